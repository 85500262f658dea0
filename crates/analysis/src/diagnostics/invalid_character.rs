//! `invalid-character`: characters no token starts with.

use pydslrep_syntax::ast::Entity;
use pydslrep_syntax::{Span, SyntaxError, SyntaxErrorKind, TokenKind};

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "invalid-character",
    severity: Severity::Error,
    summary: "a character that has no meaning in the language",
    tag: None,
    applicability: Applicability::Suggested,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A character that means nothing in the language, such as `;`, `=` or `ä`. Several in a row are \
        reported together. Inside a comment every character is fine.",
    why: "Names consist of the letters a to z and A to Z, digits and `_`, and statements need no end mark. A foreign \
        character often means that the statement was meant differently, so check it before you remove it.",
    imports: &[],
    example: "wheel wheelL with radius 4.5;",
    fixed: "wheel wheelL with radius 4.5",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let mut closed = Vec::new();
    for error in context.errors.iter().filter(|error| !is_reported(context, error)) {
        match &error.kind {
            SyntaxErrorKind::InvalidName { written } => problems.push(name(context, error.span, written)),
            SyntaxErrorKind::ForeignComment { written } => {
                problems.push(comment(context, error.span, written));
            }
            SyntaxErrorKind::InvalidCharacter { written } if !closed.contains(&error.span) => {
                if let Some(close) = partner(context, error, written) {
                    closed.push(close);
                    problems.push(pair(context, error.span, close, written));
                } else {
                    problems.push(characters(context, error.span, written));
                }
            }
            _ => {}
        }
    }
}

/// Returns whether the problem of the whole statement covers the error. An invalid name stays one in it.
fn is_reported(context: &Context<'_>, error: &SyntaxError) -> bool {
    let stays = match &error.kind {
        SyntaxErrorKind::InvalidName { written } => {
            context.rewrites.iter().any(|rewrite| rewrite.keeps(written))
        }
        _ => false,
    };
    context.is_rewritten(error.span) && !stays
}

/// `left-wheel`
fn name(context: &Context<'_>, span: Span, written: &str) -> Problem {
    let foreign = context.text(span);
    let message = format!("names cannot contain `{}`", if foreign.is_empty() { written } else { &foreign });
    let problem = RULE.problem(span, message).help(NAMES);
    let whole = context.tokens.iter().find(|(_, other)| other.start <= span.start && span.end <= other.end);
    let plain = plain_name(written);
    match whole.filter(|_| plain.chars().any(|c| c.is_ascii_alphanumeric())) {
        Some((_, whole)) => problem.suggestion(format!("write `{plain}`"), [context.replace(*whole, plain)]),
        None => problem,
    }
}

/// The name in letters that names can have.
fn plain_name(written: &str) -> String {
    let mut plain = String::new();
    for c in written.chars() {
        match c {
            'ä' => plain += "ae",
            'ö' => plain += "oe",
            'ü' => plain += "ue",
            'Ä' => plain += "Ae",
            'Ö' => plain += "Oe",
            'Ü' => plain += "Ue",
            'ß' => plain += "ss",
            '\'' | '’' => {}
            c if c.is_ascii_alphanumeric() || c == '^' => plain.push(c),
            _ => plain.push('_'),
        }
    }
    plain
}

/// `# my robot`
fn comment(context: &Context<'_>, span: Span, written: &str) -> Problem {
    let problem = RULE.problem(span, format!("`{written}` does not start a comment"));
    let line = context.tokens.iter().find(|(_, other)| other.start == span.start);
    let text = line.map_or("", |(_, line)| context.text(*line));
    let problem = problem.help(if text.starts_with("#include") {
        "another file is read by `import \"wheels.pyr\"`; a comment starts with `//`"
    } else {
        "a comment starts with `//`"
    });
    problem.suggestion("start it with `//`", [context.replace(span, "//")])
}

/// Where the bracket is closed that this one opens.
fn partner(context: &Context<'_>, error: &SyntaxError, written: &str) -> Option<Span> {
    let close = match written {
        "(" => ")",
        "[" => "]",
        "<" => ">",
        "<!--" => "-->",
        "'" | "`" | "“" | "„" | "‘" | "«" => "'`”“’‘»",
        _ => return None,
    };
    let following = context.errors.iter().filter(|other| other.span.start >= error.span.end);
    let mut other = following.filter_map(|other| match &other.kind {
        SyntaxErrorKind::InvalidCharacter { written } => Some((other.span, written)),
        _ => None,
    });
    let (span, text) = other.next()?;
    let first = text.chars().next()?;
    let closes = close == text.as_str()
        || close.contains(first) && (text.len() == first.len_utf8() || text.contains(';'));
    closes.then_some(span)
}

/// Two brackets.
fn pair(context: &Context<'_>, open: Span, close: Span, written: &str) -> Problem {
    let other = context.text(close);
    let problem = RULE.problem(open, format!("unexpected `{written}` and `{other}`"));
    let braces = [context.replace(open, "{"), context.replace(close, "}")];
    let nothing = [context.remove_character(open), context.remove_character(close)];
    let body = matches!(context.tree, Some(Entity::Movement(_)));
    let before =
        context.tokens.iter().rev().find(|(token, span)| !token.is_comment() && span.end <= open.start);
    let spaced = context.text(Span::new(open.end, close.start)).starts_with([' ', '\n']);
    let lists = before.is_some_and(|(token, _)| match token {
        TokenKind::If | TokenKind::Until => true,
        TokenKind::Has | TokenKind::Sensors | TokenKind::With => spaced || !body,
        token => body && spaced && token.is_name(),
    });
    if lists && ["(", "["].contains(&written) {
        problem.help(BRACES).suggestion("write `{` and `}`", braces)
    } else {
        problem.help(help(written)).suggestion(format!("remove `{written}` and `{other}`"), nothing)
    }
}

