//! Make movements parallel or sequential. Titles say which movements then start together or one after the other. No
//! change makes a robot run two movements at once or leaves a `parallel` without effect.

use pydslrep_analysis::{Database, Edit, EntityId};
use pydslrep_syntax::ast::{Entity, Movement};
use pydslrep_syntax::{EntityKind, Span, TokenKind};

use super::{Refactoring, RefactoringKind, Selection};
use crate::cursor::named_robot;

/// The refactorings for the movement with the cursor in its header.
pub(super) fn change(selection: &Selection<'_>) -> Vec<Refactoring> {
    let Some(movement) = selection.movement() else { return Vec::new() };
    let (Some(name), Some(body)) = (&movement.name, movement.body) else { return Vec::new() };
    if selection.range.start > body.start {
        return Vec::new();
    }
    let lists = Lists::of(selection.database, selection.entity.id);
    let Some(lists) = lists else { return Vec::new() };
    if movement.parallel.is_some() {
        return vec![make_sequential(&lists, selection.entity.id)];
    }
    let offers = make_parallel(&lists, selection.entity.id);
    offers.unwrap_or_else(|reason| {
        let title = format!("make `{}` parallel", name.text);
        vec![Refactoring::no_rewrite(title, reason)]
    })
}

fn make_sequential(lists: &Lists<'_>, id: EntityId) -> Refactoring {
    let mut changed = vec![id];
    let mut next = 0;
    // A neighbour that would be the only parallel movement left becomes sequential, too.
    while let Some(&id) = changed.get(next) {
        next += 1;
        for other in lists.beside(id, |id| lists.is_parallel(id)) {
            let is_left = |id| lists.is_parallel(id) && !changed.contains(&id);
            let lists = Lists::of(lists.database, other);
            if !changed.contains(&other) && lists.is_some_and(|lists| lists.beside(other, is_left).is_empty())
            {
                changed.push(other);
            }
        }
    }
    let title = match changed[..] {
        [_] => format!("make {} sequential: it runs alone", lists.names(&changed)),
        _ => format!("make {} sequential: one runs after the other", lists.names(&changed)),
    };
    let edits = changed.iter().filter_map(|id| lists.remove_parallel(*id)).collect();
    Refactoring::new(title, RefactoringKind::Rewrite, edits)
}

fn make_parallel(lists: &Lists<'_>, id: EntityId) -> Result<Vec<Refactoring>, String> {
    let running = lists.beside(id, |id| lists.is_parallel(id));
    if !running.is_empty() {
        if let Some(conflict) = lists.conflict(&[id]) {
            return Err(conflict);
        }
        let title = format!(
            "make {} parallel: it starts together with {}",
            lists.names(&[id]),
            lists.names(&running)
        );
        let edits = lists.add_parallel(id).into_iter().collect();
        return Ok(vec![Refactoring::new(title, RefactoringKind::Rewrite, edits)]);
    }
    let neighbours = lists.beside(id, |_| true);
    if neighbours.is_empty() {
        return Err(
            "no environment lists it next to a movement that it could run in parallel with".to_owned()
        );
    }
    let mut conflicts = Vec::new();
    let mut offers = Vec::new();
    for other in neighbours {
        let both = [id, other];
        if Lists::of(lists.database, other).is_none() {
            conflicts.push(format!("an environment that lists {} is incomplete", lists.names(&[other])));
            continue;
        }
        match lists.conflict(&both) {
            Some(conflict) => conflicts.push(conflict),
            None => offers.push(Refactoring::new(
                format!("make {} parallel: they start together", lists.names(&both)),
                RefactoringKind::Rewrite,
                both.iter().filter_map(|id| lists.add_parallel(*id)).collect(),
            )),
        }
    }
    if offers.is_empty() { Err(conflicts.swap_remove(0)) } else { Ok(offers) }
}

/// The environments that list a movement.
struct Lists<'a> {
    database: &'a Database,
    /// The movements of each list, in order.
    lists: Vec<Vec<EntityId>>,
}

impl<'a> Lists<'a> {
    /// `None` if one of them has errors or unresolved names.
    fn of(database: &'a Database, movement: EntityId) -> Option<Self> {
        let file = database.file_of(movement)?;
        let name = database.tree(movement)?.name()?;
        let mut seen = Vec::new();
        let mut lists = Vec::new();
        for reference in database.references(file, EntityKind::Movement, &name.text) {
            let entity = database.entity_at(reference.file, reference.span.start)?;
            let Entity::Environment(environment) = entity.parse.entity.as_ref()? else { continue };
            if seen.contains(&entity.id) {
                continue;
            }
            seen.push(entity.id);
            if !entity.parse.errors.is_empty() {
                return None;
            }
            let names = &environment.movements.as_ref()?.names;
            let listed = names
                .iter()
                .map(|name| database.resolve(reference.file, EntityKind::Movement, &name.text).entity());
            lists.push(listed.collect::<Option<_>>()?);
        }
        Some(Self { database, lists })
    }

