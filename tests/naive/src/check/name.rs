//! Groups "name" and "file": what is declared and what is used.

use crate::Finding;
use crate::program::{Entity, Name, Program};

pub(super) fn check(program: &Program, findings: &mut Vec<Finding>) {
    let references = program.references();
    for (kind, name) in &references {
        if program.find(kind, &name.text).is_none() {
            findings.push(Finding::new("unresolved-reference", &name.range));
        }
    }
    for (index, entity) in program.entities.iter().enumerate() {
        if program.entities[..index].iter().any(|earlier| is_same(earlier, entity)) {
            findings.push(Finding::new("duplicate-name", &entity.name.range));
        }
        if program.has_any("environment") && !is_used(&references, entity) {
            findings.push(Finding::new("unused-declaration", &entity.name.range));
        }
    }
    no_environment(program, findings);
}

fn is_same(one: &Entity, other: &Entity) -> bool {
    one.kind() == other.kind() && one.name.text == other.name.text
}

/// Whether something names it. An environment is what all the rest is for.
fn is_used(references: &[(&str, &Name)], entity: &Entity) -> bool {
    entity.kind() == "environment"
        || references.iter().any(|(kind, name)| *kind == entity.kind() && name.text == entity.name.text)
}

/// Robots and movements but no environment; said at the last entity.
fn no_environment(program: &Program, findings: &mut Vec<Finding>) {
    if program.has_any("robot") && program.has_any("movement") && !program.has_any("environment") {
        let last = program.entities.last();
        findings.extend(last.map(|entity| Finding::new("no-environment", &entity.name.range)));
    }
}

/// Whether a declaration is unused because a reference that leads nowhere may have meant it: it is the only one of its
/// kind, or its name is nearly the one that was written.
pub(crate) fn is_excused(program: &Program, finding: &Finding) -> bool {
    let declares = |entity: &&Entity| entity.name.range == (finding.start..finding.end);
    let Some(unused) =
        program.entities.iter().find(declares).filter(|_| finding.code == "unused-declaration")
    else {
        return false;
    };
    let is_only_one = !program
        .entities
        .iter()
        .any(|other| other.kind() == unused.kind() && other.name.text != unused.name.text);
    program.references().iter().any(|(kind, name)| {
        let leads_nowhere = *kind == unused.kind() && program.find(kind, &name.text).is_none();
        leads_nowhere && (is_only_one || is_near(&name.text, &unused.name.text))
    })
}

/// Equal but for case, two letters in the other order, or no more than a third of the letters to change.
fn is_near(one: &str, other: &str) -> bool {
    let is_swapped = one.len() == 2 && one.chars().rev().eq(other.chars());
    let longest = one.len().max(other.len());
    one.eq_ignore_ascii_case(other) || is_swapped || changes(one.as_bytes(), other.as_bytes()) <= longest / 3
}

/// How many letters to add, take away, replace or swap with the next one.
fn changes(one: &[u8], other: &[u8]) -> usize {
    let mut table = vec![vec![0; other.len() + 1]; one.len() + 1];
    for i in 0..=one.len() {
        for j in 0..=other.len() {
            table[i][j] = if i == 0 || j == 0 {
                i + j
            } else {
                let replaced = table[i - 1][j - 1] + usize::from(one[i - 1] != other[j - 1]);
                let is_swap = i > 1 && j > 1 && one[i - 1] == other[j - 2] && one[i - 2] == other[j - 1];
                let swapped = if is_swap { table[i - 2][j - 2] + 1 } else { usize::MAX };
                replaced.min(swapped).min(table[i - 1][j] + 1).min(table[i][j - 1] + 1)
            };
        }
    }
    table[one.len()][other.len()]
}
