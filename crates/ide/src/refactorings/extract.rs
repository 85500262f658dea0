//! Extract actions into a new movement of the same robot, which is done in their place.

use pydslrep_analysis::{Database, Edit, Edition, FileId};
use pydslrep_syntax::ast::{Action, Movement};
use pydslrep_syntax::{EntityKind, Span, TokenKind, format};
use smol_str::{SmolStr, format_smolstr};

use super::{Refactoring, RefactoringKind, Selection};

/// The refactoring for selected actions; a cursor selects none. It leaves `do`, which the article does not have.
pub(super) fn extract(selection: &Selection<'_>) -> Option<Refactoring> {
    let is_article = selection.database.edition(selection.file) == Edition::Article;
    if selection.range.is_empty() || is_article {
        return None;
    }
    let parts = Parts::find(selection)?;
    Some(match parts.edits() {
        Ok((name, edits)) => {
            Refactoring::new(format!("extract into new movement `{name}`"), RefactoringKind::Extract, edits)
        }
        Err(reason) => {
            Refactoring::unavailable("extract into a new movement", RefactoringKind::Extract, reason)
        }
    })
}

/// The innermost block around the selection, and its selected actions.
struct Parts<'a> {
    selection: &'a Selection<'a>,
    movement: &'a Movement,
    /// From brace to brace.
    block: Span,
    actions: &'a [Action],
    first: usize,
    /// The index after the last selected action.
    end: usize,
}

impl<'a> Parts<'a> {
    fn find(selection: &'a Selection<'_>) -> Option<Self> {
        let (movement, range) = (selection.movement()?, selection.range);
        let (mut block, mut actions) = (movement.body?, &movement.actions[..]);
        loop {
            let selected = |action: &&Action| action.span.start < range.end && range.start < action.span.end;
            let mut inside = actions.iter().filter(selected).flat_map(Action::blocks);
            match inside.find(|inner| inner.span.start < range.start && range.end < inner.span.end) {
                Some(inner) => (block, actions) = (inner.span, &inner.actions),
                None => break,
            }
        }
        let selected = |index: &usize| {
            let span = actions[*index].span;
            span.start < range.end && range.start < span.end
        };
        let mut indices = (0..actions.len()).filter(selected);
        let first = indices.next()?;
        let end = indices.next_back().unwrap_or(first) + 1;
        Some(Self { selection, movement, block, actions, first, end })
    }

    fn edits(&self) -> Result<(SmolStr, Vec<Edit>), String> {
        let broken = || "the movement is incomplete".to_owned();
        let name = self.movement.name.as_ref().ok_or_else(broken)?;
        let body = self.movement.body.ok_or_else(broken)?;
        if self.block == body && self.first == 0 && self.end == self.actions.len() {
            return Err(format!("these are all actions of `{}`; select only some of them", name.text));
        }
        let new = free_name(self.selection.database, self.selection.file, &name.text).ok_or_else(broken)?;
        let bounds = self.bounds();
        let cut = Span::new(bounds[self.first], bounds[self.end]);
        let added = self.entity(&new, cut).ok_or_else(broken)?;
        let edits = vec![
            self.selection.edit(cut, self.call(&new, cut)),
            self.selection.edit(Span::at(self.entity_end(body)), added),
        ];
        Ok((new, edits))
    }

    /// What does the new movement, in the place of its actions.
    fn call(&self, new: &str, cut: Span) -> String {
        let removed = self.selection.text(cut);
        let blank = &removed[..removed.len() - removed.trim_start().len()];
        let after = self.selection.text(Span::new(cut.end, self.block.end));
        // Nothing else would separate the name from the next word.
        let gap = if after.starts_with(|next: char| next.is_whitespace() || "}/".contains(next)) {
            ""
        } else {
            " "
        };
        let before = if blank.is_empty() { " " } else { blank };
        let word = TokenKind::Do.spelling().unwrap_or_default();
        format!("{before}{word} {new}{gap}")
    }

