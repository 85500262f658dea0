//! How bad problems are to whoever asks: `--severity CODE=LEVEL`.

use std::collections::HashMap;

use pydslrep_analysis::{Diagnostic, Severity};
use pydslrep_syntax::closest;

use crate::catalogue;
use crate::failure::Failure;

/// The level of problems that are not to be shown at all.
const OFF: &str = "off";

const LEVELS: [Severity; 4] = [Severity::Hint, Severity::Information, Severity::Warning, Severity::Error];

/// Severities in place of those of the catalogue.
#[derive(Debug, Default)]
pub(crate) struct Severities {
    /// By code; `None` is off.
    chosen: HashMap<&'static str, Option<Severity>>,
}

impl Severities {
    /// Reads `CODE=LEVEL`s; of several for one code, the last one counts.
    ///
    /// # Errors
    /// When there is no such code or level.
    pub(crate) fn read(choices: &[String]) -> Result<Self, Failure> {
        choices.iter().map(|choice| read_one(choice)).collect::<Result<_, _>>().map(|chosen| Self { chosen })
    }

    /// Problems as they are to be shown.
    pub(crate) fn applied(&self, diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
        let applied = diagnostics.into_iter().filter_map(|diagnostic| {
            let chosen = self.chosen.get(diagnostic.code());
            let severity = chosen.copied().unwrap_or(Some(diagnostic.severity))?;
            Some(Diagnostic { severity, ..diagnostic })
        });
        applied.collect()
    }
}

fn read_one(choice: &str) -> Result<(&'static str, Option<Severity>), Failure> {
    let (code, level) = choice.split_once('=').ok_or_else(|| {
        Failure::new(format!("`--severity {choice}` has no level"))
            .help(format!("write the code, `=` and a level: `--severity {choice}=off`"))
    })?;
    Ok((catalogue::find(code)?.code, self::level(level)?))
}

fn level(word: &str) -> Result<Option<Severity>, Failure> {
    if word == OFF {
        return Ok(None);
    }
    if let Some(severity) = LEVELS.into_iter().find(|severity| severity.word() == word) {
        return Ok(Some(severity));
    }
    let words = || std::iter::once(OFF).chain(LEVELS.map(Severity::word));
    Err(Failure::new(format!("there is no level `{word}`")).help(match closest(word, words()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("the levels are {}", words().collect::<Vec<_>>().join(", ")),
    }))
}
