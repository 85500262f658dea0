//! Workspace symbols: fuzzy search for declarations in all files by name, best match first.

use nucleo_matcher::pattern::{AtomKind, CaseMatching, Normalization, Pattern};
use nucleo_matcher::{Config, Matcher, Utf32Str};
use pydslrep_analysis::{Database, EntityId, EntityRef, FileId};
use pydslrep_syntax::ast::Entity;
use pydslrep_syntax::{EntityKind, Span};

/// The maximum number of results; another letter in the query narrows them down.
const MAX_RESULTS: usize = 1000;

/// A declaration in the workspace.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WorkspaceSymbol {
    /// Its name.
    pub name: String,
    /// Its kind.
    pub kind: EntityKind,
    /// The robot of a movement, or the only robot in the file that uses a wheel or sensor.
    pub container: Option<String>,
    /// Its file.
    pub file: FileId,
    /// The range of its name.
    pub focus: Span,
}

/// A search for the declarations whose names contain the letters of the query in order, ignoring case; all for an empty
/// query. At most a thousand. It reads file by file, so that the database may change in between.
#[derive(Debug)]
pub struct SymbolSearch {
    pattern: Pattern,
    matcher: Matcher,
    letters: Vec<char>,
    found: Vec<(u32, EntityId)>,
}

impl SymbolSearch {
    /// A search that has not read any file.
    pub fn new(query: &str) -> Self {
        let pattern = Pattern::new(query, CaseMatching::Ignore, Normalization::Never, AtomKind::Fuzzy);
        Self { pattern, matcher: Matcher::new(Config::DEFAULT), letters: Vec::new(), found: Vec::new() }
    }

    /// Searches a file.
    pub fn add(&mut self, database: &Database, file: FileId) {
        for entity in database.entities(file) {
            if let Some(score) = self.score(entity.parse.entity.as_ref()) {
                self.found.push((score, entity.id));
            }
        }
    }

    /// Returns the symbols found that still exist, the best match first.
    pub fn finish(mut self, database: &Database) -> Vec<WorkspaceSymbol> {
        let mut found = std::mem::take(&mut self.found);
        // Stable: equal scores stay by file and in text order.
        found.sort_by_key(|(score, _)| std::cmp::Reverse(*score));
        let still_there = found.into_iter().filter_map(|(score, id)| {
            let entity = database.entity(id)?;
            (self.score(entity.parse.entity.as_ref()) == Some(score)).then_some(entity)
        });
        still_there.take(MAX_RESULTS).filter_map(|entity| symbol(database, &entity)).collect()
    }

    fn score(&mut self, tree: Option<&Entity>) -> Option<u32> {
        let name = tree?.name()?;
        self.pattern.score(Utf32Str::new(&name.text, &mut self.letters), &mut self.matcher)
    }
}

fn symbol(database: &Database, entity: &EntityRef<'_>) -> Option<WorkspaceSymbol> {
    let tree = entity.parse.entity.as_ref()?;
    let name = tree.name()?;
    Some(WorkspaceSymbol {
        name: name.text.to_string(),
        kind: tree.kind()?,
        container: container(database, entity.file, tree),
        file: entity.file,
        focus: name.span.shifted(entity.span.start),
    })
}

fn container(database: &Database, file: FileId, tree: &Entity) -> Option<String> {
    match tree {
        Entity::Movement(movement) => Some(movement.robot.as_ref()?.text.to_string()),
        Entity::Wheel(_) | Entity::Sensor(_) => {
            let users = database.users(file, tree.kind()?, &tree.name()?.text).iter();
            let mut robots = users.filter_map(|id| match database.tree(*id)? {
                Entity::Robot(robot) => robot.name.as_ref(),
                _ => None,
            });
            let first = robots.next()?;
            robots.all(|other| other.text == first.text).then(|| first.text.to_string())
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;

    fn workspace_symbols(database: &Database, query: &str) -> Vec<WorkspaceSymbol> {
        let mut search = SymbolSearch::new(query);
        for file in database.files() {
            search.add(database, file);
        }
        search.finish(database)
    }

    fn check(query: &str, expected: &Expect) {
        let mut database = Database::new();
        database.open(
            "parts.pyr",
            "wheel wheelL with radius 4\nsensor front\nsensor ^sensors\nrobot rover has { wheelL\nrobot other with sensors { front }\nrobot third with sensors { front }",
        );
        database.open(
            "main.pyr",
            "// é\nmovement wheelie of rover {\nenvironment yard has\nip Wheel_host 127.0.0.1\nsensor räder\nwheel",
        );
        let line = |symbol: WorkspaceSymbol| {
            let text = database.slice(symbol.file, symbol.focus);
            let container = symbol.container.map(|name| format!(" of {name}")).unwrap_or_default();
            format!(
                "{} {}{container}: {} {text:?}",
                symbol.kind.noun(),
                symbol.name,
                database.path(symbol.file)
            )
        };
        let found: Vec<String> = workspace_symbols(&database, query).into_iter().map(line).collect();
        expected.assert_eq(&found.join("\n"));
    }

    #[test]
    fn names_match_by_letters_in_order() {
        check(
            "wheel",
            &expect![[r#"
            wheel wheelL of rover: parts.pyr "wheelL"
            movement wheelie of rover: main.pyr "wheelie"
            ip Wheel_host: main.pyr "Wheel_host""#]],
        );
        check("WHLL", &expect![[r#"wheel wheelL of rover: parts.pyr "wheelL""#]]);
        check("ss", &expect![[r#"sensor sensors: parts.pyr "^sensors""#]]);
        check("lw", &expect![[""]]);
        check("rä", &expect![[r#"sensor räder: main.pyr "räder""#]]);
        check("é", &expect![[""]]);
    }

    #[test]
    fn an_empty_query_matches_everything() {
        check(
            "",
            &expect![[r#"
                wheel wheelL of rover: parts.pyr "wheelL"
                sensor front: parts.pyr "front"
                sensor sensors: parts.pyr "^sensors"
                robot rover: parts.pyr "rover"
                robot other: parts.pyr "other"
                robot third: parts.pyr "third"
                movement wheelie of rover: main.pyr "wheelie"
                environment yard: main.pyr "yard"
                ip Wheel_host: main.pyr "Wheel_host"
                sensor räder: main.pyr "räder""#]],
        );
    }

    #[test]
    fn the_number_of_results_is_limited() {
        let mut database = Database::new();
        let wheels: Vec<String> = (0..1200).map(|number| format!("wheel w{number}")).collect();
        database.open("a.pyr", &wheels.join("\n"));
        assert_eq!(workspace_symbols(&database, "w").len(), 1000);
        assert_eq!(workspace_symbols(&database, "w119")[0].name, "w119");
    }
}
