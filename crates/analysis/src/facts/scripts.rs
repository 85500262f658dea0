//! The names of environments' scripts.

use std::sync::Arc;

use smol_str::SmolStr;

use super::Facts;
use crate::entity::{EntityId, FileId};
use crate::facts::script_name::{NamesOfFile, Obstacle, ScriptName, obstacle, script_names};

impl Facts {
    /// Returns the name of an environment's script, and the environment that already has the usual one, if any. Most
    /// names are free, which is known without looking at the others.
    pub(crate) fn script_name(&self, file: FileId, name: &SmolStr) -> Option<(ScriptName, Option<EntityId>)> {
        if obstacle(name).is_none() && self.environments_but_for_case(file, name).len() < 2 {
            return Some((ScriptName { stem: name.to_string(), obstacle: None }, None));
        }
        let of_file = self.script_names.of(file)?.get_or_init(|| Arc::new(self.names_of_file(file)));
        let found = of_file.by_name.get(name)?.clone();
        let other = match found.obstacle {
            Some(Obstacle::SameButForCase(other)) => of_file.environments.get(other).copied(),
            _ => None,
        };
        Some((found, other))
    }

    fn names_of_file(&self, file: FileId) -> NamesOfFile {
        let (environments, names): (Vec<_>, Vec<_>) =
            self.environments(file).into_iter().map(|(id, name)| (id, name.text)).unzip();
        let scripts = script_names(&names.iter().map(SmolStr::as_str).collect::<Vec<_>>());
        // All environments of a name have the same script.
        NamesOfFile { environments, by_name: names.into_iter().zip(scripts).collect() }
    }
}

#[cfg(test)]
mod tests {
    use pydslrep_syntax::Span;

    use crate::Database;

    #[test]
    fn names_follow_the_environments() {
        let mut database = Database::new();
        let file = database.open("a.pyr", "environment Yard environment yard environment math");
        let stem = |database: &Database, name: &str| {
            database.script_name(file, &name.into()).map(|(script, _)| script.stem)
        };
        assert_eq!(stem(&database, "yard").as_deref(), Some("yard_env"));
        assert_eq!(stem(&database, "math").as_deref(), Some("math_env"));
        database.edit(file, Span::new(12, 16), "yard_env");
        assert_eq!(stem(&database, "yard").as_deref(), Some("yard"), "it has the name to itself now");
        database.edit(file, Span::at(0), "environment math_env ");
        assert_eq!(stem(&database, "math").as_deref(), Some("math_env_env"));
    }
}
