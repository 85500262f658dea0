//! The part of a command's help after its options: examples and notes.
//!
//! Its lines are broken here, because a command and its explanation are two columns, and an example that continues on the
//! next line must not look like two. They fit the terminal, so `clap`, which wraps all help, leaves them as they are.

use crate::report::output;

/// Longer lines are hard to read.
const MAX_COLUMNS: usize = 100;

/// The least width of a column of explanations.
const MIN_EXPLANATION: usize = 28;

const INDENT: &str = "  ";
/// Before the continuation of a command, and an explanation below its command.
const HANGING: &str = "      ";
const NO_BREAK: &str = "\u{a0}";
/// Between a command and its explanation.
const GAP: usize = 3;

/// The width of help: that of the terminal, up to a limit.
pub(crate) fn columns() -> usize {
    output::columns().min(MAX_COLUMNS)
}

/// Examples and notes of a command.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Help {
    /// Commands, each with an explanation or an empty string.
    pub(crate) examples: &'static [(&'static str, &'static str)],
    /// Paragraphs. Their lines that start with blanks are code.
    pub(crate) notes: &'static [&'static str],
}

impl Help {
    /// The text for the terminal.
    pub(crate) fn text(self) -> String {
        self.wrapped(columns())
    }

    fn wrapped(self, columns: usize) -> String {
        let table = Table { examples: self.examples, columns };
        let mut paragraphs = vec![format!("Examples:\n{}", table.text())];
        paragraphs.extend(self.notes.iter().map(|note| wrapped_note(note, columns)));
        paragraphs.join("\n\n")
    }
}

fn wrapped_note(note: &str, columns: usize) -> String {
    let wrapped = note.lines().map(|line| {
        if line.starts_with(' ') { line.to_owned() } else { textwrap::fill(line, options(columns)) }
    });
    wrapped.collect::<Vec<_>>().join("\n")
}

/// Breaks at blanks only: `--option` and `my-file` stay whole.
fn options<'a>(columns: usize) -> textwrap::Options<'a> {
    textwrap::Options::new(columns)
        .break_words(false)
        .word_splitter(textwrap::WordSplitter::NoHyphenation)
        .word_separator(textwrap::WordSeparator::AsciiSpace)
}

struct Table {
    examples: &'static [(&'static str, &'static str)],
    columns: usize,
}

impl Table {
    fn text(&self) -> String {
        let column = self.explanations();
        let examples: Vec<String> = self
            .examples
            .iter()
            .map(|(command, explanation)| self.example(column, command, explanation))
            .collect();
        examples.join("\n")
    }

    /// The column of explanations; `None` if they stand below their commands, because most would not fit beside them.
    fn explanations(&self) -> Option<usize> {
        let max = self.columns.checked_sub(INDENT.len() + GAP + MIN_EXPLANATION)?;
        let explained = self.examples.iter().filter(|(_, explanation)| !explanation.is_empty());
        let (fitting, wider): (Vec<usize>, Vec<usize>) =
            explained.map(|(command, _)| width(command)).partition(|width| *width <= max);
        let longest = fitting.iter().max()?;
        (fitting.len() > wider.len()).then_some(INDENT.len() + longest + GAP)
    }

    fn example(&self, column: Option<usize>, command: &str, explanation: &str) -> String {
        let start = format!("{INDENT}{command}");
        if explanation.is_empty() {
            return self.broken(&start);
        }
        let is_beside = column.is_some_and(|column| width(&start) + GAP <= column);
        let below = column.map_or_else(|| HANGING.to_owned(), |column| " ".repeat(column));
        let first = if is_beside { format!("{start:0$}", below.len()) } else { below.clone() };
        let options = options(self.columns).initial_indent(&first).subsequent_indent(&below);
        let explained = textwrap::fill(explanation, options);
        if is_beside { explained } else { format!("{}\n{explained}", self.broken(&start)) }
    }

