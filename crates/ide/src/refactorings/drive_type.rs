//! Add a missing `type`, inferred from the wheels.

use pydslrep_syntax::Span;
use pydslrep_syntax::ast::{Drive, Entity, Robot};

use super::{Refactoring, Selection};
use crate::cursor::is_mecanum;

/// The refactoring for a robot without a type, if its wheels determine it.
pub(super) fn add(selection: &Selection<'_>) -> Option<Refactoring> {
    let Some(Entity::Robot(robot)) = &selection.entity.parse.entity else { return None };
    let word = inferred(selection, robot)?.word();
    let edit = selection.edit(Span::at(robot.name.as_ref()?.span.end), format!(" type {word}"));
    Some(Refactoring::rewrite(format!("add `type {word}`"), edit))
}

fn inferred(selection: &Selection<'_>, robot: &Robot) -> Option<Drive> {
    if robot.drive.is_some() {
        return None;
    }
    let wheels = &robot.wheels.as_ref()?.names;
    let mecanum: Vec<bool> = wheels
        .iter()
        .map(|name| is_mecanum(selection.database, selection.file, &name.text))
        .collect::<Option<_>>()?;
    let drive = selection.database.drive(selection.entity.id)?;
    mecanum.iter().all(|wheel| *wheel == drive.row().mecanum).then_some(drive)
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::refactorings::testing::check_whole;

    #[test]
    fn the_type_follows_from_the_wheels() {
        check_whole(
            "wheelH a with radius 4 wheelH b with radius 4 wheelH c with radius 4 wheelH d with radius 4\n\
             $0robot r with port 1 has { a b c d } wheels",
            &expect![[r#"
                Rewrite: add `type fwh`
                    | robot r type fwh with port 1 has { a b c d } wheels
            "#]],
        );
    }

    #[test]
    fn nothing_for_mixed_wheels_or_an_explicit_type() {
        check_whole(
            "wheelH a with radius 4 wheel b with radius 4 $0robot r with port 1 has { a b } wheels",
            &expect![""],
        );
        check_whole(
            "wheel a with radius 4 wheel b with radius 4 $0robot r type tw with port 1 has { a b } wheels",
            &expect![""],
        );
    }
}
