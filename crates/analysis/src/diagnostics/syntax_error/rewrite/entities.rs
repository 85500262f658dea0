//! Entities other than movements.

use pydslrep_syntax::{EntityKind, SyntaxErrorKind, TokenKind};
use pydslrep_text::is_similar;

use super::statement::{Difference, Word, are_sound, rewrite, shape, words_of};
use crate::diagnostics::context::Context;
use crate::diagnostics::rewritten::Rewrite;

/// The entity as it is written, where its mistakes are one.
pub(super) fn find(context: &Context<'_>, kind: EntityKind) -> Option<Rewrite> {
    let is_slip = |kind: &SyntaxErrorKind| {
        matches!(kind, SyntaxErrorKind::Misspelt { .. } | SyntaxErrorKind::InvalidName { .. })
    };
    let is_foreign = |kind: &SyntaxErrorKind| match kind {
        SyntaxErrorKind::InvalidCharacter { .. } => true,
        SyntaxErrorKind::Unexpected { found, .. } => *found == pydslrep_syntax::Found::Text(":".into()),
        _ => false,
    };
    let mistakes = context.errors.iter().filter(|error| !is_slip(&error.kind));
    let (count, foreign) =
        (mistakes.clone().count(), mistakes.filter(|error| is_foreign(&error.kind)).count());
    let words = words_of(context, context.tokens)?;
    let words: Vec<Word> = words.into_iter().map(|word| corrected(word, kind)).collect();
    let text = match kind {
        EntityKind::Wheel => wheel(&words)?,
        EntityKind::Sensor => sensor(&words)?,
        EntityKind::Ip => ip(&words)?,
        EntityKind::Robot => robot(&words, context.target().default_port())?,
        EntityKind::Environment => environment(&words)?,
        EntityKind::Movement => return None,
    };
    let lines: Vec<&str> = text.lines().collect();
    if !are_sound(&lines) {
        return None;
    }
    let help = shape(context, kind);
    if lines.len() > 1 {
        let rewrite = rewrite(&words, text.clone(), help, false)?;
        let message = format!("each {} is declared on its own", kind.noun());
        return Some(Rewrite { message, title: "declare each on its own".to_owned(), ..rewrite });
    }
    let difference = Difference::between(&words, &text);
    let is_part = matches!(kind, EntityKind::Wheel | EntityKind::Sensor | EntityKind::Ip);
    let lacks_words =
        difference.missing.iter().any(|missing| missing.contains(char::is_alphabetic) || missing == ":");
    // Keywords that are only misspelt are one mistake each.
    let is_one = foreign > 0 && lacks_words
        || is_part && count > 1 && !difference.extra.is_empty()
        || count > 0 && is_short(&words, kind, count, foreign > 0);
    rewrite(&words, text.clone(), help, !is_one)
}

/// Returns whether most of the entity's keywords are missing, so that it is one mistake and not several.
fn is_short(words: &[Word], kind: EntityKind, mistakes: usize, has_brackets: bool) -> bool {
    let lacks = |token: TokenKind| !words.iter().any(|word| word.token == token);
    let lacks_braces = lacks(TokenKind::OpenBrace) && !has_brackets;
    match kind {
        EntityKind::Robot => {
            lacks(TokenKind::Has) && (lacks(TokenKind::Port) || mistakes > 1) || lacks_braces && mistakes > 1
        }
        EntityKind::Environment => mistakes > 1 && (lacks(TokenKind::Has) || lacks_braces),
        _ => false,
    }
}

/// A misspelt keyword as the keyword. The text stays as written.
fn corrected(word: Word, kind: EntityKind) -> Word {
    let keywords: &[TokenKind] = match kind {
        EntityKind::Wheel => &[TokenKind::With, TokenKind::Radius],
        EntityKind::Robot => &[
            TokenKind::With,
            TokenKind::Port,
            TokenKind::Has,
            TokenKind::Wheels,
            TokenKind::Sensors,
            TokenKind::Type,
        ],
        EntityKind::Environment => &[TokenKind::With, TokenKind::Has, TokenKind::Robots, TokenKind::Moves],
        _ => &[],
    };
    if word.token != TokenKind::Name {
        return word;
    }
    let is_similar_to_word =
        |token: &&TokenKind| token.spelling().is_some_and(|keyword| is_similar(&word.text, keyword));
    match keywords.iter().find(is_similar_to_word) {
        Some(keyword) => Word { token: *keyword, ..word },
        None => word,
    }
}

