//! Extract actions into a new movement of the same robot. Wherever the movement is listed, its parts are listed in order,
//! so that the robot does the same as before.

use pydslrep_analysis::{Database, Edit, FileId, FileSpan};
use pydslrep_syntax::ast::{Entity, Movement};
use pydslrep_syntax::{EntityKind, Span, format};
use smol_str::{SmolStr, format_smolstr};

use super::{Refactoring, RefactoringKind, Selection};
use crate::rename::is_separated;

/// The refactoring for selected actions; a cursor selects none.
pub(super) fn extract(selection: &Selection<'_>) -> Option<Refactoring> {
    if selection.range.is_empty() {
        return None;
    }
    let movement = selection.movement()?;
    let selected = |index: &usize| {
        let span = movement.actions[*index].span;
        span.start < selection.range.end && selection.range.start < span.end
    };
    let mut indices = (0..movement.actions.len()).filter(selected);
    let first = indices.next()?;
    let parts = Parts { selection, movement, first, end: indices.next_back().unwrap_or(first) + 1 };
    Some(match parts.edits() {
        Ok((name, edits)) => {
            Refactoring::new(format!("extract into new movement `{name}`"), RefactoringKind::Extract, edits)
        }
        Err(reason) => {
            Refactoring::unavailable("extract into a new movement", RefactoringKind::Extract, reason)
        }
    })
}

/// A movement and its selected actions.
struct Parts<'a> {
    selection: &'a Selection<'a>,
    movement: &'a Movement,
    first: usize,
    /// The index after the last selected action.
    end: usize,
}

impl Parts<'_> {
    fn edits(&self) -> Result<(SmolStr, Vec<Edit>), String> {
        let (database, file) = (self.selection.database, self.selection.file);
        let broken = || "the movement is incomplete".to_owned();
        let name = self.movement.name.as_ref().ok_or_else(broken)?;
        let body = self.movement.body.ok_or_else(broken)?;
        if self.first == 0 && self.end == self.movement.actions.len() {
            return Err(format!("these are all actions of `{}`; select only some of them", name.text));
        }
        if self.movement.parallel.is_some() {
            let reason = "is parallel: its parts would start together";
            return Err(format!("`{}` {reason}", name.text));
        }
        if database.declarations(file, EntityKind::Movement, &name.text).len() != 1 {
            return Err(format!("there are several movements called `{}`", name.text));
        }
        let mut free = free_names(database, file, &name.text);
        let new = free.next().ok_or_else(broken)?;
        let rest = (self.first > 0 && self.end < self.movement.actions.len()).then(|| free.next()).flatten();
        let bounds = self.bounds(body);
        let mut added =
            self.entity(&new, Span::new(bounds[self.first], bounds[self.end])).ok_or_else(broken)?;
        let cut_end = match &rest {
            Some(rest) => {
                let end = bounds[self.movement.actions.len()];
                added += &self.entity(rest, Span::new(bounds[self.end], end)).ok_or_else(broken)?;
                end
            }
            None => bounds[self.end],
        };
        let mut edits = vec![
            self.selection
                .edit(Span::new(bounds[self.first], cut_end), self.join(bounds[self.first], cut_end)),
            self.selection.edit(Span::at(self.entity_end(body)), added),
        ];
        let is_before = self.first == 0;
        let names: Vec<&str> = [Some(new.as_str()), rest.as_deref()].into_iter().flatten().collect();
        for reference in database.references(file, EntityKind::Movement, &name.text) {
            edits.push(list_movements(database, reference, &names, is_before));
        }
        Ok((new, edits))
    }

    /// The replacement for removed text: a line break if the text before it may end in a line comment.
    fn join(&self, start: u32, end: u32) -> &'static str {
        let begins = |at| self.selection.text(Span::new(at, at + 1)).starts_with(['\n', '\r']);
        if begins(start) && !begins(end) {
            self.selection.database.line_ending(self.selection.file)
        } else {
            ""
        }
    }

    /// The offsets that separate the actions: before the first, between two, after the last. Text on the line of an action
    /// or on the lines before it belongs to the action.
    fn bounds(&self, body: Span) -> Vec<u32> {
        let actions = &self.movement.actions;
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

/// Names for the parts of a movement that are unused in all files that can list the movement.
fn free_names(database: &Database, file: FileId, name: &SmolStr) -> impl Iterator<Item = SmolStr> {
    let files: Vec<FileId> = std::iter::once(file).chain(database.importing(file)).collect();
    let is_taken = move |name: &SmolStr| {
        files.iter().any(|file| {
            !database.candidates(*file, EntityKind::Movement, name).is_empty()
                || !database.users(*file, EntityKind::Movement, name).is_empty()
                || database.may_hide(*file, name)
        })
    };
    (2_u32..).map(move |number| format_smolstr!("{name}_{number}")).filter(move |name| !is_taken(name))
}

/// The edit that lists more movements before or after a listed one.
fn list_movements(database: &Database, reference: FileSpan, names: &[&str], is_before: bool) -> Edit {
    let separator = if has_commas(database, reference) { ", " } else { " " };
    let names = names.join(separator);
    let (at, text) = if is_before {
        let gap = if is_separated(database, reference) { "" } else { " " };
        (reference.span.start, format!("{gap}{names}{separator}"))
    } else {
        (reference.span.end, format!("{separator}{names}"))
    };
    Edit { file: reference.file, span: Span::at(at), text }
}

fn has_commas(database: &Database, reference: FileSpan) -> bool {
    let Some(entity) = database.entity_at(reference.file, reference.span.start) else { return false };
    let Some(Entity::Environment(environment)) = &entity.parse.entity else { return false };
    let list = environment.movements.as_ref();
    list.is_some_and(|list| {
        database.slice(reference.file, list.span.shifted(entity.span.start)).contains(',')
    })
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
                    | }
                    | 
                    | movement tour_2 of rover {
                    |   // around
                    |   turn left // ho
                    |   turn left
                    | }
                    | 
                    | movement tour_3 of rover {
                    |   // back
                    |   move 1 meters
                    |   // done
                    | }
                    | environment yard has { rover } robots with { tour tour_2 tour_3 } moves
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
                    |   move 1 meters
                    | }
                    | 
                    | movement tour_2 of rover {
                    |   move 4 meters
                    |   turn left
                    | }
                    | environment yard has { rover } robots with { tour_2 tour } moves
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
                    |   turn left
                    | }
                    | 
                    | movement tour_2 of rover {
                    |   move 1 meters
                    | }
                    | environment yard has { rover } robots with { tour tour_2 } moves
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
}
