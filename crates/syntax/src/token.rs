//! The words and signs of the language. The keyword list exists here and nowhere else.

use logos::Logos;
use pydslrep_robots::Drive;
use pydslrep_text::{closest, is_similar};

/// A token without its text; the text is found by the span beside it.
#[derive(Logos, Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[logos(skip r"[ \t\r\n\f]+")]
#[repr(u8)]
pub enum TokenKind {
    /// A name, also one escaped by `^`.
    #[regex(r"\^?[A-Za-z_][A-Za-z0-9_]*")]
    Name,
    /// Text that someone took for a name: `left-wheel`, `räder`, `rover.left`. It is allowed where a name is, and is
    /// one mistake instead of a row of them.
    #[regex(r"\^?[\p{L}_][\p{L}\p{M}\p{N}_]*([-.'’][\p{L}_][\p{L}\p{M}\p{N}_]*)*", priority = 1)]
    MalformedName,
    /// Digits, perhaps with `-` before them.
    #[regex(r"-?[0-9]+", priority = 8)]
    Integer,
    /// Digits on both sides of one point.
    #[regex(r"-?[0-9]+\.[0-9]+", priority = 8)]
    Float,
    /// Four integers joined by points.
    #[regex(r"[0-9]+\.[0-9]+\.[0-9]+\.[0-9]+", priority = 8)]
    Ipv4,
    /// Digits and points that are no number: `4.`, `.5`, `1.2.3`.
    #[regex(r"-?\.*[0-9][0-9.]*", priority = 4)]
    MalformedNumber,
    /// `"…"` on one line.
    #[regex(r#""[^"\r\n]*""#)]
    String,
    /// `"` without its end on the line.
    #[regex(r#""[^"\r\n]*"#)]
    UnterminatedString,
    /// `// …` up to the end of the line.
    #[regex(r"//[^\r\n]*", allow_greedy = true)]
    LineComment,
    /// `/* … */`.
    #[regex(r"/\*([^*]|\*+[^*/])*\*+/")]
    BlockComment,
    /// `/*` without `*/`; it takes the rest of the text, so that cutting never has to look ahead for its end.
    #[regex(r"/\*([^*]|\*+[^*/])*\**")]
    UnterminatedComment,
    /// A comment as other languages write it, up to the end of the line: whatever it says is no part of the program.
    #[regex(r"(#|<!--|(--|%|/|\\\\)[ \t])[^\r\n]*", allow_greedy = true)]
    ForeignComment,
    /// `{`
    #[token("{")]
    OpenBrace,
    /// `}`
    #[token("}")]
    CloseBrace,
    /// `,`
    #[token(",")]
    Comma,
    /// `:`
    #[token(":")]
    Colon,
    /// `wheel`
    #[token("wheel")]
    Wheel,
    /// `wheelH`
    #[token("wheelH")]
    WheelH,
    /// `with`
    #[token("with")]
    With,
    /// `radius`
    #[token("radius")]
    Radius,
    /// `sensor`
    #[token("sensor")]
    Sensor,
    /// `ip`
    #[token("ip")]
    Ip,
    /// `robot`
    #[token("robot")]
    Robot,
    /// `type`
    #[token("type")]
    Type,
    /// `tw`
    #[token("tw")]
    Tw,
    /// `fw`
    #[token("fw")]
    Fw,
    /// `fwh`
    #[token("fwh")]
    Fwh,
    /// `port`
    #[token("port")]
    Port,
    /// `has`
    #[token("has")]
    Has,
    /// `wheels`
    #[token("wheels")]
    Wheels,
    /// `sensors`
    #[token("sensors")]
    Sensors,
    /// `parallel`
    #[token("parallel")]
    Parallel,
    /// `movement`
    #[token("movement")]
    Movement,
    /// `of`
    #[token("of")]
    Of,
    /// `move`
    #[token("move")]
    Move,
    /// `meters`
    #[token("meters")]
    Meters,
    /// `centimeters`
    #[token("centimeters")]
    Centimeters,
    /// `at`
    #[token("at")]
    At,
    /// `turn`
    #[token("turn")]
    Turn,
    /// `left`
    #[token("left")]
    Left,
    /// `right`
    #[token("right")]
    Right,
    /// `until`
    #[token("until")]
    Until,
    /// `slam`
    #[token("slam")]
    Slam,
    /// `environment`
    #[token("environment")]
    Environment,
    /// `robots`
    #[token("robots")]
    Robots,
    /// `moves`
    #[token("moves")]
    Moves,
    /// `distance`, a word only after a sensor's `:`.
    #[token("distance")]
    Distance,
    /// `bumper`, a word only after a sensor's `:`.
    #[token("bumper")]
    Bumper,
    /// `import`, a word only at the start of an import.
    #[token("import")]
    Import,
    /// `wait`, a word only where an action can begin.
    #[token("wait")]
    Wait,
    /// `seconds`, a word only after the number of a `wait`.
    #[token("seconds")]
    Seconds,
    /// `repeat`, a word only where an action can begin.
    #[token("repeat")]
    Repeat,
    /// `times`, a word only after the number of a `repeat`.
    #[token("times")]
    Times,
    /// `if`, a word only where an action can begin.
    #[token("if")]
    If,
    /// `else`, a word only after the block of an `if`.
    #[token("else")]
    Else,
    /// `do`, a word only where an action can begin.
    #[token("do")]
    Do,
    /// `in`, a word only before `reverse`.
    #[token("in")]
    In,
    /// `reverse`, a word only after `in`.
    #[token("reverse")]
    Reverse,
    /// `clear`, a word only after the sensors of a condition.
    #[token("clear")]
    Clear,
    /// `detect`, a word only after the sensors of a condition.
    #[token("detect")]
    Detect,
    /// `within`, a word only in a condition.
    #[token("within")]
    Within,
    /// Characters no token starts with; adjacent ones are one token.
    Invalid,
    /// Never in a text: fits nowhere, so that the parser says what would. See [`crate::expected_after`].
    Cursor,
}

