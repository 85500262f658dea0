//! Tokens to text: what stands between them.

use super::choices::Choices;

/// Between two tokens, where one likes.
const ODD_GAPS: [&str; 20] = [
    "  ",
    "\n",
    "\r\n",
    "\r",
    "\t",
    " \u{c} ",
    "\n\n\n",
    " // a comment\n",
    "//\r\n",
    "/**/",
    "/* one\n * two */",
    " /***/ ",
    "// */ /*\r",
    "/* // */",
    "// wheel a with radius 5\n",
    "/* environment x has { */",
    "/* größe 🤖 € */",
    "// \u{feff}…\n",
    "\n\t // ^ } \"\n  ",
    " /* { ^ \" */\n",
];

/// Puts entities one below the other, a space between their tokens.
pub(super) fn tidy(entities: &[Vec<String>]) -> String {
    entities.iter().map(|tokens| tokens.join(" ") + "\n").collect()
}

/// Puts tokens together in odd ways, now and then.
pub(super) fn odd(choices: &mut Choices, entities: &[Vec<String>]) -> String {
    let mut text = String::new();
    if choices.once_in(8) {
        text.push('\u{feff}');
    }
    let how_often = choices.pick(&[40, 8, 2]);
    let mut plain_gaps = choices.below(how_often);
    let mut previous = "";
    for tokens in entities {
        for (index, token) in tokens.iter().enumerate() {
            if plain_gaps > 0 {
                plain_gaps -= 1;
                text.push_str(if index > 0 { " " } else { "\n" });
            } else {
                text.push_str(odd_gap(choices, previous, token));
                plain_gaps = choices.below(how_often);
            }
            text.push_str(token);
            previous = token;
        }
    }
    // Nothing needs a line end behind the last token.
    text.push_str(choices.pick(&["\n", "", "\r", " // the end", "\n/* the\nend */", "\n//"]));
    text
}

fn odd_gap(choices: &mut Choices, previous: &str, next: &str) -> &'static str {
    if choices.once_in(3) && !would_merge(previous, next) { "" } else { choices.pick(&ODD_GAPS) }
}

/// Whether two tokens would be read as one. A number ends where a letter follows.
fn would_merge(previous: &str, next: &str) -> bool {
    let is_letter = |character: char| character.is_ascii_alphabetic() || character == '_';
    let is_digit = |character: char| character.is_ascii_digit();
    let number_before = previous.trim_start_matches('-').starts_with(is_digit);
    let name_before = previous.trim_start_matches('^').starts_with(is_letter);
    (number_before && next.starts_with(is_digit))
        || (name_before && (next.starts_with(is_letter) || next.starts_with(is_digit)))
}
