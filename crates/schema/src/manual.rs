//! Publications of a list of keys: the pages of the documentation, the JSON schema, and the texts that an editor shows.

use serde_json::{Value, json};

use crate::keys::{Key, NAME, Schema, Table, TableKind, dotted};
use crate::values::Values;

impl Schema {
    /// A section for each table with a row for each key, in Markdown.
    pub fn page_of_tables(&self) -> String {
        let mut out = String::new();
        for table in self.tables {
            let header = table.header(table.name);
            out += &format!(
                "\n## {header}\n\n{}\n\n| key | value | default | |\n|---|---|---|---|\n",
                table.summary
            );
            for key in table.keys {
                let default = key.requirement().unwrap_or_else(|| key.default.to_owned());
                out +=
                    &format!("| `{}` | {} | {default} | {} |\n", key.name, key.values.words(), key.summary);
            }
        }
        out
    }

    /// A row and a section for each key, in Markdown.
    pub fn page_of_keys(&self) -> String {
        let mut rows = "| key | value | default |\n|---|---|---|\n".to_owned();
        let mut sections = String::new();
        let mut add = |name: &str, words: &str, default: &str, description: &str| {
            // As the usual sites make it of a heading.
            let anchor = name.replace('.', "");
            rows += &format!("| [`{name}`](#{anchor}) | {words} | {default} |\n");
            sections += &format!("\n## {name}\n\n{description}");
        };
        for table in self.tables {
            if let TableKind::Catalogue { words, default, .. } = table.kind {
                add(table.name, words, default, &format!("{}\n", table.summary));
                continue;
            }
            for key in table.keys {
                add(&dotted(table.name, key.name), &key.values.words(), key.default, &key.description());
            }
        }
        rows + &sections
    }

    /// The JSON schema, for editors that check TOML by one.
    pub fn json_schema(&self, title: &str, description: &str) -> Value {
        let mut schema = json!({
            "$schema": "http://json-schema.org/draft-07/schema#",
            "title": title, "description": description, "type": "object", "additionalProperties": false,
        });
        for table in self.tables {
            let mut at = &mut schema;
            for part in table.parts() {
                at = if part == NAME { &mut at["additionalProperties"] } else { &mut at["properties"][part] };
                if !at.is_object() {
                    *at = json!({ "type": "object", "additionalProperties": false });
                }
            }
            table.add_to(at);
        }
        schema
    }
}

impl Table {
    /// Returns the text that an editor shows for it, in Markdown.
    pub fn markdown(&self) -> String {
        let (header, summary) = (self.header(self.name), self.summary);
        let lines = self.keys.iter().map(|key| format!("* `{}`: {}\n", key.name, key.summary));
        let keys = match self.kind {
            TableKind::Catalogue { help, .. } => format!("{help}\n"),
            _ => lines.collect(),
        };
        format!("**`{header}`**\n\n{summary}\n\n{keys}")
    }

    /// Adds its keys to the schema of an object.
    fn add_to(&self, object: &mut Value) {
        for key in self.keys {
            object["properties"][key.name] = key.json_schema();
        }
        let always = self.keys.iter().filter(|key| key.required && key.unless.is_none());
        let required: Vec<&str> = always.map(|key| key.name).collect();
        if !required.is_empty() {
            object["required"] = json!(required);
        }
        for (key, other) in self.keys.iter().filter_map(|key| Some((key, key.unless?))) {
            object["anyOf"] = json!([{ "required": [key.name] }, { "required": [other] }]);
        }
        if self.kind == TableKind::Each {
            *object = json!({ "type": "array", "items": object.take() });
        }
        if !self.summary.is_empty() {
            object["description"] = json!(self.summary);
        }
    }
}

impl Key {
    /// Returns the text that an editor shows for it, in Markdown.
    pub fn markdown(&self) -> String {
        let default = match self.requirement() {
            Some(required) => required.replacen('r', "R", 1),
            None => format!("Default: {}", self.default),
        };
        // The values of the others are listed above.
        let example = match self.values {
            Values::Flag | Values::Words(_) => String::new(),
            _ => format!("\nFor example `{} = {}`\n", self.name, self.example),
        };
        let (name, words) = (self.name, self.values.words());
        format!("**`{name}`**: {words}\n\n{}\n{default}\n{example}", self.description())
    }

    /// Returns a description of it and of its values.
    fn description(&self) -> String {
        let mut out = format!("{}\n", self.summary);
        if let Values::Words(words) = self.values {
            let lines = words.iter().map(|word| format!("* `\"{}\"`: {}\n", word.word, word.summary));
            out += &format!("\n{}", lines.collect::<String>());
        }
        out
    }

    fn json_schema(&self) -> Value {
        let mut schema = self.values.json_schema();
        schema["description"] = json!(self.summary);
        if let Some(default) =
            self.default_value().and_then(|value| serde_json::from_str::<Value>(value).ok())
        {
            schema["default"] = default;
        }
        schema
    }
}
