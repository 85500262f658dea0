//! From a text or a JSON value to a [`Config`].

use pydslrep_analysis::diagnostics::rule;
use pydslrep_schema::{Entry, Node, Value, closest, did_you_mean, from_json};

use crate::keys::{KEYS, Key, parts_behind};
use crate::severities::find_rule;
use crate::values::{self, Refusal, Values};
use crate::{Config, Problem, ProblemKind, SECTION};

/// What extensions of editors keep beside the settings, for themselves.
const KEPT_BY_EDITORS: [&str; 2] = ["server", "trace"];

impl Config {
    /// Reads a `pydslrep.toml`. Of a text that is no TOML nothing holds; else what is fine does, whatever else is not.
    /// Problems are in the order of the text.
    pub fn from_toml(text: &str) -> (Self, Vec<Problem>) {
        match pydslrep_schema::parse(text, "setting") {
            Err(problem) => (Self::default(), vec![problem]),
            Ok(entries) => {
                let mut reader = Reader::new(Spelling::Kebab);
                reader.table("", "", &entries);
                reader.finish()
            }
        }
    }

    /// Reads what an editor says: the settings themselves, or all of them under `pydslrep`. Keys may be written in
    /// kebab or camel case; null is nothing said.
    pub fn from_json(value: &serde_json::Value) -> (Self, Vec<Problem>) {
        let value = value.get(SECTION).unwrap_or(value);
        let mut reader = Reader::new(Spelling::KebabOrCamel);
        match from_json(value) {
            Value::Nothing => {}
            // What Lua makes of an empty table.
            Value::List(items) if items.is_empty() => {}
            Value::Table(mut entries) => {
                entries.retain(|entry| !KEPT_BY_EDITORS.contains(&entry.key.as_str()));
                reader.table("", "", &entries);
            }
            other => reader.problems.push(Problem {
                kind: ProblemKind::InvalidValue,
                key: String::new(),
                span: None,
                message: format!("the settings are a table of keys and values, not {}", other.sort()),
                help: Some(known("")),
                replacement: None,
            }),
        }
        reader.finish()
    }
}

/// How keys may be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Spelling {
    Kebab,
    KebabOrCamel,
}

struct Reader {
    spelling: Spelling,
    config: Config,
    problems: Vec<Problem>,
}

impl Reader {
    fn new(spelling: Spelling) -> Self {
        Self { spelling, config: Config::default(), problems: Vec::new() }
    }

    fn finish(mut self) -> (Config, Vec<Problem>) {
        self.problems.sort_by_key(|problem| problem.span.map(|span| span.start));
        (self.config, self.problems)
    }

    /// Reads a table by its name with a dot behind it, as it is called and as it is written.
    fn table(&mut self, prefix: &str, written_prefix: &str, entries: &[Entry]) {
        for entry in entries {
            let written = format!("{written_prefix}{}", entry.key);
            let name = format!("{prefix}{}", self.kebab(&entry.key));
            let table = format!("{name}.");
            if let Some(key) = KEYS.iter().find(|key| key.name == name) {
                self.value(key, &written, &entry.node);
            } else if !KEYS.iter().any(|key| key.name.starts_with(&table)) {
                self.problems.push(unknown_key(prefix, written, entry));
            } else if let Value::Table(entries) = &entry.node.value {
                self.table(&table, &format!("{written}."), entries);
            } else if let Err(refusal) = values::table(&entry.node.value) {
                let inner = parts_behind(&table).join(", ");
                let help = Some(format!("the keys in it are {inner}"));
                self.refuse(&written, &entry.node, Refusal { help, ..refusal });
            }
        }
    }

    fn value(&mut self, key: &Key, written: &str, node: &Node) {
        if matches!(node.value, Value::Nothing) {
            return;
        }
        if let Err(mut refusal) = (key.set)(&mut self.config, &node.value) {
            refusal.help = refusal.help.or_else(|| Some(example(key)));
            return self.refuse(written, node, refusal);
        }
        if let (Values::Levels, Value::Table(entries)) = (key.values, &node.value) {
            for entry in entries {
                self.level(&format!("{written}.{}", entry.key), entry);
            }
        }
    }

