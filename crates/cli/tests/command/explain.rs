//! `pydslrep explain`.

use expect_test::expect;
use pydslrep_analysis::diagnostics::CATALOGUE;

use crate::process::Place;

#[test]
fn a_page_for_people() {
    let done = Place::new().run(&["explain", "invalid-radius"]);
    assert_eq!((done.code, done.err.as_str()), (Some(0), ""));
    expect![[r#"
        invalid-radius

        Error · quick fix: no

        A wheel's radius is zero or negative, below 0.001 centimetres, or above 100000
        (a kilometre).

        Why it matters

        The radius is the distance from the centre of the wheel to its edge, in
        centimetres. The script divides by it to compute how fast the wheel turns, and a
        wheel without size cannot roll.

        Example

            wheel wheelL with radius 0

        This says:

            line 1: error: a wheel's radius must be above zero, not 0 cm
              help: write the radius in centimetres, such as `4.5`

        Write instead

            wheel wheelL with radius 4.5
    "#]]
    .assert_eq(&done.out);
}

#[test]
fn every_code_is_listed_and_has_its_page() {
    let place = Place::new();
    let list = place.run(&["explain"]);
    assert_eq!((list.code, list.err.as_str()), (Some(0), ""));
    assert!(list.out.lines().all(|line| line.len() <= 80), "{}", list.out);
    for rule in CATALOGUE {
        let start = format!("{} ", rule.code);
        let line = list.out.lines().find(|line| line.starts_with(&start)).unwrap();
        assert!(line.contains(rule.severity.word()), "{line}");
        let page = place.run(&["explain", rule.code]);
        assert_eq!(page.code, Some(0));
        assert!(page.out.starts_with(rule.code) && page.out.contains("Write instead"), "{}", page.out);
    }
}

#[test]
fn colours_only_where_they_are_wanted() {
    let place = Place::new();
    assert!(!place.run(&["explain", "wheel-count"]).out.contains('\u{1b}'));
    let coloured = place.run(&["explain", "wheel-count", "--color", "always"]).out;
    assert!(coloured.starts_with("\u{1b}[1mwheel-count\u{1b}[0m\n"), "{coloured}");
}

#[test]
fn unknown_codes_get_a_suggestion() {
    let done = Place::new().run(&["explain", "invalid-radus"]);
    assert_eq!((done.code, done.out.as_str()), (Some(2), ""));
    expect![[r#"
        error: there is no diagnostic `invalid-radus`
         |
         = help: did you mean `invalid-radius`?
    "#]]
    .assert_eq(&done.err);
    for (word, expected) in [
        ("unused", "did you mean `unused-declaration`?"),
        ("unused-variable", "did you mean `unused-declaration`?"),
        ("Port", "did you mean `invalid-port`, `port-of-other-target` or `duplicate-port`?"),
    ] {
        let done = Place::new().run(&["explain", word]);
        assert_eq!(done.code, Some(2), "{word}");
        assert!(done.err.contains(expected), "{}", done.err);
    }
    let done = Place::new().run(&["explain", "E0308"]);
    assert_eq!(done.code, Some(2));
    assert!(done.err.contains("`pydslrep explain` lists them all"), "{}", done.err);
}
