//! Common mistakes of people who know another language, or who misplace a part: each gets its own message.

use pydslrep_syntax::ast::Entity;
use pydslrep_syntax::{Expected, Quantity, Span, TokenKind};

use super::{RULE, repair, words};
use crate::diagnostics::context::Context;
use crate::diagnostics::problem::{Brace, Problem};

/// The problem in its own words, if it is a common mistake.
pub(super) fn problem(
    context: &Context<'_>,
    span: Span,
    expected: &[Expected],
    found: &str,
) -> Option<Problem> {
    let place = TokenContext::new(context, span)?;
    if expected == [Expected::Path] {
        return Some(path(context, span, found));
    }
    quoted(&place, found)
        .or_else(|| distance_unit(&place, expected, found))
        .or_else(|| time_unit(&place, expected, found))
        .or_else(|| glued_to_number(&place, expected))
        .or_else(|| number_for_name(&place, expected, found))
        .or_else(|| needless_word(&place, expected, found))
        .or_else(|| combined(&place, found))
        .or_else(|| way_of_moving(&place, expected, found))
        .or_else(|| angle_first(&place, found))
        .or_else(|| foreign_action(&place, expected, found))
        .or_else(|| needless_unit(&place, found))
        .or_else(|| decimal_comma(&place))
        .or_else(|| two_names(&place, expected, found))
        .or_else(|| action_outside(&place, expected, found))
        .or_else(|| stray_brace(&place, expected))
        .or_else(|| another_sensor(&place, expected))
        .or_else(|| separator(&place, expected, found))
        .or_else(|| address(&place, expected, found))
        .or_else(|| port_of_address(&place))
}

/// A token and those around it, comments left out.
struct TokenContext<'a, 'c> {
    context: &'a Context<'c>,
    span: Span,
    tokens: Vec<(TokenKind, Span)>,
    index: usize,
}

impl<'a, 'c> TokenContext<'a, 'c> {
    fn new(context: &'a Context<'c>, span: Span) -> Option<Self> {
        /// No common mistake is longer.
        const AROUND: usize = 4;
        let all = context.tokens;
        let at = all.partition_point(|(_, other)| other.start < span.start);
        let is_token = |(token, _): &&(TokenKind, Span)| !token.is_comment();
        let mut tokens: Vec<_> = all.get(..at)?.iter().rev().filter(is_token).take(AROUND).copied().collect();
        tokens.reverse();
        let index = tokens.len();
        tokens.extend(all.get(at..)?.iter().filter(is_token).take(AROUND));
        Some(Self { context, span, tokens, index })
    }

    /// The token so many places before it.
    fn before(&self, by: usize) -> Option<(TokenKind, Span)> {
        self.tokens.get(self.index.checked_sub(by)?).copied()
    }

    fn written(&self) -> &str {
        self.context.text(self.span)
    }

    fn here(&self) -> Option<TokenKind> {
        self.tokens.get(self.index).map(|(token, _)| *token)
    }

    fn after(&self) -> Option<(TokenKind, Span)> {
        self.tokens.get(self.index + 1).copied()
    }
}

/// `import parts.pyr`
fn path(context: &Context<'_>, span: Span, found: &str) -> Problem {
    let problem = RULE
        .problem(span, format!("expected a path in quotes, found `{found}`"))
        .help("an import is written `import \"wheels.pyr\"`");
    let bare = found.trim_matches(|c: char| "'\"`<>“”„‘’«»();".contains(c));
    let is_path = !bare.is_empty() && bare.chars().all(|c| c.is_alphanumeric() || "_-./".contains(c));
    let file = format!("{}.pyr", bare.strip_suffix(".pyr").unwrap_or(bare));
    if !is_path || bare.starts_with('/') || bare.contains("..") {
        return problem;
    }
    problem.suggestion(format!("write `\"{file}\"`"), [context.replace(span, format!("\"{file}\""))])
}

/// `move 40 cm`
fn distance_unit(place: &TokenContext<'_, '_>, expected: &[Expected], found: &str) -> Option<Problem> {
    if !expected.contains(&Expected::Word(TokenKind::Meters)) {
        return None;
    }
    let word = match found.to_lowercase().as_str() {
        "cm" | "cms" | "centi" => "centimeters",
        "m" => "meters",
        "mm" | "km" | "dm" | "inch" | "inches" | "feet" | "ft" | "yards" | "millimeters" | "kilometers" => {
            return Some(
                RULE.problem(
                    place.span,
                    format!("distances are in `meters` or `centimeters`, not `{found}`"),
                )
                .help("convert the number and write one of these units"),
            );
        }
        _ => return None,
    };
    Some(written_out(place, word, found))
}

