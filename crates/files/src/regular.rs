//! Regular files, the only ones that are opened: a pipe or a device could make its reader wait forever, or take input
//! from another reader.

use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, Read};
use std::path::Path;

use pydslrep_text::file_names::is_reserved_on_windows;
use pydslrep_workspace::ReadError;

/// Opens a file for reading; never waits for another process.
///
/// # Errors
/// When it does not exist, cannot be opened, or is not a regular file.
pub fn open(path: &Path) -> Result<File, ReadError> {
    if cfg!(windows) && is_device(path) {
        return Err(ReadError::NotRegular);
    }
    // Opening a device can have effects of its own.
    fs::metadata(path).map_err(|error| read_error(&error)).and_then(|found| check(&found))?;
    let file = options().open(path).map_err(|error| read_error(&error))?;
    // It may have been exchanged since.
    file.metadata().map_err(|error| read_error(&error)).and_then(|found| check(&found))?;
    Ok(file)
}

/// The content of a file.
///
/// # Errors
/// As [`open`], and when it has more than `max` bytes.
pub fn read_bytes(path: &Path, max: u64) -> Result<Vec<u8>, ReadError> {
    take(open(path)?, max)
}

/// The first bytes of a file: all of it, if it has no more than `count`.
///
/// # Errors
/// As [`open`].
pub fn read_start(path: &Path, count: u64) -> Result<Vec<u8>, ReadError> {
    let mut bytes = Vec::new();
    open(path)?.take(count).read_to_end(&mut bytes).map_err(|error| read_error(&error))?;
    Ok(bytes)
}

/// Returns the content of a stream, if that is not more than `max` bytes.
pub(crate) fn take(stream: impl Read, max: u64) -> Result<Vec<u8>, ReadError> {
    let mut bytes = Vec::new();
    stream.take(max.saturating_add(1)).read_to_end(&mut bytes).map_err(|error| read_error(&error))?;
    if bytes.len() as u64 > max { Err(ReadError::TooLarge) } else { Ok(bytes) }
}

/// Returns whether Windows takes the name of a file for that of a device: `aux.scene.toml`, wherever it is.
fn is_device(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    is_reserved_on_windows(name.split('.').next().unwrap_or_default().trim_end())
}

fn check(found: &Metadata) -> Result<(), ReadError> {
    match (found.is_dir(), found.is_file()) {
        (true, _) => Err(ReadError::Folder),
        (_, true) => Ok(()),
        _ => Err(ReadError::NotRegular),
    }
}

#[cfg(unix)]
fn options() -> OpenOptions {
    use std::os::unix::fs::OpenOptionsExt;

    use rustix::fs::OFlags;
    let mut options = File::options();
    options.read(true).custom_flags((OFlags::NONBLOCK | OFlags::NOCTTY).bits().cast_signed());
    options
}

#[cfg(not(unix))]
fn options() -> OpenOptions {
    let mut options = File::options();
    options.read(true);
    options
}

pub(crate) fn read_error(error: &io::Error) -> ReadError {
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
    fn there_is_a_limit() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a");
        fs::write(&file, "12345").unwrap();
        assert_eq!(read_bytes(&file, 5).unwrap(), b"12345");
        assert_eq!(read_bytes(&file, 4), Err(ReadError::TooLarge));
        assert_eq!(read_start(&file, 2).unwrap(), b"12");
    }

    #[test]
    fn some_names_are_devices_on_windows() {
        assert!(
            ["a/aux.scene.toml", "COM1", "nul.pyr", "con .pyr"].iter().all(|path| is_device(Path::new(path)))
        );
        assert!(
            ["aux/a.pyr", "auxiliary.pyr", "com.pyr", "a.nul"].iter().all(|path| !is_device(Path::new(path)))
        );
    }

    #[cfg(unix)]
    #[test]
    fn pipes_and_devices_are_not_opened() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let [pipe, link, device] = ["pipe", "link", "device"].map(|name| folder.path().join(name));
        rustix::fs::mknodat(rustix::fs::CWD, &pipe, rustix::fs::FileType::Fifo, rustix::fs::Mode::RWXU, 0)
            .unwrap();
        symlink(&pipe, &link).unwrap();
        symlink("/dev/zero", &device).unwrap();
        for path in [&pipe, &link, &device] {
            assert_eq!(read_start(path, 1), Err(ReadError::NotRegular), "{}", path.display());
        }
    }
}