/// Every word with a meaning of its own, in the order of the language's contract; those of [`TokenKind::CONTEXTUAL`]
/// stay usable as names.
pub const KEYWORDS: [(TokenKind, &str); 45] = [
    (TokenKind::Wheel, "wheel"),
    (TokenKind::WheelH, "wheelH"),
    (TokenKind::With, "with"),
    (TokenKind::Radius, "radius"),
    (TokenKind::Sensor, "sensor"),
    (TokenKind::Ip, "ip"),
    (TokenKind::Robot, "robot"),
    (TokenKind::Type, "type"),
    (TokenKind::Tw, "tw"),
    (TokenKind::Fw, "fw"),
    (TokenKind::Fwh, "fwh"),
    (TokenKind::Port, "port"),
    (TokenKind::Has, "has"),
    (TokenKind::Wheels, "wheels"),
    (TokenKind::Sensors, "sensors"),
    (TokenKind::Parallel, "parallel"),
    (TokenKind::Movement, "movement"),
    (TokenKind::Of, "of"),
    (TokenKind::Move, "move"),
    (TokenKind::Meters, "meters"),
    (TokenKind::Centimeters, "centimeters"),
    (TokenKind::At, "at"),
    (TokenKind::Turn, "turn"),
    (TokenKind::Left, "left"),
    (TokenKind::Right, "right"),
    (TokenKind::Until, "until"),
    (TokenKind::Slam, "slam"),
    (TokenKind::Environment, "environment"),
    (TokenKind::Robots, "robots"),
    (TokenKind::Moves, "moves"),
    (TokenKind::Distance, "distance"),
    (TokenKind::Bumper, "bumper"),
    (TokenKind::Import, "import"),
    (TokenKind::Wait, "wait"),
    (TokenKind::Seconds, "seconds"),
    (TokenKind::Repeat, "repeat"),
    (TokenKind::Times, "times"),
    (TokenKind::If, "if"),
    (TokenKind::Else, "else"),
    (TokenKind::Do, "do"),
    (TokenKind::In, "in"),
    (TokenKind::Reverse, "reverse"),
    (TokenKind::Clear, "clear"),
    (TokenKind::Detect, "detect"),
    (TokenKind::Within, "within"),
];

/// The keywords that cannot be names unless escaped by `^`.
const RESERVED: TokenSet = {
    let mut words = TokenSet(0);
    let mut i = 0;
    while i < KEYWORDS.len() {
        words = words.or(TokenSet::of(&[KEYWORDS[i].0]));
        i += 1;
    }
    words.without(TokenSet::of(&TokenKind::CONTEXTUAL))
};

/// A name as a program has to write it: keywords need their `^`. So does `import`, although it can do without in
/// most places: after `} wheel` it would be taken for the next entity.
pub fn escape(name: &str) -> String {
    let is_escaped = |token: TokenKind| token.is_keyword() || token == TokenKind::Import;
    let escaped = KEYWORDS.iter().any(|(token, word)| is_escaped(*token) && *word == name);
    if escaped { format!("^{name}") } else { name.to_owned() }
}

impl TokenKind {
    /// The keywords that begin an action.
    pub const ACTIONS: [Self; 7] =
        [Self::Move, Self::Turn, Self::Wait, Self::Repeat, Self::If, Self::Do, Self::Slam];

