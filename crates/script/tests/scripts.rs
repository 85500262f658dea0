//! Whole scripts: what is in them, what is not, and that names stay names.
//!
//! `snapshots/` holds one whole script per target, and what other scripts change in it as diffs. The tests in
//! `python/tests` run all of them. `UPDATE_EXPECT=1 cargo test -p pydslrep-script` rewrites them.

#![allow(clippy::expect_used, reason = "helpers of tests are tests, too")]

mod common;

use std::net::Ipv4Addr;

use common::{area_1, environment, four_robots, move_by, movement, robot, sensors, slam, turn, with_sensors};
use expect_test::{expect, expect_file};
use pydslrep_analysis::environment::{Action, Environment, Sensor, SensorKind, Source};
use pydslrep_kinematics::Drive;
use pydslrep_script::{REQUIREMENTS, Target, file_name, generate, may_replace};
use similar::TextDiff;

fn script(environment: &Environment) -> String {
    generate(environment, Target::CoppeliaSim).expect("a script")
}

fn vrep_script(environment: &Environment) -> String {
    generate(environment, Target::VRep).expect("a script")
}

/// The program's own part of a script: what follows `# The robots of the program`, without the shared parts.
fn own_lines(script: &str) -> String {
    let after = |start: &str| script.split_once(start).expect(start).1;
    let until_stage = |text: &str| text.split("# ====").next().unwrap_or_default().trim_end().to_owned();
    let robots = until_stage(after("# The robots of the program.\n"));
    let movements = until_stage(after("Movement(name, of, actions)\n"));
    format!("{robots}{movements}\n\n\ndef drive({}", after("\ndef drive("))
}

/// What one script changes in another.
fn changes(from: &str, to: &str) -> String {
    TextDiff::from_lines(from, to).unified_diff().context_radius(1).to_string()
}

#[test]
fn whole_scripts() {
    expect_file!["../snapshots/area_1.py"].assert_eq(&script(&area_1(Drive::TwoWheel)));
    expect_file!["../snapshots/area_1_vrep.py"].assert_eq(&vrep_script(&area_1(Drive::TwoWheel)));
}

#[test]
fn turning_until_sensors_are_free() {
    let whole = script(&area_1(Drive::TwoWheel));
    expect_file!["../snapshots/sensors.diff"].assert_eq(&changes(&whole, &script(&sensors())));
    let whole = vrep_script(&area_1(Drive::TwoWheel));
    expect_file!["../snapshots/sensors_vrep.diff"].assert_eq(&changes(&whole, &vrep_script(&sensors())));
}

#[test]
fn four_robots_in_parallel() {
    let whole = script(&area_1(Drive::TwoWheel));
    expect_file!["../snapshots/factory.diff"].assert_eq(&changes(&whole, &script(&four_robots())));
}

