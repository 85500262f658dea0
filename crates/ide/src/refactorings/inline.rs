//! Inline a movement: replaces a `do` by the movement's actions. The movement stays; if nothing uses it any more, a hint
//! offers to remove it.

use pydslrep_analysis::{Database, EntityId, EntityRef};
use pydslrep_syntax::ast::{Action, Entity, Movement, Name};
use pydslrep_syntax::{EntityKind, Span};
use rustc_hash::FxHashSet;

use super::rows::Row;
use super::{Refactoring, RefactoringKind, Selection};
use crate::cursor::named_robot;

/// The refactoring for the chosen `do`.
pub(super) fn inline(selection: &Selection<'_>) -> Option<Refactoring> {
    let (row, action) = selection.action()?;
    let name = action.done()?;
    let title = format!("inline movement `{}`", name.text);
    let done = Done::find(selection, name)?;
    if let Some(reason) = done.obstacle(&row) {
        return Some(Refactoring::unavailable(title, RefactoringKind::Inline, reason));
    }
    let comments = selection.comment_lines(action.span);
    let edit = selection.rewrite(&[selection.in_place_of(action.span, &comments, &done.text())])?;
    Some(Refactoring::new(title, RefactoringKind::Inline, vec![edit]))
}

/// A movement that is done.
struct Done<'a> {
    database: &'a Database,
    entity: EntityRef<'a>,
    movement: &'a Movement,
    body: Span,
}

impl<'a> Done<'a> {
    /// `None` where it is not known or has syntax errors.
    fn find(selection: &Selection<'a>, name: &Name) -> Option<Self> {
        let Selection { database, file, .. } = *selection;
        let [id] = database.candidates(file, EntityKind::Movement, &name.text)[..] else { return None };
        let entity = database.entity(id)?;
        let Some(Entity::Movement(movement)) = &entity.parse.entity else { return None };
        let body = movement.body.filter(|_| entity.parse.errors.is_empty())?;
        Some(Self { database, entity, movement, body })
    }

    fn obstacle(&self, row: &Row<'_>) -> Option<String> {
        let name = self.movement.name.as_ref().map_or("", |name| name.text.as_str());
        if self.movement.actions.is_empty() {
            return Some(format!("`{name}` has no actions"));
        }
        let robot = named_robot(self.database, self.entity.file, self.movement);
        if robot.is_none() || robot != named_robot(self.database, row.selection.file, row.movement) {
            return Some(format!("`{name}` is not of the same robot"));
        }
        if does(self.database, self.entity.id, row.selection.entity.id) {
            return Some(format!("`{name}` does itself"));
        }
        if let Some(other) = self.changed_name(row) {
            return Some(format!("`{}` means something else here than in the file of `{name}`", other.text));
        }
        let fits = row.has_room(&self.movement.actions, 0);
        (!fits).then(|| "too many blocks would be one in another".to_owned())
    }

