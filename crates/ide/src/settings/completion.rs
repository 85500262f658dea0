//! Completion in a settings file: keys of the table at the cursor, and what their values can be.

use pydslrep_analysis::diagnostics::CATALOGUE;
use pydslrep_config::{KEYS, Level, Values, tables};
use pydslrep_schema::{Place, Slot, names, place_at};

use super::{Meaning, documentation, meaning};
use crate::completion::Rank;
use crate::completion::filter::filter_in_toml;
use crate::{Completion, CompletionKind, CompletionTrigger, Documentation};

/// What fits at an offset in the text of a settings file. Keys and tables that are there already do not.
pub fn settings_completions(text: &str, offset: u32, trigger: CompletionTrigger) -> Vec<Completion> {
    let Some(place) = place_at(text, offset).filter(|place| trigger.opens_in_toml(place)) else {
        return Vec::new();
    };
    filter_in_toml(fitting(text, &place), text, offset)
}

fn fitting(text: &str, place: &Place) -> Vec<Completion> {
    let others = names(text).into_iter().filter(|named| named.span != place.word);
    let taken: Vec<String> = others.map(|named| named.name).collect();
    let is_free = |name: &str| !taken.iter().any(|taken| taken == name);
    match &place.slot {
        // No name of a table has several parts.
        Slot::Table { outer, .. } if !outer.is_empty() => Vec::new(),
        Slot::Table { is_closed, .. } => {
            let end = if *is_closed { "" } else { "]" };
            let free = tables().into_iter().filter(|table| is_free(table));
            free.map(|table| setting(place, table, table, format!("{table}{end}"), Rank::Fitting)).collect()
        }
        Slot::Key { table, has_value, begins_line } => {
            let free = keys_in(table).into_iter().filter(|name| is_free(name));
            let mut found: Vec<Completion> = free.map(|name| key(place, table, &name, *has_value)).collect();
            if *begins_line && !has_value {
                let free = tables().into_iter().filter(|table| is_free(table));
                found.extend(free.map(|table| {
                    let header = format!("[{table}]");
                    setting(place, table, &header, format!("{header}\n$0"), Rank::Keyword)
                }));
            }
            found
        }
        Slot::Value { key } => values(place, key),
    }
}

/// The whole names of all keys of a table, which has a dot behind its name.
fn keys_in(table: &str) -> Vec<String> {
    if KEYS.iter().any(|key| key.values == Values::Levels && table.strip_suffix('.') == Some(key.name)) {
        return CATALOGUE.iter().map(|rule| format!("{table}{}", rule.code)).collect();
    }
    let direct = KEYS.iter().filter(|key| key.values != Values::Levels);
    let direct = direct.filter(|key| key.name.strip_prefix(table).is_some_and(|rest| !rest.contains('.')));
    direct.map(|key| key.name.to_owned()).collect()
}

fn key(place: &Place, table: &str, name: &str, has_value: bool) -> Completion {
    let written = name.strip_prefix(table).unwrap_or(name).to_owned();
    let insert = match meaning(name) {
        _ if has_value => written.clone(),
        Some(Meaning::Code(_)) => format!("{written} = \"$0\""),
        Some(Meaning::Key(key)) if matches!(key.values, Values::Words(_) | Values::Folder) => {
            format!("{written} = \"$0\"")
        }
        _ => format!("{written} = $0"),
    };
    setting(place, name, &written, insert, Rank::Fitting)
}

fn setting(place: &Place, name: &str, label: &str, insert: String, rank: Rank) -> Completion {
    let meaning = meaning(name);
    let detail = match &meaning {
        Some(Meaning::Key(key)) if key.values != Values::Levels => {
            format!("default: {}", key.default.replace('`', ""))
        }
        Some(Meaning::Code(rule)) => format!("default: \"{}\"", rule.severity.word()),
        _ => "a table".to_owned(),
    };
    Completion {
        detail,
        documentation: Documentation::Text(meaning.as_ref().map(documentation).unwrap_or_default()),
        is_snippet: insert.contains("$0"),
        insert,
        rank,
        ..Completion::new(label, CompletionKind::Setting, place.word)
    }
}

