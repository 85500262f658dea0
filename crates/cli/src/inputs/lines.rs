//! Lines of programs and scripts as the article counts them: without blank lines and comments.

use pydslrep_analysis::{Database, FileId};
use pydslrep_syntax::lex;

/// The quotes of docstrings; scripts use them for nothing else.
const DOCSTRING: &str = "\"\"\"";

/// Lines of a program and of all its imports.
pub(crate) fn of_program(database: &Database, program: FileId) -> usize {
    let mut files = vec![program];
    let mut next = 0;
    while let Some(file) = files.get(next).copied() {
        for imported in database.imported_files(file) {
            if !files.contains(&imported) {
                files.push(imported);
            }
        }
        next += 1;
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

/// Lines of a generated script; a docstring is a comment.
pub(crate) fn of_python(script: &str) -> usize {
    let (mut count, mut in_docstring) = (0, false);
    for line in script.lines().map(str::trim) {
        if in_docstring {
            in_docstring = !line.ends_with(DOCSTRING);
        } else if let Some(begun) = line.strip_prefix(DOCSTRING) {
            in_docstring = !begun.ends_with(DOCSTRING);
        } else if !line.is_empty() && !line.starts_with('#') {
            count += 1;
        }
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
