//! Tests of the generator and the checker: every code is reached, and small programs have the expected findings.

mod generated;
mod programs;
mod statements;

use std::collections::{BTreeMap, BTreeSet};

use expect_test::{Expect, expect};
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::TestRunner;

use super::*;

fn findings(text: &str) -> String {
    let verdict = check(text);
    let findings = verdict.findings.iter().chain(&verdict.excused);
    let lines = findings.map(|finding| format!("{} {:?}\n", finding.code, &text[finding.start..finding.end]));
    let all: String = lines.collect();
    if verdict.grammatical { all } else { format!("not grammatical\n{all}") }
}

fn expect_findings(text: &str, expected: &Expect) {
    expected.assert_eq(&findings(text));
}

/// How many of a hundred programs have a code at least.
const MIN_SHARE: u32 = 3;

#[test]
fn programs_are_grammatical_and_every_code_is_in_many_of_them() {
    const PROGRAMS: u32 = 900;
    let mut counts: BTreeMap<&str, u32> = BTreeMap::new();
    let (mut clean, mut sound) = (0, 0);
    for seed in 0..PROGRAMS {
        let text = program(u64::from(seed), 40);
        let verdict = check(&text);
        assert!(verdict.grammatical, "seed {seed}:\n{text}");
        clean += u32::from(verdict.is_clean());
        let codes: BTreeSet<&str> = verdict.findings.iter().map(|finding| finding.code).collect();
        sound += u32::from(codes.iter().all(|code| HARMLESS.contains(code)));
        for code in codes {
            *counts.entry(code).or_default() += 1;
        }
    }
    assert_eq!(counts.keys().copied().collect::<Vec<_>>(), MEANING);
    let rare: Vec<_> = counts.iter().filter(|(_, count)| **count * 100 < PROGRAMS * MIN_SHARE).collect();
    assert!(rare.is_empty(), "of {PROGRAMS} programs too few have {rare:?}");
    assert!(clean * 100 > PROGRAMS * 8, "only {clean} of {PROGRAMS} programs are clean");
    assert!(sound * 100 > PROGRAMS * 35, "only {sound} of {PROGRAMS} programs have no errors");
}

/// The warnings and hints among them: a program that has no others can be run.
const HARMLESS: [&str; 15] = [
    "deprecated-ip-clause",
    "empty-block",
    "empty-environment",
    "empty-movement",
    "idle-robot",
    "implausible-radius",
    "misplaced-type",
    "mixed-radii",
    "port-of-other-target",
    "repeated-robot",
    "repeated-sensor",
    "script-name",
    "single-parallel",
    "unused-declaration",
    "wheel-order",
];

/// Every code that a single grammatical program can have.
const MEANING: [&str; 41] = [
    "deprecated-ip-clause",
    "duplicate-name",
    "empty-block",
    "empty-environment",
    "empty-movement",
    "idle-robot",
    "implausible-radius",
    "invalid-angle",
    "invalid-arc",
    "invalid-count",
    "invalid-ip",
    "invalid-port",
    "invalid-radius",
    "invalid-speed",
    "invalid-time",
    "invalid-within",
    "misplaced-type",
    "missing-condition-word",
    "mixed-radii",
    "movement-of-other-robot",
    "movement-robot-missing",
    "nested-too-deep",
    "no-environment",
    "number-out-of-range",
    "parallel-conflict",
    "port-of-other-target",
    "recursive-movement",
    "repeated-robot",
    "repeated-sensor",
    "repeated-wheel",
    "script-name",
    "sensor-not-on-robot",
    "single-parallel",
    "slam-robot",
    "slam-sensors",
    "unresolved-reference",
    "unused-declaration",
    "wheel-count",
    "wheel-kind-mismatch",
    "wheel-order",
    "zero-distance",
];