fn values(place: &Place, key: &str) -> Vec<Completion> {
    let value = |text: String, detail: &str| Completion {
        detail: detail.to_owned(),
        ..Completion::new(&text, CompletionKind::Value, place.word)
    };
    match meaning(key) {
        Some(Meaning::Code(rule)) => Level::ALL
            .iter()
            .map(|level| {
                let is_default = level.severity() == Some(rule.severity);
                value(
                    format!("\"{}\"", level.word()),
                    if is_default { "the default" } else { level.summary() },
                )
            })
            .collect(),
        Some(Meaning::Key(key)) => match key.values {
            Values::Words(words) => {
                words.iter().map(|word| value(format!("\"{}\"", word.word), word.summary)).collect()
            }
            Values::Flag => ["true", "false"]
                .map(|flag| {
                    let is_default = key.default.trim_matches('`') == flag;
                    value(flag.to_owned(), if is_default { "the default" } else { "" })
                })
                .to_vec(),
            Values::AboveZero | Values::Folder => vec![value(key.example.to_owned(), "for example")],
            Values::Levels => Vec::new(),
        },
        Some(Meaning::Table(_)) | None => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};
    use pydslrep_config::Config;

    use super::*;
    use crate::settings::at_cursor;

    /// Those whose label has the word at the cursor in it.
    fn check(fixture: &str, expected: &Expect) {
        let (text, offset) = at_cursor(fixture);
        let mut out = String::new();
        for found in settings_completions(&text, offset, CompletionTrigger::Invoked) {
            out += &format!("{} | {} | {:?}\n", found.label, found.detail, found.insert);
        }
        expected.assert_eq(&out);
    }

    #[test]
    fn keys_of_the_table_that_are_not_there() {
        check(
            "output = 'a'\n$0\n[inlay-hints]\npose = true",
            &expect![[r#"
                target | default: "coppeliasim" | "target = \"$0\""
                generate-on-save | default: false | "generate-on-save = $0"
                default-speed | default: 9.0 | "default-speed = $0"
                [severity] | a table | "[severity]\n$0"
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
    fn codes_below_severity() {
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
    fn values_of_every_kind() {
        check(
            "target = $0",
            &expect![[r#"
            "coppeliasim" | CoppeliaSim 4.6 or later, by its ZeroMQ remote API | "\"coppeliasim\""
            "vrep" | V-REP 3, by its legacy remote API: each robot has a port of its own | "\"vrep\""
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
            true | the default | "true"
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
            "error" | the default | "\"error\""
        "#]],
        );
        check("[severity]\nwheels = $0", &expect![""]);
        check("severity = $0", &expect![""]);
        check("target = 'vrep' $0", &expect![""]);
    }

    #[test]
    fn documentation_says_what_a_key_does() {
        let (text, offset) = at_cursor("tar$0");
        let found = settings_completions(&text, offset, CompletionTrigger::Invoked).remove(0);
        let Documentation::Text(text) = &found.documentation else { panic!("{found:?}") };
        expect![[r#"
            **`target`**: `"coppeliasim"` or `"vrep"`

            The simulator that scripts are for.

            * `"coppeliasim"`: CoppeliaSim 4.6 or later, by its ZeroMQ remote API
            * `"vrep"`: V-REP 3, by its legacy remote API: each robot has a port of its own

            Default: `"coppeliasim"`
        "#]]
        .assert_eq(text);
    }

    /// What is offered is what is read.
    #[test]
    fn every_offer_is_understood() {
        for table in ["", "[severity]\n", "[inlay-hints]\n"] {
            let offered =
                settings_completions(table, u32::try_from(table.len()).unwrap(), CompletionTrigger::Invoked);
            for key in offered.into_iter().filter(|key| !key.label.starts_with('[')) {
                let key = format!("{table}{}", key.insert.replace("\"$0\"", "").replace("$0", ""));
                let values =
                    settings_completions(&key, u32::try_from(key.len()).unwrap(), CompletionTrigger::Invoked);
                assert!(!values.is_empty(), "{key}");
                for value in values {
                    let text = format!("{key}{}", value.insert);
                    assert_eq!(Config::from_toml(&text).1, [], "{text}");
                }
            }
        }
    }
}