    /// A command that is too wide, with a backslash before each break, as a shell reads it.
    fn broken(&self, command: &str) -> String {
        if width(command) <= self.columns {
            return command.to_owned();
        }
        let options = options(self.columns.saturating_sub(2)).subsequent_indent(HANGING);
        let joined = joined_values(command);
        textwrap::wrap(&joined, options).join(" \\\n").replace(NO_BREAK, " ")
    }
}

/// The command with blanks that do not break after options and `>`, which stay with what follows.
fn joined_values(command: &str) -> String {
    let mut out = String::new();
    let mut keeps_next = false;
    for (index, word) in command.split(' ').enumerate() {
        if index > 0 {
            out += if keeps_next && !word.starts_with('-') { NO_BREAK } else { " " };
        }
        out += word;
        keeps_next = word.starts_with('-') || word == ">";
    }
    out
}

fn width(text: &str) -> usize {
    textwrap::core::display_width(text)
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::Help;

    const HELP: Help = Help {
        examples: &[
            ("pydslrep run a.pyr", "in the embedded simulator"),
            ("pydslrep run a.pyr --picture a.svg", "and draw the planned and the driven path"),
            ("pydslrep run a.pyr --host 127.0.0.1 --port 23000", "in a CoppeliaSim that is running there"),
            ("pydslrep run a.pyr --trace a.jsonl | less", ""),
        ],
        notes: &[
            "If all robots are your own, your own Python runs the script without a simulator.",
            "The nearest pydslrep.toml sets the defaults:\n  target = \"vrep\"",
        ],
    };

    #[allow(clippy::needless_pass_by_value)] // what `expect!` makes
    fn check(columns: usize, expected: Expect) {
        let text = HELP.wrapped(columns);
        assert!(text.lines().all(|line| line.len() <= columns), "{text}");
        expected.assert_eq(&text);
    }

    #[test]
    fn explanations_are_a_column_where_it_is_wide_enough() {
        check(
            100,
            expect![[r#"
            Examples:
              pydslrep run a.pyr                                 in the embedded simulator
              pydslrep run a.pyr --picture a.svg                 and draw the planned and the driven path
              pydslrep run a.pyr --host 127.0.0.1 --port 23000   in a CoppeliaSim that is running there
              pydslrep run a.pyr --trace a.jsonl | less

            If all robots are your own, your own Python runs the script without a simulator.

            The nearest pydslrep.toml sets the defaults:
              target = "vrep""#]],
        );
        check(
            80,
            expect![[r#"
            Examples:
              pydslrep run a.pyr                   in the embedded simulator
              pydslrep run a.pyr --picture a.svg   and draw the planned and the driven path
              pydslrep run a.pyr --host 127.0.0.1 --port 23000
                                                   in a CoppeliaSim that is running there
              pydslrep run a.pyr --trace a.jsonl | less

            If all robots are your own, your own Python runs the script without a simulator.

            The nearest pydslrep.toml sets the defaults:
              target = "vrep""#]],
        );
    }

    #[test]
    fn in_a_narrow_terminal_they_stand_below() {
        check(
            60,
            expect![[r#"
            Examples:
              pydslrep run a.pyr
                  in the embedded simulator
              pydslrep run a.pyr --picture a.svg
                  and draw the planned and the driven path
              pydslrep run a.pyr --host 127.0.0.1 --port 23000
                  in a CoppeliaSim that is running there
              pydslrep run a.pyr --trace a.jsonl | less

            If all robots are your own, your own Python runs the script
            without a simulator.

            The nearest pydslrep.toml sets the defaults:
              target = "vrep""#]],
        );
        check(
            40,
            expect![[r#"
            Examples:
              pydslrep run a.pyr
                  in the embedded simulator
              pydslrep run a.pyr --picture a.svg
                  and draw the planned and the
                  driven path
              pydslrep run a.pyr --host 127.0.0.1 \
                  --port 23000
                  in a CoppeliaSim that is running
                  there
              pydslrep run a.pyr --trace a.jsonl | \
                  less

            If all robots are your own, your own
            Python runs the script without a
            simulator.

            The nearest pydslrep.toml sets the
            defaults:
              target = "vrep""#]],
        );
    }
}
