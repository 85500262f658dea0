//! Scene files: keys of a `<environment>.scene.toml`, and the names of its program's robots and sensors, are checked,
//! completed, explained and mended, also while it is half typed.
//!
//! Its text, a place in it and the environment it is about in, plain structs out.

mod completion;

pub use completion::scene_completions;

use pydslrep_analysis::{Database, EntityId};
use pydslrep_scene::{Key, TABLES, Table};
use pydslrep_schema::names;
use pydslrep_syntax::ast::{Entity, Name};
use pydslrep_syntax::{EntityKind, Span};
use smol_str::SmolStr;

use crate::settings::fixes;
use crate::{Hover, KeyFix};

/// The fixes of all problems that touch a range of the text.
pub fn scene_fixes(
    database: &Database,
    environment: Option<EntityId>,
    text: &str,
    range: Span,
) -> Vec<KeyFix> {
    fixes(database.scene_problems(environment, text), range)
}

/// What there is to say of an offset in the text of a scene file.
pub fn scene_hover(text: &str, offset: u32) -> Option<Hover> {
    let named = names(text).into_iter().find(|named| named.span.touches(offset))?;
    let markdown = match meaning(&named.name)? {
        Meaning::Table(table) => table.markdown(),
        Meaning::Key(key) => key.markdown(),
    };
    Some(Hover { span: named.span, markdown })
}

