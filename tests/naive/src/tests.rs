//! Tests of the generator and the checker: every code is reached, and small programs have the expected findings.

use std::collections::BTreeSet;

use expect_test::{Expect, expect};

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

#[test]
fn programs_are_grammatical_and_reach_every_code() {
    let mut reached = BTreeSet::new();
    let mut clean = 0;
    for seed in 0..1_000 {
        let text = program(seed, 40);
        let verdict = check(&text);
        assert!(verdict.grammatical, "seed {seed}:\n{text}");
        clean += u32::from(verdict.is_clean());
        reached.extend(verdict.findings.iter().map(|finding| finding.code));
    }
    assert_eq!(reached.into_iter().collect::<Vec<_>>(), MEANING);
    assert!(clean > 100, "only {clean} programs are clean");
}

/// Every code that a single grammatical program can have.
const MEANING: [&str; 32] = [
    "deprecated-ip-clause",
    "duplicate-name",
    "empty-environment",
    "empty-movement",
    "idle-robot",
    "implausible-radius",
    "invalid-angle",
    "invalid-ip",
    "invalid-port",
    "invalid-radius",
    "invalid-speed",
    "misplaced-type",
    "mixed-radii",
    "movement-robot-missing",
    "no-environment",
    "number-out-of-range",
    "parallel-conflict",
    "port-of-other-target",
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
    let tidy = Recipe { lines: 4, mistakes: false, odd_layout: false, older_spellings: false, imports: true };
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

/// Whether the rest of any skeleton completes it to a program.
fn can_go_on(beginning: &str, rests: &[Vec<tokens::Token>]) -> bool {
    let (beginning, _) = tokens::read(beginning);
    rests.iter().any(|rest| grammar::read(&[&beginning[..], rest].concat(), 0).is_some())
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
    let rests: Vec<_> = rests.collect::<BTreeSet<_>>().iter().map(|rest| tokens::read(rest).0).collect();
    let fixed: BTreeSet<&str> = split.iter().flatten().copied().filter(|word| is_fixed(word)).collect();
    for beginning in split.iter().flat_map(|words| (0..=words.len()).map(|end| words[..end].join(" "))) {
        let expected = continuations(&beginning).unwrap_or_else(|| panic!("{beginning}"));
        let takes_name = can_go_on(&format!("{beginning} a"), &rests);
        for word in &fixed {
            // Where a name fits, contextual keywords fit, too.
            if !(takes_name && CONTEXTUAL.contains(word)) {
                let goes_on =
                    !is_older_spelling(&beginning, word) && can_go_on(&format!("{beginning} {word}"), &rests);
                assert_eq!(expected.contains(word), goes_on, "`{word}` after {beginning:?}: {expected:?}");
            }
        }
        assert_eq!(continuations(&format!("{beginning} meters meters")), None);
    }
}

const CONTEXTUAL: [&str; 3] = ["distance", "bumper", "import"];

fn is_fixed(word: &str) -> bool {
    CONTEXTUAL.contains(&word)
        || matches!(tokens::read(word).0[0].kind, tokens::Kind::Keyword | tokens::Kind::Sign)
}
