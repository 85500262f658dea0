//! Completion in a TOML file: tables, names of the program, keys of the table at the cursor, and their values.

use pydslrep_schema::{
    CursorContext, Item, Key, NAME, NamePart, Names, Schema, Slot, Table, TableKind, Values, as_key,
    cursor_context, name_parts,
};

use super::TomlFile;
use crate::completion::Rank;
use crate::completion::filter::filter_in_toml;
use crate::{Completion, CompletionKind, CompletionTrigger, Documentation};

/// Returns the keys, tables and values that fit at an offset. Keys and tables that are already there do not, except for
/// tables that can appear any number of times.
pub fn toml_completions(
    file: TomlFile<'_>,
    text: &str,
    offset: u32,
    trigger: CompletionTrigger,
) -> Vec<Completion> {
    let Some(cursor) = cursor_context(text, offset).filter(|cursor| trigger.opens_in_toml(cursor)) else {
        return Vec::new();
    };
    let mut others = name_parts(text);
    others.retain(|part| part.span != cursor.word);
    let schema = file.schema();
    let headers = headers(schema, &file.names());
    filter_in_toml(TomlOffers { schema, cursor, others, headers }.fitting(), text, offset, trigger)
}

struct TomlOffers {
    schema: &'static Schema,
    cursor: CursorContext,
    /// The names in the text but for the one at the cursor.
    others: Vec<NamePart>,
    headers: Vec<Header>,
}

/// A table as it could begin.
struct Header {
    table: &'static Table,
    parts: Vec<String>,
}

/// All tables, with the names of the program in place of placeholders.
fn headers(schema: &Schema, names: &Names) -> Vec<Header> {
    fn expand(parts: &[&str], names: &Names, is_named: bool) -> Vec<Vec<String>> {
        let Some((first, rest)) = parts.split_first() else { return vec![Vec::new()] };
        let before = |first: &str, rest: Vec<Vec<String>>| -> Vec<Vec<String>> {
            rest.into_iter().map(|rest| [vec![first.to_owned()], rest].concat()).collect()
        };
        match *first {
            NAME => {
                names.0.iter().flat_map(|(name, inner)| before(name, expand(rest, inner, true))).collect()
            }
            part if is_named && !rest.is_empty() => {
                names.get(part).map_or_else(Vec::new, |inner| before(part, expand(rest, inner, true)))
            }
            part => before(part, expand(rest, names, false)),
        }
    }
    let tables = schema.tables.iter().filter(|table| !table.name.is_empty());
    let headers = |table| {
        expand(&Table::parts(table), names, false).into_iter().map(move |parts| Header { table, parts })
    };
    tables.flat_map(headers).collect()
}

impl TomlOffers {
    fn fitting(&self) -> Vec<Completion> {
        let free = || self.headers.iter().filter(|header| !self.is_taken(header));
        match &self.cursor.slot {
            Slot::Table { outer, has_more: true, .. } => {
                self.names_in(outer).map(|(name, table)| self.table(table, &name, name.clone())).collect()
            }
            Slot::Table { .. } => free().filter_map(|header| self.in_brackets(header)).collect(),
            Slot::Key { table, has_value, begins_line } => {
                let mut found = self.keys(table, *has_value);
                let names = self.names_in(table).map(|(name, table)| (format!("{name}."), table));
                found.extend(names.map(|(name, table)| self.table(table, &name, name.clone())));
                if *begins_line && !has_value {
                    found.extend(free().map(|header| self.on_a_line(header)));
                }
                found
            }
            Slot::Value { key } => self.values(key),
        }
    }

    /// Returns whether a table exists and cannot appear again.
    fn is_taken(&self, header: &Header) -> bool {
        let name = header.parts.join(".");
        // The header of a sensor contains the name of its robot, but is not the robot's.
        let is_inner = |other: &NamePart| {
            let is_longer = other.name.strip_prefix(&name).is_some_and(|rest| rest.starts_with('.'));
            is_longer && matches!(self.schema.find(&parts(&other.name)), Some(Item::Table(_)))
        };
        let is_it = |part: &NamePart| {
            let section = || self.others.iter().filter(|other| other.section == part.section);
            part.name == name && !section().any(is_inner)
        };
        header.table.kind != TableKind::Each && self.others.iter().any(is_it)
    }

