//! The allowed values of a key, and the check of a value.

use serde_json::json;

use crate::keys::{Key, Schema};
use crate::suggestions::{did_you_mean, either, suggestions};
use crate::toml::{Node, Value};

/// The allowed values of a key. Most variants begin with the expected value, in Markdown.
#[derive(Debug, Clone, Copy)]
pub enum Values {
    /// `true` or `false`.
    Flag,
    /// One of these words.
    Words(&'static [Word]),
    /// A string that matches a regular expression. The function checks it and brings it into its canonical form.
    Text(&'static str, &'static str, fn(&str) -> Result<String, Refusal>),
    /// A number in a range.
    Number(&'static str, Range),
    /// A list of numbers in a range, with the least and the greatest count of them.
    Numbers(&'static str, Range, (usize, usize)),
    /// A list of lists of numbers, such as points: the least count of them, and how many numbers each has.
    Rows(&'static str, usize, usize),
}

/// A word with what it means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Word {
    /// The word.
    pub word: &'static str,
    /// Its meaning.
    pub summary: &'static str,
}

/// A range of numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// The least one, or what all are above.
    pub min: f64,
    /// True if `min` itself is left out.
    pub is_above: bool,
    /// The greatest one.
    pub max: f64,
    /// True if only whole numbers are allowed.
    pub is_whole: bool,
}

impl Range {
    /// All numbers.
    pub const ANY: Self =
        Self { min: f64::NEG_INFINITY, is_above: false, max: f64::INFINITY, is_whole: false };
    /// Zero and above.
    pub const FROM_ZERO: Self = Self { min: 0.0, ..Self::ANY };
    /// Above zero.
    pub const ABOVE_ZERO: Self = Self { is_above: true, ..Self::FROM_ZERO };

    fn contains(self, number: f64) -> bool {
        let is_above = if self.is_above { number > self.min } else { number >= self.min };
        is_above && number <= self.max && (!self.is_whole || number.fract() == 0.0)
    }

    fn json_schema(self) -> serde_json::Value {
        let mut schema = json!({ "type": if self.is_whole { "integer" } else { "number" } });
        if self.min.is_finite() {
            schema[if self.is_above { "exclusiveMinimum" } else { "minimum" }] = whole(self.min);
        }
        if self.max.is_finite() {
            schema["maximum"] = whole(self.max);
        }
        schema
    }
}

/// Limits are whole numbers, and JSON is to show them as such.
#[allow(clippy::cast_possible_truncation)]
fn whole(limit: f64) -> serde_json::Value {
    json!(limit as i64)
}

/// Why a key cannot have a value.
#[derive(Debug)]
pub struct Refusal {
    /// Follows the key in the message.
    pub message: String,
    /// The remedy.
    pub help: Option<String>,
    /// The text to put in place of the value.
    pub replacement: Option<String>,
}

impl From<String> for Refusal {
    fn from(message: String) -> Self {
        Self { message, help: None, replacement: None }
    }
}

impl Values {
    /// A number above zero.
    pub const ABOVE_ZERO: Self = Self::Number("a number above zero", Range::ABOVE_ZERO);

    /// Returns the expected value, in Markdown.
    pub fn words(&self) -> String {
        match self {
            Self::Flag => "`true` or `false`".to_owned(),
            Self::Words(words) => quoted(words),
            Self::Text(words, ..)
            | Self::Number(words, _)
            | Self::Numbers(words, ..)
            | Self::Rows(words, ..) => (*words).to_owned(),
        }
    }

    /// Returns whether values are in quotes.
    pub fn is_quoted(&self) -> bool {
        matches!(self, Self::Words(_) | Self::Text(..))
    }

    pub(crate) fn json_schema(&self) -> serde_json::Value {
        let list = |items, least: usize| json!({ "type": "array", "items": items, "minItems": least });
        let numbers = |range: &Range, (least, most): (usize, usize)| {
            let mut schema = list(range.json_schema(), least);
            schema["maxItems"] = json!(most);
            schema
        };
        match self {
            Self::Flag => json!({ "type": "boolean" }),
            Self::Words(words) => json!({ "enum": words.iter().map(|word| word.word).collect::<Vec<_>>() }),
            Self::Text(_, pattern, _) => json!({ "type": "string", "pattern": pattern }),
            Self::Number(_, range) => range.json_schema(),
            Self::Numbers(_, range, count) => numbers(range, *count),
            Self::Rows(_, least, width) => list(numbers(&Range::ANY, (*width, *width)), *least),
        }
    }
}

impl Key {
    /// Checks a value; returns it in its canonical form.
    pub(crate) fn read(&self, schema: &Schema, value: &Value) -> Result<Value, Refusal> {
        let limits = || format!("must be {}", self.values.words());
        let within = |range: Range, number: f64| {
            if !range.is_whole && (number.is_nan() || number.abs() > schema.largest) {
                return Err(schema.too_large.to_owned());
            }
            if range.contains(number) { Ok(()) } else { Err(limits()) }
        };
        match (self.values, value) {
            (Values::Flag, Value::Flag(_)) => {}
            (Values::Words(words), Value::Text(text)) => known(words, text)?,
            (Values::Text(_, _, read), Value::Text(text)) => return read(text).map(Value::Text),
            (Values::Number(_, range), Value::Number(number)) => within(range, *number)?,
            (Values::Numbers(_, range, (least, most)), Value::List(nodes)) => {
                let numbers = numbers(nodes).ok_or_else(limits)?;
                numbers.iter().try_for_each(|number| within(range, *number))?;
                if numbers.len() < least || numbers.len() > most {
                    return Err(limits().into());
                }
            }
            (Values::Rows(_, least, width), Value::List(nodes)) => {
                let rows = rows(nodes).ok_or_else(limits)?;
                if rows.iter().any(|row| row.len() != width) {
                    return Err(limits().into());
                }
                rows.iter().flatten().try_for_each(|number| within(Range::ANY, *number))?;
                if rows.len() < least {
                    return Err(limits().into());
                }
            }
            _ => return Err(format!("{}, not {}", limits(), value.kind()).into()),
        }
        Ok(value.clone())
    }
}

fn quoted(words: &[Word]) -> String {
    either(words.iter().map(|word| format!("`\"{}\"`", word.word)))
}

fn known(words: &[Word], text: &str) -> Result<(), Refusal> {
    let known: Vec<&str> = words.iter().map(|word| word.word).collect();
    if known.contains(&text) {
        return Ok(());
    }
    let near = suggestions(text, &known);
    let help = did_you_mean(&near).unwrap_or_else(|| format!("use {}", quoted(words)));
    let replacement = near.first().filter(|_| near.len() == 1).map(|near| format!("\"{near}\""));
    Err(Refusal { message: format!("cannot be `{text}`"), help: Some(help), replacement })
}

/// The numbers of a list; `None` if there is anything else in it.
pub(crate) fn numbers(nodes: &[Node]) -> Option<Vec<f64>> {
    let number = |node: &Node| if let Value::Number(number) = node.value { Some(number) } else { None };
    nodes.iter().map(number).collect()
}

/// The numbers of a list of lists; `None` if there is anything else in it.
pub(crate) fn rows(nodes: &[Node]) -> Option<Vec<Vec<f64>>> {
    let row = |node: &Node| if let Value::List(nodes) = &node.value { numbers(nodes) } else { None };
    nodes.iter().map(row).collect()
}
