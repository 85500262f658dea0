//! Whole and broken programs: what is understood, and that each mistake is reported once.

use expect_test::{Expect, expect};
use proptest::prelude::*;
use pydslrep_syntax::ast::{Action, ActionKind, Block, Condition, Entity, References, Within};
use pydslrep_syntax::{EntityKind, KEYWORDS, TokenKind, expected_after, lex, parse};

fn list(refs: Option<&References>) -> String {
    let Some(refs) = refs else { return "-".to_owned() };
    let names: Vec<&str> = refs.names.iter().map(|name| name.text.as_str()).collect();
    format!("{{{}}}{}", names.join(" "), if refs.broken { "?" } else { "" })
}

fn gist_of_block(block: Option<&Block>) -> String {
    let Some(block) = block else { return "-".to_owned() };
    let actions: Vec<String> = block.actions.iter().map(gist_of_action).collect();
    format!("[{}]", actions.join(" "))
}

fn gist_of_condition(condition: &Condition) -> String {
    let state = condition.state.map(|(state, _)| format!(" {state:?}").to_lowercase()).unwrap_or_default();
    let length = |within: &Within| within.distance.as_ref().and_then(|number| number.value);
    let within = condition.within.as_ref().map(|within| format!(" within {:?}", length(within)));
    format!("{}{state}{}", list(Some(&condition.sensors)), within.unwrap_or_default())
}

fn gist_of_action(action: &Action) -> String {
    let until = action.until().map(|condition| format!(" until {}", gist_of_condition(condition)));
    let until = until.unwrap_or_default();
    let rest = match &action.kind {
        ActionKind::Move(_) | ActionKind::Wait(_) | ActionKind::Slam => until,
        ActionKind::Turn(turn) => {
            let circle = if turn.circle.is_some() { " with radius" } else { "" };
            let reverse = if turn.reverse.is_some() { " in reverse" } else { "" };
            format!("{circle}{reverse}{until}")
        }
        ActionKind::Repeat(repeat) => format!("{until} {}", gist_of_block(repeat.block.as_ref())),
        ActionKind::If(choice) => {
            let branches = choice.branches.iter().map(|branch| {
                let condition = branch.condition.as_ref().map(gist_of_condition).unwrap_or_default();
                format!(" {condition} {}", gist_of_block(branch.block.as_ref()))
            });
            let otherwise =
                choice.otherwise.as_ref().map(|block| format!(" else {}", gist_of_block(Some(block))));
            format!("{}{}", branches.collect::<String>(), otherwise.unwrap_or_default())
        }
        ActionKind::Do(call) => format!(" {}", call.movement.as_ref().map_or("-", |name| name.text.as_str())),
    };
    format!("{}{rest}", action.keyword().spelling().unwrap_or_default())
}

fn gist(entity: &Entity) -> String {
    let name = entity.name().map_or("-", |name| name.text.as_str());
    let rest = match entity {
        Entity::Import(import) => format!("{:?}", import.path),
        Entity::Wheel(wheel) => format!("{:?}", wheel.radius.as_ref().and_then(|radius| radius.value)),
        Entity::Sensor(sensor) => format!("{:?}", sensor.kind.map(|(kind, _)| kind)),
        Entity::Ip(ip) => format!("{:?}", ip.address.as_ref().map(|(address, _)| address)),
        Entity::Robot(robot) => format!(
            "{:?} {:?} {} {}",
            robot.drive.and_then(|clause| clause.word),
            robot.port.as_ref().map(|port| port.value),
            list(robot.wheels.as_ref()),
            list(robot.sensors.as_ref())
        ),
        Entity::Movement(movement) => {
            let actions: Vec<String> = movement.actions.iter().map(gist_of_action).collect();
            format!("{:?} [{}]", movement.robot.as_ref().map(|name| &name.text), actions.join(" "))
        }
        Entity::Environment(environment) => format!(
            "{:?} {} {}",
            environment.ip.as_ref().and_then(|clause| clause.name.as_ref()).map(|name| &name.text),
            list(environment.robots.as_ref()),
            list(environment.movements.as_ref())
        ),
    };
    format!("{} {name} {rest}", entity.kind().map_or("import", EntityKind::noun))
}

