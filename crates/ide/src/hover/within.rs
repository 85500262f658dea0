//! The conditions and repetitions that an action is nested in.

/// The blocks that an action is in.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Within {
    rounds: bool,
    condition: bool,
}

impl Within {
    /// In a block that is repeated so many times.
    pub(crate) fn rounds(self) -> Self {
        Self { rounds: true, ..self }
    }

    /// In a block that is done, or repeated, only if a condition holds.
    pub(crate) fn condition(self) -> Self {
        Self { condition: true, ..self }
    }

    /// The beginning of a sentence that says from where to where an action leads.
    pub(crate) fn opening(self) -> &'static str {
        match (self.rounds, self.condition) {
            (false, false) => "From",
            (true, false) => "In the first round from",
            (false, true) => "If it is done, from",
            (true, true) => "If it is done in the first round, from",
        }
    }
}
