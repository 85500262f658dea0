//! Hints of whole programs, and what is left of them while one is edited.

mod blocks;

use expect_test::{Expect, expect};

use super::*;
use crate::fixture::PARTS;

fn hints(text: &str, range: Span, options: InlayHintOptions) -> Vec<InlayHint> {
    let mut database = Database::new();
    let file = database.open("a.pyr", text);
    let places = InlayHintPlaces { file, range, typed: &[] };
    inlay_hints(&database, places, options, &mut KnownMovements::default())
}

/// The movements of a program with their hints in `«…»`.
fn shown(movements: &str, options: InlayHintOptions) -> String {
    let text = format!("{PARTS}{movements}");
    let mut shown = text.clone();
    for hint in hints(&text, Span::of(&text), options).iter().rev() {
        shown.insert_str(hint.offset as usize, &format!("«{}»", hint.label));
    }
    shown.split_off(PARTS.len())
}

fn check(movements: &str, expected: &Expect) {
    expected.assert_eq(&shown(movements, InlayHintOptions::default()));
}

const MOVES: &str =
    "movement m of rover {\n  move 1 meters\n  turn left // far\n  move -50 centimeters at 10\n}\n";

#[test]
fn each_action_has_its_pose_and_time() {
    check(
        MOVES,
        &expect![[r#"
            movement m of rover {
              move 1 meters«at 9.0»«· 11.4 s → 1.00, 0.00, 0°»
              turn left«90»«· 2.9 s → 1.00, 0.00, 90°» // far
              move -50 centimeters at 10«· 5.4 s → 1.00, -0.50, 90°»
            }
        "#]],
    );
}

#[test]
fn each_kind_can_be_switched_off() {
    let none = InlayHintOptions { pose: false, duration: false, defaults: false };
    assert_eq!(shown(MOVES, none), MOVES);
    expect![[r#"
        movement m of rover {
          move 1 meters«→ 1.00, 0.00, 0°»
          turn left«→ 1.00, 0.00, 90°» // far
          move -50 centimeters at 10«→ 1.00, -0.50, 90°»
        }
    "#]]
    .assert_eq(&shown(MOVES, InlayHintOptions { pose: true, ..none }));
    expect![[r#"
        movement m of rover {
          move 1 meters«· 11.4 s»
          turn left«· 2.9 s» // far
          move -50 centimeters at 10«· 5.4 s»
        }
    "#]]
    .assert_eq(&shown(MOVES, InlayHintOptions { duration: true, ..none }));
    expect![[r#"
        movement m of rover {
          move 1 meters«at 9.0»
          turn left«90» // far
          move -50 centimeters at 10
        }
    "#]]
    .assert_eq(&shown(MOVES, InlayHintOptions { defaults: true, ..none }));
}

#[test]
fn an_unknown_pose_is_shown_once() {
    check(
        "movement m of rover {\n  move 1 meters at 9\n  turn left until { front }\n  move 1 meters at 9\n  slam\n}\n",
        &expect![[r#"
            movement m of rover {
              move 1 meters at 9«· 11.4 s → 1.00, 0.00, 0°»
              turn left until { front }«· pose unknown»
              move 1 meters at 9«· 11.4 s»
              slam
            }
        "#]],
    );
    let text = format!("{PARTS}movement m of rover {{ turn left until {{ front }} move 1 meters at 9 }}");
    let tooltips: Vec<String> = hints(&text, Span::of(&text), InlayHintOptions::default())
        .into_iter()
        .map(|hint| hint.tooltip)
        .collect();
    expect![[r#"
        Poses from here on cannot be planned: `turn left until { front }` ends when the way is clear.
        ---
        Takes 11.4 s. The start pose cannot be planned: `turn left until { front }` ends when the way is clear.

        Wheel rates: `wheelL` 2 rad/s, `wheelR` 2 rad/s."#]].assert_eq(&tooltips.join("\n---\n"));
}

#[test]
fn without_a_valid_version_only_certain_hints_appear() {
    check(
        "movement m of rover {\n  turn right\n  move 1 meters at 0\n  move\n  turn left 45\n  move 1 meters\n",
        &expect![[r#"
            movement m of rover {
              turn right«90»«· 2.9 s → 0.00, 0.00, -90°»
              move 1 meters at 0
              move
              turn left 45«· 1.6 s»
              move 1 meters
        "#]],
    );
    check(
        "movement m of nobody {\n  turn right\n}\n",
        &expect![[r#"
        movement m of nobody {
          turn right«90»
        }
    "#]],
    );
    check(
        "movement m of rover { turn right move 1 meters at 0 }",
        &expect!["movement m of rover { turn right move 1 meters at 0 }"],
    );
}

/// An editor that shows all hints of a text while it is edited.
struct Editor {
    database: Database,
    file: FileId,
    known: KnownMovements,
    typed: Vec<Span>,
}

impl Editor {
    fn new(movements: &str) -> Self {
        let mut database = Database::new();
        let file = database.open("a.pyr", &format!("{PARTS}{movements}"));
        let mut editor = Self { database, file, known: KnownMovements::default(), typed: Vec::new() };
        editor.shown();
        editor
    }

    fn text(&self) -> String {
        self.database.text(self.file).unwrap().to_string()
    }

    fn hints(&mut self) -> Vec<InlayHint> {
        let range = Span::of(&self.text());
        let places = InlayHintPlaces { file: self.file, range, typed: &self.typed };
        inlay_hints(&self.database, places, InlayHintOptions::default(), &mut self.known)
    }

    fn shown(&mut self) -> String {
        let mut shown = self.text();
        for hint in self.hints().iter().rev() {
            shown.insert_str(hint.offset as usize, &format!("«{}»", hint.label));
        }
        shown.split_off(PARTS.len().min(shown.find("movement").unwrap()))
    }

    /// Replaces a text that occurs once, in one edit, and leaves the cursor at its end.
    fn replace(&mut self, old: &str, new: &str) {
        let text = self.text();
        let start = text.find(old).unwrap();
        assert_eq!(text.rfind(old), Some(start), "{old}");
        let offset = |byte| u32::try_from(byte).unwrap();
        self.database.edit(self.file, Span::new(offset(start), offset(start + old.len())), new);
        let at = Span::at(offset(start + new.len()));
        self.typed = vec![lines(&self.database, self.file, at)];
    }

    /// Types after a text that occurs once, key by key: the hints on other lines after each key, whenever they
    /// change.
    fn types(&mut self, mark: &str, typed: &str) -> String {
        let mut seen: Vec<String> = Vec::new();
        let mut before = mark.to_owned();
        for key in typed.chars() {
            let after = format!("{before}{key}");
            self.replace(&before, &after);
            before = after;
            let shown = self.shown();
            let others = shown.lines().map(str::trim).filter(|line| line.contains('«'));
            let others: Vec<&str> = others.collect();
            let others = others.join("\n");
            if seen.last() != Some(&others) {
                seen.push(others);
            }
        }
        seen.join("\n---\n") + "\n"
    }
}

const SQUARE: &str =
    "movement m of rover {\n  move 4.0 meters\n  turn right\n  move 2 meters\n  turn left\n}\n";

#[test]
fn the_edited_line_has_no_hints_and_the_others_stay() {
    let mut editor = Editor::new(SQUARE);
    expect![[r#"
        move 4.0 meters«at 9.0»«· 44.8 s → 4.00, 0.00, 0°»
        turn right«90»«· 2.9 s → 4.00, 0.00, -90°»
        turn left«90»«· 2.9 s → 4.00, -2.00, 0°»
    "#]]
    .assert_eq(&editor.types("move 2 meters", " at 12"));
    let mut editor = Editor::new(SQUARE);
    expect![[r#"
        move 4.0 meters«at 9.0»«· 44.8 s → 4.00, 0.00, 0°»
        turn right«90»«· 2.9 s → 4.00, 0.00, -90°»
        move 2 meters«at 9.0»«· 22.6 s → 4.00, -2.00, -90°»
        turn left«90»«· 2.9 s → 4.00, -2.00, 0°»
        ---
        move 4.0 meters«at 9.0»«· 44.8 s → 4.00, 0.00, 0°»
        turn right«90»«· 2.9 s → 4.00, 0.00, -90°»
        move 2 meters«at 9.0»«· 22.6 s → 4.00, -3.00, -90°»
        turn left«90»«· 2.9 s → 4.00, -3.00, 0°»
    "#]]
    .assert_eq(&editor.types("turn right", "\n  move 100 centimeters"));
    let mut editor = Editor::new(SQUARE);
    expect![[r#"
        move 4.0 meters«at 9.0»«· 44.8 s → 4.00, 0.00, 0°»
        turn right«90»«· 2.9 s → 4.00, 0.00, -90°»
        move 2 meters«at 9.0»«· 22.6 s → 4.00, -2.00, -90°»
        turn left«90»«· 2.9 s → 4.00, -2.00, 0°»
        ---
        move 4.0 meters«at 9.0»«· 44.8 s → 4.00, 0.00, 0°»
        turn right«90»«· 2.9 s → 4.00, 0.00, -90°»
        move 2 meters«at 9.0»«· 22.6 s → 6.00, 0.00, 0°»
        turn left«90»«· 2.9 s → 6.00, 0.00, 90°»
        ---
        move 4.0 meters«at 9.0»«· 44.8 s → 4.00, 0.00, 0°»
        turn right«90»«· 2.9 s → 4.00, 0.00, -90°»
        move 2 meters«at 9.0»«· 22.6 s»
        turn left«90»«· 2.9 s»
    "#]]
    .assert_eq(&editor.types("turn right", "\n  turn left until { front }"));
}

#[test]
fn hints_after_a_line_with_errors_stay() {
    let mut editor = Editor::new(SQUARE);
    editor.replace("move 4.0 meters", "mov 4.0 meters");
    expect![[r#"
        movement m of rover {
          mov 4.0 meters
          turn right«90»«· 2.9 s → 4.00, 0.00, -90°»
          move 2 meters«at 9.0»«· 22.6 s → 4.00, -2.00, -90°»
          turn left«90»«· 2.9 s → 4.00, -2.00, 0°»
        }
    "#]]
    .assert_eq(&editor.shown());
    // Another line is edited while this one still has an error.
    expect![[r#"
        turn right«90»«· 2.9 s → 4.00, 0.00, -90°»
        move 2 meters«at 9.0»«· 22.6 s → 4.00, -2.00, -90°»
        turn left«90»«· 2.9 s → 4.00, -2.00, 0°»
        ---
        turn right«90»«· 2.9 s → 4.00, 0.00, -90°»
        move 2 meters«at 9.0»«· 22.6 s → 4.00, -2.00, -90°»
        turn left«90»«· 2.9 s → 4.00, -2.00, 0°»
        move 1 meters«at 9.0»«· 11.4 s → 5.00, -2.00, 0°»
    "#]]
    .assert_eq(&editor.types("turn left", "\n  move 1 meters\n"));
    let old = editor
        .hints()
        .iter()
        .map(|hint| hint.tooltip.clone())
        .find(|tooltip| tooltip.contains("last version"));
    expect![[r#"
        Takes 2.9 s. From (4 m, 0 m, 0°) to (4 m, 0 m, -90°), relative to the start of the movement. Based on the last version without errors.

        Wheel rates: `wheelL` 2 rad/s, `wheelR` -2 rad/s."#]].assert_eq(&old.unwrap());
    editor.replace("mov 4.0 meters", "move 3.0 meters");
    expect![[r#"
        movement m of rover {
          move 3.0 meters
          turn right«90»«· 2.9 s → 3.00, 0.00, -90°»
          move 2 meters«at 9.0»«· 22.6 s → 3.00, -2.00, -90°»
          turn left«90»«· 2.9 s → 3.00, -2.00, 0°»
          move 1 meters«at 9.0»«· 11.4 s → 4.00, -2.00, 0°»

        }
    "#]]
    .assert_eq(&editor.shown());
}

#[test]
fn a_line_added_after_one_with_errors_is_planned_from_there() {
    let mut editor = Editor::new(SQUARE);
    editor.replace("  turn right\n", "  turn rig\n");
    editor.shown();
    editor.replace("  turn rig\n", "  turn rig\n  move 1 meters\n");
    expect![[r#"
        movement m of rover {
          move 4.0 meters«at 9.0»«· 44.8 s → 4.00, 0.00, 0°»
          turn rig
          move 1 meters«at 9.0»«· 11.4 s → 4.00, -1.00, -90°»
          move 2 meters
          turn left«90»«· 2.9 s → 4.00, -3.00, 0°»
        }
    "#]]
    .assert_eq(&editor.shown());
}

#[test]
fn a_robot_with_errors_removes_no_hints() {
    let mut editor = Editor::new(SQUARE);
    let before = editor.shown();
    for (old, new) in [
        ("wheelL with radius 4.5", "wheelL with radius "),
        ("type tw with port 23000", "typ with port"),
        ("movement m of rover", "movement m of r"),
    ] {
        editor.replace(old, new);
        assert_eq!(editor.shown().replace("of r {", "of rover {"), before, "{new}");
    }
    editor.replace("movement m of r {", "movement m2 of rover {");
    let labels: Vec<String> = editor.hints().into_iter().map(|hint| hint.label).collect();
    assert_eq!(labels, ["at 9.0", "90", "at 9.0", "90"], "a movement that has not had a robot yet");
}

#[test]
fn a_pose_that_depends_on_the_world_stays_unknown() {
    let mut editor =
        Editor::new("movement m of rover {\n  turn left until { front }\n  move 1 meters\n  turn left\n}\n");
    editor.replace("move 1 meters", "move 1 met");
    expect![[r#"
        movement m of rover {
          turn left until { front }«· pose unknown»
          move 1 met
          turn left«90»«· 2.9 s»
        }
    "#]]
    .assert_eq(&editor.shown());
    editor.replace("turn left until { front }", "turn left until { fro }");
    expect![[r#"
        movement m of rover {
          turn left until { fro }
          move 1 met
          turn left«90»«· 2.9 s»
        }
    "#]]
    .assert_eq(&editor.shown());
}

#[test]
fn hints_are_hidden_per_line_with_any_line_ending() {
    for ending in ["\n", "\r\n", "\r"] {
        let mut editor = Editor::new(&SQUARE.replace('\n', ending));
        editor.replace("turn right", "turn right ");
        let labels: Vec<String> = editor.hints().into_iter().map(|hint| hint.label).collect();
        assert_eq!(labels.len(), 6, "{labels:?}");
    }
}

#[test]
fn removed_movements_are_evicted() {
    let mut editor = Editor::new(SQUARE);
    for number in 0..200 {
        let text = editor.text();
        let name = text.split("movement ").nth(1).unwrap().split(' ').next().unwrap().to_owned();
        editor.replace(&format!("movement {name} of"), &format!("movement m{number} of"));
        editor.hints();
    }
    assert!(editor.known.len() < 32, "{}", editor.known.len());
}

/// The lines with hints, each with the number of equal ones before it. `pose unknown` appears only once, so it is
/// ignored: an edit may move it.
fn hinted(database: &Database, file: FileId, typed: &[Span], known: &mut KnownMovements) -> Vec<String> {
    let text = database.text(file).unwrap();
    let range = Span::new(0, u32::try_from(text.len_bytes()).unwrap());
    let places = InlayHintPlaces { file, range, typed };
    let hints = inlay_hints(database, places, InlayHintOptions::default(), known).into_iter();
    let hints = hints.filter(|hint| hint.label != UNKNOWN);
    let mut lines: Vec<usize> = hints.map(|hint| text.byte_to_line(hint.offset as usize)).collect();
    lines.dedup();
    let mut found: Vec<String> = Vec::new();
    for line in lines {
        let line = text.line(line).to_string();
        let equal = found.iter().filter(|other| other.ends_with(&line)).count();
        found.push(format!("{equal} {line}"));
    }
    found
}

/// The first hint that disappears from another line while `content` is typed at byte `start`, although the line has a
/// hint both before and after.
fn lost_by_typing(whole: &str, start: usize, content: &str) -> Option<String> {
    let mut then = Database::new();
    let file = then.open("a.pyr", whole);
    let after = hinted(&then, file, &[], &mut KnownMovements::default());
    let mut database = Database::new();
    let file = database.open("a.pyr", &format!("{}{}", &whole[..start], &whole[start + content.len()..]));
    let mut known = KnownMovements::default();
    let mut kept = hinted(&database, file, &[], &mut known);
    kept.retain(|line| after.contains(line));
    for (offset, key) in content.char_indices() {
        let at = u32::try_from(start + offset).unwrap();
        database.edit(file, Span::at(at), key.encode_utf8(&mut [0; 4]));
        let typed = lines(&database, file, Span::at(at));
        let shown = hinted(&database, file, &[typed], &mut known);
        if let Some(missing) = kept.iter().find(|line| !shown.contains(line)) {
            return Some(format!("{:?} removes {missing:?}", &content[..=offset]));
        }
    }
    None
}

/// Types every sixth line of each example; with `LONG`, every line.
#[test]
fn typing_any_line_of_any_example_removes_no_hints() {
    let one_in = if std::env::var_os("LONG").is_some() { 1 } else { 6 };
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let files = ["tests/paper", "examples"].map(|folder| std::fs::read_dir(root.join(folder)).unwrap());
    let files = files.into_iter().flatten().map(|entry| entry.unwrap().path());
    let mut lines = 0;
    for path in files.filter(|path| path.extension().is_some_and(|ending| ending == "pyr")) {
        let whole = std::fs::read_to_string(&path).unwrap();
        let mut start = 0;
        for line in whole.split_inclusive('\n') {
            if lines % one_in == 0 {
                let lost = lost_by_typing(&whole, start, line.trim_end());
                assert_eq!(lost, None, "{}", path.display());
            }
            start += line.len();
            lines += 1;
        }
    }
    assert!(lines > 100, "{lines}");
}

/// An editor next to the preview is hardly wider.
#[test]
fn the_programs_of_the_paper_fit_60_columns() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/paper");
    let mut longest = String::new();
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    for file in files.filter(|file| file.extension().is_some_and(|ending| ending == "pyr")) {
        let text = std::fs::read_to_string(file).unwrap();
        let mut shown = text.clone();
        for hint in hints(&text, Span::of(&text), InlayHintOptions::default()).iter().rev() {
            shown.insert_str(hint.offset as usize, &format!(" «{}", hint.label));
        }
        for line in shown.lines().filter(|line| line.contains('«')).map(|line| line.replace('«', "")) {
            if line.chars().count() > longest.chars().count() {
                longest = line;
            }
        }
    }
    expect!["  move 400.0 centimeters at 9.0 · 44.8 s → 0.00, -4.00, 180°"].assert_eq(&longest);
    assert!(longest.chars().count() <= 60, "{longest}");
}

#[test]
fn only_the_requested_range_has_hints() {
    let text = format!("{PARTS}{MOVES}{}", MOVES.replace("movement m", "movement n"));
    let line = text.find("  turn left").unwrap();
    let range = Span::new(u32::try_from(line).unwrap(), u32::try_from(line + 11).unwrap());
    let labels: Vec<String> =
        hints(&text, range, InlayHintOptions::default()).into_iter().map(|hint| hint.label).collect();
    assert_eq!(labels, ["90", "· 2.9 s → 1.00, 0.00, 90°"]);
}

#[test]
fn defaults_can_be_made_explicit() {
    let text = format!("{PARTS}{MOVES}");
    let options = InlayHintOptions { pose: false, duration: false, defaults: true };
    let mut written = text.clone();
    for hint in hints(&text, Span::of(&text), options).iter().rev() {
        written.insert_str(hint.offset as usize, hint.insert.as_deref().unwrap());
    }
    assert!(written.contains("move 1 meters at 9.0\n  turn left 90 // far\n"), "{written}");
    assert_eq!(hints(&written, Span::of(&written), options), []);
}
