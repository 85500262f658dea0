//! Settings that hold for each program: those of the nearest `pydslrep.toml`, and options of the command over them.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use pydslrep_analysis::FileId;
use pydslrep_config::{Config, FILE_NAME, Settings};
use pydslrep_files::{project_folder, without_mark};

use crate::failure::Failure;
use crate::paths::{near, shown};
use crate::render;
use crate::sources::Sources;
use crate::texts::read_file;

/// The projects of the programs that were named.
#[derive(Debug)]
pub(crate) struct Projects {
    of_file: HashMap<FileId, usize>,
    /// The first one is that of programs without a file.
    projects: Vec<Project>,
}

/// What holds for some programs.
#[derive(Debug, Default)]
pub(crate) struct Project {
    /// The file that says so, if there is one.
    pub(crate) file: Option<PathBuf>,
    /// The file's, and over them the options of the command.
    pub(crate) settings: Settings,
}

impl Projects {
    /// Reads the files that say something about programs, and tells the database what it has to know of it.
    ///
    /// # Errors
    /// With everything that is wrong in these files: a misspelt setting could change what the command does, so it does
    /// nothing.
    pub(crate) fn open(sources: &mut Sources, files: &[FileId], options: &Config) -> Result<Self, Failure> {
        let mut opened =
            Self { of_file: HashMap::new(), projects: vec![Project::new(None, options, Config::default())] };
        let mut problems = String::new();
        for file in files {
            let program = Path::new(sources.database.path(*file));
            let Some(path) = project_folder(program).map(|folder| folder.join(FILE_NAME)) else { continue };
            let known = opened.projects.iter().position(|project| project.file.as_ref() == Some(&path));
            let index = if let Some(index) = known {
                index
            } else {
                let (config, told) = read(&path)?;
                problems += &told;
                opened.projects.push(Project::new(Some(path), options, config));
                opened.projects.len() - 1
            };
            opened.of_file.insert(*file, index);
        }
        if !problems.is_empty() {
            return Err(Failure::Rendered(problems));
        }
        for file in files {
            sources.database.set_target(*file, opened.of(*file).settings.target);
        }
        Ok(opened)
    }

    /// What holds for a program.
    pub(crate) fn of(&self, file: FileId) -> &Project {
        &self.projects[self.of_file.get(&file).copied().unwrap_or(0)]
    }
}

impl Project {
    fn new(file: Option<PathBuf>, options: &Config, config: Config) -> Self {
        Self { file, settings: options.clone().merged_over(config).settings() }
    }

    /// The folder that scripts are written to; `None` for beside each program.
    pub(crate) fn output(&self) -> Option<PathBuf> {
        let folder = self.file.as_ref()?.parent()?;
        Some(near(&folder.join(self.settings.output.as_ref()?)))
    }
}

fn read(path: &Path) -> Result<(Config, String), Failure> {
    let path = near(path);
    let whole = read_file(&path)?;
    let text = without_mark(&whole);
    let (config, problems) = Config::from_toml(text);
    let told = problems.iter().map(|problem| render::problem(&shown(&path), text, problem)).collect();
    Ok((config, told))
}
