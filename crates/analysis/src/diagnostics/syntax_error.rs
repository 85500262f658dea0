//! `syntax-error`: the text does not follow the grammar.

use pydslrep_syntax::ast::Entity;
use pydslrep_syntax::{EntityKind, Expected, Found, Span, SyntaxError, SyntaxErrorKind, Token};

use super::context::{Context, Problem};
use super::{Page, Remedy, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "syntax-error",
    severity: Severity::Error,
    summary: "a word is missing, misspelt, doubled or in the wrong place",
    tag: None,
    remedy: Remedy::Safe,
    seeks_names: false,
    page: PAGE,
    check,
};

const PAGE: Page = Page {
    what: "The text does not follow the patterns of the language: a word is missing, misspelt, written twice or \
        in the wrong place. Each slip is reported once, and the rest of the file is checked all the same.",
    why: "Where a pattern is broken, nobody can be sure what you want the robot to do, so no script is made \
        from it. The message says what was expected there and shows the whole pattern.",
    imports: &[],
    example: "wheel wheelL radius 4.5",
    fixed: "wheel wheelL with radius 4.5",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    problems.extend(context.errors.iter().filter_map(|error| problem(context, error)));
    problems.extend(late_import(context));
}

fn problem(context: &Context<'_>, error: &SyntaxError) -> Option<Problem> {
    let span = error.span;
    Some(match &error.kind {
        SyntaxErrorKind::Missing { expected, found, inside } => {
            missing(context, span, expected, found, *inside)
        }
        SyntaxErrorKind::Unexpected { expected, found, inside } => {
            unexpected(context, span, expected, found, *inside)
        }
        SyntaxErrorKind::Misspelt { written, keyword } => {
            let keyword = keyword.spelling().unwrap_or_default();
            RULE.problem(
                span,
                format!("`{written}` is not a word of the language; did you mean `{keyword}`?"),
            )
            .fix(format!("change to `{keyword}`"), [context.replace(span, keyword)])
        }
        SyntaxErrorKind::KeywordAsName { written, of } => RULE
            .problem(
                span,
                format!("`{written}` is a word of the language, so {} cannot be called that", of.a_noun()),
            )
            .help(format!("write `^{written}` to use it as a name, or choose another name"))
            .fix(format!("write `^{written}`"), [context.replace(Span::at(span.start), "^")]),
        SyntaxErrorKind::MalformedNumber { written } => RULE
            .problem(span, format!("`{written}` is not a number"))
            .help("write digits, and at most one point between them, such as `4` or `4.5`"),
        SyntaxErrorKind::PortNotWhole { written } => RULE
            .problem(span, format!("a port is a whole number, and `{written}` is not"))
            .help("write a whole number from 1 to 65535, such as `19999`"),
        SyntaxErrorKind::EmptyList { of } => {
            let noun = of.noun();
            RULE.problem(span, format!("this list must name at least one {noun}"))
                .help(format!("name {} between the braces, or leave the whole clause out", of.a_noun()))
        }
        SyntaxErrorKind::InvalidCharacter { .. }
        | SyntaxErrorKind::UnterminatedComment
        | SyntaxErrorKind::UnterminatedString => return None,
    })
}

fn missing(
    context: &Context<'_>,
    span: Span,
    expected: &[Expected],
    found: &Found,
    inside: Option<EntityKind>,
) -> Problem {
    let expected = telling(expected);
    let place = match (found, inside) {
        (Found::Text(text), _) => format!(" before `{text}`"),
        (Found::End, Some(kind)) => format!(" at the end of this {}", kind.noun()),
        (Found::End, None) => " at the end".to_owned(),
    };
    let mut problem = RULE.problem(span, format!("missing {}{place}", listed(&expected)));
    if let Some(kind) = inside {
        problem = problem.help(shape(kind, &expected));
    }
    match expected[..] {
        [Expected::Word(word)] => insert(context, problem, span, word),
        _ => problem,
    }
}

fn insert(context: &Context<'_>, problem: Problem, span: Span, word: Token) -> Problem {
    let spelling = word.spelling().unwrap_or_default();
    let braces_body = word == Token::CloseBrace && matches!(context.tree, Some(Entity::Movement(_)));
    let text = match context.lexemes.iter().find(|(_, other)| other.end == span.start) {
        // A brace that closes a movement gets a line of its own where the movement has several.
        Some(_) if braces_body && context.text(Span::new(0, span.start)).contains(['\n', '\r']) => {
            format!("\n{spelling}")
        }
        _ => format!(" {spelling}"),
    };
    problem.fix(format!("insert `{spelling}`"), [context.replace(span, text)])
}

