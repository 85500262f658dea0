//! The one list of settings.

use pydslrep_schema::Value;

use crate::values::{self, Refusal, Values, Word};
use crate::{Config, LensKind, Target};

/// A setting.
#[derive(Debug)]
pub struct Key {
    /// What it is called, with dots between tables and what is in them: `inlay-hints.pose`.
    pub name: &'static str,
    /// What it can be.
    pub values: Values,
    /// What it does, in Markdown.
    pub summary: &'static str,
    /// What holds where nothing is said, in Markdown.
    pub default: &'static str,
    /// A value that is not the default, as TOML and JSON write it alike.
    pub example: &'static str,
    /// Puts a value into its place.
    pub(crate) set: fn(&mut Config, &Value) -> Result<(), Refusal>,
}

const TARGETS: [Word; Target::ALL.len()] = {
    let [first, second] = Target::ALL;
    [
        Word { word: first.word(), summary: first.summary() },
        Word { word: second.word(), summary: second.summary() },
    ]
};

/// All settings, those outside of tables first.
pub const KEYS: [Key; 16] = [
    Key {
        name: "target",
        values: Values::Words(&TARGETS),
        summary: "The simulator that scripts are for.",
        default: "`\"coppeliasim\"`",
        example: "\"vrep\"",
        set: |config, value| values::target(value).map(|target| config.target = Some(target)),
    },
    Key {
        name: "output",
        values: Values::Folder,
        summary: "The folder that scripts are written to, seen from the folder of this file and inside of it; made where \
                  it is not there.",
        default: "beside each program",
        example: "\"scripts\"",
        set: |config, value| values::folder(value).map(|folder| config.output = Some(folder)),
    },
    Key {
        name: "generate-on-save",
        values: Values::Flag,
        summary: "Whether an editor writes the scripts of a program whenever it is saved without errors.",
        default: "`false`",
        example: "true",
        set: |config, value| values::flag(value).map(|flag| config.generate_on_save = Some(flag)),
    },
    Key {
        name: "default-speed",
        values: Values::AboveZero,
        summary: "The speed in snippets that an editor inserts, in centimetres per second.",
        default: "`9.0`",
        example: "12.5",
        set: |config, value| values::above_zero(value).map(|speed| config.default_speed = Some(speed)),
    },
    Key {
        name: "severity",
        values: Values::Levels,
        summary: "How bad problems of a code are to you: `\"off\"`, `\"hint\"`, `\"information\"`, `\"warning\"` or `\"error\"`. \
                  This is about what is shown and the exit code of `pydslrep check`; what keeps a script from being made \
                  does so at any level.",
        default: "as in the [list of messages](diagnostics/README.md)",
        example: "{ }",
        // Each code is read on its own, so that one slip does not hide the others.
        set: |_, value| values::table(value),
    },
    Key {
        name: "inlay-hints.pose",
        values: Values::Flag,
        summary: "Whether an editor shows the pose after each action, counted from where its movement starts: x and y in metres, and \
                  the heading.",
        default: "`true`",
        example: "false",
        set: |config, value| values::flag(value).map(|flag| config.inlay_hints.pose = Some(flag)),
    },
    Key {
        name: "inlay-hints.duration",
        values: Values::Flag,
        summary: "Whether an editor shows how long each action takes.",
        default: "`true`",
        example: "false",
        set: |config, value| values::flag(value).map(|flag| config.inlay_hints.duration = Some(flag)),
    },
    Key {
        name: "inlay-hints.defaults",
        values: Values::Flag,
        summary: "Whether an editor shows speeds and angles that are left out.",
        default: "`true`",
        example: "false",
        set: |config, value| values::flag(value).map(|flag| config.inlay_hints.defaults = Some(flag)),
    },
    Key {
        name: "code-lens.generate-script",
        values: Values::Flag,
        summary: "Whether an editor shows *Generate script* above an environment.",
        default: "`true`",
        example: "false",
        set: |config, value| {
            values::flag(value).map(|flag| config.code_lens.set(LensKind::GenerateScript, flag))
        },
    },
    Key {
        name: "code-lens.run",
        values: Values::Flag,
        summary: "Whether an editor shows *Run* above an environment.",
        default: "`true`",
        example: "false",
        set: |config, value| values::flag(value).map(|flag| config.code_lens.set(LensKind::Run, flag)),
    },
    Key {
        name: "code-lens.preview",
        values: Values::Flag,
        summary: "Whether an editor shows *Preview* above an environment.",
        default: "`true`",
        example: "false",
        set: |config, value| values::flag(value).map(|flag| config.code_lens.set(LensKind::Preview, flag)),
    },
    Key {
        name: "code-lens.wheels",
        values: Values::Flag,
        summary: "Whether an editor shows above a wheel how often it is used.",
        default: "`false`",
        example: "true",
        set: |config, value| values::flag(value).map(|flag| config.code_lens.set(LensKind::Wheels, flag)),
    },
    Key {
        name: "code-lens.sensors",
        values: Values::Flag,
        summary: "Whether an editor shows above a sensor how often it is used.",
        default: "`false`",
        example: "true",
        set: |config, value| values::flag(value).map(|flag| config.code_lens.set(LensKind::Sensors, flag)),
    },
    Key {
        name: "code-lens.ips",
        values: Values::Flag,
        summary: "Whether an editor shows above an `ip` how often it is used.",
        default: "`true`",
        example: "false",
        set: |config, value| values::flag(value).map(|flag| config.code_lens.set(LensKind::Ips, flag)),
    },
    Key {
        name: "code-lens.robots",
        values: Values::Flag,
        summary: "Whether an editor shows above a robot how often it is used.",
        default: "`true`",
        example: "false",
        set: |config, value| values::flag(value).map(|flag| config.code_lens.set(LensKind::Robots, flag)),
    },
    Key {
        name: "code-lens.movements",
        values: Values::Flag,
        summary: "Whether an editor shows above a movement how often it is used.",
        default: "`true`",
        example: "false",
        set: |config, value| values::flag(value).map(|flag| config.code_lens.set(LensKind::Movements, flag)),
    },
];

