//! Bytes as edits of two files: an edited database answers as a fresh one.

use pydslrep_analysis::{Database, FileId};
use pydslrep_ide::format;
use pydslrep_syntax::Span;

const FILES: [(&str, &str); 2] = [
    (
        "/fuzz/main.pyr",
        "import \"parts.pyr\"\nwheel a with radius 4.5\nsensor s : bumper\n\
         robot r type tw with port 23000 has { a b } wheels with sensors { s }\n\
         movement m of r { move 2 meters at 20 turn left until { s } }\n\
         environment e has { r } robots with { m } moves\n",
    ),
    ("/fuzz/parts.pyr", "wheel b with radius 4.5\nwheelH c with radius 5\n"),
];

const WORDS: [&str; 32] = [
    "{",
    "}",
    ",",
    ":",
    "/*",
    "*/",
    "//",
    "\"",
    "\n",
    "\r\n",
    " ",
    "é",
    "💥",
    "a",
    "s ",
    "r ",
    "4.5 ",
    "-",
    "wheel ",
    "wheel a ",
    "sensor ",
    "robot r ",
    "movement ",
    "of r ",
    "move ",
    "turn ",
    "left ",
    "until ",
    "environment e ",
    "parallel ",
    "import ",
    "import \"main.pyr\"\n",
];

/// An edit takes four bytes: where (two), what (file and word), and how much goes.
const SIZE: usize = 4;
const MAX_EDITS: usize = 24;

/// Edits, and compares with fresh databases.
pub(crate) fn run(data: &[u8]) {
    let mut database = Database::new();
    let mut texts = FILES.map(|(_, text)| text.to_owned());
    let files = FILES.map(|(path, text)| database.open(path, text));
    for edit in data.chunks_exact(SIZE).take(MAX_EDITS) {
        let index = usize::from(edit[2] >> 7);
        let text = &mut texts[index];
        let begin = boundary(text, text.len() * usize::from(u16::from_be_bytes([edit[0], edit[1]])) / 0xffff);
        let end = boundary(text, (begin + usize::from(edit[3])).min(text.len()));
        let word = WORDS[usize::from(edit[2]) % WORDS.len()];
        let Ok(span) = u32::try_from(begin).and_then(|begin| Ok(Span::new(begin, u32::try_from(end)?)))
        else {
            return;
        };
        database.edit(files[index], span, word);
        text.replace_range(begin..end, word);
        let fresh = fresh(&texts);
        assert_eq!(answers(&database, files), answers(&fresh, files), "after {edit:?}: {texts:?}");
    }
}

fn fresh(texts: &[String; 2]) -> Database {
    let mut database = Database::new();
    for ((path, _), text) in FILES.iter().zip(texts) {
        database.open(path, text);
    }
    database
}

/// What an editor shows of all files.
fn answers(database: &Database, files: [FileId; 2]) -> String {
    let of = |file| {
        let snapshot = database.snapshot(file, None);
        (database.diagnostics(file), snapshot.map(|snapshot| format(&snapshot)))
    };
    format!("{:#?}", files.map(of))
}

/// The next place at or after an index that is not inside a character.
fn boundary(text: &str, index: usize) -> usize {
    (index..=text.len()).find(|&index| text.is_char_boundary(index)).unwrap_or(text.len())
}