    /// The keywords that are names wherever a name can be.
    pub const CONTEXTUAL: [Self; 15] = [
        Self::Distance,
        Self::Bumper,
        Self::Import,
        Self::Wait,
        Self::Seconds,
        Self::Repeat,
        Self::Times,
        Self::If,
        Self::Else,
        Self::Do,
        Self::In,
        Self::Reverse,
        Self::Clear,
        Self::Detect,
        Self::Within,
    ];

    /// The tokens that are written where a number belongs.
    pub(crate) const NUMBERS: TokenSet =
        TokenSet::of(&[Self::Integer, Self::Float, Self::Ipv4, Self::MalformedNumber]);

    /// The tokens that can be where a name is expected.
    pub(crate) const NAMES: TokenSet =
        TokenSet::of(&[Self::Name, Self::MalformedName]).or(TokenSet::of(&Self::CONTEXTUAL));

    /// The keywords for types of robots.
    pub const DRIVES: [Self; 3] = [Self::Tw, Self::Fw, Self::Fwh];

    /// The keywords that begin a declaration, `import` included.
    pub const DECLARATIONS: [Self; 9] = [
        Self::Import,
        Self::Wheel,
        Self::WheelH,
        Self::Sensor,
        Self::Ip,
        Self::Robot,
        Self::Movement,
        Self::Parallel,
        Self::Environment,
    ];

    /// The keywords that a declaration may end with, also one whose last brace is missing.
    pub(crate) const ENDS: TokenSet = TokenSet::of(&[
        Self::Wheels,
        Self::Sensors,
        Self::Robots,
        Self::Moves,
        Self::Meters,
        Self::Centimeters,
        Self::Slam,
    ]);

    /// Returns examples of the statement that an action's keyword begins; none for other tokens.
    pub fn examples(self) -> &'static [&'static str] {
        match self {
            Self::Move => &["move 4.0 meters", "move 40 centimeters at 9.0"],
            Self::Turn => &["turn left 90", "turn right until { SENSORS }"],
            Self::Wait => &["wait 2 seconds", "wait until { SENSORS } clear"],
            Self::Repeat => &["repeat 4 times { ACTIONS }", "repeat until { SENSORS } detect { ACTIONS }"],
            Self::If => &["if { SENSORS } detect { ACTIONS }"],
            Self::Do => &["do MOVEMENT"],
            Self::Slam => &["slam"],
            _ => &[],
        }
    }

    /// What follows the keyword of an action and never a name: before it, a keyword that can be a name is none. Nothing for
    /// those that are never names, and for `do`, which a name follows.
    pub const fn only_before(self) -> TokenSet {
        match self {
            Self::Wait | Self::Repeat => Self::NUMBERS.or(TokenSet::of(&[Self::Until])),
            Self::If => TokenSet::of(&[Self::OpenBrace]),
            _ => TokenSet(0),
        }
    }

    /// Returns whether it begins an action.
    pub fn is_action(self) -> bool {
        Self::ACTIONS.contains(&self)
    }

    /// The type of robot that it stands for.
    pub fn drive(self) -> Option<Drive> {
        Drive::from_word(self.spelling()?)
    }

    /// Returns the spelling of a keyword or sign; `None` for tokens whose text varies.
    pub fn spelling(self) -> Option<&'static str> {
        match self {
            Self::OpenBrace => Some("{"),
            Self::CloseBrace => Some("}"),
            Self::Comma => Some(","),
            Self::Colon => Some(":"),
            _ => KEYWORDS.iter().find(|(token, _)| *token == self).map(|(_, word)| *word),
        }
    }

    /// Returns whether `written` may be a slip for this keyword.
    pub fn is_similar_to(self, written: &str) -> bool {
        self.spelling().is_some_and(|spelling| is_similar(written, spelling))
    }

    /// The keyword that `written` is most likely a slip for.
    pub(crate) fn closest(written: &str, keywords: impl Iterator<Item = Self>) -> Option<Self> {
        let near = closest(written, keywords.filter_map(Self::spelling))?;
        KEYWORDS.iter().find(|(_, word)| *word == near).map(|(kind, _)| *kind)
    }

    /// Returns whether it is a word that cannot be a name unless escaped by `^`.
    pub fn is_keyword(self) -> bool {
        RESERVED.has(self)
    }

    /// Returns whether it can be where a name is expected.
    pub fn is_name(self) -> bool {
        Self::NAMES.has(self)
    }

    /// Returns whether it is a comment, which the parser passes over.
    pub fn is_comment(self) -> bool {
        matches!(
            self,
            Self::LineComment | Self::BlockComment | Self::UnterminatedComment | Self::ForeignComment
        )
    }

    /// Returns whether it is a comment that takes the rest of its line.
    pub fn ends_line(self) -> bool {
        matches!(self, Self::LineComment | Self::ForeignComment)
    }

    /// Returns whether it is written where a number belongs.
    pub fn is_number(self) -> bool {
        Self::NUMBERS.has(self)
    }

    /// The kind of entity this keyword begins.
    pub fn entity_kind(self) -> Option<EntityKind> {
        Some(match self {
            Self::Wheel | Self::WheelH => EntityKind::Wheel,
            Self::Sensor => EntityKind::Sensor,
            Self::Ip => EntityKind::Ip,
            Self::Robot => EntityKind::Robot,
            Self::Movement | Self::Parallel => EntityKind::Movement,
            Self::Environment => EntityKind::Environment,
            _ => return None,
        })
    }
}

