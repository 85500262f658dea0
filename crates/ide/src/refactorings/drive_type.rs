//! Add a missing `type`: the one that the wheels make it.

use pydslrep_analysis::Database;
use pydslrep_kinematics::Drive;
use pydslrep_syntax::ast::{DriveWord, Entity, Name, Robot};
use pydslrep_syntax::{EntityKind, Span};

use super::{Place, Refactoring, RefactoringKind};
use crate::cursor::resolved;

/// The offer for a robot without a type whose wheels leave no doubt.
pub(super) fn add(place: &Place<'_>) -> Option<Refactoring> {
    let Some(Entity::Robot(robot)) = &place.entity.parse.entity else { return None };
    let word = inferred(place, robot)?.spelling();
    let edit = place.edit(Span::at(robot.name.as_ref()?.span.end), format!(" type {word}"));
    Some(Refactoring::new(format!("add `type {word}`"), RefactoringKind::Rewrite, vec![edit]))
}

fn inferred(place: &Place<'_>, robot: &Robot) -> Option<DriveWord> {
    if robot.drive.is_some() {
        return None;
    }
    let wheels = &robot.wheels.as_ref()?.names;
    let mecanum: Vec<bool> =
        wheels.iter().map(|name| is_mecanum(place.database, place, name)).collect::<Option<_>>()?;
    let word = match place.database.drive(place.entity.id)? {
        Drive::TwoWheel => DriveWord::Tw,
        Drive::FourWheel => DriveWord::Fw,
        Drive::FourMecanum => DriveWord::Fwh,
    };
    mecanum.iter().all(|wheel| *wheel == (word == DriveWord::Fwh)).then_some(word)
}

fn is_mecanum(database: &Database, place: &Place<'_>, name: &Name) -> Option<bool> {
    match resolved(database, place.file, EntityKind::Wheel, name)?.1 {
        Entity::Wheel(wheel) => Some(wheel.mecanum),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::refactorings::testing::check_whole;

    #[test]
    fn what_the_wheels_make_it() {
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
    fn nothing_where_wheels_are_mixed_or_it_has_one() {
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