fn unexpected(
    context: &Context<'_>,
    span: Span,
    expected: &[Expected],
    found: &Found,
    inside: Option<EntityKind>,
) -> Problem {
    let text = match found {
        Found::Text(text) => text.as_str(),
        Found::End => "",
    };
    let expected = telling(expected);
    let Some(kind) = inside else {
        return RULE
            .problem(span, format!("a program cannot start with `{text}`"))
            .help("a program is made of `import`, `wheel`, `wheelH`, `sensor`, `ip`, `robot`, `movement` and `environment`");
    };
    if expected.contains(&Expected::Declaration) {
        return RULE
            .problem(
                span,
                format!("`{text}` does not belong here: the {} before it is complete", kind.noun()),
            )
            .help(format!("{}; the next declaration starts with its keyword", shape(kind, &[])));
    }
    let is_keyword = context.lexemes.iter().any(|(token, other)| *other == span && token.is_keyword());
    let wants_name =
        expected.iter().any(|expected| matches!(expected, Expected::NameOf(_) | Expected::ReferenceTo(_)));
    let problem = RULE.problem(span, format!("expected {}, found `{text}`", listed(&expected)));
    if is_keyword && wants_name {
        return problem
            .help(format!("`{text}` is a word of the language; write `^{text}` to use it as a name"));
    }
    problem.help(shape(kind, &expected))
}

/// What to show as the pattern to follow.
fn shape(kind: EntityKind, expected: &[Expected]) -> String {
    let in_action = |expected: &Expected| match expected {
        Expected::Distance | Expected::Speed | Expected::Angle | Expected::Action => true,
        Expected::Word(word) => matches!(
            word,
            Token::Meters | Token::Centimeters | Token::At | Token::Left | Token::Right | Token::Until
        ),
        _ => false,
    };
    if expected.iter().any(in_action) {
        return "an action is written `move 4.0 meters`, `move 40 centimeters at 9.0`, `turn left 90`, \
                `turn right until { SENSORS }` or `slam`"
            .to_owned();
    }
    format!("{} is written `{}`", kind.a_noun(), kind.shape())
}

/// What is worth saying of all that could stand in a place: where a name or a brace would do, not that a comma would
/// as well; where a movement's brace is open, not every word that could continue its last action.
fn telling(expected: &[Expected]) -> Vec<Expected> {
    let closes = expected.contains(&Expected::Word(Token::CloseBrace));
    let lists = expected.iter().any(|expected| matches!(expected, Expected::ReferenceTo(_)));
    let ends = expected.contains(&Expected::Declaration);
    let keep = |expected: &&Expected| match expected {
        Expected::Word(Token::Comma) => !lists,
        Expected::ReferenceTo(_)
        | Expected::Action
        | Expected::Angle
        | Expected::Word(Token::At | Token::Until) => !closes,
        Expected::Word(_) => !ends,
        _ => true,
    };
    let kept: Vec<Expected> = expected.iter().filter(keep).copied().collect();
    if kept.is_empty() { expected.to_vec() } else { kept }
}

fn listed(expected: &[Expected]) -> String {
    let words: Vec<String> = expected.iter().map(|expected| phrase(*expected)).collect();
    match words.split_last() {
        None => "something else".to_owned(),
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} or {last}", others.join(", ")),
    }
}

fn phrase(expected: Expected) -> String {
    match expected {
        Expected::Word(word) => format!("`{}`", word.spelling().unwrap_or_default()),
        Expected::NameOf(kind) => format!("a name for the {}", kind.noun()),
        Expected::ReferenceTo(kind) => format!("the name of {}", kind.a_noun()),
        Expected::Radius => "a radius in centimetres".to_owned(),
        Expected::Port => "a port from 1 to 65535".to_owned(),
        Expected::Address => "an address such as 127.0.0.1".to_owned(),
        Expected::Distance => "a distance".to_owned(),
        Expected::Speed => "a speed in centimetres per second".to_owned(),
        Expected::Angle => "an angle in degrees".to_owned(),
        Expected::Path => "a path in quotes".to_owned(),
        Expected::Action => "an action (`move`, `turn` or `slam`)".to_owned(),
        Expected::Declaration => "the next declaration".to_owned(),
    }
}

