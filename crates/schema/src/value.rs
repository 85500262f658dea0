//! Values as TOML and JSON have them in common.

use pydslrep_text::Span;
use toml::Spanned;
use toml::de::{DeFloat, DeInteger, DeTable, DeValue, Error};

use crate::{Problem, ProblemKind};

/// Nothing that means anything lies deeper; what does is not looked at.
const DEEPEST: usize = 8;

/// A value and where it is.
#[derive(Debug)]
pub struct Node {
    /// The value.
    pub value: Value,
    /// Where it is; `None` in JSON.
    pub span: Option<Span>,
}

/// A value.
#[derive(Debug)]
pub enum Value {
    /// A text, without its quotes.
    Text(String),
    /// A number; not a number where it is none that counts.
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
#[derive(Debug)]
pub struct Entry {
    /// The key alone, without the tables it is in.
    pub key: String,
    /// Where the key is; `None` in JSON.
    pub key_span: Option<Span>,
    /// What it is set to.
    pub node: Node,
}

impl Value {
    /// What sort of value it is, in words.
    pub fn sort(&self) -> &'static str {
        match self {
            Self::Text(_) => "a text",
            Self::Number(_) => "a number",
            Self::Flag(_) => "true or false",
            Self::Table(_) => "a table",
            Self::List(_) => "a list",
            Self::Date => "a date or time",
            Self::Nothing => "empty",
        }
    }
}

/// The entries of a TOML document, in the order of the text.
///
/// # Errors
/// When the text is no TOML; `name` is what an entry of such a file is called in the words for it, such as `setting`.
pub fn parse(text: &str, name: &str) -> Result<Vec<Entry>, Problem> {
    let (table, errors) = DeTable::parse_recoverable(text);
    // One slip makes several errors, and only the first one is about the slip.
    match errors.iter().min_by_key(|error| error.span().map(|span| span.start)) {
        Some(error) => Err(no_toml(text, name, error)),
        None => Ok(toml_entries(table.get_ref(), 0)),
    }
}

fn toml_entries(table: &DeTable<'_>, depth: usize) -> Vec<Entry> {
    let entry = |(key, value): (&Spanned<_>, &Spanned<DeValue<'_>>)| Entry {
        key: String::from(std::borrow::Cow::as_ref(Spanned::get_ref(key))),
        key_span: Some(span(key.span())),
        node: Node { value: toml_value(value.get_ref(), depth + 1), span: Some(span(value.span())) },
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
        DeValue::Array(array) if depth < DEEPEST => {
            let node = |value: &Spanned<DeValue<'_>>| Node {
                value: toml_value(value.get_ref(), depth + 1),
                span: Some(span(value.span())),
            };
            Value::List(array.iter().map(node).collect())
        }
        DeValue::Array(_) => Value::List(Vec::new()),
        DeValue::Table(table) if depth < DEEPEST => Value::Table(toml_entries(table, depth)),
        DeValue::Table(_) => Value::Table(Vec::new()),
    }
}

/// What is no number by our reading is not one that a setting can have.
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

/// A place as our crates have it; texts are smaller than 4 GiB.
pub fn span(range: std::ops::Range<usize>) -> Span {
    let offset = |offset| u32::try_from(offset).unwrap_or(u32::MAX);
    Span::new(offset(range.start), offset(range.end))
}

/// The value of JSON.
pub fn from_json(value: &serde_json::Value) -> Value {
    json_value(value, 0)
}

fn json_value(value: &serde_json::Value, depth: usize) -> Value {
    use serde_json::Value as Json;
    match value {
        Json::Null => Value::Nothing,
        Json::Bool(flag) => Value::Flag(*flag),
        Json::Number(number) => Value::Number(number.as_f64().unwrap_or(f64::NAN)),
        Json::String(text) => Value::Text(text.clone()),
        Json::Array(_) if depth >= DEEPEST => Value::List(Vec::new()),
        Json::Array(array) => {
            let node = |value: &Json| Node { value: json_value(value, depth + 1), span: None };
            Value::List(array.iter().map(node).collect())
        }
        Json::Object(_) if depth >= DEEPEST => Value::Table(Vec::new()),
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

/// What the library found, in words for people who may have never heard of TOML.
fn no_toml(text: &str, name: &str, error: &Error) -> Problem {
    let span = error.span().map_or(Span::default(), self::span);
    let (what, expected) = match error.message().split_once(", expected ") {
        Some((what, expected)) => (what, Some(expected)),
        None => (error.message(), None),
    };
    let found = text.get(span.start as usize..span.end as usize).unwrap_or_default();
    let (message, help) = match what {
        "string values must be quoted" if found.is_empty() => {
            ("the value is missing".to_owned(), Some(format!("a {name} is written `KEY = VALUE`")))
        }
        "string values must be quoted" => {
            (format!("`{found}` is no value"), Some(format!("texts stand in quotes: `\"{found}\"`")))
        }
        "key with no value" => {
            ("there is no `=` behind the key".to_owned(), Some(format!("a {name} is written `KEY = VALUE`")))
        }
        "duplicate key" => (format!("`{found}` is set twice"), Some("leave one of them out".to_owned())),
        "unclosed table" => ("`]` is missing".to_owned(), Some("a table begins with `[NAME]`".to_owned())),
        "invalid basic string" | "invalid literal string" => (
            "the text does not end on its line".to_owned(),
            expected.map(|quote| format!("close it by {quote}")),
        ),
        other => {
            let expected = expected.filter(|expected| *expected != "nothing");
            (format!("this is no TOML: {other}"), expected.map(|expected| format!("expected: {expected}")))
        }
    };
    Problem {
        kind: ProblemKind::InvalidToml,
        key: String::new(),
        span: Some(span),
        message,
        help,
        replacement: None,
    }
}
