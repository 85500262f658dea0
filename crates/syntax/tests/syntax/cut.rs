//! Where a text is cut into entities.

use expect_test::{Expect, expect};
use pydslrep_syntax::{cut, lex};

fn check(text: &str, expected: &Expect) {
    let tokens = lex(text);
    let mut ends: Vec<usize> = cut(text, &tokens).into_iter().map(|i| tokens[i].1.start as usize).collect();
    ends.push(text.len());
    let pieces: Vec<&str> = ends.windows(2).map(|pair| text[pair[0]..pair[1]].trim()).collect();
    expected.assert_eq(&pieces.join("\n"));
}

#[test]
fn entities_begin_at_their_keywords() {
    check(
        "import \"a.pyr\" import \"b.pyr\" wheel a wheelH b // c\n ip i parallel movement m movement n robot r",
        &expect![[r#"
            import "a.pyr"
            import "b.pyr"
            wheel a
            wheelH b // c
            ip i
            parallel movement m
            movement n
            robot r"#]],
    );
}

#[test]
fn references_and_names_do_not_cut() {
    check(
        "environment e with /* */ ip i has { r } robots wheel import with radius 3",
        &expect![[r"
            environment e with /* */ ip i has { r } robots
            wheel import with radius 3"]],
    );
}

#[test]
fn misspelt_keywords_cut_where_they_are_followed_as_theirs() {
    check(
        "Wheel a with radius 3 weel b radius 4 sensr s : bumper Sensor t sensor u senor v Robot r Type tw
parallell movement m of r { move 2 meters movment n of r { } enviroment e has { r } robots Imprt \"x\"",
        &expect![[r#"
            Wheel a with radius 3
            weel b radius 4
            sensr s : bumper
            Sensor t
            sensor u
            senor v
            Robot r Type tw
            parallell
            movement m of r { move 2 meters
            movment n of r { }
            enviroment e has { r } robots
            Imprt "x""#]],
    );
}

#[test]
fn names_like_keywords_do_not_cut() {
    check(
        "robot r with port 1 wheel1 wheel2 with sensors { s } robot q with port 1 has { wheel1 with }
environment robot1 has { robot1 robot2 } robots with { movement1 of } moves wheels a with radius 4",
        &expect![[r#"
            robot r with port 1 wheel1 wheel2 with sensors { s }
            robot q with port 1 has { wheel1 with }
            environment robot1 has { robot1 robot2 } robots with { movement1 of } moves
            wheels a with radius 4"#]],
    );
}

#[test]
fn misspelt_keywords_cut_after_names_that_are_keywords_elsewhere() {
    check(
        "wheel distance weel a with radius 4 sensor import weel b with radius 4",
        &expect![[r"
            wheel distance
            weel a with radius 4
            sensor import
            weel b with radius 4"]],
    );
}

#[test]
fn an_entity_called_import_is_one() {
    check(
        "robot r with port 1 has { a b } wheels with sensors { s } wheel import with radius 3",
        &expect![[r"
            robot r with port 1 has { a b } wheels with sensors { s }
            wheel import with radius 3"]],
    );
}

#[test]
fn a_singular_for_the_plural_does_not_cut() {
    check(
        "robot r has { a } wheel with sensor { s } movement m of r { } wheel environment e has { r } robot with { m } moves",
        &expect![[r"
            robot r has { a } wheel with sensor { s }
            movement m of r { }
            wheel
            environment e has { r } robot with { m } moves"]],
    );
}

#[test]
fn a_keyword_for_a_name_does_not_cut() {
    check(
        "wheel robot with radius 3 movement parallel m of robot { } parallel parallel movement n of r { }
environment e has { r } robots with { parallel m } movement wheel robot r",
        &expect![[r"
            wheel robot with radius 3
            movement parallel m of robot { }
            parallel parallel movement n of r { }
            environment e has { r } robots with { parallel m } movement
            wheel
            robot r"]],
    );
}
