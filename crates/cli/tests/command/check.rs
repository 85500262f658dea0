//! `pydslrep check`.

use expect_test::{Expect, expect};
use serde_json::{Value, json};

use crate::process::{Place, paper, repository};

const TWO_WHEELS: &str = "wheel a with radius 4\nwheel b with radius 4\n";

fn json(arguments: &[&str]) -> (Vec<Value>, Option<i32>) {
    let done = Place::new().run(&[&["check", "--format", "json"], arguments].concat());
    (serde_json::from_str(&done.out).unwrap(), done.code)
}

#[track_caller]
fn check(program: &str, expected: &Expect) {
    let done = Place::with("x.pyr", program).run(&["check"]);
    expected.assert_eq(&done.out);
    assert_eq!((done.code, done.err.as_str()), (Some(1), ""));
}

#[test]
fn programs_of_the_article_and_examples_are_clean() {
    for name in ["table2_two_wheels", "table3_four_wheels", "table6_sensors", "table7_slam"] {
        // Its port is V-REP's, as the article has it.
        let (problems, code) = json(&[&paper(name)]);
        let found: Vec<(&Value, &Value)> =
            problems.iter().map(|problem| (&problem["code"], &problem["severity"])).collect();
        assert_eq!(
            (found, code),
            (vec![(&json!("port-of-other-target"), &json!("hint"))], Some(0)),
            "{name}"
        );
        assert_eq!(Place::new().run(&["check", "--deny", "warnings", &paper(name)]).code, Some(0), "{name}");
    }
    let done = Place::new().run(&["check", "--deny", "warnings", &repository("examples")]);
    assert_eq!((done.code, done.out.as_str()), (Some(0), "No problems in 13 files.\n"));
}

#[test]
fn table_4_is_a_mecanum_robot() {
    let (problems, code) = json(&[&paper("table4_holonomic")]);
    assert_eq!(code, Some(0));
    let [problem, port] = problems.as_slice() else { panic!("{problems:?}") };
    assert_eq!(port["code"], json!("port-of-other-target"));
    assert_eq!((&problem["code"], &problem["severity"]), (&json!("wheel-kind-mismatch"), &json!("warning")));
    assert!(problem["fix"]["edits"][0]["text"].as_str().unwrap().contains("fwh"), "{problem}");
    let done = Place::new().run(&["check", "--deny", "warnings", &paper("table4_holonomic")]);
    assert_eq!(done.code, Some(1));
}

#[test]
fn table_5_lacks_four_wheels() {
    let (problems, code) = json(&[&paper("table5_angles_as_printed")]);
    let errors: Vec<&Value> = problems.iter().filter(|problem| problem["severity"] == "error").collect();
    assert_eq!((errors.len(), code), (4, Some(1)));
    assert!(errors.iter().all(|error| error["code"] == "unresolved-reference"), "{errors:?}");
    let shown = Place::new().run(&["check", &paper("table5_angles_as_printed")]).out;
    for wheel in ["wheelL0", "wheelL1", "wheelR0", "wheelR1"] {
        assert!(shown.contains(&format!("suggestion: declare the wheel `{wheel}`")), "{shown}");
        assert!(shown.contains(&format!("4 + wheel {wheel} with radius 4.5\n")), "{shown}");
    }
}

#[test]
fn json_has_everything() {
    let program = "sensor 机\nwheel a with radius 5\nwheel a with radius 6\n";
    let place = Place::with("x.pyr", program);
    let done = place.run(&["check", "--format", "json", "x.pyr"]);
    let problems: Vec<Value> = serde_json::from_str(&done.out).unwrap();
    let at = |line, from, to| json!({"start": {"line": line, "column": from}, "end": {"line": line, "column": to}});
    let duplicate = json!({
        "file": "x.pyr",
        "code": "duplicate-name",
        "severity": "error",
        "message": "there is already a wheel called `a`",
        "range": at(3, 7, 8),
        "related": [{"message": "first declared here", "file": "x.pyr", "range": at(2, 7, 8)}],
        "fix": {"title": "rename this one to `a_2`", "edits": [{"range": at(3, 7, 8), "text": "a_2"}]},
    });
    assert_eq!(problems.last(), Some(&duplicate));
    assert_eq!(problems[0]["range"], at(1, 8, 9), "columns count characters");
}