/// Words that say nothing: `radius of 4.5 cm`, `sensor s is a bumper`.
fn says_nothing(word: &Word) -> bool {
    const WORDS: [&str; 11] =
        ["is", "a", "an", "the", "of", "and", "equals", "cm", "centimeters", "centimetres", "kind"];
    word.is_noise() || WORDS.contains(&word.text.as_str())
}

fn wheel(words: &[Word]) -> Option<String> {
    let (mut names, mut radius) = (Vec::new(), None);
    let mut is_listed = true;
    for (before, word) in words.iter().zip(words.get(1..)?) {
        match word.token {
            TokenKind::With | TokenKind::Radius | TokenKind::Has => {}
            token if token.is_name() && (names.is_empty() || !says_nothing(word)) => {
                // `wheel my wheel with …` is another mistake.
                is_listed &= names.is_empty() || before.token == TokenKind::Comma || before.text == "and";
                names.push(&word.text);
            }
            _ if word.is_number() && radius.is_none() => radius = Some(&word.text),
            _ if says_nothing(word) => {}
            _ => return None,
        }
    }
    let radius = radius.filter(|_| is_listed && !names.is_empty())?;
    let keyword = if words[0].text.eq_ignore_ascii_case("wheelH") { "wheelH" } else { "wheel" };
    let lines: Vec<String> =
        names.into_iter().map(|name| format!("{keyword} {name} with radius {radius}")).collect();
    Some(lines.join("\n"))
}

fn sensor(words: &[Word]) -> Option<String> {
    let (mut name, mut kind) = (None, None);
    for word in words.get(1..)? {
        let slot = match word.token {
            TokenKind::Type | TokenKind::With | TokenKind::Has => continue,
            TokenKind::Distance | TokenKind::Bumper if name.is_some() => &mut kind,
            token if token.is_name() && name.is_none() => &mut name,
            _ if says_nothing(word) => continue,
            _ => return None,
        };
        if slot.replace(&word.text).is_some() {
            return None;
        }
    }
    Some(kind.map_or(format!("sensor {}", name?), |kind| format!("sensor {} : {kind}", name.unwrap_or(kind))))
}

fn ip(words: &[Word]) -> Option<String> {
    let (mut name, mut address) = (None, None);
    for word in words.get(1..)? {
        let slot = match word.token {
            TokenKind::With | TokenKind::Has => continue,
            TokenKind::Ipv4 => &mut address,
            token if token.is_name() && name.is_none() => &mut name,
            _ if says_nothing(word) => continue,
            _ => return None,
        };
        if slot.replace(&word.text).is_some() {
            return None;
        }
    }
    Some(format!("ip {} {}", name?, address?))
}

/// The names of a list, and how many words it takes: with or without its braces.
fn list(words: &[Word]) -> Option<(Vec<&str>, usize)> {
    let is_open = |word: &Word| {
        word.token == TokenKind::OpenBrace
            || word.token == TokenKind::Invalid && word.text.ends_with(['(', '['])
    };
    let is_close = |word: &Word| {
        word.token == TokenKind::CloseBrace
            || word.token == TokenKind::Invalid && word.text.starts_with([')', ']'])
    };
    let opened = usize::from(words.first().is_some_and(is_open));
    let mut names = Vec::new();
    for (index, word) in words.iter().enumerate().skip(opened) {
        match word.token {
            TokenKind::Comma => {}
            token if token.is_name() && word.text != "and" => names.push(word.text.as_str()),
            token if token.is_name() => {}
            _ if opened > 0 && is_close(word) => return Some((names, index + 1)),
            _ if opened == 0 => return Some((names, index)),
            _ => return None,
        }
    }
    (opened == 0).then_some((names, words.len()))
}

/// The names of a list, and what the words before and after it call them.
struct List<'a> {
    names: Vec<&'a str>,
    before: Option<TokenKind>,
    after: Option<TokenKind>,
}

impl List<'_> {
    /// Returns whether `word` says what the list holds.
    fn is(&self, word: TokenKind) -> bool {
        self.before == Some(word)
            || self.before.is_none_or(|before| before == TokenKind::Has) && self.after == Some(word)
    }
}

