//! `no-environment`: robots and movements, but nothing that runs them.

use pydslrep_syntax::{EntityKind, Span, escape};

use super::example::trip;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::{Diagnostic, Edit, EntityRef, Facts, FileId, Fix, Severity};

pub(super) static RULE: Rule = Rule {
    code: "no-environment",
    severity: Severity::Information,
    summary: "robots and movements, but no environment to run them",
    tag: None,
    applicability: Applicability::Suggested,
    page: PAGE,
    checks: Checks::of_file(in_file),
};

const PAGE: Page = Page {
    what: "A file has robots and movements, but no environment, and no other file imports it.",
    why: "Robots and movements only describe what is possible. An environment lists the robots that take part and the \
        movements that run, and each environment becomes a script. Without one there is nothing to run.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels

movement trip of rover { move 1 meters }",
    fixed: trip!("{ move 1 meters }"),
};

/// The problem, if the file has it, at its last entity.
fn in_file(facts: &Facts, file: FileId) -> Option<Diagnostic> {
    let has = |kind| facts.count(file, kind) > 0;
    let wanted = has(EntityKind::Robot)
        && has(EntityKind::Movement)
        && !has(EntityKind::Environment)
        && !facts.is_imported(file)
        && !facts.has_open_comment(file)
        && !facts.has_skipped_names(file);
    if !wanted {
        return None;
    }
    let last = facts.entities(file).filter(|entity| entity.parse.entity.is_some()).last()?;
    let name = last.parse.entity.as_ref()?.name();
    let span = name.map_or(last.parse.tokens.first()?.1, |name| name.span).shifted(last.span.start);
    Some(Diagnostic {
        rule: &RULE,
        severity: RULE.severity,
        file,
        span,
        message: "no environment uses these robots and movements, so there is nothing to run".to_owned(),
        help: Some(format!("add one: `{}`", EntityKind::Environment.shape())),
        note: None,
        related: Vec::new(),
        fixes: vec![with_all(facts, &last)],
    })
}

/// An environment with every robot and every movement of the file, after its last entity.
fn with_all(facts: &Facts, last: &EntityRef<'_>) -> Fix {
    let names = |wanted: EntityKind| {
        let named = facts.entities(last.file).filter_map(|entity| {
            let tree = entity.parse.entity.as_ref().filter(|tree| tree.kind() == Some(wanted))?;
            tree.name().map(|name| escape(&name.text))
        });
        let mut names: Vec<String> = named.collect();
        names.dedup();
        names.join(" ")
    };
    let ending = facts.line_ending(last.file);
    let tokens = last.parse.tokens.iter().rev();
    let end = tokens.map(|(_, span)| span.end).next().unwrap_or(last.span.len()) + last.span.start;
    let (robots, movements) = (names(EntityKind::Robot), names(EntityKind::Movement));
    let text =
        format!("{ending}{ending}environment area has {{ {robots} }} robots with {{ {movements} }} moves");
    Fix {
        title: "add an environment with all robots and movements".to_owned(),
        safe: false,
        edits: vec![Edit { file: last.file, span: Span::at(end), text }],
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check_whole, check_whole_clean};

    const PARTS: &str =
        "wheel a with radius 4\nwheel b with radius 4\nrobot r with port 1 has { a b } wheels\n";

    #[test]
    fn an_environment_is_offered() {
        check_whole(
            &format!("{PARTS}movement m of r {{ turn left }} // end\n"),
            &expect![[r#"
                information[no-environment] 4:10 "m" no environment uses these robots and movements, so there is nothing to run
                  help: add one: `environment NAME has { ROBOTS } robots with { MOVEMENTS } moves`
                  suggestion: add an environment with all robots and movements ->  ⏎ environment area has { r } robots with { m } moves
            "#]],
        );
        check_whole_clean(PARTS);
    }
}
