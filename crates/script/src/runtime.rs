//! The Python package that scripts import, as files to put beside them.

use std::borrow::Cow;

use rust_embed::RustEmbed;

/// The package's name, which is that of its folder.
pub const NAME: &str = "pydslrep_runtime";

/// The package's version: that of this program.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

#[derive(RustEmbed)]
#[folder = "../../python/pydslrep_runtime"]
#[include = "*.py"]
#[include = "py.typed"]
#[exclude = "*__pycache__*"]
struct Package;

/// One file of the package.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct File {
    /// Where it is in the package's folder, with `/` between folders.
    pub path: Cow<'static, str>,
    /// Its content.
    pub content: Cow<'static, [u8]>,
}

/// All files of the package, in the order of their paths.
pub fn files() -> Vec<File> {
    let found = Package::iter().filter_map(|path| Some(File { content: Package::get(&path)?.data, path }));
    let mut files: Vec<File> = found.collect();
    files.sort_by(|a, b| a.path.cmp(&b.path));
    files
}
