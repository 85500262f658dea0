//! Helpers that the tests of all rules share.

use expect_test::Expect;
use pydslrep_syntax::Span;

use super::Applicability;
use crate::{Database, Diagnostic, Edit, FileId, Fix};

/// Rules about what is still to be written; fixtures are fragments and would all break them.
const OF_WHOLE_PROGRAMS: [&str; 3] = ["unused-declaration", "idle-robot", "no-environment"];

/// A robot `r` with a distance sensor `s` and a bumper `t`.
pub(super) const PARTS: &str = "wheel a with radius 4\nwheel b with radius 4\nsensor s\nsensor t : bumper\n\
    robot r with port 1 has { a b } wheels with sensors { s, t }\n";

/// A movement `m` of that robot.
pub(super) fn program(actions: &str) -> String {
    format!("{PARTS}movement m of r {{ {actions} }}")
}

/// Compares the problems of a fragment with what is expected, and holds every fix to its promise: the problem is gone
/// and none has come.
#[track_caller]
pub(super) fn check(fragment: &str, expected: &Expect) {
    check_those(fragment, expected, |diagnostic| !OF_WHOLE_PROGRAMS.contains(&diagnostic.code()));
}

/// Like [`check`], with the rules about whole programs.
#[track_caller]
pub(super) fn check_whole(program: &str, expected: &Expect) {
    check_those(program, expected, |_| true);
}

/// No problem at all.
#[track_caller]
pub(super) fn check_clean(fragment: &str) {
    check(fragment, &expect_test::expect![""]);
}

/// No problem at all, nor anything left to write.
#[track_caller]
pub(super) fn check_whole_clean(program: &str) {
    check_whole(program, &expect_test::expect![""]);
}

#[track_caller]
fn check_those(program: &str, expected: &Expect, asked: fn(&Diagnostic) -> bool) {
    let problems = |text: &str| {
        let mut database = Database::new();
        let file = database.open("test.pyr", text);
        let mut diagnostics = database.diagnostics(file);
        check_extents(&database, file, &diagnostics);
        diagnostics.retain(asked);
        (file, diagnostics)
    };
    let (file, diagnostics) = problems(program);
    let rendered: String = diagnostics.iter().map(|diagnostic| render(program, diagnostic)).collect();
    expected.assert_eq(&rendered);
    for diagnostic in &diagnostics {
        for fix in &diagnostic.fixes {
            assert!(
                applicability(fix) <= diagnostic.rule.applicability,
                "{} promises less than {fix:?}",
                diagnostic.code()
            );
            let after = apply(program, file, &fix.edits);
            check_fix(program, &diagnostics, diagnostic, &after, &problems(&after).1);
        }
    }
}

/// What is shown differs from all that is known by fixes only, and at each problem's place the problem is found.
fn check_extents(database: &Database, file: FileId, all: &[Diagnostic]) {
    let unfixed = |diagnostic: &Diagnostic| Diagnostic { fixes: Vec::new(), ..diagnostic.clone() };
    let shown: Vec<Diagnostic> = database.shown_diagnostics(file).iter().map(unfixed).collect();
    assert_eq!(shown, all.iter().map(unfixed).collect::<Vec<_>>());
    for diagnostic in all {
        let at = database.diagnostics_at(file, diagnostic.span);
        assert!(at.contains(diagnostic), "{diagnostic:#?} is not among {at:#?}");
        let touches = |found: &Diagnostic| {
            found.span.touches(diagnostic.span.start) || diagnostic.span.touches(found.span.start)
        };
        assert!(at.iter().all(touches));
    }
}

fn check_fix(program: &str, before: &[Diagnostic], fixed: &Diagnostic, after: &str, left: &[Diagnostic]) {
    let count = |list: &[Diagnostic], code: &str| list.iter().filter(|other| other.code() == code).count();
    let code = fixed.code();
    assert!(
        count(left, code) < count(before, code),
        "the fix does not solve it\n{program}\n->\n{after}\n{left:#?}"
    );
    for other in left {
        let code = other.code();
        assert!(
            count(left, code) <= count(before, code),
            "the fix brings {code}\n{program}\n->\n{after}\n{left:#?}"
        );
    }
}

/// Returns the applicability of a fix.
pub(super) fn applicability(fix: &Fix) -> Applicability {
    if fix.safe { Applicability::Safe } else { Applicability::Suggested }
}

/// The program after edits.
pub(super) fn apply(program: &str, file: FileId, edits: &[Edit]) -> String {
    let mut edits: Vec<&Edit> = edits.iter().filter(|edit| edit.file == file).collect();
    edits.sort_by_key(|edit| std::cmp::Reverse(edit.span.start));
    let mut text = program.to_owned();
    for edit in edits {
        text.replace_range(std::ops::Range::from(edit.span), &edit.text);
    }
    text
}

fn render(program: &str, diagnostic: &Diagnostic) -> String {
    let mut out = format!(
        "{}[{}] {} {}\n",
        diagnostic.severity.word(),
        diagnostic.code(),
        place(program, diagnostic.span),
        diagnostic.message
    );
    for related in &diagnostic.related {
        out += &format!("  see {} {}\n", place(program, related.span), related.message);
    }
    for (word, text) in [("help", &diagnostic.help), ("note", &diagnostic.note)] {
        if let Some(text) = text {
            out += &format!("  {word}: {text}\n");
        }
    }
    for fix in &diagnostic.fixes {
        let changed = apply(program, diagnostic.file, &fix.edits);
        let lines: Vec<&str> =
            changed.lines().filter(|line| !program.lines().any(|old| old == *line)).collect();
        let sort = if fix.safe { "fix" } else { "suggestion" };
        out += &format!("  {sort}: {} -> {}\n", fix.title, lines.join(" ⏎ "));
    }
    out
}

fn place(program: &str, span: Span) -> String {
    let before = &program[..span.start as usize];
    let line = before.matches('\n').count() + 1;
    let column = before.len() - before.rfind('\n').map_or(0, |newline| newline + 1) + 1;
    format!("{line}:{column} {:?}", span.text(program))
}