/// `wait 2 sec`, `wait 500 ms`
fn time_unit(place: &TokenContext<'_, '_>, expected: &[Expected], found: &str) -> Option<Problem> {
    if !expected.contains(&Expected::Word(TokenKind::Seconds)) {
        return None;
    }
    let factor = match found.to_lowercase().as_str() {
        "s" | "sec" | "secs" => return Some(written_out(place, "seconds", found)),
        "ms" | "msec" | "millis" | "millisecond" | "milliseconds" => 0.001,
        "min" | "mins" | "minute" | "minutes" => 60.0,
        "h" | "hour" | "hours" => 3600.0,
        _ => return None,
    };
    let problem = RULE
        .problem(place.span, format!("times are in `seconds`, not `{found}`"))
        .help("convert the number and write `seconds`");
    let (_, number) = place.before(1)?;
    let Some(value) = converted(place.context.text(number), factor) else { return Some(problem) };
    let text = format!("{value} seconds");
    let edit = place.context.replace(number.to(place.span), text.clone());
    Some(problem.suggestion(format!("change to `{text}`"), [edit]))
}

/// A unit that was shortened.
fn written_out(place: &TokenContext<'_, '_>, word: &str, found: &str) -> Problem {
    let glued = place.before(1).is_some_and(|(_, before)| before.end == place.span.start);
    let text = if glued { format!(" {word}") } else { word.to_owned() };
    RULE.problem(place.span, format!("units are written out: `{word}`, not `{found}`"))
        .fix(format!("change to `{word}`"), [place.context.replace(place.span, text)])
}

/// `radius 4.5 cm`, `at 9 cm/s`, `turn left 90 degrees`
fn needless_unit(place: &TokenContext<'_, '_>, found: &str) -> Option<Problem> {
    const CENTIMETRES: [&str; 7] =
        ["cm", "cms", "centimeter", "centimeters", "centimetre", "centimetres", "centi"];
    const OTHERS: [&str; 8] = ["mm", "m", "meter", "meters", "metres", "inch", "inches", "s"];
    const DEGREES: [&str; 5] = ["degrees", "degree", "deg", "degs", "grad"];
    let (number, number_span) = place.before(1)?;
    if !number.is_number() {
        return None;
    }
    let (what, unit, own): (&str, &str, &[&str]) = match place.before(2)?.0 {
        TokenKind::Radius => ("a radius", "centimetres", &CENTIMETRES),
        TokenKind::At => ("a speed", "centimetres per second", &CENTIMETRES),
        TokenKind::Left | TokenKind::Right => ("an angle", "degrees", &DEGREES),
        _ => return None,
    };
    let known = own.contains(&found) || OTHERS.contains(&found);
    let whole = glued(place);
    let written = place.context.text(whole);
    let problem = RULE.problem(whole, format!("{what} is always in {unit}, so no unit is written"));
    let problem = problem.help(if own.contains(&found) {
        format!("leave `{written}` out")
    } else {
        format!("convert the number to {unit}, and leave `{written}` out")
    });
    if !known {
        return None;
    }
    let edit = place.context.remove(whole);
    if own.contains(&found) {
        return Some(problem.fix(format!("remove `{written}`"), [edit]));
    }
    let length = matches!(place.before(2), Some((TokenKind::Radius | TokenKind::At, _)));
    let factor = match found {
        "mm" => 0.1,
        "m" | "meter" | "meters" | "metres" => 100.0,
        _ => return Some(problem),
    };
    let converted = converted(place.context.text(number_span), factor).filter(|_| length);
    Some(match converted {
        Some(value) => {
            let edit = place.context.replace(number_span.to(whole), value.clone());
            problem.suggestion(format!("change to `{value}`"), [edit])
        }
        None => problem,
    })
}

/// A number times another one, as it is written.
fn converted(number: &str, factor: f64) -> Option<String> {
    /// Without what a multiplication of binary fractions adds.
    const DIGITS: f64 = 1e9;
    let value = number.parse::<f64>().ok().filter(|value| value.is_finite())?;
    Some(((value * factor * DIGITS).round() / DIGITS).to_string())
}

/// The token with what follows it without a space: `cm/s`.
fn glued(place: &TokenContext<'_, '_>) -> Span {
    let rest = place.tokens[place.index..].iter().map(|(_, span)| *span);
    rest.reduce(|all, next| if all.end == next.start { all.to(next) } else { all }).unwrap_or(place.span)
}

