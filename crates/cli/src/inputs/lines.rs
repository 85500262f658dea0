//! Lines of programs and scripts as the article counts them: without blank lines and comments.

use std::collections::HashSet;

use pydslrep_analysis::{Database, FileId};
use pydslrep_syntax::lex;

/// The quotes of docstrings and other texts of several lines.
const QUOTES: &str = "\"\"\"";
const RAW_QUOTES: &str = "r\"\"\"";

/// Lines of a program and of all its imports.
pub(crate) fn of_program(database: &Database, program: FileId) -> usize {
    let mut files = HashSet::from([program]);
    let mut waiting = vec![program];
    while let Some(file) = waiting.pop() {
        waiting.extend(database.imported_files(file).filter(|imported| files.insert(*imported)));
    }
    files.into_iter().map(|file| of_file(database, file)).sum()
}

fn of_file(database: &Database, file: FileId) -> usize {
    let Some(text) = database.text(file) else { return 0 };
    let whole = text.to_string();
    let tokens = lex(&whole).into_iter().filter(|(token, _)| !token.is_comment());
    let mut lines: Vec<usize> = tokens.map(|(_, span)| text.byte_to_line(span.start as usize)).collect();
    lines.dedup();
    lines.len()
}

/// Lines of Python; a docstring is a comment, any other text of several lines is not.
pub(crate) fn of_python(code: &str) -> usize {
    let (mut count, mut inside) = (0, None);
    for line in code.lines().map(str::trim).filter(|line| !line.is_empty()) {
        let is_docstring = match inside {
            Some(is_docstring) => is_docstring,
            None => line.starts_with(QUOTES) || line.starts_with(RAW_QUOTES),
        };
        if !is_docstring && (inside.is_some() || !line.starts_with('#')) {
            count += 1;
        }
        let is_inside = inside.is_some() != (line.matches(QUOTES).count() % 2 == 1);
        inside = is_inside.then_some(is_docstring);
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blank_lines_and_comments_do_not_count() {
        assert_eq!(of_python("# a\n\nx = 1\n  # b\nif x:\n    y = 2  # c\n"), 3);
        let script = "\"\"\"One.\n\nMore\n\"\"\"\nimport math\ndef f():\n    \"\"\"Two.\"\"\"\n    return '#'\n\"\"\"\na\n\"\"\"\n";
        assert_eq!(of_python(script), 3);
        let text = "x = \"\"\"\n# a\n\nb\"\"\"\ny = 1\nz = \"\"\"c\"\"\"\nr\"\"\"\nd\n\"\"\"\n";
        assert_eq!(of_python(text), 5, "what is not a docstring counts");
    }

    #[test]
    fn programs_have_two_kinds_of_comments() {
        let mut database = Database::new();
        let count = |database: &mut Database, text: &str| {
            let file = database.open("/x.pyr", text);
            of_program(database, file)
        };
        assert_eq!(count(&mut database, ""), 0);
        assert_eq!(count(&mut database, "// a\n/* b\nc */\n\n \t\n"), 0);
        assert_eq!(count(&mut database, "/* b\nc */ wheel // d\n\na\r\nwith radius 4 wheel"), 3);
        assert_eq!(count(&mut database, "sensor a ; ?"), 1, "mistakes are lines, too");
    }

    #[test]
    fn imported_lines_count_once() {
        let mut database = Database::new();
        database.open("/a.pyr", "import \"b.pyr\"\nsensor a");
        database.open("/b.pyr", "import \"a.pyr\" // again\nsensor b\nsensor c");
        let file = database.open("/x.pyr", "import \"a.pyr\"\nimport \"b.pyr\"");
        assert_eq!(of_program(&database, file), 2 + 2 + 3);
    }
}
