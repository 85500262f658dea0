//! Options that several commands have.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use pydslrep_config::{Level, Severities, Target, find_rule};

use crate::failure::Failure;

/// Parses a simulator by its name in settings.
pub(crate) fn target_parser() -> impl TypedValueParser<Value = Target> {
    let word = |target: Target| PossibleValue::new(target.word()).help(target.summary());
    PossibleValuesParser::new(Target::ALL.map(word))
        .try_map(|word| Target::from_word(&word).ok_or("no target"))
}

/// Parses a number above zero.
pub(crate) fn above_zero(text: &str) -> Result<f64, String> {
    let speed = text.parse().ok().filter(|speed: &f64| speed.is_finite() && *speed > 0.0);
    speed.ok_or_else(|| "expected a number above zero, such as 1 or 2.5".to_owned())
}

/// Parses `CODE=LEVEL` options; the last one for a code wins.
///
/// # Errors
/// If there is no such code or level.
pub(crate) fn severities(choices: &[String]) -> Result<Severities, Failure> {
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
