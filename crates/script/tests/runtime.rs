//! The embedded package is the one in `python/`, all of it and nothing else.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "helpers of tests are tests, too")]

use std::fs;
use std::path::{Path, PathBuf};

use pydslrep_script::runtime::{self, File};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../python").join(runtime::NAME)
}

/// The paths of all sources below a folder.
fn sources(folder: &Path, prefix: &str, found: &mut Vec<String>) {
    for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let name = entry.file_name().into_string().unwrap();
        let path = format!("{prefix}{name}");
        if entry.path().is_dir() {
            if name != "__pycache__" {
                sources(&entry.path(), &format!("{path}/"), found);
            }
        } else if entry.path().extension().is_some_and(|extension| extension == "py") || path == "py.typed" {
            found.push(path);
        }
    }
}

#[test]
fn every_source_is_embedded() {
    let mut expected = Vec::new();
    sources(&folder(), "", &mut expected);
    expected.sort();
    let paths: Vec<String> = runtime::files().iter().map(|file| file.path.to_string()).collect();
    assert_eq!(paths, expected, "new files are seen when crates/script/src/runtime.rs is compiled again");
    for path in ["__init__.py", "py.typed", "slam/__init__.py"] {
        assert!(paths.iter().any(|found| found == path), "{path}");
    }
    for File { path, content } in runtime::files() {
        assert_eq!(content, fs::read(folder().join(&*path)).unwrap(), "{path}");
    }
}

#[test]
fn the_package_has_the_version_of_this_program() {
    let file = runtime::files().into_iter().find(|file| file.path == "version.py").expect("version.py");
    let text = String::from_utf8(file.content.into_owned()).unwrap();
    assert!(text.contains(&format!("\n__version__ = \"{}\"\n", runtime::VERSION)), "{text}");
}
