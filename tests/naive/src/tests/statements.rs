//! The statements of "The language grows", one by one.

use expect_test::{Expect, expect};

use super::{check, check_as_article, findings, project_findings};

/// Two distance sensors, a bumper, and a movement with these statements.
fn program(statements: &str) -> String {
    format!(
        "wheel l with radius 4 wheel r with radius 4 sensor a sensor b sensor bump : bumper sensor foreign \
         robot rover with port 7 has {{ l r }} wheels with sensors {{ a b bump }} \
         robot spare with port 8 has {{ l r }} wheels with sensors {{ foreign }} movement idle of spare {{ turn left }} \
         movement m of rover {{ {statements} }} environment e has {{ rover spare }} robots with {{ m idle }} moves"
    )
}

fn expect_of(statements: &str, expected: &Expect) {
    expected.assert_eq(&findings(&program(statements)));
}

fn is_grammatical(statements: &str) -> bool {
    check(&program(statements)).grammatical
}

#[test]
fn every_form_is_in_the_grammar() {
    for statements in [
        "move 1 meters until { a } clear move at 5 until { a, b, } detect move until { a } clear within 1 meters",
        "turn left 90 with radius 1 meters at 5 in reverse until { a } clear",
        "turn left turn left 90 turn left at 5 turn left in reverse turn left with radius 5 centimeters",
        "turn left until { a } turn left until { a } detect turn left 90 until { a } within 1 meters",
        "wait 1 seconds wait 1.5 seconds until { a } clear wait until { a } detect",
        "repeat 2 times { repeat until { a } clear { } }",
        "if { a } clear { } if { a } clear { } else { } if { a } { } else if { b } { } else if { a } { } else { }",
        "do m slam do ^m",
    ] {
        assert!(is_grammatical(statements), "{statements}");
    }
}

#[test]
fn what_is_close_to_a_form_is_not() {
    for statements in [
        "move",
        "move at 5",
        "move 1 until { a } clear",
        "move 1 meters until { } clear",
        "move 1 meters until { a } clear detect",
        "move 1 meters until { a } within 1 meters clear",
        "move 1 meters until { a } clear at 5",
        "move until { a } clear within 1",
        "turn left at 5 with radius 1 meters",
        "turn left in reverse at 5",
        "turn left in",
        "turn left ^in reverse",
        "turn left with radius 1",
        "turn left with 1 meters",
        "wait",
        "wait 1",
        "wait 1 until { a } clear",
        "repeat 2 { }",
        "repeat times { }",
        "repeat { }",
        "repeat 2 times",
        "repeat until { } clear { }",
        "if { a } clear",
        "if a clear { }",
        "if { a } clear { } else",
        "if { a } clear { } else { } else { }",
        "if { a } clear { } else wait 1 seconds",
        "else { }",
        "do",
        "do { }",
        "^repeat 2 times { }",
        "repeat 2 ^times { }",
        "{ }",
    ] {
        assert!(!is_grammatical(statements), "{statements}");
    }
}

#[test]
fn a_word_is_a_name_where_a_name_can_stand() {
    const WORDS: [&str; 12] = [
        "wait", "repeat", "times", "if", "else", "do", "seconds", "clear", "detect", "within", "in",
        "reverse",
    ];
    for word in WORDS {
        let text = format!(
            "wheel {word} with radius 4 wheel r with radius 4 sensor {word} ip {word} 1.2.3.4 \
             robot {word} with port 7 has {{ {word} r }} wheels with sensors {{ {word} }} \
             movement last of {word} {{ do {word} do {word} wait 1 seconds if {{ {word} }} clear {{ do {word} }} }} \
             movement {word} of {word} {{ turn left until {{ {word} }} move 1 meters until {{ {word} }} detect }} \
             environment {word} with ip {word} has {{ {word} }} robots with {{ {word} last }} moves"
        );
        assert_eq!(findings(&text), "", "{word}");
    }
    // A movement that is missing here would have one of these names, but what follows belongs to no name.
    for statements in [
        "do wait 1 seconds",
        "do wait until { a } clear",
        "do repeat 2 times { }",
        "do if { a } clear { }",
        "do do idle",
    ] {
        assert!(!is_grammatical(statements), "{statements}");
    }
    assert!(is_grammatical("do do wait 1 seconds"));
}

