//! Entities other than movements.

use pydslrep_syntax::{EntityKind, SyntaxErrorKind, Token, is_similar};

use super::{Difference, Rewrite, Word, are_sound, rewrite, shape, words_of};
use crate::diagnostics::context::Context;

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
    if count == 0 {
        return None;
    }
    let words = words_of(context, context.lexemes)?;
    let words: Vec<Word> = words.into_iter().map(|word| corrected(word, kind)).collect();
    let text = match kind {
        EntityKind::Wheel => wheel(&words)?,
        EntityKind::Sensor => sensor(&words)?,
        EntityKind::Ip => ip(&words)?,
        EntityKind::Robot => robot(&words, context.database.target(context.file).default_port())?,
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
    let is_one = foreign > 0 && !difference.missing.is_empty()
        || is_part && count > 1 && !difference.extra.is_empty()
        || is_short(&words, kind, count);
    rewrite(&words, text.clone(), help, !is_one)
}

/// Whether most of the entity's keywords are missing, so that it is one mistake and not several.
fn is_short(words: &[Word], kind: EntityKind, mistakes: usize) -> bool {
    let lacks = |token: Token| !words.iter().any(|word| word.token == token);
    match kind {
        EntityKind::Robot => {
            lacks(Token::Has) && (lacks(Token::Port) || mistakes > 1)
                || lacks(Token::OpenBrace) && mistakes > 1
        }
        EntityKind::Environment => mistakes > 1 && (lacks(Token::Has) || lacks(Token::OpenBrace)),
        _ => false,
    }
}

/// A misspelt keyword as the keyword. The text stays as written.
fn corrected(word: Word, kind: EntityKind) -> Word {
    let keywords: &[Token] = match kind {
        EntityKind::Wheel => &[Token::With, Token::Radius],
        EntityKind::Robot => {
            &[Token::With, Token::Port, Token::Has, Token::Wheels, Token::Sensors, Token::Type]
        }
        EntityKind::Environment => &[Token::With, Token::Has, Token::Robots, Token::Moves],
        _ => &[],
    };
    if word.token != Token::Name {
        return word;
    }
    let meant = |token: &&Token| token.spelling().is_some_and(|keyword| is_similar(&word.text, keyword));
    match keywords.iter().find(meant) {
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
            Token::With | Token::Radius | Token::Has => {}
            _ if says_nothing(word) => {}
            token if token.is_name() => {
                // `wheel my wheel with …` is another mistake.
                is_listed &= names.is_empty() || before.token == Token::Comma || before.text == "and";
                names.push(&word.text);
            }
            _ if word.is_number() && radius.is_none() => radius = Some(&word.text),
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
            Token::Type | Token::With | Token::Has => continue,
            Token::Distance | Token::Bumper if name.is_some() => &mut kind,
            _ if says_nothing(word) => continue,
            token if token.is_name() => &mut name,
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
            Token::With | Token::Has => continue,
            Token::Ipv4 => &mut address,
            _ if says_nothing(word) => continue,
            token if token.is_name() => &mut name,
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
        word.token == Token::OpenBrace || word.token == Token::Invalid && word.text.ends_with(['(', '['])
    };
    let is_close = |word: &Word| {
        word.token == Token::CloseBrace || word.token == Token::Invalid && word.text.starts_with([')', ']'])
    };
    let opened = usize::from(words.first().is_some_and(is_open));
    let mut names = Vec::new();
    for (index, word) in words.iter().enumerate().skip(opened) {
        match word.token {
            Token::Comma => {}
            token if token.is_name() && word.text != "and" => names.push(word.text.as_str()),
            token if token.is_name() => {}
            _ if opened > 0 && is_close(word) => return Some((names, index + 1)),
            _ if opened == 0 => return Some((names, index)),
            _ => return None,
        }
    }
    (opened == 0).then_some((names, words.len()))
}

/// Whether a list begins at a word.
fn begins_list(word: &Word, is_expected: bool) -> bool {
    match word.token {
        Token::OpenBrace => true,
        Token::Invalid => word.text.ends_with(['(', '[']),
        token => is_expected && token.is_name(),
    }
}

fn robot(words: &[Word], default_port: u16) -> Option<String> {
    let (mut name, mut drive, mut port) = (None, None, None);
    let (mut wheels, mut sensors): (Option<Vec<&str>>, Option<Vec<&str>>) = (None, None);
    let (mut index, mut label) = (1, None);
    while let Some(word) = words.get(index) {
        if begins_list(word, label.is_some()) {
            let (names, taken) = list(&words[index..])?;
            let slot =
                if label == Some(Token::Sensors) || wheels.is_some() { &mut sensors } else { &mut wheels };
            if slot.replace(names).is_some() {
                return None;
            }
            (index, label) = (index + taken, None);
            continue;
        }
        index += 1;
        let slot = match word.token {
            Token::Has | Token::Wheels | Token::Sensors => {
                label = Some(word.token);
                continue;
            }
            Token::With | Token::Type | Token::Port => continue,
            Token::Tw | Token::Fw | Token::Fwh => &mut drive,
            Token::Integer => &mut port,
            _ if says_nothing(word) => continue,
            token if token.is_name() => &mut name,
            _ => return None,
        };
        if slot.replace(word.text.as_str()).is_some() {
            return None;
        }
    }
    let drive = drive.map_or(String::new(), |drive| format!(" type {drive}"));
    let port = port.map_or(default_port.to_string(), str::to_owned);
    let sensors = sensors.map_or(String::new(), |names| format!(" with sensors {{ {} }}", names.join(" ")));
    let wheels = wheels?.join(" ");
    Some(format!("robot {}{drive} with port {port} has {{ {wheels} }} wheels{sensors}", name?))
}

fn environment(words: &[Word]) -> Option<String> {
    let (mut name, mut ip) = (None, None);
    let (mut robots, mut movements): (Option<Vec<&str>>, Option<Vec<&str>>) = (None, None);
    let (mut index, mut label) = (1, None);
    while let Some(word) = words.get(index) {
        if begins_list(word, matches!(label, Some(Token::Has | Token::Robots | Token::Moves))) {
            let (names, taken) = list(&words[index..])?;
            let slot =
                if label == Some(Token::Moves) || robots.is_some() { &mut movements } else { &mut robots };
            if slot.replace(names).is_some() {
                return None;
            }
            (index, label) = (index + taken, None);
            continue;
        }
        index += 1;
        let slot = match word.token {
            Token::Has | Token::Robots | Token::Moves | Token::Ip => {
                label = Some(word.token);
                continue;
            }
            Token::With => continue,
            _ if says_nothing(word) => continue,
            token if token.is_name() && label == Some(Token::Ip) => &mut ip,
            token if token.is_name() => &mut name,
            _ => return None,
        };
        if slot.replace(word.text.as_str()).is_some() {
            return None;
        }
    }
    let ip = ip.map_or(String::new(), |ip| format!(" with ip {ip}"));
    let movements = movements.map_or(String::new(), |names| format!(" with {{ {} }} moves", names.join(" ")));
    Some(format!("environment {}{ip} has {{ {} }} robots{movements}", name?, robots?.join(" ")))
}
