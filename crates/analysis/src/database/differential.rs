//! The acceptance test of the database: after any edits it answers as a fresh one would.

use proptest::prelude::*;
use pydslrep_syntax::ast::Entity;
use pydslrep_syntax::{EntityKind, KEYWORDS, Span};
use smol_str::SmolStr;

use crate::{Database, FileId, Place, Target};

const PATHS: [&str; 3] = ["main.pyr", "parts.pyr", "base.pyr"];

const START: [&str; 3] = [
    "import \"parts.pyr\"\n// a robot\nwheel wheelL with radius 4.5\nwheel wheelR with radius 4.5\n\n\
     robot r type tw with port 19999 has { wheelL wheelR } wheels with sensors { s }\n\n\
     parallel movement m of r {\n  move 4.0 meters at 9\n  turn left until { s, t }\n  turn right\n}\n\
     movement n of q { move 1 meters turn left }\n\n\
     environment e has { r q p } robots with { m m n o } moves\n",
    "import \"base.pyr\"\nsensor s\nsensor t : bumper\nwheelH a with radius 3 /* mecanum */\nwheelH b with radius 3\n\
     robot q with port 2 has { a b a b } wheels\nmovement m of q { slam }\n\
     parallel movement o of p { turn right 30 }\n",
    "wheel b with radius 3\nwheel c with radius 3\nrobot p with port 2 has { b c } wheels\n",
];

/// One edit: where, as parts of 65536 of the text, how much goes, and what comes.
#[derive(Debug, Clone)]
struct Change {
    file: usize,
    at: u16,
    len: u8,
    text: String,
}

fn changes() -> impl Strategy<Value = Vec<Change>> {
    let signs = vec![
        "{",
        "}",
        ",",
        ":",
        "/*",
        "*/",
        "//",
        "\"",
        "\n",
        "\r",
        "\r\n",
        "^",
        "-",
        ".",
        " ",
        "é",
        "🤖",
        "s",
        "a ",
        "4.5",
        "wheelL ",
        "import \"parts.pyr\" ",
        "import \"base.pyr\" ",
        "import \"main.pyr\" ",
        "o p ",
        "import ",
        "wheel a with radius 3\n",
        "movement m of r { turn left }\n",
        "robot r ",
        "sensor s ",
        "environment f has { r } robots ",
        "environment E has { q } robots ",
        "environment math has { q } robots ",
        "} wheel ",
        "",
    ];
    let text = prop_oneof![
        2 => proptest::sample::select(KEYWORDS.map(|(_, word)| word).to_vec()).prop_map(|word| format!("{word} ")),
        5 => proptest::sample::select(signs).prop_map(str::to_owned),
    ];
    let len = prop_oneof![3 => Just(0_u8), 2 => 1..4_u8, 1 => 4..60_u8];
    let change = (0..PATHS.len(), any::<u16>(), len, text).prop_map(|(file, at, len, text)| Change {
        file,
        at,
        len,
        text,
    });
    proptest::collection::vec(change, 1..60)
}

fn apply(database: &mut Database, files: [FileId; 3], change: &Change) {
    let file = files[change.file];
    let end = database.text(file).map_or(0, ropey::Rope::len_bytes);
    let at = u32::try_from(end * usize::from(change.at) / usize::from(u16::MAX)).unwrap();
    database.edit(file, Span::new(at, at + u32::from(change.len)), &change.text);
}

fn check_same(edited: &Database, files: [FileId; 3]) -> Result<(), TestCaseError> {
    let mut fresh = Database::new();
    let text = |file| edited.text(file).map(ToString::to_string).unwrap_or_default();
    let fresh_files = [0, 1, 2].map(|index| fresh.open(PATHS[index], &text(files[index])));
    for (file, fresh_file) in files.into_iter().zip(fresh_files) {
        fresh.set_target(fresh_file, edited.target(file));
    }
    for (file, fresh_file) in files.into_iter().zip(fresh_files) {
        let pieces = |database: &Database, file| -> Vec<_> {
            database.entities(file).map(|entity| (entity.span, entity.parse.clone())).collect()
        };
        prop_assert_eq!(pieces(edited, file), pieces(&fresh, fresh_file));
        prop_assert_eq!(edited.imports(file), fresh.imports(fresh_file));
        prop_assert_eq!(references(edited, files, file), references(&fresh, fresh_files, fresh_file));
        let (ours, theirs) = (edited.diagnostics(file), fresh.diagnostics(fresh_file));
        prop_assert_eq!(ours.len(), theirs.len(), "{}", text(file));
        for (ours, theirs) in ours.iter().zip(&theirs) {
            prop_assert_eq!(ours, theirs, "{}", text(file));
        }
    }
    Ok(())
}