    fn level(&mut self, written: &str, entry: &Entry) {
        match (find_rule(&entry.key), values::level(&entry.node.value)) {
            (Err(unknown), _) => self.problems.push(Problem {
                kind: ProblemKind::UnknownKey,
                key: written.to_owned(),
                span: entry.key_span,
                message: unknown.message,
                help: Some(unknown.help),
                replacement: unknown.near.map(str::to_owned),
            }),
            (Ok(rule), Ok(Some(level))) => self.config.severities.set(rule, level),
            (Ok(_), Ok(None)) => {}
            (Ok(_), Err(refusal)) => self.refuse(written, &entry.node, refusal),
        }
    }

    fn refuse(&mut self, written: &str, node: &Node, refusal: Refusal) {
        self.problems.push(Problem {
            kind: ProblemKind::InvalidValue,
            key: written.to_owned(),
            span: node.span,
            message: format!("`{written}` {}", refusal.message),
            help: refusal.help,
            replacement: refusal.replacement.map(|word| format!("\"{word}\"")),
        });
    }

    fn kebab(&self, key: &str) -> String {
        match self.spelling {
            Spelling::Kebab => key.to_owned(),
            Spelling::KebabOrCamel => kebab(key),
        }
    }
}

fn example(key: &Key) -> String {
    match key.values {
        Values::Levels => "its keys are codes of diagnostics: `pydslrep explain` lists them".to_owned(),
        _ => format!("write for example `{}`", key.example),
    }
}

/// `inlayHints` as `inlay-hints`.
fn kebab(key: &str) -> String {
    let mut out = String::with_capacity(key.len() + 2);
    for c in key.chars() {
        if c.is_ascii_uppercase() {
            out.push('-');
        }
        out.push(c.to_ascii_lowercase());
    }
    out
}

fn unknown_key(prefix: &str, written: String, entry: &Entry) -> Problem {
    let near = closest(&entry.key, parts_behind(prefix));
    let help = match (near, home(&entry.key)) {
        (Some(near), _) => did_you_mean(near),
        (None, Some(home)) => home,
        (None, None) => known(prefix),
    };
    Problem {
        kind: ProblemKind::UnknownKey,
        span: entry.key_span,
        message: format!("there is no setting `{written}`"),
        key: written,
        help: Some(help),
        replacement: near.map(str::to_owned),
    }
}

/// Where a key belongs that is in another table.
fn home(key: &str) -> Option<String> {
    if let Some(rule) = rule(key) {
        return Some(format!("levels of diagnostics are in the table `severity`: `severity.{}`", rule.code));
    }
    let name = KEYS.iter().map(|other| other.name).find(|name| name.rsplit('.').next() == Some(key))?;
    Some(format!("it is written `{name}`"))
}

