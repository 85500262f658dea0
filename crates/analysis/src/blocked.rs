//! Why an environment cannot run.

use std::sync::Arc;

use crate::Diagnostic;

/// Why an environment cannot run.
#[derive(Debug, Clone, PartialEq)]
pub struct Blocked {
    /// The environment's name.
    pub environment: String,
    /// The errors in it and in everything it uses; never empty. Shared, as many environments may be blocked by the same.
    pub errors: Arc<[Diagnostic]>,
}

impl Blocked {
    /// It in one sentence.
    pub fn reason(&self) -> String {
        let more = match self.errors.len() {
            0 | 1 => String::new(),
            count => format!(" (and {} more)", count - 1),
        };
        let first = self.errors.first().map_or("it is not complete", |error| &error.message);
        format!("`{}` has errors: {first}{more}", self.environment)
    }
}
