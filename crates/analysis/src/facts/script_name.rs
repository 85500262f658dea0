//! The names of the scripts of a program's environments.

use std::sync::{Arc, LazyLock, OnceLock};

use pydslrep_syntax::EntityKind;
use pydslrep_text::file_names::is_reserved_on_windows;
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;

use crate::entity::{EntityId, FileId};
use crate::facts::keys::Key;

/// Modules of Python 3.11 to 3.14.
static STANDARD_MODULES: LazyLock<FxHashSet<&str>> =
    LazyLock::new(|| include_str!("standard_modules.txt").lines().collect());

/// Modules that scripts and the clients of simulators import, or look for, beside the standard ones. Those of all targets
/// count: a script would hide them from others in its folder, too.
const CLIENT_MODULES: [&str; 20] = [
    "builtin_interfaces",
    "cbor",
    "cbor2",
    "cffi",
    "coppeliasim_zmqremoteapi_client",
    "geometry_msgs",
    "matplotlib",
    "nav_msgs",
    "numpy",
    "pydslrep_runtime",
    "rclpy",
    "rosgraph_msgs",
    "scipy",
    "sensor_msgs",
    "sim",
    "simConst",
    "std_msgs",
    "vrep",
    "vrepConst",
    "zmq",
];

/// Modules that Python imports by itself when it starts, if it finds them.
const START_MODULES: [&str; 2] = ["sitecustomize", "usercustomize"];

/// The name of a script.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ScriptName {
    /// The file's name without `.py`: the environment's name, with `_env` after it where that would not do.
    pub(crate) stem: String,
    /// Why it is not the environment's name.
    pub(crate) obstacle: Option<Obstacle>,
}

/// The names of the scripts of files, each kept until an environment of the file comes, goes or is renamed.
#[derive(Debug, Clone, Default)]
pub(crate) struct ScriptNames(FxHashMap<FileId, OnceLock<Arc<NamesOfFile>>>);

/// The names of the scripts of one file.
#[derive(Debug)]
pub(crate) struct NamesOfFile {
    pub(crate) environments: Vec<EntityId>,
    pub(crate) by_name: FxHashMap<SmolStr, ScriptName>,
}

impl ScriptNames {
    /// Those of a file that has, or had, environments; filled once they are needed.
    pub(crate) fn of(&self, file: FileId) -> Option<&OnceLock<Arc<NamesOfFile>>> {
        self.0.get(&file)
    }

    /// Notes that a declaration comes or goes.
    pub(crate) fn forget(&mut self, (file, kind, _): &Key) {
        if *kind == EntityKind::Environment {
            self.0.insert(*file, OnceLock::new());
        }
    }
}

/// Why a script cannot be called like its environment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Obstacle {
    /// Python would import the script in place of a module of its own.
    StandardModule,
    /// Python would import the script in place of a module that scripts need.
    ClientModule,
    /// Python would run the script whenever it starts in its folder.
    StartModule,
    /// Windows has no files of that name.
    ReservedOnWindows,
    /// Another environment's name, at this index, differs by case only, which some file systems ignore.
    SameButForCase(usize),
}

/// The names of the scripts of all environments of a file, in the order of the environments. An environment that is
/// declared a second time has the script of the first.
pub(crate) fn script_names(environments: &[&str]) -> Vec<ScriptName> {
    let mut first: FxHashMap<&str, usize> = FxHashMap::default();
    let mut taken: FxHashMap<String, usize> = FxHashMap::default();
    let mut names: Vec<ScriptName> = Vec::with_capacity(environments.len());
    for (index, name) in environments.iter().enumerate() {
        first.entry(name).or_insert(index);
        let folded = name.to_ascii_lowercase();
        let other = taken.get(&folded).copied();
        let obstacle = obstacle(name)
            .or(other.filter(|other| environments[*other] != *name).map(Obstacle::SameButForCase));
        if obstacle.is_none() && other.is_none() {
            taken.insert(folded, index);
        }
        names.push(ScriptName { stem: (*name).to_owned(), obstacle });
    }
    for (index, name) in environments.iter().enumerate() {
        match first.get(name) {
            Some(&first) if first < index => {
                let stem = names[first].stem.clone();
                names[index].stem = stem;
            }
            _ if names[index].obstacle.is_some() => {
                names[index].stem = free(name, &taken);
                taken.insert(names[index].stem.to_ascii_lowercase(), index);
            }
            _ => {}
        }
    }
    names
}

fn free(name: &str, taken: &FxHashMap<String, usize>) -> String {
    let mut stem = format!("{name}_env");
    while taken.contains_key(&stem.to_ascii_lowercase()) {
        stem += "_env";
    }
    stem
}

/// Why a script cannot be called like an environment of this name, whatever other environments there are.
pub(crate) fn obstacle(name: &str) -> Option<Obstacle> {
    if STANDARD_MODULES.contains(name) {
        Some(Obstacle::StandardModule)
    } else if CLIENT_MODULES.contains(&name) {
        Some(Obstacle::ClientModule)
    } else if START_MODULES.contains(&name) {
        Some(Obstacle::StartModule)
    } else if is_reserved_on_windows(name) {
        Some(Obstacle::ReservedOnWindows)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stems(environments: &[&str]) -> Vec<String> {
        script_names(environments).into_iter().map(|name| name.stem).collect()
    }

    #[test]
    fn scripts_hide_no_module_and_exist_on_windows() {
        for name in ["area_1", "Math", "comet", "com10", "zmq_"] {
            assert_eq!(script_names(&[name]), [ScriptName { stem: name.to_owned(), obstacle: None }]);
        }
        for (name, obstacle) in [
            ("math", Obstacle::StandardModule),
            ("json", Obstacle::StandardModule),
            ("tomllib", Obstacle::StandardModule),
            ("distutils", Obstacle::StandardModule),
            ("annotationlib", Obstacle::StandardModule),
            ("zmq", Obstacle::ClientModule),
            ("cbor2", Obstacle::ClientModule),
            ("sim", Obstacle::ClientModule),
            ("vrep", Obstacle::ClientModule),
            ("pydslrep_runtime", Obstacle::ClientModule),
            ("sitecustomize", Obstacle::StartModule),
            ("usercustomize", Obstacle::StartModule),
            ("con", Obstacle::ReservedOnWindows),
            ("NUL", Obstacle::ReservedOnWindows),
            ("Com7", Obstacle::ReservedOnWindows),
            ("lpt1", Obstacle::ReservedOnWindows),
        ] {
            let expected = ScriptName { stem: format!("{name}_env"), obstacle: Some(obstacle) };
            assert_eq!(script_names(&[name]), [expected]);
        }
    }

    #[test]
    fn every_script_has_a_file_of_its_own() {
        assert_eq!(stems(&["yard", "Yard", "YARD"]), ["yard", "Yard_env", "YARD_env_env"]);
        assert_eq!(script_names(&["yard", "Yard"])[1].obstacle, Some(Obstacle::SameButForCase(0)));
        assert_eq!(stems(&["math", "Math_Env"]), ["math_env_env", "Math_Env"]);
        assert_eq!(stems(&["CON", "con"]), ["CON_env", "con_env_env"]);
    }

    #[test]
    fn a_second_declaration_is_no_second_script() {
        assert_eq!(stems(&["yard", "Yard", "Yard", "yard"]), ["yard", "Yard_env", "Yard_env", "yard"]);
        assert!(script_names(&["yard", "yard"]).iter().all(|name| name.obstacle.is_none()));
    }
}
