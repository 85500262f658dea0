//! The list of settings.

use std::sync::LazyLock;

use pydslrep_schema::{Key, Range, Schema, Table, TableKind, Value, Values, Word, key};

use crate::severities::{CODES, Severities};
use crate::{Config, Edition, Target, folder, host};

/// All settings.
pub static SCHEMA: Schema = Schema {
    noun: "setting",
    tables: &[
        Table { name: Settings::TABLE, kind: TableKind::Once, summary: "", keys: Settings::KEYS },
        CODES,
        Table {
            name: SimulatorAddress::TABLE,
            kind: TableKind::Once,
            summary: "Where CoppeliaSim runs: for `pydslrep scene`, and for the commands of an editor that build and check \
                      scenes.",
            keys: SimulatorAddress::KEYS,
        },
        Table {
            name: InlayHints::TABLE,
            kind: TableKind::Once,
            summary: "What an editor shows between the words of a program.",
            keys: InlayHints::KEYS,
        },
        Table {
            name: CodeLens::TABLE,
            kind: TableKind::Once,
            summary: "What an editor shows above declarations.",
            keys: CodeLens::KEYS,
        },
    ],
    largest: f64::MAX,
    too_large: "is not finite",
};

/// Declares the settings of a table: a struct of their values, and the list of keys that they are read from. The
/// documentation of a field is the summary of its key.
macro_rules! settings {
    (
        $(#[$about:meta])*
        struct $name:ident in $table:literal {
            $($(#[doc = $summary:literal])+ $field:ident: $type:ty = $key:expr,)*
        }
        $($(#[$part_about:meta])+ $part:ident: $part_type:ty,)*
    ) => {
        $(#[$about])*
        #[derive(Debug, Clone, PartialEq)]
        pub struct $name {
            $($(#[doc = $summary])+ pub $field: $type,)*
            $($(#[$part_about])+ pub $part: $part_type,)*
        }

        impl $name {
            const TABLE: &'static str = $table;
            const KEYS: &'static [Key] = &[$($key.summary(concat!($($summary),+).trim_ascii())),*];
        }

        impl From<&Config> for $name {
            fn from(config: &Config) -> Self {
                Self {
                    $($field: Setting::read(config.get_or_default($table, $key.name)),)*
                    $($part: <$part_type>::from(config),)*
                }
            }
        }
    };
}

settings! {
    /// The settings that apply to a program.
    struct Settings in "" {
        /// The simulator that scripts are for.
        target: Target = key("target", Values::Words(&TARGETS), "").default("`\"coppeliasim\"`").example("\"vrep\""),
        /// Which statements a program may have: those of the article are a part of what this version has.
        edition: Edition = key("edition", Values::Words(&EDITIONS), "").default("`\"current\"`").example("\"article\""),
        /// The folder that scripts are written to, relative to the folder of this file and inside of it; created if
        /// missing.
        output: Option<String> = key("output", folder::FOLDER, "").default("beside each program").example("\"scripts\""),
        /// Whether an editor writes the scripts of a program whenever it is saved without errors.
        generate_on_save: bool = flag("generate-on-save", false),
        /// Whether the Python package that scripts import, `pydslrep_runtime`, is written next to them if it is not
        /// installed.
        write_runtime: bool = flag("write-runtime", true),
        /// The speed in snippets that an editor inserts, in centimetres per second.
        default_speed: f64 = key("default-speed", Values::ABOVE_ZERO, "").default("`9.0`").example("12.5"),
    }
    /// The severities of diagnostics that differ from the catalogue.
    severities: Severities,
    /// Where CoppeliaSim runs.
    coppeliasim: SimulatorAddress,
    /// The hints that an editor shows between the words of a program.
    inlay_hints: InlayHints,
    /// The commands and counts that an editor shows above declarations.
    code_lens: CodeLens,
}

settings! {
    /// The address of a running `CoppeliaSim`.
    struct SimulatorAddress in "coppeliasim" {
        /// The name or address of the machine that CoppeliaSim runs on.
        host: String = key("host", host::HOST, "").default("`\"127.0.0.1\"`").example("\"192.168.0.7\""),
        /// The port of CoppeliaSim's ZeroMQ remote API.
        port: u16 = key("port", PORT, "").default("`23000`").example("23010"),
    }
}

settings! {
    /// Which inlay hints are shown.
    struct InlayHints in "inlay-hints" {
        /// Whether an editor shows the pose after each action, relative to the start of its movement: x and y in metres,
        /// and the heading.
        pose: bool = flag("pose", true),
        /// Whether an editor shows how long each action takes.
        duration: bool = flag("duration", true),
        /// Whether an editor shows speeds and angles that are left out.
        defaults: bool = flag("defaults", true),
    }
}

settings! {
    /// Which code lenses are shown.
    struct CodeLens in "code-lens" {
        /// Whether an editor shows *Generate script* above an environment.
        generate_script: bool = flag("generate-script", true),
        /// Whether an editor shows *Run* above an environment.
        run: bool = flag("run", true),
        /// Whether an editor shows *Preview* above an environment.
        preview: bool = flag("preview", true),
        // Kinds with many declarations, each used once, would fill the screen.
        /// Whether an editor shows above a wheel how often it is used.
        wheels: bool = flag("wheels", false),
        /// Whether an editor shows above a sensor how often it is used.
        sensors: bool = flag("sensors", false),
        /// Whether an editor shows above an `ip` how often it is used.
        ips: bool = flag("ips", true),
        /// Whether an editor shows above a robot how often it is used.
        robots: bool = flag("robots", true),
        /// Whether an editor shows above a movement how often it is used.
        movements: bool = flag("movements", true),
    }
}

impl Default for Settings {
    fn default() -> Self {
        Config::default().settings()
    }
}

const TARGETS: [Word; Target::ALL.len()] = {
    let [first, second, third] = Target::ALL;
    [
        Word { word: first.word(), summary: first.summary() },
        Word { word: second.word(), summary: second.summary() },
        Word { word: third.word(), summary: third.summary() },
    ]
};

const EDITIONS: [Word; Edition::ALL.len()] = {
    let [first, second] = Edition::ALL;
    [
        Word { word: first.word(), summary: first.summary() },
        Word { word: second.word(), summary: second.summary() },
    ]
};

const PORT: Values = Values::Number(
    "a whole number from 1 to 65535",
    Range { min: 1.0, max: 65535.0, is_whole: true, ..Range::ANY },
);

const fn flag(name: &'static str, default: bool) -> Key {
    let (default, example) = if default { ("`true`", "false") } else { ("`false`", "true") };
    key(name, Values::Flag, "").default(default).example(example)
}

/// The value of a setting, from what the reader let pass.
trait Setting {
    /// `None` if it is not set and has no default.
    fn read(value: Option<&Value>) -> Self;
}

impl Setting for bool {
    fn read(value: Option<&Value>) -> Self {
        value.and_then(Value::flag).unwrap_or_default()
    }
}

impl Setting for f64 {
    fn read(value: Option<&Value>) -> Self {
        value.and_then(Value::number).unwrap_or_default()
    }
}

impl Setting for u16 {
    // The reader lets whole numbers of this size pass.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn read(value: Option<&Value>) -> Self {
        value.and_then(Value::number).unwrap_or_default() as Self
    }
}

impl Setting for String {
    fn read(value: Option<&Value>) -> Self {
        value.and_then(Value::text).unwrap_or_default().to_owned()
    }
}

impl Setting for Option<String> {
    fn read(value: Option<&Value>) -> Self {
        value.and_then(Value::text).map(str::to_owned)
    }
}

impl Setting for Target {
    fn read(value: Option<&Value>) -> Self {
        value.and_then(Value::text).and_then(Self::from_word).unwrap_or_default()
    }
}

impl Setting for Edition {
    fn read(value: Option<&Value>) -> Self {
        value.and_then(Value::text).and_then(Self::from_word).unwrap_or_default()
    }
}

/// All defaults that are values.
pub(crate) static DEFAULTS: LazyLock<Config> = LazyLock::new(|| {
    let defaults = SCHEMA.tables.iter().filter(|table| table.name != CODES.name).map(|table| {
        let line = |key: &Key| key.default_value().map(|value| format!("{} = {value}\n", key.name));
        let lines: String = table.keys.iter().filter_map(line).collect();
        if table.name.is_empty() { lines } else { format!("[{}]\n{lines}", table.name) }
    });
    Config::from_toml(&defaults.collect::<String>()).0
});

#[cfg(test)]
mod tests {
    use pydslrep_kinematics::motion::RIM_SPEED;
    use pydslrep_schema::NAME;

    use super::*;

    fn keys() -> impl Iterator<Item = (&'static Table, &'static Key)> {
        SCHEMA.tables.iter().flat_map(|table| table.keys.iter().map(move |key| (table, key)))
    }

    fn read(table: &Table, key: &Key, value: &str) -> Config {
        let header = if table.name.is_empty() { String::new() } else { format!("[{}]\n", table.name) };
        let (config, problems) = Config::from_toml(&format!("{header}{} = {value}\n", key.name));
        assert_eq!(problems, [], "{} in {}", key.name, table.name);
        config
    }

    #[test]
    fn examples_are_not_the_default() {
        for (table, key) in keys() {
            assert_ne!(read(table, key, key.example).settings(), Settings::default(), "{}", key.name);
        }
    }

    #[test]
    fn defaults_are_values_and_have_no_effect() {
        for (table, key) in keys().filter(|(table, key)| table.name != CODES.name && key.name != "output") {
            let config = read(table, key, key.default_value().unwrap());
            assert_ne!(config, Config::default(), "{}", key.name);
            assert_eq!(config.settings(), Settings::default(), "{}", key.name);
        }
    }

    #[test]
    fn the_default_speed_is_that_of_scripts() {
        assert!((Settings::default().default_speed - RIM_SPEED * 100.0).abs() < 1e-12);
    }

    #[test]
    fn every_table_is_in_the_list_once() {
        let names: Vec<&str> = SCHEMA.tables.iter().map(|table| table.name).collect();
        assert_eq!(names, ["", "severity", "coppeliasim", "inlay-hints", "code-lens"]);
        assert!(!names.contains(&NAME));
    }
}
