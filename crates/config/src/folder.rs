//! A folder inside of the one that the settings are about.

use pydslrep_schema::{Refusal, Values};

use crate::keys::Settings;

/// A relative folder.
pub(crate) const FOLDER: Values = Values::Text("a folder", r"\S", read);

/// Brings a path into its canonical form. It must not lead elsewhere: settings come with the programs of other people.
fn read(path: &str) -> Result<String, Refusal> {
    let refuse = |message: &str, help: &str| {
        Err(Refusal { help: Some(help.to_owned()), ..Refusal::from(message.to_owned()) })
    };
    if path.trim().is_empty() {
        return refuse(
            "is empty",
            "name a folder, or remove the key: scripts are then written beside their programs",
        );
    }
    if path.chars().any(char::is_control) {
        return refuse("is not a path: it contains control characters", "name a folder: `\"scripts\"`");
    }
    let elsewhere = "use `pydslrep build -o` to write scripts anywhere else";
    // The same text is read on every system.
    let has_drive = path.as_bytes().get(1) == Some(&b':');
    if has_drive || path.starts_with(['/', '\\']) {
        return refuse("must be relative to the folder of the settings, not an absolute path", elsewhere);
    }
    let mut parts = Vec::new();
    for part in path.split(['/', '\\']).filter(|part| !part.is_empty() && *part != ".") {
        if part != ".." {
            parts.push(part);
        } else if parts.pop().is_none() {
            return refuse("leads out of the folder of the settings", elsewhere);
        }
    }
    Ok(if parts.is_empty() { ".".to_owned() } else { parts.join("/") })
}

impl Settings {
    /// Returns the number of folders in the path to scripts; 0 where they go beside programs.
    pub fn output_depth(&self) -> usize {
        self.output.iter().flat_map(|path| path.split('/')).filter(|part| *part != ".").count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_counted() {
        for (path, depth) in [("scripts", 1), ("a/b/../c", 2), (".", 0)] {
            let settings = Settings { output: read(path).ok(), ..Settings::default() };
            assert_eq!(settings.output_depth(), depth, "{path}");
        }
        assert_eq!(Settings::default().output_depth(), 0);
    }

    #[test]
    fn folders_stay_inside() {
        for (path, clean) in
            [("scripts", "scripts"), ("./a/../b//c/", "b/c"), (".", "."), ("a\\b", "a/b"), ("機 器", "機 器")]
        {
            assert_eq!(read(path).ok().as_deref(), Some(clean), "{path}");
        }
        for path in ["", " ", "/tmp", "\\\\host\\x", "C:\\x", "..", "a/../../b", "a\\..\\..", "a\0b", "\n"] {
            assert!(read(path).is_err(), "{path:?}");
        }
    }
}
