//! Workspaces in memory.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests, too")]

use std::sync::Arc;

use pydslrep_config::Config;
use pydslrep_workspace::{MemoryFiles, ReadError, TextChange, Workspace};
use ropey::Rope;

/// A workspace and the files that it reads; names are relative to `/w`.
struct Fixture {
    files: Arc<MemoryFiles>,
    workspace: Workspace,
}

fn key(name: &str) -> String {
    format!("/w/{name}")
}

impl Fixture {
    fn new(files: &[(&str, &str)]) -> Self {
        let memory = Arc::new(MemoryFiles::default());
        for (name, text) in files {
            memory.write(key(name), text);
        }
        Self { workspace: Workspace::new(memory.clone()), files: memory }
    }

    fn open(&mut self, name: &str, text: &str) {
        self.workspace.open(&key(name), Rope::from_str(text));
    }

    fn change(&mut self, name: &str, text: &str) {
        let change = TextChange { span: None, after: Rope::from_str(text) };
        self.workspace.change(&key(name), vec![change]);
    }

    /// Writes a file and says so.
    fn write(&mut self, name: &str, text: &str) {
        self.files.write(key(name), text);
        self.workspace.file_changed(&key(name));
    }

    fn remove(&mut self, name: &str) {
        self.files.remove(key(name));
        self.workspace.file_changed(&key(name));
    }

    fn set_folders(&mut self, names: &[&str]) {
        self.workspace.set_folders(names.iter().map(|name| key(name)).collect());
    }

    fn codes(&self, name: &str) -> Vec<&'static str> {
        let file = self.workspace.document(&key(name)).unwrap().file.unwrap();
        let found = self.workspace.database().diagnostics(file);
        found.iter().map(pydslrep_analysis::Diagnostic::code).collect()
    }

    fn messages(&self, name: &str) -> Vec<String> {
        let file = self.workspace.document(&key(name)).unwrap().file.unwrap();
        let found = self.workspace.database().diagnostics(file);
        found.into_iter().map(|diagnostic| diagnostic.message).collect()
    }

    fn problems(&self, name: &str) -> Vec<String> {
        self.workspace.problems(&key(name)).into_iter().map(|problem| problem.message).collect()
    }

    fn speed(&self, name: &str) -> String {
        self.workspace.document(&key(name)).unwrap().settings.default_speed.to_string()
    }

    fn known(&self) -> Vec<&str> {
        let mut known: Vec<&str> =
            self.workspace.documents().map(|document| document.key.trim_start_matches("/w/")).collect();
        known.sort_unstable();
        known
    }

    fn changed(&mut self) -> Vec<String> {
        let changes = self.workspace.take_changes();
        changes.documents.into_iter().map(|key| key.trim_start_matches("/w/").to_owned()).collect()
    }
}

const WHEEL: &str = "wheel a with radius 4";
const WHEELS: &str = "wheel a with radius 4 wheel b with radius 4";
const USER: &str = "import \"parts/wheels.pyr\"\nrobot r with port 1 has { a b } wheels";

/// A program that drives two metres in the environment `yard`.
fn driver(environment: &str) -> String {
    format!(
        "{WHEELS} robot r with port 1 has {{ a b }} wheels movement m of r {{ move 2 meters }}\n\
         environment {environment} has {{ r }} robots with {{ m }} moves"
    )
}

const BOX_AHEAD: &str = "[[box]]\nat = [1, 0]\nsize = [0.4, 0.4]";

#[test]
fn an_import_is_read_and_forgotten_with_its_importer() {
    let mut fixture = Fixture::new(&[("parts/wheels.pyr", WHEEL)]);
    fixture.open("main.pyr", USER);
    assert_eq!(fixture.codes("main.pyr"), ["unresolved-reference"], "there is no wheel `b`");
    assert_eq!(fixture.known(), ["main.pyr", "parts/wheels.pyr"]);
    fixture.change("main.pyr", "");
    assert_eq!(fixture.known(), ["main.pyr"]);
    fixture.change("main.pyr", USER);
    assert!(fixture.workspace.close(&key("main.pyr")));
    assert_eq!(fixture.known(), [""; 0]);
    assert!(!fixture.workspace.close(&key("main.pyr")));
}

