//! `pydslrep check --watch`.

use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use pydslrep_config::Config;

use super::summary;
use crate::failure::Failure;
use crate::inputs::Inputs;
use crate::inputs::paths::absolute;
use crate::inputs::scenes;
use crate::inputs::watch::{Scope, Watch};
use crate::report::{output, render};
use crate::run::interrupt::{self, Interrupts};

/// Clears the terminal and its scrollback.
const CLEAR: &str = "\u{1b}[2J\u{1b}[3J\u{1b}[H";

/// Checks again whenever something changes, until it is interrupted.
///
/// # Errors
/// If nothing can be watched or printed. Problems of a file are reported and do not end it.
pub(super) fn run(paths: &[PathBuf], options: &Config) -> Result<ExitCode, Failure> {
    if paths.iter().any(|path| path == Path::new("-")) {
        return Err(Failure::new("standard input cannot be watched").help("name a file or a folder"));
    }
    interrupt::run("watch for changes", async |interrupts| watch(paths, options, interrupts).await)
}

async fn watch(paths: &[PathBuf], options: &Config, mut interrupts: Interrupts) -> Result<ExitCode, Failure> {
    let mut watch = Watch::new();
    watch.look_at(scope(paths, &Inputs::default())?)?;
    let mut shown = None;
    loop {
        let look = Look::take(paths, options)?;
        if shown != Some(look.fingerprint) {
            look.show()?;
            shown = Some(look.fingerprint);
        }
        if *watch.scope() != look.scope {
            // A file that is watched only from now on may have changed before.
            watch.look_at(look.scope)?;
            continue;
        }
        tokio::select! {
            () = watch.change() => {}
            () = interrupts.next() => return Ok(ExitCode::from(interrupt::EXIT_CODE)),
        }
        watch.look_at(look.scope)?;
    }
}

/// The result of one check.
struct Look {
    problems: String,
    summary: Option<String>,
    failures: Vec<Failure>,
    scope: Scope,
    /// A hash of the inputs and the result.
    fingerprint: u64,
}

impl Look {
    fn take(paths: &[PathBuf], options: &Config) -> Result<Self, Failure> {
        let (inputs, mut failures) = Inputs::open(paths, options);
        let (problems, summary) = match inputs.check_settings() {
            Ok(()) => {
                let mut found = inputs.all_diagnostics();
                inputs.retain_offered(&mut found);
                let (scene_problems, unread) = inputs.scene_problems();
                failures.extend(unread);
                let problems = render::diagnostics(&inputs, &found) + &scenes::render(&scene_problems);
                (problems, summary(&inputs, &found, &scene_problems))
            }
            Err(failure) => {
                failures.push(failure);
                (String::new(), None)
            }
        };
        let mut hasher = DefaultHasher::new();
        (inputs.texts(), &problems, format!("{failures:?}")).hash(&mut hasher);
        let scope = scope(paths, &inputs)?;
        Ok(Self { problems, summary, failures, scope, fingerprint: hasher.finish() })
    }

    fn show(&self) -> Result<(), Failure> {
        if io::stdout().is_terminal() {
            output::print_raw(CLEAR)?;
        }
        output::print(&self.problems)?;
        self.failures.iter().for_each(output::fail);
        let time = jiff::Zoned::now().strftime("%H:%M:%S");
        let summary = self.summary.as_deref().unwrap_or("Nothing was checked.");
        output::print(&format!("[{time}] {summary} Watching for changes; press Ctrl+C to stop.\n"))
    }
}

/// The files and folders that these programs depend on.
fn scope(paths: &[PathBuf], inputs: &Inputs) -> Result<Scope, Failure> {
    let mut scope = Scope::default();
    for path in paths {
        let whole = absolute(path)?;
        if whole.is_dir() {
            scope.folders.insert(whole);
        } else {
            scope.files.insert(whole);
        }
    }
    scope.files.extend(inputs.paths());
    Ok(scope)
}
