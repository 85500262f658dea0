//! `pydslrep fmt`.

use expect_test::expect;

use crate::process::{Place, repository};

const MESSY: &str = "wheel  a with radius 3\nsensor s // front\n";
const NEAT: &str = "wheel a with radius 3\n\nsensor s // front\n";

#[test]
fn programs_are_laid_out_in_place() {
    let place = Place::with("rooms/a.pyr", MESSY);
    place.write("b.pyr", NEAT);
    place.write("notes.txt", MESSY);
    let done = place.run(&["fmt"]);
    assert_eq!((done.code, done.err.as_str()), (Some(0), ""));
    assert_eq!(done.out, "1 file formatted, 1 laid out already.\n");
    assert_eq!((place.read("rooms/a.pyr"), place.read("notes.txt")), (NEAT.to_owned(), MESSY.to_owned()));
    assert_eq!(
        place.run(&["fmt", "--check", "b.pyr", "./rooms", "rooms/a.pyr"]).out,
        "2 files laid out already.\n"
    );
}

#[test]
fn check_and_diff_write_nothing() {
    let place = Place::with("a.pyr", MESSY);
    place.write("b.pyr", NEAT);
    let done = place.run(&["fmt", "--check"]);
    assert_eq!((done.code, done.err.as_str()), (Some(1), ""));
    expect![[r#"
        would format a.pyr
        1 file would be formatted; `pydslrep fmt` does it.
    "#]]
    .assert_eq(&done.out);
    let done = place.run(&["fmt", "--diff"]);
    assert_eq!((done.code, done.err.as_str()), (Some(1), ""));
    expect![[r#"
        --- a.pyr
        +++ a.pyr
        @@ -1,2 +1,3 @@
        -wheel  a with radius 3
        +wheel a with radius 3
        +
         sensor s // front
    "#]]
    .assert_eq(&done.out);
    assert_eq!(place.read("a.pyr"), MESSY);
    let done = place.run(&["fmt", "--diff", "b.pyr"]);
    assert_eq!((done.code, done.out.as_str(), done.err.as_str()), (Some(0), "", ""));
    let coloured = place.run(&["fmt", "--diff", "--color", "always", "a.pyr"]).out;
    assert!(coloured.contains("\u{1b}[32m+wheel a with radius 3\u{1b}[0m\n"), "{coloured:?}");
}

#[test]
fn standard_input_goes_to_standard_output() {
    // A byte order mark, other line ends and control characters are the person's own.
    let input = "\u{feff}wheel  a with radius 3 // \u{1b}[1mbold\r\n";
    let done = Place::new().run_with(&["fmt", "-"], input.as_bytes());
    assert_eq!((done.code, done.err.as_str()), (Some(0), ""));
    assert_eq!(done.out, input.replace("  a", " a"));
    let done = Place::new().run_with(&["fmt", "--check", "-"], input.as_bytes());
    assert_eq!(done.code, Some(1));
    assert!(done.out.starts_with("would format <stdin>\n"), "{}", done.out);
}

#[test]
fn what_is_broken_stays_and_is_told() {
    let place = Place::with("a.pyr", "wheel  a with radius 3\nwheel  b radius 3\n");
    let done = place.run(&["fmt", "a.pyr"]);
    assert_eq!(done.code, Some(1));
    assert_eq!(done.out, "1 file formatted.\n");
    expect![[r#"
        error: a.pyr has syntax errors: the entities they are in were left as they are
         |
         = help: `pydslrep check a.pyr` shows how to fix them
    "#]]
    .assert_eq(&done.err);
    assert_eq!(place.read("a.pyr"), "wheel a with radius 3\nwheel  b radius 3\n");
}

#[test]
fn what_cannot_be_read_keeps_nothing_else_from_being_formatted() {
    let place = Place::with("a.pyr", MESSY);
    place.write("b.pyr", b"wheel \xff");
    let done = place.run(&["fmt", "a.pyr", "b.pyr", "c.pyr"]);
    assert_eq!(done.code, Some(2));
    assert!(done.err.contains("cannot read b.pyr: not valid UTF-8"), "{}", done.err);
    assert!(done.err.contains("c.pyr does not exist"), "{}", done.err);
    assert_eq!(place.read("a.pyr"), NEAT);
}

#[test]
fn an_import_that_is_not_there_does_not_matter() {
    let done = Place::with("a.pyr", "import \"gone.pyr\"\n").run(&["fmt", "a.pyr"]);
    assert_eq!((done.code, done.out.as_str()), (Some(0), "1 file laid out already.\n"));
}

#[test]
fn formatted_programs_have_the_same_problems() {
    let folder = repository("tests/paper");
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "pyr") {
            continue;
        }
        let place = Place::with("a.pyr", std::fs::read_to_string(path).unwrap());
        let codes = |place: &Place| -> Vec<String> {
            let found: serde_json::Value =
                serde_json::from_str(&place.run(&["check", "--format", "json"]).out).unwrap();
            found.as_array().unwrap().iter().map(|problem| problem["message"].to_string()).collect()
        };
        let before = codes(&place);
        assert_eq!(place.run(&["fmt"]).code, Some(0));
        assert_eq!(codes(&place), before);
    }
}
