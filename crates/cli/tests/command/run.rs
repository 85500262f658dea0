//! `pydslrep run`, with the real Python, the real client from PyPI, and the embedded simulator.

use std::collections::BTreeMap;
use std::net::TcpListener;
use std::sync::Mutex;

use pydslrep_trace::{FailureClass, FileKind, RunEvent};
use serde_json::Value;

use crate::process::{Done, Place, paper, repository};

/// The tolerance between driven and planned poses: metres and degrees.
const NEAR: f64 = 0.005;
const TURNED: f64 = 0.5;

/// x, y and heading in degrees.
type End = (f64, f64, f64);

/// Runs one after the other: the first one makes the Python environment, and all would want both processors.
fn run(place: &Place, arguments: &[&str]) -> Done {
    static TURN: Mutex<()> = Mutex::new(());
    let _turn = TURN.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    place.run(&[&["run"], arguments].concat())
}

/// Where each robot ended, by the trace.
fn ends(program: &str) -> BTreeMap<String, End> {
    let place = Place::new();
    let done = run(&place, &[program, "--trace", "trace.jsonl"]);
    assert_eq!(done.code, Some(0), "{}\n{}", done.out, done.err);
    assert!(done.out.lines().all(|line| line.chars().count() <= 80), "{}", done.out);
    let mut ends = BTreeMap::new();
    for line in place.read("trace.jsonl").lines() {
        let row: Value = serde_json::from_str(line).unwrap();
        let number = |key: &str| row[key].as_f64().unwrap();
        let end = (number("x"), number("y"), number("theta").to_degrees());
        ends.insert(row["robot"].as_str().unwrap().to_owned(), end);
    }
    ends
}

#[track_caller]
fn assert_near(end: End, goal: End) {
    let off = (end.0 - goal.0).hypot(end.1 - goal.1);
    let turned = (end.2 - goal.2 + 180.0).rem_euclid(360.0) - 180.0;
    assert!(off <= NEAR && turned.abs() <= TURNED, "{end:?} instead of {goal:?}");
}

#[test]
fn every_example_ends_where_it_is_planned() {
    let known = [
        ("square", 1),
        ("mecanum", 1),
        ("convoy", 4),
        ("patrol", 1),
        ("crossing", 4),
        ("lawn", 1),
        ("dock", 1),
    ];
    for (name, robots) in known {
        let program = repository(&format!("examples/{name}.pyr"));
        let plan: Value = serde_json::from_str(&Place::new().run(&["plan", "--json", &program]).out).unwrap();
        let ends = ends(&program);
        assert_eq!(ends.len(), robots, "{name}");
        for robot in plan[0]["robots"].as_array().unwrap() {
            let last = robot["poses"].as_array().unwrap().last().unwrap();
            let number = |key: &str| last[key].as_f64().unwrap();
            let goal = (number("x"), number("y"), number("theta").to_degrees());
            assert_near(ends[robot["name"].as_str().unwrap()], goal);
        }
    }
}

/// Their plans are unknown, but where their scenes lead them is not.
#[test]
fn examples_that_react_end_where_their_scenes_lead_them() {
    let ends = |name: &str| ends(&repository(&format!("examples/{name}.pyr")));
    assert_near(ends("museum")["guard"], (-1.5, -1.5, 0.0));
    let junction = ends("junction");
    assert_near(junction["tram"], (2.0, 0.0, 0.0));
    assert_near(junction["cart"], (0.0, 2.0, 90.0));
    // Once around the room, at half a metre from its walls, and back at the first corner.
    let (x, y, heading) = ends("wall")["rover"];
    assert!((x + 1.95).hypot(y + 1.45) < 0.1 && heading.abs() > 170.0, "{x} {y} {heading}");
}

