//! Values as TOML and JSON have them in common.

use pydslrep_syntax::Span;
use toml::Spanned;
use toml::de::{DeFloat, DeInteger, DeTable, DeValue};

/// Settings lie no deeper; what does is not looked at.
const DEEPEST: usize = 3;

/// A value and where it is.
#[derive(Debug)]
pub(crate) struct Node {
    pub(crate) value: Value,
    pub(crate) span: Option<Span>,
}

#[derive(Debug)]
pub(crate) enum Value {
    Text(String),
    Number(f64),
    Flag(bool),
    Table(Vec<Entry>),
    List,
    Date,
    Nothing,
}

/// A key with its value.
#[derive(Debug)]
pub(crate) struct Entry {
    pub(crate) key: String,
    pub(crate) key_span: Option<Span>,
    pub(crate) node: Node,
}

impl Value {
    /// What sort of value it is, in words.
    pub(crate) fn sort(&self) -> &'static str {
        match self {
            Self::Text(_) => "a text",
            Self::Number(_) => "a number",
            Self::Flag(_) => "true or false",
            Self::Table(_) => "a table",
            Self::List => "a list",
            Self::Date => "a date or time",
            Self::Nothing => "empty",
        }
    }
}

/// The entries of a TOML document, in the order of the text.
pub(crate) fn from_toml(table: &DeTable<'_>) -> Vec<Entry> {
    toml_entries(table, 0)
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
        DeValue::Array(_) => Value::List,
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
pub(crate) fn span(range: std::ops::Range<usize>) -> Span {
    let offset = |offset| u32::try_from(offset).unwrap_or(u32::MAX);
    Span::new(offset(range.start), offset(range.end))
}

/// The value of JSON.
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
        Json::Array(_) => Value::List,
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
