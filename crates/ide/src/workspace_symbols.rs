//! Workspace symbols: fuzzy search for declarations in all files by name, best match first.

use nucleo_matcher::pattern::{AtomKind, CaseMatching, Normalization, Pattern};
use nucleo_matcher::{Config, Matcher, Utf32Str};
use pydslrep_analysis::{Database, EntityRef, FileId};
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

/// The declarations whose names contain the letters of the query in order, ignoring case; all for an empty query. At most
/// a thousand.
pub fn workspace_symbols(database: &Database, query: &str) -> Vec<WorkspaceSymbol> {
    let pattern = Pattern::new(query, CaseMatching::Ignore, Normalization::Never, AtomKind::Fuzzy);
    let mut matcher = Matcher::new(Config::DEFAULT);
    let mut letters = Vec::new();
    let mut matches: Vec<(u32, EntityRef<'_>)> = Vec::new();
    for entity in database.files().flat_map(|file| database.entities(file)) {
        let Some(name) = entity.parse.entity.as_ref().and_then(Entity::name) else { continue };
        if let Some(score) = pattern.score(Utf32Str::new(&name.text, &mut letters), &mut matcher) {
            matches.push((score, entity));
        }
    }
    // Stable: equal scores stay by file and in text order.
    matches.sort_by_key(|(score, _)| std::cmp::Reverse(*score));
    matches.iter().take(MAX_RESULTS).filter_map(|(_, entity)| symbol(database, entity)).collect()
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