/// Which keys there are, in words.
fn known(prefix: &str) -> String {
    format!("the keys here are {}", parts_behind(prefix).join(", "))
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};
    use proptest::prelude::*;
    use serde_json::json;

    use super::*;
    use crate::Target;

    fn told(text: Option<&str>, problems: &[Problem]) -> String {
        let mut out = String::new();
        for problem in problems {
            let place = match (text, problem.span) {
                (Some(text), Some(span)) => {
                    let (start, end) = (span.start as usize, span.end as usize);
                    format!("{start} `{}`", &text[start..end])
                }
                _ => format!("at `{}`", problem.key),
            };
            out += &format!("{} {place}: {}\n", problem.kind.code(), problem.message);
            if let Some(help) = &problem.help {
                out += &format!("  help: {help}\n");
            }
            if let Some(replacement) = &problem.replacement {
                out += &format!("  write: {replacement}\n");
            }
        }
        out
    }

    #[track_caller]
    fn toml(text: &str, expected: &Expect) -> Config {
        let (config, problems) = Config::from_toml(text);
        expected.assert_eq(&told(Some(text), &problems));
        config
    }

    #[track_caller]
    fn json(value: &serde_json::Value, expected: &Expect) -> Config {
        let (config, problems) = Config::from_json(value);
        expected.assert_eq(&told(None, &problems));
        config
    }

    #[test]
    fn unknown_keys_are_told_with_what_was_meant() {
        let config = toml(
            "sevrity = 1\npose = true\nwheel-count = \"off\"\n\"機\" = 1\ngenerateOnSave = true\ntarget = \"vrep\"\n\
             [inlay-hints]\ndurations = false\n[severity]\nunused-declarations = \"off\"\nxyz = \"off\"\n[tool.x]\n",
            &expect![[r#"
                unknown-key 0 `sevrity`: there is no setting `sevrity`
                  help: did you mean `severity`?
                  write: severity
                unknown-key 12 `pose`: there is no setting `pose`
                  help: it is written `inlay-hints.pose`
                unknown-key 24 `wheel-count`: there is no setting `wheel-count`
                  help: levels of diagnostics are in the table `severity`: `severity.wheel-count`
                unknown-key 44 `"機"`: there is no setting `機`
                  help: the keys here are target, output, generate-on-save, default-speed, severity, inlay-hints, code-lens
                unknown-key 54 `generateOnSave`: there is no setting `generateOnSave`
                  help: did you mean `generate-on-save`?
                  write: generate-on-save
                unknown-key 106 `durations`: there is no setting `inlay-hints.durations`
                  help: did you mean `duration`?
                  write: duration
                unknown-key 135 `unused-declarations`: there is no diagnostic `unused-declarations`
                  help: did you mean `unused-declaration`?
                  write: unused-declaration
                unknown-key 163 `xyz`: there is no diagnostic `xyz`
                  help: `pydslrep explain` lists them all
                unknown-key 176 `tool`: there is no setting `tool`
                  help: the keys here are target, output, generate-on-save, default-speed, severity, inlay-hints, code-lens
            "#]],
        );
        assert_eq!(config.target, Some(Target::VRep), "what is fine holds");
    }

    #[test]
    fn wrong_values_are_told_with_what_fits() {
        let config = toml(
            "target = 1\noutput = \"\"\ngenerate-on-save = \"yes\"\ndefault-speed = 0\nseverity = \"off\"\ninlay-hints = true\n",
            &expect![[r#"
                invalid-value 9 `1`: `target` must be a text, not a number
                  help: write for example `"vrep"`
                invalid-value 20 `""`: `output` is empty
                  help: name a folder, or leave the key out: scripts are then written beside their programs
                invalid-value 42 `"yes"`: `generate-on-save` must be true or false, not a text
                  help: write for example `true`
                invalid-value 64 `0`: `default-speed` must be a number above zero
                  help: write for example `12.5`
                invalid-value 77 `"off"`: `severity` must be a table, not a text
                  help: its keys are codes of diagnostics: `pydslrep explain` lists them
                invalid-value 97 `true`: `inlay-hints` must be a table, not true or false
                  help: the keys in it are pose, duration, defaults
            "#]],
        );
        assert_eq!(config, Config::default());
        toml(
            "target = \"V-REP\"\ndefault-speed = inf\n[severity]\nwheel-count = \"warn\"\nwheel-order = \"none\"\n\
             mixed-radii = 1979-05-27\nidle-robot = [1]\nslam-robot = {}\n",
            &expect![[r#"
                invalid-value 9 `"V-REP"`: `target` cannot be `V-REP`
                  help: did you mean `vrep`?
                  write: "vrep"
                invalid-value 33 `inf`: `default-speed` must be a number above zero
                  help: write for example `12.5`
                invalid-value 62 `"warn"`: `severity.wheel-count` cannot be `warn`
                  help: did you mean `warning`?
                  write: "warning"
                invalid-value 83 `"none"`: `severity.wheel-order` cannot be `none`
                  help: the levels are off, hint, information, warning, error
                invalid-value 104 `1979-05-27`: `severity.mixed-radii` must be a text, not a date or time
                  help: write for example `"off"`
                invalid-value 128 `[1]`: `severity.idle-robot` must be a text, not a list
                  help: write for example `"off"`
                invalid-value 145 `{}`: `severity.slam-robot` must be a text, not a table
                  help: write for example `"off"`
            "#]],
        );
    }

    #[test]
    fn no_toml_is_told_once_and_nothing_of_it_holds() {
        for (text, expected) in [
            (
                "target",
                expect![[r#"
                invalid-toml 6 ``: there is no `=` behind the key
                  help: a setting is written `KEY = VALUE`
            "#]],
            ),
            (
                "output = scripts\ngenerate-on-save = true",
                expect![[r#"
                invalid-toml 9 `scripts`: `scripts` is no value
                  help: texts stand in quotes: `"scripts"`
            "#]],
            ),
            (
                "generate-on-save = ",
                expect![[r#"
                invalid-toml 19 ``: the value is missing
                  help: a setting is written `KEY = VALUE`
            "#]],
            ),
            (
                "output = \"a\n[severity]",
                expect![[r#"
                invalid-toml 11 ``: the text does not end on its line
                  help: close it by `"`
            "#]],
            ),
            (
                "[severity\n",
                expect![[r#"
                invalid-toml 9 ``: `]` is missing
                  help: a table begins with `[NAME]`
            "#]],
            ),
            (
                "output = 'a'\noutput = 'b'",
                expect![[r#"
                invalid-toml 13 `output`: `output` is set twice
                  help: leave one of them out
            "#]],
            ),
            (
                "a = [1,",
                expect![[r#"
                invalid-toml 7 ``: this is no TOML: unclosed array
                  help: expected: `]`
            "#]],
            ),
        ] {
            assert_eq!(toml(text, &expected), Config::default(), "{text}");
        }
    }

    #[test]
    fn editors_say_the_same_in_either_case() {
        let inner = json!({
            "target": "vrep", "generateOnSave": true, "default-speed": 12, "output": null, "severity": {"wheel-count": "off", "wheel-order": null},
            "inlayHints": {"pose": false}, "trace": {"server": "verbose"}, "server": {"path": "x"},
        });
        let config = json(&inner, &expect![[""]]);
        let (same, _) = Config::from_toml(
            "target = \"vrep\"\ngenerate-on-save = true\ndefault-speed = 12\ninlay-hints.pose = false\nseverity.wheel-count = \"off\"",
        );
        assert_eq!(config, same);
        assert_eq!(Config::from_json(&json!({ "pydslrep": inner, "editor": {} })).0, same);
        assert_eq!(Config::from_json(&json!(null)), (Config::default(), vec![]));
        // Lua knows no empty table.
        assert_eq!(Config::from_json(&json!([])), (Config::default(), vec![]));
        assert_eq!(Config::from_json(&json!({"severity": [], "target": "vrep"})).1, vec![]);
    }

    #[test]
    fn what_editors_say_wrong_is_told_by_its_key() {
        json(
            &json!({"inlayHints": {"poses": 1, "pose": "x"}, "severity": {"wheelCount": "off", "wheel-order": 1}, "x": {}}),
            &expect![[r#"
                invalid-value at `inlayHints.pose`: `inlayHints.pose` must be true or false, not a text
                  help: write for example `false`
                unknown-key at `inlayHints.poses`: there is no setting `inlayHints.poses`
                  help: did you mean `pose`?
                  write: pose
                invalid-value at `severity.wheel-order`: `severity.wheel-order` must be a text, not a number
                  help: write for example `"off"`
                unknown-key at `severity.wheelCount`: there is no diagnostic `wheelCount`
                  help: did you mean `wheel-count`?
                  write: wheel-count
                unknown-key at `x`: there is no setting `x`
                  help: the keys here are target, output, generate-on-save, default-speed, severity, inlay-hints, code-lens
            "#]],
        );
        json(
            &json!(["vrep"]),
            &expect![[r#"
                invalid-value at ``: the settings are a table of keys and values, not a list
                  help: the keys here are target, output, generate-on-save, default-speed, severity, inlay-hints, code-lens
            "#]],
        );
    }

    /// Texts that are nearly settings.
    fn nearly() -> impl Strategy<Value = String> {
        let piece = prop_oneof![
            3 => proptest::sample::select(vec![
                "target", "output", "severity", "inlay-hints", "default-speed", "wheel-count", "pose", "=", " = ", "\n",
                "\r\n", "\r", "[", "]", "[[", "]]", "{", "}", ".", ",", "\"", "'", "\"\"\"", "\"off\"", "true", "0x7f", "1e400",
                "-0.0", "nan", "1979-05-27", "\\u", "# ", "\u{feff}", "機", "\0",
            ]).prop_map(str::to_owned),
            1 => any::<char>().prop_map(String::from),
        ];
        proptest::collection::vec(piece, 0..24).prop_map(|pieces| pieces.concat())
    }

    proptest! {
        #[test]
        fn any_text_is_read(text in nearly()) {
            let (_, problems) = Config::from_toml(&text);
            for problem in problems {
                let span = problem.span.unwrap();
                prop_assert!(text.get(span.start as usize..span.end as usize).is_some(), "{problem:?}");
                prop_assert!(!problem.message.is_empty());
            }
        }
    }

    #[test]
    fn deep_texts_and_values_are_read() {
        for text in
            ["a.".repeat(100_000) + "b = 1", "[".repeat(100_000), format!("a = {}", "{a=".repeat(100_000))]
        {
            assert_eq!(Config::from_toml(&text).1.len(), 1);
        }
        let deep = (0..1000).fold(json!(1), |value, _| json!({ "severity": value }));
        assert_eq!(Config::from_json(&deep).1.len(), 1);
    }
}
