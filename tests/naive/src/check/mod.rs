//! "Diagnostics" of the specification: one file per group, one function per code.

mod block;
mod call;
mod condition;
mod duration;
mod edition;
mod environment;
mod file;
mod movement;
mod name;
mod robot;
mod value;

pub(crate) use duration::doubtful;
pub(crate) use edition::not_in_article;
pub(crate) use name::is_excused;

use crate::Finding;
use crate::program::Name;
use crate::project::Scope;

/// The findings of a grammatical file.
pub(crate) fn check(scope: Scope<'_>) -> Vec<Finding> {
    let mut findings = scope.program().older_spellings.clone();
    value::check(scope.file(), &mut findings);
    file::check(scope, &mut findings);
    name::check(scope, &mut findings);
    robot::check(scope, &mut findings);
    movement::check(scope, &mut findings);
    condition::check(scope, &mut findings);
    block::check(scope, &mut findings);
    call::check(scope, &mut findings);
    findings.extend(duration::certain(scope));
    environment::check(scope, &mut findings);
    findings
}

/// Every repeated name in a list.
fn repeated(names: &[Name]) -> impl Iterator<Item = &Name> {
    names.iter().enumerate().filter(|(index, name)| is_among(name, &names[..*index])).map(|(_, name)| name)
}

fn is_among(name: &Name, names: &[Name]) -> bool {
    names.iter().any(|other| other.text == name.text)
}
