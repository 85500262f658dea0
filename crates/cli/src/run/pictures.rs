//! Writes pictures of paths.

use std::path::{Path, PathBuf};

use pydslrep_output::{Kind, write_output};
use pydslrep_picture::{Picture, png};
use pydslrep_trace::FileKind;

use crate::failure::Failure;
use crate::run::reporter::Reporter;

/// Where to write pictures, if at all.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct Pictures {
    /// Draw the paths into a file, as SVG or, where its name ends in .png, as PNG
    #[arg(long, value_name = "FILE", value_parser = picture_path)]
    picture: Option<PathBuf>,
    /// Draw robots driving along their paths, as an animated SVG
    #[arg(long, value_name = "FILE", value_parser = replay_path)]
    replay: Option<PathBuf>,
}

impl Pictures {
    /// The files to write.
    pub(crate) fn outputs(&self) -> impl Iterator<Item = (&Path, Kind)> {
        [&self.picture, &self.replay].into_iter().flatten().map(|path| (path.as_path(), Kind::Picture))
    }

    /// Draws the pictures that are wanted.
    ///
    /// # Errors
    /// If a file cannot be written.
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

    /// Reports where the pictures are.
    pub(crate) fn report(&self, reporter: &Reporter) {
        for (kind, path) in [(FileKind::Picture, &self.picture), (FileKind::Replay, &self.replay)] {
            if let Some(path) = path {
                reporter.report_file(kind, path);
            }
        }
    }
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    Ok(write_output(path, Kind::Picture, bytes)?)
}

fn has_ending(path: &Path, ending: &str) -> bool {
    path.extension().is_some_and(|found| found.eq_ignore_ascii_case(ending))
}

/// Checks the name of a picture at once, not after a long run.
fn picture_path(name: &str) -> Result<PathBuf, String> {
    path_with(name, &["svg", "png"], "pictures are SVG or PNG: use a name that ends in .svg or .png")
}

/// Checks the name of a replay.
fn replay_path(name: &str) -> Result<PathBuf, String> {
    path_with(name, &["svg"], "replays are animated SVG: use a name that ends in .svg")
}

fn path_with(name: &str, endings: &[&str], complaint: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(name);
    let fits = path.extension().is_none() || endings.iter().any(|ending| has_ending(&path, ending));
    if fits { Ok(path) } else { Err(complaint.to_owned()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_decides_the_format() {
        for name in ["a.svg", "a.PNG", "a", ".picture"] {
            assert!(picture_path(name).is_ok(), "{name}");
        }
        assert!(picture_path("a.pdf").unwrap_err().contains(".png"));
        assert!(replay_path("a.png").unwrap_err().contains(".svg"));
        assert!(replay_path("a.svg").is_ok());
    }
}
