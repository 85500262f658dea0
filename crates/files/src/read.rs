//! Reads text files.

use std::fmt;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// The maximum size of a program.
pub const MAX_BYTES: u64 = 64 << 20;

/// Why a file cannot be read.
#[derive(Debug)]
pub enum Unread {
    /// There is no such file.
    Missing,
    /// It has more than [`MAX_BYTES`].
    TooLarge,
    /// It is not valid UTF-8.
    NotText {
        /// The first invalid line, from 1.
        line: usize,
    },
    /// Another I/O error.
    Failed(io::Error),
}

/// The message, to follow the name of the file and a colon.
impl fmt::Display for Unread {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing => f.write_str("file not found"),
            Self::TooLarge => write!(f, "larger than {} MiB", MAX_BYTES >> 20),
            Self::NotText { line } => write!(f, "not valid UTF-8 in line {line}"),
            Self::Failed(error) if error.kind() == io::ErrorKind::IsADirectory => f.write_str("is a folder"),
            Self::Failed(error) if error.kind() == io::ErrorKind::PermissionDenied => {
                f.write_str("permission denied")
            }
            Self::Failed(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for Unread {}

/// Reads the text of a file, including any byte order mark.
///
/// # Errors
/// If it does not exist, cannot be read, or is not valid UTF-8.
pub fn read(path: &Path) -> Result<String, Unread> {
    File::open(path)
        .map_err(|error| match error.kind() {
            io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => Unread::Missing,
            _ => Unread::Failed(error),
        })
        .and_then(decode)
}

/// Reads the text of a stream.
///
/// # Errors
/// If it cannot be read, or is not valid UTF-8.
pub fn decode(stream: impl Read) -> Result<String, Unread> {
    let mut bytes = Vec::new();
    stream.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(Unread::Failed)?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(Unread::TooLarge);
    }
    String::from_utf8(bytes).map_err(|error| {
        let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        Unread::NotText { line: before.split(|byte| *byte == b'\n').count() }
    })
}

const BYTE_ORDER_MARK: char = '\u{feff}';

/// The text without its byte order mark: editors hide the mark, and columns would be off by one.
pub fn without_mark(text: &str) -> &str {
    text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_have_messages() {
        let folder = tempfile::tempdir().unwrap();
        let message = |path: &Path| read(path).unwrap_err().to_string();
        assert_eq!(message(folder.path()), "is a folder");
        let file = folder.path().join("x.pyr");
        assert_eq!(message(&file), "file not found");
        std::fs::write(&file, b"a\nb\xff").unwrap();
        assert_eq!(message(&file), "not valid UTF-8 in line 2");
        assert_eq!(message(&file.join("y.pyr")), "file not found");
        assert_eq!(decode(io::repeat(b' ')).unwrap_err().to_string(), "larger than 64 MiB");
    }
}