#[test]
fn imports_of_imports_are_read_too() {
    let movement = "import \"robots.pyr\"\nmovement m of r { turn left }";
    let robots = format!("{WHEELS} robot r with port 1 has {{ a b }} wheels");
    let mut fixture = Fixture::new(&[("moves.pyr", movement), ("robots.pyr", &robots)]);
    let main = "import \"moves.pyr\" import \"robots.pyr\" environment e has { r } robots with { m } moves";
    fixture.open("main.pyr", main);
    assert_eq!(fixture.known(), ["main.pyr", "moves.pyr", "robots.pyr"]);
    assert_eq!(fixture.codes("main.pyr"), [""; 0]);
    fixture.open("moves.pyr", "movement m of r { turn left }");
    assert_eq!(fixture.codes("moves.pyr"), ["unresolved-reference"]);
}

#[test]
fn an_open_document_wins_over_its_file() {
    let mut fixture = Fixture::new(&[("parts/wheels.pyr", WHEEL)]);
    fixture.open("main.pyr", USER);
    fixture.open("parts/wheels.pyr", WHEELS);
    assert_eq!(fixture.codes("main.pyr"), [""; 0]);
    fixture.write("parts/wheels.pyr", WHEEL);
    assert_eq!(fixture.codes("main.pyr"), [""; 0]);
    assert!(fixture.workspace.close(&key("parts/wheels.pyr")));
    assert_eq!(fixture.codes("main.pyr"), ["unresolved-reference"], "it is read again");
}

#[test]
fn files_come_change_and_go() {
    let mut fixture = Fixture::new(&[]);
    fixture.open("main.pyr", USER);
    assert_eq!(fixture.codes("main.pyr"), ["unresolved-import"]);
    fixture.write("parts/wheels.pyr", WHEELS);
    assert_eq!(fixture.codes("main.pyr"), [""; 0]);
    fixture.write("parts/wheels.pyr", "wheel a with radius 4 wheel b with radius 5");
    assert_eq!(fixture.codes("main.pyr"), ["mixed-radii"]);
    fixture.remove("parts/wheels.pyr");
    assert_eq!(fixture.codes("main.pyr"), ["unresolved-import"]);
    assert_eq!(fixture.known(), ["main.pyr"]);
}

#[test]
fn imports_stay_in_the_folders_of_the_workspace() {
    let mut fixture = Fixture::new(&[("wheel.pyr", WHEEL), ("project/b.pyr", WHEEL)]);
    fixture.open("project/main.pyr", "import \"../wheel.pyr\"");
    assert_eq!(fixture.codes("project/main.pyr"), ["unresolved-import"]);
    assert_eq!(fixture.known(), ["project/main.pyr"]);
    fixture.set_folders(&["project/"]);
    assert_eq!(fixture.codes("project/main.pyr"), ["unresolved-import"]);
    fixture.set_folders(&[""]);
    assert_eq!(fixture.codes("project/main.pyr"), [""; 0]);
    fixture.set_folders(&["project/", "other/"]);
    assert_eq!(fixture.codes("project/main.pyr"), ["unresolved-import"]);
    assert_eq!(fixture.known(), ["project/main.pyr"]);
}

/// The nearest settings bound the imports of the file they hold for, whichever file imports that.
#[test]
fn settings_bound_imports_of_each_file() {
    let mut fixture = Fixture::new(&[
        ("pydslrep.toml", ""),
        ("shared.pyr", WHEEL),
        ("a/b/part.pyr", "import \"../../shared.pyr\""),
    ]);
    fixture.open("a/main.pyr", "import \"b/part.pyr\"\nimport \"../shared.pyr\"");
    assert_eq!(fixture.codes("a/b/part.pyr"), [""; 0]);
    fixture.write("a/b/pydslrep.toml", "");
    assert_eq!(fixture.codes("a/b/part.pyr"), ["unresolved-import"]);
    assert_eq!(fixture.codes("a/main.pyr"), [""; 0]);
    fixture.remove("a/b/pydslrep.toml");
    assert_eq!(fixture.codes("a/b/part.pyr"), [""; 0]);
    fixture.remove("pydslrep.toml");
    assert_eq!(fixture.codes("a/main.pyr"), ["unresolved-import"]);
}

