//! Words without a blank between them, such as `metersturn` or `robotr`: one problem each, which inserts the blanks.

use pydslrep_syntax::{KEYWORDS, Span, Token, TokenKind};

use super::{RULE, repair};
use crate::diagnostics::context::Context;
use crate::diagnostics::edits::ProblemEdit;
use crate::diagnostics::problem::Problem;

/// Longer words are not split.
const MAX_WORD_LENGTH: u32 = 40;

/// A word that is several.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Glued {
    span: Span,
    written: String,
    /// The same with blanks.
    apart: String,
    /// True if no part of it is a name, which somebody may have chosen.
    is_certain: bool,
}

/// The words of an entity that are several, where separating them fixes something.
pub(super) fn find(context: &Context<'_>) -> Vec<Glued> {
    let mut found: Vec<Glued> = Vec::new();
    for error in context.errors {
        for span in words_near(context, error.span) {
            if found.iter().all(|glued| glued.span != span) {
                found.extend(separated(context, span));
            }
        }
    }
    found
}

/// The words that an error is at, and the one after it, before which something seems to be missing.
fn words_near(context: &Context<'_>, error: Span) -> Vec<Span> {
    // `repeat` ends with `at`, and is a word of its own.
    let is_word = |(token, span): &&Token| {
        token.is_name() && !TokenKind::CONTEXTUAL.contains(token) && span.len() <= MAX_WORD_LENGTH
    };
    let touching =
        context.tokens.iter().filter(|(_, span)| span.touches(error.start) || span.touches(error.end));
    let after = context.tokens.iter().find(|(token, span)| !token.is_comment() && span.start >= error.end);
    let mut words: Vec<Span> = touching.chain(after).filter(is_word).map(|(_, span)| *span).collect();
    words.dedup();
    words
}

/// Separates a word so that fewer errors are left, if that is possible in one way.
fn separated(context: &Context<'_>, span: Span) -> Option<Glued> {
    let written = context.text(span).to_owned();
    let (only_keywords, mut with_names): (Vec<Vec<&str>>, Vec<Vec<&str>>) =
        divisions(&written).into_iter().partition(|parts| parts.iter().all(|part| !is_name(part)));
    let fixes = |parts: &Vec<&str>| repair::is_split(context, &[edit(context, span, &parts.join(" "))]);
    // The longest keyword first: `wheelHa` is `wheelH a`.
    with_names.sort_by_key(|parts| {
        std::cmp::Reverse(parts.iter().filter(|part| !is_name(part)).map(|part| part.len()).max())
    });
    let certain = only_keywords.into_iter().find(fixes);
    let is_certain = certain.is_some();
    let parts = certain.or_else(|| with_names.into_iter().find(fixes))?;
    let apart = parts.join(" ");
    Some(Glued { span, written, apart, is_certain })
}

/// A word as keywords and numbers alone, and as a keyword before or after something else.
fn divisions(word: &str) -> Vec<Vec<&str>> {
    let mut found: Vec<Vec<&str>> = keywords_in(word).into_iter().filter(|parts| parts.len() > 1).collect();
    for (at, _) in word.char_indices().skip(1) {
        let (before, after) = word.split_at(at);
        let parts = vec![before, after];
        // A name cannot begin with a digit.
        let is_word = !after.starts_with(|c: char| c.is_ascii_digit()) || is_number(after);
        if is_keyword(before) != is_keyword(after) && is_word && !found.contains(&parts) {
            found.push(parts);
        }
    }
    found
}

/// The ways to read a word as keywords without blanks, the last of which may be a number.
fn keywords_in(word: &str) -> Vec<Vec<&str>> {
    if word.is_empty() || is_number(word) {
        return vec![[word].into_iter().filter(|word| !word.is_empty()).collect()];
    }
    let begun = KEYWORDS
        .iter()
        .filter(|(token, _)| divides(*token))
        .filter_map(|(_, keyword)| word.strip_prefix(keyword).map(|rest| (keyword.len(), rest)));
    begun
        .flat_map(|(length, rest)| {
            let whole = |rest: Vec<_>| std::iter::once(&word[..length]).chain(rest).collect();
            keywords_in(rest).into_iter().map(whole).collect::<Vec<Vec<&str>>>()
        })
        .collect()
}

