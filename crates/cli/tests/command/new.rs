//! `pydslrep new`.

use crate::process::Place;

#[test]
fn the_program_is_clean_and_builds() {
    let place = Place::new();
    // A keyword, and the name of a Python module, are good names too.
    for name in ["patrol", "robots", "json", "rooms/hall_2"] {
        let done = place.run(&["new", name]);
        assert_eq!((done.code, done.err.as_str()), (Some(0), ""), "{name}");
        let last = name.rsplit('/').next().unwrap();
        assert!(done.out.contains(&format!("pydslrep run {name}/{last}.pyr")), "{}", done.out);
        assert_eq!(place.run(&["check", "--deny", "warnings", name]).code, Some(0), "{name}");
        assert_eq!(place.run(&["build", name]).code, Some(0), "{name}");
        let planned = place.run(&["plan", &format!("{name}/{last}.pyr")]);
        assert_eq!((planned.code, planned.err.as_str()), (Some(0), ""), "{name}");
        assert!(place.path(&format!("{name}/{last}_area.py")).exists(), "{name}");
    }
}

#[test]
fn nothing_is_overwritten() {
    let place = Place::with("patrol/notes.txt", "mine");
    let done = place.run(&["new", "patrol"]);
    assert_eq!(done.code, Some(2));
    assert!(done.err.contains("patrol already exists"), "{}", done.err);
    assert!(!place.path("patrol/patrol.pyr").exists());
}

#[test]
fn names_are_files_on_every_system() {
    let done = Place::new().run(&["new", "Con"]);
    assert_eq!(done.code, Some(2));
    assert!(done.err.contains("Windows has no files called `Con`"), "{}", done.err);
}

#[test]
fn names_fit_the_language() {
    for name in ["2nd", "my-robot", "a b", "..", "é"] {
        let done = Place::new().run(&["new", name]);
        assert_eq!(done.code, Some(2), "{name}");
        assert!(done.err.contains("cannot be a name in a program"), "{name}: {}", done.err);
    }
}