/// `4,5`
fn decimal_comma(place: &TokenContext<'_, '_>) -> Option<Problem> {
    let ((before, whole), (after, fraction)) = (place.before(1)?, place.after()?);
    let glued = whole.end == place.span.start && place.span.end == fraction.start;
    let digits = before == TokenKind::Integer && after == TokenKind::Integer;
    if place.here() != Some(TokenKind::Comma) || !glued || !digits {
        return None;
    }
    let edit = place.context.replace(place.span, ".");
    if !repair::is_fixed(place.context, std::slice::from_ref(&edit)) {
        return None;
    }
    let number = format!("{}.{}", place.context.text(whole), place.context.text(fraction));
    Some(
        RULE.problem(whole.to(fraction), format!("a number has a point, not a comma: `{number}`"))
            .fix(format!("write `{number}`"), [edit]),
    )
}

/// `robot my rover with …`
fn two_names(place: &TokenContext<'_, '_>, expected: &[Expected], found: &str) -> Option<Problem> {
    let (before, first) = place.before(1)?;
    let declared = place.before(2).is_some_and(|(token, _)| token.entity_kind().is_some());
    let wanted = expected.iter().all(|expected| matches!(expected, Expected::Word(_)));
    if !declared || !wanted || before != TokenKind::Name || place.here() != Some(TokenKind::Name) {
        return None;
    }
    let gap = place.context.join(Span::new(first.end, place.span.start), "_");
    let name = format!("{}_{found}", place.context.text(first));
    (place.context.text(first) != found && repair::is_fixed(place.context, std::slice::from_ref(&gap))).then(
        || {
            RULE.problem(place.span, format!("a name is one word, so `{found}` does not belong here"))
                .help(format!("join the words, such as `{name}`"))
                .suggestion(format!("write `{name}`"), [gap])
        },
    )
}

/// `move 4 meters` between declarations.
fn action_outside(place: &TokenContext<'_, '_>, expected: &[Expected], found: &str) -> Option<Problem> {
    let is_action = place.here().is_some_and(TokenKind::is_action);
    if !is_action || !expected.contains(&Expected::Declaration) {
        return None;
    }
    let problem =
        RULE.problem(place.span, format!("`{found}` is an action, and actions stand in a movement"));
    Some(if let Some(Entity::Movement(_)) = place.context.tree {
        problem.help("the movement before it is closed; put the action before its `}`")
    } else {
        problem.help("put it between the braces of one: `movement NAME of ROBOT { ACTIONS }`")
    })
}

/// `}` where nothing is open.
fn stray_brace(place: &TokenContext<'_, '_>, expected: &[Expected]) -> Option<Problem> {
    if place.here() != Some(TokenKind::CloseBrace)
        || expected.contains(&Expected::Word(TokenKind::CloseBrace))
    {
        return None;
    }
    let problem = RULE
        .problem(place.span, "this `}` closes nothing")
        .brace(Brace::Stray)
        .help("remove it, or write the `{` that it closes");
    let edit = place.context.remove(place.span);
    let fixed = repair::is_fixed(place.context, std::slice::from_ref(&edit));
    Some(if fixed { problem.suggestion("remove `}`", [edit]) } else { problem })
}

/// A comma where nothing is listed.
fn separator(place: &TokenContext<'_, '_>, expected: &[Expected], found: &str) -> Option<Problem> {
    let what = if expected.contains(&Expected::Declaration) {
        "declarations"
    } else if expected.contains(&Expected::Action) {
        "actions"
    } else {
        return None;
    };
    if place.here() != Some(TokenKind::Comma) {
        return None;
    }
    let problem =
        RULE.problem(place.span, format!("{what} follow each other without `{found}`")).help("leave it out");
    let edit = place.context.remove(place.span);
    let fixed = repair::is_fixed(place.context, std::slice::from_ref(&edit));
    Some(if fixed { problem.fix(format!("remove `{found}`"), [edit]) } else { problem })
}

/// `ip home localhost`, `ip home 127.0.1`
fn address(place: &TokenContext<'_, '_>, expected: &[Expected], found: &str) -> Option<Problem> {
    if !expected.contains(&Expected::Address) {
        return None;
    }
    if found.eq_ignore_ascii_case("localhost") {
        return Some(
            RULE.problem(place.span, "an address is written in numbers, not as `localhost`")
                .help("`127.0.0.1` is this computer")
                .fix("change to `127.0.0.1`", [place.context.replace(place.span, "127.0.0.1")]),
        );
    }
    place.here().filter(|token| token.is_number())?;
    Some(
        RULE.problem(
            place.span,
            format!("`{found}` is not an address: it has four numbers with points between them"),
        )
        .help("an address is written such as `192.168.0.7`; `127.0.0.1` is this computer"),
    )
}

