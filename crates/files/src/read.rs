//! The text of a file.

use std::fmt;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Larger files are no programs.
pub const MOST_BYTES: u64 = 64 << 20;

/// Why there is no text.
#[derive(Debug)]
pub enum Unread {
    /// There is no such file.
    Missing,
    /// It has more than [`MOST_BYTES`].
    TooLarge,
    /// It is not in UTF-8.
    NotText {
        /// The first line that is not, from 1.
        line: usize,
    },
    /// What the system says.
    Failed(io::Error),
}

/// What is the matter, to go behind the name of the file and a colon.
impl fmt::Display for Unread {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing => f.write_str("there is no such file"),
            Self::TooLarge => write!(f, "it is larger than {} MiB", MOST_BYTES >> 20),
            Self::NotText { line } => write!(f, "it is no text in UTF-8: line {line} holds other bytes"),
            Self::Failed(error) if error.kind() == io::ErrorKind::IsADirectory => {
                f.write_str("it is a folder")
            }
            Self::Failed(error) if error.kind() == io::ErrorKind::PermissionDenied => {
                f.write_str("you have no right to read it")
            }
            Self::Failed(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for Unread {}

/// The text of a file, byte order mark and all.
///
/// # Errors
/// When it is not there, cannot be read, or is no text.
pub fn read(path: &Path) -> Result<String, Unread> {
    File::open(path)
        .map_err(|error| match error.kind() {
            io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => Unread::Missing,
            _ => Unread::Failed(error),
        })
        .and_then(decode)
}

/// The text that a stream holds.
///
/// # Errors
/// When it cannot be read, or is no text.
pub fn decode(stream: impl Read) -> Result<String, Unread> {
    let mut bytes = Vec::new();
    stream.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(Unread::Failed)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(Unread::TooLarge);
    }
    String::from_utf8(bytes).map_err(|error| {
        let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        Unread::NotText { line: before.split(|byte| *byte == b'\n').count() }
    })
}

const BYTE_ORDER_MARK: char = '\u{feff}';

/// A byte order mark is not part of the text: editors hide it, and columns would be off by one.
pub fn without_mark(text: &str) -> &str {
    text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_reason_is_told_in_words() {
        let folder = tempfile::tempdir().unwrap();
        let said = |path: &Path| read(path).unwrap_err().to_string();
        assert_eq!(said(folder.path()), "it is a folder");
        let file = folder.path().join("x.pyr");
        assert_eq!(said(&file), "there is no such file");
        std::fs::write(&file, b"a\nb\xff").unwrap();
        assert_eq!(said(&file), "it is no text in UTF-8: line 2 holds other bytes");
        assert_eq!(said(&file.join("y.pyr")), "there is no such file");
        assert_eq!(decode(io::repeat(b' ')).unwrap_err().to_string(), "it is larger than 64 MiB");
    }
}
