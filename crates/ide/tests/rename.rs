//! A rename changes only the name, for any program and any name.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests, too")]

use std::path::{Path, PathBuf};

use proptest::prelude::*;
use pydslrep_analysis::{Database, FileId, FileSpan, Resolution};
use pydslrep_ide::{FilePosition, references, rename};
use pydslrep_syntax::ast::Entity;
use pydslrep_syntax::{EntityKind, KEYWORDS, Span};
use smol_str::SmolStr;

/// The programs without their names: all other tokens, and the target of every reference.
fn meaning(database: &Database) -> Vec<String> {
    database.files().flat_map(|file| meaning_of_file(database, file)).collect()
}

fn meaning_of_file(database: &Database, file: FileId) -> Vec<String> {
    let mut said = Vec::new();
    for entity in database.entities(file) {
        for (token, span) in &entity.parse.tokens {
            let text = database.slice(file, span.shifted(entity.span.start));
            said.push(if token.is_name() { "a name".to_owned() } else { text });
        }
        let uses = entity.parse.entity.as_ref().map(Entity::references).unwrap_or_default();
        said.extend(uses.into_iter().map(|(kind, name)| match database.resolve(file, kind, &name.text) {
            Resolution::To(id) => {
                let home = database.file_of(id).unwrap();
                let number = database.entities(home).position(|entity| entity.id == id);
                format!("{} {} {number:?}", kind.noun(), database.path(home))
            }
            other => format!("{other:?}"),
        }));
    }
    said
}

/// The diagnostics that a rename must not change, by file and entity, without the renamed names.
fn problems(database: &Database, names: [&str; 2]) -> Vec<String> {
    let mut found = Vec::new();
    for file in database.files() {
        for problem in database.diagnostics(file) {
            let before = |entity: &pydslrep_analysis::EntityRef<'_>| entity.span.start <= problem.span.start;
            let number = database.entities(file).filter(before).count();
            let without = |text: String, name: &&str| text.replace(&format!("`{name}`"), "`…`");
            let message = names.iter().fold(problem.message, without);
            found.push(format!("{} {number} {} {message}", database.path(file), problem.rule.code));
        }
    }
    // A name declared by two imported files may be declared by only one of them afterwards, which fixes an error.
    found.retain(|problem| !problem.contains("ambiguous-import"));
    if found
        .iter()
        .any(|problem| problem.contains("unresolved-reference") || problem.contains("syntax-error"))
    {
        // Unused declarations are not reported if a similar name is unresolved.
        found.retain(|problem| !problem.contains("unused-declaration"));
    }
    found
}

fn texts(database: &Database) -> Vec<String> {
    database.files().map(|file| database.text(file).unwrap().to_string()).collect()
}

/// Applies a rename; false if it is refused.
fn apply(database: &mut Database, position: FilePosition, new: &str) -> bool {
    let edits = match rename(database, position, new) {
        Ok(edits) => edits,
        Err(refusal) => {
            assert!(refusal.to_string().len() > 20, "{refusal}");
            return false;
        }
    };
    for edit in edits.iter().rev() {
        database.edit(edit.file, edit.span, &edit.text);
    }
    true
}

/// Every kind and name that a file declares or uses, with one of its locations.
fn names(database: &Database) -> Vec<(EntityKind, SmolStr, FileSpan)> {
    let mut found: Vec<(EntityKind, SmolStr, FileSpan)> = Vec::new();
    for file in database.files() {
        for entity in database.entities(file) {
            let Some(tree) = &entity.parse.entity else { continue };
            let declared = tree.name().and_then(|name| Some((tree.kind()?, name)));
            for (kind, name) in tree.references().into_iter().chain(declared) {
                let place = FileSpan { file, span: name.span.shifted(entity.span.start) };
                let is_same = |(other, text, place): &(EntityKind, SmolStr, FileSpan)| {
                    (*other, text, place.file) == (kind, &name.text, file)
                };
                if !found.iter().any(is_same) {
                    found.push((kind, name.text.clone(), place));
                }
            }
        }
    }
    found
}

/// An offset inside the name: between two adjacent names, as in `a^b`, the cursor refers to the first.
fn at(place: FileSpan) -> FilePosition {
    FilePosition { file: place.file, offset: place.span.start + place.span.len() / 2 }
}

/// A database for every program of the project, with its imports.
fn programs() -> Vec<Database> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folders = ["tests/paper", "tests/programs", "examples"].map(|folder| root.join(folder));
    let entries = folders.iter().flat_map(|folder| std::fs::read_dir(folder).unwrap());
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "pyr"));
    paths.sort();
    assert!(paths.len() > 8, "{paths:?}");
    paths.iter().map(|path| with_imports(path)).collect()
}

fn with_imports(path: &Path) -> Database {
    let path = std::fs::canonicalize(path).unwrap();
    let path = path.to_string_lossy();
    let read = |path: &str| std::fs::read_to_string(path).unwrap();
    let mut database = Database::new();
    let file = database.open(&path, &read(&path));
    for import in database.imports(file).to_vec() {
        database.open(&import, &read(&import));
    }
    database
}

