//! The text of a file.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use pydslrep_workspace::{MAX_BYTES, ReadError};

/// The text of a file, including a byte order mark.
///
/// # Errors
/// When the file does not exist, cannot be read, or is not text.
pub fn read(path: &Path) -> Result<String, ReadError> {
    File::open(path).map_err(|error| read_error(&error)).and_then(decode)
}

/// The text of a stream.
///
/// # Errors
/// When it cannot be read, or is not text.
pub fn decode(stream: impl Read) -> Result<String, ReadError> {
    let mut bytes = Vec::new();
    stream.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(|error| read_error(&error))?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(ReadError::TooLarge);
    }
    String::from_utf8(bytes).map_err(|error| {
        let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        ReadError::NotText { line: before.split(|byte| *byte == b'\n').count() }
    })
}

fn read_error(error: &io::Error) -> ReadError {
    match error.kind() {
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => ReadError::Missing,
        io::ErrorKind::IsADirectory => ReadError::Folder,
        io::ErrorKind::PermissionDenied => ReadError::PermissionDenied,
        _ => ReadError::Other(error.to_string()),
    }
}

#[cfg(test)]
mod tests {
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
        assert_eq!(decode(io::repeat(b' ')).unwrap_err().to_string(), "larger than 64 MiB");
    }
}
