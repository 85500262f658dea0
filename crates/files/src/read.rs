//! The text of a file.

use std::io::Read;
use std::path::Path;

use pydslrep_workspace::{MAX_BYTES, ReadError};

use crate::regular::{open, take};

/// The text of a file, including a byte order mark.
///
/// # Errors
/// When the file does not exist, cannot be read, is not a regular file, is too large, or is not text.
pub fn read(path: &Path) -> Result<String, ReadError> {
    decode(open(path)?)
}

/// The text of a stream.
///
/// # Errors
/// When it cannot be read, is too large, or is not text.
pub fn decode(stream: impl Read) -> Result<String, ReadError> {
    String::from_utf8(take(stream, MAX_BYTES)?).map_err(|error| {
        let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        ReadError::NotText { line: before.split(|byte| *byte == b'\n').count() }
    })
}

#[cfg(test)]
mod tests {
    use std::io;

    use super::*;

    #[test]
    fn errors_say_why_there_is_no_text() {
        let folder = tempfile::tempdir().unwrap();
        let error = |path: &Path| read(path).unwrap_err().to_string();
        assert_eq!(error(folder.path()), "is a folder");
        let file = folder.path().join("x.pyr");
        assert_eq!(error(&file), "file not found");
        std::fs::write(&file, b"a\nb\xff").unwrap();
        assert_eq!(error(&file), "not valid UTF-8 in line 2");
        assert_eq!(error(&file.join("y.pyr")), "file not found");
        assert_eq!(decode(io::repeat(b' ')).unwrap_err().to_string(), "larger than 16 MiB");
    }
}