#[test]
fn every_name_of_every_program_can_be_renamed_and_renamed_back() {
    let mut imported = 0;
    for mut database in programs() {
        let (said, text) = (meaning(&database), texts(&database));
        for (kind, name, place) in names(&database) {
            let all = references(&database, at(place), true).unwrap();
            let Ok(edits) = rename(&database, at(place), "zz_9") else {
                assert_eq!(database.resolve(place.file, kind, &name), Resolution::Nothing, "{name}");
                continue;
            };
            for other in &all {
                assert_eq!(references(&database, at(*other), true).as_ref(), Some(&all));
                assert_eq!(rename(&database, at(*other), "zz_9").as_ref(), Ok(&edits));
            }
            let found = problems(&database, [&name, "zz_9"]);
            assert!(apply(&mut database, at(place), "zz_9"), "{name}");
            assert_ne!(texts(&database), text);
            assert_eq!(meaning(&database), said, "{name}");
            assert_eq!(problems(&database, [&name, "zz_9"]), found, "{name}");
            let (_, _, moved) = names(&database).into_iter().find(|(_, other, _)| other == "zz_9").unwrap();
            assert!(apply(&mut database, at(moved), &name), "{name}");
            assert_eq!(texts(&database), text);
            imported += usize::from(all.iter().any(|other| other.file != place.file));
        }
    }
    assert!(imported > 0, "no name of these programs was renamed in two files");
}

#[test]
fn names_that_are_taken_and_keywords_are_refused() {
    for mut database in programs() {
        let text = texts(&database);
        let all = names(&database);
        for (kind, name, place) in &all {
            for (other_kind, other, _) in &all {
                if kind == other_kind && name != other {
                    assert!(!apply(&mut database, at(*place), other), "{name} to {other}");
                }
            }
            for (token, word) in KEYWORDS {
                assert!(!token.is_keyword() || !apply(&mut database, at(*place), word), "{name} to {word}");
            }
            // A name can stay as it is.
            if database.resolve(place.file, *kind, name).entity().is_some() {
                assert!(apply(&mut database, at(*place), name), "{name}");
                assert_eq!(texts(&database), text);
            }
        }
    }
}

const PATHS: [&str; 3] = ["main.pyr", "parts.pyr", "base.pyr"];

const START: [&str; 3] = [
    "import \"parts.pyr\" import \"base.pyr\"\nwheel a with radius 4\nwheel b with radius 4\n\
     robot r with port 1 has { a b c } wheels with sensors { s }\n\
     movement m of r { turn left until { s } }\nmovement n of q { turn left }\n\
     environment e has { r q } robots with { m n } moves\n",
    "import \"base.pyr\"\nwheel c with radius 4\nsensor s\nrobot q with port 2 has { c d } wheels\n",
    "robot p with port 3 has { d e } wheels with sensors { s }\nwheel d with radius 4\nwheel e with radius 4\nsensor s\n",
];

type Slip = (usize, u16, u8, &'static str);

fn slips() -> impl Strategy<Value = Vec<Slip>> {
    let texts = vec![
        "{",
        "}",
        " a ",
        " b ",
        " c ",
        " d ",
        " s ",
        " import ",
        "import \"parts.pyr\" ",
        "import \"base.pyr\" ",
        "^",
        "/*",
        "\n",
        "wheel a with radius 4\n",
        "wheel d with radius 4\n",
        "sensor s\n",
        "robot q ",
        "with ",
        "",
    ];
    let slip = (0..3_usize, any::<u16>(), 0..12_u8, prop::sample::select(texts));
    prop::collection::vec(slip, 0..5)
}

fn with_slips(slips: &[Slip]) -> Database {
    let mut database = Database::new();
    let files = [0, 1, 2].map(|index| database.open(PATHS[index], START[index]));
    for (file, at, len, text) in slips {
        let file = files[*file];
        let end = database.text(file).map_or(0, ropey::Rope::len_bytes);
        let at = u32::try_from(end * usize::from(*at) / usize::from(u16::MAX)).unwrap();
        database.edit(file, Span::new(at, at + u32::from(*len)), text);
    }
    database
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_rename_of_anything_to_anything_changes_nothing_else(
        slips in slips(),
        which in any::<prop::sample::Index>(),
        new in prop::sample::select(vec!["a", "b", "d", "s", "q", "new_9", "import", "distance", "^robots"]),
    ) {
        let mut database = with_slips(&slips);
        let names = names(&database);
        prop_assume!(!names.is_empty());
        let (kind, name, place) = which.get(&names).clone();
        // A keyword in place of a name counts as a name with an error, which a rename fixes.
        prop_assume!(!KEYWORDS.iter().any(|(token, word)| token.is_keyword() && name == *word));
        let (said, text) = (meaning(&database), texts(&database));
        let bare = new.trim_start_matches('^');
        // Messages may depend on other names ("`x` is a robot, not a wheel"), and so may the number of syntax errors in a
        // statement, because recovery compares its words with keywords.
        let unworded = |problems: Vec<String>| -> Vec<String> {
            problems.iter().filter(|problem| !problem.contains("syntax-error")).map(|problem| problem.split(' ').take(3).collect()).collect()
        };
        let found = unworded(problems(&database, [&name, bare]));
        let all = references(&database, at(place), true).unwrap();
        for other in &all {
            let again = references(&database, at(*other), true);
            prop_assert_eq!(again.as_ref(), Some(&all));
        }
        if apply(&mut database, at(place), new) {
            prop_assert_eq!(meaning(&database), said, "{} {} to {} in {:?}", kind.noun(), name, new, text);
            let now = unworded(problems(&database, [&name, bare]));
            prop_assert_eq!(now, found, "{} {} to {} in {:?}", kind.noun(), name, new, text);
        }
    }
}
