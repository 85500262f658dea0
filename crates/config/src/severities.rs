//! The severity of diagnostics.

use std::collections::BTreeMap;

use pydslrep_analysis::diagnostics::{CATALOGUE, Rule, rule};
use pydslrep_analysis::{Diagnostic, Severity};
use pydslrep_schema::{Key, Table, TableKind, Values, Word, did_you_mean, key, suggestions};

/// The table of severities.
pub(crate) const TABLE: &str = "severity";

/// The table of severities, with a key for each diagnostic.
pub(crate) const CODES: Table = Table {
    name: TABLE,
    kind: TableKind::Catalogue {
        noun: "diagnostic",
        words: "a table: `CODE = \"LEVEL\"`",
        default: "as in the [list of messages](diagnostics/README.md)",
        help: "`pydslrep explain` lists all diagnostics",
    },
    summary: "The severity of each diagnostic: `\"off\"`, `\"hint\"`, `\"information\"`, `\"warning\"` or `\"error\"`. It decides what \
              is shown and the exit code of `pydslrep check`; what keeps a script from being generated does so at any level.",
    keys: &KEYS,
};

static KEYS: [Key; CATALOGUE.len()] = {
    let mut keys = [key("", Values::Words(&LEVELS), "").example("\"off\""); CATALOGUE.len()];
    let mut index = 0;
    while index < keys.len() {
        let rule = CATALOGUE[index];
        keys[index].name = rule.code;
        keys[index].summary = rule.summary;
        keys[index].default = match rule.severity {
            Severity::Hint => "`\"hint\"`",
            Severity::Information => "`\"information\"`",
            Severity::Warning => "`\"warning\"`",
            Severity::Error => "`\"error\"`",
        };
        index += 1;
    }
    keys
};

static LEVELS: [Word; Level::ALL.len()] = {
    let mut words = [Word { word: "", summary: "" }; Level::ALL.len()];
    let mut index = 0;
    while index < words.len() {
        let level = Level::ALL[index];
        words[index] = Word { word: level.word(), summary: level.summary() };
        index += 1;
    }
    words
};

/// The severity of a diagnostic, or that it is not shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// Not shown.
    Off,
    /// [`Severity::Hint`]
    Hint,
    /// [`Severity::Information`]
    Information,
    /// [`Severity::Warning`]
    Warning,
    /// [`Severity::Error`]
    Error,
}

impl Level {
    /// All of them, the mildest first.
    pub const ALL: [Self; 5] = [Self::Off, Self::Hint, Self::Information, Self::Warning, Self::Error];

    /// The severity; `None` if it is not shown.
    pub const fn severity(self) -> Option<Severity> {
        match self {
            Self::Off => None,
            Self::Hint => Some(Severity::Hint),
            Self::Information => Some(Severity::Information),
            Self::Warning => Some(Severity::Warning),
            Self::Error => Some(Severity::Error),
        }
    }

    /// The word it is chosen by.
    pub const fn word(self) -> &'static str {
        match self.severity() {
            None => "off",
            Some(severity) => severity.word(),
        }
    }

    /// Returns a description in a few words.
    pub const fn summary(self) -> &'static str {
        match self {
            Self::Off => "not shown",
            Self::Hint => "shown as a hint, hardly visible",
            Self::Information => "shown as information",
            Self::Warning => "shown as a warning",
            Self::Error => "shown as an error; `pydslrep check` fails",
        }
    }

    /// The level of a word.
    ///
    /// # Errors
    /// If there is none.
    pub fn from_word(word: &str) -> Result<Self, UnknownWord> {
        Self::ALL.into_iter().find(|level| level.word() == word).ok_or_else(|| {
            let words = Self::ALL.map(Self::word);
            let help = did_you_mean(&suggestions(word, &words));
            UnknownWord {
                message: format!("there is no level `{word}`"),
                help: help.unwrap_or_else(|| format!("the levels are {}", words.join(", "))),
            }
        })
    }
}

/// A word that is neither a code nor a level.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownWord {
    /// The problem, in one sentence.
    pub message: String,
    /// The remedy.
    pub help: String,
}

/// The rule of a code.
///
/// # Errors
/// If there is none.
pub fn find_rule(code: &str) -> Result<&'static Rule, UnknownWord> {
    rule(code).ok_or_else(|| {
        let help = did_you_mean(&suggestions(code, &CATALOGUE.map(|rule| rule.code)));
        UnknownWord {
            message: format!("there is no diagnostic `{code}`"),
            help: help.unwrap_or_else(|| "`pydslrep explain` lists them all".to_owned()),
        }
    })
}

/// Severities that differ from the catalogue.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Severities {
    /// By code.
    levels: BTreeMap<&'static str, Level>,
}

impl Severities {
    /// Sets the level of a code.
    pub fn set(&mut self, code: &'static str, level: Level) {
        self.levels.insert(code, level);
    }

    /// The level that is set for a code.
    pub fn level(&self, code: &str) -> Option<Level> {
        self.levels.get(code).copied()
    }

    /// Both, with `self` over `base`.
    pub fn merged_over(self, base: Self) -> Self {
        let mut levels = base.levels;
        levels.extend(self.levels);
        Self { levels }
    }

    /// The severity to show for a code whose severity is otherwise `usual`; `None` if it is not shown.
    pub fn severity(&self, code: &str, usual: Severity) -> Option<Severity> {
        self.level(code).map_or(Some(usual), Level::severity)
    }

    /// Diagnostics with the severities to show, without those that are not shown.
    pub fn applied(&self, diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
        if self.levels.is_empty() {
            return diagnostics;
        }
        let applied = diagnostics.into_iter().filter_map(|diagnostic| {
            let severity = self.severity(diagnostic.code(), diagnostic.severity)?;
            Some(Diagnostic { severity, ..diagnostic })
        });
        applied.collect()
    }
}
