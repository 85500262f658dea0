//! Environments ready to run, or the errors that keep them from it.

use std::cell::OnceCell;
use std::sync::Arc;

use pydslrep_syntax::Span;
use pydslrep_syntax::ast::Entity;

use super::Database;
use crate::blocked::Blocked;
use crate::entity::{EntityId, EntityRef};
use crate::environment::Environment;
use crate::fingerprint::Fingerprint;
use crate::{Diagnostic, Severity, diagnostics};

impl Database {
    /// An environment ready to run.
    ///
    /// # Errors
    /// When it or anything it uses has errors.
    pub fn environment(&self, id: EntityId) -> Result<Environment, Blocked> {
        self.environment_or(id, &OnceCell::new())
    }

    /// Several environments ready to run, in the order asked for; the error is as for [`Self::environment`].
    pub fn ready_environments(
        &self,
        ids: impl IntoIterator<Item = EntityId>,
    ) -> Vec<Result<Environment, Blocked>> {
        let all_errors = OnceCell::new();
        ids.into_iter().map(|id| self.environment_or(id, &all_errors)).collect()
    }

    /// `all_errors` keeps those of all files, once they are needed.
    fn environment_or(
        &self,
        id: EntityId,
        all_errors: &OnceCell<Arc<[Diagnostic]>>,
    ) -> Result<Environment, Blocked> {
        let name =
            self.tree(id).and_then(Entity::name).map_or_else(String::new, |name| name.text.to_string());
        let is_error = |diagnostic: &Diagnostic| diagnostic.severity == Severity::Error;
        let reached = self.located_problems(self.reached_from(id));
        let mut errors = diagnostics::of_entities(&self.facts, &reached);
        errors.retain(is_error);
        if !errors.is_empty() {
            return Err(Blocked { environment: name, errors: errors.into() });
        }
        // Otherwise a declaration it needs is hidden in text that was not understood; those errors are the cause.
        let hidden = || self.files().flat_map(|file| self.diagnostics(file)).filter(is_error).collect();
        let environment = self.resolved_environment(id);
        environment
            .map(|environment| self.with_scene(id, environment))
            .ok_or_else(|| Blocked { environment: name, errors: Arc::clone(all_errors.get_or_init(hidden)) })
    }

    /// Returns the fingerprint of an environment, to be compared with a later one; `None` where it has errors.
    pub fn fingerprint(&self, id: EntityId) -> Option<Fingerprint> {
        let reached = self.reached_from(id);
        let problems = reached.iter().flat_map(|id| self.problems.of(*id));
        if problems.into_iter().any(|problem| problem.severity == Severity::Error) {
            return None;
        }
        Fingerprint::new(&self.facts, id, &reached)
    }

    /// Where the errors of an entity are in its file.
    pub fn errors(&self, entity: &EntityRef<'_>) -> impl Iterator<Item = Span> {
        let errors = self.problems.of(entity.id).iter().filter(|problem| problem.severity == Severity::Error);
        let start = entity.span.start;
        errors.map(move |problem| problem.span.shifted(start))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_an_environment_uses_changes_it() {
        let mut database = Database::new();
        let program = "sensor far wheel a with radius 4 robot r with port 1 has { a b } wheels\n\
                       movement m of r { move 1 meters at 18 } environment e has { r } robots with { m } moves\n\
                       wheel b with radius 4";
        let file = database.open("test.pyr", program);
        let id = database.environments(file)[0].0;
        let fingerprint = |database: &Database| database.fingerprint(id);
        let before = fingerprint(&database);
        assert!(before.is_some());
        database.edit(file, Span::at(7), "very_");
        assert_eq!(fingerprint(&database), before, "nobody uses this sensor");
        database.edit(file, Span::at(0), "\n\nsensor new robot x has { } ");
        assert_eq!(fingerprint(&database), before, "nor that one, and what is wrong with a robot is its own");
        let text = database.text(file).unwrap().to_string();
        let speed = u32::try_from(text.find("at 18").unwrap()).unwrap() + 3;
        database.edit(file, Span::new(speed, speed + 2), "19");
        assert_ne!(fingerprint(&database), before);
        database.edit(file, Span::new(speed, speed + 2), "0");
        assert_eq!(fingerprint(&database), None, "no speed");
    }
}
