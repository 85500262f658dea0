//! `syntax-error`: the text does not follow the grammar.
//!
//! [`words`] has the phrases for what was expected; [`common_mistakes`] recognises habits from other languages, and [`rewrite`]
//! whole statements in their syntax; [`glued`] separates words without a blank between them; [`repair`] finds fixes by trying
//! candidates.

mod common_mistakes;
mod glued;
mod repair;
mod rewrite;
mod words;

use pydslrep_syntax::ast::{Entity, Name};
use pydslrep_syntax::{EntityKind, Expected, Found, Span, SyntaxError, SyntaxErrorKind, TokenKind};

pub(super) use self::rewrite::find as rewrites;
use self::words::{listed, shape, worth_listing};
use super::context::Context;
use super::problem::{Brace, Problem, Renaming};
use super::rule::{Applicability, Checks, Page, Rule};
use crate::{Diagnostic, Resolution, Severity};

pub(super) static RULE: Rule = Rule {
    code: "syntax-error",
    severity: Severity::Error,
    summary: "a word is missing, misspelt, doubled or in the wrong place",
    tag: None,
    applicability: Applicability::Safe,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "The text does not follow the grammar: a word is missing, misspelt, written twice or in the wrong place. Each \
        mistake is reported once, and the rest of the file is still checked.",
    why: "A broken statement could mean several things, so no script is generated from it. The message names what was \
        expected and shows the form of the statement.",
    imports: &[],
    example: "wheel wheelL radius 4.5",
    fixed: "wheel wheelL with radius 4.5",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let glued = glued::find(context);
    let explain_all = glued::explain_all(context, &glued);
    let is_explained = |span: Span| explain_all || glued.iter().any(|glued| glued.explains(span));
    let errors =
        context.errors.iter().filter(|error| !context.is_rewritten(error.span) && !is_explained(error.span));
    let others = errors.filter_map(|error| problem(context, error));
    problems.extend(others.map(|problem| rewrite::with_fallback(context, problem)));
    problems.extend(glued.iter().map(|glued| glued.problem(context)));
    problems.extend(context.rewrites.iter().filter_map(|statement| rewrite::problem(statement, context)));
    problems.extend(late_import(context));
}

fn problem(context: &Context<'_>, error: &SyntaxError) -> Option<Problem> {
    let span = error.span;
    Some(match &error.kind {
        SyntaxErrorKind::Missing { expected, found, inside } => {
            missing(context, span, expected, found, *inside)
        }
        SyntaxErrorKind::Unexpected { expected, found: Found::Text(found), inside } => {
            common_mistakes::problem(context, span, expected, found)
                .unwrap_or_else(|| unexpected(context, span, expected, found, *inside))
        }
        SyntaxErrorKind::Misplaced { written, to, inside } => misplaced(context, span, written, *to, *inside),
        SyntaxErrorKind::Unbraced { close, inside } => unbraced(context, span, *close, *inside),
        SyntaxErrorKind::Misspelt { written, keyword } => misspelt(context, span, written, *keyword),
        SyntaxErrorKind::KeywordAsName { written, of } => {
            return keyword_as_name(context, span, written, *of);
        }
        SyntaxErrorKind::MalformedNumber { written } => malformed_number(context, span, written),
        SyntaxErrorKind::PortNotWhole { written } => RULE
            .problem(span, format!("a port is a whole number, and `{written}` is not"))
            .help("write a whole number from 1 to 65535, such as `23000`"),
        SyntaxErrorKind::EmptyList { of } => {
            let noun = of.noun();
            RULE.problem(span, format!("this list must name at least one {noun}"))
                .help(format!("name {} between the braces, or leave the whole clause out", of.a_noun()))
        }
        _ => return None,
    })
}

fn misspelt(context: &Context<'_>, span: Span, written: &str, keyword: TokenKind) -> Problem {
    let word = keyword.spelling().unwrap_or_default();
    let is_keyword = pydslrep_syntax::KEYWORDS.iter().any(|(_, other)| *other == written);
    let message = if is_keyword {
        format!("`{written}` does not fit here; did you mean `{word}`?")
    } else if written.eq_ignore_ascii_case(word) {
        format!("keywords are case-sensitive: this one is `{word}`")
    } else {
        format!("`{written}` is not a keyword; did you mean `{word}`?")
    };
    let problem = RULE.problem(span, message);
    let edit = context.replace(span, word);
    if repair::is_split(context, std::slice::from_ref(&edit)) {
        problem.fix(format!("change to `{word}`"), [edit])
    } else {
        problem.suggestion(format!("change to `{word}`"), [edit])
    }
}

