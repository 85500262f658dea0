//! Keys of documents, and the paths of their files.

use std::borrow::Cow;
use std::path::Path;

/// The path of the file with a key: on Windows, `C:\a\b.pyr` for `/C:/a/b.pyr`; elsewhere they are the same.
pub fn path_of(key: &str) -> Cow<'_, Path> {
    if cfg!(windows) { Cow::Owned(on_windows(key).into()) } else { Cow::Borrowed(Path::new(key)) }
}

/// The key of the file at an absolute path; [`path_of`] leads back.
pub fn key_of(path: &Path) -> String {
    let path = path.to_string_lossy();
    if cfg!(windows) { from_windows(&path) } else { path.into_owned() }
}

/// A path of Windows for a key: `/C:/a` is on a drive, `//host/a` on another machine.
fn on_windows(key: &str) -> String {
    let path = match drive_of(key.strip_prefix('/').unwrap_or_default()) {
        Some(_) => &key[1..],
        None => key,
    };
    let path = path.replace('/', r"\");
    // `C:` alone is the current folder on that drive.
    if path.ends_with(':') { path + r"\" } else { path }
}

/// The key for an absolute path of Windows, which may be verbatim (`\\?\`), as canonical ones are.
fn from_windows(path: &str) -> String {
    let path = match (path.strip_prefix(r"\\?\UNC\"), path.strip_prefix(r"\\?\")) {
        (Some(shared), _) => format!("//{shared}"),
        (None, plain) => plain.unwrap_or(path).to_owned(),
    };
    let path = path.replace('\\', "/");
    match drive_of(&path) {
        Some(drive) => format!("/{}{}", drive.to_ascii_uppercase(), &path[1..]),
        None => path,
    }
}

/// The letter that a path on a drive begins with.
fn drive_of(path: &str) -> Option<char> {
    match path.as_bytes() {
        [letter, b':', rest @ ..] if letter.is_ascii_alphabetic() && matches!(rest, [] | [b'/', ..]) => {
            Some(char::from(*letter))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_windows_have_keys() {
        for (path, key) in [
            (r"C:\a b\x.pyr", "/C:/a b/x.pyr"),
            (r"C:\", "/C:/"),
            (r"\\server\share\é.pyr", "//server/share/é.pyr"),
        ] {
            assert_eq!(from_windows(path), key);
            assert_eq!(on_windows(key), path);
        }
        assert_eq!(from_windows(r"c:\a/b\x.pyr"), "/C:/a/b/x.pyr");
        assert_eq!(from_windows(r"\\?\C:\x.pyr"), "/C:/x.pyr");
        assert_eq!(from_windows(r"\\?\UNC\server\share\x.pyr"), "//server/share/x.pyr");
        assert_eq!(on_windows("/C:"), r"C:\");
        assert_eq!(on_windows("untitled:1"), "untitled:1");
    }

    #[test]
    fn a_key_leads_back_to_its_file() {
        let path = std::env::temp_dir().join("a b").join("é.pyr");
        assert_eq!(path_of(&key_of(&path)), path);
    }
}
