//! "Grammar" of the specification: one function per rule, in the same order. `None` means: not in the language.

mod actions;

use std::cell::Cell;
use std::collections::BTreeSet;
use std::ops::Range;

use crate::Finding;
use crate::program::{Body, Entity, Environment, Ip, Movement, Name, Number, Program, Robot, Sensor, Wheel};
use crate::robot_types;
use crate::tokens::{Kind, Token};

pub(crate) fn read(tokens: &[Token], end: usize) -> Option<Program> {
    Reader::new(tokens, end).program()
}

/// The keywords and punctuation expected at the end of the tokens; `None` if no program begins like this.
pub(crate) fn expected(tokens: &[Token], end: usize) -> Option<BTreeSet<&'static str>> {
    let mut reader = Reader::new(tokens, end);
    if reader.imports().and_then(|_| reader.entities()).is_some() {
        // The next entity.
        let _ = reader.entity();
    }
    reader.ran_out.get().then_some(reader.expected)
}

struct Reader<'a> {
    tokens: &'a [Token],
    at: usize,
    /// The end of the text.
    end: usize,
    older_spellings: Vec<Finding>,
    /// Whether anything was expected after the last token.
    ran_out: Cell<bool>,
    /// The keywords and punctuation that were expected there.
    expected: BTreeSet<&'static str>,
}

impl<'a> Reader<'a> {
    fn new(tokens: &'a [Token], end: usize) -> Self {
        let (ran_out, expected) = (Cell::new(false), BTreeSet::new());
        Self { tokens, at: 0, end, older_spellings: Vec::new(), ran_out, expected }
    }
}

