//! The settings from one place.

use std::collections::BTreeMap;

use pydslrep_schema::{Contents, Value};
use serde_json::Value as Json;

use crate::keys::{DEFAULTS, SCHEMA, Settings};
use crate::severities::{self, Level, Severities};
use crate::{Edition, Problem, SECTION, Target};

/// The settings from one place: a file, an editor, or the options of a command.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Config {
    /// By table and key; severities are in `severities`.
    values: BTreeMap<(&'static str, &'static str), Value>,
    /// The severities of diagnostics.
    severities: Severities,
}

/// The keys that extensions of editors keep in the same section for themselves.
const KEPT_BY_EDITORS: [&str; 2] = ["server", "trace"];

impl Config {
    /// Reads a `pydslrep.toml`. What is wrong is left out; if the text is not TOML, everything. Problems are in the order
    /// of the text.
    pub fn from_toml(text: &str) -> (Self, Vec<Problem>) {
        SCHEMA.read(text, None).map_or_else(|problem| (Self::default(), vec![problem]), Self::new)
    }

    /// Reads settings of an editor: ours alone, or all of them with ours under `pydslrep`. Keys may be in kebab or in
    /// camel case; null is the same as nothing.
    pub fn from_json(value: &Json) -> (Self, Vec<Problem>) {
        let mut own = value.get(SECTION).unwrap_or(value).clone();
        if let Json::Object(entries) = &mut own {
            entries.retain(|key, _| !KEPT_BY_EDITORS.contains(&key.as_str()));
        }
        Self::new(SCHEMA.read_json(&own))
    }

    fn new(contents: Contents) -> (Self, Vec<Problem>) {
        let mut config = Self::default();
        for section in &contents.sections {
            for (key, value) in section.values() {
                if section.table.name != severities::TABLE {
                    config.values.insert((section.table.name, key), value.clone());
                } else if let Some(level) = value.text().and_then(|word| Level::from_word(word).ok()) {
                    config.severities.set(key, level);
                }
            }
        }
        (config, contents.problems)
    }

    /// The options of a command that chooses a target.
    pub fn of_target(target: Option<Target>) -> Self {
        let value = target.map(|target| (("", "target"), Value::Text(target.word().to_owned())));
        Self { values: value.into_iter().collect(), ..Self::default() }
    }

    /// The options of a command that chooses an edition.
    pub fn of_edition(edition: Option<Edition>) -> Self {
        let value = edition.map(|edition| (("", "edition"), Value::Text(edition.word().to_owned())));
        Self { values: value.into_iter().collect(), ..Self::default() }
    }

    /// The options of a command that chooses severities.
    pub fn of_severities(severities: Severities) -> Self {
        Self { severities, ..Self::default() }
    }

    /// Returns whether it sets the folder of scripts, which is relative to the place that sets it.
    pub fn sets_output(&self) -> bool {
        self.values.contains_key(&("", "output"))
    }

    /// Both, with `self` over `base`.
    pub fn merged_over(self, base: Self) -> Self {
        let mut values = base.values;
        values.extend(self.values);
        Self { values, severities: self.severities.merged_over(base.severities) }
    }

    /// Returns the settings that apply, with defaults for those that are not set.
    pub fn settings(self) -> Settings {
        Settings::from(&self)
    }

    pub(crate) fn get_or_default(&self, table: &'static str, key: &'static str) -> Option<&Value> {
        self.values.get(&(table, key)).or_else(|| DEFAULTS.values.get(&(table, key)))
    }
}

