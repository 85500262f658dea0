//! The identifiers of robots, movements and the environment in a script: their names, if these are free identifiers.

use std::collections::{BTreeSet, HashSet};

use pydslrep_analysis::environment::{Environment, nested};
use pydslrep_kinematics::Drive;

/// Everything that a script may import from the runtime, in the order of imports.
pub(crate) fn imports() -> Vec<&'static str> {
    let mut names = Drive::ALL.map(|drive| drive.row().class).to_vec();
    names.extend(["movement", "parallel", "run", CLEAR, DETECTS]);
    names.sort_unstable();
    names
}

/// The function for a condition that no sensor detects anything.
pub(crate) const CLEAR: &str = "clear";

/// The function for a condition that a sensor detects something.
pub(crate) const DETECTS: &str = "detects";

/// Returns the functions that an environment's conditions call.
pub(crate) fn conditions(environment: &Environment) -> BTreeSet<&'static str> {
    let actions = environment.movements.iter().flat_map(|movement| nested(&movement.actions));
    let conditions = actions.flat_map(|action| action.kind.conditions());
    conditions.map(|condition| if condition.detect { DETECTS } else { CLEAR }).collect()
}

/// Python's keywords and builtins, one per line; tests/repository compares them with Python's own.
const PYTHON: &str = include_str!("python_names.txt");

/// Too like a digit, says ruff.
const AMBIGUOUS: [&str; 3] = ["I", "O", "l"];

/// Longer names would exceed the line length.
const MAX_LENGTH: usize = 40;

/// The identifiers of a script, all different.
#[derive(Debug)]
pub(crate) struct Identifiers {
    pub(crate) robots: Vec<String>,
    pub(crate) movements: Vec<String>,
    pub(crate) environment: String,
}

impl Identifiers {
    /// Chooses them in the order of the script.
    pub(crate) fn new(environment: &Environment) -> Self {
        let conditions = conditions(environment);
        let is_free = |name: &&str| [CLEAR, DETECTS].contains(name) && !conditions.contains(name);
        let imported = imports().into_iter().filter(|name| !is_free(name));
        let mut taken: HashSet<String> =
            PYTHON.lines().chain(imported).chain(AMBIGUOUS).map(str::to_owned).collect();
        let mut choose = |name: &str, kind: &str, number| {
            let found = choose(name, kind, number, &taken);
            taken.insert(found.clone());
            found
        };
        let robots = environment.robots.iter().zip(1..);
        let robots = robots.map(|(robot, number)| choose(&robot.name, "robot", number)).collect();
        let movements = environment.movements.iter().zip(1..);
        let movements =
            movements.map(|(movement, number)| choose(&movement.name, "movement", number)).collect();
        Self { robots, movements, environment: choose(&environment.name, "environment", 1) }
    }
}

/// The name itself, the name with its kind, or the kind with the first free number from `number` on.
fn choose(name: &str, kind: &str, number: usize, taken: &HashSet<String>) -> String {
    let named = [name.to_owned(), format!("{name}_{kind}")];
    let numbered = (number..).map(|number| format!("{kind}_{number}"));
    let mut candidates = named.into_iter().filter(|name| is_plain(name)).chain(numbered);
    candidates.find(|name| !taken.contains(name)).unwrap_or_default()
}

/// Returns whether a name is a short identifier whose form means nothing special to Python.
fn is_plain(name: &str) -> bool {
    name.len() <= MAX_LENGTH
        && name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c == '_' || c.is_ascii_alphanumeric())
}