/// `wheel "a" with …`
fn quoted(place: &TokenContext<'_, '_>, found: &str) -> Option<Problem> {
    let inner = found.strip_prefix('"')?.strip_suffix('"')?;
    let edit = place.context.replace(place.span, inner);
    let fixed = !inner.is_empty() && repair::is_fixed(place.context, std::slice::from_ref(&edit));
    fixed.then(|| {
        RULE.problem(place.span, format!("only the path of an import stands in quotes: write `{inner}`"))
            .fix(format!("write `{inner}`"), [edit])
    })
}

/// `1e2`, `0x10`, `1_000`
fn glued_to_number(place: &TokenContext<'_, '_>, expected: &[Expected]) -> Option<Problem> {
    let (number, before) = place.before(1)?;
    let glued = number.is_number() && before.end == place.span.start;
    let is_unit = |word| expected.contains(&Expected::Word(word));
    let units = is_unit(TokenKind::Meters)
        || is_unit(TokenKind::Seconds)
        || is_unit(TokenKind::Times)
        || needless_unit(place, place.written()).is_some();
    let known = units && !place.written().contains(|c: char| c.is_ascii_digit());
    (glued && !known && place.here() == Some(TokenKind::Name)).then(|| {
        let whole = before.to(place.span);
        RULE.problem(whole, format!("`{}` is not a number", place.context.text(whole)))
            .help("write digits, and at most one point between them, such as `4` or `4.5`")
    })
}

/// `wheel 1 with …`
fn number_for_name(place: &TokenContext<'_, '_>, expected: &[Expected], found: &str) -> Option<Problem> {
    let reference = expected.contains(&Expected::ReferenceTo(pydslrep_syntax::EntityKind::Ip));
    if reference && place.here() == Some(TokenKind::Ipv4) {
        return Some(
            RULE.problem(place.span, format!("expected the name of an ip, found the address `{found}`"))
                .help(format!("declare it, such as `ip home {found}`, and write its name here")),
        );
    }
    let wanted = expected.iter().any(|expected| matches!(expected, Expected::NameOf(_)));
    let plain =
        matches!(place.here(), Some(TokenKind::Integer | TokenKind::Float | TokenKind::MalformedNumber));
    (wanted && plain).then(|| {
        RULE.problem(place.span, format!("a name cannot start with a digit, as `{found}` does"))
            .help("names start with a letter or `_`, such as `wheel_1`")
    })
}

/// `turn left by 90`, `wait for 2 seconds`
fn needless_word(place: &TokenContext<'_, '_>, expected: &[Expected], found: &str) -> Option<Problem> {
    let (before, span) = place.before(1)?;
    let why = match before {
        TokenKind::Left | TokenKind::Right => "the angle comes right after the direction".to_owned(),
        _ if before.is_action() => {
            let quantity = expected.iter().find_map(|expected| match expected {
                Expected::Number(quantity) => Some(*quantity),
                _ => None,
            });
            let what = match quantity? {
                Quantity::Count if before.begins_block() => "number of rounds",
                quantity => quantity.noun(),
            };
            format!("the {what} comes right after `{}`", place.context.text(span))
        }
        _ => return None,
    };
    if !["by", "for"].contains(&found) || !place.after()?.0.is_number() {
        return None;
    }
    let problem = RULE.problem(place.span, format!("`{found}` is not needed: {why}"));
    let edit = place.context.remove_word(place.span);
    let fixed = repair::is_fixed(place.context, std::slice::from_ref(&edit));
    Some(if fixed { problem.fix(format!("remove `{found}`"), [edit]) } else { problem })
}

/// `if { front } detect and { left } clear { … }`
fn combined(place: &TokenContext<'_, '_>, found: &str) -> Option<Problem> {
    let help = match found {
        "and" => "put one `if` into the block of another, or list the sensors in one condition",
        "or" => "list the sensors in one condition, or write one `if` after another",
        _ => return None,
    };
    let follows = matches!(
        place.before(1)?.0,
        TokenKind::CloseBrace
            | TokenKind::Clear
            | TokenKind::Detect
            | TokenKind::Meters
            | TokenKind::Centimeters
    );
    follows.then(|| RULE.problem(place.span, format!("conditions are not combined by `{found}`")).help(help))
}

