//! Completion in a scene file: tables, names of robots and sensors, keys of the table at the cursor and their values.

use pydslrep_analysis::{Database, EntityId};
use pydslrep_scene::{Key, Sort, TABLES, Table, Values};
use pydslrep_schema::{Named, Place, Slot, as_key, names, place_at};
use smol_str::SmolStr;

use super::{Meaning, meaning, robots};
use crate::completion::Rank;
use crate::completion::filter::filter_in_toml;
use crate::{Completion, CompletionKind, CompletionTrigger, Documentation};

/// What fits at an offset in the text of a scene file. Keys and tables that are there already do not, except for tables
/// that may stand any number of times.
pub fn scene_completions(
    database: &Database,
    environment: Option<EntityId>,
    text: &str,
    offset: u32,
    trigger: CompletionTrigger,
) -> Vec<Completion> {
    let Some(place) = place_at(text, offset).filter(|place| trigger.opens_in_toml(place)) else {
        return Vec::new();
    };
    filter_in_toml(fitting(database, environment, text, &place), text, offset)
}

fn fitting(database: &Database, environment: Option<EntityId>, text: &str, place: &Place) -> Vec<Completion> {
    let mut others = names(text);
    others.retain(|named| named.span != place.word);
    let robots = robots(database, environment);
    let mut free = headers(&robots);
    free.retain(|header| !header.is_taken(&others));
    match &place.slot {
        Slot::Table { outer, has_more: true, .. } => {
            let names = segments(&robots, outer).into_iter();
            let names = names.map(|(name, table)| (as_key(&name), table));
            names
                .map(|(name, table)| offer(place, &name, name.clone(), &table.markdown(), Rank::Fitting))
                .collect()
        }
        Slot::Table { .. } => free.iter().filter_map(|header| header.in_brackets(place)).collect(),
        Slot::Key { table, has_value, begins_line } => {
            let mut found = keys(place, table, *has_value, &others);
            found.extend(segments(&robots, table).into_iter().map(|(name, table)| {
                let written = format!("{}.", as_key(&name));
                offer(place, &written, written.clone(), &table.markdown(), Rank::Fitting)
            }));
            if *begins_line && !has_value {
                found.extend(free.iter().map(|header| header.on_a_line(place)));
            }
            found
        }
        Slot::Value { key } => values(place, key),
    }
}

/// A table as it could begin.
struct Header {
    table: &'static Table,
    parts: Vec<SmolStr>,
}

fn headers(robots: &[(SmolStr, Vec<SmolStr>)]) -> Vec<Header> {
    let mut headers = Vec::new();
    for table in &TABLES {
        match table.sort {
            Sort::Once | Sort::Each => headers.push(Header { table, parts: vec![table.name.into()] }),
            Sort::Robot => headers.extend(
                robots.iter().map(|(robot, _)| Header { table, parts: vec!["robots".into(), robot.clone()] }),
            ),
            Sort::Sensor => headers.extend(robots.iter().flat_map(|(robot, sensors)| {
                sensors.iter().map(move |sensor| Header {
                    table,
                    parts: vec!["robots".into(), robot.clone(), "sensors".into(), sensor.clone()],
                })
            })),
        }
    }
    headers
}

impl Header {
    /// Whether it is there and cannot be there again.
    fn is_taken(&self, others: &[Named]) -> bool {
        let name = self.parts.join(".");
        let sensors = format!("{name}.sensors");
        // The table of a sensor names its robot, too, but is another one.
        let is_of_a_sensor = |stretch: usize| {
            others.iter().any(|other| other.stretch == stretch && other.name.starts_with(&sensors))
        };
        let is_it = |named: &Named| named.name == name && !is_of_a_sensor(named.stretch);
        self.table.sort != Sort::Each && others.iter().any(is_it)
    }

    /// It, or what is missing of it, where a bracket is open; `None` where it does not fit.
    fn in_brackets(&self, place: &Place) -> Option<Completion> {
        let Slot::Table { outer, is_each, is_closed, .. } = &place.slot else { return None };
        let depth = outer.matches('.').count();
        let begins = self.parts.iter().take(depth).flat_map(|part| [part.as_str(), "."]).collect::<String>();
        if begins != *outer || depth >= self.parts.len() {
            return None;
        }
        let label = self.parts[depth..].iter().map(|part| as_key(part)).collect::<Vec<_>>().join(".");
        let insert = match (self.table.sort == Sort::Each, is_each, is_closed) {
            (true, true, true) | (false, false, true) => label.clone(),
            (true, true, false) => format!("{label}]]"),
            (true, false, true) => format!("[{label}]"),
            (true, false, false) => format!("[{label}]]"),
            (false, false, false) => format!("{label}]"),
            (false, true, _) => return None,
        };
        Some(offer(place, &label, insert, &self.table.markdown(), Rank::Fitting))
    }