/// The kinds of entity, each with a namespace of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum EntityKind {
    /// `wheel` and `wheelH`
    Wheel,
    /// `sensor`
    Sensor,
    /// `ip`
    Ip,
    /// `robot`
    Robot,
    /// `movement`
    Movement,
    /// `environment`
    Environment,
}

impl EntityKind {
    /// All kinds, bottom up as a program builds them.
    pub const ALL: [Self; 6] =
        [Self::Wheel, Self::Sensor, Self::Ip, Self::Robot, Self::Movement, Self::Environment];

    /// Returns its name in messages, without an article.
    pub fn noun(self) -> &'static str {
        match self {
            Self::Wheel => "wheel",
            Self::Sensor => "sensor",
            Self::Ip => "ip",
            Self::Robot => "robot",
            Self::Movement => "movement",
            Self::Environment => "environment",
        }
    }

    /// Returns its syntax, from end to end.
    pub fn shape(self) -> &'static str {
        match self {
            Self::Wheel => "wheel NAME with radius CENTIMETRES",
            Self::Sensor => "sensor NAME",
            Self::Ip => "ip NAME 127.0.0.1",
            Self::Robot => "robot NAME type tw with port 23000 has { WHEELS } wheels",
            Self::Movement => "movement NAME of ROBOT { ACTIONS }",
            Self::Environment => "environment NAME has { ROBOTS } robots with { MOVEMENTS } moves",
        }
    }

    /// The noun with its article: `a wheel`, `an ip`.
    pub fn a_noun(self) -> &'static str {
        match self {
            Self::Wheel => "a wheel",
            Self::Sensor => "a sensor",
            Self::Ip => "an ip",
            Self::Robot => "a robot",
            Self::Movement => "a movement",
            Self::Environment => "an environment",
        }
    }
}

/// A set of tokens.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TokenSet(u128);

impl TokenSet {
    /// The set of these tokens.
    pub const fn of(tokens: &[TokenKind]) -> Self {
        let mut bits = 0;
        let mut i = 0;
        while i < tokens.len() {
            bits |= 1 << tokens[i] as u8;
            i += 1;
        }
        Self(bits)
    }

    /// The set of all tokens but one.
    pub const fn all_but(token: TokenKind) -> Self {
        Self(!(1 << token as u8))
    }

    /// The set without those of another.
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Returns the tokens in both.
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// Returns the tokens in either.
    pub const fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Returns whether `token` is in it.
    pub const fn has(self, token: TokenKind) -> bool {
        self.0 & (1 << token as u8) != 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_keyword_is_lexed_as_itself() {
        for (token, word) in KEYWORDS {
            assert_eq!(TokenKind::lexer(word).next(), Some(Ok(token)), "{word}");
            let contextual = TokenKind::CONTEXTUAL.contains(&token);
            assert_eq!(token.is_keyword(), !contextual, "{word}");
            assert_eq!(token.is_name(), contextual, "{word}");
        }
    }

    #[test]
    fn every_type_of_robot_has_its_keyword() {
        assert_eq!(TokenKind::DRIVES.map(TokenKind::drive), Drive::ALL.map(Some));
        for (token, word) in KEYWORDS {
            assert_eq!(token.drive().is_some(), TokenKind::DRIVES.contains(&token), "{word}");
        }
    }

    #[test]
    fn the_list_is_complete() {
        let first = TokenKind::Wheel as u8;
        let listed: Vec<u8> = KEYWORDS.iter().map(|(token, _)| *token as u8).collect();
        let all: Vec<u8> = (first..TokenKind::Invalid as u8).collect();
        assert_eq!(listed, all);
        assert!((TokenKind::Cursor as u8) < 128, "a token set is one word");
    }
}