fn render(text: &str) -> String {
    let mut out = String::new();
    for (span, parse) in parse(text) {
        if let Some(entity) = &parse.entity {
            out += &format!("{}\n", gist(entity));
        }
        for error in &parse.errors {
            let at = error.span.shifted(span.start);
            out += &format!("  {}..{} {:?}\n", at.start, at.end, error.kind);
        }
    }
    out
}

fn check(text: &str, expected: &Expect) {
    expected.assert_eq(&render(text));
}

#[test]
fn the_articles_programs_have_no_syntax_errors() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/paper");
    let mut programs = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let text = std::fs::read_to_string(entry.unwrap().path()).unwrap();
        assert!(parse(&text).iter().all(|(_, parse)| parse.errors.is_empty() && parse.entity.is_some()));
        programs += 1;
    }
    assert_eq!(programs, 6);
}

#[test]
fn everything_the_grammar_has() {
    check(
        r#"import "parts/wheels.pyr"
wheelH ^robots with radius 4
sensor s : bumper sensor t
ip here 127.0.0.1
robot type tw r with port 1 has { a, b, } wheels
robot q with port 70000 has { a b, c d } wheels with sensors { s, t }
parallel movement m of r { move -4 meters at 9 turn left turn right -30.5 turn left until { s } slam }
environment e, here has { r } robots
environment f with ip here has { r q } robots with { m m } moves"#,
        &expect![[r#"
            import - Some("parts/wheels.pyr")
            wheel robots Some(4.0)
            sensor s Some(Bumper)
            sensor t None
            ip here Some("127.0.0.1")
            robot r Some(TwoWheel) Some(Some(1)) {a b} -
            robot q None Some(None) {a b c d} {s t}
            movement m Some("r") [move turn turn turn until {s} slam]
            environment e Some("here") {r} -
            environment f Some("here") {r q} {m m}
        "#]],
    );
}

#[test]
fn one_token_missing() {
    for text in [
        "wheel with radius 4.5",
        "wheel w radius 4.5",
        "wheel w with 4.5",
        "wheel w with radius",
        "wheel",
        "robot r type with port 1 has { a b } wheels",
        "robot r port 1 has { a b } wheels",
        "robot r with 1 has { a b } wheels",
        "robot r with port has { a b } wheels",
        "robot r with port 1 { a b } wheels",
        "robot r with port 1 has a b } wheels",
        "robot r with port 1 has { a b wheels with sensors { s }",
        "robot r with port 1 has { a b } with sensors { s }",
        "robot r with port 1 has { a b } wheels with { s }",
        "robot r with port 1 has { a b } wheels with sensors s }",
        "robot r with port 1 has { a b } wheels with sensors { s",
        "robot r has { a b } wheels",
        "movement m r { slam }",
        "movement m of { slam }",
        "movement m of r slam }",
        "movement m of r { slam",
        "movement m of r { move meters turn left }",
        "movement m of r { move 4 turn left }",
        "movement m of r { move 4 meters at turn left }",
        "movement m of r { turn 90 slam }",
        "parallel m of r { slam }",
        "environment e { r } robots",
        "environment e has { r robots with { m } moves",
        "environment e has { r } with { m } moves",
        "environment e has { r } robots with { m }",
        "environment e has { r } robots { m } moves",
        "environment e with i has { r } robots",
        "ip here",
    ] {
        let rendered = render(text);
        assert_eq!(rendered.matches("\n  ").count(), 1, "{text}\n{rendered}");
    }
}

#[test]
fn misspelt_keywords() {
    check(
        "wheel w wiht radius 4 robot r tpye tw with prot 1 has { a b } wheel with sensor { s }
movement m fo r { mvoe 4 metres turn lefft until { s } slm }
weel v with radius 3 environment e has { r } robot with { m } move",
        &expect![[r#"
            wheel w Some(4.0)
              8..12 Misspelt { written: "wiht", keyword: With }
            robot r None Some(Some(1)) {a b} {s}
              30..34 Misspelt { written: "tpye", keyword: Type }
              43..47 Misspelt { written: "prot", keyword: Port }
              62..67 Misspelt { written: "wheel", keyword: Wheels }
              73..79 Misspelt { written: "sensor", keyword: Sensors }
            movement m Some("r") [turn until {s}]
              97..99 Misspelt { written: "fo", keyword: Of }
              104..108 Misspelt { written: "mvoe", keyword: Move }
              123..128 Misspelt { written: "lefft", keyword: Left }
              141..144 Misspelt { written: "slm", keyword: Slam }
            wheel v Some(3.0)
              147..151 Misspelt { written: "weel", keyword: Wheel }
            environment e None {r} {m}
              192..197 Misspelt { written: "robot", keyword: Robots }
              209..213 Misspelt { written: "move", keyword: Moves }
        "#]],
    );
}

#[test]
fn doubled_and_misplaced() {
    check(
        "wheel wheel a with with radius radius 4 4
robot r with port 1 has { { a,, b } } wheels
movement m of r { move 4 4 meters turn 90 left turn left right , }
} environment e has ( r ) robots",
        &expect![[r#"
            wheel - None
              5..5 Missing { expected: [NameOf(Wheel)], found: End, inside: Some(Wheel) }
            wheel a Some(4.0)
              19..23 Unexpected { expected: [Word(Radius)], found: Text("with"), inside: Some(Wheel) }
              31..37 Unexpected { expected: [Number(Radius)], found: Text("radius"), inside: Some(Wheel) }
              40..41 Unexpected { expected: [Declaration], found: Text("4"), inside: Some(Wheel) }
            robot r None Some(Some(1)) {a b}? -
              68..69 Unexpected { expected: [ReferenceTo(Wheel)], found: Text("{"), inside: Some(Robot) }
              72..73 Unexpected { expected: [ReferenceTo(Wheel)], found: Text(","), inside: Some(Robot) }
              78..79 Unexpected { expected: [Word(Wheels)], found: Text("}"), inside: Some(Robot) }
            movement m Some("r") [move turn turn]
              112..113 Unexpected { expected: [Word(Meters), Word(Centimeters)], found: Text("4"), inside: Some(Movement) }
              126..128 Unexpected { expected: [Word(Left), Word(Right)], found: Text("90"), inside: Some(Movement) }
              144..149 Unexpected { expected: [Word(With), Word(At), Word(Until), Word(In), Number(Angle), Action], found: Text("right"), inside: Some(Movement) }
              154..155 Unexpected { expected: [Declaration], found: Text("}"), inside: Some(Movement) }
            environment e None {r} -
              174..175 InvalidCharacter { written: "(" }
              178..179 InvalidCharacter { written: ")" }
        "#]],
    );
}

#[test]
fn two_complaints_that_are_one_mistake() {
    check(
        "wheel a radius with 4 robot r with port 1 has a b wheels movement m r of { move meters 4 turn left until }
environment e has {{ r }} robots with moves { m }",
        &expect![[r#"
            wheel a Some(4.0)
              8..14 Misplaced { written: "radius", to: 19, inside: Some(Wheel) }
            robot r None Some(Some(1)) {a b} -
              45..45 Unbraced { close: 27, inside: Some(Robot) }
            movement m None [move turn until {}?]
              68..69 Misplaced { written: "r", to: 15, inside: Some(Movement) }
              80..86 Misplaced { written: "meters", to: 31, inside: Some(Movement) }
              104..104 Missing { expected: [Word(OpenBrace)], found: Text("}"), inside: Some(Movement) }
            environment e None {r}? {m}
              126..127 Unexpected { expected: [ReferenceTo(Robot)], found: Text("{"), inside: Some(Environment) }
              145..150 Misplaced { written: "moves", to: 49, inside: Some(Environment) }
        "#]],
    );
}

#[test]
fn paths_without_quotes_are_one_mistake() {
    check(
        "import 'parts.pyr' // mine\nimport <more.pyr>;\nwheel a with radius 4",
        &expect![[r#"
            import - None
              7..18 Unexpected { expected: [Path], found: Text("'parts.pyr'"), inside: None }
              34..35 InvalidCharacter { written: "<" }
              39..40 InvalidName { written: "more.pyr" }
              43..45 InvalidCharacter { written: ">;" }
            wheel a Some(4.0)
        "#]],
    );
}

#[test]
fn keywords_for_names() {
    check(
        "wheel left with radius 3 robot r with port 1 has { left radius } wheels movement slam of turn { slam }",
        &expect![[r#"
            wheel left Some(3.0)
              6..10 KeywordAsName { written: "left", of: Wheel }
            robot r None Some(Some(1)) {left radius} -
              51..55 KeywordAsName { written: "left", of: Wheel }
              56..62 KeywordAsName { written: "radius", of: Wheel }
            movement slam Some("turn") [slam]
              81..85 KeywordAsName { written: "slam", of: Movement }
              89..93 KeywordAsName { written: "turn", of: Robot }
        "#]],
    );
}

#[test]
fn numbers_that_are_none() {
    check(
        "wheel a with radius 4. robot r with port 3.5 has { a 3 } wheels movement m of r { move 1.2.3 meters turn left 1.2.3.4 turn left until { } }",
        &expect![[r#"
            wheel a None
              20..22 MalformedNumber { written: "4." }
            robot r None Some(None) {a}? -
              41..44 PortNotWhole { written: "3.5" }
              53..54 Unexpected { expected: [Word(Comma), ReferenceTo(Wheel)], found: Text("3"), inside: Some(Robot) }
            movement m Some("r") [move turn turn until {}]
              87..92 MalformedNumber { written: "1.2.3" }
              110..117 MalformedNumber { written: "1.2.3.4" }
              134..137 EmptyList { of: Sensor }
        "#]],
    );
}

#[test]
fn an_open_end_is_reported_at_its_own_entity() {
    check(
        "robot r with port 1 has { a b\n\nmovement m of r { move 4.0 meters\n\nwheel w with radius 3",
        &expect![[r#"
            robot r None Some(Some(1)) {a b} -
              29..29 Missing { expected: [Word(CloseBrace), Word(Comma), ReferenceTo(Wheel)], found: End, inside: Some(Robot) }
            movement m Some("r") [move]
              64..64 Missing { expected: [Word(CloseBrace), Word(At), Word(Until), Action], found: End, inside: Some(Movement) }
            wheel w Some(3.0)
        "#]],
    );
}

#[test]
fn signs_that_are_none() {
    check(
        "wheel rüd with radius 4,5 §\n/* open\nwheel a with radius 3",
        &expect![[r#"
            wheel rüd Some(4.0)
              7..9 InvalidName { written: "rüd" }
              24..25 Unexpected { expected: [Declaration], found: Text(","), inside: Some(Wheel) }
              30..32 UnterminatedComment
        "#]],
    );
    check(
        "import \"a.pyr\nwheel a with radius 3 import b",
        &expect![[r#"
        import - Some("a.pyr")
          7..13 UnterminatedString
        wheel a Some(3.0)
          36..42 Unexpected { expected: [Declaration], found: Text("import"), inside: Some(Wheel) }
    "#]],
    );
}

fn check_expected(text: &str, expected: &Expect) {
    expected.assert_eq(&format!("{:?}", expected_after(text, &lex(text))));
}

#[test]
fn the_grammar_says_what_can_follow() {
    check_expected("", &expect!["[Declaration]"]);
    check_expected("wheel", &expect!["[NameOf(Wheel)]"]);
    check_expected("wheel a", &expect!["[Word(With)]"]);
    check_expected("wheel a with radius 4", &expect!["[Declaration]"]);
    check_expected("sensor s", &expect!["[Word(Colon), Declaration]"]);
    check_expected("sensor s :", &expect!["[Word(Distance), Word(Bumper)]"]);
    check_expected("robot r", &expect!["[Word(With), Word(Type)]"]);
    check_expected("robot r type", &expect!["[Word(Tw), Word(Fw), Word(Fwh)]"]);
    check_expected("robot r with", &expect!["[Word(Port)]"]);
    check_expected("robot r with port 1 has {", &expect!["[Word(CloseBrace), ReferenceTo(Wheel)]"]);
    check_expected(
        "robot r with port 1 has { a",
        &expect!["[Word(CloseBrace), Word(Comma), ReferenceTo(Wheel)]"],
    );
    check_expected("robot r with port 1 has { a b } wheels", &expect!["[Word(With), Declaration]"]);
    check_expected(
        "robot r with port 1 has { a b } wheels with sensors {",
        &expect!["[ReferenceTo(Sensor)]"],
    );
    check_expected("movement m of", &expect!["[ReferenceTo(Robot)]"]);
    check_expected("movement m of r {", &expect!["[Word(CloseBrace), Action]"]);
    check_expected("movement m of r { move 4", &expect!["[Word(Meters), Word(Centimeters)]"]);
    check_expected(
        "movement m of r { move 4 meters",
        &expect!["[Word(CloseBrace), Word(At), Word(Until), Action]"],
    );
    check_expected(
        "movement m of r { turn left",
        &expect!["[Word(CloseBrace), Word(With), Word(At), Word(Until), Word(In), Number(Angle), Action]"],
    );
    check_expected(
        "movement m of r { turn left until { s",
        &expect!["[Word(CloseBrace), Word(Comma), ReferenceTo(Sensor)]"],
    );
    check_expected("environment e", &expect!["[Word(With), Word(Has)]"]);
    check_expected(
        "environment e has { r } robots with {",
        &expect!["[Word(CloseBrace), ReferenceTo(Movement)]"],
    );
    // A mistake before the cursor does not change what fits at it.
    check_expected("movment m of r {", &expect!["[Word(CloseBrace), Action]"]);
    check_expected("Wheel a with radius", &expect!["[Number(Radius)]"]);
    check_expected("robot r tpye tw with port has { a } wheel with", &expect!["[Word(Sensors)]"]);
}

proptest! {
    #[test]
    fn any_text_is_parsed_and_tiled(text in any_text()) {
        let pieces = parse(&text);
        let mut end = 0;
        for (span, parse) in &pieces {
            prop_assert_eq!(span.start, end);
            end = span.end;
            for error in &parse.errors {
                prop_assert!(error.span.end <= span.len());
                prop_assert!(text.is_char_boundary((span.start + error.span.start) as usize));
            }
        }
        prop_assert_eq!(end as usize, text.len());
    }

    /// An entity means the same wherever it is, which is what lets an edit touch it alone.
    #[test]
    fn a_piece_parses_alone_as_it_does_in_its_file(text in any_text()) {
        for (span, parsed) in parse(&text) {
            let alone = parse(span.text(&text));
            prop_assert_eq!(alone.len(), 1, "{:?}", span.text(&text));
            prop_assert_eq!(&alone[0].1, &parsed);
        }
    }
}

fn any_text() -> impl Strategy<Value = String> {
    let word = prop_oneof![
        6 => proptest::sample::select(KEYWORDS.map(|(_, word)| word).to_vec()).prop_map(str::to_owned),
        4 => proptest::sample::select(vec![
            "{", "}", ",", ":", "/*", "*/", "//", "\"", "\n", "\r", "^", "-", ".", "a", "b1", "4.5", "90", "1.2.3.4", "movment", "Wheel", "sensr", "Import", "a-1", "robot-1", "-1a", "é", "🤖", "\u{feff}",
        ])
        .prop_map(str::to_owned),
        1 => ".{0,4}",
    ];
    proptest::collection::vec(word, 0..40).prop_map(|words| words.join(" "))
}

#[test]
fn blocks_and_conditions() {
    check(
        "movement m of r { repeat 4 times { move 1 meters repeat until { a b } detect within 40 centimeters { } }
  if { a } clear { turn left 6 with radius 80 centimeters at 9 in reverse until { b } detect } else if { b } detect { do m } else { slam }
  move until { a } detect move at 9 until { a } clear move 1 meters at 9 until { a } clear
  wait 2 seconds wait until { a } clear wait 2 seconds until { a } clear turn left until { a } do if wait 1 seconds }",
        &expect![[r#"
            movement m Some("r") [repeat [move repeat until {a b} detect within Some(40.0) []] if {a} clear [turn with radius in reverse until {b} detect] {b} detect [do m] else [slam] move until {a} detect move until {a} clear move until {a} clear wait wait until {a} clear wait until {a} clear turn until {a} do if wait]
        "#]],
    );
}

#[test]
fn one_mistake_in_a_block() {
    for text in [
        "repaet 4 times { move 1 meters } turn left",
        "repeat 4 tiems { move 1 meters } turn left",
        "repeat times { move 1 meters } turn left",
        "repeat 4 { move 1 meters } turn left",
        "repeat 4 times move 1 meters } turn left",
        "loop 4 times { move 1 meters } turn left",
        "repeat until a } detect { move 1 meters } turn left",
        "repeat until { a detect { move 1 meters } turn left",
        "repeat until { a } detected { move 1 meters } turn left",
        "repeat until { a } free { move 1 meters } turn left",
        "if { a } clear move 1 meters } turn left",
        "fi { a } clear { move 1 meters } turn left",
        "if { move 1 meters } turn left",
        "if { wait 1 seconds } turn left",
        "repeat until { move 1 meters } turn left",
        "if { a } detect then { move 1 meters } turn left",
        "if { a } detect and { a } detect { move 1 meters } turn left",
        "if { a } and { a } clear within 1 meters { move 1 meters } turn left",
        "if { a } or { a, a } { do m } turn left",
        "while { a } clear { move 1 meters } turn left",
        "if { a } clear { move 1 meters } esle { move 1 meters } turn left",
        "if { a } clear { move 1 meters } else move 1 meters } turn left",
        "else { move 1 meters } turn left",
        "wait 2 secs turn left",
        "wait 2 turn left",
        "wait seconds turn left",
        "wiat 2 seconds turn left",
        "turn left until { a wait 2 seconds turn left",
        "turn left until { a repeat until { a } clear { move 1 meters } turn left",
        "turn left until { a if { a } clear { move 1 meters } turn left",
        "move until a, a clear turn left",
        "if a detect { move 1 meters } turn left",
        "move at 4 meters turn left",
        "do wait until { a } clear turn left",
        "do if { a } clear { move 1 meters } turn left",
        "do wait 1 seconds turn left",
        "do repeat 2 times { move 1 meters } turn left",
        "do do side turn left",
        "turn left until { a repeat 2 times { move 1 meters } turn left",
        "turn left until { a wait until { a } clear turn left",
        "move until { a } clear within 4 turn left",
        "move until { a } clear within meters turn left",
        "turn left with 4 meters turn left",
        "turn left with radius 4 turn left",
        "turn left with radius meters turn left",
        "turn left in turn left",
        "turn left in revers turn left",
        "turn left until turn left",
    ] {
        let rendered = render(&format!("movement m of r {{ {text} }} sensor a"));
        assert_eq!(rendered.matches("\n  ").count(), 1, "{text}\n{rendered}");
        assert!(rendered.contains("turn") && rendered.contains("sensor a None"), "{text}\n{rendered}");
    }
}

/// An action that somebody is writing right before the brace of the movement or of a block, which stays its brace.
#[test]
fn an_action_that_is_begun_takes_no_brace() {
    for begun in [
        "move",
        "move 4",
        "move 1 meters at",
        "move 1 meters until",
        "move until",
        "turn",
        "turn left until",
        "turn left 90 with",
        "turn left 90 with radius",
        "turn left 90 with radius 1",
        "turn left in",
        "wait",
        "wait 2",
        "wait until",
        "repeat",
        "repeat 4",
        "repeat 4 times",
        "repeat until",
        "repeat until { a } detect",
        "if",
        "if { a } detect",
        "if { a } detect within",
        "if { a } detect within 1",
        "if { a } clear { slam } else",
        "if { a } clear { slam } else if",
        "do",
    ] {
        for (text, before, after) in [
            (format!("turn left {begun} }} sensor a"), "[turn", "]"),
            (format!("turn left {begun} repeat 2 times {{ slam }} }} sensor a"), "[turn", "repeat [slam]]"),
            (format!("repeat 2 times {{ turn left {begun} }} slam }} sensor a"), "[repeat [turn", "] slam]"),
            (format!("repeat 2 times {{ {begun} turn right }} slam }} sensor a"), "[repeat [", "turn] slam]"),
        ] {
            let rendered = render(&format!("movement m of r {{ {text}"));
            assert_eq!(rendered.matches("\n  ").count(), 1, "{text}\n{rendered}");
            let tree = rendered.lines().next().unwrap_or_default();
            assert!(tree.contains(before) && tree.ends_with(after), "{text}\n{rendered}");
            assert!(rendered.contains("sensor a None"), "{text}\n{rendered}");
        }
    }
}

#[test]
fn mistakes_in_two_actions_stay_two() {
    check(
        "movement m of r { wait 2 secs do wait 1 seconds }",
        &expect![[r#"
        movement m Some("r") [wait do - wait]
          25..29 Unexpected { expected: [Word(Seconds)], found: Text("secs"), inside: Some(Movement) }
          32..32 Missing { expected: [ReferenceTo(Movement)], found: Text("wait"), inside: Some(Movement) }
    "#]],
    );
}

#[test]
fn blocks_of_any_depth_are_parsed() {
    for count in [39, 40, 41, 100_000] {
        let open = "repeat 2 times { ".repeat(count);
        let text = format!("movement m of r {{ {open} slam {} }} sensor a", "} ".repeat(count));
        let pieces = parse(&text);
        assert_eq!(pieces.len(), 2);
        assert!(pieces.iter().all(|(_, parse)| parse.errors.is_empty()), "{count}");
        let unclosed = parse(&format!("movement m of r {{ {open} sensor a"));
        assert_eq!(unclosed.iter().map(|(_, parse)| parse.errors.len()).sum::<usize>(), 1, "{count}");
    }
}

#[test]
fn every_contextual_word_is_a_name() {
    for word in TokenKind::CONTEXTUAL {
        let word = word.spelling().unwrap();
        let text = format!(
            "wheel {word} with radius 1 sensor {word} ip {word} 1.2.3.4 robot {word} with port 1 has {{ {word} {word} }} wheels with sensors {{ {word} a }}
movement {word} of {word} {{ do {word} turn left until {{ {word}, a }} do {word} move 1 meters until {{ a {word} }} clear do {word} wait 1 seconds do {word} }}
environment {word} with ip {word} has {{ {word} }} robots with {{ {word} {word} }} moves"
        );
        let errors: Vec<_> = parse(&text).into_iter().flat_map(|(_, parse)| parse.errors).collect();
        assert_eq!(errors, [], "{text}");
    }
}
