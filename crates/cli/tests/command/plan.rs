//! `pydslrep plan`.

use expect_test::expect;
use serde_json::{Value, json};

use crate::process::{Place, paper};

fn plan(program: &str) -> Value {
    let done = Place::new().run(&["plan", "--json", program]);
    assert_eq!((done.code, done.err.as_str()), (Some(0), ""));
    serde_json::from_str(&done.out).unwrap()
}

#[test]
fn the_articles_path_as_json() {
    let plans = plan(&paper("table2_two_wheels"));
    assert_eq!(plans.as_array().unwrap().len(), 1);
    let (plan, robot) = (&plans[0], &plans[0]["robots"][0]);
    assert_eq!((&plan["environment"], &robot["name"]), (&json!("area_1"), &json!("robot_1")));
    assert_eq!(robot["unknown_after"], json!(null));
    let poses = robot["poses"].as_array().unwrap();
    assert_eq!(poses.len(), 5);
    assert_eq!(poses[4]["t"], plan["duration"]);
    // 12 m at 9 cm/s, two quarter turns of 0.15 m at 9 cm/s, five ramps of 0.09 / 0.5 s and rests.
    let seconds = 12.0 / 0.09 + 2.0 * 0.15 * std::f64::consts::FRAC_PI_2 / 0.09 + 5.0 * (0.18 + 0.15);
    assert!((plan["duration"].as_f64().unwrap() - seconds).abs() < 1e-6);
    let last = &poses[4];
    assert_eq!((&last["movement"], &last["run"], &last["action"]), (&json!("mov_1"), &json!(1), &json!(5)));
    for (key, value) in [("x", 0.0), ("y", -4.0), ("theta", std::f64::consts::PI)] {
        assert!((last[key].as_f64().unwrap() - value).abs() < 1e-9, "{last}");
    }
}

#[test]
fn what_the_world_decides_is_not_guessed() {
    let plans = plan(&paper("table6_sensors"));
    let robot = &plans[0]["robots"][0];
    assert_eq!(plans[0]["duration"], json!(null));
    assert_eq!(robot["poses"].as_array().unwrap().len(), 1);
    assert_eq!(robot["unknown_after"], json!({"movement": "mov_1", "run": 1, "action": 2, "line": 14}));
    assert_eq!(robot.get("possible"), None, "it has no bound");
}

/// The known part is the same as if nothing were possible.
#[test]
fn what_may_be_driven_is_a_part_of_its_own() {
    let program = "\
wheel a with radius 4.5 wheel b with radius 4.5 sensor eye
robot r with port 1 has { a b } wheels with sensors { eye }
movement m of r {
  repeat 2 times {
    move 1 meters
    if { eye } clear { move 2 meters until { eye } detect } else { turn left move 1 meters }
  }
}
environment e has { r } robots with { m } moves";
    let place = Place::with("x.pyr", program);
    let done = place.run(&["plan", "--json", "x.pyr"]);
    let plans: Value = serde_json::from_str(&done.out).unwrap();
    let robot = &plans[0]["robots"][0];
    assert_eq!((robot["poses"].as_array().unwrap().len(), &plans[0]["duration"]), (1, &json!(null)));
    let lost = json!({"movement": "m", "run": 1, "action": 3, "line": 6, "rounds": [1]});
    assert_eq!(robot["unknown_after"], lost);
    let end =
        |pose: &Value| (pose["action"].as_u64().unwrap(), format!("{:.1}", pose["x"].as_f64().unwrap()));
    let ways = robot["possible"].as_array().unwrap().iter();
    let ends: Vec<Vec<_>> = ways.map(|way| way.as_array().unwrap().iter().map(end).collect()).collect();
    let [three, one] = ["3.0", "1.0"].map(str::to_owned);
    assert_eq!(ends, [vec![(4, three)], vec![(5, one.clone()), (6, one)]]);
    let first = &robot["possible"][0][0];
    assert!(first["t"].as_f64() > robot["poses"][0]["t"].as_f64(), "{robot}");
    assert_eq!((&first["rounds"], &first["line"]), (&json!([1]), &json!(6)));
    assert_eq!(place.run(&["plan", "x.pyr", "--picture", "x.svg"]).code, Some(0));
    assert!(place.read("x.svg").contains("possible, sensors decide"));
}

