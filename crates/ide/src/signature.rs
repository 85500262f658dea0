//! Signature help: the syntax of the statement being typed on one line, with the next part highlighted.
//!
//! It opens on request only, because editors show it over the line above the cursor, and closes where the statement
//! ends. The syntax is that of the keyword pages, and the parser itself says which part is next, so neither can drift from
//! the language.

mod shape;

use pydslrep_analysis::Database;
use pydslrep_syntax::{EntityKind, Expected, Span, Token, TokenKind, expected_after, offset};

use self::shape::window;
use crate::FilePosition;
use crate::keyword_pages::keyword_page;
use crate::statements::Statements;

/// Why an editor asks for signature help.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SignatureTrigger {
    /// The user requested it.
    Invoked,
    /// It is shown, and the text or the cursor has changed.
    Retriggered,
}

/// The possible forms of a statement.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SignatureHelp {
    /// At least one.
    pub signatures: Vec<Signature>,
    /// The index of the form that fits the typed text.
    pub active: usize,
}

/// A form of a statement.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Signature {
    /// Its syntax, or the part that fits on one line; ASCII.
    pub label: String,
    /// The ranges of its parts in `label`.
    pub parts: Vec<Span>,
    /// The index of the next part; `None` if the typed text fits none.
    pub current: Option<usize>,
}

/// The signature help at a position.
pub fn signature_help(
    database: &Database,
    position: FilePosition,
    trigger: SignatureTrigger,
) -> Option<SignatureHelp> {
    let typed = Typed::before(database, position)?;
    let expected = expected_after(&typed.text, &typed.tokens);
    match trigger {
        SignatureTrigger::Invoked => invoked(&typed, &expected),
        SignatureTrigger::Retriggered => retriggered(&typed, &expected),
    }
}

fn invoked(typed: &Typed, expected: &[Expected]) -> Option<SignatureHelp> {
    let ends = expected.contains(&Expected::Declaration);
    if ends && typed.on_new_line {
        return None;
    }
    let statements = typed.statements();
    let mut around = statements.iter().flat_map(Statements::inside_out);
    let action = around.find_map(|action| signatures(action, expected).filter(SignatureHelp::is_marked));
    action.or_else(|| {
        let help = signatures(&typed.declaration(), expected)?;
        (help.is_marked() || !ends).then_some(help)
    })
}

/// Only for the statement at the cursor, as long as it can continue.
fn retriggered(typed: &Typed, expected: &[Expected]) -> Option<SignatureHelp> {
    let ends = expected.iter().any(|next| matches!(next, Expected::Declaration | Expected::Action));
    if ends && typed.on_new_line {
        return None;
    }
    let help = match typed.statements() {
        Some(statements) => signatures(statements.latest(), expected),
        None => signatures(&typed.declaration(), expected),
    };
    help.filter(SignatureHelp::is_marked)
}

impl SignatureHelp {
    fn is_marked(&self) -> bool {
        self.signatures.iter().any(|signature| signature.current.is_some())
    }
}

/// The typed part of an entity before the word at the cursor.
struct Typed {
    /// The entity's text.
    text: String,
    /// Its tokens, without comments.
    tokens: Vec<Token>,
    /// True if the cursor is on a later line than the last token.
    on_new_line: bool,
}

impl Typed {
    fn before(database: &Database, position: FilePosition) -> Option<Self> {
        let at_cursor = position.offset.checked_sub(1)?;
        let mut entity = database.entity_at(position.file, at_cursor)?;
        let touched = entity.parse.tokens.iter().find(|(token, span)| {
            let end = span.end + entity.span.start;
            let goes_on =
                is_word(*token) || matches!(token, TokenKind::LineComment | TokenKind::UnterminatedComment);
            span.start + entity.span.start < position.offset
                && (end > position.offset || goes_on && end == position.offset)
        });
        if touched.is_some_and(|(token, _)| token.is_comment()) {
            return None;
        }
        let cursor = touched.map_or(position.offset, |(_, span)| span.start + entity.span.start);
        if cursor == entity.span.start {
            // A typed word that equals a keyword is parsed as a new entity, but still continues the one before.
            entity = database.entity_at(position.file, cursor.checked_sub(1)?)?;
        }
        let start = entity.span.start;
        let before = entity.parse.tokens.iter().filter(|(token, _)| !token.is_comment());
        let tokens: Vec<Token> = before.take_while(|(_, span)| span.end + start <= cursor).copied().collect();
        let end = tokens.last()?.1.end;
        let text = database.slice(position.file, entity.span);
        let on_new_line = Span::new(end, cursor - start).text(&text).contains(['\n', '\r']);
        Some(Self { text, tokens, on_new_line })
    }