#[test]
fn a_new_program_runs_and_is_drawn() {
    let place = Place::new();
    place.run(&["new", "patrol"]);
    let done = run(&place, &["patrol/patrol.pyr", "--picture", "patrol.svg", "--replay", "driven.svg"]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    assert!(done.out.contains("times real time"), "{}", done.out);
    let picture = place.read("patrol.svg");
    assert!(picture.starts_with("<svg") && picture.contains("off the plan"), "{picture}");
    let replay = place.read("driven.svg");
    assert!(replay.contains("<animateTransform") && replay.contains("driven"), "{replay}");
}

#[test]
fn taken_ports_do_not_matter() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    let program = format!(
        "wheel a with radius 4 wheel b with radius 4 robot r with port {port} has {{ a b }} wheels
         movement m of r {{ move 10 centimeters }} environment e has {{ r }} robots with {{ m }} moves"
    );
    let done = run(&Place::with("x.pyr", program), &["x.pyr"]);
    assert_eq!(done.code, Some(0), "{}", done.err);
}

#[test]
fn programs_with_errors_are_not_run() {
    let done = run(&Place::new(), &[&paper("table5_angles_as_printed")]);
    assert_eq!((done.code, done.out.as_str()), (Some(1), ""));
    assert!(done.err.contains("there is no wheel called `wheelL0`"), "{}", done.err);
}

#[test]
fn which_environment_must_be_clear() {
    let program = "\
wheel a with radius 4 wheel b with radius 4 robot r with port 1 has { a b } wheels
environment one has { r } robots environment two has { r } robots";
    let done = run(&Place::with("x.pyr", program), &["x.pyr"]);
    assert_eq!(done.code, Some(2));
    assert!(done.err.contains("there are `one`, `two`"), "{}", done.err);
}

#[test]
fn a_speed_is_above_zero_and_the_simulators() {
    let run = |speed: &[&str]| run(&Place::new(), &[&[paper("table2_two_wheels").as_str()], speed].concat());
    let done = run(&["--speed", "0"]);
    assert_eq!(done.code, Some(2));
    assert!(done.err.contains("expected a number above zero"), "{}", done.err);
    assert_eq!(run(&["--speed", "2", "--host", "127.0.0.1"]).code, Some(2));
}

#[test]
fn options_that_contradict_each_other_are_refused() {
    let refusals: [(&[&str], &str); 9] = [
        (&["--view"], "--view is for --engine mujoco"),
        (
            &["--engine", "mujoco", "--target", "vrep"],
            "--target is for another simulator than --engine mujoco",
        ),
        (&["--engine", "mujoco", "--host", "127.0.0.1"], "cannot be used with"),
        (&["--target", "vrep", "--host", "127.0.0.1", "--restart"], "--restart is for CoppeliaSim"),
        (&["--target", "ros2", "--host", "127.0.0.1"], "--host is for simulators"),
        (&["--target", "ros2", "--speed", "2"], "--speed is for simulators"),
        (&["--target", "ros2", "--seed", "2"], "--seed is for simulators"),
        (&["--target", "ros2", "--odometry"], "--odometry is for simulators"),
        (&["--sim-time"], "--sim-time is for the target ros2"),
    ];
    let program = paper("table2_two_wheels");
    for (options, reason) in refusals {
        let done = run(&Place::new(), &[&[program.as_str()], options].concat());
        assert_eq!(done.code, Some(2), "{options:?}: {}", done.out);
        let printed = done.err.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(printed.contains(reason), "{options:?}: {}", done.err);
    }
}

#[test]
fn a_missing_python_is_explained() {
    let done = run(&Place::new(), &[&paper("table2_two_wheels"), "--python", "./no/python"]);
    assert_eq!(done.code, Some(2));
    assert!(done.err.contains("no Python at ./no/python"), "{}", done.err);
    assert!(done.err.contains("install Python 3.11 or later"), "{}", done.err);
}