/// `move forward 4 meters`
fn way_of_moving(place: &TokenContext<'_, '_>, expected: &[Expected], found: &str) -> Option<Problem> {
    let early = expected.contains(&Expected::Number(Quantity::Distance));
    let late = matches!(place.before(1), Some((TokenKind::Meters | TokenKind::Centimeters, _)));
    if !early && !late {
        return None;
    }
    let word = found.to_lowercase();
    let problem =
        RULE.problem(place.span, format!("a move goes straight ahead, so `{found}` does not belong here"));
    match word.as_str() {
        "forward" | "forwards" | "ahead" | "straight" => {
            let edit = place.context.remove_word(place.span);
            Some(problem.help("leave it out").suggestion(format!("remove `{found}`"), [edit]))
        }
        "back" | "backward" | "backwards" => {
            Some(problem.help("a negative distance moves backwards: `move -4 meters`"))
        }
        "left" | "right" => {
            Some(problem.help(format!("turn before you move: `turn {word}` and then `move 4 meters`")))
        }
        _ => None,
    }
}

/// `turn 90 left`
fn angle_first(place: &TokenContext<'_, '_>, found: &str) -> Option<Problem> {
    let number = matches!(place.here(), Some(TokenKind::Integer | TokenKind::Float));
    let (after, direction) = place.after()?;
    let turn = matches!(place.before(1), Some((TokenKind::Turn, _)))
        && matches!(after, TokenKind::Left | TokenKind::Right);
    if !number || !turn {
        return None;
    }
    let word = place.context.text(direction);
    let edits = [place.context.replace(place.span, word), place.context.replace(direction, found)];
    let problem =
        RULE.problem(place.span, format!("the angle comes after the direction: `turn {word} {found}`"));
    Some(if repair::is_fixed(place.context, &edits) {
        problem.fix(format!("write `turn {word} {found}`"), edits)
    } else {
        problem
    })
}

/// `go 4 meters`, `sleep 5`
fn foreign_action(place: &TokenContext<'_, '_>, expected: &[Expected], found: &str) -> Option<Problem> {
    if !expected.contains(&Expected::Action) {
        return None;
    }
    let problem = RULE.problem(place.span, format!("there is no action `{found}`"));
    let keyword = match found.to_lowercase().as_str() {
        "go" | "drive" | "forward" | "walk" | "run" | "advance" => "move",
        "rotate" | "spin" | "rotation" => "turn",
        "sleep" | "pause" => "wait",
        "when" => "if",
        "loop" => "repeat",
        "stop" | "halt" => {
            return Some(
                problem.help("a robot stops by itself when its movement is over, and the next one follows"),
            );
        }
        "for" | "while" | "forever"
            if !matches!(place.before(1), Some((TokenKind::Left | TokenKind::Right, _))) =>
        {
            return Some(problem.help(words::action(TokenKind::Repeat)));
        }
        "else" => return Some(problem.help("`else` follows the block of an `if`")),
        _ => return None,
    };
    let edit = place.context.replace(place.span, keyword);
    let problem = problem.help(format!("did you mean `{keyword}`?"));
    let fixed = repair::is_fixed(place.context, std::slice::from_ref(&edit));
    Some(if fixed { problem.suggestion(format!("change to `{keyword}`"), [edit]) } else { problem })
}

/// `sensor s, t`
fn another_sensor(place: &TokenContext<'_, '_>, expected: &[Expected]) -> Option<Problem> {
    let Some(Entity::Sensor(_)) = place.context.tree else { return None };
    let (next, name) = place.after()?;
    if place.here() != Some(TokenKind::Comma) || !expected.contains(&Expected::Declaration) || !next.is_name()
    {
        return None;
    }
    let problem = RULE
        .problem(place.span, "each sensor is declared on its own")
        .help(format!("write `sensor {}` on a line of its own", place.context.text(name)));
    let gap = place.context.replace(Span::new(place.span.start, name.start), "\nsensor ");
    let fixed = repair::is_split(place.context, std::slice::from_ref(&gap));
    Some(if fixed { problem.suggestion("declare it on its own", [gap]) } else { problem })
}

/// `ip home 127.0.0.1:23000`
fn port_of_address(place: &TokenContext<'_, '_>) -> Option<Problem> {
    let address = matches!(place.before(1), Some((TokenKind::Ipv4, _)));
    (address && place.here() == Some(TokenKind::Colon)).then(|| {
        RULE.problem(place.span, "an ip is an address without a port")
            .help("each robot has its port: `robot NAME with port 23000 has …`")
    })
}
