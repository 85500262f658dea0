//! Asks the command about a folder of programs at once: a process for each would cost seconds.

use std::collections::BTreeMap;
use std::process::Command;

use serde_json::Value;
use tempfile::TempDir;

/// A folder of programs.
pub(crate) struct Folder {
    folder: TempDir,
}

/// A problem without its place, which a fix before it may move.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Problem {
    pub(crate) code: String,
    pub(crate) severity: String,
    pub(crate) message: String,
}

impl Folder {
    pub(crate) fn new() -> Self {
        Self { folder: TempDir::new().unwrap() }
    }

    pub(crate) fn write(&self, name: &str, program: &str) {
        std::fs::write(self.folder.path().join(name), program).unwrap();
    }

    /// Returns the output for people, for each file with problems.
    pub(crate) fn shown(&self) -> BTreeMap<String, String> {
        let out = self.run(&[]);
        let mut shown: BTreeMap<String, String> = BTreeMap::new();
        for block in out.split("\n\n").filter(|block| block.contains("\n --> ") || block.contains("\n  --> "))
        {
            let place = block.lines().find_map(|line| line.trim_start().strip_prefix("--> ")).unwrap();
            let (file, _) = place.split_once(':').unwrap();
            let message = format!("{}\n", block.replace(file, "x.pyr"));
            let all = shown.entry(file.to_owned()).or_default();
            if !all.is_empty() {
                all.push('\n');
            }
            *all += &message;
        }
        shown
    }

    /// All problems by file, in the order of the text.
    pub(crate) fn problems(&self, arguments: &[&str]) -> Vec<(String, Problem)> {
        let out = self.run(&[&["--format", "json"], arguments].concat());
        let problems: Vec<Value> = serde_json::from_str(&out).unwrap();
        let word = |problem: &Value, key: &str| problem[key].as_str().unwrap().to_owned();
        let problem = |problem: &Value| Problem {
            code: word(problem, "code"),
            severity: word(problem, "severity"),
            message: word(problem, "message"),
        };
        problems.iter().map(|value| (word(value, "file"), problem(value))).collect()
    }

    fn run(&self, arguments: &[&str]) -> String {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pydslrep"));
        command.args(["--color", "never", "check"]).args(arguments).current_dir(self.folder.path());
        String::from_utf8(command.output().unwrap().stdout).unwrap()
    }
}
