//! Pictures of paths as files.

use std::fs;
use std::path::{Path, PathBuf};

use pydslrep_picture::{Picture, png};

use crate::failure::Failure;
use crate::output;

/// The files of pictures that were asked for.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct Pictures {
    /// Draw the paths into a file, as SVG or, where its name ends in .png, as PNG
    #[arg(long, value_name = "FILE", value_parser = still)]
    picture: Option<PathBuf>,
    /// Draw robots that drive along their paths, as an SVG that moves
    #[arg(long, value_name = "FILE", value_parser = moving)]
    replay: Option<PathBuf>,
}

impl Pictures {
    /// Whether there is something to draw.
    pub(crate) fn are_wanted(&self) -> bool {
        self.picture.is_some() || self.replay.is_some()
    }

    /// Draws what was asked for.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub(crate) fn draw(&self, picture: &Picture<'_>) -> Result<(), Failure> {
        if let Some(path) = &self.picture {
            let svg = picture.svg();
            let bytes = if has_ending(path, "png") {
                png(&svg).map_err(|error| Failure::new(error.to_string()))?
            } else {
                svg.into_bytes()
            };
            write(path, &bytes)?;
        }
        self.replay.as_ref().map_or(Ok(()), |path| write(path, picture.replay().as_bytes()))
    }

    /// Says which files there are now.
    pub(crate) fn tell(&self) {
        for (what, path) in [("picture", &self.picture), ("replay", &self.replay)] {
            if let Some(path) = path {
                output::say(&format!("{what}: {}\n", path.display()));
            }
        }
    }
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    fs::write(path, bytes).map_err(|error| Failure::unwritten(path, &error))
}

fn has_ending(path: &Path, ending: &str) -> bool {
    path.extension().is_some_and(|found| found.eq_ignore_ascii_case(ending))
}

/// A file for a picture; said at once, not after a long run.
fn still(name: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(name);
    match path.extension() {
        Some(_) if !has_ending(&path, "svg") && !has_ending(&path, "png") => {
            Err("pictures are SVG or PNG: give a name that ends in .svg or .png".to_owned())
        }
        _ => Ok(path),
    }
}

/// A file for a replay.
fn moving(name: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(name);
    match path.extension() {
        Some(_) if !has_ending(&path, "svg") => {
            Err("only an SVG can move: give a name that ends in .svg".to_owned())
        }
        _ => Ok(path),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_what_is_drawn() {
        for name in ["a.svg", "a.PNG", "a", ".picture"] {
            assert!(still(name).is_ok(), "{name}");
        }
        assert!(still("a.pdf").unwrap_err().contains(".png"));
        assert!(moving("a.png").unwrap_err().contains(".svg"));
        assert!(moving("a.svg").is_ok());
    }
}
