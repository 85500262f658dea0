//! Diagnostics as they are named on the command line.

use pydslrep_analysis::diagnostics::{CATALOGUE, Rule, rule};
use pydslrep_syntax::closest;

use crate::failure::Failure;

/// The rule with a code.
///
/// # Errors
/// When there is none.
pub(crate) fn find(code: &str) -> Result<&'static Rule, Failure> {
    rule(code).ok_or_else(|| {
        let near = closest(code, CATALOGUE.into_iter().map(|rule| rule.code));
        Failure::new(format!("there is no diagnostic `{code}`")).help(match near {
            Some(near) => format!("did you mean `{near}`?"),
            None => "`pydslrep explain` lists them all".to_owned(),
        })
    })
}
