//! What the scripts of a program's environments are called.

use std::sync::LazyLock;

use rustc_hash::FxHashSet;

/// Modules of Python 3.11 to 3.14.
static STANDARD_MODULES: LazyLock<FxHashSet<&str>> =
    LazyLock::new(|| include_str!("standard_modules.txt").lines().collect());

/// Modules that the clients of scripts import, or look for, beside the standard ones. Those of all targets count: a
/// script would hide them from others in its folder, too.
const CLIENT_MODULES: [&str; 10] = [
    "cbor",
    "cbor2",
    "cffi",
    "coppeliasim_zmqremoteapi_client",
    "numpy",
    "sim",
    "simConst",
    "vrep",
    "vrepConst",
    "zmq",
];

/// What a script is called.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ScriptName {
    /// The file's name without `.py`: the environment's name, with `_env` after it where that would not do.
    pub(crate) stem: String,
    /// Why it is not the environment's name.
    pub(crate) obstacle: Option<Obstacle>,
}

/// Why a script cannot be called like its environment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Obstacle {
    /// Python would import the script in place of a module of its own.
    StandardModule,
    /// Python would import the script in place of a module that scripts need.
    ClientModule,
    /// Windows has no files of that name.
    ReservedOnWindows,
    /// Another environment's name, at this index, differs by case only, as some file systems do not tell apart.
    SameButForCase(usize),
}

/// The names of the scripts of all environments of a file, in the order of the environments. An environment that is
/// declared a second time has the script of the first.
pub(crate) fn script_names(environments: &[&str]) -> Vec<ScriptName> {
    let first = |name: &str| environments.iter().position(|other| *other == name);
    let mut taken: Vec<(String, usize)> = Vec::new();
    let mut names: Vec<ScriptName> = Vec::with_capacity(environments.len());
    for (index, name) in environments.iter().enumerate() {
        let folded = name.to_ascii_lowercase();
        let other = taken.iter().find(|(other, _)| *other == folded).map(|(_, other)| *other);
        let obstacle = obstacle(name)
            .or(other.filter(|other| environments[*other] != *name).map(Obstacle::SameButForCase));
        if obstacle.is_none() && other.is_none() {
            taken.push((folded, index));
        }
        names.push(ScriptName { stem: (*name).to_owned(), obstacle });
    }
    for (index, name) in environments.iter().enumerate() {
        match first(name) {
            Some(first) if first < index => {
                let stem = names[first].stem.clone();
                names[index].stem = stem;
            }
            _ if names[index].obstacle.is_some() => {
                names[index].stem = free(name, &taken);
                taken.push((names[index].stem.to_ascii_lowercase(), index));
            }
            _ => {}
        }
    }
    names
}

fn free(name: &str, taken: &[(String, usize)]) -> String {
    let mut stem = format!("{name}_env");
    while taken.iter().any(|(other, _)| stem.eq_ignore_ascii_case(other)) {
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
    } else if is_reserved_on_windows(name) {
        Some(Obstacle::ReservedOnWindows)
    } else {
        None
    }
}

fn is_reserved_on_windows(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    let is_port = |prefix| {
        name.strip_prefix(prefix).is_some_and(|n| matches!(n.as_bytes(), [digit] if digit.is_ascii_digit()))
    };
    ["con", "prn", "aux", "nul"].contains(&name.as_str()) || is_port("com") || is_port("lpt")
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
