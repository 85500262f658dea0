//! Extract actions into a new movement of the same robot, which is done in their place.

use pydslrep_analysis::{Database, Edit, FileId};
use pydslrep_syntax::{EntityKind, Span, TokenKind, format};
use smol_str::{SmolStr, format_smolstr};

use super::rows::Row;
use super::{Refactoring, RefactoringKind, Selection};

/// The refactoring for selected actions; a cursor selects none.
pub(super) fn extract(selection: &Selection<'_>) -> Option<Refactoring> {
    if selection.range.is_empty() {
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

/// The innermost row around the selection, and its selected actions.
struct Parts<'a> {
    row: Row<'a>,
    first: usize,
    /// The index after the last selected action.
    end: usize,
}

impl<'a> Parts<'a> {
    fn find(selection: &Selection<'a>) -> Option<Self> {
        let (row, range) = (selection.rows().pop()?, selection.range);
        let selected = |index: &usize| {
            let span = row.actions[*index].span;
            span.start < range.end && range.start < span.end
        };
        let mut indices = (0..row.actions.len()).filter(selected);
        let first = indices.next()?;
        let end = indices.next_back().unwrap_or(first) + 1;
        Some(Self { row, first, end })
    }

    fn edits(&self) -> Result<(SmolStr, Vec<Edit>), String> {
        let broken = || "the movement is incomplete".to_owned();
        let (row, selection) = (self.row, self.row.selection);
        let name = row.movement.name.as_ref().ok_or_else(broken)?;
        let body = row.movement.body.ok_or_else(broken)?;
        if row.braces == body && self.first == 0 && self.end == row.actions.len() {
            return Err(format!("these are all actions of `{}`; select only some of them", name.text));
        }
        let new = free_name(selection.database, selection.file, &name.text).ok_or_else(broken)?;
        let cut = Span::new(row.bound(self.first), self.cut_end());
        let added = self.entity(&new, cut).ok_or_else(broken)?;
        let edits = vec![
            selection.edit(cut, self.call(&new, cut)),
            selection.edit(Span::at(self.entity_end(body)), added),
        ];
        Ok((new, edits))
    }

    /// Returns the `do` action that replaces the extracted actions.
    fn call(&self, new: &str, cut: Span) -> String {
        let removed = self.row.selection.text(cut);
        let blank = &removed[..removed.len() - removed.trim_start().len()];
        let after = self.row.selection.text(Span::new(cut.end, self.row.braces.end));
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

    /// Returns the end of the cut: text after the last action of a row is moved along.
    fn cut_end(&self) -> u32 {
        if self.end < self.row.actions.len() {
            self.row.bound(self.end)
        } else {
            self.row.after_comments(self.row.gap(self.end))
        }
    }

    /// The offset for a new entity after this one: the end of the line.
    fn entity_end(&self, body: Span) -> u32 {
        let Selection { database, file, entity, .. } = self.row.selection;
        let after = Span::new(body.end, entity.span.len());
        let next = database.entity_at(file, entity.span.end);
        let is_last = next.is_none_or(|next| next.id == entity.id);
        let end = || if is_last { self.row.after_comments(after) } else { body.end };
        self.row.line_end(after).unwrap_or_else(end)
    }

    /// The text of a new movement with the actions in a range, to be inserted after an entity.
    fn entity(&self, name: &str, actions: Span) -> Option<String> {
        let Row { selection, movement, .. } = self.row;
        let line_end = selection.database.line_ending(selection.file);
        let robot = selection.text(movement.robot.as_ref()?.span);
        let actions = selection.text(actions);
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

    use crate::refactorings::testing::check;

    #[test]
    fn from_the_middle() {
        check(
            "  // ahead\n  move 4.0 meters // far\n  // around\n  $0turn left // ho\n  turn$0 left\n\n  // back\n  move 1 meters\n  // done",
            &expect![[r#"
                Rewrite: convert all lengths of `tour` to centimeters
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
                Rewrite: roll up into `repeat 2 times`
                    |   repeat 2 times {
                    |     turn left // ho
                    |   }
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
                Rewrite: convert all lengths of `tour` to centimeters
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
                Rewrite: convert all lengths of `tour` to centimeters
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
                Rewrite: convert all lengths of `tour` to centimeters
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
                Rewrite: turn on a circle of 1.0 meters (changes the path)
                    |   repeat 4 times {
                    |     turn left with radius 1.0 meters
                    |   }
            "#]],
        );
    }
}