    fn on_a_line(&self, place: &Place) -> Completion {
        let name = self.parts.iter().map(|part| as_key(part)).collect::<Vec<_>>().join(".");
        let header = if self.table.sort == Sort::Each { format!("[[{name}]]") } else { format!("[{name}]") };
        offer(place, &header, format!("{header}\n$0"), &self.table.markdown(), Rank::Keyword)
    }
}

/// Robots or sensors, where a table of theirs is one part of a key away.
fn segments(robots: &[(SmolStr, Vec<SmolStr>)], table: &str) -> Vec<(SmolStr, &'static Table)> {
    let named = |names: Vec<SmolStr>, sort: Sort| {
        let table = TABLES.iter().find(|table| table.sort == sort);
        table.map_or_else(Vec::new, |table| names.into_iter().map(|name| (name, table)).collect())
    };
    match table.split('.').collect::<Vec<_>>().as_slice() {
        ["robots", ""] => named(robots.iter().map(|(robot, _)| robot.clone()).collect(), Sort::Robot),
        ["robots", robot, "sensors", ""] => {
            let robot = robots.iter().find(|(name, _)| name == robot);
            named(robot.map(|(_, sensors)| sensors.clone()).unwrap_or_default(), Sort::Sensor)
        }
        _ => Vec::new(),
    }
}

fn keys(place: &Place, table: &str, has_value: bool, others: &[Named]) -> Vec<Completion> {
    // Where a name of a robot or a sensor is still to come, there are no keys yet.
    let is_whole =
        !matches!(table.split('.').collect::<Vec<_>>().as_slice(), ["robots", ""] | [.., "sensors", ""]);
    let Some(Meaning::Table(of)) = meaning(table.trim_end_matches('.')).filter(|_| is_whole) else {
        return Vec::new();
    };
    let is_taken = |key: &&Key| {
        let name = format!("{table}{}", key.name);
        let is_here = |other: &Named| of.sort != Sort::Each || other.stretch == place.stretch;
        others.iter().any(|other| other.name == name && is_here(other))
    };
    let free = of.keys.iter().filter(|key| !is_taken(key));
    let offered = free.map(|key| {
        let insert = if has_value { key.name.to_owned() } else { format!("{} = $0", key.name) };
        let detail = if key.required {
            "required".to_owned()
        } else {
            format!("default: {}", key.default.replace('`', ""))
        };
        Completion { detail, ..offer(place, key.name, insert, &key.markdown(), Rank::Fitting) }
    });
    offered.collect()
}

fn values(place: &Place, key: &str) -> Vec<Completion> {
    let Some(Meaning::Key(key)) = meaning(key) else { return Vec::new() };
    let value = |text: &str, detail: &str| Completion {
        detail: detail.to_owned(),
        ..Completion::new(text, CompletionKind::Value, place.word)
    };
    match key.values {
        Values::Flag => ["true", "false"]
            .map(|flag| {
                let is_default = key.default.trim_matches('`') == flag;
                value(flag, if is_default { "the default" } else { "" })
            })
            .to_vec(),
        _ => vec![value(key.example, "for example")],
    }
}

