//! The Python that runs scripts: a private virtual environment with their requirements, created on first use; for scripts
//! without requirements, the user's own.

use std::env;
use std::ffi::OsStr;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};
use std::process::{Output, Stdio};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use pydslrep_script::{OLDEST_PYTHON, REQUIREMENTS};
use tempfile::TempDir;
use tokio::process::Command;
use tokio::time::timeout;

use crate::failure::Failure;
use crate::report::output;

/// Asking an interpreter, creating an environment, installing: none may hang forever.
const ASK_LIMIT: Duration = Duration::from_secs(30);
const CREATE_LIMIT: Duration = Duration::from_secs(120);
const INSTALL_LIMIT: Duration = Duration::from_secs(600);

/// Long enough for a package index to answer, short enough to wait for.
const INDEX_LIMIT: Duration = Duration::from_millis(2500);

/// Asks whether the package index can be reached; if not, exits with [`ABSENT`] and prints why.
const ASK_INDEX: &str = include_str!("../../python/ask_index.py");
const ABSENT: i32 = 3;

/// Prints version and path, one per line; works on Python 2, too, so that an old one is not reported as broken.
const QUESTION: &str = "import sys; print('%d.%d.%d' % sys.version_info[:3]); print(sys.executable)";

/// The command that installs Python on this system.
const INSTALL_PYTHON: &str = if cfg!(target_os = "macos") {
    "brew install python"
} else if cfg!(windows) {
    "winget install Python.Python.3.13"
} else {
    "sudo apt install python3 python3-venv"
};

/// What to do if there is no suitable Python.
fn install_python() -> String {
    let (major, minor) = OLDEST_PYTHON;
    format!(
        "install Python {major}.{minor} or later, e.g. `{INSTALL_PYTHON}`, or choose one with --python PATH"
    )
}

/// A Python interpreter on this machine.
struct Interpreter {
    path: PathBuf,
    version: String,
}

/// The interpreter of an environment with the requirements of scripts. The first call creates it; concurrent calls do not
/// disturb each other. `quiet` hides progress.
///
/// # Errors
/// If there is no suitable Python or the environment cannot be created.
pub(crate) async fn prepare(chosen: Option<&Path>, quiet: bool) -> Result<PathBuf, Failure> {
    let base = find(chosen).await?;
    let cache = cache()?;
    let home = cache.join(name(&base));
    if works(&home) {
        return Ok(python_in(&home));
    }
    let progress = if quiet { ProgressBar::hidden() } else { spinner() };
    check_index(&base).await?;
    let created = create(&base, &cache, &Steps { progress: &progress, quiet }).await;
    progress.finish_and_clear();
    install(created?, &home)?;
    Ok(python_in(&home))
}

/// Shows the current step: as a spinner on a terminal, else as a line, which an editor shows as progress.
struct Steps<'a> {
    progress: &'a ProgressBar,
    quiet: bool,
}

impl Steps<'_> {
    fn show(&self, step: &'static str) {
        self.progress.set_message(step);
        if !self.quiet && !io::stderr().is_terminal() {
            output::say(&format!("{step}\n"));
        }
    }
}

fn spinner() -> ProgressBar {
    let style = ProgressStyle::with_template("{spinner} {msg} ({elapsed})");
    let bar =
        ProgressBar::new_spinner().with_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
    bar.enable_steady_tick(Duration::from_millis(100));
    bar
}

/// The interpreter itself, for scripts without requirements.
///
/// # Errors
/// If there is no suitable one.
pub(crate) async fn interpreter(chosen: Option<&Path>) -> Result<PathBuf, Failure> {
    Ok(find(chosen).await?.path)
}

async fn find(chosen: Option<&Path>) -> Result<Interpreter, Failure> {
    let Some(chosen) = chosen else {
        let mut found = Err(Failure::new("no Python on the PATH").help(install_python()));
        for name in ["python3", "python"] {
            found = match ask(Path::new(name)).await {
                Ok(interpreter) => return Ok(interpreter),
                // A Python that cannot be used says more than a missing one.
                Err(Some(failure)) => Err(failure),
                Err(None) => found,
            };
        }
        return found;
    };
    ask(chosen).await.map_err(|failure| {
        let missing = || Failure::new(format!("no Python at {}", chosen.display())).help(install_python());
        failure.unwrap_or_else(missing)
    })
}

/// Asks an interpreter for its version and path; `Err(None)` if there is none.
async fn ask(path: &Path) -> Result<Interpreter, Option<Failure>> {
    let mut command = Command::new(path);
    command.args(["-c", QUESTION]);
    let output = match output(&mut command, ASK_LIMIT).await {
        Ok(output) => output,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Err(None),
        Err(error) => return Err(Some(unusable(path, &error.to_string()))),
    };
    let text = String::from_utf8_lossy(&output.stdout);
    let mut lines = text.lines();
    let (Some(version), Some(place), true) = (lines.next(), lines.next(), output.status.success()) else {
        return Err(Some(unusable(path, "it is not a Python interpreter")));
    };
    let mut numbers = version.split('.').map_while(|number| number.parse::<u32>().ok());
    let release = (numbers.next().unwrap_or(0), numbers.next().unwrap_or(0));
    if release < OLDEST_PYTHON {
        let (major, minor) = OLDEST_PYTHON;
        let reason = format!("it is version {version}, scripts need {major}.{minor} or later");
        return Err(Some(unusable(path, &reason)));
    }
    Ok(Interpreter { path: place.into(), version: version.to_owned() })
}

fn unusable(path: &Path, reason: &str) -> Failure {
    Failure::new(format!("cannot use the Python `{}`: {reason}", path.display())).help(install_python())
}