    /// The names that can follow the parts of a table's name, each of which has a dot after it.
    fn names_in(&self, outer: &str) -> impl Iterator<Item = (String, &'static Table)> {
        let depth = outer.matches('.').count();
        let fits = move |header: &&Header| {
            header.parts.len() == depth + 1
                && header.table.parts()[depth] == NAME
                && header.begins_with(outer)
        };
        self.headers.iter().filter(fits).map(move |header| (as_key(&header.parts[depth]), header.table))
    }

    /// Returns the completion for the rest of a header after an open bracket; `None` if it does not fit.
    fn in_brackets(&self, header: &Header) -> Option<Completion> {
        let Slot::Table { outer, is_each, is_closed, .. } = &self.cursor.slot else { return None };
        let depth = outer.matches('.').count();
        if depth >= header.parts.len() || !header.begins_with(outer) {
            return None;
        }
        let label = written(&header.parts[depth..]);
        let insert = match (header.table.kind == TableKind::Each, is_each, is_closed) {
            (true, true, true) | (false, false, true) => label.clone(),
            (true, true, false) => format!("{label}]]"),
            (true, false, true) => format!("[{label}]"),
            (true, false, false) => format!("[{label}]]"),
            (false, false, false) => format!("{label}]"),
            (false, true, _) => return None,
        };
        Some(self.table(header.table, &label, insert))
    }

    fn on_a_line(&self, header: &Header) -> Completion {
        let label = header.table.header(&written(&header.parts));
        Completion { rank: Rank::Keyword, ..self.table(header.table, &label, format!("{label}\n$0")) }
    }

    fn keys(&self, table: &str, has_value: bool) -> Vec<Completion> {
        let Some(of) = self.schema.table_at(&parts(table)) else { return Vec::new() };
        let is_taken = |key: &&Key| {
            let name = format!("{table}{}", key.name);
            let is_here =
                |other: &NamePart| of.kind != TableKind::Each || other.section == self.cursor.section;
            self.others.iter().any(|other| other.name == name && is_here(other))
        };
        of.keys.iter().filter(|key| !is_taken(key)).map(|key| self.key(key, has_value)).collect()
    }

    fn key(&self, key: &Key, has_value: bool) -> Completion {
        let insert = match has_value {
            true => key.name.to_owned(),
            false if key.values.is_quoted() => format!("{} = \"$0\"", key.name),
            false => format!("{} = $0", key.name),
        };
        let default = || format!("default: {}", key.default.replace('`', ""));
        let detail = key.requirement().map_or_else(default, |required| required.replace('`', ""));
        Completion { detail, ..self.offer(key.name, insert, key.markdown()) }
    }

    fn values(&self, key: &str) -> Vec<Completion> {
        let Some(Item::Key(key)) = self.schema.find(&parts(key)) else { return Vec::new() };
        let value = |text: &str, summary: &str| {
            let detail = match (key.default_value() == Some(text), summary) {
                (true, "") => "default".to_owned(),
                (true, summary) => format!("{summary} (default)"),
                (false, summary) => summary.to_owned(),
            };
            Completion { detail, ..Completion::new(text, CompletionKind::Value, self.cursor.word) }
        };
        match key.values {
            Values::Words(words) => {
                words.iter().map(|word| value(&format!("\"{}\"", word.word), word.summary)).collect()
            }
            Values::Flag => ["true", "false"].map(|flag| value(flag, "")).to_vec(),
            _ => vec![value(key.example, "for example")],
        }
    }

    fn table(&self, table: &Table, label: &str, insert: String) -> Completion {
        Completion { detail: "a table".to_owned(), ..self.offer(label, insert, table.markdown()) }
    }