/// `None` for a reference to a declaration that has the same mistake: the declaration's problem stands for all its uses.
fn keyword_as_name(context: &Context<'_>, span: Span, written: &str, of: EntityKind) -> Option<Problem> {
    let message = format!("`{written}` is a keyword, so {} cannot be called that", of.a_noun());
    let help = format!("write `^{written}` to use it as a name, or choose another name");
    let problem = RULE.problem(span, message).help(help);
    let name = Name { text: written.into(), span };
    if context.tree.and_then(Entity::name).is_some_and(|name| name.span == span) {
        let renaming =
            |text: String| Renaming { declared: context.id, kind: of, name: name.text.clone(), text };
        let free = free_name(context, of, written);
        let problem = problem.renaming(format!("rename it to `{free}`"), false, renaming(free));
        return Some(problem.renaming(format!("write `^{written}`"), true, renaming(format!("^{written}"))));
    }
    match context.resolve(of, &name) {
        Resolution::Nothing => Some(
            RULE.problem(span, format!("expected the name of {}, found `{written}`", of.a_noun()))
                .help(format!("`{written}` is a keyword; only a name can stand here")),
        ),
        Resolution::To(declared) if context.name_of(declared).is_some_and(is_bare) => None,
        _ => Some(problem.fix(format!("write `^{written}`"), [context.replace(Span::at(span.start), "^")])),
    }
}

/// Returns whether a name is written without `^`.
fn is_bare(name: &Name) -> bool {
    name.span.len() as usize == name.text.len()
}

/// A name made of the current one and the kind, such as `left_sensor`, that no other declaration of the kind has.
fn free_name(context: &Context<'_>, kind: EntityKind, written: &str) -> String {
    let stem =
        if written == kind.noun() { format!("{written}_1") } else { format!("{written}_{}", kind.noun()) };
    let numbered = (2_u32..).map(|number| format!("{stem}_{number}"));
    let mut candidates = std::iter::once(stem.clone()).chain(numbered);
    candidates.find(|candidate| !context.is_declared(kind, candidate)).unwrap_or_default()
}

fn malformed_number(context: &Context<'_>, span: Span, written: &str) -> Problem {
    let problem = RULE
        .problem(span, format!("`{written}` is not a number"))
        .help("write digits, and at most one point between them, such as `4` or `4.5`");
    let (sign, digits) = written.strip_prefix('-').map_or(("", written), |digits| ("-", digits));
    let whole = match (digits.strip_prefix('.'), digits.strip_suffix('.')) {
        (Some(fraction), None) if !fraction.contains('.') => format!("{sign}0.{fraction}"),
        (None, Some(digits)) if !digits.contains('.') => format!("{sign}{digits}.0"),
        _ => return problem,
    };
    problem.fix(format!("write `{whole}`"), [context.replace(span, whole)])
}

fn missing(
    context: &Context<'_>,
    span: Span,
    expected: &[Expected],
    found: &Found,
    inside: Option<EntityKind>,
) -> Problem {
    let all = expected;
    let expected = worth_listing(expected);
    let closes = matches!(expected[..], [Expected::Word(TokenKind::CloseBrace)]);
    let before =
        context.tokens.iter().rev().find(|(token, other)| !token.is_comment() && other.end <= span.start);
    let place = match (found, inside, before) {
        (Found::Text(text), ..) => format!(" before `{text}`"),
        (Found::End, Some(kind), _) if closes => format!(" at the end of this {}", kind.noun()),
        (Found::End, _, Some((_, before))) => format!(" after `{}`", context.text(*before)),
        (Found::End, ..) => " at the end".to_owned(),
    };
    let clause = clause(&expected, found, inside);
    let what = clause.map_or_else(|| listed(&expected), |(what, _)| what.to_owned());
    let mut problem = RULE.problem(span, format!("missing {what}{place}"));
    let braces = before.and_then(|(token, _)| words::missing_braces(*token, &expected));
    let amount = || words::amount(context, span, &expected);
    let help = braces.map(str::to_owned).or_else(amount).or_else(|| shape(context, inside, &expected));
    if let Some(help) = help {
        problem = problem.help(help);
    }
    if *found == Found::End && expected.contains(&Expected::Word(TokenKind::CloseBrace)) {
        problem = problem.brace(Brace::Unclosed);
    }
    if let Some((_, Some(text))) = clause {
        let edit = context.replace(span, format!(" {text}"));
        if repair::is_fixed(context, std::slice::from_ref(&edit)) {
            return problem.suggestion(format!("insert `{text}`"), [edit]);
        }
    }
    repair::insert(context, problem, span, all)
}

