//! The private virtual environment in the cache.

use std::fs::{self, File, TryLockError};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use tempfile::TempDir;
use tokio::process::Command;
use tokio::time::sleep;

use super::index::{check_index, uninstalled};
use super::interpreter::Interpreter;
use super::subprocess::succeed;
use super::{Packages, Watcher, manifest, uncached};
use crate::failure::Failure;
use crate::report::output;

/// Neither may hang forever.
const CREATE_LIMIT: Duration = Duration::from_secs(120);
const INSTALL_LIMIT: Duration = Duration::from_secs(600);

/// The interval at which a run checks whether another one has finished its preparations.
const LOCK_PERIOD: Duration = Duration::from_millis(100);

/// The folders of environments that are not complete begin with this.
const UNFINISHED: &str = "venv-new-";

/// A virtual environment with the requirements of scripts.
pub(super) struct Environment {
    base: Interpreter,
    packages: Packages,
    cache: PathBuf,
    home: PathBuf,
}

enum State {
    Missing,
    Sound,
    Damaged(String),
}

impl Environment {
    /// The environment of an interpreter. A change of the interpreter or of the requirements makes another one.
    pub(super) fn new(base: Interpreter, packages: Packages, cache: PathBuf) -> Self {
        let mut hasher = DefaultHasher::new();
        (packages.requirements.concat(), &base.version, &base.path).hash(&mut hasher);
        let home = cache.join(format!("venv-{:016x}", hasher.finish()));
        Self { base, packages, cache, home }
    }

    /// Its interpreter; creates or replaces it where that is necessary.
    pub(super) async fn prepare(self, watcher: Watcher<'_>) -> Result<PathBuf, Failure> {
        let python = python_in(&self.home);
        if let State::Sound = self.state() {
            return Ok(python);
        }
        let steps =
            Steps { progress: if watcher.quiet { ProgressBar::hidden() } else { spinner() }, watcher };
        let lock = self.lock(&steps).await;
        match self.state() {
            // Another run was faster.
            State::Sound => return Ok(python),
            State::Missing => {}
            State::Damaged(reason) => watcher.reporter.warn(
                &format!("the Python environment in {} is damaged: {reason}", self.home.display()),
                Some("it is made again"),
            ),
        }
        if lock.is_some() {
            self.remove_leftovers();
        }
        check_index(&self.base, self.packages).await?;
        let created = self.create(&steps).await?;
        self.install(created)?;
        Ok(python)
    }

    /// Where its packages are, or when they will be there.
    pub(super) fn describe(&self) -> String {
        match self.state() {
            State::Missing => format!("not there yet: {} installs it", self.packages.first_run),
            State::Sound => format!("in {}", self.home.display()),
            State::Damaged(reason) => {
                format!(
                    "in {}, which is damaged ({reason}) and made again by the next run",
                    self.home.display()
                )
            }
        }
    }

    fn state(&self) -> State {
        if !self.home.exists() {
            return State::Missing;
        }
        if !python_in(&self.home).exists() {
            return State::Damaged("its Python is gone".to_owned());
        }
        manifest::damage(&self.home).map_or(State::Sound, State::Damaged)
    }

    /// Lets one run at a time change the cache. The lock goes with the process, whatever ends it; `None` where the file
    /// system has no locks.
    async fn lock(&self, steps: &Steps<'_>) -> Option<File> {
        let file =
            File::options().create(true).truncate(false).write(true).open(self.cache.join("lock")).ok()?;
        loop {
            match file.try_lock() {
                Ok(()) => return Some(file),
                Err(TryLockError::Error(_)) => return None,
                Err(TryLockError::WouldBlock) => {
                    self.show(steps, "another run is doing it");
                    sleep(LOCK_PERIOD).await;
                }
            }
        }
    }

    /// Removes the leftovers of interrupted runs. Only the holder of the lock creates environments.
    fn remove_leftovers(&self) {
        for entry in fs::read_dir(&self.cache).into_iter().flatten().flatten() {
            if entry.file_name().to_string_lossy().starts_with(UNFINISHED) {
                // The next run tries again.
                let _ = fs::remove_dir_all(entry.path());
            }
        }
    }

