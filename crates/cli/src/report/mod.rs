//! The output of the command.
//!
//! [`output`] writes to the terminal; [`render`] draws diagnostics for people, [`json`], [`github`] and [`sarif`] write
//! them for programs.

pub(crate) mod github;
pub(crate) mod json;
pub(crate) mod numbers;
pub(crate) mod output;
pub(crate) mod place;
pub(crate) mod render;
pub(crate) mod sarif;
pub(crate) mod summary;

/// A message with its help and its note, for formats that have no place for them.
fn with_advice(message: &str, help: Option<&str>, note: Option<&str>) -> String {
    let advice = [("help", help), ("note", note)].into_iter();
    let lines = advice.filter_map(|(word, text)| Some(format!("\n{word}: {}", text?)));
    lines.fold(message.to_owned(), |text, line| text + &line)
}