fn offer(place: &Place, label: &str, insert: String, documentation: &str, rank: Rank) -> Completion {
    Completion {
        documentation: Documentation::Text(documentation.to_owned()),
        detail: "a table".to_owned(),
        is_snippet: insert.contains("$0"),
        insert,
        rank,
        ..Completion::new(label, CompletionKind::Setting, place.word)
    }
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::super::tests::program;
    use super::*;
    use crate::settings::at_cursor;

    /// Those whose label has the word at the cursor in it.
    fn check(fixture: &str, expected: &Expect) {
        let (text, offset) = at_cursor(fixture);
        let (database, environment) = program();
        let mut out = String::new();
        for found in scene_completions(&database, environment, &text, offset, CompletionTrigger::Invoked) {
            out += &format!("{} | {} | {:?}\n", found.label, found.detail, found.insert);
        }
        expected.assert_eq(&out);
    }

    #[test]
    fn tables_with_the_names_of_the_program() {
        check(
            "$0",
            &expect![[r#"
            [world] | a table | "[world]\n$0"
            [noise] | a table | "[noise]\n$0"
            [[wall]] | a table | "[[wall]]\n$0"
            [[box]] | a table | "[[box]]\n$0"
            [[cylinder]] | a table | "[[cylinder]]\n$0"
            [[polygon]] | a table | "[[polygon]]\n$0"
            [robots.rover] | a table | "[robots.rover]\n$0"
            [robots."größe"] | a table | "[robots.\"größe\"]\n$0"
            [robots.rover.sensors.front] | a table | "[robots.rover.sensors.front]\n$0"
            [robots.rover.sensors.back] | a table | "[robots.rover.sensors.back]\n$0"
        "#]],
        );
        check(
            "[$0\n[world]\n[robots.rover.sensors.back]",
            &expect![[r#"
            noise | a table | "noise]"
            wall | a table | "[wall]]"
            box | a table | "[box]]"
            cylinder | a table | "[cylinder]]"
            polygon | a table | "[polygon]]"
            robots.rover | a table | "robots.rover]"
            robots."größe" | a table | "robots.\"größe\"]"
            robots.rover.sensors.front | a table | "robots.rover.sensors.front]"
        "#]],
        );
        check(
            "[box$0]",
            &expect![[r#"
            box | a table | "[box]"
        "#]],
        );
        check(
            "[[$0]]\n[[box]]",
            &expect![[r#"
            wall | a table | "wall"
            box | a table | "box"
            cylinder | a table | "cylinder"
            polygon | a table | "polygon"
        "#]],
        );
        check(
            "[robots.$0\n[robots.rover]",
            &expect![[r#"
            "größe" | a table | "\"größe\"]"
            rover.sensors.front | a table | "rover.sensors.front]"
            rover.sensors.back | a table | "rover.sensors.back]"
        "#]],
        );
        check(
            "[robots.rover.sensors.$0]",
            &expect![[r#"
            front | a table | "front"
            back | a table | "back"
        "#]],
        );
        check(
            "[robots.ro$0ver.sensors.front]",
            &expect![[r#"
            rover | a table | "rover"
        "#]],
        );
        check(
            "robots.$0",
            &expect![[r#"
            rover. | a table | "rover."
            "größe". | a table | "\"größe\"."
        "#]],
        );
    }

    #[test]
    fn keys_of_the_table_that_are_not_there() {
        check(
            "[[box]]\nsize = [1, 1]\n[[box]]\nat = [1, 1]\n$0",
            &expect![[r#"
            size | required | "size = $0"
            heading | default: 0 | "heading = $0"
            name | default: the table's name and a number: box_1 | "name = $0"
            [world] | a table | "[world]\n$0"
            [noise] | a table | "[noise]\n$0"
            [[wall]] | a table | "[[wall]]\n$0"
            [[box]] | a table | "[[box]]\n$0"
            [[cylinder]] | a table | "[[cylinder]]\n$0"
            [[polygon]] | a table | "[[polygon]]\n$0"
            [robots.rover] | a table | "[robots.rover]\n$0"
            [robots."größe"] | a table | "[robots.\"größe\"]\n$0"
            [robots.rover.sensors.front] | a table | "[robots.rover.sensors.front]\n$0"
            [robots.rover.sensors.back] | a table | "[robots.rover.sensors.back]\n$0"
        "#]],
        );
        check(
            "[robots.rover]\nrim$0",
            &expect![[r#"
            rim-speed | default: without end | "rim-speed = $0"
            rim-acceleration | default: 1.0 | "rim-acceleration = $0"
        "#]],
        );
        check(
            "[robots.rover.sensors.front]\nco$0ne = 1",
            &expect![[r#"
            cone | default: 20 | "cone"
        "#]],
        );
        check(
            "world = { s$0 }",
            &expect![[r#"
                size | default: without end | "size = $0"
                seed | default: 1 | "seed = $0"
            "#]],
        );
        check(
            "[[polygon]]\ncorners = [\n  [0, 1],\n  [1, 1]\n]\nn$0",
            &expect![[r#"
                name | default: the table's name and a number: box_1 | "name = $0"
                [noise] | a table | "[noise]\n$0"
            "#]],
        );
    }

    #[test]
    fn values_of_every_kind() {
        check(
            "[world]\nwalls = $0",
            &expect![[r#"
            true | the default | "true"
            false |  | "false"
        "#]],
        );
        check(
            "[[box]]\nat = $0",
            &expect![[r#"
            [1.0, 0.5] | for example | "[1.0, 0.5]"
        "#]],
        );
        check("[[box]]\nfoo = $0", &expect![[r#""#]]);
    }

    /// What is offered is what is read.
    #[test]
    fn every_offer_is_understood() {
        let (database, environment) = program();
        let floor = database.floor(environment.unwrap()).unwrap();
        let at_end = |text: &str| {
            let end = u32::try_from(text.len()).unwrap();
            scene_completions(&database, environment, text, end, CompletionTrigger::Invoked)
        };
        let tables = at_end("");
        assert_eq!(tables.len(), 6 + 2 + 2);
        for table in tables {
            let header = table.insert.replace("$0", "");
            for key in at_end(&header).into_iter().filter(|key| !key.label.starts_with('[')) {
                let key = format!("{header}{}", key.insert.replace("$0", ""));
                let values = at_end(&key);
                assert!(!values.is_empty(), "{key}");
                for value in values {
                    let text = format!("{key}{}", value.insert);
                    let wrong = pydslrep_scene::read(&text, floor.clone()).1;
                    // One key alone may leave out another, or put a robot into a box.
                    let mut wrong = wrong.iter().filter(|problem| {
                        problem.kind != pydslrep_schema::ProblemKind::MissingKey
                            && !problem.message.contains("starts in")
                    });
                    assert_eq!(wrong.next(), None, "{text}");
                }
            }
        }
    }
}