/// The names of all tables, each once.
pub fn tables() -> Vec<&'static str> {
    let table = |key: &'static Key| match key.values {
        Values::Levels => Some(key.name),
        _ => key.name.rsplit_once('.').map(|(table, _)| table),
    };
    let mut tables: Vec<&str> = KEYS.iter().filter_map(table).collect();
    tables.dedup();
    tables
}

/// The parts right behind this one, each once: of the whole for "", of a table for its name and a dot.
pub(crate) fn parts_behind(prefix: &str) -> Vec<&'static str> {
    let rest = KEYS.iter().filter_map(|key| key.name.strip_prefix(prefix));
    let mut parts: Vec<&str> = rest.map(|rest| rest.split('.').next().unwrap_or(rest)).collect();
    parts.dedup();
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Settings;

    fn toml(key: &Key, value: &str) -> String {
        format!("{} = {value}\n", key.name)
    }

    #[test]
    fn examples_are_read_and_are_not_the_default() {
        for key in KEYS.iter().filter(|key| key.values != Values::Levels) {
            let (config, problems) = Config::from_toml(&toml(key, key.example));
            assert_eq!(problems, [], "{}", key.name);
            assert_ne!(config.settings(), Settings::default(), "{}", key.name);
        }
    }

    #[test]
    fn defaults_are_what_is_said_of_them() {
        for key in &KEYS {
            let Some(default) = key.default.strip_prefix('`').and_then(|rest| rest.strip_suffix('`')) else {
                assert!(matches!(key.values, Values::Folder | Values::Levels), "{}", key.name);
                continue;
            };
            let (config, problems) = Config::from_toml(&toml(key, default));
            assert_eq!(problems, [], "{}", key.name);
            assert_ne!(config, Config::default(), "{}", key.name);
            assert_eq!(config.settings(), Settings::default(), "{}", key.name);
        }
    }

    #[test]
    fn tables_follow_what_is_outside_of_tables() {
        assert_eq!(
            parts_behind(""),
            ["target", "output", "generate-on-save", "default-speed", "severity", "inlay-hints", "code-lens"]
        );
        assert_eq!(tables(), ["severity", "inlay-hints", "code-lens"]);
        assert_eq!(parts_behind("inlay-hints."), ["pose", "duration", "defaults"]);
    }
}
