//! Output: results on standard output, everything else on standard error, colours only where they are wanted.

use std::borrow::Cow;
use std::env;
use std::io::{self, Write};

use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{Group, Level, Renderer};
use comfy_table::{CellAlignment, ColumnConstraint, ContentArrangement, LineStyle, Table, Width, presets};
use serde::Serialize;
use terminal_size::terminal_size;

use crate::failure::Failure;

/// Prints a result.
///
/// # Errors
/// If standard output cannot be written.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = anstream::stdout().lock();
    out.write_all(without_controls(text).as_bytes())
        .and_then(|()| out.flush())
        .map_err(|error| unprinted(&error))
}

/// A value as JSON with line breaks, to be printed.
///
/// # Errors
/// If it has no form in JSON.
pub(crate) fn json(value: &(impl Serialize + ?Sized)) -> Result<String, Failure> {
    let text = serde_json::to_string_pretty(value);
    Ok(text.map_err(|error| Failure::new(format!("cannot write JSON: {error}")))? + "\n")
}

/// Prints a user's text as it is: escape sequences in it stay.
///
/// # Errors
/// If standard output cannot be written.
pub(crate) fn print_raw(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(|error| unprinted(&error))
}

fn unprinted(error: &io::Error) -> Failure {
    /// The error code of Windows for a pipe that its reader has closed (`ERROR_PIPE_NOT_CONNECTED`).
    const NOT_CONNECTED: i32 = 233;
    match error.kind() {
        io::ErrorKind::BrokenPipe => Failure::NoReader,
        _ if cfg!(windows) && error.raw_os_error() == Some(NOT_CONNECTED) => Failure::NoReader,
        _ => Failure::new(format!("cannot write to standard output: {error}")),
    }
}

/// Writes to standard error; a failure to do so is ignored.
pub(crate) fn say(text: &str) {
    let _ = anstream::stderr().lock().write_all(without_controls(text).as_bytes());
}

/// Names and messages may contain the control characters from U+0080 to U+009F, which terminals obey as they do escape
/// sequences: they are written as JSON does.
pub(crate) fn without_controls(text: &str) -> Cow<'_, str> {
    let is_control = |character| ('\u{80}'..='\u{9f}').contains(&character);
    if !text.contains(is_control) {
        return Cow::Borrowed(text);
    }
    let mut clean = String::with_capacity(text.len());
    for character in text.chars() {
        if is_control(character) {
            clean += &format!("\\u{:04x}", u32::from(character));
        } else {
            clean.push(character);
        }
    }
    Cow::Owned(clean)
}

/// Reports a failure.
pub(crate) fn fail(failure: &Failure) {
    match failure {
        Failure::Message { message, help, .. } => error(message, help.as_deref()),
        Failure::Rendered(text) => say(text),
        Failure::NoReader => {}
    }
}

/// Reports an error, with advice.
pub(crate) fn error(message: &str, help: Option<&str>) {
    report(&Level::ERROR, message, help);
}

/// Reports a warning, with advice.
pub(crate) fn warning(message: &str, help: Option<&str>) {
    report(&Level::WARNING, message, help);
}

/// Reports a note.
pub(crate) fn note(message: &str) {
    report(&Level::NOTE, message, None);
}

fn report(level: &Level<'_>, message: &str, help: Option<&str>) {
    let mut group = Group::with_title(level.clone().primary_title(message));
    if let Some(help) = help {
        group = group.element(Level::HELP.message(help));
    }
    say(&format!("{}\n", renderer().render(&[group])));
}

/// The style of diagnostics and failures.
pub(crate) fn renderer() -> Renderer {
    Renderer::styled().decor_style(DecorStyle::Ascii)
}

/// "1 error", "2 errors".
pub(crate) fn count(number: usize, noun: &str) -> String {
    let plural = if number == 1 { "" } else { "s" };
    format!("{number} {noun}{plural}")
}

/// The width of the terminal; without one, that in `COLUMNS`, else 80.
pub(crate) fn columns() -> usize {
    let of_terminal = terminal_size().map(|(width, _)| usize::from(width.0));
    let of_variable = || env::var("COLUMNS").ok()?.parse().ok().filter(|columns| *columns > 0);
    of_terminal.or_else(of_variable).unwrap_or(80)
}

/// Text wrapped to the terminal; continuation lines are indented.
pub(crate) fn wrapped(text: &str) -> String {
    textwrap::fill(text, textwrap::Options::new(columns()).subsequent_indent("  "))
}

/// An empty table with a ruled header. Text wraps if the table would be wider than the terminal.
pub(crate) fn table<const COLUMNS: usize>(head: [&str; COLUMNS]) -> Table {
    let mut table = Table::new();
    table
        .load_style(presets::NOTHING.header_separator(LineStyle::none().fill('─').junction('─')))
        .set_header(head)
        .set_content_arrangement(ContentArrangement::Dynamic)
        .set_width(u16::try_from(columns()).unwrap_or(u16::MAX));
    for column in table.column_iter_mut() {
        column.set_padding((0, 1));
    }
    table
}

/// Right-aligns columns of numbers. Numbers never wrap; their titles may.
pub(crate) fn align_right(table: &mut Table, columns: &[usize]) {
    for index in columns {
        let cells = table.row_iter().filter_map(|row| row.cell_iter().nth(*index));
        let longest = cells.map(|cell| cell.content().chars().count()).max().unwrap_or(0);
        if let Some(column) = table.column_mut(*index) {
            column.set_cell_alignment(CellAlignment::Right);
            let whole = u16::try_from(longest + 1).unwrap_or(u16::MAX);
            column.set_constraint(ColumnConstraint::LowerBoundary(Width::Fixed(whole)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terminals_are_not_controlled_by_names() {
        assert_eq!(without_controls("caf\u{e9} \u{9b}31m\u{85}"), "caf\u{e9} \\u009b31m\\u0085");
        assert!(matches!(without_controls("\u{1b}[1mcaf\u{e9}\u{1b}[0m"), Cow::Borrowed(_)));
    }
}