const SCOUT: &str = "\
wheel wheelL with radius 4.5 wheel wheelR with radius 4.5 sensor fSensor
robot scout with port 19997 has { wheelL wheelR } wheels with sensors { fSensor }
movement ahead of scout { move 2 meters at 20 }
movement around of scout { turn left until { fSensor } }
environment wall has { scout } robots with { ahead } moves
environment cage has { scout } robots with { around } moves";

#[test]
fn a_robot_turns_until_its_way_is_free() {
    let place = Place::new();
    let done = run(&place, &[&repository("examples/horseshoe.pyr"), "--picture", "u.svg"]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    let picture = place.read("u.svg");
    assert!(picture.contains("obstacle") && picture.contains("detected by a sensor"), "{picture}");
}

#[test]
fn a_blocked_robot_fails_its_action() {
    let place = Place::with("x.pyr", SCOUT);
    place.write("wall.scene.toml", "[[wall]]\nfrom = [1, -1]\nto = [1, 1]\n");
    let done = run(&place, &["x.pyr", "--environment", "wall", "--no-progress"]);
    assert_eq!(done.code, Some(1), "{}", done.err);
    let message = "action 1: move 2 m: no progress for 5 s, 1.201 m from the goal; its wheels turn, but the body does not move: an obstacle may be in the way";
    assert!(done.err.contains(message), "{}", done.err);
    assert!(done.out.contains("stopped  0.799  0.000"), "{}", done.out);
}

/// One robot drives and one stands still, while somebody walks fast through one of them.
fn run_with_person(path: &str, options: &[&str]) -> Done {
    let program = "\
wheel a with radius 4.5 wheel b with radius 4.5
robot guard with port 1 has { a b } wheels robot scout with port 2 has { a b } wheels
movement ahead of scout { move 2 meters at 20 }
environment hall has { guard scout } robots with { ahead } moves";
    let place = Place::with("x.pyr", program);
    let scene = "[robots.guard]\nstart = [0, 2, 0]\n[robots.scout]\nstart = [0, 0, 0]\n[[cylinder]]\nname = \"person\"\nradius = 0.2\n";
    place.write("hall.scene.toml", format!("{scene}path = {path}\n"));
    run(&place, &[&["x.pyr", "--no-progress"], options].concat())
}

#[test]
fn a_robot_that_stands_still_and_is_struck_gets_a_warning() {
    let path = "[[0, 0, 3], [3, 0, 3], [5, 0, 1], [6, -3, 1]]";
    let done = run_with_person(path, &["--events", "-"]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    let message = "`person` ran into `guard` after 3.6 s, where it stood still at x 0.00 m, y 2.00 m";
    let found = events(&done.out);
    let warning = |event: &&RunEvent| matches!(event, RunEvent::Warning { .. });
    let warnings: Vec<&RunEvent> = found.iter().filter(warning).collect();
    let [RunEvent::Warning { text, help: Some(help) }] = warnings[..] else { panic!("{found:?}") };
    assert!(text == message && help.contains("`path` of `person`"), "{text} {help}");
    let err = done.err.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(err.contains(message), "{}", done.err);
}

#[test]
fn a_robot_that_waits_and_is_struck_goes_on_with_a_warning() {
    let program = "\
wheel a with radius 4.5 wheel b with radius 4.5
robot guard with port 1 has { a b } wheels
movement stand of guard { wait 8 seconds move 20 centimeters }
environment hall has { guard } robots with { stand } moves";
    let place = Place::with("x.pyr", program);
    let path = "path = [[0, 0, 1], [3, 0, 1], [5, 0, -1], [6, -3, -1]]";
    place.write("hall.scene.toml", format!("[[cylinder]]\nname = \"person\"\nradius = 0.2\n{path}\n"));
    let done = run(&place, &["x.pyr", "--no-progress"]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    let err = done.err.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        err.contains("`person` ran into `guard`") && err.contains("where it stood still"),
        "{}",
        done.err
    );
}

#[test]
fn a_robot_that_drives_and_is_struck_fails() {
    let done = run_with_person("[[0, 0.5, -3], [2, 0.5, -3], [4, 0.5, 3], [5, 5, 3]]", &[]);
    assert_eq!(done.code, Some(1), "{}", done.err);
    let err = done.err.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(err.contains("`person` ran into `scout` after 2.9 s, where it drove"), "{}", done.err);
    assert!(err.contains("no progress for 5 s"), "{}", done.err);
    let done = run_with_person("[[0, 0.5, -3], [9, 0.5, -3]]", &[]);
    assert_eq!((done.code, done.err.contains("ran into")), (Some(0), false), "{}", done.err);
}

/// The events in a text: every line is one.
fn events(text: &str) -> Vec<RunEvent> {
    text.lines().map(|line| RunEvent::parse(line).unwrap_or_else(|| panic!("{line}"))).collect()
}

#[test]
fn events_tell_what_happens() {
    let place = Place::with("x.pyr", SCOUT);
    place.write("wall.scene.toml", "[[wall]]\nfrom = [1, -1]\nto = [1, 1]\n");
    let run_with = |target: &str| {
        let options = ["--environment", "wall", "--no-progress", "--trace", "t.jsonl", "--events", target];
        run(&place, &[&["x.pyr"], &options[..]].concat())
    };
    let done = run_with("events.jsonl");
    assert_eq!(done.code, Some(1), "{}", done.err);
    let found = events(&place.read("events.jsonl"));
    let [RunEvent::Started { robots, .. }, RunEvent::ActionBegun(begin), middle @ .., last] = &found[..]
    else {
        panic!("{found:?}")
    };
    assert_eq!((robots.len(), begin.action, begin.t), (1, 1, 0.0));
    assert_eq!(*last, RunEvent::File { kind: FileKind::Trace, path: "t.jsonl".to_owned() });
    let [RunEvent::Contact(contact), RunEvent::Failed(failure), RunEvent::Figures { figures, table }] =
        middle
    else {
        panic!("{middle:?}")
    };
    assert!((contact.x - 0.8).abs() < 0.01, "{contact:?}");
    assert_eq!((failure.class, failure.action), (FailureClass::Action, Some(1)));
    // The warning before is of the program, which is no event.
    let ending = format!("file.\nerror: {}\ntrace: t.jsonl\n", failure.message);
    assert!(done.err.ends_with(&ending), "{}", done.err);
    assert_eq!((&figures["complete"], table), (&Value::Bool(false), &done.out));

    let done = run_with("-");
    assert_eq!(events(&done.out).len(), found.len());
    assert!(done.err.contains("no progress for 5 s"), "{}", done.err);
    assert!(run_with("x.pyr").err.contains("x.pyr"), "it is an input");
}

#[test]
fn sensors_that_are_never_free_fail_their_action() {
    let place = Place::with("x.pyr", SCOUT);
    place.write("hut.toml", "[world]\nsize = [1, 1]\n");
    let done = run(&place, &["x.pyr", "--environment", "cage", "--scene", "hut.toml", "--no-progress"]);
    assert_eq!(done.code, Some(1), "{}", done.err);
    assert!(done.err.contains("after a full turn fSensor still detects something"), "{}", done.err);
}

#[test]
fn the_same_seed_is_the_same_run() {
    let place = Place::with("x.pyr", SCOUT);
    place.write("wall.scene.toml", "[noise]\n");
    let trace = |seed: &str| {
        let done =
            run(&place, &["x.pyr", "--environment", "wall", "--seed", seed, "--trace", "t", "--no-progress"]);
        assert_eq!(done.code, Some(0), "{}", done.err);
        place.read("t")
    };
    let first = trace("1");
    assert_eq!(first, trace("1"));
    assert_ne!(first, trace("2"));
}

/// A robot that moves as its wheels turn, in a time of its own.
const MY_ROBOT: &str = r#"
import math
from pydslrep_runtime import Backend, Pose, RobotSpec

class Clock:
    time, time_step = 0.0, 0.05
    def advance(self) -> None:
        self.time += self.time_step

class Rover(Backend):
    def __init__(self, spec: RobotSpec) -> None:
        self.clock, self._radii = Clock(), list(spec.wheels.values())
        self._rates, self._at, self._pose = [0.0, 0.0], 0.0, Pose(5.0, 0.0, 0.0)
    def wheel_mounts(self):
        return [(0.0, 0.15), (0.0, -0.15)]
    def set_wheel_rates(self, rates):
        self.pose()
        self._rates = list(rates)
    def pose(self) -> Pose:
        passed, self._at = self.clock.time - self._at, self.clock.time
        left, right = (rate * radius * passed for rate, radius in zip(self._rates, self._radii))
        half = (right - left) / 0.6
        self._pose = self._pose.turned(half).ahead((left + right) / 2).turned(half)
        return self._pose
"#;

#[test]
fn robots_of_ones_own_need_no_simulator() {
    let place = Place::with("p/x.pyr", std::fs::read_to_string(paper("table2_two_wheels")).unwrap());
    place.write("p/my_robot.py", MY_ROBOT);
    // A file in the program's folder cannot replace a module that the runtime imports.
    place.write("p/asyncio.py", "raise SystemExit('replaced')");
    let own = ["run", "p/x.pyr", "--robot", "my_robot:Rover", "--picture", "x.svg", "--figures", "x.json"];
    let done: Done = place.command(&own).env("XDG_CACHE_HOME", place.path("cache")).output().unwrap().into();
    assert_eq!((done.code, done.err.contains("preparing")), (Some(0), false), "{}", done.err);
    let figures: Value = serde_json::from_str(&place.read("x.json")).unwrap();
    let robot = &figures["robots"][0];
    assert!((robot["driven"]["x"].as_f64().unwrap() - 5.0).abs() < NEAR, "it started elsewhere: {robot}");
    assert!(robot["off"]["distance"].as_f64().unwrap() < NEAR, "{robot}");
    assert!(place.read("x.svg").contains("driven"));
}

#[test]
fn a_robot_of_ones_own_drives_beside_a_simulated_one() {
    let program = "\
wheel a with radius 4 wheel b with radius 4
robot scout with port 18321 has { a b } wheels robot guard with port 18322 has { a b } wheels
parallel movement m of scout { move 30 centimeters } parallel movement n of guard { move 40 centimeters }
environment yard has { scout guard } robots with { m n } moves";
    let place = Place::with("x.pyr", program);
    place.write("my_robot.py", MY_ROBOT);
    let done = run(&place, &["x.pyr", "--robot", "scout=my_robot:Rover", "--figures", "x.json"]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    let figures: Value = serde_json::from_str(&place.read("x.json")).unwrap();
    let ends: Vec<f64> = figures["robots"]
        .as_array()
        .unwrap()
        .iter()
        .map(|robot| robot["driven"]["x"].as_f64().unwrap())
        .collect();
    assert!((ends[0] - 5.3).abs() < NEAR && (ends[1] - 0.4).abs() < NEAR, "{figures}");
}

#[test]
fn mistakes_with_robots_of_ones_own_are_explained() {
    let program = paper("table2_two_wheels");
    let done = run(&Place::new(), &[&program, "--robot", "scout=my_robot:Rover"]);
    assert_eq!(done.code, Some(2));
    assert!(done.err.contains("there is no robot `scout` in `area_1`"), "{}", done.err);
    assert!(done.err.contains("its robots: `robot_1`"), "{}", done.err);
    let done = run(&Place::new(), &[&program, "--robot", "Rover"]);
    assert_eq!(done.code, Some(2));
    assert!(done.err.contains("such as my_robot:Rover"), "{}", done.err);
    let done = run(&Place::new(), &[&program, "--robot", "my_robot:Rover"]);
    assert_eq!(done.code, Some(2));
    assert!(done.err.contains("there is no Python module my_robot"), "{}", done.err);
}