    fn offer(&self, label: &str, insert: String, documentation: String) -> Completion {
        Completion {
            documentation: Documentation::Text(documentation),
            is_snippet: insert.contains("$0"),
            insert,
            rank: Rank::Fitting,
            ..Completion::new(label, CompletionKind::Setting, self.cursor.word)
        }
    }
}

impl Header {
    /// Returns whether `outer` consists of its first parts, each followed by a dot.
    fn begins_with(&self, outer: &str) -> bool {
        let name = format!("{}.", self.parts.join("."));
        name.starts_with(outer)
    }
}

/// The parts of a name, which may have a dot after the last one.
fn parts(name: &str) -> Vec<&str> {
    name.split('.').filter(|part| !part.is_empty()).collect()
}

/// Parts of a name as a file has them.
fn written(parts: &[String]) -> String {
    parts.iter().map(|part| as_key(part)).collect::<Vec<_>>().join(".")
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};
    use pydslrep_config::Config;
    use pydslrep_schema::ProblemKind;

    use super::super::tests::{at_cursor, program};
    use super::*;

    /// Those that fit the word at the cursor.
    fn completions(file: TomlFile<'_>, fixture: &str, expected: &Expect) {
        let (text, offset) = at_cursor(fixture);
        let mut out = String::new();
        for found in toml_completions(file, &text, offset, CompletionTrigger::Invoked) {
            out += &format!("{} | {} | {:?}\n", found.label, found.detail, found.insert);
        }
        expected.assert_eq(&out);
    }

    fn check(fixture: &str, expected: &Expect) {
        completions(TomlFile::Settings, fixture, expected);
    }

    fn check_scene(fixture: &str, expected: &Expect) {
        let (database, environment) = program();
        completions(TomlFile::Scene(&database, environment), fixture, expected);
    }

    #[test]
    fn settings_that_are_not_there() {
        check(
            "output = 'a'\n$0\n[inlay-hints]\npose = true",
            &expect![[r#"
                target | default: "coppeliasim" | "target = \"$0\""
                edition | default: "current" | "edition = \"$0\""
                generate-on-save | default: false | "generate-on-save = $0"
                write-runtime | default: true | "write-runtime = $0"
                default-speed | default: 9.0 | "default-speed = $0"
                [severity] | a table | "[severity]\n$0"
                [coppeliasim] | a table | "[coppeliasim]\n$0"
                [code-lens] | a table | "[code-lens]\n$0"
            "#]],
        );
        check(
            "out$0 = 'a'",
            &expect![[r#"
            output | default: beside each program | "output"
        "#]],
        );
        check(
            "[inlay-hints]\npose = true\n$0\n[severity]",
            &expect![[r#"
                duration | default: true | "duration = $0"
                defaults | default: true | "defaults = $0"
                [coppeliasim] | a table | "[coppeliasim]\n$0"
                [code-lens] | a table | "[code-lens]\n$0"
            "#]],
        );
        check(
            "inlay-hints.$0",
            &expect![[r#"
            pose | default: true | "pose = $0"
            duration | default: true | "duration = $0"
            defaults | default: true | "defaults = $0"
        "#]],
        );
        check(
            "sever$0\ntarget = 'vrep'",
            &expect![[r#"
            [severity] | a table | "[severity]\n$0"
        "#]],
        );
        check(
            "[$0",
            &expect![[r#"
                severity | a table | "severity]"
                coppeliasim | a table | "coppeliasim]"
                inlay-hints | a table | "inlay-hints]"
                code-lens | a table | "code-lens]"
            "#]],
        );
        check(
            "[sev$0]\n[inlay-hints]",
            &expect![[r#"
            severity | a table | "severity"
        "#]],
        );
        check("wheels.$0", &expect![""]);
    }

    #[test]
    fn codes_in_severity() {
        check(
            "[severity]\nwheel-order = 'off'\nwheel$0",
            &expect![[r#"
            wheel-count | default: "error" | "wheel-count = \"$0\""
            wheel-kind-mismatch | default: "error" | "wheel-kind-mismatch = \"$0\""
            repeated-wheel | default: "error" | "repeated-wheel = \"$0\""
        "#]],
        );
        check(
            "severity = { slam$0",
            &expect![[r#"
            slam-robot | default: "error" | "slam-robot = \"$0\""
            slam-sensors | default: "error" | "slam-sensors = \"$0\""
        "#]],
        );
        check(
            "[severity]\nslam-rob$0ot = 'off'",
            &expect![[r#"
            slam-robot | default: "error" | "slam-robot"
        "#]],
        );
    }

    #[test]
    fn values_of_settings() {
        check(
            "target = $0",
            &expect![[r#"
                "coppeliasim" | CoppeliaSim 4.6 or later, by its ZeroMQ remote API (default) | "\"coppeliasim\""
                "vrep" | V-REP 3, by its legacy remote API: each robot has a port of its own | "\"vrep\""
                "ros2" | ROS 2, by the topics of a robot's driver: Jazzy or Kilted, through rclpy | "\"ros2\""
            "#]],
        );
        check(
            "target = \"v$0\"",
            &expect![[r#"
            "vrep" | V-REP 3, by its legacy remote API: each robot has a port of its own | "\"vrep\""
        "#]],
        );
        check(
            "inlay-hints.pose = $0",
            &expect![[r#"
                true | default | "true"
                false |  | "false"
            "#]],
        );
        check(
            "default-speed = $0",
            &expect![[r#"
            12.5 | for example | "12.5"
        "#]],
        );
        check(
            "output = $0",
            &expect![[r#"
            "scripts" | for example | "\"scripts\""
        "#]],
        );
        check(
            "[severity]\nwheel-count = \"$0",
            &expect![[r#"
                "off" | not shown | "\"off\""
                "hint" | shown as a hint, hardly visible | "\"hint\""
                "information" | shown as information | "\"information\""
                "warning" | shown as a warning | "\"warning\""
                "error" | shown as an error; `pydslrep check` fails (default) | "\"error\""
            "#]],
        );
        check("[severity]\nwheels = $0", &expect![""]);
        check("severity = $0", &expect![""]);
        check("target = 'vrep' $0", &expect![""]);
    }

    #[test]
    fn documentation_says_what_a_key_does() {
        let (text, offset) = at_cursor("tar$0");
        let found = toml_completions(TomlFile::Settings, &text, offset, CompletionTrigger::Invoked).remove(0);
        let Documentation::Text(text) = &found.documentation else { panic!("{found:?}") };
        expect![[r#"
            **`target`**: `"coppeliasim"`, `"vrep"` or `"ros2"`

            The simulator that scripts are for.

            * `"coppeliasim"`: CoppeliaSim 4.6 or later, by its ZeroMQ remote API
            * `"vrep"`: V-REP 3, by its legacy remote API: each robot has a port of its own
            * `"ros2"`: ROS 2, by the topics of a robot's driver: Jazzy or Kilted, through rclpy

            Default: `"coppeliasim"`
        "#]]
        .assert_eq(text);
    }

    #[test]
    fn every_setting_offered_is_valid() {
        for table in ["", "[severity]\n", "[inlay-hints]\n"] {
            let offered = toml_completions(
                TomlFile::Settings,
                table,
                u32::try_from(table.len()).unwrap(),
                CompletionTrigger::Invoked,
            );
            for key in offered.into_iter().filter(|key| !key.label.starts_with('[')) {
                let key = format!("{table}{}", key.insert.replace("\"$0\"", "").replace("$0", ""));
                let values = toml_completions(
                    TomlFile::Settings,
                    &key,
                    u32::try_from(key.len()).unwrap(),
                    CompletionTrigger::Invoked,
                );
                assert!(!values.is_empty(), "{key}");
                for value in values {
                    let text = format!("{key}{}", value.insert);
                    assert_eq!(Config::from_toml(&text).1, [], "{text}");
                }
            }
        }
    }

    #[test]
    fn tables_with_names_of_the_program() {
        check_scene(
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
                [robots.rover.wheels.a] | a table | "[robots.rover.wheels.a]\n$0"
                [robots.rover.wheels.b] | a table | "[robots.rover.wheels.b]\n$0"
                [robots."größe".wheels.a] | a table | "[robots.\"größe\".wheels.a]\n$0"
                [robots."größe".wheels.b] | a table | "[robots.\"größe\".wheels.b]\n$0"
                [robots.rover.sensors.front] | a table | "[robots.rover.sensors.front]\n$0"
                [robots.rover.sensors.back] | a table | "[robots.rover.sensors.back]\n$0"
                [robots.rover.ros2] | a table | "[robots.rover.ros2]\n$0"
                [robots."größe".ros2] | a table | "[robots.\"größe\".ros2]\n$0"
            "#]],
        );
        check_scene(
            "[$0\n[world]\n[robots.rover.sensors.back]",
            &expect![[r#"
                noise | a table | "noise]"
                wall | a table | "[wall]]"
                box | a table | "[box]]"
                cylinder | a table | "[cylinder]]"
                polygon | a table | "[polygon]]"
                robots.rover | a table | "robots.rover]"
                robots."größe" | a table | "robots.\"größe\"]"
                robots.rover.wheels.a | a table | "robots.rover.wheels.a]"
                robots.rover.wheels.b | a table | "robots.rover.wheels.b]"
                robots."größe".wheels.a | a table | "robots.\"größe\".wheels.a]"
                robots."größe".wheels.b | a table | "robots.\"größe\".wheels.b]"
                robots.rover.sensors.front | a table | "robots.rover.sensors.front]"
                robots.rover.ros2 | a table | "robots.rover.ros2]"
                robots."größe".ros2 | a table | "robots.\"größe\".ros2]"
            "#]],
        );
        check_scene(
            "[box$0]",
            &expect![[r#"
            box | a table | "[box]"
        "#]],
        );
        check_scene(
            "[[$0]]\n[[box]]",
            &expect![[r#"
            wall | a table | "wall"
            box | a table | "box"
            cylinder | a table | "cylinder"
            polygon | a table | "polygon"
        "#]],
        );
        check_scene(
            "[robots.$0\n[robots.rover]",
            &expect![[r#"
                "größe" | a table | "\"größe\"]"
                rover.wheels.a | a table | "rover.wheels.a]"
                rover.wheels.b | a table | "rover.wheels.b]"
                "größe".wheels.a | a table | "\"größe\".wheels.a]"
                "größe".wheels.b | a table | "\"größe\".wheels.b]"
                rover.sensors.front | a table | "rover.sensors.front]"
                rover.sensors.back | a table | "rover.sensors.back]"
                rover.ros2 | a table | "rover.ros2]"
                "größe".ros2 | a table | "\"größe\".ros2]"
            "#]],
        );
        check_scene(
            "[robots.rover.sensors.$0]",
            &expect![[r#"
            front | a table | "front"
            back | a table | "back"
        "#]],
        );
        check_scene(
            "[robots.ro$0ver.sensors.front]",
            &expect![[r#"
            rover | a table | "rover"
        "#]],
        );
        check_scene(
            "robots.$0",
            &expect![[r#"
            rover. | a table | "rover."
            "größe". | a table | "\"größe\"."
        "#]],
        );
    }

    #[test]
    fn keys_of_scenes_that_are_not_there() {
        check_scene(
            "[[box]]\nsize = [1, 1]\n[[box]]\nat = [1, 1]\n$0",
            &expect![[r#"
                size | required | "size = $0"
                heading | default: 0 | "heading = $0"
                height | default: 0.5 | "height = $0"
                path | default: it does not move | "path = $0"
                repeat | default: false | "repeat = $0"
                name | default: the table's name and a number: box_1 | "name = \"$0\""
                [world] | a table | "[world]\n$0"
                [noise] | a table | "[noise]\n$0"
                [[wall]] | a table | "[[wall]]\n$0"
                [[box]] | a table | "[[box]]\n$0"
                [[cylinder]] | a table | "[[cylinder]]\n$0"
                [[polygon]] | a table | "[[polygon]]\n$0"
                [robots.rover] | a table | "[robots.rover]\n$0"
                [robots."größe"] | a table | "[robots.\"größe\"]\n$0"
                [robots.rover.wheels.a] | a table | "[robots.rover.wheels.a]\n$0"
                [robots.rover.wheels.b] | a table | "[robots.rover.wheels.b]\n$0"
                [robots."größe".wheels.a] | a table | "[robots.\"größe\".wheels.a]\n$0"
                [robots."größe".wheels.b] | a table | "[robots.\"größe\".wheels.b]\n$0"
                [robots.rover.sensors.front] | a table | "[robots.rover.sensors.front]\n$0"
                [robots.rover.sensors.back] | a table | "[robots.rover.sensors.back]\n$0"
                [robots.rover.ros2] | a table | "[robots.rover.ros2]\n$0"
                [robots."größe".ros2] | a table | "[robots.\"größe\".ros2]\n$0"
            "#]],
        );
        check_scene(
            "[robots.rover]\nrim$0",
            &expect![[r#"
                rim-speed | default: unlimited | "rim-speed = $0"
                rim-acceleration | default: 1.0 | "rim-acceleration = $0"
            "#]],
        );
        check_scene(
            "[robots.rover.sensors.front]\nco$0ne = 1",
            &expect![[r#"
            cone | default: 20 | "cone"
        "#]],
        );
        check_scene(
            "world = { s$0 }",
            &expect![[r#"
                size | default: unlimited | "size = $0"
                seed | default: 1 | "seed = $0"
            "#]],
        );
        check_scene(
            "[[polygon]]\ncorners = [\n  [0, 1],\n  [1, 1]\n]\nn$0",
            &expect![[r#"
                name | default: the table's name and a number: box_1 | "name = \"$0\""
                [noise] | a table | "[noise]\n$0"
            "#]],
        );
    }

    #[test]
    fn values_in_scenes() {
        check_scene(
            "[world]\nwalls = $0",
            &expect![[r#"
                true | default | "true"
                false |  | "false"
            "#]],
        );
        check_scene(
            "[[box]]\nat = $0",
            &expect![[r#"
            [1.0, 0.5] | for example | "[1.0, 0.5]"
        "#]],
        );
        check_scene("[[box]]\nfoo = $0", &expect![[r#""#]]);
    }

    #[test]
    fn every_offer_for_a_scene_is_valid() {
        let (database, environment) = program();
        let floor = database.floor(environment.unwrap()).unwrap();
        let at_end = |text: &str| {
            let end = u32::try_from(text.len()).unwrap();
            toml_completions(TomlFile::Scene(&database, environment), text, end, CompletionTrigger::Invoked)
        };
        let tables = at_end("");
        assert_eq!(tables.len(), 6 + 2 * 2 + 4 + 2);
        for table in tables {
            let header = table.insert.replace("$0", "");
            for key in at_end(&header).into_iter().filter(|key| !key.label.starts_with('[')) {
                let key = format!("{header}{}", key.insert.replace("\"$0\"", "").replace("$0", ""));
                let values = at_end(&key);
                assert!(!values.is_empty(), "{key}");
                for value in values {
                    let text = format!("{key}{}", value.insert);
                    let wrong = pydslrep_scene::read(&text, floor.clone()).1;
                    // One key alone may leave out another, or put a robot into a box.
                    let mut wrong = wrong.iter().filter(|problem| {
                        problem.kind != ProblemKind::MissingKey && !problem.message.contains("starts in")
                    });
                    assert_eq!(wrong.next(), None, "{text}");
                }
            }
        }
    }
}