/// A whole clause that is missing, and what it could be.
fn clause(
    expected: &[Expected],
    found: &Found,
    inside: Option<EntityKind>,
) -> Option<(&'static str, Option<&'static str>)> {
    let Found::Text(found) = found else { return None };
    match (inside?, expected) {
        (EntityKind::Robot, [Expected::Word(TokenKind::With)]) if ["has", "{"].contains(&found.as_str()) => {
            Some(("the robot's port", Some("with port 23000")))
        }
        (EntityKind::Movement, [Expected::Word(TokenKind::Of)]) if found == "{" => {
            Some(("`of` and the name of a robot", None))
        }
        (EntityKind::Environment, [Expected::Word(TokenKind::Has)]) if found == "with" => {
            Some(("the environment's robots", None))
        }
        _ => None,
    }
}

/// Says of a brace that is closed only after other declarations that those do not belong between.
pub(super) fn nested(unclosed: &mut Diagnostic) {
    "a declaration stands between the braces here".clone_into(&mut unclosed.message);
    unclosed.help =
        Some("declarations stand beside each other: move it out, and let only its name be listed".to_owned());
    unclosed.fixes.clear();
}

fn unexpected(
    context: &Context<'_>,
    span: Span,
    expected: &[Expected],
    found: &str,
    inside: Option<EntityKind>,
) -> Problem {
    let all = expected;
    let expected = worth_listing(expected);
    if repair::is_doubled(context, span) {
        let problem = RULE.problem(span, format!("`{found}` is written twice"));
        return problem.fix(format!("remove the second `{found}`"), [context.remove(span)]);
    }
    let complete = expected.contains(&Expected::Declaration);
    let problem = match inside {
        None if matches!(context.tree, Some(Entity::Import(_))) => {
            RULE.problem(span, format!("unexpected `{found}`: this import is complete"))
                .help("each file has an import of its own, such as `import \"wheels.pyr\"`")
        }
        None if ["include", "from", "using", "require", "use"].contains(&found) => RULE
            .problem(span, format!("a program cannot start with `{found}`"))
            .help("another file is read by `import`, such as `import \"wheels.pyr\"`"),
        None => RULE.problem(span, format!("a program cannot start with `{found}`")).help(
            "a program is made of `import`, `wheel`, `wheelH`, `sensor`, `ip`, `robot`, `movement` and `environment`",
        ),
        Some(kind) if complete => {
            let problem = RULE.problem(
                span,
                format!("unexpected `{found}`: the {} before it is complete", kind.noun()),
            );
            let is_clause = ["with", "has", "at", "until", "of", "type"].contains(&found);
            problem.help(match shape(context, inside, &[]).filter(|_| is_clause) {
                Some(shape) => shape,
                None => "leave it out, or start the next declaration with its keyword, such as `robot`".to_owned(),
            })
        }
        Some(_) if expected.contains(&Expected::Action) && found.starts_with(char::is_alphabetic) => {
            let problem = RULE.problem(span, format!("unexpected `{found}`: not an action"));
            problem.help(words::actions())
        }
        Some(_) => {
            let problem = RULE.problem(span, format!("expected {}, found `{found}`", listed(&expected)));
            let amount = words::amount(context, span, &expected);
            match amount.or_else(|| shape(context, inside, &expected)) {
                Some(help) => problem.help(help),
                None => problem,
            }
        }
    };
    repair::repair(context, problem, span, found, all)
}

fn misplaced(
    context: &Context<'_>,
    span: Span,
    written: &str,
    to: u32,
    inside: Option<EntityKind>,
) -> Problem {
    let early = span.start < to;
    let side = if early { "early" } else { "late" };
    let before = context.tokens.iter().rev().find(|(token, other)| !token.is_comment() && other.end <= to);
    let place = before.map(|(_, other)| format!(": it belongs after `{}`", context.text(*other)));
    let problem = RULE.problem(span, format!("`{written}` comes too {side}{}", place.unwrap_or_default()));
    let problem = match shape(context, inside, &[]) {
        Some(shape) => problem.help(shape),
        None => problem,
    };
    let edits = [context.remove(span), context.replace(Span::at(to), format!(" {written}"))];
    let apart = !context.remove(span).span.touches(to);
    if apart && repair::is_fixed(context, &edits) {
        problem.fix(format!("move `{written}` there"), edits)
    } else {
        problem
    }
}