    fn tree(&self, id: EntityId) -> Option<&'a Movement> {
        match self.database.tree(id)? {
            Entity::Movement(movement) => Some(movement),
            _ => None,
        }
    }

    fn is_parallel(&self, id: EntityId) -> bool {
        self.tree(id).is_some_and(|movement| movement.parallel.is_some())
    }

    /// The other `wanted` movements listed right before or after a movement.
    fn beside(&self, id: EntityId, wanted: impl Fn(EntityId) -> bool) -> Vec<EntityId> {
        let mut found = Vec::new();
        for pair in self.lists.iter().flat_map(|list| list.windows(2)) {
            for (one, other) in [(pair[0], pair[1]), (pair[1], pair[0])] {
                if one == id && other != id && wanted(other) && !found.contains(&other) {
                    found.push(other);
                }
            }
        }
        found
    }

    /// Why some movements cannot become parallel: a robot would run two of them at once.
    fn conflict(&self, changed: &[EntityId]) -> Option<String> {
        let others = changed.iter().filter_map(|id| Lists::of(self.database, *id));
        let lists: Vec<Vec<EntityId>> = others.flat_map(|lists| lists.lists).collect();
        let is_parallel = |id: &EntityId| changed.contains(id) || self.is_parallel(*id);
        for group in lists.iter().flat_map(|list| list.chunk_by(|a, b| is_parallel(a) && is_parallel(b))) {
            for (index, id) in group.iter().enumerate() {
                let rival = group[..index].iter().find(|other| self.robot(**other) == self.robot(*id));
                let robot = self.tree(*id).and_then(|movement| movement.robot.as_ref());
                if let (Some(rival), Some(robot)) = (rival, robot) {
                    let what = if rival == id {
                        format!("{} twice", self.names(&[*id]))
                    } else {
                        self.names(&[*rival, *id])
                    };
                    return Some(format!("`{}` cannot run {what} at the same time", robot.text));
                }
            }
        }
        None
    }

    fn robot(&self, id: EntityId) -> Option<EntityId> {
        let file = self.database.file_of(id)?;
        named_robot(self.database, file, self.tree(id)?)
    }

    /// "`a`, `b` and `c`".
    fn names(&self, ids: &[EntityId]) -> String {
        let name = |id: &EntityId| self.tree(*id).and_then(|movement| movement.name.as_ref());
        let names: Vec<String> = ids.iter().filter_map(name).map(|name| format!("`{}`", name.text)).collect();
        match names.split_last() {
            Some((last, [])) => last.clone(),
            Some((last, before)) => format!("{} and {last}", before.join(", ")),
            None => String::new(),
        }
    }

    fn add_parallel(&self, id: EntityId) -> Option<Edit> {
        let entity = self.database.entity(id)?;
        let (_, keyword) = entity.parse.tokens.iter().find(|(token, _)| *token == TokenKind::Movement)?;
        let span = Span::at(keyword.start).shifted(entity.span.start);
        Some(Edit { file: entity.file, span, text: "parallel ".to_owned() })
    }

    fn remove_parallel(&self, id: EntityId) -> Option<Edit> {
        let entity = self.database.entity(id)?;
        let parallel = self.tree(id)?.parallel?;
        let (_, next) = entity.parse.tokens.iter().find(|(_, span)| span.start >= parallel.end)?;
        let span = Span::new(parallel.start, next.start).shifted(entity.span.start);
        Some(Edit { file: entity.file, span, text: String::new() })
    }
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use crate::refactorings::testing::check_whole;

    const ROBOTS: &str = "wheel l with radius 4\nwheel r with radius 4\nrobot a with port 1 has { l r } wheels\n\
                          robot b with port 2 has { l r } wheels\n";

    #[track_caller]
    fn check(movements: &str, list: &str, expected: &Expect) {
        check_whole(
            &format!("{ROBOTS}{movements}\nenvironment e has {{ a b }} robots with {{ {list} }} moves"),
            expected,
        );
    }

    const TWO: &str = "$0movement go of a { turn left }\nmovement come of b { turn left }\nmovement rest of a { turn left }";

    #[test]
    fn neighbours_become_parallel_together() {
        check(
            TWO,
            "go come rest",
            &expect![[r#"
                Rewrite: make `go` and `come` parallel: they start together
                    | parallel movement go of a { turn left }
                    | parallel movement come of b { turn left }
            "#]],
        );
        check(
            TWO,
            "rest go",
            &expect![[r#"
                Rewrite: make `go` parallel
                  not here: `a` cannot run `rest` and `go` at the same time
            "#]],
        );
        check(
            TWO,
            "go",
            &expect![[r#"
                Rewrite: make `go` parallel
                  not here: no environment lists it next to a movement that it could run in parallel with
            "#]],
        );
    }

    #[test]
    fn a_movement_joins_its_parallel_neighbour() {
        let movements = "movement $0go of a { turn left }\nparallel movement come of b { turn left }";
        check(
            movements,
            "go come",
            &expect![[r#"
                Rewrite: make `go` parallel: it starts together with `come`
                    | parallel movement go of a { turn left }
            "#]],
        );
        check(
            movements,
            "go come go",
            &expect![[r#"
                Rewrite: make `go` parallel
                  not here: `a` cannot run `go` twice at the same time
            "#]],
        );
    }

    #[test]
    fn the_last_parallel_movement_becomes_sequential_too() {
        let movements =
            "parallel movement $0go of a { turn left }\nparallel movement come of b { turn left }";
        check(
            movements,
            "go come",
            &expect![[r#"
                Rewrite: make `go` and `come` sequential: one runs after the other
                    | movement go of a { turn left }
                    | movement come of b { turn left }
            "#]],
        );
        check(
            movements,
            "come go come",
            &expect![[r#"
                Rewrite: make `go` and `come` sequential: one runs after the other
                    | movement go of a { turn left }
                    | movement come of b { turn left }
            "#]],
        );
    }
}