#[test]
fn only_the_form_of_the_article_may_lack_its_word() {
    expect_of(
        "turn left until { a } turn left until { a, b } within 1 meters turn left 9 until { b } \
         turn left with radius 1 meters until {a} turn left at 9 until { a b } move until { a a } \
         wait until { b a } repeat until { foreign } { slam } if { bump } { slam } else if { l } { slam }",
        &expect![[r#"
            missing-condition-word "{ a, b }"
            missing-condition-word "{ b }"
            missing-condition-word "{a}"
            missing-condition-word "{ a b }"
            missing-condition-word "{ a a }"
            repeated-sensor "a"
            missing-condition-word "{ b a }"
            missing-condition-word "{ foreign }"
            sensor-not-on-robot "foreign"
            slam-sensors "slam"
            missing-condition-word "{ bump }"
            slam-sensors "slam"
            missing-condition-word "{ l }"
            unresolved-reference "l"
            slam-sensors "slam"
        "#]],
    );
}

#[test]
fn numbers_have_their_limits() {
    expect_of(
        "repeat 0 times { slam } repeat 1 times { move 0 meters } repeat 2.5 times { wait 0 seconds } \
         repeat -2 times { wait -0.0 seconds } repeat 10000 times { wait 2 seconds } \
         repeat 10001 times { wait 1 seconds } wait 86400 seconds repeat 002.0 times { wait 86400.5 seconds }",
        &expect![[r#"
            invalid-count "0"
            slam-sensors "slam"
            invalid-count "1"
            zero-distance "0"
            invalid-count "2.5"
            invalid-time "0"
            invalid-count "-2"
            invalid-time "-0.0"
            invalid-count "10001"
            invalid-time "86400.5"
        "#]],
    );
    expect_of(
        "move 1 meters until { a } clear within 0 meters move until { a bump } clear within 0.5 centimeters \
         wait until { bump } detect within 1 meters wait until { bump } detect within -1 meters \
         if { bump unknown } detect within 3 meters { slam } wait until { a } clear within 1000001 meters \
         move 0 meters at 0 until { a } clear move at -1 until { a } clear",
        &expect![[r#"
            invalid-within "0"
            invalid-within "1"
            invalid-within "-1"
            unresolved-reference "unknown"
            slam-sensors "slam"
            number-out-of-range "1000001"
            zero-distance "0"
            invalid-speed "0"
            invalid-speed "-1"
        "#]],
    );
    let endless = "9".repeat(400);
    let all = format!(
        "wait {endless} seconds repeat {endless} times {{ slam }} turn left with radius {endless} meters \
         wait until {{ a }} clear within {endless} meters"
    );
    assert_eq!(findings(&program(&all)).matches("number-out-of-range").count(), 4);
}

#[test]
fn a_circle_has_a_radius_and_an_angle() {
    expect_of(
        "turn left 720 turn left 720 with radius 1 meters turn left 36000.5 with radius 1 meters \
         turn left -90 with radius 1 meters turn left 0 with radius 1 meters turn left 0 at 1000000 \
         turn left in reverse turn left 9 at 9 in  reverse until { a } clear turn left with radius -0.0 centimeters \
         turn left with radius -1 meters turn left with radius 1000000 meters \
         turn left with radius 100000001 centimeters in reverse turn left 0 with radius 0 meters",
        &expect![[r#"
            invalid-angle "720"
            invalid-angle "36000.5"
            invalid-angle "-90"
            invalid-arc "0"
            invalid-angle "0"
            invalid-speed "1000000"
            invalid-arc "in reverse"
            invalid-arc "in  reverse"
            invalid-arc "-0.0"
            invalid-arc "-1"
            invalid-arc "100000001"
            invalid-arc "0"
            invalid-arc "0"
        "#]],
    );
}

#[test]
fn blocks_have_statements_and_a_depth() {
    expect_of(
        "repeat 2 times { } repeat until { a } clear {} if { a } clear { /* */ } else { } \
         if { a } clear { } else if { b } clear { } else { turn left }",
        &expect![[r#"
            empty-block "{ }"
            empty-block "{}"
            empty-block "{ /* */ }"
            empty-block "{ }"
            empty-block "{ }"
            empty-block "{ }"
        "#]],
    );
    let nested = |depth: usize, inner: &str| {
        format!("{}{inner}{}", "repeat 2 times { if { a } clear { ".repeat(depth / 2), "} ".repeat(depth))
    };
    let inner = "if { a } clear { turn left } else if { a } clear { wait 0 seconds } else { move 1 meters }";
    expect_of(
        &nested(14, inner),
        &expect![[r#"
        invalid-time "0"
    "#]],
    );
    expect_of(&nested(16, "turn left"), &expect![[""]]);
    expect_of(
        &nested(16, inner),
        &expect![[r#"
        nested-too-deep "if"
        invalid-time "0"
    "#]],
    );
    expect_of(
        &nested(16, "repeat 2 times { repeat 3 times { do idle } } slam repeat 2 times { turn left }"),
        &expect![[r#"
            nested-too-deep "repeat"
            movement-of-other-robot "idle"
            slam-sensors "slam"
            nested-too-deep "repeat"
        "#]],
    );
}

/// Its environment lists `one`.
const ROBOT: &str = "wheel l with radius 4 wheel r with radius 4 robot rover with port 7 has { l r } wheels \
                         environment e has { rover } robots with { one } moves ";

#[test]
fn a_movement_does_others_of_its_robot_and_never_itself() {
    expect_of(
        "do m do idle do nothing",
        &expect![[r#"
        recursive-movement "m"
        movement-of-other-robot "idle"
        unresolved-reference "nothing"
    "#]],
    );
    // Only done is used; `parallel` has no meaning there, and to lead to a circle is no mistake.
    let circle = "movement one of rover { repeat 2 times { do two } } parallel movement two of rover { do three } \
                  movement three of rover { do four do two } movement four of rover { slam } \
                  movement five of rover { turn left }";
    expect![[r#"
        recursive-movement "three"
        recursive-movement "two"
        slam-sensors "slam"
        unused-declaration "five"
    "#]]
    .assert_eq(&findings(&format!("{ROBOT}{circle}")));
    // Nothing is known of a robot that is not.
    assert_eq!(
        findings(&program("do away } movement away of nobody { turn left")),
        "unresolved-reference \"nobody\"\n"
    );
}

#[test]
fn movements_of_other_files_are_done() {
    let parts = "wheel l with radius 4 wheel r with radius 4 robot rover with port 7 has { l r } wheels ";
    let main = "import \"x.pyr\" environment e has { rover } robots with { one } moves movement one of rover { do two }";
    let files = |main: &str, other: &str| {
        project_findings(&[("main.pyr", main, false), ("x.pyr", &format!("{parts}{other}"), false)])
    };
    assert_eq!(files(main, "movement two of rover { turn left }"), "");
    expect![[r#"
        main.pyr recursive-movement "two"
        x.pyr recursive-movement "one"
    "#]]
    .assert_eq(&project_findings(&[
        ("main.pyr", main, false),
        ("x.pyr", &format!("import \"main.pyr\" {parts} movement two of rover {{ do one }}"), false),
    ]));
}

#[test]
fn a_plan_has_at_most_thirty_days() {
    let day = "wait 86400 seconds";
    let said = |statements: &str| {
        let verdict = check(&program(statements));
        let codes = |findings: &[crate::Finding]| {
            findings.iter().filter(|finding| finding.code == "invalid-time").count()
        };
        (codes(&verdict.findings), codes(&verdict.excused))
    };
    assert_eq!(said(&format!("repeat 29 times {{ {day} }}")), (0, 0));
    assert_eq!(said(&format!("repeat 31 times {{ {day} }}")), (1, 0));
    // At the outermost.
    expect_of(
        &format!("repeat 2 times {{ repeat 31 times {{ {day} }} }}"),
        &expect![[r#"
            invalid-time "2"
        "#]],
    );
    // By another movement, and by what it drives.
    assert_eq!(said(&format!("repeat 31 times {{ do day }} }} movement day of rover {{ {day}")), (1, 0));
    assert_eq!(said("repeat 3 times { move 1000000 meters at 9 }"), (1, 0));
    // What follows a condition is not known, nor how long a robot turns in place.
    assert_eq!(said(&format!("wait until {{ a }} clear repeat 31 times {{ {day} }}")), (0, 1));
    assert_eq!(said(&format!("if {{ a }} clear {{ repeat 31 times {{ {day} }} }}")), (0, 1));
    assert_eq!(said("repeat 10000 times { repeat 100 times { turn left } }"), (0, 1));
}

#[test]
fn the_article_lacks_what_is_new() {
    let text = program(
        "move 1 meters at 9 move 1 meters until { a } clear turn left until { a } turn left 90 \
         turn left until { a } clear turn left 9 until { a } clear \
         turn left with radius 1 meters at 5 in reverse until { a } within 2 meters \
         wait 1 seconds repeat 2 times { if { a } detect { do m } else if { b } clear { slam } }",
    );
    let text = format!("import \"x.pyr\" {text}");
    let verdict = check_as_article(&text);
    let new = verdict.findings.iter().filter(|finding| finding.code == "not-in-article");
    let parts: Vec<&str> = new.map(|finding| &text[finding.start..finding.end]).collect();
    expect![[r#"
        "x.pyr"
        until { a } clear
        clear
        until { a } clear
        with radius 1 meters
        at 5
        in reverse
        until { a } within 2 meters
        wait
        repeat
        if
        do
    "#]]
    .assert_eq(&(parts.join("\n") + "\n"));
    assert!(check(&text).findings.iter().all(|finding| finding.code != "not-in-article"));
}
