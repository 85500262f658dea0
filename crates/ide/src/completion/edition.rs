//! Leaves of the items only those that the edition of the file has.

use pydslrep_analysis::Edition;
use pydslrep_analysis::diagnostics::beyond_article;
use pydslrep_syntax::{EntityKind, Expected, TokenKind, lex, parse};

use super::context::CompletionContext;
use super::{Completion, CompletionKind};

/// Drops the items for `expected` that the edition of the file does not have.
pub(super) fn retain(context: &CompletionContext<'_>, expected: Expected, items: &mut Vec<Completion>) {
    if context.database.edition(context.file) != Edition::Article {
        return;
    }
    let is_movement = context.movement().is_some();
    match expected {
        Expected::Path => items.clear(),
        // After `do`.
        Expected::ReferenceTo(EntityKind::Movement) if is_movement => items.clear(),
        _ => {
            let written = written(context);
            let before = extensions(written);
            items.retain(|item| {
                let is_name = !matches!(item.kind, CompletionKind::Keyword | CompletionKind::Snippet);
                let fits = is_name || !(is_movement && begins_with_new_word(item));
                let text = format!("{written} {}", item.plain());
                fits && item.imports.is_none() && (is_name || extensions(&text) <= before)
            });
        }
    }
}

/// Returns the entity's text before the word at the cursor.
fn written<'a>(context: &'a CompletionContext<'_>) -> &'a str {
    let end = context.before.last().map_or(0, |(_, span)| span.end);
    context.text.get(..end as usize).unwrap_or_default()
}

/// Returns the number of words and forms in a text that are not in the article's edition.
fn extensions(text: &str) -> usize {
    let pieces = parse(text).into_iter();
    pieces.filter_map(|(_, parse)| Some(beyond_article(&parse.entity?, &parse.tokens).len())).sum()
}

/// Returns whether an item in a movement begins with a keyword that the article does not have. In a statement that has
/// others already, the number of its extensions does not show that.
fn begins_with_new_word(item: &Completion) -> bool {
    lex(&item.plain()).first().is_some_and(|(token, _)| TokenKind::CONTEXTUAL.contains(token))
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};
    use pydslrep_analysis::Edition;

    use crate::fixture::{PARTS, at_cursor_in};
    use crate::{CompletionTrigger, completions};

    /// Checks what is offered in a movement in the article's edition and, after a bar, what is not.
    #[track_caller]
    fn check(program: &str, expected: &Expect) {
        let files = [("test.pyr", program), ("other.pyr", "sensor elsewhere")];
        let (mut database, position) = at_cursor_in(&files);
        let mut labels = |edition| {
            database.set_edition(position.file, edition);
            let items = completions(&database, position, CompletionTrigger::Invoked, 9.0);
            items.into_iter().map(|item| item.label).collect::<Vec<_>>()
        };
        let (all, mut offered) = (labels(Edition::Current), labels(Edition::Article));
        assert!(offered.iter().all(|label| all.contains(label)), "{offered:?}");
        let mut missing: Vec<String> = all.into_iter().filter(|label| !offered.contains(label)).collect();
        offered.dedup();
        missing.dedup();
        expected.assert_eq(&format!("{}\n| {}\n", offered.join(", "), missing.join(", ")));
    }

    fn movement(actions: &str) -> String {
        format!("{PARTS}movement side of rover {{ slam }}\nmovement m of rover {{ {actions}")
    }

    #[test]
    fn actions_are_those_of_the_article() {
        check(
            &movement("$0"),
            &expect![[r#"
                move … meters, move … meters at …, move … centimeters, move … centimeters at …, turn left, turn right, turn left …, turn right …, turn left until …, move, turn, slam, }
                | move until … detect, turn left … with radius …, turn right … with radius …, repeat … times { … }, repeat until … detect { … }, wait … seconds, wait until … clear, if … detect { … }, do …, wait, repeat, if, do
            "#]],
        );
        check(
            &movement("turn left $0 }"),
            &expect![[r#"
                until, move … meters, move … meters at …, move … centimeters, move … centimeters at …, turn left, turn right, turn left …, turn right …, turn left until …, move, turn, slam, }
                | with radius …, with radius, at …, at, until … clear, until … detect, in reverse, move until … detect, turn left … with radius …, turn right … with radius …, repeat … times { … }, repeat until … detect { … }, wait … seconds, wait until … clear, if … detect { … }, do …, wait, repeat, if, do
            "#]],
        );
    }

    #[test]
    fn clauses_are_those_of_the_article() {
        check(
            &movement("move 2 meters $0 }"),
            &expect![[r#"
                at …, at, turn left, turn right, turn left …, turn right …, turn left until …, move … meters, move … meters at …, move … centimeters, move … centimeters at …, move, turn, slam, }
                | until … detect, until … clear, until, turn left … with radius …, turn right … with radius …, move until … detect, repeat … times { … }, repeat until … detect { … }, wait … seconds, wait until … clear, if … detect { … }, do …, wait, repeat, if, do
            "#]],
        );
        check(
            &movement("turn left until { front } $0 }"),
            &expect![[r#"
                move … meters, move … meters at …, move … centimeters, move … centimeters at …, turn left until …, turn left, turn right, turn left …, turn right …, move, turn, slam, }
                | clear, detect, within, move until … detect, turn left … with radius …, turn right … with radius …, repeat … times { … }, repeat until … detect { … }, wait … seconds, wait until … clear, if … detect { … }, do …, wait, repeat, if, do
            "#]],
        );
    }

    #[test]
    fn what_goes_on_with_an_extension_is_not_offered() {
        check(
            &movement("repeat 4 $0 }"),
            &expect![[r#"

                | times { … }, times
            "#]],
        );
        check(
            &movement("wait 4 $0 }"),
            &expect![[r#"

                | seconds
            "#]],
        );
        check(
            &movement("do $0 }"),
            &expect![[r#"

                | side
            "#]],
        );
    }

    #[test]
    fn nothing_is_imported() {
        check(
            "$0",
            &expect![[r#"
                program …, wheel …, wheelH …, sensor …, ip …, robot …, movement …, parallel movement …, environment …, wheel, wheelH, sensor, ip, robot, movement, parallel, environment
                | import …, import
            "#]],
        );
        check(
            "import $0",
            &expect![[r#"

                | "other.pyr"
            "#]],
        );
        check(
            "import \"$0\"",
            &expect![[r#"

                | other.pyr
            "#]],
        );
    }
}
