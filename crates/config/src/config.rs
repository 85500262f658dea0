//! What can be set: as one place says it, and as it holds in the end.

use pydslrep_kinematics::motion::RIM_SPEED;

use pydslrep_analysis::Target;

use crate::Severities;

/// What one place says; `None` where it says nothing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Config {
    /// The simulator that scripts are for.
    pub target: Option<Target>,
    /// The folder that scripts are written to, with `/` between its parts; relative to the folder of the file, or in
    /// an editor to that of the workspace, and never outside of it.
    pub output: Option<String>,
    /// How bad problems are.
    pub severities: Severities,
    /// Whether an editor writes scripts whenever a program without errors is saved.
    pub generate_on_save: Option<bool>,
    /// The speed in inserted snippets, centimetres per second; finite and above zero.
    pub default_speed: Option<f64>,
    /// What an editor shows between the words of a program.
    pub inlay_hints: InlayHintsConfig,
    /// What an editor shows above declarations.
    pub code_lens: CodeLensConfig,
}

/// Which inlay hints one place wants.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct InlayHintsConfig {
    /// The pose after each action.
    pub pose: Option<bool>,
    /// How long each action takes.
    pub duration: Option<bool>,
    /// Speeds and angles that are left out.
    pub defaults: Option<bool>,
}

/// What holds in the end.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// The simulator that scripts are for.
    pub target: Target,
    /// The folder that scripts are written to, as in [`Config::output`]; beside each program where it is `None`.
    pub output: Option<String>,
    /// How bad problems are, where that is not as in the catalogue.
    pub severities: Severities,
    /// Whether an editor writes scripts whenever a program without errors is saved.
    pub generate_on_save: bool,
    /// The speed in inserted snippets, centimetres per second.
    pub default_speed: f64,
    /// What an editor shows between the words of a program.
    pub inlay_hints: InlayHints,
    /// What an editor shows above declarations.
    pub code_lens: CodeLens,
}

/// Which inlay hints are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InlayHints {
    /// The pose after each action.
    pub pose: bool,
    /// How long each action takes.
    pub duration: bool,
    /// Speeds and angles that are left out.
    pub defaults: bool,
}

/// What an editor can show above a declaration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LensKind {
    /// *Generate script*, above an environment.
    GenerateScript,
    /// *Run*, above an environment.
    Run,
    /// *Preview*, above an environment.
    Preview,
    /// How often a wheel is used.
    Wheels,
    /// How often a sensor is used.
    Sensors,
    /// How often an address is used.
    Ips,
    /// How often a robot is used.
    Robots,
    /// How often a movement is used.
    Movements,
}

impl LensKind {
    /// All of them, in the order of their declaration.
    pub const ALL: [Self; 8] = [
        Self::GenerateScript,
        Self::Run,
        Self::Preview,
        Self::Wheels,
        Self::Sensors,
        Self::Ips,
        Self::Robots,
        Self::Movements,
    ];

    /// Whether it is shown where nothing is said: what has many declarations, each used once, would fill the screen.
    fn is_shown_by_default(self) -> bool {
        !matches!(self, Self::Wheels | Self::Sensors)
    }
}

/// Which code lenses one place wants, by [`LensKind`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct CodeLensConfig([Option<bool>; LensKind::ALL.len()]);

impl CodeLensConfig {
    pub(crate) fn set(&mut self, kind: LensKind, is_shown: bool) {
        self.0[kind as usize] = Some(is_shown);
    }

    fn merged_over(self, base: Self) -> Self {
        Self(LensKind::ALL.map(|kind| self.0[kind as usize].or(base.0[kind as usize])))
    }

    fn settings(self) -> CodeLens {
        CodeLens(LensKind::ALL.map(|kind| self.0[kind as usize].unwrap_or(kind.is_shown_by_default())))
    }
}

/// Which code lenses are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CodeLens([bool; LensKind::ALL.len()]);

impl CodeLens {
    /// Whether those of a kind are.
    pub fn shows(self, kind: LensKind) -> bool {
        self.0[kind as usize]
    }
}

impl Config {
    /// What holds where `self` is asked first and `base` where it says nothing. Severities are merged code by code.
    pub fn merged_over(self, base: Self) -> Self {
        let (hints, base_hints) = (self.inlay_hints, base.inlay_hints);
        Self {
            target: self.target.or(base.target),
            output: self.output.or(base.output),
            severities: self.severities.merged_over(base.severities),
            generate_on_save: self.generate_on_save.or(base.generate_on_save),
            default_speed: self.default_speed.or(base.default_speed),
            inlay_hints: InlayHintsConfig {
                pose: hints.pose.or(base_hints.pose),
                duration: hints.duration.or(base_hints.duration),
                defaults: hints.defaults.or(base_hints.defaults),
            },
            code_lens: self.code_lens.merged_over(base.code_lens),
        }
    }

    /// What holds, with defaults where nothing is said.
    pub fn settings(self) -> Settings {
        let hints = self.inlay_hints;
        Settings {
            target: self.target.unwrap_or_default(),
            output: self.output,
            severities: self.severities,
            generate_on_save: self.generate_on_save.unwrap_or(false),
            default_speed: self.default_speed.unwrap_or(RIM_SPEED * 100.0),
            inlay_hints: InlayHints {
                pose: hints.pose.unwrap_or(true),
                duration: hints.duration.unwrap_or(true),
                defaults: hints.defaults.unwrap_or(true),
            },
            code_lens: self.code_lens.settings(),
        }
    }
}

impl Default for Settings {
    fn default() -> Self {
        Config::default().settings()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Level;

    #[test]
    fn what_is_asked_first_wins_and_the_rest_is_kept() {
        let (base, _) = Config::from_toml(
            "target = \"vrep\"\noutput = \"a\"\n[severity]\nwheel-count = \"off\"\nwheel-order = \"error\"\n\
             [inlay-hints]\npose = false\nduration = false\n[code-lens]\nwheels = true\nrun = false\n",
        );
        let (over, _) = Config::from_toml(
            "target = \"coppeliasim\"\ngenerate-on-save = true\n[severity]\nwheel-order = \"hint\"\n\
             [inlay-hints]\nduration = true\n[code-lens]\nrun = true\nips = false\n",
        );
        let settings = over.merged_over(base).settings();
        assert_eq!((settings.target, settings.output.as_deref()), (Target::CoppeliaSim, Some("a")));
        assert!(settings.generate_on_save);
        assert!((settings.default_speed - 9.0).abs() < 1e-12);
        assert_eq!(settings.inlay_hints, InlayHints { pose: false, duration: true, defaults: true });
        let hidden: Vec<LensKind> =
            LensKind::ALL.into_iter().filter(|kind| !settings.code_lens.shows(*kind)).collect();
        assert_eq!(hidden, [LensKind::Sensors, LensKind::Ips]);
        assert_eq!(settings.severities.level("wheel-count"), Some(Level::Off));
        assert_eq!(settings.severities.level("wheel-order"), Some(Level::Hint));
    }
}
