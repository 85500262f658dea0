//! What a setting can be: how a value is read as that, or why it is refused.

use pydslrep_schema::{Value, closest, did_you_mean};

use crate::severities::UnknownWord;
use crate::{Level, Target};

/// What a setting can be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Values {
    /// One of these words.
    Words(&'static [Word]),
    /// `true` or `false`.
    Flag,
    /// A number above zero.
    AboveZero,
    /// A folder in the one that the settings are about.
    Folder,
    /// A table of codes of the catalogue, each with a [`Level`].
    Levels,
}

/// A word with what it means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Word {
    /// The word.
    pub word: &'static str,
    /// What it means.
    pub summary: &'static str,
}

/// What is wrong with a value, before it is known whose it is.
#[derive(Debug)]
pub(crate) struct Refusal {
    /// Goes behind the key.
    pub(crate) message: String,
    pub(crate) help: Option<String>,
    /// A word that may have been meant.
    pub(crate) replacement: Option<&'static str>,
}

fn wrong_sort(expected: &str, value: &Value) -> Refusal {
    Refusal { message: format!("must be {expected}, not {}", value.sort()), help: None, replacement: None }
}

fn refusal(message: &str, help: &str) -> Refusal {
    Refusal { message: message.to_owned(), help: Some(help.to_owned()), replacement: None }
}

pub(crate) fn table(value: &Value) -> Result<(), Refusal> {
    match value {
        Value::Table(_) | Value::Nothing => Ok(()),
        // What Lua makes of an empty table.
        Value::List(items) if items.is_empty() => Ok(()),
        other => Err(wrong_sort("a table", other)),
    }
}

pub(crate) fn flag(value: &Value) -> Result<bool, Refusal> {
    match value {
        Value::Flag(flag) => Ok(*flag),
        other => Err(wrong_sort("true or false", other)),
    }
}

pub(crate) fn above_zero(value: &Value) -> Result<f64, Refusal> {
    match value {
        Value::Number(number) if number.is_finite() && *number > 0.0 => Ok(*number),
        Value::Number(_) => {
            Err(Refusal { message: "must be a number above zero".to_owned(), help: None, replacement: None })
        }
        other => Err(wrong_sort("a number", other)),
    }
}

pub(crate) fn target(value: &Value) -> Result<Target, Refusal> {
    let Value::Text(word) = value else { return Err(wrong_sort("a text", value)) };
    Target::from_word(word).ok_or_else(|| {
        let words = Target::ALL.map(Target::word);
        // The one name is V-REP where people write it.
        let near = closest(word, words).or_else(|| closest(&word.replace('-', ""), words));
        Refusal {
            message: format!("cannot be `{word}`"),
            help: Some(near.map_or_else(|| format!("the targets are {}", words.join(", ")), did_you_mean)),
            replacement: near,
        }
    })
}

pub(crate) fn level(value: &Value) -> Result<Option<Level>, Refusal> {
    match value {
        Value::Nothing => Ok(None),
        Value::Text(word) => {
            Level::from_word(word).map(Some).map_err(|UnknownWord { near, help, .. }| Refusal {
                message: format!("cannot be `{word}`"),
                help: Some(help),
                replacement: near,
            })
        }
        other => Err(Refusal {
            help: Some(format!("write for example `\"{}\"`", Level::Off.word())),
            ..wrong_sort("a text", other)
        }),
    }
}

/// A folder inside of another one: settings come with the programs of others, and are not to write elsewhere.
pub(crate) fn folder(value: &Value) -> Result<String, Refusal> {
    let Value::Text(path) = value else { return Err(wrong_sort("a text", value)) };
    if path.trim().is_empty() {
        return Err(refusal(
            "is empty",
            "name a folder, or leave the key out: scripts are then written beside their programs",
        ));
    }
    if path.chars().any(char::is_control) {
        return Err(refusal(
            "is no path: there are control characters in it",
            "name a folder: `\"scripts\"`",
        ));
    }
    let elsewhere = "use `pydslrep build -o` to write scripts anywhere else";
    // The same text is read on every system.
    let has_drive = path.as_bytes().get(1) == Some(&b':');
    if has_drive || path.starts_with(['/', '\\']) {
        return Err(refusal(
            "must be a folder seen from the folder of the settings, not a whole path",
            elsewhere,
        ));
    }
    let mut parts = Vec::new();
    for part in path.split(['/', '\\']).filter(|part| !part.is_empty() && *part != ".") {
        if part != ".." {
            parts.push(part);
        } else if parts.pop().is_none() {
            return Err(refusal("leads out of the folder of the settings", elsewhere));
        }
    }
    Ok(if parts.is_empty() { ".".to_owned() } else { parts.join("/") })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_stay_inside() {
        let read = |path: &str| folder(&Value::Text(path.to_owned()));
        for (path, clean) in
            [("scripts", "scripts"), ("./a/../b//c/", "b/c"), (".", "."), ("a\\b", "a/b"), ("機 器", "機 器")]
        {
            assert_eq!(read(path).ok().as_deref(), Some(clean), "{path}");
        }
        for path in ["", " ", "/tmp", "\\\\host\\x", "C:\\x", "..", "a/../../b", "a\\..\\..", "a\0b", "\n"] {
            assert!(read(path).is_err(), "{path:?}");
        }
    }
}
