//! `--severity CODE=LEVEL`.

use pydslrep_config::{Level, Severities, find_rule};

use crate::failure::Failure;

/// Parses `CODE=LEVEL` options; the last one for a code wins.
///
/// # Errors
/// If there is no such code or level.
pub(crate) fn read(choices: &[String]) -> Result<Severities, Failure> {
    let mut severities = Severities::default();
    for choice in choices {
        let (code, level) = choice.split_once('=').ok_or_else(|| {
            Failure::new(format!("`--severity {choice}` has no level"))
                .help(format!("write the code, `=` and a level: `--severity {choice}=off`"))
        })?;
        severities.set(find_rule(code)?.code, Level::from_word(level)?);
    }
    Ok(severities)
}