#[test]
fn programs_without_mistakes_have_no_errors() {
    let careful = Recipe { mistakes: false, older_spellings: false, ..Recipe::default() };
    let harmless = [
        "unused-declaration",
        "single-parallel",
        "wheel-order",
        "script-name",
        "no-environment",
        "port-of-other-target",
        // In a tower of blocks: 1, which is a warning.
        "invalid-count",
    ];
    for seed in 0..300 {
        let text = careful.seeded(seed);
        let bad: Vec<_> =
            check(&text).findings.into_iter().filter(|finding| !harmless.contains(&finding.code)).collect();
        assert!(bad.is_empty(), "seed {seed}: {bad:?}\n{text}");
    }
}

#[test]
fn programs_are_reproducible() {
    assert_eq!(program(7, 30), program(7, 30));
    assert_ne!(program(7, 30), program(8, 30));
    let tidy = Recipe {
        lines: 4,
        mistakes: false,
        odd_layout: false,
        older_spellings: false,
        imports: true,
        statements: Statements::Flat,
    };
    expect![[r#"
        sensor area_1 : bumper
        sensor wheelR
        robot import with port 65535 has { print import class x9 , } wheels with sensors { ^parallel rRight area_1 distance wheelR wheelR0 }
        sensor ^parallel : distance
        wheel class with radius 4.5
        sensor wheelR0 : distance
        sensor distance
        environment None has { import } robots with { print , } moves
        wheel print with radius 4.5
        movement print of import { turn left 45 }
        sensor rRight : bumper
        wheel x9 with radius 4.5
        wheel import with radius 4.5
    "#]].assert_eq(&tidy.seeded(3));
}

#[test]
fn lexical_errors_have_their_codes() {
    expect_findings(
        "wheel a with radius 4 € $ wheel b",
        &expect![[r#"
        not grammatical
        invalid-character "€"
        invalid-character "$"
    "#]],
    );
    expect_findings(
        "sensor s /* and so on",
        &expect![[r#"
        not grammatical
        unterminated-comment "/*"
    "#]],
    );
    expect_findings(
        "import \"a.pyr\nsensor s",
        &expect![[r#"
        not grammatical
        unterminated-string "\"a.pyr"
    "#]],
    );
    expect_findings(
        "ip i 1.2.3",
        &expect![[r#"
        not grammatical
    "#]],
    );
    expect_findings(
        "\u{feff}wheel ^wheel with radius 4meters",
        &expect![[r#"
        not grammatical
    "#]],
    );
}

/// What is found in each file of a project: its path, its text, and whether its scripts are for V-REP.
fn project_findings(files: &[(&'static str, &str, bool)]) -> String {
    let source = |&(path, text, for_vrep): &(&'static str, &str, bool)| Source {
        path,
        text: text.to_owned(),
        for_vrep,
    };
    let sources: Vec<Source> = files.iter().map(source).collect();
    let verdicts = check_project(&sources).expect("grammatical files");
    let mut out = String::new();
    for (source, verdict) in sources.iter().zip(verdicts) {
        for finding in verdict.findings {
            out +=
                &format!("{} {} {:?}\n", source.path, finding.code, &source.text[finding.start..finding.end]);
        }
    }
    out
}

#[test]
fn files_import_each_other() {
    const PARTS: &str = "wheel a with radius 4 wheel b with radius 4 robot r with port 7 has { a b } wheels movement m of r { slam }";
    let main = "import \"parts/x.pyr\" environment e has { r } robots with { m } moves";
    expect![[r#"
        parts/x.pyr slam-sensors "slam"
    "#]]
    .assert_eq(&project_findings(&[("main.pyr", main, false), ("parts/x.pyr", PARTS, false)]));
    // A name means what it means in the file that uses it: `m` drives the robot of its own file.
    let own = format!(
        "{main} wheel a with radius 4 wheel b with radius 4 robot r with port 7 has {{ a b }} wheels"
    );
    expect![[r#"
        main.pyr idle-robot "r"
        main.pyr movement-robot-missing "m"
        parts/x.pyr slam-sensors "slam"
    "#]]
    .assert_eq(&project_findings(&[("main.pyr", &own, false), ("parts/x.pyr", PARTS, false)]));
    expect![[r#"
        main.pyr unresolved-import "\"../z.pyr\""
        main.pyr ambiguous-import "a"
    "#]]
    .assert_eq(&project_findings(&[
        (
            "main.pyr",
            "import \"x.pyr\" import \"y.pyr\" import \"../z.pyr\" robot r with port 7 has { a c } wheels",
            false,
        ),
        ("x.pyr", "wheel a with radius 4", false),
        ("y.pyr", "wheel a with radius 4", false),
    ]));
    let two = "import \"x.pyr\" environment e has { q r } robots";
    let robots = "robot r with port 19997 has { a b } wheels robot q with port 19997 has { a b } wheels wheel a with radius 4 wheel b with radius 4";
    expect![[r#"
        main.pyr idle-robot "q"
        main.pyr duplicate-port "r"
        main.pyr idle-robot "r"
        x.pyr port-of-other-target "19997"
        x.pyr port-of-other-target "19997"
    "#]]
    .assert_eq(&project_findings(&[("main.pyr", two, true), ("x.pyr", robots, false)]));
}

#[test]
fn projects_have_what_takes_several_files() {
    const PROJECTS: usize = 300;
    let mut runner = TestRunner::deterministic();
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for _ in 0..PROJECTS {
        let sources = Recipe::default().projects().new_tree(&mut runner).expect("a project").current();
        let verdicts = check_project(&sources).expect("grammatical files");
        let codes = verdicts.iter().flat_map(|verdict| verdict.findings.iter().map(|finding| finding.code));
        for code in codes.collect::<BTreeSet<_>>() {
            *counts.entry(code).or_default() += 1;
        }
    }
    for code in ["ambiguous-import", "unresolved-import", "duplicate-port"] {
        let count = counts.get(code).copied().unwrap_or_default();
        assert!(count * 100 >= PROJECTS * 3, "only {count} of {PROJECTS} projects have {code}: {counts:?}");
    }
}

#[test]
fn the_grammar_has_its_contextual_names() {
    expect_findings(
        "sensor distance:distance wheel import with radius.5",
        &expect![[r#"
        not grammatical
    "#]],
    );
    expect_findings("sensor distance:distance wheel import with radius 5", &expect![[""]]);
    expect_findings(
        "sensor s : ^bumper",
        &expect![[r#"
        not grammatical
    "#]],
    );
    expect_findings(
        "robot type tw r with port 1 has { } wheels",
        &expect![[r#"
        misplaced-type "type tw"
        wheel-count "{ }"
    "#]],
    );
    expect_findings(
        "robot type tw r type tw with port 1 has { } wheels",
        &expect![[r#"
        not grammatical
    "#]],
    );
}

/// These cover every state of the grammar; the last ones cover the states after a complete entity.
const SKELETONS: [&str; 14] = [
    "wheel a with radius 1",
    "wheelH a with radius 1",
    "sensor a : distance",
    "sensor a : bumper",
    "ip a 127.0.0.1",
    "robot a type tw with port 1 has { } wheels with sensors { a }",
    "robot a type fw with port 1 has { a , } wheels",
    "robot type fwh a with port 1 has { a , a } wheels with sensors { a , a , }",
    "parallel movement a of a { move 1 meters at 1 slam turn left turn right 1 }",
    "movement a of a { turn left until { a a , } move 1 centimeters }",
    "environment a with ip a has { } robots with { } moves",
    "environment a , a has { a } robots with { a , a } moves",
    "import \"a.pyr\" sensor a sensor a",
    "environment a has { a } robots sensor a",
];

/// These cover every state of a movement with blocks.
const BLOCKS: [&str; 13] = [
    "movement a of a { turn left until { a } clear within 1 meters turn left until { a } within 1 meters slam }",
    "movement a of a { turn left 1 with radius 1 meters at 1 in reverse until { a } detect slam }",
    "movement a of a { turn left with radius 1 meters until { a } }",
    "movement a of a { turn left 1 at 1 until { a } turn left 1 in reverse }",
    "movement a of a { turn left 1 until { a } turn left at 1 turn left in reverse slam }",
    "movement a of a { move 1 meters at 1 until { a , } move at 1 until { a } clear move until { a } }",
    "movement a of a { move 1 meters until { a } detect within 1 centimeters wait until { a } clear slam }",
    "movement a of a { wait 1 seconds wait 1 seconds until { a } clear do a wait until { a a } }",
    "movement a of a { repeat 1 times { } repeat 1 times { slam } slam }",
    "movement a of a { repeat until { a } { slam } repeat until { a } clear within 1 meters { } }",
    "movement a of a { if { a } detect { } if { a } { slam } else { slam } do a }",
    "movement a of a { if { a } within 1 meters { } else if { a } clear { } else { } do a }",
    "movement a of a { if { a } { repeat 1 times { if { a } { } else if { a } { } } } else { } wait 1 seconds }",
];

/// One of these completes every statement, if enough braces follow it.
const ENDS: [&str; 18] = [
    "",
    "1 meters",
    "meters",
    "until { a }",
    "left",
    "{ a }",
    "{ a } { }",
    "a }",
    "a } { }",
    "2 times { }",
    "times { }",
    "{ }",
    "seconds",
    "radius 1 meters",
    "1",
    "reverse",
    "1 meters { }",
    "1 until { a }",
];

/// Whether the rest of any skeleton completes it to a program.
fn can_go_on(beginning: &str, rests: &[Vec<tokens::Token>]) -> bool {
    let (beginning, _) = tokens::read(beginning);
    rests.iter().any(|rest| grammar::read(&[&beginning[..], rest].concat(), 0).is_some())
}

fn all_tokens(texts: impl Iterator<Item = String>) -> Vec<Vec<tokens::Token>> {
    texts.collect::<BTreeSet<_>>().iter().map(|text| tokens::read(text).0).collect()
}

fn is_inside_movement(beginning: &str) -> bool {
    let (open, closed) = (beginning.matches('{').count(), beginning.matches('}').count());
    beginning.contains("movement a of") && open > closed
}

/// Accepted but deprecated spellings.
fn is_older_spelling(beginning: &str, word: &str) -> bool {
    match word {
        "type" => beginning.ends_with("robot"),
        "," => beginning.ends_with("environment a"),
        _ => false,
    }
}

#[test]
fn continuations_are_what_can_be_continued() {
    let split = SKELETONS.map(|text| text.split(' ').collect::<Vec<_>>());
    let rests = split.iter().flat_map(|words| (0..=words.len()).map(|from| words[from..].join(" ")));
    let rests = all_tokens(rests);
    let ends = ENDS.iter().flat_map(|end| (0..=4).map(move |depth| format!("{end}{}", " }".repeat(depth))));
    let ends = all_tokens(ends);
    let blocks = BLOCKS.map(|text| text.split(' ').collect::<Vec<_>>());
    let all = || split.iter().chain(&blocks);
    let fixed: BTreeSet<&str> = all().flatten().copied().filter(|word| is_fixed(word)).collect();
    let beginnings = all().flat_map(|words| (0..=words.len()).map(|end| words[..end].join(" ")));
    for beginning in beginnings.collect::<BTreeSet<_>>() {
        let expected = continuations(&beginning).unwrap_or_else(|| panic!("{beginning}"));
        let rests = if is_inside_movement(&beginning) { &ends } else { &rests };
        let takes_name = can_go_on(&format!("{beginning} a"), rests);
        for word in &fixed {
            // Where a name fits, contextual keywords fit, too.
            if !(takes_name && CONTEXTUAL.contains(word)) {
                let goes_on =
                    !is_older_spelling(&beginning, word) && can_go_on(&format!("{beginning} {word}"), rests);
                assert_eq!(expected.contains(word), goes_on, "`{word}` after {beginning:?}: {expected:?}");
            }
        }
        assert_eq!(continuations(&format!("{beginning} meters meters")), None);
    }
}

const CONTEXTUAL: [&str; 15] = [
    "distance", "bumper", "import", "wait", "seconds", "repeat", "times", "if", "else", "do", "clear",
    "detect", "within", "in", "reverse",
];

fn is_fixed(word: &str) -> bool {
    CONTEXTUAL.contains(&word)
        || matches!(tokens::read(word).0[0].kind, tokens::Kind::Keyword | tokens::Kind::Sign)
}