type UsedName = (EntityKind, SmolStr, Vec<(Option<usize>, Span)>);

/// Where all names that a file declares or uses are used: each kind and name with indices of files and spans.
fn references(database: &Database, files: [FileId; 3], file: FileId) -> Vec<UsedName> {
    let mut names: Vec<(EntityKind, SmolStr)> = EntityKind::ALL
        .iter()
        .flat_map(|kind| database.names(file, *kind).map(|name| (*kind, name.clone())))
        .collect();
    let trees = database.entities(file).filter_map(|entity| entity.parse.entity.as_ref());
    names.extend(trees.flat_map(Entity::references).map(|(kind, name)| (kind, name.text.clone())));
    names.sort_unstable();
    names.dedup();
    let index = |place: Place| (files.iter().position(|file| *file == place.file), place.span);
    names
        .into_iter()
        .map(|(kind, name)| {
            let places = database.references(file, kind, &name).into_iter().map(index).collect();
            (kind, name, places)
        })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn an_edited_database_answers_as_a_fresh_one(changes in changes()) {
        let mut database = Database::new();
        let files = [0, 1, 2].map(|index| database.open(PATHS[index], START[index]));
        for file in files {
            database.set_target(file, Target::VRep);
        }
        for change in &changes {
            apply(&mut database, files, change);
            check_same(&database, files)?;
        }
    }

    #[test]
    fn opening_and_closing_leaves_no_trace(changes in changes()) {
        let mut database = Database::new();
        let mut files = [0, 1, 2].map(|index| database.open(PATHS[index], START[index]));
        for change in &changes {
            apply(&mut database, files, change);
            if change.len > 3 {
                database.close(files[change.file]);
                files[change.file] = database.open(PATHS[change.file], &change.text);
            }
            check_same(&database, files)?;
        }
    }
}

/// A file of many cells, each with its own wheels, robot and movement.
fn large(cells: usize) -> String {
    let cell = |number: usize| {
        format!(
            "wheel l{number} with radius 4\nwheel r{number} with radius 4\n\
             robot robot{number} type tw with port 1 has {{ l{number} r{number} }} wheels\n\
             movement m{number} of robot{number} {{\n  move 4.0 meters\n  turn left 30\n}}\n\
             environment e{number} has {{ robot{number} }} robots with {{ m{number} }} moves\n"
        )
    };
    (0..cells).map(cell).collect()
}

#[test]
fn an_edit_inside_a_movement_costs_the_same_in_any_file() {
    for cells in [10, 1000] {
        let mut database = Database::new();
        let text = large(cells);
        let file = database.open("large.pyr", &text);
        let at = text.find("turn left 30").unwrap() + "turn left 3".len();
        let at = u32::try_from(at).unwrap();
        database.edit(file, Span::at(at), "6");
        let counts = database.last_edit();
        assert_eq!((counts.reparsed, counts.revalidated), (1, 1), "{cells} cells");
    }
}

#[test]
fn renaming_a_robot_asks_only_those_who_use_it() {
    let mut database = Database::new();
    let text = large(1000);
    let file = database.open("large.pyr", &text);
    let at = u32::try_from(text.find("robot robot500 ").unwrap() + "robot robot500".len()).unwrap();
    database.edit(file, Span::at(at), "x");
    // The robot itself, its movement and its environment.
    assert_eq!(database.last_edit().revalidated, 3);
    let codes: Vec<_> = database.diagnostics(file).iter().map(crate::Diagnostic::code).collect();
    assert_eq!(codes, ["unused-declaration", "unresolved-reference", "unresolved-reference"]);
}