impl Reader<'_> {
    fn peek(&self) -> Option<&Token> {
        let token = self.tokens.get(self.at);
        if token.is_none() {
            self.ran_out.set(true);
        }
        token
    }

    fn sees_any(&self) -> bool {
        self.peek().is_some()
    }

    /// The next token, if it is of this kind.
    fn next(&mut self, kind: Kind) -> Option<Token> {
        let token = self.peek().filter(|token| token.kind == kind)?.clone();
        self.at += 1;
        Some(token)
    }

    fn sees(&mut self, word: &'static str) -> bool {
        let is_word = |token: &Token| matches!(token.kind, Kind::Keyword | Kind::Sign) && token.text == word;
        let seen = self.peek().map(is_word);
        if seen.is_none() {
            self.expected.insert(word);
        }
        seen == Some(true)
    }

    fn word(&mut self, word: &'static str) -> Option<Range<usize>> {
        if !self.sees(word) {
            return None;
        }
        let range = self.peek()?.range.clone();
        self.at += 1;
        Some(range)
    }

    fn one_of(&mut self, words: &[&'static str]) -> Option<&'static str> {
        words.iter().copied().find(|word| self.word(word).is_some())
    }

    /// A contextual keyword, which is also a valid name: `distance`, `repeat` and so on, without `^`.
    fn contextual(&mut self, word: &'static str) -> Option<Range<usize>> {
        if self.peek().is_none() {
            self.expected.insert(word);
        }
        let plain = |token: &&Token| {
            token.kind == Kind::Name && token.text == word && token.range.len() == word.len()
        };
        let range = self.peek().filter(plain)?.range.clone();
        self.at += 1;
        Some(range)
    }

    fn last_end(&self) -> usize {
        self.tokens[..self.at].last().map_or(self.end, |token| token.range.end)
    }

    /// The start of the next token.
    fn start(&self) -> usize {
        self.peek().map_or(self.end, |token| token.range.start)
    }

    fn name(&mut self) -> Option<Name> {
        self.next(Kind::Name).map(|token| Name { text: token.text, range: token.range })
    }

    fn number(&mut self) -> Option<Number> {
        self.next(Kind::Number).map(|token| Number { text: token.text, range: token.range })
    }

    /// `[0-9]+`
    fn integer(&mut self) -> Option<Number> {
        self.number().filter(|number| number.text.bytes().all(|byte| byte.is_ascii_digit()))
    }

    // Program = { Import } { Entity } ;
    fn program(mut self) -> Option<Program> {
        let imports = self.imports()?;
        let entities = self.entities()?;
        Some(Program { imports, entities, older_spellings: self.older_spellings })
    }

    fn imports(&mut self) -> Option<Vec<Name>> {
        let mut imports = Vec::new();
        while self.contextual("import").is_some() {
            let token = self.next(Kind::Text)?;
            imports.push(Name { text: token.text.trim_matches('"').to_owned(), range: token.range });
        }
        Some(imports)
    }

    fn entities(&mut self) -> Option<Vec<Entity>> {
        let mut entities = Vec::new();
        while self.at < self.tokens.len() {
            entities.push(self.entity()?);
        }
        Some(entities)
    }

    // Entity = Wheel | Sensor | Ip | Robot | Movement | Environment ;
    fn entity(&mut self) -> Option<Entity> {
        let start = self.start();
        let parallel = self.word("parallel");
        let words: &[&'static str] = match parallel {
            Some(_) => &["movement"],
            None => &["wheel", "wheelH", "sensor", "ip", "robot", "movement", "environment"],
        };
        let (name, body) = match self.one_of(words)? {
            "wheel" => self.wheel(false)?,
            "wheelH" => self.wheel(true)?,
            "sensor" => self.sensor()?,
            "ip" => self.ip()?,
            "robot" => self.robot()?,
            "movement" => self.movement(parallel)?,
            _ => self.environment()?,
        };
        Some(Entity { range: start..self.last_end(), name, body })
    }

    // Wheel = ( "wheel" | "wheelH" ) Name "with" "radius" Number ;
    fn wheel(&mut self, mecanum: bool) -> Option<(Name, Body)> {
        let name = self.name()?;
        self.word("with")?;
        self.word("radius")?;
        let radius = self.number()?;
        Some((name, Body::Wheel(Wheel { mecanum, radius })))
    }

    // Sensor = "sensor" Name [ ":" ( "distance" | "bumper" ) ] ;
    fn sensor(&mut self) -> Option<(Name, Body)> {
        let name = self.name()?;
        let mut bumper = false;
        if self.word(":").is_some() {
            bumper = self.contextual("bumper").is_some();
            if !bumper {
                self.contextual("distance")?;
            }
        }
        Some((name, Body::Sensor(Sensor { bumper })))
    }

    // Ip = "ip" Name Ipv4 ;
    fn ip(&mut self) -> Option<(Name, Body)> {
        let name = self.name()?;
        let token = self.next(Kind::Ipv4)?;
        Some((name, Body::Ip(Ip { address: Name { text: token.text, range: token.range } })))
    }

    // Robot = "robot" Name [ "type" Type ] "with" "port" Integer
    //         "has" "{" [ Refs(Wheel) ] "}" "wheels" [ "with" "sensors" "{" Refs(Sensor) "}" ] ;
    fn robot(&mut self) -> Option<(Name, Body)> {
        let start = self.start();
        // Accepted here, but never expected.
        let mut drive = if self.sees_any() { self.drive()? } else { None };
        if drive.is_some() {
            let misplaced = start..self.last_end();
            self.older_spellings.push(Finding::new("misplaced-type", &misplaced));
        }
        let name = self.name()?;
        if drive.is_none() {
            drive = self.drive()?;
        }
        self.word("with")?;
        self.word("port")?;
        let port = self.integer()?;
        self.word("has")?;
        let (wheels, wheel_list) = self.braced_refs()?;
        self.word("wheels")?;
        let mut sensors = Vec::new();
        if self.word("with").is_some() {
            self.word("sensors")?;
            sensors = self.some_braced_refs()?.0;
        }
        Some((name, Body::Robot(Robot { drive, port, wheels, wheel_list, sensors })))
    }

    // [ "type" Type ]
    #[allow(
        clippy::option_option,
        reason = "outside: whether it is in the language; inside: whether it is there"
    )]
    fn drive(&mut self) -> Option<Option<Name>> {
        let start = self.start();
        if self.word("type").is_none() {
            return Some(None);
        }
        let text = self.one_of(&robot_types::words())?.to_owned();
        Some(Some(Name { text, range: start..self.last_end() }))
    }

    // Movement = [ "parallel" ] "movement" Name "of" Ref(Robot) "{" { Action } "}" ;
    fn movement(&mut self, parallel: Option<Range<usize>>) -> Option<(Name, Body)> {
        let name = self.name()?;
        self.word("of")?;
        let robot = self.name()?;
        let block = self.block()?;
        Some((name, Body::Movement(Movement { parallel, robot, actions: block.actions, body: block.range })))
    }

    // Environment = "environment" Name [ "with" "ip" Ref(Ip) ] "has" "{" [ Refs(Robot) ] "}" "robots"
    //               [ "with" "{" [ Refs(Movement) ] "}" "moves" ] ;
    fn environment(&mut self) -> Option<(Name, Body)> {
        let name = self.name()?;
        let start = self.start();
        let mut ip = None;
        if self.word("with").is_some() {
            self.word("ip")?;
            ip = Some(self.name()?);
        } else if self.sees_any() && self.word(",").is_some() {
            ip = Some(self.name()?);
            let older = start..self.last_end();
            self.older_spellings.push(Finding::new("deprecated-ip-clause", &older));
        }
        self.word("has")?;
        let (robots, robot_list) = self.braced_refs()?;
        self.word("robots")?;
        let mut movements = Vec::new();
        if self.word("with").is_some() {
            movements = self.braced_refs()?.0;
            self.word("moves")?;
        }
        Some((name, Body::Environment(Environment { ip, robots, robot_list, movements })))
    }

    // "{" Refs(T) "}"
    fn some_braced_refs(&mut self) -> Option<(Vec<Name>, Range<usize>)> {
        let start = self.word("{")?.start;
        // At least one name.
        self.peek().filter(|token| token.kind == Kind::Name)?;
        self.refs_and_brace(start)
    }

    // "{" [ Refs(T) ] "}"
    fn braced_refs(&mut self) -> Option<(Vec<Name>, Range<usize>)> {
        let start = self.word("{")?.start;
        self.refs_and_brace(start)
    }

    // Refs(T) = Ref(T) { [ "," ] Ref(T) } [ "," ] ;
    fn refs_and_brace(&mut self, start: usize) -> Option<(Vec<Name>, Range<usize>)> {
        let mut names = Vec::new();
        while let Some(name) = self.name() {
            names.push(name);
            self.word(",");
        }
        let end = self.word("}")?.end;
        Some((names, start..end))
    }
}
