//! The words and signs of the language. The keyword list exists here and nowhere else.

use logos::Logos;
use pydslrep_robots::Drive;
use pydslrep_text::{closest, is_similar};

/// Writes [`TokenKind`] with the keywords, and the lists of them: a keyword is one line, and one that begins an action has
/// its row of [`ACTIONS`] beside it.
macro_rules! keywords {
    (
        reserved { $($reserved:ident $reserved_word:tt $({ $($reserved_row:tt)* })?,)* }
        contextual { $($(#[$doc:meta])* $contextual:ident $contextual_word:tt $({ $($row:tt)* })?,)* }
    ) => {
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
            $(
                #[doc = concat!("`", $reserved_word, "`")]
                #[token($reserved_word)]
                $reserved,
            )*
            $(
                #[doc = concat!("`", $contextual_word, "`")]
                ///
                $(#[$doc])*
                #[token($contextual_word)]
                $contextual,
            )*
            /// Characters no token starts with; adjacent ones are one token.
            Invalid,
            /// Never in a text: fits nowhere, so that the parser says what would. See [`crate::expected_after`].
            Cursor,
        }

        /// Every word with a meaning of its own, in the order of the language's contract; those of
        /// [`TokenKind::CONTEXTUAL`] stay usable as names.
        pub const KEYWORDS: [(TokenKind, &str); [$($reserved_word,)* $($contextual_word,)*].len()] = [
            $((TokenKind::$reserved, $reserved_word),)*
            $((TokenKind::$contextual, $contextual_word),)*
        ];

        /// The keywords that begin an action.
        const ACTIONS: &[Action] = &[
            $($(Action { keyword: TokenKind::$reserved, $($reserved_row)* },)?)*
            $($(Action { keyword: TokenKind::$contextual, $($row)* },)?)*
        ];

        /// The keywords that cannot be names unless escaped by `^`.
        const RESERVED: TokenSet = TokenSet::of(&[$(TokenKind::$reserved,)*]);

        impl TokenKind {
            /// The keywords that are names wherever a name can be.
            pub const CONTEXTUAL: [Self; [$($contextual_word,)*].len()] = [$(Self::$contextual,)*];
        }
    };
}

keywords! {
    reserved {
        Wheel "wheel",
        WheelH "wheelH",
        With "with",
        Radius "radius",
        Sensor "sensor",
        Ip "ip",
        Robot "robot",
        Type "type",
        Tw "tw",
        Fw "fw",
        Fwh "fwh",
        Port "port",
        Has "has",
        Wheels "wheels",
        Sensors "sensors",
        Parallel "parallel",
        Movement "movement",
        Of "of",
        Move "move" {
            only_before: NOTHING,
            examples: &["move 4.0 meters", "move 40 centimeters at 9.0"],
            details: &[],
        },
        Meters "meters",
        Centimeters "centimeters",
        At "at",
        Turn "turn" {
            only_before: NOTHING,
            examples: &["turn left 90", "turn right until { SENSORS }"],
            details: &[],
        },
        Left "left",
        Right "right",
        Until "until",
        Slam "slam" {
            only_before: NOTHING,
            examples: &["slam"],
            details: &[],
        },
        Environment "environment",
        Robots "robots",
        Moves "moves",
    }
    contextual {
        /// A word only after a sensor's `:`.
        Distance "distance",
        /// A word only after a sensor's `:`.
        Bumper "bumper",
        /// A word only at the start of an import.
        Import "import",
        /// A word only where an action can begin.
        Wait "wait" {
            only_before: AMOUNT,
            examples: &["wait 2 seconds", "wait until { SENSORS } clear"],
            details: &["stands still", "stands still until no sensor detects an obstacle"],
        },
        /// A word only after the number of a `wait`.
        Seconds "seconds",
        /// A word only where an action can begin.
        Repeat "repeat" {
            only_before: AMOUNT,
            examples: &["repeat 4 times { ACTIONS }", "repeat until { SENSORS } detect { ACTIONS }"],
            details: &["a number of times", "until a sensor detects an obstacle"],
        },
        /// A word only after the number of a `repeat`.
        Times "times",
        /// A word only where an action can begin.
        If "if" {
            only_before: TokenSet::of(&[TokenKind::OpenBrace]),
            examples: &["if { SENSORS } detect { ACTIONS }"],
            details: &["only if a sensor detects an obstacle"],
        },
        /// A word only after the block of an `if`.
        Else "else",
        /// A word only where an action can begin.
        Do "do" {
            only_before: NOTHING,
            examples: &["do MOVEMENT"],
            details: &["another movement of the same robot"],
        },
        /// A word only before `reverse`.
        In "in",
        /// A word only after `in`.
        Reverse "reverse",
        /// A word only after the sensors of a condition.
        Clear "clear",
        /// A word only after the sensors of a condition.
        Detect "detect",
        /// A word only in a condition.
        Within "within",
    }
}

/// A name as a program has to write it: keywords need their `^`. So does `import`, although it can do without in
/// most places: after `} wheel` it would be taken for the next entity.
pub fn escape(name: &str) -> String {
    let is_escaped = |token: TokenKind| token.is_keyword() || token == TokenKind::Import;
    let escaped = KEYWORDS.iter().any(|(token, word)| is_escaped(*token) && *word == name);
    if escaped { format!("^{name}") } else { name.to_owned() }
}

/// A keyword that begins an action.
struct Action {
    keyword: TokenKind,
    /// See [`TokenKind::only_before`].
    only_before: TokenSet,
    /// See [`TokenKind::examples`].
    examples: &'static [&'static str],
    /// See [`TokenKind::details`].
    details: &'static [&'static str],
}

const AMOUNT: TokenSet = TokenKind::NUMBERS.or(TokenSet::of(&[TokenKind::Until]));

const NOTHING: TokenSet = TokenSet(0);

impl TokenKind {
    /// The keywords that begin an action, in the order in which messages list them: `slam`, which few robots can, is last.
    pub const ACTIONS: [Self; ACTIONS.len()] = {
        let mut words = [Self::Slam; ACTIONS.len()];
        let (mut i, mut end) = (0, 0);
        while i < ACTIONS.len() {
            if !matches!(ACTIONS[i].keyword, Self::Slam) {
                words[end] = ACTIONS[i].keyword;
                end += 1;
            }
            i += 1;
        }
        words
    };

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
        self.action().map_or(&[], |action| action.examples)
    }

    /// What the statement of each of the examples does, in a list of them; none where other words than those are listed.
    pub fn details(self) -> &'static [&'static str] {
        self.action().map_or(&[], |action| action.details)
    }

    /// Returns whether it begins an action with a block.
    pub fn begins_block(self) -> bool {
        self.examples().iter().any(|example| example.contains("{ ACTIONS }"))
    }

    /// What follows the keyword of an action and never a name: before it, a keyword that can be a name is none. Nothing for
    /// those that are never names, and for `do`, which a name follows.
    pub fn only_before(self) -> TokenSet {
        self.action().map_or_else(TokenSet::default, |action| action.only_before)
    }

    fn action(self) -> Option<&'static Action> {
        ACTIONS.iter().find(|action| action.keyword == self)
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
        self.a_noun().split_once(' ').map_or("", |(_, noun)| noun)
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