/// Returns whether a word is divided after this keyword: after those that many names begin with, it is not.
fn divides(token: TokenKind) -> bool {
    use TokenKind::{Bumper, Distance, Import, Seconds, Times};
    let before_number = token.only_before().has(TokenKind::Integer);
    token.is_keyword() || before_number || matches!(token, Bumper | Distance | Import | Seconds | Times)
}

fn is_keyword(word: &str) -> bool {
    KEYWORDS.iter().any(|(token, keyword)| *keyword == word && divides(*token))
}

fn is_number(word: &str) -> bool {
    word.chars().all(|c| c.is_ascii_digit())
}

fn is_name(word: &str) -> bool {
    !is_keyword(word) && !is_number(word)
}

/// The edit that writes a word with blanks, and one before it if there is none.
fn edit(context: &Context<'_>, span: Span, apart: &str) -> ProblemEdit {
    let follows = context.tokens.iter().any(|(_, other)| other.end == span.start && !other.is_empty());
    context.replace(span, if follows { format!(" {apart}") } else { apart.to_owned() })
}

/// Returns whether an entity has no errors once its words are separated.
pub(super) fn explain_all(context: &Context<'_>, found: &[Glued]) -> bool {
    let edits: Vec<ProblemEdit> = found.iter().map(|glued| edit(context, glued.span, &glued.apart)).collect();
    !found.is_empty() && repair::has_no_errors(context, &edits)
}

impl Glued {
    pub(super) fn span(&self) -> Span {
        self.span
    }

    /// Returns whether an error is about this word.
    pub(super) fn explains(&self, error: Span) -> bool {
        self.span.touches(error.start) || self.span.touches(error.end)
    }

