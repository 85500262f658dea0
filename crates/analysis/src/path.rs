//! Paths of imports. A path is text with `/` between its parts; nothing here looks at a disk.

/// The path that `relative`, written in the file at `base`, leads to. `.` and `..` are resolved where they can be.
pub(crate) fn join(base: &str, relative: &str) -> String {
    let folder = base.rfind('/').map_or("", |slash| &base[..=slash]);
    let rooted = folder.starts_with('/');
    let mut parts: Vec<&str> = Vec::new();
    for part in folder.split('/').chain(relative.split('/')) {
        match part {
            "" | "." => {}
            ".." if parts.last().is_some_and(|last| *last != ".." && !last.ends_with(':')) => {
                parts.pop();
            }
            part => parts.push(part),
        }
    }
    let joined = parts.join("/");
    // `file:///a` keeps its three slashes: the empty parts between them were dropped above.
    match joined.split_once(":/") {
        Some((scheme, rest)) if folder.contains("://") => format!("{scheme}:{}{rest}", slashes(folder)),
        _ if rooted => format!("/{joined}"),
        _ => joined,
    }
}

fn slashes(folder: &str) -> &str {
    let start = folder.find("://").map_or(0, |colon| colon + 1);
    let run = folder[start..].len() - folder[start..].trim_start_matches('/').len();
    &folder[start..start + run]
}

#[cfg(test)]
mod tests {
    use super::join;

    #[test]
    fn paths_are_relative_to_the_importing_file() {
        assert_eq!(join("a/b.pyr", "c.pyr"), "a/c.pyr");
        assert_eq!(join("/a/b/c.pyr", "../d/./e.pyr"), "/a/d/e.pyr");
        assert_eq!(join("b.pyr", "../c.pyr"), "../c.pyr");
        assert_eq!(join("file:///w/a.pyr", "parts/x.pyr"), "file:///w/parts/x.pyr");
        assert_eq!(join("file:///w/a.pyr", "../../../x.pyr"), "file:///../../x.pyr");
    }
}
