//! The environment of a program to drive, and the scene it is driven in.

use std::fmt;

use pydslrep_analysis::environment::Environment;
use pydslrep_analysis::{EntityId, FileId};
use pydslrep_config::Problem;
use pydslrep_scene::Scene;
use pydslrep_syntax::EntityKind;

use crate::{ReadError, Workspace};

/// Why no environment is chosen.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NoEnvironment {
    /// The program has none.
    None,
    /// It has so many, and none was named.
    Several(usize),
    /// It has none of this name.
    Unknown(String),
}

impl fmt::Display for NoEnvironment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => f.write_str("there is no environment"),
            Self::Several(count) => write!(f, "there are {count} environments"),
            Self::Unknown(name) => write!(f, "there is no environment `{name}`"),
        }
    }
}

impl std::error::Error for NoEnvironment {}

/// Why an environment has no scene. It gets no other one, in which robots could meet other obstacles than intended.
#[derive(Debug, Clone, PartialEq)]
pub enum SceneError {
    /// There is a file, which cannot be read.
    Unreadable {
        /// Its key.
        key: String,
        /// The reason.
        error: ReadError,
    },
    /// The file has mistakes.
    Invalid {
        /// Its key.
        key: String,
        /// All of them.
        problems: Vec<Problem>,
    },
}

impl Workspace {
    /// The environment of a program with this name, or its only one. Of several with the same name, the first one counts,
    /// as everywhere.
    ///
    /// # Errors
    /// If there is none, or several and none is named.
    pub fn choose_environment(&self, program: FileId, name: Option<&str>) -> Result<EntityId, NoEnvironment> {
        let all = self.database.environments(program).into_iter();
        let named: Vec<EntityId> =
            all.filter(|(_, other)| name.is_none_or(|name| other.text == name)).map(|(id, _)| id).collect();
        match (named.as_slice(), name) {
            ([one], _) | ([one, ..], Some(_)) => Ok(*one),
            ([], None) => Err(NoEnvironment::None),
            (several, None) => Err(NoEnvironment::Several(several.len())),
            ([], Some(name)) => Err(NoEnvironment::Unknown(name.to_owned())),
        }
    }

    /// The scene that an environment of a program is driven in: an empty floor if there is no scene file.
    ///
    /// # Errors
    /// If the file cannot be read, and with everything that is wrong in it.
    pub fn scene(&self, program: FileId, environment: &Environment) -> Result<Scene, SceneError> {
        let name = environment.name.as_str().into();
        let id = self.database.definitions(program, EntityKind::Environment, &name).first().copied();
        let Some((id, key)) = id.zip(self.scene_key(program, &environment.name)) else {
            return Ok(pydslrep_analysis::scene(environment));
        };
        if let Some(error) = self.read_error(&key) {
            return Err(SceneError::Unreadable { key, error: error.clone() });
        }
        self.database.scene(id, environment).map_err(|problems| SceneError::Invalid { key, problems })
    }
}