    /// The statements around the cursor; `None` outside the body of a movement.
    fn statements(&self) -> Option<Statements> {
        Statements::read(&self.tokens)
    }

    /// The tokens of the entity up to its body, where keywords that can be names are names.
    fn declaration(&self) -> Vec<Token> {
        let body = self.statements().and_then(|_| self.tokens.iter().position(opens));
        let written = body.map_or(&self.tokens[..], |body| &self.tokens[..=body]);
        let name = |(kind, span): &Token| (if kind.is_name() { TokenKind::Name } else { *kind }, *span);
        match written.split_first() {
            Some((first, rest)) => std::iter::once(*first).chain(rest.iter().map(name)).collect(),
            None => Vec::new(),
        }
    }
}

fn opens((token, _): &Token) -> bool {
    *token == TokenKind::OpenBrace
}

fn is_word(token: TokenKind) -> bool {
    let is_string = matches!(token, TokenKind::String | TokenKind::UnterminatedString);
    token.is_name() || token.is_keyword() || token.is_number() || is_string || token == TokenKind::Invalid
}

/// The forms of the statement that begins with these tokens, in which no name is a keyword.
fn signatures(typed: &[Token], expected: &[Expected]) -> Option<SignatureHelp> {
    // `parallel` has a page of its own with the same syntax.
    let page = keyword_page(typed.first()?.0).filter(|_| is_statement(typed[0].0))?;
    let signatures: Vec<Signature> = page
        .syntax
        .lines()
        .map(|label| {
            let parts = parts(label);
            let current = current(&parts, typed, expected);
            let parts = parts.iter().map(|part| part.span).collect();
            window(&Signature { label: label.to_owned(), parts, current })
        })
        .collect();
    let active = signatures.iter().position(|signature| signature.current.is_some()).unwrap_or(0);
    Some(SignatureHelp { signatures, active })
}

fn is_statement(token: TokenKind) -> bool {
    token.is_action() || TokenKind::DECLARATIONS.contains(&token)
}

/// A part of a form: a keyword, alternatives, or a placeholder.
struct Part {
    text: &'static str,
    span: Span,
    /// True if a brace opens before it.
    opens: bool,
    /// True if it may be left out.
    optional: bool,
}

fn parts(label: &'static str) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    let (mut opens, mut joins) = (false, false);
    let mut depth = 0;
    for word in label.split_whitespace() {
        depth += word.matches('[').count();
        let optional = depth > 0;
        depth -= word.matches(']').count().min(depth);
        match word.trim_matches(['[', ']']) {
            "{" => opens = true,
            "|" => joins = true,
            "}" => {}
            text => {
                // Both are slices of the label.
                let start = text.as_ptr() as usize - label.as_ptr() as usize;
                let span = Span::of(text).shifted(offset(start));
                match parts.last_mut() {
                    Some(last) if joins => {
                        last.span = last.span.to(span);
                        last.text = last.span.text(label);
                    }
                    _ => parts.push(Part { text, span, opens, optional }),
                }
                (opens, joins) = (false, false);
            }
        }
    }
    parts
}

/// The next part: the first after the typed keywords and braces that the parser would accept.
fn current(parts: &[Part], typed: &[Token], expected: &[Expected]) -> Option<usize> {
    let is_action = typed.first().is_some_and(|(token, _)| token.is_action());
    let mut next = 0;
    for (token, _) in typed {
        let rest = &parts[next..];
        match token {
            TokenKind::OpenBrace => next += rest.iter().position(|part| part.opens).unwrap_or(0),
            TokenKind::CloseBrace => {
                next += rest.iter().position(|part| part.opens).map_or(0, |list| list + 1);
            }
            TokenKind::Name | TokenKind::Comma => {}
            _ => match token.spelling().map(|word| rest.iter().position(|part| part.is_word(word))) {
                // An action has no keyword of another form, and leaves out none that is required.
                Some(None) if is_action => return None,
                Some(Some(place)) if is_action && rest[..place].iter().any(Part::must_be_written) => {
                    return None;
                }
                Some(Some(place)) => next += place + 1,
                Some(None) | None => {}
            },
        }
    }
    let accepted =
        parts[next..].iter().position(|part| expected.iter().any(|expected| part.accepts(*expected)));
    accepted.map(|place| next + place)
}

