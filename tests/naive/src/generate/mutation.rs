//! Programs with a few wrong tokens.

use super::choices::Choices;
use crate::tokens;

/// What is put where it does not belong.
const STRANGERS: [&str; 26] = [
    "{", "}", "wait", "repeat", "if", "else", "do", "times", "seconds", "clear", "detect", "within", "in",
    "reverse", "until", "with", "radius", "at", "move", "turn", "slam", "movement", "7", "stranger", ",",
    "-0.5",
];

/// A program in which this many tokens, one after the other, are left out, doubled, swapped with the next, replaced, misspelt or
/// preceded by something. It may still be grammatical. It is always the same for the same seed.
pub fn mutated(program: &str, seed: u64, count: usize) -> String {
    let mut choices = Choices::seeded(seed);
    let mut text = program.to_owned();
    for _ in 0..count {
        text = mutated_once(&text, &mut choices);
    }
    text
}

fn mutated_once(text: &str, choices: &mut Choices) -> String {
    let ranges: Vec<_> = tokens::read(text).0.into_iter().map(|token| token.range).collect();
    if ranges.is_empty() {
        return text.to_owned();
    }
    let index = choices.below(ranges.len());
    let range = ranges[index].clone();
    let word = &text[range.clone()];
    let stranger = choices.pick(&STRANGERS);
    let mut changed = text.to_owned();
    match choices.below(6) {
        0 => changed.replace_range(range, ""),
        1 => changed.insert_str(range.end, &format!(" {word}")),
        2 => {
            if let Some(next) = ranges.get(index + 1) {
                let between = &text[range.end..next.start];
                let swapped = format!("{} {between} {word}", &text[next.clone()]);
                changed.replace_range(range.start..next.end, &swapped);
            }
        }
        3 => changed.replace_range(range, stranger),
        4 => changed.replace_range(range, &misspelt(word)),
        _ => changed.insert_str(range.start, &format!(" {stranger} ")),
    }
    changed
}

/// Its second and third letter swapped, or one letter too many.
fn misspelt(word: &str) -> String {
    let mut letters: Vec<char> = word.chars().collect();
    if letters.len() > 2 {
        letters.swap(1, 2);
    } else {
        letters.push('x');
    }
    letters.into_iter().collect()
}