#[test]
fn what_is_unknown_says_by_which_calls_it_is_reached() {
    let program = "\
wheel a with radius 4.5 wheel b with radius 4.5 sensor eye
robot r with port 1 has { a b } wheels with sensors { eye }
movement m of r { turn left repeat 2 times { do side } }
movement side of r { move 1 meters wait until { eye } clear }
environment e has { r } robots with { m } moves";
    let done = Place::with("x.pyr", program).run(&["plan", "--json", "x.pyr"]);
    let plans: Value = serde_json::from_str(&done.out).unwrap();
    let calls = json!([{"movement": "m", "action": 3}]);
    let lost = json!({"movement": "m", "run": 1, "action": 2, "line": 4, "rounds": [1], "calls": calls});
    assert_eq!(plans[0]["robots"][0]["unknown_after"], lost);
}

#[test]
fn a_table_for_people() {
    let program = "\
wheel a with radius 4.5 wheel b with radius 9
robot r with port 1 has { a b } wheels sensor s
movement m of r { move 90 centimeters turn left 45 }
environment e has { r } robots with { m } moves";
    let done = Place::with("x.pyr", program).run(&["plan", "x.pyr"]);
    expect![[r#"
        e: 11.97 s

        action                    at s    x m    y m  heading °  wheels rad/s
        ──────────────────────────────────────────────────────────────────────
        r                         0.00  0.000  0.000        0.0
          m
            move 90 centimeters  10.33  0.900  0.000        0.0   2.00  1.00
            turn left 45         11.97  0.900  0.000       45.0  -2.00  1.00

    "#]]
    .assert_eq(&done.out);
}

#[test]
fn a_picture_of_it() {
    let place = Place::new();
    let done = place.run(&["plan", &paper("table2_two_wheels"), "--picture", "plan.svg"]);
    assert_eq!(done.code, Some(0));
    let picture = place.read("plan.svg");
    assert!(picture.starts_with("<svg") && picture.contains("robot_1"), "{picture}");
    assert!(picture.contains("heading, every "), "{picture}");
}

#[test]
fn a_picture_of_pixels_and_one_that_moves() {
    let place = Place::new();
    let program = paper("table2_two_wheels");
    let done = place.run(&["plan", &program, "--picture", "plan.png", "--replay", "plan.svg"]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    assert!(done.err.ends_with("picture: plan.png\nreplay: plan.svg\n"), "{}", done.err);
    let pixels = std::fs::read(place.path("plan.png")).unwrap();
    assert!(pixels.starts_with(b"\x89PNG\r\n"), "{:?}", &pixels[..8]);
    let replay = place.read("plan.svg");
    assert!(replay.contains("<animateTransform") && replay.contains("× real time"), "{replay}");
}

#[test]
fn a_picture_of_a_kind_that_is_not_drawn() {
    let place = Place::new();
    let program = paper("table2_two_wheels");
    for (option, name, hint) in [("--picture", "a.pdf", ".svg or .png"), ("--replay", "a.png", ".svg")] {
        let done = place.run(&["plan", &program, option, name]);
        assert_eq!(done.code, Some(2));
        assert!(done.err.contains(&format!("ends in {hint}")), "{}", done.err);
    }
}

#[test]
fn errors_are_shown_instead() {
    let done = Place::new().run(&["plan", &paper("table5_angles_as_printed")]);
    assert_eq!(done.code, Some(1));
    assert!(done.err.contains("there is no wheel called `wheelL0`"), "{}", done.err);
}

const TWO_ROBOTS: &str = "\
wheel a with radius 4.5 wheel b with radius 4.5
robot first with port 1 has { a b } wheels with sensors { eye }
robot second with port 2 has { a b } wheels
sensor eye
movement m of first { move 1 meters }
movement n of second { turn left }
environment hall has { first second } robots with { m n } moves";

#[test]
fn a_scene_beside_the_program_says_where_robots_start() {
    let place = Place::with("x.pyr", TWO_ROBOTS);
    place.write("hall.scene.toml", "[robots.first]\nstart = [1, 2, 90]\n");
    let done = place.run(&["plan", "--json", "x.pyr"]);
    assert_eq!((done.code, done.err.as_str()), (Some(0), ""));
    let plans: Value = serde_json::from_str(&done.out).unwrap();
    let y = plans[0]["robots"][0]["poses"][0]["y"].as_f64().unwrap();
    assert!((y - 3.0).abs() < 1e-9, "{y}");
    place.write("other.toml", "");
    let named = place.run(&["plan", "--json", "x.pyr", "--scene", "other.toml"]);
    let plans: Value = serde_json::from_str(&named.out).unwrap();
    assert_eq!(plans[0]["robots"][0]["poses"][0]["y"], json!(0.0));
}

#[test]
fn what_is_in_the_way_is_told() {
    let place = Place::with("x.pyr", TWO_ROBOTS);
    place.write(
        "hall.scene.toml",
        "[[box]]\nname = \"crate\"\nat = [0.8, 0]\nsize = [0.4, 0.4]\n[robots.second]\nstart = [1.1, -0.36, 30]\n",
    );
    let done = place.run(&["plan", "x.pyr"]);
    expect![[r#"
        hall: 14.39 s

        action                 at s    x m     y m  heading °  wheels rad/s
        ────────────────────────────────────────────────────────────────────
        first                  0.00  0.000   0.000        0.0
          m
            move 1 meters     11.44  1.000   0.000        0.0   2.00  2.00
        second                 0.00  1.100  -0.360       30.0
          (waits for others)  11.44  1.100  -0.360       30.0
          n
            turn left         14.39  1.100  -0.360      120.0  -2.00  2.00

        first runs into `crate` after 5.08 s: `move 1 meters` of `m`, at x 0.450 m, y
          0.000 m
        second runs into `first` after 11.68 s: `turn left` of `n`, at x 1.100 m, y
          -0.360 m
        second runs into `crate` after 12.66 s: `turn left` of `n`, at x 1.100 m, y
          -0.360 m

    "#]]
    .assert_eq(&done.out);
    let checked = place.run(&["check", "x.pyr"]);
    assert_eq!(checked.code, Some(0), "{}", checked.err);
    let warning =
        "warning[planned-collision]: `first` runs into `crate` here after 5.1 s, at x 0.45 m, y 0 m";
    assert!(checked.out.contains(warning), "{}", checked.out);
    let json = place.run(&["plan", "--json", "x.pyr"]);
    let plans: Value = serde_json::from_str(&json.out).unwrap();
    let collisions = &plans[0]["collisions"];
    assert_eq!(collisions.as_array().unwrap().len(), 3, "{collisions}");
    assert_eq!(
        (&collisions[0]["robot"], &collisions[0]["with"]),
        (&json!("first"), &json!({"obstacle": "crate"}))
    );
    assert_eq!(
        (&collisions[0]["movement"], &collisions[0]["run"], &collisions[0]["action"]),
        (&json!("m"), &json!(1), &json!(1))
    );
    assert!((collisions[0]["x"].as_f64().unwrap() - 0.449).abs() < 0.002, "{collisions}");
    assert_eq!(
        (&collisions[1]["robot"], &collisions[1]["with"]),
        (&json!("second"), &json!({"robot": "first"}))
    );
}

#[test]
fn a_scene_with_a_mistake_is_not_driven() {
    let place = Place::with("x.pyr", TWO_ROBOTS);
    place.write("hall.scene.toml", "[robots.frist]\n\n[robots.first.sensors.eye]\nrnage = 2\n");
    let done = place.run(&["plan", "x.pyr"]);
    assert_eq!((done.code, done.out.as_str()), (Some(2), ""));
    expect![[r#"
        error: the environment has no robot `frist`
         --> hall.scene.toml:1:9
          |
        1 | [robots.frist]
          |         ^^^^^
          |
          = help: did you mean `first`?

        error: there is no key `robots.first.sensors.eye.rnage`
         --> hall.scene.toml:4:1
          |
        4 | rnage = 2
          | ^^^^^
          |
          = help: did you mean `range`?

    "#]]
    .assert_eq(&done.err);
    let missing = place.run(&["plan", "x.pyr", "--scene", "nowhere.toml"]);
    expect![[r#"
        error: nowhere.toml does not exist
    "#]]
    .assert_eq(&missing.err);
    assert_eq!(missing.code, Some(2));
}
