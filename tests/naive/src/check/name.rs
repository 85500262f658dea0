//! Group "name": declarations and references.

use crate::Finding;
use crate::program::{Entity, Name};
use crate::project::Scope;

pub(super) fn check(scope: Scope<'_>, findings: &mut Vec<Finding>) {
    let program = scope.program();
    let references = program.references();
    for (kind, name) in &references {
        if scope.find(kind, &name.text).is_none() && !scope.lacks_imports() {
            findings.push(Finding::new("unresolved-reference", &name.range));
        }
    }
    for (index, entity) in program.entities.iter().enumerate() {
        if program.entities[..index].iter().any(|earlier| is_same(earlier, entity)) {
            findings.push(Finding::new("duplicate-name", &entity.name.range));
        }
        if program.has_any("environment") && !scope.is_imported() && !is_used(&references, entity) {
            findings.push(Finding::new("unused-declaration", &entity.name.range));
        }
    }
}

fn is_same(one: &Entity, other: &Entity) -> bool {
    one.kind() == other.kind() && one.name.text == other.name.text
}

/// Whether it is referenced. Environments are always used.
fn is_used(references: &[(&str, &Name)], entity: &Entity) -> bool {
    entity.kind() == "environment"
        || references.iter().any(|(kind, name)| *kind == entity.kind() && name.text == entity.name.text)
}

/// Whether a declaration may be unused because of an unresolved reference: it is the only one of its kind, or its name is
/// similar.
pub(crate) fn is_excused(scope: Scope<'_>, finding: &Finding) -> bool {
    let program = scope.program();
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
        let is_unresolved = *kind == unused.kind() && scope.find(kind, &name.text).is_none();
        is_unresolved && (is_only_one || is_similar(&name.text, &unused.name.text))
    })
}

/// Equal except for case, two swapped letters, or an edit distance of at most a third of the length.
fn is_similar(one: &str, other: &str) -> bool {
    let is_swapped = one.len() == 2 && one.chars().rev().eq(other.chars());
    let longest = one.len().max(other.len());
    one.eq_ignore_ascii_case(other)
        || is_swapped
        || edit_distance(one.as_bytes(), other.as_bytes()) <= longest / 3
}

/// The edit distance: insertions, deletions, replacements and swaps of adjacent letters.
fn edit_distance(one: &[u8], other: &[u8]) -> usize {
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
