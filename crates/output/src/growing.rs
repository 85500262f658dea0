//! Files that are written while something runs: under a name that says that they are not complete.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::WriteError;
use crate::kind::Kind;
use crate::place::free_place;

/// The suffix of such a file; the scripts' own traces have the same one (`python/pydslrep_runtime/outputs.py`).
const ENDING: &str = ".partial";

/// A file that is called `NAME.partial` until it is finished. If its process is killed, it stays under that name.
#[derive(Debug)]
pub struct GrowingFile {
    path: PathBuf,
    partial: PathBuf,
    place: PathBuf,
    file: BufWriter<File>,
}

impl GrowingFile {
    /// Begins a file.
    ///
    /// # Errors
    /// If it may not be written, or another process is writing it.
    pub fn begin(path: &Path, kind: Kind) -> Result<Self, WriteError> {
        let place = free_place(path, kind)?;
        let mut partial = place.clone().into_os_string();
        partial.push(ENDING);
        let partial = free_place(Path::new(&partial), kind)?;
        let open = || {
            let file = File::options().write(true).create(true).truncate(false).open(&partial)?;
            if let Err(fs::TryLockError::WouldBlock) = file.try_lock() {
                return Err(io::Error::other("another process is writing it"));
            }
            file.set_len(0)?;
            Ok(file)
        };
        let file = open().map_err(|error| WriteError::unwritten(&partial, error))?;
        Ok(Self { path: path.to_owned(), file: BufWriter::new(file), partial, place })
    }

    /// Adds to the file; what was added is on its way to the disk.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn add(&mut self, content: &[u8]) -> Result<(), WriteError> {
        let added = self.file.write_all(content).and_then(|()| self.file.flush());
        added.map_err(|error| WriteError::unwritten(&self.partial, error))
    }

    /// Gives the file its name.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn finish(mut self) -> Result<(), WriteError> {
        let mut finish = || {
            self.file.flush()?;
            self.file.get_ref().sync_all()?;
            fs::rename(&self.partial, &self.place)
        };
        finish().map_err(|error| WriteError::unwritten(&self.path, error))
    }
}

impl Write for GrowingFile {
    fn write(&mut self, content: &[u8]) -> io::Result<usize> {
        self.file.write(content)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_has_its_name_in_the_end() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.jsonl");
        let partial = folder.path().join("a.jsonl.partial");
        fs::write(&path, "").unwrap();
        let mut file = GrowingFile::begin(&path, Kind::Trace).unwrap();
        let line = b"{\"t\": 0.05, \"robot\": \"r\", \"x\": 0, \"y\": 0, \"theta\": 0}\n";
        file.add(line).unwrap();
        assert_eq!((fs::read(&path).unwrap(), fs::read(&partial).unwrap()), (vec![], line.to_vec()));
        assert!(GrowingFile::begin(&path, Kind::Trace).is_err(), "somebody is at it");
        file.finish().unwrap();
        assert_eq!(fs::read(&path).unwrap(), line);
        assert!(!partial.exists());
        drop(GrowingFile::begin(&path, Kind::Trace).unwrap());
        assert_eq!((fs::read(&path).unwrap(), partial.exists()), (line.to_vec(), true), "as if killed");
        fs::write(&partial, "mine").unwrap();
        assert!(GrowingFile::begin(&path, Kind::Trace).is_err());
    }
}
