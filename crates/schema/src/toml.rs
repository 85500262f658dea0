//! Values that TOML and JSON have in common, and how they are read.

use pydslrep_text::Span;
use toml::Spanned;
use toml::de::{DeFloat, DeInteger, DeTable, DeValue, Error};

use crate::{Problem, ProblemKind};

/// The maximum depth of nested keys; deeper ones are ignored.
const MAX_DEPTH: usize = 8;

/// A value and where it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// The value.
    pub value: Value,
    /// Where it is; `None` in JSON.
    pub span: Option<Span>,
}

/// A value.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A string, without its quotes.
    Text(String),
    /// A number; NaN if it is out of range.
    Number(f64),
    /// True or false.
    Flag(bool),
    /// A table, in the order of the text.
    Table(Vec<Entry>),
    /// A list.
    List(Vec<Node>),
    /// A date or a time.
    Date,
    /// Null.
    Nothing,
}

/// A key with its value.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// The key alone, without the tables it is in.
    pub key: String,
    /// Where the key is; `None` in JSON.
    pub key_span: Option<Span>,
    /// Its value.
    pub node: Node,
}

impl Value {
    /// The boolean.
    pub fn flag(&self) -> Option<bool> {
        if let Self::Flag(flag) = self { Some(*flag) } else { None }
    }

    /// The number.
    pub fn number(&self) -> Option<f64> {
        if let Self::Number(number) = self { Some(*number) } else { None }
    }

    /// The string.
    pub fn text(&self) -> Option<&str> {
        if let Self::Text(text) = self { Some(text) } else { None }
    }

    /// Its kind, in words.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::Text(_) => "a string",
            Self::Number(_) => "a number",
            Self::Flag(_) => "a boolean",
            Self::Table(_) => "a table",
            Self::List(_) => "a list",
            Self::Date => "a date or time",
            Self::Nothing => "null",
        }
    }
}

/// The entries of a TOML document, in the order of the text.
///
/// # Errors
/// If the text is not TOML; `noun` is what the message calls an entry of the file.
pub(crate) fn parse(text: &str, noun: &str) -> Result<Vec<Entry>, Problem> {
    let (table, errors) = DeTable::parse_recoverable(text);
    // One mistake causes several errors, and only the first is about the mistake.
    match errors.iter().min_by_key(|error| error.span().map(|span| span.start)) {
        Some(error) => Err(invalid_toml(text, noun, error)),
        None => Ok(toml_entries(table.get_ref(), 0)),
    }
}

fn toml_entries(table: &DeTable<'_>, depth: usize) -> Vec<Entry> {
    let entry = |(key, value): (&Spanned<_>, &Spanned<DeValue<'_>>)| Entry {
        key: String::from(std::borrow::Cow::as_ref(Spanned::get_ref(key))),
        key_span: Some(Span::from(key.span())),
        node: Node { value: toml_value(value.get_ref(), depth + 1), span: Some(Span::from(value.span())) },
    };
    let mut entries: Vec<Entry> = table.iter().map(entry).collect();
    entries.sort_by_key(|entry| entry.key_span.map(|span| span.start));
    entries
}

fn toml_value(value: &DeValue<'_>, depth: usize) -> Value {
    match value {
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Integer(number) => Value::Number(integer(number)),
        DeValue::Float(number) => Value::Number(float(number)),
        DeValue::Boolean(flag) => Value::Flag(*flag),
        DeValue::Datetime(_) => Value::Date,
        DeValue::Array(array) if depth < MAX_DEPTH => {
            let node = |value: &Spanned<DeValue<'_>>| Node {
                value: toml_value(value.get_ref(), depth + 1),
                span: Some(Span::from(value.span())),
            };
            Value::List(array.iter().map(node).collect())
        }
        DeValue::Array(_) => Value::List(Vec::new()),
        DeValue::Table(table) if depth < MAX_DEPTH => Value::Table(toml_entries(table, depth)),
        DeValue::Table(_) => Value::Table(Vec::new()),
    }
}

/// NaN if it has more digits than any key can have.
fn integer(number: &DeInteger<'_>) -> f64 {
    if number.radix() == 10 {
        return number.as_str().parse().unwrap_or(f64::NAN);
    }
    let whole = i64::from_str_radix(number.as_str(), number.radix());
    whole.ok().and_then(|whole| i32::try_from(whole).ok()).map_or(f64::NAN, f64::from)
}

fn float(number: &DeFloat<'_>) -> f64 {
    number.as_str().parse().unwrap_or(f64::NAN)
}

/// A JSON value.
pub(crate) fn from_json(value: &serde_json::Value) -> Value {
    json_value(value, 0)
}

fn json_value(value: &serde_json::Value, depth: usize) -> Value {
    use serde_json::Value as Json;
    match value {
        Json::Null => Value::Nothing,
        Json::Bool(flag) => Value::Flag(*flag),
        Json::Number(number) => Value::Number(number.as_f64().unwrap_or(f64::NAN)),
        Json::String(text) => Value::Text(text.clone()),
        Json::Array(_) if depth >= MAX_DEPTH => Value::List(Vec::new()),
        Json::Array(array) => {
            let node = |value: &Json| Node { value: json_value(value, depth + 1), span: None };
            Value::List(array.iter().map(node).collect())
        }
        Json::Object(_) if depth >= MAX_DEPTH => Value::Table(Vec::new()),
        Json::Object(object) => {
            let entry = |(key, value): (&String, &Json)| Entry {
                key: key.clone(),
                key_span: None,
                node: Node { value: json_value(value, depth + 1), span: None },
            };
            Value::Table(object.iter().map(entry).collect())
        }
    }
}

/// Returns the library's error, in words for people who may never have heard of TOML.
fn invalid_toml(text: &str, noun: &str, error: &Error) -> Problem {
    let span = error.span().map_or(Span::default(), Span::from);
    let (what, expected) = match error.message().split_once(", expected ") {
        Some((what, expected)) => (what, Some(expected)),
        None => (error.message(), None),
    };
    let found = span.text(text);
    let form = || format!("a {noun} is written `KEY = VALUE`");
    let (message, help) = match what {
        "string values must be quoted" if found.is_empty() => {
            ("the value is missing".to_owned(), Some(form()))
        }
        "string values must be quoted" => {
            (format!("`{found}` is not a value"), Some(format!("strings are in quotes: `\"{found}\"`")))
        }
        "key with no value" => ("`=` is missing after the key".to_owned(), Some(form())),
        "duplicate key" => (format!("`{found}` is set twice"), Some("remove one of them".to_owned())),
        "unclosed table" => ("`]` is missing".to_owned(), Some("a table begins with `[NAME]`".to_owned())),
        "invalid basic string" | "invalid literal string" => (
            "the string does not end on its line".to_owned(),
            expected.map(|quote| format!("close it with {quote}")),
        ),
        other => {
            let expected = expected.filter(|expected| *expected != "nothing");
            (format!("invalid TOML: {other}"), expected.map(|expected| format!("expected: {expected}")))
        }
    };
    let problem = Problem::new(ProblemKind::InvalidToml, "", Some(span), message);
    Problem { help, ..problem }
}
