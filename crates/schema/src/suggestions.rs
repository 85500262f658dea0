//! Suggestions for unknown words.

use pydslrep_text::closest;

/// Shorter words are part of too many others.
const MIN_PART_LENGTH: usize = 3;

/// The known words that an unknown one may stand for: the one that is spelled nearly the same, else those that share most
/// of its parts, or the beginnings of them.
pub fn suggestions<'a>(word: &str, known: &[&'a str]) -> Vec<&'a str> {
    let spelled = closest(word, known.iter().copied());
    // V-REP is spelled `vrep` here.
    if let Some(near) = spelled.or_else(|| closest(&word.replace('-', ""), known.iter().copied())) {
        return vec![near];
    }
    let word = word.to_lowercase();
    let parts = || word.split(|c: char| !c.is_alphanumeric()).filter(|part| part.len() >= MIN_PART_LENGTH);
    let shared =
        |known: &str| parts().filter(|part| known.split('-').any(|other| other.starts_with(part))).count();
    let most = known.iter().map(|known| shared(known)).max().unwrap_or(0);
    known.iter().copied().filter(|known| most > 0 && shared(known) == most).collect()
}

/// The help for an unknown word; `None` if there are no suggestions.
pub fn did_you_mean(near: &[&str]) -> Option<String> {
    (!near.is_empty())
        .then(|| format!("did you mean {}?", either(near.iter().map(|near| format!("`{near}`")))))
}

/// Alternatives as English lists them: `a, b or c`.
pub fn either(words: impl IntoIterator<Item = String>) -> String {
    let mut words: Vec<String> = words.into_iter().collect();
    match (words.pop(), words.is_empty()) {
        (Some(last), false) => format!("{} or {last}", words.join(", ")),
        (last, _) => last.unwrap_or_default(),
    }
}
