//! The Python that runs scripts: the user's own if it has what they require, else a private virtual environment with
//! that, created on first use.

mod environment;
mod index;
mod interpreter;
mod manifest;
mod subprocess;

use std::env;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use pydslrep_output::provide_runtime;
use pydslrep_script::{REQUIREMENTS, REQUIREMENTS_MUJOCO, REQUIREMENTS_SLAM};

use self::environment::Environment;
use crate::failure::Failure;
use crate::run::reporter::Reporter;

/// The packages installed for a script.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Packages {
    /// Requirements files for pip.
    requirements: &'static [&'static str],
    /// The modules that scripts import from them.
    modules: &'static [&'static str],
    /// What people call them.
    names: &'static str,
    /// The run that installs them.
    first_run: &'static str,
}

impl Packages {
    /// The client library of `CoppeliaSim`.
    pub(crate) const CLIENT: Self = Self {
        requirements: &[REQUIREMENTS],
        modules: &["coppeliasim_zmqremoteapi_client"],
        names: "the CoppeliaSim client library",
        first_run: "the first run",
    };

    /// The same and the packages for slam by odometry.
    pub(crate) const CLIENT_AND_ODOMETRY: Self = Self {
        requirements: &[REQUIREMENTS, REQUIREMENTS_SLAM],
        modules: &["coppeliasim_zmqremoteapi_client", "numpy", "scipy"],
        names: "the CoppeliaSim client library, NumPy and SciPy",
        first_run: "the first run with --odometry",
    };

    /// `MuJoCo`, instead of the client.
    pub(crate) const MUJOCO: Self = Self {
        requirements: &[REQUIREMENTS_MUJOCO],
        modules: &["mujoco", "numpy"],
        names: "MuJoCo",
        first_run: "the first run with --engine mujoco",
    };

    /// The same and the packages for slam by odometry.
    pub(crate) const MUJOCO_AND_ODOMETRY: Self = Self {
        requirements: &[REQUIREMENTS_MUJOCO, REQUIREMENTS_SLAM],
        modules: &["mujoco", "numpy", "scipy"],
        names: "MuJoCo, NumPy and SciPy",
        first_run: "the first run with --engine mujoco and --odometry",
    };
}

/// The recipient of the preparations' progress.
#[derive(Clone, Copy)]
pub(crate) struct Watcher<'a> {
    pub(crate) reporter: &'a Reporter,
    /// True if progress is hidden from people.
    pub(crate) quiet: bool,
}

/// An interpreter with these packages: the user's own if it has them, else that of a private environment. The first call
/// creates it, and a later one replaces it if it is damaged; of concurrent calls, one does.
///
/// # Errors
/// If there is no suitable Python or the environment cannot be created.
pub(crate) async fn prepare(
    chosen: Option<&Path>,
    packages: Packages,
    watcher: Watcher<'_>,
) -> Result<PathBuf, Failure> {
    let base = interpreter::find(chosen, packages.modules).await?;
    if base.modules.len() == packages.modules.len() {
        return Ok(base.path);
    }
    Environment::new(base, packages, cache()?).prepare(watcher).await
}

/// The interpreter itself, for scripts without requirements.
///
/// # Errors
/// If there is no suitable one.
pub(crate) async fn interpreter(chosen: Option<&Path>) -> Result<PathBuf, Failure> {
    Ok(interpreter::find(chosen, &[]).await?.path)
}

/// The Python that runs scripts, for people.
pub(crate) struct Description {
    /// Version and path of the interpreter.
    pub(crate) interpreter: String,
    /// Where the client is that talks to `CoppeliaSim`.
    pub(crate) client: String,
    /// Where the packages are that slam by odometry computes with.
    pub(crate) odometry: String,
}

/// Returns the Python and the packages that scripts run with; changes nothing.
///
/// # Errors
/// If there is no suitable Python.
pub(crate) async fn describe(chosen: Option<&Path>) -> Result<Description, Failure> {
    let all = Packages::CLIENT_AND_ODOMETRY;
    let base = interpreter::find(chosen, all.modules).await?;
    let place = |packages: Packages| -> Result<String, Failure> {
        let has = |module: &&str| base.modules.iter().any(|found| found == module);
        if packages.modules.iter().all(has) {
            return Ok("in this Python".to_owned());
        }
        Ok(Environment::new(base.clone(), packages, cache()?).describe())
    };
    Ok(Description {
        interpreter: format!("{} ({})", base.version, base.path.display()),
        client: place(Packages::CLIENT)?,
        odometry: place(all)?,
    })
}

/// The cache folder, created if it is missing.
///
/// # Errors
/// If there is none or it cannot be created.
pub(crate) fn cache() -> Result<PathBuf, Failure> {
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

/// The folder to import the package of scripts from: in the cache or, without one, in `folder`, for one run only.
///
/// # Errors
/// If the package cannot be written.
pub(crate) fn runtime(folder: &Path) -> Result<PathBuf, Failure> {
    let cached = cache().and_then(|cache| Ok(provide_runtime(&cache)?));
    Ok(cached.or_else(|_| provide_runtime(folder))?)
}

fn uncached(path: &Path, error: &io::Error) -> Failure {
    Failure::unwritten(path, error).help(
        "the Python environment that runs scripts goes there; set XDG_CACHE_HOME to choose another folder",
    )
}