fn unbraced(context: &Context<'_>, span: Span, close: u32, inside: Option<EntityKind>) -> Problem {
    let what = if inside == Some(EntityKind::Movement) && repair::is_body(context, span) {
        "actions"
    } else {
        "lists"
    };
    let problem = RULE.problem(span, format!("missing `{{` and `}}`: {what} are written between braces"));
    let problem = match shape(context, inside, &[]) {
        Some(shape) => problem.help(shape),
        None => problem,
    };
    let edits = [context.replace(Span::at(span.start), " {"), repair::closing(context, Span::at(close))];
    if repair::is_fixed(context, &edits) { problem.fix("insert `{` and `}`", edits) } else { problem }
}

fn late_import(context: &Context<'_>) -> Option<Problem> {
    let Some(Entity::Import(_)) = context.tree else { return None };
    let top = context.place_of_late_import()?;
    let first = context.tokens.first()?.1;
    let last = context.tokens.iter().rev().find(|(token, _)| !token.is_comment())?.1;
    let span = first.to(last);
    let text = format!("{}\n", context.text(span).replace("\r\n", "\n"));
    let insert = super::edits::ProblemEdit::new(top, Span::at(0), text);
    Some(
        RULE.problem(span, "imports must come first in a file")
            .help("move it to the top of the file")
            .fix("move to the top", [insert, context.remove_line(span)]),
    )
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    const PARTS: &str = "wheel a with radius 4.5\nwheel b with radius 4.5\nsensor s\n";

    #[test]
    fn a_missing_word_is_inserted() {
        check(
            "wheel a radius 4.5",
            &expect![[r#"
            error[syntax-error] 1:8 "" missing `with` before `radius`
              help: a wheel is written `wheel NAME with radius CENTIMETRES`
              fix: insert `with` -> wheel a with radius 4.5
        "#]],
        );
        check(
            &format!("{PARTS}robot r with port 1 has {{ a b wheels with sensors {{ s }}"),
            &expect![[r#"
            error[syntax-error] 4:30 "" missing `}` before `wheels`
              help: a robot is written `robot NAME type tw with port 23000 has { WHEELS } wheels`
              fix: insert `}` -> robot r with port 1 has { a b } wheels with sensors { s }
        "#]],
        );
    }

    #[test]
    fn a_missing_part_is_named() {
        check(
            "wheel",
            &expect![[r#"
                error[syntax-error] 1:6 "" missing a name for the wheel after `wheel`
                  help: a wheel is written `wheel NAME with radius CENTIMETRES`
            "#]],
        );
        check(
            "wheel a with radius",
            &expect![[r#"
                error[syntax-error] 1:20 "" missing a radius in centimetres after `radius`
                  help: a wheel is written `wheel NAME with radius CENTIMETRES`
            "#]],
        );
        check(
            &format!("{PARTS}robot r has {{ a b }} wheels"),
            &expect![[r#"
                error[syntax-error] 4:8 "" missing the robot's port before `has`
                  help: a robot is written `robot NAME type tw with port 23000 has { WHEELS } wheels`
                  suggestion: insert `with port 23000` -> robot r with port 23000 has { a b } wheels
            "#]],
        );
        check(
            &format!(
                "{PARTS}robot r with port 1 has {{ a b }} wheels\nmovement m of r {{\n  move 4\n  turn 90\n"
            ),
            &expect![[r#"
                error[syntax-error] 6:9 "" missing `meters` or `centimeters` before `turn`
                  help: a move is written `move 4.0 meters` or `move 40 centimeters at 9.0`
                  suggestion: insert `meters` ->   move 4 meters
                  suggestion: insert `centimeters` ->   move 4 centimeters
                error[syntax-error] 7:7 "" missing `left` or `right` before `90`
                  help: a turn is written `turn left 90` or `turn right until { SENSORS }`
                  suggestion: insert `left` ->   turn left 90
                  suggestion: insert `right` ->   turn right 90
                error[syntax-error] 7:10 "" missing `}` at the end of this movement
                  help: a movement is written `movement NAME of ROBOT { ACTIONS }`
                  fix: insert `}` -> }
            "#]],
        );
    }

    #[test]
    fn a_slip_of_spelling_is_recognised() {
        check(
            "wheel a with radios 4.5",
            &expect![[r#"
            error[syntax-error] 1:14 "radios" `radios` is not a keyword; did you mean `radius`?
              fix: change to `radius` -> wheel a with radius 4.5
        "#]],
        );
        check(
            "weel a with radius 4.5",
            &expect![[r#"
            error[syntax-error] 1:1 "weel" `weel` is not a keyword; did you mean `wheel`?
              fix: change to `wheel` -> wheel a with radius 4.5
        "#]],
        );
    }

    #[test]
    fn a_word_of_the_language_as_a_name_is_one_problem() {
        check(
            "wheel a with radius 4 wheel b with radius 4\nsensor left\nsensor left_sensor\n\
             robot r with port 1 has { a b } wheels with sensors { left }\n\
             movement m of r { turn left until { left } }",
            &expect![[r#"
                error[syntax-error] 2:8 "left" `left` is a keyword, so a sensor cannot be called that
                  help: write `^left` to use it as a name, or choose another name
                  suggestion: rename it to `left_sensor_2` -> sensor left_sensor_2 ⏎ robot r with port 1 has { a b } wheels with sensors { left_sensor_2 } ⏎ movement m of r { turn left until { left_sensor_2 } }
                  fix: write `^left` -> sensor ^left ⏎ robot r with port 1 has { a b } wheels with sensors { ^left } ⏎ movement m of r { turn left until { ^left } }
            "#]],
        );
        check(
            "sensor ^left\nrobot r with port 1 has { a b } wheels with sensors { left }",
            &expect![[r#"
                error[unresolved-reference] 2:27 "a" there is no wheel called `a`
                  help: declare it: `wheel NAME with radius CENTIMETRES`
                  suggestion: declare the wheel `a` -> wheel a with radius 4.5
                error[unresolved-reference] 2:29 "b" there is no wheel called `b`
                  help: declare it: `wheel NAME with radius CENTIMETRES`
                  suggestion: declare the wheel `b` -> wheel b with radius 4.5
                error[syntax-error] 2:55 "left" `left` is a keyword, so a sensor cannot be called that
                  help: write `^left` to use it as a name, or choose another name
                  fix: write `^left` -> robot r with port 1 has { a b } wheels with sensors { ^left }
            "#]],
        );
    }

    #[test]
    fn what_does_not_belong_is_shown() {
        check(
            "wheel a with radius 4.5 4.5",
            &expect![[r#"
                error[syntax-error] 1:25 "4.5" `4.5` is written twice
                  fix: remove the second `4.5` -> wheel a with radius 4.5
            "#]],
        );
        check(
            "}\nwheel a with radius 4.5",
            &expect![[r#"
                error[syntax-error] 1:1 "}" this `}` closes nothing
                  help: remove it, or write the `{` that it closes
                  suggestion: remove `}` -> 
            "#]],
        );
        check(
            "wheel left with radius 4.5",
            &expect![[r#"
                error[syntax-error] 1:7 "left" `left` is a keyword, so a wheel cannot be called that
                  help: write `^left` to use it as a name, or choose another name
                  suggestion: rename it to `left_wheel` -> wheel left_wheel with radius 4.5
                  fix: write `^left` -> wheel ^left with radius 4.5
            "#]],
        );
        check(
            &format!("{PARTS}robot r with port 1.5 has {{ a 7 b }} wheels with sensors {{ }}"),
            &expect![[r#"
                error[syntax-error] 4:19 "1.5" a port is a whole number, and `1.5` is not
                  help: write a whole number from 1 to 65535, such as `23000`
                error[syntax-error] 4:31 "7" expected the name of a wheel, found `7`
                  help: a robot is written `robot NAME type tw with port 23000 has { WHEELS } wheels`
                  suggestion: remove `7` -> robot r with port 1.5 has { a b } wheels with sensors { }
                error[syntax-error] 4:57 "{ }" this list must name at least one sensor
                  help: name a sensor between the braces, or leave the whole clause out
            "#]],
        );
        check(
            "wheel a with radius 4.",
            &expect![[r#"
                error[syntax-error] 1:21 "4." `4.` is not a number
                  help: write digits, and at most one point between them, such as `4` or `4.5`
                  fix: write `4.0` -> wheel a with radius 4.0
            "#]],
        );
    }

    #[test]
    fn an_import_comes_first() {
        check(
            "// top\nwheel a with radius 4.5\nimport \"b.pyr\"\n",
            &expect![[r#"
            error[syntax-error] 3:1 "import \"b.pyr\"" imports must come first in a file
              help: move it to the top of the file
              fix: move to the top -> 
        "#]],
        );
        check_clean("import \"b.pyr\"\nwheel a with radius 4.5\n");
    }
}
