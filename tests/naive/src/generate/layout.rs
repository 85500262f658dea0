//! The layout of tokens.

use super::choices::Choices;

/// Unusual separators between tokens.
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

/// One entity per line, with single spaces.
pub(super) fn tidy(entities: &[Vec<String>]) -> String {
    entities.iter().map(|tokens| tokens.join(" ") + "\n").collect()
}

/// Unusual separators now and then.
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
    // The last line break is optional.
    text.push_str(choices.pick(&["\n", "", "\r", " // the end", "\n/* the\nend */", "\n//"]));
    text
}

fn odd_gap(choices: &mut Choices, previous: &str, next: &str) -> &'static str {
    if choices.once_in(3) && !would_merge(previous, next) { "" } else { choices.pick(&ODD_GAPS) }
}

/// Whether two tokens without a separator would be read as one. A letter ends a number.
fn would_merge(previous: &str, next: &str) -> bool {
    let is_letter = |character: char| character.is_ascii_alphabetic() || character == '_';
    let is_digit = |character: char| character.is_ascii_digit();
    let number_before = previous.trim_start_matches('-').starts_with(is_digit);
    let name_before = previous.trim_start_matches('^').starts_with(is_letter);
    (number_before && next.starts_with(is_digit))
        || (name_before && (next.starts_with(is_letter) || next.starts_with(is_digit)))
}
