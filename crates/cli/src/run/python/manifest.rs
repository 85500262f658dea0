//! The manifest of a complete environment.

use std::collections::BTreeMap;
use std::fs::{self, Metadata};
use std::io;
use std::path::Path;
use std::time::UNIX_EPOCH;

use serde::{Deserialize, Serialize};
use walkdir::WalkDir;

const NAME: &str = "installed.json";

/// The files of its packages, by their path from the environment. Changing, truncating or replacing a file changes its
/// size or its time.
#[derive(Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
struct Manifest(BTreeMap<String, Stamp>);

/// Size in bytes, and seconds since 1970.
#[derive(Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Stamp(u64, u64);

impl Stamp {
    fn of(file: &Metadata) -> Self {
        let time = file.modified().ok().and_then(|time| time.duration_since(UNIX_EPOCH).ok());
        Self(file.len(), time.map_or(0, |time| time.as_secs()))
    }
}

/// Records an environment that is complete; Python itself writes `__pycache__`.
pub(super) fn write(home: &Path) -> io::Result<()> {
    let mut manifest = Manifest::default();
    for entry in WalkDir::new(home).into_iter().filter_entry(|entry| entry.file_name() != "__pycache__") {
        let entry = entry?;
        let path = entry.path().strip_prefix(home).ok().and_then(Path::to_str);
        if let Some(path) = path.filter(|_| entry.file_type().is_file()) {
            manifest.0.insert(path.to_owned(), Stamp::of(&entry.metadata()?));
        }
    }
    fs::write(home.join(NAME), serde_json::to_vec(&manifest)?)
}

/// Returns the first damage of an environment, if there is any.
pub(super) fn damage(home: &Path) -> Option<String> {
    let recorded = fs::read(home.join(NAME)).ok().and_then(|bytes| serde_json::from_slice(&bytes).ok());
    let Some(Manifest(recorded)) = recorded else { return Some(format!("{NAME} cannot be read")) };
    recorded.into_iter().find_map(|(path, stamp)| match fs::metadata(home.join(&path)) {
        Ok(found) if Stamp::of(&found) == stamp => None,
        Ok(_) => Some(format!("{path} has changed")),
        Err(_) => Some(format!("{path} is missing")),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn environment() -> tempfile::TempDir {
        let home = tempfile::tempdir().expect("a folder");
        fs::create_dir_all(home.path().join("lib/zmq/__pycache__")).expect("folders");
        fs::write(home.path().join("lib/zmq/core.so"), "binary").expect("a file");
        write(home.path()).expect("the manifest");
        home
    }

    #[test]
    fn a_sound_environment_is_sound_after_use() {
        let home = environment();
        fs::write(home.path().join("lib/zmq/__pycache__/core.pyc"), "compiled").expect("a file");
        assert_eq!(damage(home.path()), None);
    }

    #[test]
    fn a_file_that_is_cut_short_or_missing_is_named() {
        let home = environment();
        fs::write(home.path().join("lib/zmq/core.so"), "bin").expect("a file");
        assert_eq!(damage(home.path()).as_deref(), Some("lib/zmq/core.so has changed"));
        fs::remove_file(home.path().join("lib/zmq/core.so")).expect("removed");
        assert_eq!(damage(home.path()).as_deref(), Some("lib/zmq/core.so is missing"));
    }

    #[test]
    fn without_its_manifest_it_is_incomplete() {
        let home = environment();
        fs::write(home.path().join(NAME), "{").expect("a file");
        assert_eq!(damage(home.path()).as_deref(), Some("installed.json cannot be read"));
    }
}