    pub(super) fn problem(&self, context: &Context<'_>) -> Problem {
        let Self { span, written, apart, .. } = self;
        let count = apart.split(' ').count();
        let words = if count == 2 { "two words".to_owned() } else { format!("{count} words") };
        let problem = RULE
            .problem(*span, format!("`{written}` is {words} without a blank between them"))
            .help(format!("write `{apart}`"));
        let (title, edit) = (format!("write `{apart}`"), edit(context, *span, apart));
        if self.is_certain { problem.fix(title, [edit]) } else { problem.suggestion(title, [edit]) }
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use super::*;
    use crate::diagnostics::testing::check;

    const PARTS: &str = "wheel a with radius 4.5\nwheel b with radius 4.5\nsensor s\n\
         robot r type tw with port 1 has { a b } wheels with sensors { s }\n";

    #[test]
    fn a_word_is_divided_at_keywords() {
        assert_eq!(divisions("metersturn")[0], ["meters", "turn"]);
        assert_eq!(divisions("metersturnleft90")[0], ["meters", "turn", "left", "90"]);
        assert_eq!(divisions("wheelHa"), [["wheel", "Ha"], ["wheelH", "a"]]);
        assert_eq!(divisions("detect4"), Vec::<Vec<&str>>::new());
    }

    #[test]
    fn two_words_without_a_blank_are_separated() {
        let movement = |action: &str| format!("{PARTS}movement m of r {{ {action} }}");
        check(
            &movement("move 2 metersturn left"),
            &expect![[r#"
            error[syntax-error] 5:26 "metersturn" `metersturn` is two words without a blank between them
              help: write `meters turn`
              fix: write `meters turn` -> movement m of r { move 2 meters turn left }
        "#]],
        );
        check(
            &movement("move 2metersturn left"),
            &expect![[r#"
            error[syntax-error] 5:25 "metersturn" `metersturn` is two words without a blank between them
              help: write `meters turn`
              fix: write `meters turn` -> movement m of r { move 2 meters turn left }
        "#]],
        );
        check(
            &movement("turn left90"),
            &expect![[r#"
            error[syntax-error] 5:24 "left90" `left90` is two words without a blank between them
              help: write `left 90`
              fix: write `left 90` -> movement m of r { turn left 90 }
        "#]],
        );
        check(
            &movement("move4 meters"),
            &expect![[r#"
            error[syntax-error] 5:19 "move4" `move4` is two words without a blank between them
              help: write `move 4`
              fix: write `move 4` -> movement m of r { move 4 meters }
        "#]],
        );
        check(
            &movement("turnleft turn right"),
            &expect![[r#"
            error[syntax-error] 5:19 "turnleft" `turnleft` is two words without a blank between them
              help: write `turn left`
              fix: write `turn left` -> movement m of r { turn left turn right }
        "#]],
        );
        check(
            &movement("turn left turn rightuntil { s }"),
            &expect![[r#"
            error[syntax-error] 5:34 "rightuntil" `rightuntil` is two words without a blank between them
              help: write `right until`
              fix: write `right until` -> movement m of r { turn left turn right until { s } }
        "#]],
        );
        check(
            "wheel a with radius4.5",
            &expect![[r#"
            error[syntax-error] 1:14 "radius4" `radius4` is two words without a blank between them
              help: write `radius 4`
              fix: write `radius 4` -> wheel a with radius 4.5
        "#]],
        );
    }

    #[test]
    fn a_keyword_and_a_name_without_a_blank_are_separated() {
        let wheels = "wheel a with radius 4.5\nwheel b with radius 4.5\n";
        check(
            &format!("{wheels}robotr type tw with port 1 has {{ a b }} wheels"),
            &expect![[r#"
            error[syntax-error] 3:1 "robotr" `robotr` is two words without a blank between them
              help: write `robot r`
              suggestion: write `robot r` -> robot r type tw with port 1 has { a b } wheels
        "#]],
        );
        check(
            &format!("{PARTS}movement m ofr {{ turn left }}"),
            &expect![[r#"
            error[syntax-error] 5:12 "ofr" `ofr` is two words without a blank between them
              help: write `of r`
              suggestion: write `of r` -> movement m of r { turn left }
        "#]],
        );
        check(
            &format!("{PARTS}movementm of r {{ turn left }}"),
            &expect![[r#"
            error[syntax-error] 5:1 "movementm" `movementm` is two words without a blank between them
              help: write `movement m`
              suggestion: write `movement m` -> movement m of r { turn left }
        "#]],
        );
        check(
            "wheelHa with radius 4.5",
            &expect![[r#"
            error[syntax-error] 1:1 "wheelHa" `wheelHa` is two words without a blank between them
              help: write `wheelH a`
              suggestion: write `wheelH a` -> wheelH a with radius 4.5
        "#]],
        );
        check(
            "wheel a withradius 4.5",
            &expect![[r#"
            error[syntax-error] 1:9 "withradius" `withradius` is two words without a blank between them
              help: write `with radius`
              fix: write `with radius` -> wheel a with radius 4.5
        "#]],
        );
        check(
            &format!("{PARTS}environmente has {{ r }} robots"),
            &expect![[r#"
            error[syntax-error] 5:1 "environmente" `environmente` is two words without a blank between them
              help: write `environment e`
              suggestion: write `environment e` -> environment e has { r } robots
        "#]],
        );
    }

    #[test]
    fn a_name_that_contains_a_keyword_is_left_alone() {
        check(
            &format!("{PARTS}movement format of r {{ turn left turnleft_2 }}"),
            &expect![[r#"
                error[syntax-error] 5:34 "turnleft_2" unexpected `turnleft_2`: not an action
                  help: an action is written `move 4.0 meters`, `turn left 90`, `wait 2 seconds`, `repeat 4 times { ACTIONS }`, `if { SENSORS } detect { ACTIONS }`, `do MOVEMENT` or `slam`
                  suggestion: remove `turnleft_2` -> movement format of r { turn left }
            "#]],
        );
        check(
            "wheel wheelat of radius 4.5",
            &expect![[r#"
            error[syntax-error] 1:15 "of" expected `with`, found `of`
              help: a wheel is written `wheel NAME with radius CENTIMETRES`
              suggestion: change to `with` -> wheel wheelat with radius 4.5
        "#]],
        );
    }
}
