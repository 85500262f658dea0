//! "Diagnostics" of the specification: one file per group, one function per code.

mod environment;
mod movement;
mod name;
mod robot;
mod value;

pub(crate) use name::is_excused;

use crate::Finding;
use crate::program::{Name, Program};

/// The findings of a grammatical program.
pub(crate) fn check(program: &Program) -> Vec<Finding> {
    let mut findings = program.older_spellings.clone();
    value::check(program, &mut findings);
    name::check(program, &mut findings);
    robot::check(program, &mut findings);
    movement::check(program, &mut findings);
    environment::check(program, &mut findings);
    findings
}

/// Every repeated name in a list.
fn repeated(names: &[Name]) -> impl Iterator<Item = &Name> {
    names.iter().enumerate().filter(|(index, name)| is_among(name, &names[..*index])).map(|(_, name)| name)
}

fn is_among(name: &Name, names: &[Name]) -> bool {
    names.iter().any(|other| other.text == name.text)
}
