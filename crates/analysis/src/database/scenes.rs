//! Scenes, and the planned runs in them, whose problems depend on everything that an environment sees.

use std::sync::Arc;

use smol_str::SmolStr;

use super::Database;
use super::scene_run::SceneRun;
use crate::diagnostics::PlannedRun;
use crate::entity::FileId;

impl Database {
    /// Sets the text of the scene file of an environment by its name, or takes it away. Kept while a file is closed, and
    /// whether or not there is such an environment.
    pub fn set_scene(&mut self, file: FileId, environment: &str, text: Option<&str>) {
        if !self.facts.set_scene(file, environment, text) {
            return;
        }
        let runs = self.runs.entry(file).or_default();
        match text {
            Some(_) => runs.insert(environment.into(), SceneRun::default()),
            None => runs.remove(environment),
        };
        self.runs.retain(|_, runs| !runs.is_empty());
        let seen = self.seen_from(file);
        self.touched.extend(seen);
    }

    /// Returns the planned runs of the environments with a scene whose actions may be in a file. A run is computed
    /// again only where the environment's fingerprint changed.
    pub(super) fn planned_runs(&self, file: FileId) -> Vec<Arc<PlannedRun>> {
        let mut planned_runs = Vec::new();
        for (home, runs) in &self.runs {
            if *home != file && !self.imported_files(*home).any(|imported| imported == file) {
                continue;
            }
            planned_runs.extend(runs.iter().filter_map(|(name, run)| self.planned_run(*home, name, run)));
        }
        planned_runs
    }

    fn planned_run(&self, home: FileId, name: &SmolStr, run: &SceneRun) -> Option<Arc<PlannedRun>> {
        let id = self.environment_called(home, name)?;
        run.of(self.fingerprint(id)?, || PlannedRun::new(&self.facts, id))
    }

    /// Touches the files of environments that changed: the collisions on a path depend on everything the environment
    /// sees.
    pub(super) fn touch_in_scenes(&mut self) {
        let mut concerned: Vec<FileId> = Vec::new();
        let mut looked_at = Vec::new();
        for (home, runs) in &self.runs {
            let seen = self.seen_from(*home);
            if !seen.iter().any(|file| self.touched.contains(file)) {
                continue;
            }
            for (name, run) in runs {
                let fingerprint = self.environment_called(*home, name).and_then(|id| self.fingerprint(id));
                // Where there is something to say, other files may name a place that has moved.
                if fingerprint != run.touched_with || run.has_problems() {
                    concerned.extend(&seen);
                }
                looked_at.push((*home, name.clone(), fingerprint));
            }
        }
        for (home, name, fingerprint) in looked_at {
            if let Some(run) = self.runs.get_mut(&home).and_then(|runs| runs.get_mut(&name)) {
                run.touched_with = fingerprint;
            }
        }
        self.touched.extend(concerned);
    }

    fn seen_from(&self, home: FileId) -> Vec<FileId> {
        std::iter::once(home).chain(self.imported_files(home)).collect()
    }
}

#[cfg(test)]
mod tests {
    use pydslrep_syntax::Span;

    use super::*;

    const PROGRAM: &str = "wheel a with radius 4 wheel b with radius 4 wheel c with radius 4\n\
        robot r with port 1 has { a b } wheels movement m of r { move 2 meters }\n\
        environment e has { r } robots with { m } moves";

    fn replace(database: &mut Database, file: FileId, old: &str, new: &str) {
        let text = database.text(file).unwrap().to_string();
        let at = u32::try_from(text.find(old).unwrap()).unwrap();
        database.edit(file, Span::new(at, at + u32::try_from(old.len()).unwrap()), new);
    }

    fn changed(database: &mut Database) -> Vec<String> {
        database.take_changed_environments().into_iter().map(|(_, name)| name.to_string()).collect()
    }

    #[test]
    fn an_environment_has_the_objects_that_its_scene_names() {
        let mut database = Database::new();
        let file = database.open("a.pyr", PROGRAM);
        let (id, _) = database.environments(file)[0].clone();
        let paths = |database: &Database| {
            let objects = database.environment(id).unwrap().robots.remove(0).objects;
            objects
                .into_iter()
                .map(|(part, paths)| format!("{part}: {}", paths.join(" ")))
                .collect::<Vec<_>>()
        };
        assert!(paths(&database).is_empty());
        let scene = "[robots.r]\nobject = '/P3DX'\nstart = 1\n[robots.r.wheels.a]\nobject = '/P3DX/left'";
        database.set_scene(file, "e", Some(scene));
        assert_eq!(
            paths(&database),
            ["a: /P3DX/left", "r: /P3DX"],
            "what is wrong with others does not matter"
        );
    }

    #[test]
    fn a_run_is_planned_again_only_when_it_is_another_one() {
        let mut database = Database::new();
        let file = database.open("a.pyr", PROGRAM);
        database.set_scene(file, "e", Some("[[box]]\nat = [1, 0]\nsize = [0.4, 0.4]"));
        let run = |database: &Database| database.planned_runs(file).remove(0);
        let first = run(&database);
        replace(&mut database, file, "c with radius 4", "c with radius 45");
        replace(&mut database, file, "c with", "c\n\nwith");
        assert!(Arc::ptr_eq(&run(&database), &first), "nobody has this wheel");
        replace(&mut database, file, "move 2", "move 3");
        let second = run(&database);
        assert!(!Arc::ptr_eq(&second, &first));
        database.set_scene(file, "e", Some("[[box]]\nat = [1, 1]\nsize = [0.4, 0.4]"));
        assert!(!Arc::ptr_eq(&run(&database), &second));
        assert!(!run(&database).has_problems());
    }

    /// Text typed elsewhere in the program does not make the imported files outdated.
    #[test]
    fn files_are_touched_where_what_is_met_may_change() {
        let mut database = Database::new();
        let parts = database.open("parts.pyr", PROGRAM.split("environment").next().unwrap());
        let text = "import \"parts.pyr\" sensor s\nenvironment e has { r } robots with { m } moves";
        let main = database.open("main.pyr", text);
        database.set_scene(main, "e", Some("[[box]]\nat = [1, 1]\nsize = [0.4, 0.4]"));
        database.take_touched();
        replace(&mut database, main, "sensor s", "sensor t");
        assert_eq!(database.take_touched(), [main]);
        database.set_scene(main, "e", Some("[[box]]\nat = [1, 0]\nsize = [0.4, 0.4]"));
        assert_eq!(database.take_touched(), [parts, main]);
        replace(&mut database, main, "{ m }", "{ }");
        assert_eq!(database.take_touched(), [parts, main]);
    }

    #[test]
    fn environments_that_come_and_go_are_told() {
        let mut database = Database::new();
        let file = database.open("a.pyr", PROGRAM);
        assert_eq!(changed(&mut database), ["e"]);
        replace(&mut database, file, "{ m }", "{ m m }");
        replace(&mut database, file, "move 2", "move 3");
        assert_eq!(changed(&mut database), [""; 0]);
        replace(&mut database, file, "environment e", "environment east");
        assert_eq!(changed(&mut database), ["e", "east"]);
        database.open("a.pyr", &PROGRAM.replace("environment e", "environment east"));
        assert_eq!(changed(&mut database), [""; 0]);
        database.close(file);
        assert_eq!(changed(&mut database), ["east"]);
    }
}
