//! The results for a folder, by its previous content.

use std::collections::BTreeMap;

use tempfile::TempDir;

use super::*;

fn never() -> bool {
    panic!("nobody needs to be asked")
}

/// A folder with the package as this version writes it.
fn written() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(NAME);
    assert_eq!(write_runtime(folder.path(), || false).unwrap(), RuntimeFolder::Written(path.clone()));
    (folder, path)
}

/// Makes it a copy that another version wrote, with one file that this one does not have.
fn make_older(path: &Path) {
    let mut record = Record::parse(&fs::read(path.join(RECORD)).unwrap()).unwrap();
    record.version = "0.0.9".to_owned();
    for (name, content) in [("__init__.py", "old = 1\n"), ("slam/gone.py", "gone = 1\n")] {
        fs::write(path.join(name), content).unwrap();
        record.files.insert(name.to_owned(), sha256(content.as_bytes()));
    }
    fs::write(path.join(RECORD), record.to_json()).unwrap();
}

/// Every file of a folder by its path in it.
fn files_in(path: &Path) -> BTreeMap<String, Vec<u8>> {
    let names = list(path).unwrap();
    names.into_iter().map(|file| (file.name.clone(), fs::read(path.join(file.name)).unwrap())).collect()
}

fn current() -> BTreeMap<String, Vec<u8>> {
    let all = pydslrep_script::runtime::files().into_iter();
    all.map(|file| (file.path.into_owned(), file.content.into_owned())).collect()
}

fn outcome(folder: &TempDir) -> RuntimeFolder {
    let outcome = write_runtime(folder.path(), never).unwrap();
    assert_eq!(folder.path().read_dir().unwrap().count(), 1, "nothing is left beside it");
    outcome
}

#[test]
fn a_missing_one_is_written_whole() {
    let (_folder, path) = written();
    assert_eq!(files_in(&path), current());
    let record = Record::parse(&fs::read(path.join(RECORD)).unwrap()).unwrap();
    assert_eq!((record.version.as_str(), record.files.len()), (VERSION, current().len()));
}

#[test]
fn an_installed_one_is_enough() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(write_runtime(folder.path(), || true).unwrap(), RuntimeFolder::Installed);
    assert_eq!(folder.path().read_dir().unwrap().count(), 0);
}

#[test]
fn an_unchanged_one_is_not_written_again() {
    let (folder, path) = written();
    fs::create_dir(path.join(CACHES)).unwrap();
    fs::write(path.join(CACHES).join("pose.pyc"), "").unwrap();
    assert_eq!(outcome(&folder), RuntimeFolder::Current(path.clone()));
    assert!(path.join(CACHES).exists(), "it is the same folder");
    fs::write(path.join("notes.txt"), "mine").unwrap();
    assert_eq!(outcome(&folder), RuntimeFolder::Current(path));
}

#[test]
fn a_copy_without_a_record_is_enough_if_it_is_whole() {
    let (folder, path) = written();
    fs::remove_file(path.join(RECORD)).unwrap();
    assert_eq!(outcome(&folder), RuntimeFolder::Current(path));
}

#[test]
fn an_older_one_is_replaced() {
    let (folder, path) = written();
    make_older(&path);
    fs::write(path.join("notes.txt"), "mine").unwrap();
    let replaced = RuntimeFolder::Replaced { path: path.clone(), before: "0.0.9".to_owned() };
    assert_eq!(outcome(&folder), replaced);
    let mut expected = current();
    expected.insert("notes.txt".to_owned(), b"mine".to_vec());
    assert_eq!(files_in(&path), expected, "what another version had is gone, what somebody added is not");
}

#[test]
fn a_lost_file_comes_back() {
    let (folder, path) = written();
    fs::remove_file(path.join("__init__.py")).unwrap();
    let again = outcome(&folder);
    assert!(again.to_string().ends_with(&format!("written again (version {VERSION})")), "{again}");
    assert_eq!(files_in(&path), current());
}

