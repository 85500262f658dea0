//! `--target`: the simulator that scripts are for.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use pydslrep_config::Target;

/// Parses a simulator by its name in settings.
pub(crate) fn target_parser() -> impl TypedValueParser<Value = Target> {
    let word = |target: Target| PossibleValue::new(target.word()).help(target.summary());
    PossibleValuesParser::new(Target::ALL.map(word))
        .try_map(|word| Target::from_word(&word).ok_or("no target"))
}
