//! Paths of files: absolute, relative to the current folder, as keys of the workspace, and as they are printed.

use std::path::{Component, Path, PathBuf};

use crate::failure::Failure;

/// The absolute path without `.` and `..`, the same however a file was named.
pub(crate) fn absolute(path: &Path) -> Result<PathBuf, Failure> {
    let whole = std::path::absolute(path)
        .map_err(|error| Failure::new(format!("cannot find {}: {error}", path.display())))?;
    let mut clean = PathBuf::new();
    for component in whole.components() {
        match component {
            Component::ParentDir => {
                clean.pop();
            }
            Component::CurDir => {}
            other => clean.push(other),
        }
    }
    Ok(clean)
}

/// The path relative to the current folder, if it is inside it.
pub(crate) fn near(path: &Path) -> PathBuf {
    let here = std::env::current_dir().unwrap_or_default();
    match path.strip_prefix(&here) {
        Ok(near) if !near.as_os_str().is_empty() => near.to_owned(),
        _ => path.to_owned(),
    }
}

/// The path as it is printed.
pub(crate) fn shown(path: &Path) -> String {
    path.strip_prefix(".").unwrap_or(path).display().to_string()
}

/// A path with `/` between its parts, as other tools want it on every system.
pub(crate) fn with_slashes(shown: &str) -> String {
    if cfg!(windows) { shown.replace('\\', "/") } else { shown.to_owned() }
}
