//! How bad problems are to whoever asks.

use std::collections::BTreeMap;

use pydslrep_analysis::diagnostics::{CATALOGUE, Rule, rule};
use pydslrep_analysis::{Diagnostic, Severity};
use pydslrep_schema::{closest, did_you_mean};

/// How bad problems of a code are, or that they are not shown at all.
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
    /// All of them, mildest first.
    pub const ALL: [Self; 5] = [Self::Off, Self::Hint, Self::Information, Self::Warning, Self::Error];

    /// How bad it is; `None` where it is not shown.
    pub fn severity(self) -> Option<Severity> {
        match self {
            Self::Off => None,
            Self::Hint => Some(Severity::Hint),
            Self::Information => Some(Severity::Information),
            Self::Warning => Some(Severity::Warning),
            Self::Error => Some(Severity::Error),
        }
    }

    /// The word it is chosen by.
    pub fn word(self) -> &'static str {
        self.severity().map_or("off", Severity::word)
    }

    /// What it does with problems, in a few words.
    pub fn summary(self) -> &'static str {
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
    /// When there is none.
    pub fn from_word(word: &str) -> Result<Self, UnknownWord> {
        Self::ALL.into_iter().find(|level| level.word() == word).ok_or_else(|| {
            let words = Self::ALL.map(Self::word);
            // `warn` and `info` are no slips, but short for one.
            let is_short_for = |level: &&str| word.len() > 2 && level.starts_with(word);
            let near = closest(word, words).or_else(|| words.into_iter().find(is_short_for));
            let help = near.map_or_else(|| format!("the levels are {}", words.join(", ")), did_you_mean);
            UnknownWord { message: format!("there is no level `{word}`"), near, help }
        })
    }
}

/// A word that is neither a code nor a level.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownWord {
    /// What is wrong, in one sentence.
    pub message: String,
    /// What may have been meant.
    pub near: Option<&'static str>,
    /// What to do, in words.
    pub help: String,
}

/// The rule with a code.
///
/// # Errors
/// When there is none.
pub fn find_rule(code: &str) -> Result<&'static Rule, UnknownWord> {
    rule(code).ok_or_else(|| {
        let near = near_codes(code);
        let help = match near.as_slice() {
            [] => "`pydslrep explain` lists them all".to_owned(),
            [one] => did_you_mean(one),
            [several @ .., last] => format!("did you mean `{}` or `{last}`?", several.join("`, `")),
        };
        let near = near.first().copied().filter(|_| near.len() == 1);
        UnknownWord { message: format!("there is no diagnostic `{code}`"), near, help }
    })
}

/// The codes that may have been meant: one that is nearly the same, else those with the same words in them.
fn near_codes(code: &str) -> Vec<&'static str> {
    /// Shorter words are in too many codes.
    const SHORTEST: usize = 3;
    let codes = || CATALOGUE.into_iter().map(|rule| rule.code);
    if let Some(near) = closest(code, codes()) {
        return vec![near];
    }
    let code = code.to_lowercase();
    let words = || code.split(|c: char| !c.is_alphanumeric()).filter(|word| word.len() >= SHORTEST);
    let shared =
        |known: &&str| words().filter(|word| known.split('-').any(|other| other.starts_with(word))).count();
    let most = codes().map(|code| shared(&code)).max().unwrap_or(0);
    codes().filter(|code| most > 0 && shared(code) == most).collect()
}

/// Levels in place of the severities of the catalogue.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Severities {
    /// By code.
    levels: BTreeMap<&'static str, Level>,
}

impl Severities {
    /// Chooses the level of a rule's problems.
    pub fn set(&mut self, rule: &'static Rule, level: Level) {
        self.levels.insert(rule.code, level);
    }

    /// The level that was chosen for a code.
    pub fn level(&self, code: &str) -> Option<Level> {
        self.levels.get(code).copied()
    }

    /// Those of `self`, and of `base` for other codes.
    pub fn merged_over(self, base: Self) -> Self {
        let mut levels = base.levels;
        levels.extend(self.levels);
        Self { levels }
    }

    /// How bad problems of a rule are to be shown that the database thinks to be this bad; `None` for not at all.
    pub fn severity(&self, code: &str, usual: Severity) -> Option<Severity> {
        self.level(code).map_or(Some(usual), Level::severity)
    }

    /// Problems as they are to be shown.
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