/// The lists among some words and the other words; `of` are the words for what is listed.
fn lists<'a>(words: &'a [Word], of: [TokenKind; 2]) -> Option<(Vec<List<'a>>, Vec<&'a Word>)> {
    let (mut lists, mut others): (Vec<List<'a>>, Vec<&Word>) = (Vec::new(), Vec::new());
    let (mut index, mut label, mut is_after_list) = (0, None, false);
    while let Some(word) = words.get(index) {
        let begins = match word.token {
            TokenKind::OpenBrace => true,
            TokenKind::Invalid => word.text.ends_with(['(', '[']),
            token => label.is_some() && token.is_name(),
        };
        if begins {
            let (names, taken) = list(&words[index..])?;
            lists.push(List { names, before: label, after: None });
            (index, label, is_after_list) = (index + taken, None, true);
            continue;
        }
        let last = lists.last_mut().filter(|_| is_after_list);
        match (last, of.contains(&word.token)) {
            (Some(last), true) => last.after = Some(word.token),
            (_, true) => label = Some(word.token),
            _ if word.token == TokenKind::Has => label = Some(TokenKind::Has),
            _ => others.push(word),
        }
        (index, is_after_list) = (index + 1, false);
    }
    Some((lists, others))
}

/// The lists of both kinds, the first of which must be there. Where no keyword tells the kind of a list, their order does.
fn in_order<'a>(lists: &[List<'a>], of: [TokenKind; 2]) -> Option<(String, Option<String>)> {
    let joined = |list: &List<'a>| list.names.join(" ");
    match lists {
        [only] => (!only.is(of[1])).then(|| (joined(only), None)),
        [first, second] if first.is(of[1]) && !second.is(of[1]) => {
            Some((joined(second), Some(joined(first))))
        }
        [first, second] if !first.is(of[1]) && !second.is(of[0]) => {
            Some((joined(first), Some(joined(second))))
        }
        _ => None,
    }
}

fn robot(words: &[Word], default_port: u16) -> Option<String> {
    const LISTED: [TokenKind; 2] = [TokenKind::Wheels, TokenKind::Sensors];
    let (lists, others) = lists(words.get(1..)?, LISTED)?;
    let (mut name, mut drive, mut port) = (None, None, None);
    for word in others {
        let slot = match word.token {
            TokenKind::With | TokenKind::Type | TokenKind::Port => continue,
            token if token.drive().is_some() => &mut drive,
            TokenKind::Integer => &mut port,
            token if token.is_name() && name.is_none() => &mut name,
            _ if says_nothing(word) => continue,
            _ => return None,
        };
        if slot.replace(word.text.as_str()).is_some() {
            return None;
        }
    }
    let (wheels, sensors) = in_order(&lists, LISTED)?;
    let drive = drive.map_or(String::new(), |drive| format!(" type {drive}"));
    let port = port.map_or(default_port.to_string(), str::to_owned);
    let sensors = sensors.map_or(String::new(), |names| format!(" with sensors {{ {names} }}"));
    Some(format!("robot {}{drive} with port {port} has {{ {wheels} }} wheels{sensors}", name?))
}

fn environment(words: &[Word]) -> Option<String> {
    const LISTED: [TokenKind; 2] = [TokenKind::Robots, TokenKind::Moves];
    let (lists, others) = lists(words.get(1..)?, LISTED)?;
    let (mut name, mut ip, mut is_ip) = (None, None, false);
    for word in others {
        let slot = match word.token {
            TokenKind::Ip => {
                is_ip = true;
                continue;
            }
            TokenKind::With => continue,
            token if token.is_name() && is_ip => &mut ip,
            token if token.is_name() && name.is_none() => &mut name,
            _ if says_nothing(word) => continue,
            _ => return None,
        };
        if slot.replace(word.text.as_str()).is_some() {
            return None;
        }
    }
    let (robots, movements) = in_order(&lists, LISTED)?;
    let ip = ip.map_or(String::new(), |ip| format!(" with ip {ip}"));
    let movements = movements.map_or(String::new(), |names| format!(" with {{ {names} }} moves"));
    Some(format!("environment {}{ip} has {{ {robots} }} robots{movements}", name?))
}