#[test]
fn a_changed_one_is_kept() {
    type Change = fn(&Path);
    let changes: [(Change, Option<&str>); 5] = [
        (|path| fs::write(path.join("__init__.py"), "mine = 1\n").unwrap(), Some("__init__.py")),
        (
            |path| {
                make_older(path);
                fs::write(path.join("slam/gone.py"), "mine = 1\n").unwrap();
            },
            Some("slam/gone.py"),
        ),
        (
            |path| {
                fs::remove_file(path.join(RECORD)).unwrap();
                fs::write(path.join("__init__.py"), "mine = 1\n").unwrap();
            },
            None,
        ),
        (
            // Files that this version has, and the one that wrote the folder did not.
            |path| fs::write(path.join(RECORD), r#"{"version": "0.0.9", "files": {}}"#).unwrap(),
            Some("__init__.py"),
        ),
        (
            |path| {
                fs::remove_dir_all(path).unwrap();
                fs::write(path, "mine").unwrap();
            },
            None,
        ),
    ];
    for (index, (change, changed)) in changes.into_iter().enumerate() {
        let (folder, path) = written();
        change(&path);
        let before = path.is_dir().then(|| files_in(&path));
        let kept = Kept { path: path.clone(), changed: changed.map(str::to_owned) };
        assert_eq!(outcome(&folder), RuntimeFolder::Kept(kept), "{index}");
        assert_eq!(path.is_dir().then(|| files_in(&path)), before, "{index}");
    }
}

#[cfg(unix)]
#[test]
fn a_link_is_not_followed() {
    let (elsewhere, path) = written();
    make_older(&path);
    let folder = tempfile::tempdir().unwrap();
    std::os::unix::fs::symlink(&path, folder.path().join(NAME)).unwrap();
    assert!(matches!(outcome(&folder), RuntimeFolder::Kept(_)));
    let (linked, path) = written();
    fs::remove_file(path.join("py.typed")).unwrap();
    std::os::unix::fs::symlink(elsewhere.path().join(NAME).join("py.typed"), path.join("py.typed")).unwrap();
    assert!(matches!(outcome(&linked), RuntimeFolder::Kept(_)));
}

#[test]
fn messages_say_what_to_do() {
    let kept = |changed: Option<&str>| {
        let kept = Kept { path: NAME.into(), changed: changed.map(str::to_owned) };
        format!("{}\n{}", RuntimeFolder::Kept(kept.clone()), kept.help())
    };
    expect_test::expect![[r#"
        pydslrep_runtime is not replaced: pose.py in it was changed
        delete it to have version 0.2.0 written, or set `write-runtime = false` in pydslrep.toml to keep it
        pydslrep_runtime is not replaced: PyDSLRep did not write it
        delete it to have version 0.2.0 written, or set `write-runtime = false` in pydslrep.toml to keep it"#]]
    .assert_eq(&format!("{}\n{}", kept(Some("pose.py")), kept(None)));
}

#[test]
fn a_cache_provides_whole_packages_only() {
    let cache = tempfile::tempdir().unwrap();
    let folder = provide_runtime(cache.path()).unwrap();
    assert_eq!(files_in(&folder.join(NAME)), current());
    fs::write(folder.join(NAME).join("__init__.py"), "broken").unwrap();
    assert_eq!(provide_runtime(cache.path()).unwrap(), folder);
    assert_eq!(files_in(&folder.join(NAME)), current());
    assert_eq!(cache.path().read_dir().unwrap().count(), 1);
}

#[test]
fn several_at_once_write_one() {
    for is_damaged in [false, true] {
        let cache = tempfile::tempdir().unwrap();
        if is_damaged {
            let folder = provide_runtime(cache.path()).unwrap();
            fs::write(folder.join(NAME).join("__init__.py"), "broken").unwrap();
        }
        std::thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| {
                    let folder = provide_runtime(cache.path()).unwrap();
                    // A copy is away for a moment while it is replaced.
                    assert!(is_damaged || files_in(&folder.join(NAME)) == current());
                });
            }
        });
        let folder = provide_runtime(cache.path()).unwrap();
        assert_eq!(files_in(&folder.join(NAME)), current());
        assert_eq!(folder.read_dir().unwrap().count(), 1);
    }
}
