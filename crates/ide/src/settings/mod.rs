//! Settings files: keys and values of a `pydslrep.toml` are completed, explained and mended, also while it is half
//! typed.
//!
//! Its text and a place in, plain structs out.

mod completion;
mod fixes;
mod hover;

pub use completion::settings_completions;
pub(crate) use fixes::fixes;
pub use fixes::{KeyFix, settings_fixes};
pub use hover::settings_hover;

use pydslrep_analysis::diagnostics::Rule;
use pydslrep_config::{KEYS, Key, Level, Values, find_rule};

/// What a whole name is the name of.
enum Meaning {
    Key(&'static Key),
    /// How bad problems of a code are.
    Code(&'static Rule),
    /// Keys are in it.
    Table(Vec<&'static Key>),
}

fn meaning(name: &str) -> Option<Meaning> {
    if let Some(key) = KEYS.iter().find(|key| key.name == name) {
        return Some(Meaning::Key(key));
    }
    if let Some((table, code)) = name.split_once('.')
        && KEYS.iter().any(|key| key.name == table && key.values == Values::Levels)
    {
        return find_rule(code).ok().map(Meaning::Code);
    }
    let is_inside = |key: &&Key| key.name.strip_prefix(name).is_some_and(|rest| rest.starts_with('.'));
    let inside: Vec<&Key> = KEYS.iter().filter(is_inside).collect();
    (!inside.is_empty()).then_some(Meaning::Table(inside))
}

/// What there is to say of a name, in Markdown.
fn documentation(meaning: &Meaning) -> String {
    match meaning {
        Meaning::Key(key) => key.markdown(),
        Meaning::Code(rule) => {
            let levels: Vec<String> =
                Level::ALL.iter().map(|level| format!("`\"{}\"`", level.word())).collect();
            format!(
                "**`{}`**: {}\n\n{}\n\nDefault: `\"{}\"`\n",
                rule.code,
                levels.join(", "),
                rule.summary,
                rule.severity.word()
            )
        }
        Meaning::Table(keys) => {
            let lines = keys.iter().map(|key| format!("* `{}`: {}\n", key.name, key.summary));
            lines.collect()
        }
    }
}

/// A text of a settings file, and the place of `$0` in it.
#[cfg(test)]
pub(crate) fn at_cursor(fixture: &str) -> (String, u32) {
    let offset = fixture.find("$0").expect("the fixture has no `$0`");
    (fixture.replacen("$0", "", 1), u32::try_from(offset).unwrap())
}