/// The cache folder.
fn cache() -> Result<PathBuf, Failure> {
    let folder = |name: &str| env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let cache = folder("XDG_CACHE_HOME")
        .or_else(|| folder("LOCALAPPDATA").filter(|_| cfg!(windows)))
        .or_else(|| Some(folder("HOME")?.join(".cache")));
    let cache = cache.ok_or_else(|| {
        Failure::new("no cache folder for the Python environment that runs scripts")
            .help("set HOME or XDG_CACHE_HOME")
    })?;
    let cache = cache.join("pydslrep");
    fs::create_dir_all(&cache).map_err(|error| uncached(&cache, &error))?;
    Ok(cache)
}

fn uncached(path: &Path, error: &io::Error) -> Failure {
    Failure::unwritten(path, error).help(
        "the Python environment that runs scripts goes there; set XDG_CACHE_HOME to choose another folder",
    )
}

/// Depends on the Python and the requirements, so that a change of either creates another environment.
fn name(base: &Interpreter) -> String {
    let mut hasher = DefaultHasher::new();
    (REQUIREMENTS, &base.version, &base.path).hash(&mut hasher);
    format!("venv-{:016x}", hasher.finish())
}

fn python_in(home: &Path) -> PathBuf {
    if cfg!(windows) { home.join("Scripts").join("python.exe") } else { home.join("bin").join("python") }
}

/// Whether it exists and the Python it was created from does, too.
fn works(home: &Path) -> bool {
    python_in(home).exists()
}

/// Checks that the package index can be reached before anything is created: pip itself retries for minutes.
async fn check_index(base: &Interpreter) -> Result<(), Failure> {
    let mut command = Command::new(&base.path);
    command.args(["-I", "-c", ASK_INDEX]);
    match output(&mut command, INDEX_LIMIT).await {
        Ok(output) if output.status.code() == Some(ABSENT) => {
            Err(uninstalled(String::from_utf8_lossy(&output.stdout).trim()))
        }
        Err(error) if error.kind() == io::ErrorKind::TimedOut => {
            Err(uninstalled("the package index does not answer"))
        }
        // pip reports anything else.
        _ => Ok(()),
    }
}

fn uninstalled(reason: &str) -> Failure {
    Failure::new(format!("cannot install the CoppeliaSim client library: {reason}")).help(
        "the first run needs network access to PyPI; behind a proxy or with a mirror, set HTTPS_PROXY or PIP_INDEX_URL",
    )
}

/// Creates a complete environment in a temporary folder.
async fn create(base: &Interpreter, cache: &Path, steps: &Steps<'_>) -> Result<TempDir, Failure> {
    steps.show("preparing Python for the first run: creating a virtual environment");
    let folder = tempfile::Builder::new().prefix("venv-new-").tempdir_in(cache);
    let folder = folder.map_err(|error| uncached(cache, &error))?;
    let mut venv = Command::new(&base.path);
    venv.args(["-I", "-m", "venv"]).arg(folder.path());
    succeed(&mut venv, CREATE_LIMIT).await.map_err(|reason| {
        Failure::new(format!("cannot create a virtual environment: {reason}")).help(format!(
            "{} needs its modules venv and ensurepip, e.g. `sudo apt install python3-venv`; or choose another Python with \
             --python PATH",
            base.path.display()
        ))
    })?;
    steps.show("preparing Python for the first run: installing the CoppeliaSim client library");
    let requirements = folder.path().join("requirements.txt");
    fs::write(&requirements, REQUIREMENTS).map_err(|error| uncached(&requirements, &error))?;
    let mut pip = Command::new(python_in(folder.path()));
    pip.args(["-I", "-m", "pip", "install", "--quiet", "--no-input", "--disable-pip-version-check"]);
    // The index answered a moment ago.
    pip.args(["--retries", "1"]).arg("--requirement").arg(&requirements);
    succeed(&mut pip, INSTALL_LIMIT).await.map_err(|reason| uninstalled(&reason))?;
    Ok(folder)
}

/// Moves the environment to its final folder; if another run was faster, uses that one's.
fn install(created: TempDir, home: &Path) -> Result<(), Failure> {
    if home.exists() && !works(home) {
        // Its Python is gone, so nothing uses it.
        let _ = fs::remove_dir_all(home);
    }
    match fs::rename(created.path(), home) {
        Ok(()) => {
            // Nothing is left to remove at its old path.
            let _ = created.keep();
            Ok(())
        }
        Err(_) if works(home) => Ok(()),
        Err(error) => Err(uncached(home, &error)),
    }
}

/// Runs a command; the error is its own message.
async fn succeed(command: &mut Command, limit: Duration) -> Result<(), String> {
    let output = output(command, limit).await.map_err(|error| error.to_string())?;
    if output.status.success() {
        return Ok(());
    }
    let text = [output.stderr, output.stdout].concat();
    let text = String::from_utf8_lossy(&text);
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    // pip marks the reason; other tools print it last.
    let reason = lines.clone().find(|line| line.starts_with("ERROR:")).or_else(|| lines.next_back());
    let reason = reason.unwrap_or("it exited without output");
    Err(reason.trim_start_matches("ERROR: ").to_owned())
}

/// Runs a command with a time limit; a command that exceeds it is killed.
async fn output(command: &mut Command, limit: Duration) -> io::Result<Output> {
    for name in ["PYTHONHOME", "PYTHONPATH", "__PYVENV_LAUNCHER__"].map(OsStr::new) {
        command.env_remove(name);
    }
    command.stdin(Stdio::null()).kill_on_drop(true);
    match timeout(limit, command.output()).await {
        Ok(output) => output,
        Err(_) => {
            Err(io::Error::new(io::ErrorKind::TimedOut, format!("it took longer than {} s", limit.as_secs())))
        }
    }
}
