//! Hover in a TOML file: the meaning of the key or the table under the cursor.

use pydslrep_schema::{Item, name_parts};

use super::TomlFile;
use crate::Hover;

/// Returns the hover for the name at an offset.
pub fn toml_hover(file: TomlFile<'_>, text: &str, offset: u32) -> Option<Hover> {
    let part = name_parts(text).into_iter().find(|part| part.span.touches(offset))?;
    let path: Vec<&str> = part.name.split('.').collect();
    let markdown = match file.schema().find(&path)? {
        Item::Table(table) => table.markdown(),
        Item::Key(key) => key.markdown(),
    };
    Some(Hover { span: part.span, markdown })
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};
    use pydslrep_analysis::Database;

    use super::super::tests::at_cursor;
    use super::*;

    fn hover(file: TomlFile<'_>, fixture: &str, expected: &Expect) {
        let (text, offset) = at_cursor(fixture);
        let found = toml_hover(file, &text, offset)
            .map(|hover| format!("{}\n---\n{}", hover.span.text(&text), hover.markdown));
        expected.assert_eq(found.as_deref().unwrap_or("nothing"));
    }

    fn check(fixture: &str, expected: &Expect) {
        hover(TomlFile::Settings, fixture, expected);
    }

    #[test]
    fn of_settings_tables_and_codes() {
        check(
            "tar$0get = 'v",
            &expect![[r#"
            target
            ---
            **`target`**: `"coppeliasim"`, `"vrep"` or `"ros2"`

            The simulator that scripts are for.

            * `"coppeliasim"`: CoppeliaSim 4.6 or later, by its ZeroMQ remote API
            * `"vrep"`: V-REP 3, by its legacy remote API: each robot has a port of its own
            * `"ros2"`: ROS 2, by the topics of a robot's driver: Jazzy or Kilted, through rclpy

            Default: `"coppeliasim"`
        "#]],
        );
        check(
            "default-speed$0",
            &expect![[r#"
                default-speed
                ---
                **`default-speed`**: a number above zero

                The speed in snippets that an editor inserts, in centimetres per second.

                Default: `9.0`

                For example `default-speed = 12.5`
            "#]],
        );
        check(
            "[inlay-hints]\n$0pose = true",
            &expect![[r#"
                pose
                ---
                **`pose`**: `true` or `false`

                Whether an editor shows the pose after each action, relative to the start of its movement: x and y in metres, and the heading.

                Default: `true`
            "#]],
        );
        check(
            "[inlay$0-hints]",
            &expect![[r#"
                inlay-hints
                ---
                **`[inlay-hints]`**

                What an editor shows between the words of a program.

                * `pose`: Whether an editor shows the pose after each action, relative to the start of its movement: x and y in metres, and the heading.
                * `duration`: Whether an editor shows how long each action takes.
                * `defaults`: Whether an editor shows speeds and angles that are left out.
            "#]],
        );
        check(
            "[severity$0]",
            &expect![[r#"
                severity
                ---
                **`[severity]`**

                The severity of each diagnostic: `"off"`, `"hint"`, `"information"`, `"warning"` or `"error"`. It decides what is shown and the exit code of `pydslrep check`; what keeps a script from being generated does so at any level.

                `pydslrep explain` lists all diagnostics
            "#]],
        );
        check(
            "severity = { wheel-c$0ount = ",
            &expect![[r#"
                wheel-count
                ---
                **`wheel-count`**: `"off"`, `"hint"`, `"information"`, `"warning"` or `"error"`

                a robot does not have the 2 wheels of a `tw`, or the 4 of an `fw` or `fwh`

                * `"off"`: not shown
                * `"hint"`: shown as a hint, hardly visible
                * `"information"`: shown as information
                * `"warning"`: shown as a warning
                * `"error"`: shown as an error; `pydslrep check` fails

                Default: `"error"`
            "#]],
        );
    }

    #[test]
    fn of_nothing_else() {
        for fixture in ["$0", "tarjet$0 = 1", "target = $0'vrep'", "# tar$0get", "[severity]\nx$0 = 1"] {
            check(fixture, &expect!["nothing"]);
        }
    }

    #[test]
    fn of_scenes() {
        let database = Database::new();
        let scene = TomlFile::Scene(&database, None);
        hover(
            scene,
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
            scene,
            "[wor$0ld]",
            &expect![[r#"
                world
                ---
                **`[world]`**

                The floor, and what applies to everything on it.

                * `size`: The size of the floor along x and y.
                * `corner`: The corner of the floor with the smallest x and y.
                * `walls`: Whether there are walls around a floor with a `size`.
                * `collisions`: Whether robots are stopped by what they touch; sensors see it either way.
                * `friction`: How well wheels grip the floor in MuJoCo: the coefficient of sliding friction, about 0.1 on ice. In the embedded simulator, wheels do not slide.
                * `seed`: The seed of noise: with the same seed, runs are the same.
            "#]],
        );
        hover(
            scene,
            "[robots.rover]\nrim-sp$0eed = 2",
            &expect![[r#"
                rim-speed
                ---
                **`rim-speed`**: a number above zero

                The maximum speed of its wheels' rims, per second.

                Default: unlimited

                For example `rim-speed = 0.4`
            "#]],
        );
        hover(
            scene,
            "[robots.rover.sensors.fr$0ont]\nrange = 2",
            &expect![[r#"
                front
                ---
                **`[robots.NAME.sensors.NAME]`**

                A proximity sensor of a robot. Its default position depends on the first letter of its name: f… ahead, l… left, r… right, b… behind, any other in the front half.

                * `at`: Its position, ahead and to the left of the robot's middle.
                * `bearing`: The direction it faces: 0 is ahead, 90 left.
                * `range`: The greatest distance it measures.
                * `cone`: The opening angle of its cone.
                * `object`: Where the sensor is in CoppeliaSim's scene, if that has a name of its own.
            "#]],
        );
        hover(
            scene,
            "robots.rover.sensors.front.co$0ne = 2",
            &expect![[r#"
                cone
                ---
                **`cone`**: an angle above 0 and up to 180 degrees

                The opening angle of its cone.

                Default: `20`

                For example `cone = 30`
            "#]],
        );
        hover(scene, "[[bxo$0]]", &expect!["nothing"]);
        hover(scene, "[[box]]\nat = [$01, 2]", &expect!["nothing"]);
    }
}