impl Part {
    fn is_word(&self, word: &str) -> bool {
        self.text.split(" | ").any(|choice| choice == word)
    }

    /// Returns whether it is a keyword, or one of several, that the form always has.
    fn must_be_written(&self) -> bool {
        !self.optional && self.text.starts_with(|first: char| first.is_ascii_lowercase())
    }

    fn accepts(&self, expected: Expected) -> bool {
        match expected {
            Expected::Word(TokenKind::OpenBrace) => self.opens,
            Expected::Word(word) => word.spelling().is_some_and(|word| self.is_word(word)),
            Expected::ReferenceTo(EntityKind::Robot) => matches!(self.text, "ROBOT" | "ROBOTS"),
            Expected::ReferenceTo(EntityKind::Movement) => matches!(self.text, "MOVEMENT" | "MOVEMENTS"),
            _ => placeholder(expected).is_some_and(|placeholder| self.text == placeholder),
        }
    }
}

/// The placeholder in the syntax for an expected item.
fn placeholder(expected: Expected) -> Option<&'static str> {
    Some(match expected {
        Expected::NameOf(_) => "NAME",
        Expected::ReferenceTo(EntityKind::Wheel) => "WHEELS",
        Expected::ReferenceTo(EntityKind::Sensor) => "SENSORS",
        Expected::ReferenceTo(EntityKind::Ip) => "IP",
        Expected::Number(quantity) => quantity.placeholder(),
        Expected::Port => "PORT",
        Expected::Address => "127.0.0.1",
        Expected::Path => "\"FILE.pyr\"",
        Expected::Action => "ACTIONS",
        Expected::ReferenceTo(_) | Expected::Word(_) | Expected::Declaration => return None,
    })
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;
    use crate::fixture::at_cursor;

    fn render(help: &SignatureHelp) -> String {
        let marked = |signature: &Signature| match signature.current {
            None => signature.label.clone(),
            Some(current) => {
                let span = signature.parts[current];
                let (start, end) = (span.start as usize, span.end as usize);
                let label = &signature.label;
                format!("{}«{}»{}", &label[..start], &label[start..end], &label[end..])
            }
        };
        let active = &help.signatures[help.active];
        format!("{} ({} of {})", marked(active), help.active + 1, help.signatures.len())
    }

    fn after(fixture: &str, trigger: SignatureTrigger) -> String {
        let (database, position) = at_cursor(fixture);
        let help = signature_help(&database, position, trigger);
        help.map_or_else(|| "nothing".to_owned(), |help| render(&help))
    }

    fn at(fixture: &str) -> String {
        after(fixture, SignatureTrigger::Invoked)
    }

    fn check(fixtures: &[&str], expected: &Expect) {
        expected.assert_eq(&fixtures.iter().map(|fixture| at(fixture) + "\n").collect::<String>());
    }

    #[test]
    fn the_next_part_is_highlighted() {
        check(
            &[
                "wheel $0",
                "wheel a $0",
                "wheel a with radius 4$0",
                "sensor s $0",
                "import \"$0",
                "ip i 12$0",
                "robot r $0",
                "robot r type $0",
                "robot r with port 1 has $0",
                "robot r with port 1 has { a $0 } wheels",
                "robot r with port 1 has { a } wheels $0",
                "robot r with port 1 has { a } wheels with $0",
                "environment e with ip $0",
                "environment e has { r } robots with { m $0",
                "parallel movement m of $0",
                "movement m of r { $0 }",
            ],
            &expect![[r#"
                wheel «NAME» with radius CENTIMETRES (1 of 1)
                wheel NAME «with» radius CENTIMETRES (1 of 1)
                wheel NAME with radius «CENTIMETRES» (1 of 1)
                sensor NAME [«:» distance | bumper] (1 of 1)
                import «"FILE.pyr"» (1 of 1)
                ip NAME «127.0.0.1» (1 of 1)
                ... [«type» tw | fw | fwh] with port PORT ... (1 of 1)
                ... [type «tw | fw | fwh»] with port PORT ... (1 of 1)
                ... with port PORT has { «WHEELS» } wheels ... (1 of 1)
                ... with port PORT has { «WHEELS» } wheels ... (1 of 1)
                ... [«with» sensors { SENSORS }] (1 of 1)
                ... [with «sensors» { SENSORS }] (1 of 1)
                ... [with ip «IP»] has { ROBOTS } robots ... (1 of 1)
                ... [with { «MOVEMENTS» } moves] (1 of 1)
                [parallel] movement NAME of «ROBOT» { ACTIONS } (1 of 1)
                [parallel] movement NAME of ROBOT { «ACTIONS» } (1 of 1)
            "#]],
        );
    }

    #[test]
    fn actions_have_their_own_syntax() {
        check(
            &[
                "movement m of r { slam move $0 }",
                "movement m of r { move 4 $0 turn left }",
                "movement m of r { move 4 meters $0",
                "movement m of r { move 4 meters at $0",
                "movement m of r { turn $0",
                "movement m of r { turn left $0",
                "movement m of r { turn left until { s $0",
                "movement m of r { turn left 90 $0",
                "movement m of r { slam $0",
            ],
            &expect![[r#"
                move «DISTANCE» meters | centimeters [at SPEED] (1 of 2)
                move DISTANCE «meters | centimeters» [at SPEED] (1 of 2)
                move DISTANCE meters | centimeters [«at» SPEED] (1 of 2)
                move DISTANCE meters | centimeters [at «SPEED»] (1 of 2)
                turn «left | right» [DEGREES] [with ... (1 of 3)
                turn left | right [«DEGREES»] [with ... (1 of 3)
                turn left | right until { «SENSORS» } (2 of 3)
                turn left | right [DEGREES] [«with» ... (1 of 3)
                [parallel] movement NAME of ROBOT { «ACTIONS» } (1 of 1)
            "#]],
        );
    }

    #[test]
    fn each_clause_and_block_has_its_part() {
        let fixtures = [
            "wait $0",
            "wait 2 $0",
            "wait until $0",
            "wait until { s $0",
            "wait until { wait clear } $0",
            "wait until { s } clear $0",
            "wait until { s } clear within $0",
            "wait 2 seconds until { s } detect within 3 $0",
            "move at 5 $0",
            "move until { s } detect within $0",
            "turn left with $0",
            "turn left with radius $0",
            "turn left with radius 3 $0",
            "turn left with radius 3 meters $0",
            "turn left with radius 3 meters in $0",
            "turn left until { s } $0",
            "repeat $0",
            "repeat 4 $0",
            "repeat 4 times $0",
            "repeat 4 times { $0",
            "repeat 4 times { slam $0",
            "repeat 4 times { slam } $0",
            "repeat until { s } clear $0",
            "repeat until { s } clear { $0 }",
            "if $0",
            "if { s } $0",
            "if { s } clear { slam } $0",
            "if { s } clear { slam } else $0",
            "if { s } clear { slam } else if { $0",
            "if { s } clear { slam } else if { s } clear { move 2 $0 }",
            "do $0",
        ];
        let shown = |action: &&str| format!("{action}: {}\n", at(&format!("movement m of r {{ {action}")));
        let shown: String = fixtures.iter().map(shown).collect();
        expect![[r#"
            wait $0: wait «SECONDS» seconds (1 of 2)
            wait 2 $0: wait SECONDS «seconds» (1 of 2)
            wait until $0: ... until { «SENSORS» } clear | detect ... (2 of 2)
            wait until { s $0: ... until { «SENSORS» } clear | detect ... (2 of 2)
            wait until { wait clear } $0: ... until { SENSORS } «clear | detect» ... (2 of 2)
            wait until { s } clear $0: ... [«within» DISTANCE meters | centimeters] (2 of 2)
            wait until { s } clear within $0: ... [within «DISTANCE» meters | centimeters] (2 of 2)
            wait 2 seconds until { s } detect within 3 $0: ... [within DISTANCE «meters | centimeters»] (2 of 2)
            move at 5 $0: ... «until» { SENSORS } clear | detect ... (2 of 2)
            move until { s } detect within $0: ... [within «DISTANCE» meters | centimeters] (2 of 2)
            turn left with $0: ... «radius» DISTANCE meters | centimeters] ... (1 of 3)
            turn left with radius $0: ... radius «DISTANCE» meters | centimeters] ... (1 of 3)
            turn left with radius 3 $0: ... radius DISTANCE «meters | centimeters»] ... (1 of 3)
            turn left with radius 3 meters $0: ... [«at» SPEED] [in reverse] (1 of 3)
            turn left with radius 3 meters in $0: ... [at SPEED] [in «reverse»] (1 of 3)
            turn left until { s } $0: ... until { SENSORS } «clear | detect» ... (3 of 3)
            repeat $0: repeat «COUNT» times { ACTIONS } (1 of 2)
            repeat 4 $0: repeat COUNT «times» { ACTIONS } (1 of 2)
            repeat 4 times $0: repeat COUNT times { «ACTIONS» } (1 of 2)
            repeat 4 times { $0: repeat COUNT times { «ACTIONS» } (1 of 2)
            repeat 4 times { slam $0: repeat COUNT times { «ACTIONS» } (1 of 2)
            repeat 4 times { slam } $0: [parallel] movement NAME of ROBOT { «ACTIONS» } (1 of 1)
            repeat until { s } clear $0: ... [«within» DISTANCE meters | centimeters] ... (2 of 2)
            repeat until { s } clear { $0 }: ... { «ACTIONS» } (2 of 2)
            if $0: if { «SENSORS» } clear | detect ... (1 of 1)
            if { s } $0: if { SENSORS } «clear | detect» ... (1 of 1)
            if { s } clear { slam } $0: ... { ACTIONS } [«else» { ACTIONS }] (1 of 1)
            if { s } clear { slam } else $0: ... { ACTIONS } [else { «ACTIONS» }] (1 of 1)
            if { s } clear { slam } else if { $0: if { «SENSORS» } clear | detect ... (1 of 1)
            if { s } clear { slam } else if { s } clear { move 2 $0 }: move DISTANCE «meters | centimeters» [at SPEED] (1 of 2)
            do $0: do «MOVEMENT» (1 of 1)
        "#]].assert_eq(&shown);
    }

    #[test]
    fn entities_with_errors_have_help() {
        check(
            &[
                "robot r with prt $0",
                "wheel a with with $0",
                "movement m of r { move meters $0",
                "environment e has { robot$0",
            ],
            &expect![[r#"
                ... with port «PORT» has { WHEELS } wheels ... (1 of 1)
                wheel NAME with «radius» CENTIMETRES (1 of 1)
                move DISTANCE meters | centimeters [«at» SPEED] (1 of 2)
                ... [with ip IP] has { «ROBOTS» } robots ... (1 of 1)
            "#]],
        );
    }

    #[test]
    fn requested_help_closes_at_the_end_of_the_statement() {
        let again =
            |fixture: &&str| format!("{fixture:?}: {}\n", after(fixture, SignatureTrigger::Retriggered));
        let shown: String = [
            "wheel a with radius $0",
            "wheel a with radius 4 $0",
            "robot r with port 1 has { a } wheels $0",
            "robot r with port 1 has { a } wheels\n$0",
            "movement m of r $0",
            "movement m of r { $0",
            "movement m of r { move 4 $0",
            "movement m of r { move 4 meters $0",
            "movement m of r {\n  move 4 meters\n  $0",
            "movement m of r { move 4 meters at 9 $0",
            "movement m of r { turn left $0",
            "movement m of r { turn left 90 $0",
            "movement m of r { turn left until { s $0",
            "movement m of r { turn left until { s } $0",
            "movement m of r { turn left } $0",
        ]
        .iter()
        .map(again)
        .collect();
        expect![[r#"
            "wheel a with radius $0": wheel NAME with radius «CENTIMETRES» (1 of 1)
            "wheel a with radius 4 $0": nothing
            "robot r with port 1 has { a } wheels $0": ... [«with» sensors { SENSORS }] (1 of 1)
            "robot r with port 1 has { a } wheels\n$0": nothing
            "movement m of r $0": [parallel] movement NAME of ROBOT { «ACTIONS» } (1 of 1)
            "movement m of r { $0": nothing
            "movement m of r { move 4 $0": move DISTANCE «meters | centimeters» [at SPEED] (1 of 2)
            "movement m of r { move 4 meters $0": move DISTANCE meters | centimeters [«at» SPEED] (1 of 2)
            "movement m of r {\n  move 4 meters\n  $0": nothing
            "movement m of r { move 4 meters at 9 $0": ... «until» { SENSORS } clear | detect ... (2 of 2)
            "movement m of r { turn left $0": turn left | right [«DEGREES»] [with ... (1 of 3)
            "movement m of r { turn left 90 $0": turn left | right [DEGREES] [«with» ... (1 of 3)
            "movement m of r { turn left until { s $0": turn left | right until { «SENSORS» } (2 of 3)
            "movement m of r { turn left until { s } $0": ... until { SENSORS } «clear | detect» ... (3 of 3)
            "movement m of r { turn left } $0": nothing
        "#]]
        .assert_eq(&shown);
    }

    #[test]
    fn every_form_fits_on_a_line() {
        for (token, _) in pydslrep_syntax::KEYWORDS {
            let Some(page) = keyword_page(token).filter(|_| is_statement(token)) else { continue };
            for label in page.syntax.lines() {
                let parts: Vec<Span> = parts(label).iter().map(|part| part.span).collect();
                for current in 0..parts.len() {
                    let whole =
                        Signature { label: label.to_owned(), parts: parts.clone(), current: Some(current) };
                    let shown = window(&whole);
                    assert!(shown.label.len() <= 48, "{}", shown.label);
                    let text = |of: &Signature| of.parts[of.current.unwrap()].text(&of.label).to_owned();
                    assert_eq!(text(&shown), text(&whole), "{}", shown.label);
                }
            }
        }
    }

    #[test]
    fn there_is_none_elsewhere() {
        for fixture in
            ["$0", "wheel a with radius 4 $0", "sensor s\n$0", "wheel // $0", "foo $0", "wheel$0", "// $0"]
        {
            assert_eq!(at(fixture), "nothing", "{fixture}");
        }
    }

    /// The texts that a form allows, with placeholders filled in.
    fn written(label: &str) -> Vec<String> {
        let optional = |keep: bool| {
            let mut out = String::new();
            let mut depth = 0;
            for c in label.chars() {
                match c {
                    '[' => depth += 1,
                    ']' => depth -= 1,
                    c if keep || depth == 0 => out.push(c),
                    _ => {}
                }
            }
            out
        };
        let choose = |label: String, last: bool| {
            let mut words: Vec<&str> = Vec::new();
            let all: Vec<&str> = label.split_whitespace().collect();
            let mut joins = false;
            for word in all {
                if word == "|" {
                    joins = true;
                } else if !joins {
                    words.push(word);
                } else {
                    joins = false;
                    if last {
                        words.pop();
                        words.push(word);
                    }
                }
            }
            words.join(" ")
        };
        let filled = |label: String| {
            let number = ["CENTIMETRES", "PORT", "DISTANCE", "SPEED", "DEGREES", "SECONDS", "COUNT"];
            let fill = |word: &str| match word {
                _ if number.contains(&word) => "7".to_owned(),
                "ACTIONS" => "slam".to_owned(),
                _ if word.chars().all(|c| c.is_ascii_uppercase()) => "x".to_owned(),
                _ => word.to_owned(),
            };
            label.split(' ').map(fill).collect::<Vec<_>>().join(" ")
        };
        let mut all = Vec::new();
        for keep in [false, true] {
            for last in [false, true] {
                all.push(filled(choose(optional(keep), last)));
            }
        }
        all
    }

    #[test]
    fn all_forms_parse() {
        for (token, _) in pydslrep_syntax::KEYWORDS {
            if !is_statement(token) {
                continue;
            }
            let in_movement = token.is_action();
            for label in keyword_page(token).unwrap().syntax.lines() {
                for text in written(label) {
                    let text = if in_movement { format!("movement m of r {{ {text} }}") } else { text };
                    let pieces = pydslrep_syntax::parse(&text);
                    assert_eq!(pieces.len(), 1, "{text}");
                    assert_eq!(pieces[0].1.errors, [], "{text}");
                }
            }
        }
    }
}
