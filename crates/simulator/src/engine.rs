//! Engines: what a physics engine and its server do to a script, beyond the ideal world.

use pydslrep_kinematics::motion;

/// The step that the figures were measured at, seconds.
const MEASURED_STEP: f64 = motion::STEP;

/// The engine that a simulator imitates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Engine {
    /// Bodies move exactly as their wheels roll, and every request is answered.
    #[default]
    Ideal,
    /// `CoppeliaSim` 4.6 with Bullet. While it is paused, its server answers nothing.
    CoppeliaSim46,
    /// `CoppeliaSim` 4.7 and later with Bullet. While it is paused, `sim.step` returns without a step.
    CoppeliaSim47,
}

impl Engine {
    /// All engines.
    pub const ALL: [Self; 3] = [Self::Ideal, Self::CoppeliaSim46, Self::CoppeliaSim47];

    /// Its name in options.
    pub fn word(self) -> &'static str {
        match self {
            Self::Ideal => "ideal",
            Self::CoppeliaSim46 => "coppeliasim-4.6",
            Self::CoppeliaSim47 => "coppeliasim-4.7",
        }
    }

    /// What it does, in a sentence.
    pub fn summary(self) -> &'static str {
        match self {
            Self::Ideal => "Robots move exactly as their wheels roll",
            Self::CoppeliaSim46 => {
                "Wheels slip and bodies tremble as with Bullet; answers nothing while paused"
            }
            Self::CoppeliaSim47 => {
                "Wheels slip and bodies tremble as with Bullet; a step while paused takes no time"
            }
        }
    }

    /// The engine of this name.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|engine| engine.word() == word)
    }

    /// Whether its server answers nothing while the simulation is paused.
    pub(crate) fn is_silent_while_paused(self) -> bool {
        self == Self::CoppeliaSim46
    }

    /// Whether a client whose connection has ended stays until its time-out: it keeps holding the time, and its wheels
    /// keep turning.
    pub(crate) fn keeps_lost_clients(self) -> bool {
        self != Self::Ideal
    }

    /// What it does to robots with a step of `step` seconds; `None` if nothing.
    pub(crate) fn physics(self, step: f64) -> Option<Physics> {
        (self != Self::Ideal).then(|| {
            // Shorter steps are better in proportion.
            let share = (step / MEASURED_STEP).min(1.0);
            Physics { jitter: 1e-4, creep: 0.11 * share, drift: 0.02 * share, least_speed: 0.002 }
        })
    }
}

/// What a physics engine does to robots.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Physics {
    /// How far contacts move a body from one step to the next, moving or at rest, metres and radians.
    pub(crate) jitter: f64,
    /// How much less than its wheels roll a body moves, as a share of it.
    pub(crate) creep: f64,
    /// How far a body drifts sideways per radian that it turns, at most, metres.
    pub(crate) drift: f64,
    /// Wheels whose rims should move slower than this stand still, m/s.
    pub(crate) least_speed: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_name_engines() {
        for engine in Engine::ALL {
            assert_eq!(Engine::from_word(engine.word()), Some(engine));
        }
        assert_eq!(Engine::from_word("ode"), None);
    }

    #[test]
    fn short_steps_slip_less() {
        let creep = |step| Engine::CoppeliaSim46.physics(step).map(|physics| physics.creep);
        assert_eq!((creep(0.05), creep(0.1), Engine::Ideal.physics(0.05)), (Some(0.11), Some(0.11), None));
        assert!(creep(0.01).is_some_and(|creep| (creep - 0.022).abs() < 1e-12));
    }
}