#[test]
fn what_is_missing_is_marked_behind_what_is_there() {
    check(
        "wheel a with\tradius\r\nwheel b with radius 4",
        &expect![[r#"
            error[syntax-error]: missing a radius in centimetres after `radius`
             --> x.pyr:1:20
              |
            1 | wheel a with    radius 
              |                       ^
              |
              = help: a wheel is written `wheel NAME with radius CENTIMETRES`

            1 error in 1 file.
        "#]],
    );
}

#[test]
fn second_places_and_wide_letters() {
    check(
        &format!("{TWO_WHEELS}/* 机器人 🤖 */ wheel a with radius 5"),
        &expect![[r#"
            error[duplicate-name]: there is already a wheel called `a`
             --> x.pyr:3:19
              |
            1 | wheel a with radius 4
              |       - first declared here
            2 | wheel b with radius 4
            3 | /* 机器人 🤖 */ wheel a with radius 5
              |                       ^
              |
              = help: give one of them another name
            suggestion: rename this one to `a_2`
              |
            3 | /* 机器人 🤖 */ wheel a_2 with radius 5
              |                        ++

            1 error in 1 file.
        "#]],
    );
}

#[test]
fn errors_and_warnings_are_counted() {
    let program = format!(
        "{TWO_WHEELS}robot r with port 70000 has {{ a b }} wheels\nmovement m of r {{ move 0 meters turn left 400 }}"
    );
    let done = Place::with("x.pyr", program).run(&["check"]);
    let places = ["error[invalid-port]", "x.pyr:3:19", "warning[invalid-angle]", "x.pyr:4:43"];
    let found: Vec<Option<usize>> = places.iter().map(|place| done.out.find(place)).collect();
    assert!(found.is_sorted() && !found.contains(&None), "{found:?} {}", done.out);
    assert!(done.out.contains("\n1 error, 2 warnings"), "{}", done.out);
    assert!(done.out.ends_with(" in 1 file; 1 fixable with `--fix`.\n"), "{}", done.out);
}

#[test]
fn what_is_safe_to_do_is_told_from_what_is_not() {
    let program =
        format!("{TWO_WHEELS}robot r with port 1 has {{ a bb }} wheels\nmovement m of r {{ turn left -9 }}");
    let shown = Place::with("x.pyr", program).run(&["check"]).out;
    assert!(shown.contains("\nsuggestion: declare the wheel `bb`\n"), "{shown}");
    assert!(shown.contains("\nfix: turn right instead\n"), "{shown}");
}

/// Three problems: a repeated name, an odd radius, a sensor that nothing uses.
const ODD: &str = "\
wheel a with radius 4 wheel a with radius 400
sensor s
robot r with port 1 has { a a } wheels
movement m of r { move 1 meters }
environment e has { r } robots with { m } moves";

#[track_caller]
fn severities(arguments: &[&str]) -> (Vec<String>, Option<i32>) {
    let place = Place::with("x.pyr", ODD);
    let done = place.run(&[&["check", "--format", "json"], arguments].concat());
    let problems: Vec<Value> = serde_json::from_str(&done.out).unwrap();
    let word = |problem: &Value, key: &str| problem[key].as_str().unwrap().to_owned();
    let words = problems.iter().map(|problem| word(problem, "code") + "=" + &word(problem, "severity"));
    (words.collect(), done.code)
}

#[test]
fn severities_are_a_matter_of_taste() {
    let (usual, code) = severities(&[]);
    let expected = [
        "duplicate-name=error",
        "implausible-radius=warning",
        "unused-declaration=hint",
        "repeated-wheel=error",
    ];
    assert_eq!((usual, code), (expected.map(str::to_owned).to_vec(), Some(1)));
    let choices = [
        "duplicate-name=off",
        "implausible-radius=hint",
        "unused-declaration=warning",
        "repeated-wheel=information",
    ];
    let mut arguments: Vec<&str> = choices.iter().flat_map(|choice| ["--severity", choice]).collect();
    let expected = choices[1..].iter().map(|&choice| choice.to_owned()).collect();
    assert_eq!(severities(&arguments), (expected, Some(0)));
    assert_eq!(severities(&[&arguments[..], &["--deny", "warnings"]].concat()).1, Some(1));
    // Neither hints nor information are warnings.
    let mild = [&arguments[..], &["--severity", "unused-declaration=hint", "--deny", "warnings"]].concat();
    let (shown, code) = severities(&mild);
    assert!(shown.contains(&"repeated-wheel=information".to_owned()), "{shown:?}");
    assert_eq!(code, Some(0));
    // The last one counts.
    arguments.extend(["--severity", "repeated-wheel=error"]);
    assert_eq!(severities(&arguments).1, Some(1));
}

#[test]
fn unknown_severities_get_a_suggestion() {
    for (choice, expected) in [
        (
            "invalid-radus=off",
            "there is no diagnostic `invalid-radus`\n |\n = help: did you mean `invalid-radius`?",
        ),
        (
            "invalid-radius=fatal",
            "there is no level `fatal`\n |\n = help: the levels are off, hint, information, warning, error",
        ),
        ("invalid-radius=warn", "there is no level `warn`\n |\n = help: did you mean `warning`?"),
        ("invalid-radius=wraning", "there is no level `wraning`\n |\n = help: did you mean `warning`?"),
        (
            "invalid-radius",
            "`--severity invalid-radius` has no level\n |\n = help: write the code, `=` and a level: `--severity invalid-radius=off`",
        ),
    ] {
        let done = Place::with("x.pyr", ODD).run(&["check", "--severity", choice]);
        assert_eq!((done.code, done.out.as_str()), (Some(2), ""), "{choice}");
        assert_eq!(done.err, format!("error: {expected}\n"));
    }
}

#[test]
fn marks_in_pull_requests() {
    let place = Place::with("50%, a.pyr", format!("{ODD}\nrobot q with port 1 has {{ a whel }} wheels"));
    let done = place.run(&["check", "--format", "github"]);
    expect![[r#"
        ::error file=50%25%2C a.pyr,line=1,col=29,endLine=1,endColumn=30,title=duplicate-name::there is already a wheel called `a`%0Ahelp: give one of them another name
        ::warning file=50%25%2C a.pyr,line=1,col=43,endLine=1,endColumn=46,title=implausible-radius::with a radius of 400 cm this wheel is taller than a person%0Anote: a radius is in centimetres; was this one measured in millimetres?
        ::notice file=50%25%2C a.pyr,line=2,col=8,endLine=2,endColumn=9,title=unused-declaration::nothing uses the sensor `s`%0Ahelp: add it to a robot: `with sensors { … }`, or leave it out
        ::error file=50%25%2C a.pyr,line=3,col=29,endLine=3,endColumn=30,title=repeated-wheel::`a` is listed twice, but each wheel of a robot needs a name of its own%0Ahelp: declare one more wheel, and list that one here
        ::notice file=50%25%2C a.pyr,line=6,col=7,endLine=6,endColumn=8,title=unused-declaration::nothing uses the robot `q`%0Ahelp: list it among the robots of an environment, or leave it out
        ::error file=50%25%2C a.pyr,line=6,col=29,endLine=6,endColumn=33,title=unresolved-reference::there is no wheel called `whel`%0Ahelp: the only wheel is `a`
    "#]].assert_eq(&done.out);
    assert_eq!((done.code, done.err.as_str()), (Some(1), ""));
    place.write("50%, a.pyr", "");
    let done = place.run(&["check", "--format", "github"]);
    assert_eq!((done.code, done.out.as_str()), (Some(0), ""));
}

#[test]
fn colours_only_where_they_are_wanted() {
    let place = Place::with("x.pyr", "wheel");
    assert!(!place.run(&["check"]).out.contains('\u{1b}'));
    assert!(place.run(&["check", "--color", "always"]).out.contains("\u{1b}[1m"));
    let done = place.command(&["check"]).env("CLICOLOR_FORCE", "1").env("NO_COLOR", "1").output().unwrap();
    assert!(!String::from_utf8_lossy(&done.stdout).contains('\u{1b}'));
}

#[test]
fn folders_are_walked_in_order_of_names() {
    let place = Place::with("b.pyr", "wheel");
    for name in ["a/z.pyr", "a/b/c.pyr", ".hidden/x.pyr"] {
        place.write(name, "wheel");
    }
    place.write("a/notes.txt", "wheel");
    let done = place.run(&["check", "--format", "json", "b.pyr", ".", "./a/z.pyr"]);
    let problems: Vec<Value> = serde_json::from_str(&done.out).unwrap();
    let files: Vec<&str> = problems.iter().map(|problem| problem["file"].as_str().unwrap()).collect();
    assert_eq!(files, ["a/b/c.pyr", "a/z.pyr", "b.pyr"]);
}

#[test]
fn standard_input_is_a_program_too() {
    let done = Place::new().run_with(&["check", "-"], b"sensor s sensor s");
    assert_eq!(done.code, Some(1));
    assert!(done.out.contains("--> <stdin>:1:17"), "{}", done.out);
}

#[test]
fn files_that_are_no_programs_do_not_hide_the_others() {
    let place = Place::with("bad.pyr", b"wheel a\nwith \xff\xfe");
    place.write("good.pyr", "wheel");
    let large = std::fs::File::create(place.path("large.pyr")).unwrap();
    large.set_len((16 << 20) + 1).unwrap();
    let done = place.run(&["check", ".", "missing.pyr"]);
    assert_eq!(done.code, Some(2));
    assert!(done.out.contains("good.pyr:1:6") && done.out.ends_with("1 error in 1 file.\n"), "{}", done.out);
    expect![[r#"
        error: cannot read bad.pyr: not valid UTF-8 in line 2
         |
         = help: save it in the encoding UTF-8
        error: cannot read large.pyr: larger than 16 MiB
         |
         = help: is this a program?
        error: missing.pyr does not exist
    "#]]
    .assert_eq(&done.err);
}

#[test]
fn byte_order_marks_are_no_part_of_the_text() {
    let place = Place::with("x.pyr", "\u{feff}wheel");
    assert!(place.run(&["check"]).out.contains("x.pyr:1:6"));
}

#[test]
fn imports_are_read_and_bounded() {
    let place =
        Place::with("a/main.pyr", "import \"lib/wheels.pyr\"\nrobot r with port 1 has { x y } wheels");
    place.write("a/lib/wheels.pyr", "wheel x with radius 4 wheel y with radius 4");
    assert_eq!(place.run(&["check", "a/main.pyr"]).code, Some(0));
    place.write("a/main.pyr", "import \"../b.pyr\"\nrobot r with port 1 has { x y } wheels");
    place.write("b.pyr", "wheel x with radius 4 wheel y with radius 4");
    let done = place.run(&["check", "a/main.pyr"]);
    assert_eq!((done.code, done.err.as_str()), (Some(1), ""));
    expect![[r#"
        error[unresolved-import]: `../b.pyr` is outside of the workspace
         --> a/main.pyr:1:8
          |
        1 | import "../b.pyr"
          |        ^^^^^^^^^^
          |
          = help: move the file to where this one is, or put a `pydslrep.toml` into the folder that holds both; in an editor, open that folder

        1 error in 1 file.
    "#]].assert_eq(&done.out);
    place.write("a/main.pyr", "import \"lib.pyr\"\nrobot r with port 1 has { x y } wheels");
    expect![[r#"
        error[unresolved-import]: there is no file `lib.pyr`
         --> a/main.pyr:1:8
          |
        1 | import "lib.pyr"
          |        ^^^^^^^^^
          |
          = help: check the spelling; the path counts from the folder of this file, with `/` between its parts

        1 error in 1 file.
    "#]]
    .assert_eq(&place.run(&["check", "a/main.pyr"]).out);
    place.write("a/lib.pyr", b"wheel x \xff");
    expect![[r#"
        error[unresolved-import]: `lib.pyr` cannot be read: not valid UTF-8 in line 1
         --> a/main.pyr:1:8
          |
        1 | import "lib.pyr"
          |        ^^^^^^^^^
          |
          = help: programs are UTF-8 text files that you are allowed to read

        1 error in 1 file.
    "#]]
    .assert_eq(&place.run(&["check", "a/main.pyr"]).out);
    place.write("a/main.pyr", "import \"../b.pyr\"\nrobot r with port 1 has { x y } wheels");
    place.write("pydslrep.toml", "");
    let done = place.run(&["check", "a/main.pyr"]);
    assert_eq!((done.code, done.err.as_str()), (Some(0), ""));
}

#[test]
fn a_folder_without_programs_is_a_mistake() {
    let done = Place::new().run(&["check"]);
    assert_eq!((done.code, done.out.as_str()), (Some(2), ""));
    assert!(done.err.contains("there is no program in ."), "{}", done.err);
}

#[test]
fn wrong_use_ends_with_2() {
    for arguments in [&["chek"][..], &["check", "--format", "xml"], &["run"]] {
        assert_eq!(Place::new().run(arguments).code, Some(2), "{arguments:?}");
    }
}

#[test]
fn mistakes_in_the_scene_of_an_environment_are_told() {
    let program = format!(
        "{TWO_WHEELS}robot rover with port 1 has {{ a b }} wheels\nmovement m of rover {{ move 1 meters }}\n\
         environment yard has {{ rover }} robots with {{ m }} moves\n"
    );
    let place = Place::with("x.pyr", &program);
    place.write("yard.scene.toml", "# 机\n[robots.rovr]\nstart = [0, 0]\n");
    let done = place.run(&["check"]);
    expect![[r#"
        error: the environment has no robot `rovr`
         --> yard.scene.toml:2:9
          |
        2 | [robots.rovr]
          |         ^^^^
          |
          = help: did you mean `rover`?

        1 error in 1 file.
    "#]]
    .assert_eq(&done.out);
    assert_eq!((done.code, done.err.as_str()), (Some(1), ""));
    let done = place.run(&["check", "--format", "json"]);
    let [problem] = &serde_json::from_str::<Vec<Value>>(&done.out).unwrap()[..] else {
        panic!("{}", done.out)
    };
    assert_eq!(
        *problem,
        json!({
            "file": "yard.scene.toml", "code": "unknown-name", "severity": "error",
            "message": "the environment has no robot `rovr`",
            "range": { "start": { "line": 2, "column": 9 }, "end": { "line": 2, "column": 13 } },
            "related": [],
            "fix": { "title": "change to `rover`", "edits": [{
                "range": { "start": { "line": 2, "column": 9 }, "end": { "line": 2, "column": 13 } },
                "text": "rover",
            }] },
        })
    );
    let done = place.run(&["check", "--format", "github"]);
    expect![[r#"
        ::error file=yard.scene.toml,line=2,col=9,endLine=2,endColumn=13,title=unknown-name::the environment has no robot `rovr`%0Ahelp: did you mean `rover`?
    "#]].assert_eq(&done.out);
    let sarif: Value = serde_json::from_str(&place.run(&["check", "--format", "sarif"]).out).unwrap();
    let found = &sarif["runs"][0]["results"][0];
    assert_eq!((&found["ruleId"], &found["level"]), (&json!("unknown-name"), &json!("error")));
    place.write("yard.scene.toml", "[robots.rover]\nstart = [0, 0]\n");
    assert_eq!(place.run(&["check"]).code, Some(0));
}