#[test]
fn why_an_import_is_absent_is_known() {
    let mut fixture = Fixture::new(&[("hall.scene.toml", "")]);
    fixture.files.write_unreadable(key("bytes.pyr"), ReadError::NotText { line: 3 });
    let imports = ["gone.pyr", "bytes.pyr", "hall.scene.toml"].map(|name| format!("import \"{name}\"\n"));
    fixture.open("main.pyr", &imports.concat());
    assert_eq!(
        fixture.messages("main.pyr"),
        [
            "there is no file `gone.pyr`",
            "`bytes.pyr` cannot be read: not valid UTF-8 in line 3",
            "`hall.scene.toml` cannot be read: not a program",
        ]
    );
}

#[test]
fn a_buffer_without_a_file_imports_nothing_and_has_no_problem_for_it() {
    let mut fixture = Fixture::new(&[]);
    fixture.workspace.open("untitled:Untitled-1", Rope::from_str(USER));
    let file = fixture.workspace.document("untitled:Untitled-1").unwrap().file.unwrap();
    assert_eq!(fixture.workspace.database().diagnostics(file), []);
}

#[test]
fn closed_files_of_the_workspace_stay() {
    let mut fixture = Fixture::new(&[("a.pyr", WHEEL)]);
    fixture.set_folders(&[""]);
    for name in ["a.pyr", "deleted.pyr"] {
        fixture.open(name, "");
        assert!(fixture.workspace.close(&key(name)));
    }
    assert_eq!(fixture.known(), ["a.pyr"]);
    fixture.set_folders(&[]);
    assert_eq!(fixture.known(), [""; 0]);
}

#[test]
fn the_nearest_settings_hold_and_follow_their_file() {
    let mut fixture = Fixture::new(&[("pydslrep.toml", "default-speed = 20"), ("a/pydslrep.toml", "")]);
    fixture.open("main.pyr", "");
    fixture.open("a/main.pyr", "");
    assert_eq!(fixture.speed("main.pyr"), "20");
    let default = fixture.speed("a/main.pyr");
    fixture.files.write(key("a/pydslrep.toml"), "default-speed = 30");
    assert_eq!(fixture.speed("a/main.pyr"), default, "no change was reported");
    fixture.workspace.file_changed(&key("a/pydslrep.toml"));
    assert_eq!(fixture.speed("a/main.pyr"), "30");
    fixture.open("a/pydslrep.toml", "default-speed = 40");
    assert_eq!(fixture.speed("a/main.pyr"), "40", "as it is in the editor");
    fixture.change("a/pydslrep.toml", "default-speed = 50");
    assert_eq!(fixture.speed("a/main.pyr"), "50");
    let (overrides, _) = Config::from_toml("default-speed = 60");
    fixture.workspace.set_overrides(overrides);
    assert_eq!(fixture.speed("a/main.pyr"), "60", "the caller wins");
    assert!(fixture.workspace.close(&key("a/pydslrep.toml")));
    fixture.workspace.set_overrides(Config::default());
    assert_eq!(fixture.speed("a/main.pyr"), "30");
    assert_eq!(fixture.speed("main.pyr"), "20");
}

