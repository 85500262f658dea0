//! Mistakes of new users: a program in place of a command, and tables on a terminal of the usual width.

use expect_test::expect;

use crate::process::{Place, paper, repository};

#[test]
fn a_program_in_place_of_a_command_is_most_likely_to_be_run() {
    let place = Place::with("x.pyr", "sensor s");
    place.write("rooms/y.pyr", "sensor s");
    let done = place.run(&["x.pyr"]);
    assert_eq!((done.code, done.out.as_str()), (Some(2), ""));
    expect![[r#"
        error: there is no command `x.pyr`
         |
         = help: did you mean `pydslrep run x.pyr`?
    "#]]
    .assert_eq(&done.err);
    for (word, expected) in
        [("gone.pyr", "run gone.pyr"), ("rooms", "check rooms"), ("rooms/y.pyr", "run rooms/y.pyr")]
    {
        let done = place.run(&[word]);
        assert_eq!(done.code, Some(2), "{word}");
        assert!(done.err.contains(&format!("did you mean `pydslrep {expected}`?")), "{}", done.err);
    }
    let done = place.run(&["chekc"]);
    assert_eq!(done.code, Some(2));
    assert!(
        done.err.contains("unrecognized subcommand 'chekc'") && done.err.contains("'check'"),
        "{}",
        done.err
    );
}

/// Every program of the article and the examples that can be planned.
fn programs() -> Vec<String> {
    let examples = [
        ["convoy", "crossing", "dock", "horseshoe", "junction", "lawn"],
        ["mecanum", "museum", "patrol", "rooms", "square", "wall"],
    ]
    .concat();
    let examples = examples.into_iter().map(|name| repository(&format!("examples/{name}.pyr")));
    let articles =
        ["table2_two_wheels", "table3_four_wheels", "table4_holonomic", "table6_sensors", "table7_slam"];
    examples.chain(articles.map(paper)).collect()
}

#[test]
fn tables_fit_a_usual_terminal() {
    let place = Place::new();
    for program in programs() {
        place.write("p/x.pyr", std::fs::read_to_string(&program).unwrap());
        for arguments in [&["plan", &program][..], &["stats", &program], &["build", &program, "-o", "made"]] {
            let done = place.run(arguments);
            assert_eq!(done.code, Some(0), "{arguments:?}: {}", done.err);
            for line in done.out.lines() {
                assert!(line.chars().count() <= 80, "{arguments:?}\n{}", done.out);
            }
        }
    }
}

#[test]
fn long_names_and_actions_are_wrapped_between_words() {
    let program = "\
wheelH front_left with radius 4.5 wheelH rear_left with radius 4.5
wheelH front_right with radius 4.5 wheelH rear_right with radius 4.5
sensor a_very_long_name_of_a_sensor_in_front
robot a_robot_with_a_long_name with port 1 has { front_left rear_left front_right rear_right } wheels
  with sensors { a_very_long_name_of_a_sensor_in_front }
movement a_movement_with_a_long_name of a_robot_with_a_long_name { move -1.25 meters at 12.5 turn left 45.5 }
environment e has { a_robot_with_a_long_name } robots with { a_movement_with_a_long_name } moves";
    let done = Place::with("x.pyr", program).run(&["plan", "x.pyr"]);
    expect![[r#"
        e: 13.16 s

        action                  at s     x m    y m  heading °  wheels rad/s
        ────────────────────────────────────────────────────────────────────────────────
        a_robot_with_a_long     0.00   0.000  0.000        0.0
          _name
          a_movement_with_a
            _long_name
            move -1.25 meters  10.40  -1.250  0.000        0.0  -2.78 -2.78 -2.78 -2.78
              at 12.5
            turn left 45.5     13.16  -1.250  0.000       45.5  -2.00 -2.00  2.00  2.00

    "#]]
    .assert_eq(&done.out);
}

#[test]
fn robots_that_wait_are_shown() {
    let program = "\
wheel a with radius 4.5 wheel b with radius 4.5
robot r with port 1 has { a b } wheels robot q with port 2 has { a b } wheels
movement m of r { move 90 centimeters } movement n of q { turn left }
environment e has { r q } robots with { m n m } moves";
    let done = Place::with("x.pyr", program).run(&["plan", "x.pyr"]);
    expect![[r#"
        e: 23.61 s

        action                    at s    x m     y m  heading °  wheels rad/s
        ───────────────────────────────────────────────────────────────────────
        r                         0.00  0.000   0.000        0.0
          m
            move 90 centimeters  10.33  0.900   0.000        0.0   2.00  2.00
          (waits for others)     13.28  0.900   0.000        0.0
          m
            move 90 centimeters  23.61  1.800   0.000        0.0   2.00  2.00
        q                         0.00  0.000  -1.000        0.0
          (waits for others)     10.33  0.000  -1.000        0.0
          n
            turn left            13.28  0.000  -1.000       90.0  -2.00  2.00

    "#]]
    .assert_eq(&done.out);
}