    /// Creates a complete environment in a temporary folder.
    async fn create(&self, steps: &Steps<'_>) -> Result<TempDir, Failure> {
        self.show(steps, "creating a virtual environment");
        let folder = tempfile::Builder::new().prefix(UNFINISHED).tempdir_in(&self.cache);
        let folder = folder.map_err(|error| uncached(&self.cache, &error))?;
        let mut venv = Command::new(&self.base.path);
        venv.args(["-I", "-m", "venv", "--without-pip"]).arg(folder.path());
        succeed(&mut venv, CREATE_LIMIT).await.map_err(|reason| self.uncreated(&reason))?;
        self.show(steps, &format!("installing {}", self.packages.names));
        let requirements = folder.path().join("requirements.txt");
        fs::write(&requirements, self.packages.requirements.concat())
            .map_err(|error| uncached(&requirements, &error))?;
        let mut pip = self.pip(folder.path()).await?;
        pip.args(["install", "--quiet", "--no-input", "--disable-pip-version-check"]);
        // Nothing but the packages that we know, and none of their code runs during the installation.
        pip.args(["--require-hashes", "--only-binary", ":all:", "--no-deps"]);
        // The index answered a moment ago.
        pip.args(["--retries", "1"]).arg("--requirement").arg(&requirements);
        succeed(&mut pip, INSTALL_LIMIT).await.map_err(|reason| uninstalled(self.packages, &reason))?;
        manifest::write(folder.path()).map_err(|error| uncached(folder.path(), &error))?;
        Ok(folder)
    }

    /// A pip that installs into an environment: that of the interpreter, where it has one. One in the environment takes longer
    /// to install than the packages, and is used once.
    async fn pip(&self, home: &Path) -> Result<Command, Failure> {
        let of_base = || {
            let mut pip = Command::new(&self.base.path);
            pip.args(["-I", "-m", "pip", "--python"]).arg(python_in(home));
            pip
        };
        // Before version 22.3, it knows no other environments than its own.
        if succeed(of_base().arg("--version"), CREATE_LIMIT).await.is_ok() {
            return Ok(of_base());
        }
        let module = |name| {
            let mut python = Command::new(python_in(home));
            python.args(["-I", "-m", name]);
            python
        };
        succeed(&mut module("ensurepip"), CREATE_LIMIT).await.map_err(|reason| self.uncreated(&reason))?;
        Ok(module("pip"))
    }

    fn uncreated(&self, reason: &str) -> Failure {
        Failure::new(format!("cannot create a virtual environment: {reason}")).help(format!(
            "{} needs its modules venv and ensurepip, e.g. `sudo apt install python3-venv`; or choose another Python \
             with --python PATH",
            self.base.path.display()
        ))
    }

    fn show(&self, steps: &Steps<'_>, step: &str) {
        steps.show(&format!("preparing Python for {}: {step}", self.packages.first_run));
    }

    /// Moves an environment to its final folder.
    fn install(&self, created: TempDir) -> Result<(), Failure> {
        if self.home.exists() {
            fs::remove_dir_all(&self.home).map_err(|error| uncached(&self.home, &error))?;
        }
        fs::rename(created.path(), &self.home).map_err(|error| uncached(&self.home, &error))?;
        // Nothing is left to remove at its old path.
        let _ = created.keep();
        Ok(())
    }
}

fn python_in(home: &Path) -> PathBuf {
    if cfg!(windows) { home.join("Scripts").join("python.exe") } else { home.join("bin").join("python") }
}

/// Shows the current step: as a spinner on a terminal, else as a line, which an editor shows as progress.
struct Steps<'a> {
    progress: ProgressBar,
    watcher: Watcher<'a>,
}

impl Steps<'_> {
    fn show(&self, step: &str) {
        if self.progress.message() == step {
            return;
        }
        self.progress.set_message(step.to_owned());
        self.watcher.reporter.progress(step);
        if !self.watcher.quiet && !io::stderr().is_terminal() {
            output::say(&format!("{step}\n"));
        }
    }
}

impl Drop for Steps<'_> {
    fn drop(&mut self) {
        self.progress.finish_and_clear();
    }
}

fn spinner() -> ProgressBar {
    let style = ProgressStyle::with_template("{spinner} {msg} ({elapsed})");
    let bar =
        ProgressBar::new_spinner().with_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
    bar.enable_steady_tick(Duration::from_millis(100));
    bar
}