#[test]
fn settings_that_cannot_be_read_hide_those_above() {
    let mut fixture = Fixture::new(&[("pydslrep.toml", "default-speed = 20")]);
    fixture.files.write_unreadable(key("a/pydslrep.toml"), ReadError::PermissionDenied);
    fixture.open("main.pyr", "");
    fixture.open("a/main.pyr", "");
    assert_ne!(fixture.speed("a/main.pyr"), fixture.speed("main.pyr"));
    assert_eq!(fixture.workspace.settings_file(&key("a/main.pyr")), Some("/w/a/pydslrep.toml"));
    assert_eq!(fixture.workspace.read_error("/w/a/pydslrep.toml"), Some(&ReadError::PermissionDenied));
    fixture.write("a/pydslrep.toml", "default-speed = 0\nspeed = 1");
    assert_eq!(fixture.workspace.read_error("/w/a/pydslrep.toml"), None);
    assert_eq!(fixture.problems("a/pydslrep.toml").len(), 2);
}

#[test]
fn scripts_go_to_the_folder_that_is_named() {
    let mut fixture = Fixture::new(&[("pydslrep.toml", "output = \"out\"")]);
    fixture.open("a/main.pyr", "");
    fixture.workspace.open("untitled:1", Rope::new());
    let folder = |fixture: &Fixture| fixture.workspace.output_folder(&key("a/main.pyr"));
    assert_eq!(folder(&fixture).as_deref(), Some("/w/out"));
    assert_eq!(fixture.workspace.output_folder("untitled:1"), None);
    let (overrides, _) = Config::from_toml("output = \"py\"");
    fixture.workspace.set_overrides(overrides);
    assert_eq!(folder(&fixture).as_deref(), Some("/w/a/py"));
    fixture.set_folders(&[""]);
    assert_eq!(folder(&fixture).as_deref(), Some("/w/py"));
}

#[test]
fn a_scene_comes_and_goes_with_its_environment() {
    let mut fixture = Fixture::new(&[("yard.scene.toml", BOX_AHEAD)]);
    fixture.open("main.pyr", &driver("yard"));
    assert_eq!(fixture.codes("main.pyr"), ["planned-collision"]);
    assert_eq!(fixture.known(), ["main.pyr", "yard.scene.toml"]);
    fixture.change("main.pyr", &driver("hall"));
    assert_eq!(fixture.codes("main.pyr"), [""; 0]);
    assert_eq!(fixture.known(), ["main.pyr"]);
    fixture.open("hall.scene.toml", BOX_AHEAD);
    assert_eq!(fixture.codes("main.pyr"), ["planned-collision"]);
    fixture.change("hall.scene.toml", "");
    assert_eq!(fixture.codes("main.pyr"), [""; 0]);
}

#[test]
fn a_scene_is_checked_against_the_first_program_with_its_environment() {
    let scene = "[robots.r]\nstart = [0, 0]\n[robots.s]\nstart = [1, 1]";
    let mut fixture =
        Fixture::new(&[("yard.scene.toml", scene), ("lone.scene.toml", "[robots.x]\nstrat = 1")]);
    fixture.set_folders(&[""]);
    fixture.open("b.pyr", &driver("yard").replace(" r ", " s ").replace("{ r }", "{ s }"));
    assert_eq!(fixture.problems("yard.scene.toml"), ["the environment has no robot `r`"]);
    fixture.open("a.pyr", &driver("yard"));
    assert_eq!(fixture.problems("yard.scene.toml"), ["the environment has no robot `s`"]);
    assert!(fixture.workspace.close(&key("a.pyr")));
    assert_eq!(fixture.problems("yard.scene.toml"), ["the environment has no robot `r`"]);
    fixture.workspace.load_scene("/w/lone.scene.toml");
    assert_eq!(fixture.problems("lone.scene.toml"), ["there is no key `robots.x.strat`"]);
}

#[test]
fn a_scene_that_cannot_be_read_is_known_as_such() {
    let mut fixture = Fixture::new(&[]);
    fixture.files.write_unreadable(key("yard.scene.toml"), ReadError::Folder);
    fixture.open("main.pyr", &driver("yard"));
    assert_eq!(fixture.workspace.read_error("/w/yard.scene.toml"), Some(&ReadError::Folder));
    fixture.write("yard.scene.toml", BOX_AHEAD);
    assert_eq!(fixture.workspace.read_error("/w/yard.scene.toml"), None);
    assert_eq!(fixture.codes("main.pyr"), ["planned-collision"]);
}