    /// The offsets that separate the actions: before the first, between two, after the last. Text on the line of an action
    /// or on the lines before it belongs to the action.
    fn bounds(&self) -> Vec<u32> {
        let (actions, body) = (self.actions, self.block);
        let ends = std::iter::once(body.start + 1).chain(actions.iter().map(|action| action.span.end));
        let starts = actions.iter().map(|action| action.span.start).chain([body.end.saturating_sub(1)]);
        let mut bounds: Vec<u32> = ends
            .zip(starts)
            .map(|(end, start)| {
                let gap = Span::new(end, start);
                self.line_end(gap).unwrap_or_else(|| self.after_comments(gap))
            })
            .collect();
        if let (Some(last), Some(action)) = (bounds.last_mut(), actions.last()) {
            *last = self.after_comments(Span::new(action.span.end, body.end.saturating_sub(1)));
        }
        bounds
    }

    /// The first line break in a gap that is not inside a comment.
    fn line_end(&self, gap: Span) -> Option<u32> {
        let text = self.selection.text(gap);
        let ends = (gap.start..).zip(text.bytes()).filter(|(_, byte)| matches!(byte, b'\n' | b'\r'));
        let mut ends = ends.map(|(at, _)| at);
        ends.find(|at| !self.comments(gap).any(|comment| comment.start <= *at && *at < comment.end))
    }

    fn after_comments(&self, gap: Span) -> u32 {
        self.comments(gap).last().map_or(gap.start, |comment| comment.end)
    }

    fn comments(&self, gap: Span) -> impl Iterator<Item = Span> {
        let tokens = self.selection.entity.parse.tokens.iter();
        let inside = move |span: &Span| gap.start <= span.start && span.end <= gap.end;
        tokens.filter(|(token, _)| token.is_comment()).map(|(_, span)| *span).filter(inside)
    }

    /// The offset for a new entity after this one: the end of the line.
    fn entity_end(&self, body: Span) -> u32 {
        let end = self.selection.entity.span.len();
        let after = Span::new(body.end, end);
        let next = self.selection.database.entity_at(self.selection.file, self.selection.entity.span.end);
        let is_last = next.is_none_or(|next| next.id == self.selection.entity.id);
        self.line_end(after).unwrap_or(if is_last { self.after_comments(after) } else { body.end })
    }

    /// The text of a new movement with the actions in a range, to be inserted after an entity.
    fn entity(&self, name: &str, actions: Span) -> Option<String> {
        let line_end = self.selection.database.line_ending(self.selection.file);
        let robot = self.selection.text(self.movement.robot.as_ref()?.span);
        let actions = self.selection.text(actions);
        let whole = format!("movement {name} of {robot} {{{line_end}{actions}{line_end}}}{line_end}");
        Some(format!("{line_end}{line_end}{}", format(&whole).trim_end()))
    }
}

/// A name for a part of a movement that is unused in all files that can see it.
fn free_name(database: &Database, file: FileId, name: &SmolStr) -> Option<SmolStr> {
    let files: Vec<FileId> = std::iter::once(file).chain(database.importing(file)).collect();
    let is_taken = |name: &SmolStr| {
        files.iter().any(|file| {
            !database.candidates(*file, EntityKind::Movement, name).is_empty()
                || !database.users(*file, EntityKind::Movement, name).is_empty()
                || database.may_hide(*file, name)
        })
    };
    (2..u32::MAX).map(|number| format_smolstr!("{name}_{number}")).find(|name| !is_taken(name))
}

#[cfg(test)]
mod tests {
    use expect_test::expect;
    use pydslrep_analysis::Edition;

    use crate::fixture::{PARTS, at_cursor};
    use crate::refactorings::refactorings;
    use crate::refactorings::testing::check;

    #[test]
    fn not_in_the_edition_of_the_article() {
        let text = format!("{PARTS}movement tour of rover {{ turn left $0slam turn right }}");
        let (mut database, position) = at_cursor(&text);
        let range = pydslrep_syntax::Span::new(position.offset, position.offset + 4);
        let mut titles = |edition| {
            database.set_edition(position.file, edition);
            let found = refactorings(&database, position.file, range);
            found.into_iter().map(|offer| offer.title).collect::<Vec<_>>()
        };
        let title = "extract into new movement `tour_2`".to_owned();
        assert!(titles(Edition::Current).contains(&title));
        assert!(!titles(Edition::Article).iter().any(|title| title.contains("extract")));
    }

