//! Servers: how those of `CoppeliaSim` treat their clients while a simulation is paused, and when a client is lost.

/// The server that a simulator imitates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Server {
    /// Every request is answered, and a client that has gone is forgotten.
    #[default]
    Embedded,
    /// `CoppeliaSim` 4.6: while it is paused, it answers nothing.
    CoppeliaSim46,
    /// `CoppeliaSim` 4.7 and later: while it is paused, `sim.step` returns without a step.
    CoppeliaSim47,
}

impl Server {
    /// All servers.
    pub const ALL: [Self; 3] = [Self::Embedded, Self::CoppeliaSim46, Self::CoppeliaSim47];

    /// Its name in options.
    pub fn word(self) -> &'static str {
        match self {
            Self::Embedded => "embedded",
            Self::CoppeliaSim46 => "coppeliasim-4.6",
            Self::CoppeliaSim47 => "coppeliasim-4.7",
        }
    }

    /// Returns a sentence on its behaviour.
    pub fn summary(self) -> &'static str {
        match self {
            Self::Embedded => "Answers every request, and forgets clients that have gone",
            Self::CoppeliaSim46 => "Answers nothing while paused; keeps lost clients until their timeout",
            Self::CoppeliaSim47 => {
                "A step while paused takes no time; keeps lost clients until their timeout"
            }
        }
    }

    /// The server of this name.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|server| server.word() == word)
    }

    /// Returns whether it answers nothing while the simulation is paused.
    pub(crate) fn is_silent_while_paused(self) -> bool {
        self == Self::CoppeliaSim46
    }

    /// Returns whether a step that was requested before a pause is taken after it rather than cancelled.
    pub(crate) fn keeps_steps_over_pauses(self) -> bool {
        self != Self::Embedded
    }

    /// Returns whether a client whose connection has ended stays until its timeout: it keeps blocking steps, and its
    /// wheels keep turning.
    pub(crate) fn keeps_lost_clients(self) -> bool {
        self != Self::Embedded
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_name_servers() {
        for server in Server::ALL {
            assert_eq!(Server::from_word(server.word()), Some(server));
        }
        assert_eq!(Server::from_word("ode"), None);
    }
}
