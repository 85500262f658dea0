//! Scene files, `<environment>.scene.toml`: a text in, a scene and problems with their locations out.

mod keys;
mod read;

pub use keys::SCHEMA;
pub use pydslrep_text::file_names::SCENE_SUFFIX as ENDING;
pub use read::{problems, read};

/// The page of the documentation, in Markdown.
pub fn manual() -> String {
    let intro = format!(
        "# Scenes\n\n\
        The embedded simulator puts the robots of an environment on an empty floor, a metre apart. A file\n\
        `<environment>{ENDING}` beside the program, or one that is named with `--scene`, describes the rest of the world:\n\
        obstacles, the robots' start poses and dimensions, and noise. With a scene file, robots are stopped by what they touch,\n\
        or slide along it; an action that is stopped, or a move that is deflected from its goal, fails. Without one, robots\n\
        drive through each other, because their positions are unspecified. Nothing in it is required:\n\n\
        ```toml\n{EXAMPLE}```\n\n\
        Lengths are in metres, angles in degrees and counter-clockwise, x points ahead of a robot with heading 0 and y to its\n\
        left. Unknown keys, wrong values, names of robots or sensors that the program does not have, and robots that start\n\
        inside something are reported with their location, and nothing is driven.\n\n\
        Boxes and cylinders may move, so that there is something to wait for. Somebody stands in the way for half a minute and\n\
        then steps aside:\n\n\
        ```toml\n{MOVING}```\n\n\
        What moves pushes nothing and is stopped by nothing, and its heading stays. If it runs into a robot, the robot cannot\n\
        move until it has passed: one that stands still gets a warning at the end of the run; one that drives stays there until\n\
        its wheels stop, too, so that its action fails. In CoppeliaSim nothing moves: `pydslrep scene push` places such an\n\
        obstacle at its first point and says so.\n\n\
        Editors that support JSON schemas complete and check the file with [scene.schema.json](../editors/scene.schema.json).\n"
    );
    intro + &SCHEMA.page_of_tables()
}

const EXAMPLE: &str = "\
[world]
size = [4.0, 3.0]

[[wall]]
from = [-0.5, 0.5]
to = [1.5, 0.5]

[[cylinder]]
at = [1.0, -0.7]
radius = 0.15

[noise]
wheel-slip = 3

[robots.robot_1]
start = [-1.5, 0.0, 0]
track = 0.28

[robots.robot_1.sensors.fSensor]
range = 0.6
cone = 30
";

const MOVING: &str = "\
[[cylinder]]
name = \"person\"
radius = 0.2
path = [[0, 2, 0], [30, 2, 0], [35, 2, -2]]
";

/// The JSON schema of scene files, for editors that check TOML by one.
pub fn json_schema() -> serde_json::Value {
    SCHEMA.json_schema(
        &format!("*{ENDING}"),
        "The world that the robots of an environment of PyDSLRep drive in.",
    )
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use expect_test::expect_file;
    use pydslrep_kinematics::Drive;

    use super::*;
    use crate::{Robot, Scene, SensorKind, Wheel, defaults};

    #[test]
    fn the_manual_and_the_schema_are_up_to_date() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        expect_file![root.join("docs/scenes.md")].assert_eq(&manual());
        let schema = serde_json::to_string_pretty(&json_schema()).unwrap() + "\n";
        expect_file![root.join("editors/scene.schema.json")].assert_eq(&schema);
    }

    #[test]
    fn the_documented_defaults_are_those_that_are_used() {
        let documented = |table: &str, key: &str| {
            let table = SCHEMA.tables.iter().find(|each| each.name == table).unwrap();
            table.key(key).unwrap().default
        };
        let robot = |key| documented("robots.NAME", key);
        assert_eq!(robot("track"), format!("`{:.2}`", defaults::GEOMETRY.track));
        assert_eq!(robot("wheelbase"), format!("`{:.2}`", defaults::GEOMETRY.wheelbase));
        assert_eq!(robot("rim-acceleration"), format!("`{:?}`", defaults::MOTOR_ACCELERATION));
        assert_eq!(robot("motor-gain"), format!("`{}`", defaults::MOTOR_GAIN));
        assert_eq!(robot("wheel-width"), format!("`{}`", defaults::WHEEL_WIDTH));
        assert_eq!(documented("world", "friction"), format!("`{:?}`", defaults::FRICTION));
        for table in ["wall", "box", "cylinder", "polygon"] {
            assert_eq!(documented(table, "height"), format!("`{:?}`", defaults::HEIGHT));
        }
        let grip_of = |mecanum| {
            let rows: Vec<_> =
                Drive::ALL.into_iter().map(Drive::row).filter(|row| row.mecanum == mecanum).collect();
            let words = rows[0].lateral_friction.to_string();
            assert!(rows.iter().all(|row| row.lateral_friction.to_string() == words));
            words
        };
        assert_eq!(robot("grip"), format!("`{}`, for mecanum wheels `{}`", grip_of(false), grip_of(true)));
        let sensor = |key| documented("robots.NAME.sensors.NAME", key);
        let [range, reach] = [SensorKind::Distance, SensorKind::Bumper].map(defaults::range);
        assert_eq!(sensor("range"), format!("`{range:?}`, for a bumper `{reach:?}`"));
        assert_eq!(sensor("cone"), format!("`{}`", defaults::CONE_DEGREES));
    }

    #[test]
    fn the_example_is_correct() {
        let wheels = ["l", "r"].map(|name| Wheel::new(name, 0.045)).to_vec();
        let sensors = vec![("fSensor".to_owned(), SensorKind::Distance)];
        let robot = Robot::new("robot_1", Drive::TwoWheel, wheels, sensors);
        let (scene, problems) = read(EXAMPLE, Scene::empty_floor(vec![robot]));
        assert_eq!((scene.obstacles.len(), problems), (6, vec![]));
        let (scene, problems) = read(MOVING, Scene::default());
        assert_eq!((scene.obstacles.len(), problems), (1, vec![]));
    }
}