impl From<&Config> for Severities {
    fn from(config: &Config) -> Self {
        config.severities.clone()
    }
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};
    use proptest::prelude::*;
    use serde_json::json;

    use super::*;

    fn reported(text: Option<&str>, problems: &[Problem]) -> String {
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
        expected.assert_eq(&reported(Some(text), &problems));
        config
    }

    #[track_caller]
    fn json(value: &serde_json::Value, expected: &Expect) -> Config {
        let (config, problems) = Config::from_json(value);
        expected.assert_eq(&reported(None, &problems));
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
                  help: it belongs in the table `inlay-hints`
                unknown-key 24 `wheel-count`: there is no setting `wheel-count`
                  help: it belongs in the table `severity`
                unknown-key 44 `"機"`: there is no setting `機`
                  help: the keys here are target, edition, output, generate-on-save, write-runtime, default-speed, severity, coppeliasim, inlay-hints, code-lens
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
                  help: `pydslrep explain` lists all diagnostics
                unknown-key 176 `tool`: there is no setting `tool`
                  help: the keys here are target, edition, output, generate-on-save, write-runtime, default-speed, severity, coppeliasim, inlay-hints, code-lens
            "#]],
        );
        assert_eq!(config.settings().target, Target::VRep, "the rest applies");
    }

    #[test]
    fn wrong_values_are_told_with_what_fits() {
        let config = toml(
            "target = 1\noutput = \"\"\ngenerate-on-save = \"yes\"\ndefault-speed = 0\nseverity = \"off\"\ninlay-hints = true\n",
            &expect![[r#"
                invalid-value 9 `1`: `target` must be `"coppeliasim"`, `"vrep"` or `"ros2"`, not a number
                  help: write, for example, `"vrep"`
                invalid-value 20 `""`: `output` is empty
                  help: name a folder, or remove the key: scripts are then written beside their programs
                invalid-value 42 `"yes"`: `generate-on-save` must be `true` or `false`, not a string
                  help: write, for example, `true`
                invalid-value 64 `0`: `default-speed` must be a number above zero
                  help: write, for example, `12.5`
                invalid-value 77 `"off"`: `severity` must be a table, not a string
                  help: begin it with `[severity]`
                invalid-value 97 `true`: `inlay-hints` must be a table, not a boolean
                  help: begin it with `[inlay-hints]`
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
                invalid-value 33 `inf`: `default-speed` is not finite
                  help: write, for example, `12.5`
                invalid-value 62 `"warn"`: `severity.wheel-count` cannot be `warn`
                  help: did you mean `warning`?
                  write: "warning"
                invalid-value 83 `"none"`: `severity.wheel-order` cannot be `none`
                  help: use `"off"`, `"hint"`, `"information"`, `"warning"` or `"error"`
                invalid-value 104 `1979-05-27`: `severity.mixed-radii` must be `"off"`, `"hint"`, `"information"`, `"warning"` or `"error"`, not a date or time
                  help: write, for example, `"off"`
                invalid-value 128 `[1]`: `severity.idle-robot` must be `"off"`, `"hint"`, `"information"`, `"warning"` or `"error"`, not a list
                  help: write, for example, `"off"`
                invalid-value 145 `{}`: `severity.slam-robot` must be `"off"`, `"hint"`, `"information"`, `"warning"` or `"error"`, not a table
                  help: write, for example, `"off"`
            "#]],
        );
    }

    #[test]
    fn no_toml_is_told_once_and_nothing_of_it_holds() {
        for (text, expected) in [
            (
                "target",
                expect![[r#"
                    invalid-toml 6 ``: `=` is missing after the key
                      help: a setting is written `KEY = VALUE`
                "#]],
            ),
            (
                "output = scripts\ngenerate-on-save = true",
                expect![[r#"
                    invalid-toml 9 `scripts`: `scripts` is not a value
                      help: strings are in quotes: `"scripts"`
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
                    invalid-toml 11 ``: the string does not end on its line
                      help: close it with `"`
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
                      help: remove one of them
                "#]],
            ),
            (
                "a = [1,",
                expect![[r#"
                    invalid-toml 7 ``: invalid TOML: unclosed array
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
                unknown-key at `x`: there is no setting `x`
                  help: the keys here are target, edition, output, generate-on-save, write-runtime, default-speed, severity, coppeliasim, inlay-hints, code-lens
                invalid-value at `inlayHints.pose`: `inlayHints.pose` must be `true` or `false`, not a string
                  help: write, for example, `false`
                unknown-key at `inlayHints.poses`: there is no setting `inlayHints.poses`
                  help: did you mean `pose`?
                  write: pose
                invalid-value at `severity.wheel-order`: `severity.wheel-order` must be `"off"`, `"hint"`, `"information"`, `"warning"` or `"error"`, not a number
                  help: write, for example, `"off"`
            "#]],
        );
        json(
            &json!(["vrep"]),
            &expect![[r#"
                invalid-value at ``: the settings must be a table, not a list
                  help: the keys here are target, edition, output, generate-on-save, write-runtime, default-speed, severity, coppeliasim, inlay-hints, code-lens
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

    #[test]
    fn the_first_wins_and_the_rest_is_kept() {
        let (base, _) = Config::from_toml(
            "target = \"vrep\"\noutput = \"a\"\n[severity]\nwheel-count = \"off\"\nwheel-order = \"error\"\n\
             [inlay-hints]\npose = false\nduration = false\n[code-lens]\nwheels = true\nrun = false\n",
        );
        let (over, _) = Config::from_toml(
            "target = \"coppeliasim\"\ngenerate-on-save = true\n[severity]\nwheel-order = \"hint\"\n\
             [inlay-hints]\nduration = true\n[code-lens]\nrun = true\nips = false\n",
        );
        let settings = over.merged_over(base).settings();
        assert_eq!((settings.target, settings.output.as_deref()), (Target::CoppeliaSim, Some("a")));
        assert!(settings.generate_on_save);
        assert!((settings.default_speed - 9.0).abs() < 1e-12);
        let hints = settings.inlay_hints;
        assert_eq!((hints.pose, hints.duration, hints.defaults), (false, true, true));
        let lenses = settings.code_lens;
        assert_eq!((lenses.sensors, lenses.ips, lenses.wheels, lenses.run), (false, false, true, true));
        assert_eq!(settings.severities.level("wheel-count"), Some(Level::Off));
        assert_eq!(settings.severities.level("wheel-order"), Some(Level::Hint));
    }
}