/// The parts that explore are 2 000 lines, tested where they are.
#[test]
fn exploring() {
    expect![[r#"
        ROBOTS = (
            RobotModel(
                name="robot_1",
                port=19999,
                drive=TwoWheelDrive,
                wheels={
                    "wheelL": 0.045,
                    "wheelR": 0.045,
                },
                sensors=[
                    "fSensor0",
                    "fSensor1",
                    "fSensor2",
                    "lSensor",
                    "rSensor",
                ],
                slam_sensors=[
                    "fSensor0",
                    "fSensor1",
                    "fSensor2",
                    "lSensor",
                    "rSensor",
                ],
            ),
        )

        @movement("mov_1", of="robot_1")  # line 6
        def movement_mov_1(robot: Robot) -> None:
            robot.slam()  # line 14: slam


        def drive(fleet: Fleet) -> None:
            """Runs the movements of environment rooms in order."""
            fleet.run(movement_mov_1)


        if __name__ == "__main__":
            sys.exit(main(__doc__, HOST, ROBOTS, drive, ENVIRONMENT))
    "#]]
    .assert_eq(&own_lines(&script(&slam())));
}

#[test]
fn targets_differ_in_the_contact_with_the_simulator_only() {
    let [coppeliasim, vrep] = [script(&four_robots()), vrep_script(&four_robots())];
    for word in ["zmq", "RemoteAPIClient", "coppeliasim_zmqremoteapi_client"] {
        assert!(coppeliasim.contains(word) && !vrep.contains(word), "{word}");
    }
    assert!(vrep.contains("simxStart") && !coppeliasim.contains("simx"));
    // The backend is between these two classes.
    let around = |script: &str| {
        let (before, rest) = script.split_once("class Mounting:").expect("Mounting");
        let (_, after) = rest.split_once("class Robot:").expect("Robot");
        let before = before.split_once("from pathlib").expect("imports").1;
        let without_client = |before: &str| {
            let (first, rest) = before.split_once("try:\n    import zmq\n")?;
            Some(first.to_owned() + rest.split_once("    sys.exit(2)\n")?.1)
        };
        let before = without_client(before).unwrap_or_else(|| before.to_owned());
        (before, after.replace("# The host of V-REP.", "# The host of CoppeliaSim."))
    };
    assert_eq!(around(&vrep), around(&coppeliasim));
}

#[test]
fn a_script_may_be_replaced_by_a_newer_one() {
    assert!(may_replace(script(&sensors()).as_bytes()));
    assert!(may_replace(b""));
    assert!(!may_replace(b"print('mine')"));
    assert!(!may_replace(b"\xff\xfe"));
}

#[test]
fn same_environment_same_bytes() {
    assert_eq!(script(&four_robots()), script(&four_robots()));
}

#[test]
fn only_what_is_needed() {
    let all = [
        "TwoWheelDrive",
        "FourWheelDrive",
        "FourMecanumDrive",
        "steer(",
        "Lock",
        "turn_until",
        "Proximity",
        "Cancelled",
    ];
    let check = |environment: &Environment, wanted: &[&str]| {
        let script = script(environment);
        for word in all {
            assert_eq!(script.contains(word), wanted.contains(&word), "{word} in {}", environment.name);
        }
        assert!(!script.contains("#:"), "a template statement is left in {}", environment.name);
        assert!(!script.contains("from ."), "an import of a part is left in {}", environment.name);
    };
    check(&area_1(Drive::TwoWheel), &["TwoWheelDrive", "steer("]);
    check(&area_1(Drive::FourWheel), &["FourWheelDrive", "steer("]);
    check(&area_1(Drive::FourMecanum), &["FourMecanumDrive"]);
    check(&sensors(), &["TwoWheelDrive", "steer(", "turn_until", "Proximity"]);
    check(
        &four_robots(),
        &["TwoWheelDrive", "FourWheelDrive", "FourMecanumDrive", "steer(", "Lock", "Cancelled"],
    );
    let script = script(&area_1(Drive::TwoWheel));
    assert!(!script.to_lowercase().contains("mecanum"));
    assert!(!script.contains("thread"));
}

#[test]
fn stages_follow_each_other() {
    let script = script(&four_robots());
    let places: Vec<_> =
        ["# 1. Kinematics", "# 2. Robots", "ROBOTS = ", "# 3. Movements", "@movement(", "# 4. Environment"]
            .iter()
            .map(|title| script.find(title).expect(title))
            .collect();
    assert!(places.is_sorted(), "{places:?}");
}

#[test]
fn names_used_by_python_or_the_script_stay_names() {
    let mut robot = robot("class", Drive::TwoWheel, 19999);
    "print".clone_into(&mut robot.wheels[0].name);
    "class".clone_into(&mut robot.wheels[1].name);
    let movements =
        ["class", "print", "main", "Robot", "_"].map(|name| movement(name, 0, vec![move_by(0.5, 7)]));
    let environment =
        environment("None", vec![robot], movements.into(), vec![vec![0], vec![1], vec![2], vec![3], vec![4]]);
    expect![[r#"
        ROBOTS = (
            RobotModel(
                name="class",
                port=19999,
                drive=TwoWheelDrive,
                wheels={
                    "print": 0.045,
                    "class": 0.045,
                },
            ),
        )

        @movement("class", of="class")  # line 6
        def movement_class(robot: Robot) -> None:
            robot.move(0.5)  # line 7: move 0.5 meters


        @movement("print", of="class")  # line 6
        def movement_print(robot: Robot) -> None:
            robot.move(0.5)  # line 7: move 0.5 meters


        @movement("main", of="class")  # line 6
        def movement_main(robot: Robot) -> None:
            robot.move(0.5)  # line 7: move 0.5 meters


        @movement("Robot", of="class")  # line 6
        def movement_Robot(robot: Robot) -> None:
            robot.move(0.5)  # line 7: move 0.5 meters


        @movement("_", of="class")  # line 6
        def movement__(robot: Robot) -> None:
            robot.move(0.5)  # line 7: move 0.5 meters


        def drive(fleet: Fleet) -> None:
            """Runs the movements of environment None in order."""
            fleet.run(movement_class)
            fleet.run(movement_print)
            fleet.run(movement_main)
            fleet.run(movement_Robot)
            fleet.run(movement__)


        if __name__ == "__main__":
            sys.exit(main(__doc__, HOST, ROBOTS, drive))
    "#]]
    .assert_eq(&own_lines(&script(&environment)));
}

#[test]
fn long_names_do_not_break_lines() {
    let long = "n".repeat(200);
    let mut robot = robot(&long, Drive::TwoWheel, 19999);
    long.clone_into(&mut robot.wheels[0].name);
    let environment =
        environment(&long, vec![robot], vec![movement(&long, 0, vec![turn(45.0, 7)])], vec![vec![0]]);
    let script = script(&environment).replace(&long, "<long>");
    expect![[r#"
        ROBOTS = (
            RobotModel(
                name="<long>",
                port=19999,
                drive=TwoWheelDrive,
                wheels={
                    "<long>": 0.045,
                    "wheelR": 0.045,
                },
            ),
        )

        # line 6
        @movement(
            "<long>",
            of="<long>",
        )
        def movement_1(robot: Robot) -> None:
            robot.turn(45.0)  # line 7: turn left 45.0


        def drive(fleet: Fleet) -> None:
            """Runs the movements of environment <long> in order."""
            fleet.run(movement_1)


        if __name__ == "__main__":
            sys.exit(main(__doc__, HOST, ROBOTS, drive))
    "#]]
    .assert_eq(&own_lines(&script));
}

#[test]
fn nothing_breaks_out_of_its_place() {
    let evil = "x\"\"\"\\\"\nimport os\u{2028}é";
    let mut robot = robot(evil, Drive::TwoWheel, 1);
    evil.clone_into(&mut robot.wheels[0].name);
    let action = Action {
        text: evil.to_owned(),
        source: Source { file: Some(evil.to_owned()), line: 3 },
        ..move_by(1.0, 1)
    };
    let environment = environment(evil, vec![robot], vec![movement(evil, 0, vec![action])], vec![vec![0]]);
    let script = script(&environment);
    assert!(!script.lines().any(|line| line.trim_start().starts_with("import os")), "{script}");
    assert!(
        script.starts_with("\"\"\"Drives environment x????"),
        "{}",
        script.lines().next().unwrap_or_default()
    );
    assert!(script.contains(r#"name="x\"\"\"\\\"\U0000000aimport os\U00002028\U000000e9","#));
    let comment = "# x\"\"\"\\\"?import os?é, line 3: x\"\"\"\\\"?import os?é\n";
    assert!(script.contains(&format!("    robot.move(1.0)  {comment}")));
    assert!(script.contains("def movement_1("));
}

#[test]
fn another_host() {
    let environment = Environment { host: Some(Ipv4Addr::new(192, 168, 0, 7)), ..area_1(Drive::TwoWheel) };
    assert!(script(&environment).contains("HOST = \"192.168.0.7\"\n"));
}

#[test]
fn empty_environments_and_movements_are_programs() {
    let nothing = environment("nothing", vec![], vec![], vec![]);
    assert!(script(&nothing).contains("ROBOTS: tuple[RobotModel, ...] = ()\n"));
    assert!(script(&nothing).contains("in order.\"\"\"\n\n\nif __name__"));
    let idle = environment(
        "idle",
        vec![robot("r", Drive::TwoWheel, 1)],
        vec![movement("m", 0, vec![])],
        vec![vec![0]],
    );
    assert!(script(&idle).contains("def movement_m(robot: Robot) -> None:\n    pass\n"));
}

#[test]
fn only_exploring_robots_have_slam_sensors_without_bumpers() {
    let mut environment = slam();
    environment.robots[0].sensors.push(Sensor { name: "bumper".to_owned(), kind: SensorKind::Bumper });
    let idle = with_sensors(robot("idle", Drive::TwoWheel, 19998), &["fSensor"]);
    environment.robots.push(idle);
    let text = script(&environment);
    assert!(!text.contains("bumper"));
    assert_eq!(
        (text.matches("\n        slam_sensors=[\n").count(), text.matches("\n        sensors=[\n").count()),
        (1, 1)
    );
    let without = script(&sensors());
    for word in ["slam", "Explorer", "heapq", "slam_sensors", "importlib"] {
        assert!(text.contains(word) && !without.contains(word), "{word}");
    }
}

#[test]
fn a_wheel_listed_twice_is_an_error() {
    let mut environment = area_1(Drive::TwoWheel);
    "wheelL".clone_into(&mut environment.robots[0].wheels[1].name);
    let error = generate(&environment, Target::CoppeliaSim).expect_err("no script");
    expect!["robot `robot_1` lists wheel `wheelL` twice; use a different wheel for each position"]
        .assert_eq(&error.to_string());
}

#[test]
fn the_program_says_what_its_scripts_are_called() {
    assert_eq!(file_name(&area_1(Drive::TwoWheel)), "area_1.py");
    let math = Environment { name: "math".into(), script: "math_env".into(), ..area_1(Drive::TwoWheel) };
    assert_eq!(file_name(&math), "math_env.py");
}

#[test]
fn every_requirement_has_a_fixed_version() {
    let requirements: Vec<_> = REQUIREMENTS.lines().filter(|line| !line.starts_with('#')).collect();
    assert!(requirements.contains(&"coppeliasim-zmqremoteapi-client==2.0.4"), "{requirements:?}");
    assert!(requirements.iter().all(|line| line.contains("==")), "{requirements:?}");
}
