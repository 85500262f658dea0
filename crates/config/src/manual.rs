//! What is published of the settings: the page of documentation and the JSON schema, both made from [`KEYS`].

use pydslrep_analysis::diagnostics::CATALOGUE;
use serde_json::{Map, Value, json};

use crate::keys::{KEYS, Key};
use crate::{FILE_NAME, Level, Values};

/// The page of documentation, in Markdown.
pub fn manual() -> String {
    let mut out = format!(
        "# Configuration\n\n\
        A file `{FILE_NAME}` sets how the programs in its folder, and in all folders below, are checked and built. The nearest\n\
        one above a program counts. Its folder is also the one that imports cannot leave. Nothing in it is required:\n\n\
        ```toml\n{EXAMPLE}```\n\n\
        Options of a command win over the file. Editors can say the same in their own settings, under `pydslrep`, which win\n\
        over the file too; there, keys may also be written like `generateOnSave`. What is misspelt or has a wrong value is\n\
        reported, with the place; the rest still holds in an editor, while the command stops with exit code 2.\n\n\
        Editors that know JSON schemas complete and check the file by [pydslrep.schema.json](../editors/pydslrep.schema.json).\n\n\
        | key | value | default |\n|---|---|---|\n"
    );
    for key in &KEYS {
        out += &format!(
            "| [`{}`](#{}) | {} | {} |\n",
            key.name,
            anchor(key.name),
            values(key.values),
            key.default
        );
    }
    for key in &KEYS {
        out += &format!("\n## {}\n\n{}", key.name, description(key));
    }
    out
}

/// What a setting does and can be, in Markdown.
fn description(key: &Key) -> String {
    let mut out = format!("{}\n", key.summary);
    if let Values::Words(words) = key.values {
        out.push('\n');
        for word in words {
            out += &format!("* `\"{}\"`: {}\n", word.word, word.summary);
        }
    }
    out
}

impl Key {
    /// What an editor shows of the setting, in Markdown.
    pub fn markdown(&self) -> String {
        let default = match self.values {
            // What it says leads to another page of the documentation.
            Values::Levels => String::new(),
            _ => format!("\nDefault: {}\n", self.default),
        };
        format!("**`{}`**: {}\n\n{}{default}", self.name, values(self.values), description(self))
    }
}

const EXAMPLE: &str = "\
output = \"scripts\"
generate-on-save = true

[severity]
unused-declaration = \"off\"
wheel-order = \"warning\"

[inlay-hints]
duration = false
";

/// The anchor of a heading, as it is made on the usual sites.
fn anchor(heading: &str) -> String {
    heading.chars().filter(|c| *c != '.').collect()
}

fn values(values: Values) -> String {
    match values {
        Values::Words(words) => {
            let words: Vec<String> = words.iter().map(|word| format!("`\"{}\"`", word.word)).collect();
            words.join(" or ")
        }
        Values::Flag => "`true` or `false`".to_owned(),
        Values::AboveZero => "a number above zero".to_owned(),
        Values::Folder => "a folder".to_owned(),
        Values::Levels => "a table: `CODE = \"LEVEL\"`".to_owned(),
    }
}

/// The JSON schema of the file, for editors that check TOML by one.
pub fn json_schema() -> Value {
    let mut properties = Map::new();
    for key in &KEYS {
        match key.name.split_once('.') {
            None => {
                properties.insert(key.name.to_owned(), property(key));
            }
            Some((table, name)) => {
                let table = properties.entry(table).or_insert_with(|| object(&Map::new()));
                table["properties"][name] = property(key);
            }
        }
    }
    let mut schema = object(&properties);
    schema["$schema"] = json!("http://json-schema.org/draft-07/schema#");
    schema["title"] = json!(FILE_NAME);
    schema["description"] = json!("How the programs of a folder are checked and built by PyDSLRep.");
    schema
}

fn object(properties: &Map<String, Value>) -> Value {
    json!({ "type": "object", "additionalProperties": false, "properties": properties })
}

fn property(key: &Key) -> Value {
    let mut property = match key.values {
        Values::Words(words) => {
            json!({ "enum": words.iter().map(|word| word.word).collect::<Vec<_>>() })
        }
        Values::Flag => json!({ "type": "boolean" }),
        Values::AboveZero => json!({ "type": "number", "exclusiveMinimum": 0 }),
        Values::Folder => json!({ "type": "string", "pattern": r"\S" }),
        Values::Levels => levels(),
    };
    property["description"] = json!(key.summary);
    if let Ok(default) = serde_json::from_str::<Value>(key.default.trim_matches('`')) {
        property["default"] = default;
    }
    property
}

fn levels() -> Value {
    let levels = Level::ALL.map(Level::word);
    let code = |rule: &&pydslrep_analysis::diagnostics::Rule| {
        let property =
            json!({ "enum": levels, "description": rule.summary, "default": rule.severity.word() });
        (rule.code.to_owned(), property)
    };
    object(&CATALOGUE.iter().map(code).collect())
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use expect_test::expect_file;

    use super::*;
    use crate::Config;

    #[test]
    fn what_is_published_is_what_is_read() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        expect_file![root.join("docs/configuration.md")].assert_eq(&manual());
        let schema = serde_json::to_string_pretty(&json_schema()).unwrap() + "\n";
        expect_file![root.join("editors/pydslrep.schema.json")].assert_eq(&schema);
    }

    #[test]
    fn the_example_is_fine() {
        let (config, problems) = Config::from_toml(EXAMPLE);
        assert_eq!((config.output.as_deref(), problems), (Some("scripts"), vec![]));
    }
}