    /// A name in its actions that is not the same in the file of the `do`.
    fn changed_name(&self, row: &Row<'_>) -> Option<&'a Name> {
        let (here, there) = (row.selection.file, self.entity.file);
        let references = self.entity.parse.entity.as_ref()?.references().into_iter();
        let mut used = references.filter(|(_, name)| self.body.start <= name.span.start);
        let resolve = |file, kind, name: &Name| self.database.resolve(file, kind, &name.text).entity();
        let changes = |kind, name| {
            let intended = resolve(there, kind, name);
            here != there && (intended.is_none() || intended != resolve(here, kind, name))
        };
        used.find(|(kind, name)| changes(*kind, *name)).map(|(_, name)| name)
    }

    /// The text between its braces.
    fn text(&self) -> String {
        let inner = Span::new(self.body.start + 1, self.body.end.saturating_sub(1));
        self.database.slice(self.entity.file, inner.shifted(self.entity.span.start))
    }
}

/// Returns whether a movement does itself or another one, directly or through others.
fn does(database: &Database, movement: EntityId, other: EntityId) -> bool {
    let mut seen = FxHashSet::default();
    let mut open = vec![movement];
    while let Some(id) = open.pop() {
        if id == other {
            return true;
        }
        let Some(entity) = database.entity(id) else { continue };
        let Some(Entity::Movement(tree)) = &entity.parse.entity else { continue };
        let names = tree.all_actions().filter_map(Action::done);
        let done =
            names.filter_map(|name| database.resolve(entity.file, EntityKind::Movement, &name.text).entity());
        for id in done {
            if id == movement {
                return true;
            }
            if seen.insert(id) {
                open.push(id);
            }
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use crate::fixture::PARTS;
    use crate::refactorings::testing::{check_importing, check_only_whole};

    const SIDE: &str = "movement side of rover {\n  // ahead\n  move 1 meters // far\n  turn left\n}\n";

    fn program(actions: &str) -> String {
        format!(
            "{PARTS}{SIDE}movement tour of rover {{\n{actions}\n}}\n\
             environment yard has {{ rover }} robots with {{ tour }} moves\n"
        )
    }

    #[test]
    fn the_actions_in_the_place_of_a_do() {
        let check =
            |actions: &str, expected: &Expect| check_only_whole("inline", &program(actions), expected);
        check(
            "  slam\n  $0do side\n  slam",
            &expect![[r#"
            Inline: inline movement `side`
                |   // ahead
                |   move 1 meters // far
                |   turn left
        "#]],
        );
        check(
            "  repeat 4 times { do /* again */ si$0de }",
            &expect![[r#"
            Inline: inline movement `side`
                |   repeat 4 times {
                |     /* again */
                |     // ahead
                |     move 1 meters // far
                |     turn left
                |   }
        "#]],
        );
        check(
            "  $0do side // there\n  do side",
            &expect![[r#"
            Inline: inline movement `side`
                |   // ahead
                |   move 1 meters // far
                |   turn left // there
        "#]],
        );
    }

    #[test]
    fn comments_beside_it_are_laid_out_with_it() {
        let program = program("  slam /* a\n * b */ do side /* c\n * d */").replace("do side", "do $0side");
        let program = program.replace("turn left\n", "turn left /* // */\n");
        check_only_whole(
            "inline",
            &program,
            &expect![[r#"
            Inline: inline movement `side`
                |  * b */ // ahead
                |   move 1 meters // far
                |   turn left /* // */ /* c
        "#]],
        );
    }

    #[test]
    fn a_comment_at_the_end_swallows_nothing() {
        let program = program("  $0do side wait 1 seconds").replace("turn left\n", "turn left // ho\n");
        check_only_whole(
            "inline",
            &program,
            &expect![[r#"
            Inline: inline movement `side`
                |   // ahead
                |   move 1 meters // far
                |   turn left // ho
                |   wait 1 seconds
        "#]],
        );
    }

    #[test]
    fn what_means_something_else_is_not_inlined() {
        let others = |side: &str| [("parts.pyr", format!("{PARTS}sensor own\n{side}"))];
        let tour = "import \"parts.pyr\"\n$1movement tour of rover { $0do side }";
        let check = |own: &str, side: &str, expected: &Expect| {
            let others = others(side);
            let others = others.each_ref().map(|(path, text)| (*path, text.as_str()));
            check_importing("inline", &others, &tour.replace("$1", own), expected);
        };
        let side = "movement side of rover { turn left until { front } }";
        check(
            "",
            side,
            &expect![[r#"
            Inline: inline movement `side`
                | movement tour of rover {
                |   turn left until { front }
                | }
        "#]],
        );
        check(
            "sensor front\n",
            side,
            &expect![[r#"
            Inline: inline movement `side`
              not here: `front` means something else here than in the file of `side`
        "#]],
        );
        check("", &side.replace("turn", "tun"), &expect![[""]]);
        let robot = "robot rover type tw with port 1 has { wheelL wheelR } wheels\n";
        check(
            robot,
            side,
            &expect![[r#"
            Inline: inline movement `side`
              not here: `side` is not of the same robot
        "#]],
        );
    }

    #[test]
    fn not_everywhere() {
        let check = |program: &str, expected: &Expect| check_only_whole("inline", program, expected);
        check(&program("  $0do nothing"), &expect![[""]]);
        check(
            &program("  $0do tour"),
            &expect![[r#"
            Inline: inline movement `tour`
              not here: `tour` does itself
        "#]],
        );
        let around = program("  $0do side").replace("turn left", "do tour");
        check(
            &around,
            &expect![[r#"
            Inline: inline movement `side`
              not here: `side` does itself
        "#]],
        );
        check(&program("  $0do side").replace(SIDE, &SIDE.repeat(2)), &expect![[""]]);
        check(
            &program("  $0do side").replace(SIDE, "movement side of rover { }\n"),
            &expect![[r#"
            Inline: inline movement `side`
              not here: `side` has no actions
        "#]],
        );
        let deep = "repeat 2 times { ".repeat(16) + "$0do side" + &" }".repeat(16);
        let side = |actions: &str| SIDE.replace("turn left", actions);
        check(
            &program(&deep).replace(SIDE, &side("repeat 2 times { slam }")),
            &expect![[r#"
            Inline: inline movement `side`
              not here: too many blocks would be one in another
        "#]],
        );
    }
}
