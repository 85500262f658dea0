//! `pydslrep check --fix`.

use std::fs;

use expect_test::expect;
use pydslrep_analysis::diagnostics::{Applicability, CATALOGUE};

use crate::process::Place;

/// Many problems that can be fixed, some of them at the same place.
const BAD: &str = "\
wheel a with radius 4 wheel b with radius 4 wheel c with radius 4 wheel d with radius 4
sensor s
robot type tw r with port 1 has { a b } wheels with sensors { s s s }
robot q with port 2 has { c d } wheels
movement m of r { turn left -90 move 0 meters turn left -0 }
movement n of q { move 1 meters }
environment e has { r r } robots with { m n } moves
";

const GOOD: &str = "\
wheel a with radius 4 wheel b with radius 4
robot r with port 1 has { a b } wheels
movement m of r { move 1 meters }
environment e has { r } robots with { m } moves
";

/// One problem that can be fixed.
fn turned() -> String {
    GOOD.replace("move 1 meters", "turn left -90")
}

fn names(place: &Place) -> Vec<String> {
    let entries = fs::read_dir(place.path("")).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn everything_safe_is_fixed() {
    let place = Place::with("x.pyr", BAD);
    place.write("y.pyr", turned());
    place.write("z.pyr", GOOD);
    let done = place.run(&["check", "--fix"]);
    expect![[r#"
        wheel a with radius 4 wheel b with radius 4 wheel c with radius 4 wheel d with radius 4
        sensor s
        robot r type tw with port 1 has { a b } wheels with sensors { s }
        robot q with port 2 has { c d } wheels
        movement m of r { turn right 90 }
        movement n of q { move 1 meters }
        environment e has { r q } robots with { m n } moves
    "#]]
    .assert_eq(&place.read("x.pyr"));
    expect![[r#"
        No problems in 3 files.
        Fixed 9 problems in 2 files.
    "#]]
    .assert_eq(&(done.out + &done.err));
    assert_eq!(place.read("y.pyr"), GOOD.replace("move 1 meters", "turn right 90"));
    assert_eq!((place.read("z.pyr").as_str(), done.code), (GOOD, Some(0)));
    assert_eq!(names(&place), ["x.pyr", "y.pyr", "z.pyr"], "nothing is left beside them");
    let again = place.run(&["check", "--fix"]);
    assert_eq!((again.code, again.err.as_str()), (Some(0), ""));
}

#[test]
fn every_safe_fix_of_the_catalogue_is_applied() {
    let mut count = 0;
    for rule in CATALOGUE.into_iter().filter(|rule| rule.applicability == Applicability::Safe) {
        let place = Place::with("x.pyr", rule.page.example);
        // The target with more rules, as for the pages.
        place.write("pydslrep.toml", "target = \"vrep\"\n");
        for (name, text) in rule.page.imports {
            place.write(name, text);
        }
        let done = place.run(&["check", "--fix", "x.pyr"]);
        let reported = (done.code, done.out.as_str(), done.err.as_str());
        let expected = (Some(0), "No problems in 1 file.\n", "Fixed 1 problem in 1 file.\n");
        assert_eq!(reported, expected, "{}", rule.code);
        count += 1;
    }
    assert!(count > 5);
}

#[test]
fn suggestions_are_for_people_to_decide() {
    let text = GOOD.replace("has { a b }", "has { a bb }");
    let place = Place::with("x.pyr", &text);
    let done = place.run(&["check", "--fix"]);
    assert_eq!((done.code, place.read("x.pyr")), (Some(1), text));
    assert!(done.out.contains("suggestion: declare the wheel `bb`"), "{}", done.out);
    assert!(done.err.starts_with("Nothing was fixed"), "{}", done.err);
}

#[test]
fn a_program_from_standard_input_goes_to_standard_output() {
    for (format, report) in [("human", "No problems in 1 file.\n"), ("json", "[]\n"), ("github", "")] {
        let done = Place::new().run_with(&["check", "--fix", "--format", format, "-"], turned().as_bytes());
        assert_eq!((done.code, done.out), (Some(0), GOOD.replace("move 1 meters", "turn right 90")));
        assert_eq!(done.err, format!("{report}Fixed 1 problem in 1 file.\n"));
    }
    let done = Place::new().run_with(&["check", "--fix", "-"], GOOD.as_bytes());
    assert_eq!((done.code, done.out.as_str()), (Some(0), GOOD), "also where there is nothing to fix");
}

#[test]
fn what_is_off_is_not_fixed() {
    let place = Place::with("x.pyr", turned());
    let done = place.run(&["check", "--fix", "--severity", "invalid-angle=off"]);
    assert_eq!((done.code, place.read("x.pyr")), (Some(0), turned()));
}

#[test]
fn only_named_files_are_changed() {
    let place = Place::with("x.pyr", "import \"lib.pyr\"\nenvironment e has { r } robots with { m } moves");
    let lib = turned().replace("environment e has { r } robots with { m } moves\n", "");
    place.write("lib.pyr", &lib);
    assert_eq!(place.run(&["check", "--fix", "x.pyr"]).code, Some(0));
    assert_eq!(place.read("lib.pyr"), lib);
    assert_eq!(place.run(&["check", "--fix", "x.pyr", "lib.pyr"]).code, Some(0));
    assert!(place.read("lib.pyr").contains("turn right 90"));
}

#[test]
fn an_import_that_was_fixed_is_followed() {
    let place = Place::with("x.pyr", "improt \"lib.pyr\"\nenvironment e has { r } robots with { n } moves");
    let fixed = "Fixed 1 problem in 1 file.\n";
    let done = place.run(&["check", "--fix", "x.pyr"]);
    assert_eq!((done.code, done.err.as_str()), (Some(1), fixed));
    assert!(done.out.contains("there is no file `lib.pyr`"), "{}", done.out);

    place.write("x.pyr", "improt \"lib.pyr\"\nenvironment e has { r } robots with { n } moves");
    place.write("lib.pyr", GOOD.replace("environment e has { r } robots with { m } moves\n", ""));
    let done = place.run(&["check", "--fix", "x.pyr"]);
    assert_eq!((done.code, done.err.as_str()), (Some(1), fixed), "{}", done.out);
    assert!(done.out.contains("there is no movement called `n`"), "{}", done.out);
}

#[test]
fn marks_and_line_endings_stay() {
    let text = |program: &str| format!("\u{feff}{}", program.replace('\n', "\r\n"));
    let place = Place::with("x.pyr", text(&turned()));
    assert_eq!(place.run(&["check", "--fix"]).code, Some(0));
    assert_eq!(place.read("x.pyr"), text(&GOOD.replace("move 1 meters", "turn right 90")));
}

#[cfg(unix)]
#[test]
fn links_and_permissions_stay() {
    use std::os::unix::fs::{PermissionsExt, symlink};

    let place = Place::with("deep/x.pyr", turned());
    let mode = |mode| fs::Permissions::from_mode(mode);
    fs::set_permissions(place.path("deep/x.pyr"), mode(0o640)).unwrap();
    symlink("deep/x.pyr", place.path("y.pyr")).unwrap();
    assert_eq!(place.run(&["check", "--fix", "y.pyr"]).code, Some(0));
    assert!(fs::symlink_metadata(place.path("y.pyr")).unwrap().is_symlink());
    assert!(place.read("deep/x.pyr").contains("turn right 90"));
    assert_eq!(fs::metadata(place.path("deep/x.pyr")).unwrap().permissions().mode() & 0o777, 0o640);
}

#[test]
fn a_file_that_cannot_be_written_does_not_keep_the_others() {
    let place = Place::with("x.pyr", turned());
    place.write("y.pyr", turned());
    let mut permissions = fs::metadata(place.path("x.pyr")).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(place.path("x.pyr"), permissions).unwrap();
    let done = place.run(&["check", "--fix"]);
    assert_eq!((done.code, place.read("x.pyr")), (Some(2), turned()));
    assert!(place.read("y.pyr").contains("turn right 90"));
    assert!(
        done.out.contains("x.pyr:3:") && done.out.ends_with("1 warning in 1 file; 1 fixable with `--fix`.\n"),
        "{}",
        done.out
    );
    expect![[r#"
        Fixed 1 problem in 1 file.
        error: cannot write x.pyr: it is read-only
         |
         = help: make it writable, or leave it out
    "#]]
    .assert_eq(&done.err);
}