    #[test]
    fn from_the_middle() {
        check(
            "  // ahead\n  move 4.0 meters // far\n  // around\n  $0turn left // ho\n  turn$0 left\n\n  // back\n  move 1 meters\n  // done",
            &expect![[r#"
                Rewrite: convert all moves of `tour` to centimeters
                    |   move 400.0 centimeters // far
                    |   // around
                    |   turn left // ho
                    |   turn left
                    | 
                    |   // back
                    |   move 100 centimeters
                Rewrite: make the default speed explicit in all moves of `tour`
                    |   move 4.0 meters at 9.0 // far
                    |   // around
                    |   turn left // ho
                    |   turn left
                    | 
                    |   // back
                    |   move 1 meters at 9.0
                Extract: extract into new movement `tour_2`
                    |   do tour_2
                    | 
                    |   // back
                    |   move 1 meters
                    |   // done
                    | }
                    | 
                    | movement tour_2 of rover {
                    |   // around
                    |   turn left // ho
                    |   turn left
            "#]],
        );
    }

    #[test]
    fn from_the_start_and_from_the_end() {
        check(
            "  $0move 4 meters\n  turn$0 left\n  move 1 meters",
            &expect![[r#"
                Rewrite: convert to centimeters
                    |   move 400 centimeters
                Rewrite: convert all moves of `tour` to centimeters
                    |   move 400 centimeters
                    |   turn left
                    |   move 100 centimeters
                Rewrite: make the default speed explicit
                    |   move 4 meters at 9.0
                Rewrite: make the default speed explicit in all moves of `tour`
                    |   move 4 meters at 9.0
                    |   turn left
                    |   move 1 meters at 9.0
                Extract: extract into new movement `tour_2`
                    |   do tour_2
                    |   move 1 meters
                    | }
                    | 
                    | movement tour_2 of rover {
                    |   move 4 meters
                    |   turn left
            "#]],
        );
        check(
            "  move 4 meters\n  turn left $0move 1 meters$0",
            &expect![[r#"
                Rewrite: convert to centimeters
                    |   turn left move 100 centimeters
                Rewrite: convert all moves of `tour` to centimeters
                    |   move 400 centimeters
                    |   turn left move 100 centimeters
                Rewrite: make the default speed explicit
                    |   turn left move 1 meters at 9.0
                Rewrite: make the default speed explicit in all moves of `tour`
                    |   move 4 meters at 9.0
                    |   turn left move 1 meters at 9.0
                Extract: extract into new movement `tour_2`
                    |   turn left do tour_2
                    | }
                    | 
                    | movement tour_2 of rover {
                    |   move 1 meters
            "#]],
        );
    }

    #[test]
    fn all_actions_or_none_cannot_be_extracted() {
        check(
            "  $0move 4 centimeters\n  slam$0",
            &expect![[r#"
                Rewrite: convert to meters
                    |   move 0.04 meters
                Rewrite: make the default speed explicit
                    |   move 4 centimeters at 9.0
                Extract: extract into a new movement
                  not here: these are all actions of `tour`; select only some of them
            "#]],
        );
        check(
            "  move $04 meters at 10",
            &expect![[r#"
                Rewrite: convert to centimeters
                    |   move 400 centimeters at 10
            "#]],
        );
    }

    #[test]
    fn from_a_block() {
        check(
            "  repeat 4 times {\n    move 1 meters\n    $0turn left\n    wait 2 seconds$0\n    slam\n  }",
            &expect![[r#"
                Rewrite: convert all moves of `tour` to centimeters
                    |     move 100 centimeters
                Rewrite: make the default speed explicit in all moves of `tour`
                    |     move 1 meters at 9.0
                Extract: extract into new movement `tour_2`
                    |     do tour_2
                    |     slam
                    |   }
                    | }
                    | 
                    | movement tour_2 of rover {
                    |   turn left
                    |   wait 2 seconds
            "#]],
        );
        check(
            "  repeat 4 times {$0 turn left$0}\n  if { front } clear { slam } else { wait 1 seconds }",
            &expect![[r#"
                Extract: extract into new movement `tour_2`
                    |   repeat 4 times { do tour_2}
                    |   if { front } clear { slam } else { wait 1 seconds }
                    | }
                    | 
                    | movement tour_2 of rover {
                    |   turn left
            "#]],
        );
    }
}