/// What a whole name is the name of.
enum Meaning {
    Table(&'static Table),
    Key(&'static Key),
}

fn meaning(name: &str) -> Option<Meaning> {
    let parts: Vec<&str> = name.split('.').collect();
    let (table, rest) = match parts.as_slice() {
        ["robots", _, "sensors", _, rest @ ..] => ("robots.NAME.sensors.NAME", rest),
        ["robots", _, "sensors"] => ("robots.NAME.sensors.NAME", &[][..]),
        ["robots", _, rest @ ..] => ("robots.NAME", rest),
        ["robots"] => ("robots.NAME", &[][..]),
        [table, rest @ ..] => (*table, rest),
        [] => return None,
    };
    let table = TABLES.iter().find(|known| known.name == table)?;
    match rest {
        [] => Some(Meaning::Table(table)),
        [key] => table.keys.iter().find(|known| known.name == *key).map(Meaning::Key),
        _ => None,
    }
}

/// The names of an environment's robots, each with those of its sensors, as far as they are declared.
fn robots(database: &Database, environment: Option<EntityId>) -> Vec<(SmolStr, Vec<SmolStr>)> {
    let tree = environment.and_then(|id| Some((database.file_of(id)?, database.tree(id)?)));
    let Some((file, Entity::Environment(tree))) = tree else { return Vec::new() };
    let listed = tree.robots.as_ref().map_or(&[][..], |list| &list.names);
    let robots = listed.iter().map(|robot| {
        let id = database.resolve(file, EntityKind::Robot, &robot.text).entity();
        let sensors = match id.and_then(|id| database.tree(id)) {
            Some(Entity::Robot(tree)) => tree.sensors.as_ref().map_or(&[][..], |list| &list.names),
            _ => &[],
        };
        (robot.text.clone(), distinct(sensors))
    });
    let mut robots: Vec<_> = robots.collect();
    robots.dedup();
    robots
}

fn distinct(names: &[Name]) -> Vec<SmolStr> {
    let mut distinct: Vec<SmolStr> = Vec::new();
    for name in names {
        if !distinct.contains(&name.text) {
            distinct.push(name.text.clone());
        }
    }
    distinct
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;
    use crate::settings::at_cursor;

    /// A program of a robot with a sensor, and its environment.
    pub(super) fn program() -> (Database, Option<EntityId>) {
        let mut database = Database::new();
        let file = database.open(
            "a.pyr",
            "wheel a with radius 4 wheel b with radius 4 sensor front sensor back : bumper\n\
             robot rover with port 1 has { a b } wheels with sensors { front back }\n\
             robot größe with port 2 has { a b } wheels\n\
             environment yard has { rover größe } robots with { } moves",
        );
        let environment = database.environments(file)[0].0;
        (database, Some(environment))
    }

    fn hover(fixture: &str, expected: &Expect) {
        let (text, offset) = at_cursor(fixture);
        let told = scene_hover(&text, offset)
            .map(|hover| format!("{}\n---\n{}", hover.span.text(&text), hover.markdown));
        expected.assert_eq(told.as_deref().unwrap_or("nothing"));
    }

    #[test]
    fn keys_and_tables_are_explained() {
        hover(
            "[[cylinder]]\nat = [1, 1]\nrad$0ius = 2",
            &expect![[r#"
            radius
            ---
            **`radius`**: a number above zero

            Its radius.

            Required

            For example `radius = 0.25`
        "#]],
        );
        hover(
            "[wor$0ld]",
            &expect![[r#"
            world
            ---
            **`[world]`**

            The floor, and what holds for everything on it.

            * `size`: How long the floor is along x and along y.
            * `corner`: Where the floor's corner with the least x and y is.
            * `walls`: Whether there are walls around a floor with a `size`.
            * `collisions`: Whether robots are stopped by what they touch; sensors see it either way.
            * `seed`: What noise is made from: the same seed, the same run.
        "#]],
        );
        hover(
            "[robots.rover]\nrim-sp$0eed = 2",
            &expect![[r#"
            rim-speed
            ---
            **`rim-speed`**: a number above zero

            The most its motors can do, at the wheels' rims, per second.

            Default: without end

            For example `rim-speed = 0.4`
        "#]],
        );
        hover(
            "[robots.rover.sensors.fr$0ont]\nrange = 2",
            &expect![[r#"
            front
            ---
            **`[robots.NAME.sensors.NAME]`**

            A proximity sensor of a robot. One that is not placed sits where its name says: f… ahead, l… left, r… right, b… behind, any other one somewhere in front.

            * `at`: Where it sits, ahead and to the left of the robot's middle.
            * `bearing`: Where it looks: 0 is ahead, 90 left.
            * `range`: How far it sees.
            * `cone`: How wide it looks.
        "#]],
        );
        hover(
            "robots.rover.sensors.front.co$0ne = 2",
            &expect![[r#"
            cone
            ---
            **`cone`**: an angle above 0 and up to 180 degrees

            How wide it looks.

            Default: `20`

            For example `cone = 30`
        "#]],
        );
        hover("[[bxo$0]]", &expect!["nothing"]);
        hover("[[box]]\nat = [$01, 2]", &expect!["nothing"]);
    }

    /// What is wrong, the titles of the fixes at the cursor, and the text after each, in which that is mended.
    fn check_fixes(fixture: &str, expected: &Expect) {
        let (text, offset) = at_cursor(fixture);
        let (database, environment) = program();
        let before = database.scene_problems(environment, &text);
        let mut out = String::new();
        for problem in &before {
            out += &problem.message;
            out.push('\n');
        }
        for fix in scene_fixes(&database, environment, &text, Span::at(offset)) {
            let mut mended = text.clone();
            mended.replace_range(std::ops::Range::from(fix.span), &fix.text);
            assert!(database.scene_problems(environment, &mended).len() < before.len(), "{mended}");
            out += &format!("{}\n{mended}\n", fix.title);
        }
        expected.assert_eq(&out);
    }

    #[test]
    fn slips_are_mended() {
        check_fixes(
            "[wrold$0]\nseed = 2",
            &expect![[r#"
            there is nothing called `wrold` in a scene
            change to `world`
            [world]
            seed = 2
        "#]],
        );
        check_fixes(
            "[robots.rovr$0]\nstart = [1, 2]",
            &expect![[r#"
            the environment has no robot `rovr`
            change to `rover`
            [robots.rover]
            start = [1, 2]
        "#]],
        );
        check_fixes(
            "[robots.rover.sensors.frnt$0]\nrange = 2",
            &expect![[r#"
            robot `rover` has no sensor `frnt`
            change to `front`
            [robots.rover.sensors.front]
            range = 2
        "#]],
        );
        check_fixes(
            "[[cylinder]]\nat = [1, 1]\nradus$0 = 0.1",
            &expect![[r#"
            `radius` is missing in this `cylinder`
            there is no key `radus` in `cylinder`
            change to `radius`
            [[cylinder]]
            at = [1, 1]
            radius = 0.1
        "#]],
        );
        check_fixes(
            "[robots.\"größee$0\"]\nstart = [1, 2]",
            &expect![[r#"
            the environment has no robot `größee`
            change to `größe`
            [robots."größe"]
            start = [1, 2]
        "#]],
        );
        check_fixes(
            "[world]\nsize = [1, 1]$0\nseed = -2",
            &expect![[r#"
            `world.seed` must be a whole number from 0
        "#]],
        );
    }

    #[test]
    fn without_a_program_names_can_be_any() {
        let database = Database::new();
        let text = "[robots.rovr]\nstart = 2\n[robots.rovr.sensors.x]\nrnge = 1\n[wrold]";
        let told: Vec<String> =
            database.scene_problems(None, text).into_iter().map(|problem| problem.message).collect();
        expect![[r#"
            `robots.rovr.start` must be a pose `[x, y, heading]`, not a number
            there is no key `rnge` in `robots.rovr.sensors.x`
            there is nothing called `wrold` in a scene"#]]
        .assert_eq(&told.join("\n"));
    }
}