#[test]
fn a_byte_order_mark_is_not_part_of_the_text() {
    let mut fixture = Fixture::new(&[("a.pyr", "\u{feff}wheel")]);
    fixture.set_folders(&[""]);
    fixture.workspace.file_changed("/w/a.pyr");
    assert_eq!(fixture.workspace.document("/w/a.pyr").unwrap().text, "wheel");
}

/// There is one rope for each text, shared by all holders.
#[test]
fn the_database_shares_the_text() {
    let mut fixture = Fixture::new(&[]);
    fixture.open("main.pyr", WHEEL);
    let is_shared = |fixture: &Fixture| {
        let document = fixture.workspace.document("/w/main.pyr").unwrap();
        document.text.is_instance(fixture.workspace.database().text(document.file.unwrap()).unwrap())
    };
    assert!(is_shared(&fixture));
    let mut after = fixture.workspace.document("/w/main.pyr").unwrap().text.clone();
    after.insert(6, "x");
    let span = Some(pydslrep_text::Span::at(6));
    let costs = fixture.workspace.change("/w/main.pyr", vec![TextChange { span, after }]);
    assert_eq!(costs.len(), 1);
    assert!(is_shared(&fixture));
    assert_eq!(fixture.workspace.document("/w/main.pyr").unwrap().text, "wheel xa with radius 4");
    fixture.workspace.rebuild();
    assert!(is_shared(&fixture));
}

#[test]
fn changes_name_what_may_have_new_problems() {
    let mut fixture = Fixture::new(&[("parts/wheels.pyr", WHEEL), ("yard.scene.toml", BOX_AHEAD)]);
    fixture.open("main.pyr", USER);
    assert_eq!(fixture.changed(), ["main.pyr", "parts/wheels.pyr"]);
    assert!(fixture.workspace.take_changes().is_empty());
    fixture.write("parts/wheels.pyr", WHEELS);
    assert_eq!(fixture.changed(), ["main.pyr", "parts/wheels.pyr"]);
    fixture.open("drive.pyr", &driver("yard"));
    assert_eq!(fixture.changed(), ["drive.pyr", "yard.scene.toml"]);
    fixture.change("drive.pyr", &driver("yard").replace("move 2", "move 3"));
    assert_eq!(fixture.changed(), ["drive.pyr", "yard.scene.toml"]);
    fixture.workspace.close("/w/drive.pyr");
    assert_eq!(fixture.changed(), ["drive.pyr", "yard.scene.toml"]);
    fixture.write("pydslrep.toml", "");
    assert!(fixture.workspace.take_changes().all);
}

#[test]
fn keys_are_ordered_by_kind_and_path() {
    let keys = ["/w/pydslrep.toml", "/w/b.scene.toml", "/w/z.pyr", "/w/a/a.pyr", "/w/a.scene.toml"];
    assert_eq!(
        Workspace::in_order(keys),
        ["/w/a/a.pyr", "/w/z.pyr", "/w/a.scene.toml", "/w/b.scene.toml", "/w/pydslrep.toml"]
    );
}

#[test]
fn a_workspace_is_rebuilt_as_it_was() {
    let mut fixture = Fixture::new(&[("parts/wheels.pyr", WHEEL), ("yard.scene.toml", BOX_AHEAD)]);
    fixture.open("main.pyr", &format!("{USER}\nimport \"../outside.pyr\""));
    fixture.open("drive.pyr", &driver("yard"));
    let before = [fixture.messages("main.pyr"), fixture.messages("drive.pyr")];
    let known: Vec<String> = fixture.known().into_iter().map(str::to_owned).collect();
    fixture.workspace.rebuild();
    assert_eq!([fixture.messages("main.pyr"), fixture.messages("drive.pyr")], before);
    assert_eq!(fixture.known(), known);
    assert!(fixture.workspace.take_changes().all);
}
