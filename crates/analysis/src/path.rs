//! Paths of imports: what they lead to, and how they are written. A path is text with `/` between its parts; nothing here looks at a disk.

/// The path that `relative`, written in the file at `base`, leads to. `.` and `..` are resolved where they can be.
pub fn join(base: &str, relative: &str) -> String {
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

/// Returns the path by which the file at `base` imports `target`, so that [`join`] leads there; `None` if there is
/// none.
pub fn relative(base: &str, target: &str) -> Option<String> {
    let folders = |path: &str| path.split('/').map(str::to_owned).collect::<Vec<_>>();
    let (mut from, to) = (folders(base), folders(target));
    from.pop();
    let common = from.iter().zip(&to[..to.len() - 1]).take_while(|(one, other)| one == other).count();
    let up = std::iter::repeat_n("..", from.len() - common);
    let written: Vec<&str> = up.chain(to[common..].iter().map(String::as_str)).collect();
    let written = written.join("/");
    let fits_in_quotes = !written.contains(['"', '\n', '\r']);
    (fits_in_quotes && join(base, &written) == target).then_some(written)
}

fn slashes(folder: &str) -> &str {
    let start = folder.find("://").map_or(0, |colon| colon + 1);
    let run = folder[start..].len() - folder[start..].trim_start_matches('/').len();
    &folder[start..start + run]
}

#[cfg(test)]
mod tests {
    use super::{join, relative};

    #[test]
    fn paths_are_relative_to_the_importing_file() {
        assert_eq!(join("a/b.pyr", "c.pyr"), "a/c.pyr");
        assert_eq!(join("/a/b/c.pyr", "../d/./e.pyr"), "/a/d/e.pyr");
        assert_eq!(join("b.pyr", "../c.pyr"), "../c.pyr");
        assert_eq!(join("file:///w/a.pyr", "parts/x.pyr"), "file:///w/parts/x.pyr");
        assert_eq!(join("file:///w/a.pyr", "../../../x.pyr"), "file:///../../x.pyr");
    }

    #[test]
    fn a_path_can_be_written_as_imports_want_it() {
        let pairs = [
            ("a/b.pyr", "a/c.pyr", "c.pyr"),
            ("/a/b/c.pyr", "/a/d/e.pyr", "../d/e.pyr"),
            ("/a.pyr", "/b/c d/é.pyr", "b/c d/é.pyr"),
            ("/a/b/c.pyr", "/d.pyr", "../../d.pyr"),
            ("b.pyr", "../c.pyr", "../c.pyr"),
            ("file:///w/a.pyr", "file:///w/parts/x.pyr", "parts/x.pyr"),
        ];
        for (base, target, written) in pairs {
            assert_eq!(relative(base, target).as_deref(), Some(written));
            assert_eq!(join(base, written), target);
        }
        for (base, target) in [("untitled:one", "/a.pyr"), ("/a.pyr", "/b\"c.pyr"), ("../a.pyr", "b.pyr")] {
            assert_eq!(relative(base, target), None, "{target}");
        }
    }
}