fn late_import(context: &Context<'_>) -> Option<Problem> {
    let Some(Entity::Import(_)) = context.tree else { return None };
    if !context.database.is_late_import(context.id) {
        return None;
    }
    let first = context.lexemes.first()?.1;
    let last = context.lexemes.iter().rev().find(|(token, _)| !token.is_comment())?.1;
    let span = first.to(last);
    let top = context.database.entities(context.file).next()?.id;
    let text = format!("{}\n", context.text(span).replace("\r\n", "\n"));
    let start = if context.database.parse(top)?.entity.is_none() {
        context.database.entities(context.file).nth(1)?.id
    } else {
        top
    };
    let insert = super::context::ProblemEdit { entity: start, span: Span::at(0), text };
    Some(
        RULE.problem(span, "an import must stand before everything else")
            .help("move it to the top of the file")
            .fix("move to the top", [insert, context.remove(span)]),
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
              help: a robot is written `robot NAME type tw with port 19999 has { WHEELS } wheels`
              fix: insert `}` -> robot r with port 1 has { a b } wheels with sensors { s }
        "#]],
        );
    }

    #[test]
    fn a_missing_part_is_named() {
        check(
            "wheel",
            &expect![[r#"
            error[syntax-error] 1:6 "" missing a name for the wheel at the end of this wheel
              help: a wheel is written `wheel NAME with radius CENTIMETRES`
        "#]],
        );
        check(
            "wheel a with radius",
            &expect![[r#"
            error[syntax-error] 1:20 "" missing a radius in centimetres at the end of this wheel
              help: a wheel is written `wheel NAME with radius CENTIMETRES`
        "#]],
        );
        check(
            &format!("{PARTS}robot r has {{ a b }} wheels"),
            &expect![[r#"
            error[syntax-error] 4:8 "" missing `with` or `type` before `has`
              help: a robot is written `robot NAME type tw with port 19999 has { WHEELS } wheels`
        "#]],
        );
        check(
            &format!(
                "{PARTS}robot r with port 1 has {{ a b }} wheels\nmovement m of r {{\n  move 4\n  turn 90\n"
            ),
            &expect![[r#"
                error[syntax-error] 6:9 "" missing `meters` or `centimeters` before `turn`
                  help: an action is written `move 4.0 meters`, `move 40 centimeters at 9.0`, `turn left 90`, `turn right until { SENSORS }` or `slam`
                error[syntax-error] 7:7 "" missing `left` or `right` before `90`
                  help: an action is written `move 4.0 meters`, `move 40 centimeters at 9.0`, `turn left 90`, `turn right until { SENSORS }` or `slam`
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
            error[syntax-error] 1:14 "radios" `radios` is not a word of the language; did you mean `radius`?
              fix: change to `radius` -> wheel a with radius 4.5
        "#]],
        );
        check(
            "weel a with radius 4.5",
            &expect![[r#"
            error[syntax-error] 1:1 "weel" `weel` is not a word of the language; did you mean `wheel`?
              fix: change to `wheel` -> wheel a with radius 4.5
        "#]],
        );
    }

    #[test]
    fn what_does_not_belong_is_shown() {
        check(
            "wheel a with radius 4.5 4.5",
            &expect![[r#"
            error[syntax-error] 1:25 "4.5" `4.5` does not belong here: the wheel before it is complete
              help: a wheel is written `wheel NAME with radius CENTIMETRES`; the next declaration starts with its keyword
        "#]],
        );
        check(
            "}\nwheel a with radius 4.5",
            &expect![[r#"
            error[syntax-error] 1:1 "}" a program cannot start with `}`
              help: a program is made of `import`, `wheel`, `wheelH`, `sensor`, `ip`, `robot`, `movement` and `environment`
        "#]],
        );
        check(
            "wheel left with radius 4.5",
            &expect![[r#"
            error[syntax-error] 1:7 "left" `left` is a word of the language, so a wheel cannot be called that
              help: write `^left` to use it as a name, or choose another name
              fix: write `^left` -> wheel ^left with radius 4.5
        "#]],
        );
        check(
            &format!("{PARTS}robot r with port 1.5 has {{ a 7 b }} wheels with sensors {{ }}"),
            &expect![[r#"
            error[syntax-error] 4:19 "1.5" a port is a whole number, and `1.5` is not
              help: write a whole number from 1 to 65535, such as `19999`
            error[syntax-error] 4:31 "7" expected the name of a wheel, found `7`
              help: a robot is written `robot NAME type tw with port 19999 has { WHEELS } wheels`
            error[syntax-error] 4:57 "{ }" this list must name at least one sensor
              help: name a sensor between the braces, or leave the whole clause out
        "#]],
        );
        check(
            "wheel a with radius 4.",
            &expect![[r#"
            error[syntax-error] 1:21 "4." `4.` is not a number
              help: write digits, and at most one point between them, such as `4` or `4.5`
        "#]],
        );
    }

    #[test]
    fn an_import_comes_first() {
        check(
            "// top\nwheel a with radius 4.5\nimport \"b.pyr\"\n",
            &expect![[r#"
            error[syntax-error] 3:1 "import \"b.pyr\"" an import must stand before everything else
              help: move it to the top of the file
              fix: move to the top -> 
        "#]],
        );
        check_clean("import \"b.pyr\"\nwheel a with radius 4.5\n");
    }
}