fn characters(context: &Context<'_>, span: Span, written: &str) -> Problem {
    let shown = shown(written);
    let problem = RULE.problem(span, format!("unexpected {shown}")).help(help(written));
    if written.chars().all(|c| MINUS.contains(&c)) && written.chars().count() == 1 && written != "-" {
        return problem.suggestion("change to `-`", [context.replace(span, "-")]);
    }
    if written == "-" {
        return match context.tokens.iter().find(|(_, other)| other.start >= span.end) {
            Some((token, number)) if token.is_number() && number.start > span.end => problem.suggestion(
                "join it with its number",
                [context.replace(Span::new(span.end, number.start), "")],
            ),
            _ => problem.suggestion("remove `-`", [context.remove_character(span)]),
        };
    }
    if written.chars().all(is_space) {
        return problem.suggestion("put a plain space there", [context.replace(span, " ")]);
    }
    if written == "/" {
        // `1/2` without it is another number.
        return problem;
    }
    problem.suggestion(format!("remove {shown}"), [context.remove_character(span)])
}

const NAMES: &str = "names are made of the letters a to z and A to Z, digits and `_`";
const BRACES: &str = "lists and actions are written between `{` and `}`";

/// Characters that look like a minus sign.
const MINUS: [char; 5] = ['-', '\u{2212}', '\u{2013}', '\u{2014}', '\u{2010}'];

/// White space that is none to the language.
fn is_space(c: char) -> bool {
    c.is_whitespace()
}

/// The characters in quotes, or their numbers where nobody could see them.
fn shown(written: &str) -> String {
    let unseen = |c: char| {
        c.is_whitespace()
            || c.is_control()
            || matches!(c, '\u{200b}'..='\u{200f}' | '\u{feff}' | '\u{2060}' | '\u{ad}')
    };
    if !written.chars().all(unseen) {
        return format!("`{written}`");
    }
    let numbers: Vec<String> = written.chars().map(|c| format!("U+{:04X}", u32::from(c))).collect();
    format!("invisible character {}", numbers.join(" "))
}

/// Returns a hint about the language for somebody who is used to these characters.
fn help(written: &str) -> &'static str {
    let has = |signs: &[char]| written.contains(signs);
    if written.chars().any(char::is_alphabetic) {
        NAMES
    } else if written.chars().all(is_space) {
        "it looks like a space but is not one; type a plain space"
    } else if has(&[';']) {
        "lines need no end mark; leave it out"
    } else if has(&['=']) {
        "a value comes right after its word, such as `radius 4.5`; leave it out"
    } else if has(&['(', ')', '[', ']']) {
        BRACES
    } else if has(&['°']) {
        "an angle is always in degrees; leave the sign out"
    } else if has(&['\'', '“', '”', '„', '‘', '’', '`', '«', '»']) {
        "only the path of an import is quoted, with `\"`"
    } else if written == "*/" {
        "no comment is open here: the first `*/` closes one, however many `/*` came before it"
    } else if has(&['^']) {
        "`^` goes right before a keyword that is used as a name, such as `^left`"
    } else if written == "/" {
        "a comment starts with `//`; a number is written out, such as `0.5`"
    } else if has(&['+']) {
        "a number without a sign is positive; leave it out"
    } else if written.chars().all(|c| MINUS.contains(&c)) {
        "a minus sign is `-`, right before its number, such as `-4.5`"
    } else if has(&['\\']) {
        "a comment starts with `//`"
    } else {
        "leave it out; in a comment, after `//`, every character is fine"
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    #[test]
    fn adjacent_ones_are_one_problem() {
        check(
            "wheel a with §§ radius 4.5;",
            &expect![[r#"
                error[invalid-character] 1:14 "§§" unexpected `§§`
                  help: leave it out; in a comment, after `//`, every character is fine
                  suggestion: remove `§§` -> wheel a with radius 4.5;
                error[invalid-character] 1:29 ";" unexpected `;`
                  help: lines need no end mark; leave it out
                  suggestion: remove `;` -> wheel a with §§ radius 4.5
            "#]],
        );
        check_clean("wheel a with radius 4.5 // §");
    }

    #[test]
    fn mistakes_from_other_languages_are_known() {
        check(
            "wheel aä with radius 4.5",
            &expect![[r#"
                error[invalid-character] 1:8 "ä" names cannot contain `ä`
                  help: names are made of the letters a to z and A to Z, digits and `_`
                  suggestion: write `aae` -> wheel aae with radius 4.5
            "#]],
        );
        check(
            "wheel a with radius = 4.5",
            &expect![[r#"
                error[invalid-character] 1:21 "=" unexpected `=`
                  help: a value comes right after its word, such as `radius 4.5`; leave it out
                  suggestion: remove `=` -> wheel a with radius 4.5
            "#]],
        );
        check(
            "wheel a with radius 4.5 #",
            &expect![[r##"
                error[invalid-character] 1:25 "#" `#` does not start a comment
                  help: a comment starts with `//`
                  suggestion: start it with `//` -> wheel a with radius 4.5 //
            "##]],
        );
        check(
            "wheel a with radius (4.5",
            &expect![[r#"
            error[invalid-character] 1:21 "(" unexpected `(`
              help: lists and actions are written between `{` and `}`
              suggestion: remove `(` -> wheel a with radius 4.5
        "#]],
        );
    }
}
