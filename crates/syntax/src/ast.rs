//! The syntax tree of one entity. Every clause is optional, because any of them may be missing or broken while the
//! rest is fine; an error says so wherever one is absent that must be there.

pub use pydslrep_robots::Drive;
use smol_str::SmolStr;

use crate::{EntityKind, Span, TokenKind};

/// One top-level piece of a program.
#[derive(Debug, Clone, PartialEq)]
pub enum Entity {
    /// `import "file.pyr"`
    Import(Import),
    /// `wheel name with radius 4.5`
    Wheel(Wheel),
    /// `sensor name : distance`
    Sensor(Sensor),
    /// `ip name 127.0.0.1`
    Ip(Ip),
    /// `robot name type tw with port 23000 has { … } wheels`
    Robot(Robot),
    /// `movement name of robot { … }`
    Movement(Movement),
    /// `environment name has { … } robots with { … } moves`
    Environment(Environment),
}

impl Entity {
    /// Its namespace; `None` for an import.
    pub fn kind(&self) -> Option<EntityKind> {
        Some(match self {
            Self::Import(_) => return None,
            Self::Wheel(_) => EntityKind::Wheel,
            Self::Sensor(_) => EntityKind::Sensor,
            Self::Ip(_) => EntityKind::Ip,
            Self::Robot(_) => EntityKind::Robot,
            Self::Movement(_) => EntityKind::Movement,
            Self::Environment(_) => EntityKind::Environment,
        })
    }

    /// The name it declares.
    pub fn name(&self) -> Option<&Name> {
        match self {
            Self::Import(_) => None,
            Self::Wheel(wheel) => wheel.name.as_ref(),
            Self::Sensor(sensor) => sensor.name.as_ref(),
            Self::Ip(ip) => ip.name.as_ref(),
            Self::Robot(robot) => robot.name.as_ref(),
            Self::Movement(movement) => movement.name.as_ref(),
            Self::Environment(environment) => environment.name.as_ref(),
        }
    }

    /// Every name it refers to, with the kind that is wanted, in the order of the text.
    pub fn references(&self) -> Vec<(EntityKind, &Name)> {
        let mut found = Vec::new();
        match self {
            Self::Robot(robot) => {
                extend(&mut found, EntityKind::Wheel, robot.wheels.as_ref());
                extend(&mut found, EntityKind::Sensor, robot.sensors.as_ref());
            }
            Self::Movement(movement) => {
                found.extend(movement.robot.iter().map(|name| (EntityKind::Robot, name)));
                for action in nested(&movement.actions) {
                    for condition in action.conditions() {
                        extend(&mut found, EntityKind::Sensor, Some(&condition.sensors));
                    }
                    found.extend(action.done().map(|name| (EntityKind::Movement, name)));
                }
                // The condition of an `else if` comes after the block before it.
                found.sort_by_key(|(_, name)| name.span.start);
            }
            Self::Environment(environment) => {
                let ip = environment.ip.as_ref().and_then(|clause| clause.name.as_ref());
                found.extend(ip.map(|name| (EntityKind::Ip, name)));
                extend(&mut found, EntityKind::Robot, environment.robots.as_ref());
                extend(&mut found, EntityKind::Movement, environment.movements.as_ref());
            }
            Self::Import(_) | Self::Wheel(_) | Self::Sensor(_) | Self::Ip(_) => {}
        }
        found
    }
}

fn extend<'a>(found: &mut Vec<(EntityKind, &'a Name)>, kind: EntityKind, refs: Option<&'a References>) {
    found.extend(refs.into_iter().flat_map(|refs| &refs.names).map(|name| (kind, name)));
}

/// A name, declared or referred to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Name {
    /// Without `^`.
    pub text: SmolStr,
    /// With `^`.
    pub span: Span,
}

/// A number as written.
#[derive(Debug, Clone, PartialEq)]
pub struct Number {
    /// `None` where the text is no number (an error has been reported).
    pub value: Option<f64>,
    /// Its span.
    pub span: Span,
}

/// A port as written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PortNumber {
    /// `None` where it is out of range, however far.
    pub value: Option<u16>,
    /// Its span.
    pub span: Span,
    /// True if it is a whole number at all; if it is not, an error has been reported.
    pub whole: bool,
}

/// A list of references in braces.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct References {
    /// In the order of the text.
    pub names: Vec<Name>,
    /// From brace to brace.
    pub span: Span,
    /// True if something in it could not be understood, so that nothing may be concluded from its length.
    pub broken: bool,
}

/// `import "file.pyr"`
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Import {
    /// The path between the quotes.
    pub path: Option<SmolStr>,
    /// Where the path is, with its quotes.
    pub path_span: Option<Span>,
}

/// `wheel` or `wheelH`
#[derive(Debug, Clone, PartialEq)]
pub struct Wheel {
    /// Where the keyword is.
    pub keyword: Span,
    /// `wheelH`: 45° rollers.
    pub mecanum: bool,
    /// Its name.
    pub name: Option<Name>,
    /// In centimetres.
    pub radius: Option<Number>,
}

/// `sensor`
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sensor {
    /// Its name.
    pub name: Option<Name>,
    /// The kind after `:`.
    pub kind: Option<(SensorKeyword, Span)>,
}

/// The keyword for a kind of proximity sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SensorKeyword {
    /// `distance`, also where no kind is written.
    Distance,
    /// `bumper`
    Bumper,
}

/// `ip`
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ip {
    /// Its name.
    pub name: Option<Name>,
    /// The address as written.
    pub address: Option<(SmolStr, Span)>,
}

/// `robot`
#[derive(Debug, Clone, PartialEq)]
pub struct Robot {
    /// Its name.
    pub name: Option<Name>,
    /// `type tw`
    pub drive: Option<DriveClause>,
    /// `with port 23000`
    pub port: Option<PortNumber>,
    /// `has { … } wheels`
    pub wheels: Option<References>,
    /// `with sensors { … }`
    pub sensors: Option<References>,
}

/// `type tw`
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DriveClause {
    /// Which one; `None` where the word is missing or unknown.
    pub word: Option<Drive>,
    /// From `type` to the word.
    pub span: Span,
    /// True if it is before the name, as in the article's grammar.
    pub before_name: bool,
}

/// `movement`
#[derive(Debug, Clone, PartialEq)]
pub struct Movement {
    /// Where `parallel` is, if it is there.
    pub parallel: Option<Span>,
    /// Its name.
    pub name: Option<Name>,
    /// Whose movement it is.
    pub robot: Option<Name>,
    /// From brace to brace.
    pub body: Option<Span>,
    /// In order.
    pub actions: Vec<Action>,
}

impl Movement {
    /// Where each statement is, in the order of the text; that of an `else if` is one of its own. The place in this list is
    /// what numbers of actions count.
    pub fn statements(&self) -> Vec<Span> {
        let mut spans = Vec::new();
        for action in self.all_actions() {
            spans.push(action.span);
            if let ActionKind::If(choice) = &action.kind {
                spans.extend(choice.branches.iter().skip(1).map(|branch| branch.span));
            }
        }
        // The branches come after what is in the blocks before them.
        spans.sort_by_key(|span| span.start);
        spans
    }

    /// All its actions, those in blocks too, in the order of the text.
    pub fn all_actions(&self) -> Nested<'_> {
        nested(&self.actions)
    }
}

/// One action and the text it covers.
#[derive(Debug, Clone, PartialEq)]
pub struct Action {
    /// The action and its values.
    pub kind: ActionKind,
    /// From its keyword to its last word or brace.
    pub span: Span,
}

/// What an action is made of, whatever its kind.
#[derive(Default)]
struct Parts<'a> {
    numbers: [Option<&'a Number>; 3],
    count: Option<&'a Number>,
    until: Option<&'a Until>,
    branches: &'a [Branch],
    /// The block that is after those of the branches.
    block: Option<&'a Block>,
    done: Option<&'a Name>,
}

impl ActionKind {
    /// The keyword that it begins with, and its parts: all that is asked of any action, so that a new one says it here.
    // Each key asks for one or another part of each action: the others need not be made for that.
    #[inline(always)]
    fn parts(&self) -> (TokenKind, Parts<'_>) {
        fn value(clause: Option<&SpeedClause>) -> Option<&Number> {
            clause?.value.as_ref()
        }
        match self {
            Self::Move(Move { distance, speed, until, .. }) => {
                let numbers = [distance.as_ref(), value(speed.as_ref()), None];
                (TokenKind::Move, Parts { numbers, until: until.as_ref(), ..Parts::default() })
            }
            Self::Turn(Turn { angle, circle, speed, until, .. }) => {
                let radius = circle.as_ref().and_then(|circle| circle.radius.as_ref());
                let numbers = [angle.as_ref(), radius, value(speed.as_ref())];
                (TokenKind::Turn, Parts { numbers, until: until.as_ref(), ..Parts::default() })
            }
            Self::Wait(Wait { seconds, until }) => {
                let numbers = [seconds.as_ref(), None, None];
                (TokenKind::Wait, Parts { numbers, until: until.as_ref(), ..Parts::default() })
            }
            Self::Repeat(Repeat { rounds, block }) => {
                let (count, until) = match rounds {
                    Some(Rounds::Times(count)) => (Some(count), None),
                    Some(Rounds::Until(until)) => (None, Some(until)),
                    None => (None, None),
                };
                (TokenKind::Repeat, Parts { count, until, block: block.as_ref(), ..Parts::default() })
            }
            Self::If(If { branches, otherwise }) => {
                (TokenKind::If, Parts { branches, block: otherwise.as_ref(), ..Parts::default() })
            }
            Self::Do(Do { movement }) => {
                (TokenKind::Do, Parts { done: movement.as_ref(), ..Parts::default() })
            }
            Self::Slam => (TokenKind::Slam, Parts::default()),
        }
    }
}

impl Action {
    #[expect(clippy::inline_always, reason = "as above")]
    #[inline(always)]
    fn parts(&self) -> Parts<'_> {
        self.kind.parts().1
    }

    /// The keyword that it begins with.
    pub fn keyword(&self) -> TokenKind {
        self.kind.parts().0
    }

    /// Returns the condition that decides when it ends: that of its `until`.
    pub fn until(&self) -> Option<&Condition> {
        self.parts().until.map(|clause| &clause.condition)
    }

    /// The conditions in it, in the order of the text; those of the actions in its blocks are not among them.
    pub fn conditions(&self) -> impl Iterator<Item = &Condition> {
        let Parts { until, branches, .. } = self.parts();
        let until = until.map(|clause| &clause.condition);
        until.into_iter().chain(branches.iter().filter_map(|branch| branch.condition.as_ref()))
    }

    /// The blocks in it, in the order of the text.
    pub fn blocks(&self) -> impl Iterator<Item = &Block> {
        let Parts { branches, block, .. } = self.parts();
        branches.iter().filter_map(|branch| branch.block.as_ref()).chain(block)
    }

    /// The numbers in it, in the order of the text; those of conditions and of the actions in its blocks are not among
    /// them.
    pub fn numbers(&self) -> impl Iterator<Item = &Number> {
        let Parts { numbers, count, .. } = self.parts();
        numbers.into_iter().flatten().chain(count)
    }

    /// How many times it does something.
    pub fn count(&self) -> Option<&Number> {
        self.parts().count
    }

    /// The movement that a `do` names.
    pub fn done(&self) -> Option<&Name> {
        self.parts().done
    }
}

/// The actions of a block with those in their blocks, in the order of the text.
#[derive(Debug, Clone)]
pub struct Nested<'a> {
    /// The remaining actions of each block, the outermost first.
    open: Vec<std::slice::Iter<'a, Action>>,
    /// The blocks of the latest action that are not entered yet, the last one first.
    blocks: Vec<(usize, &'a Block)>,
}

/// All actions of `actions` and of their blocks.
pub fn nested(actions: &[Action]) -> Nested<'_> {
    Nested { open: vec![actions.iter()], blocks: Vec::new() }
}

impl<'a> Iterator for Nested<'a> {
    type Item = &'a Action;

    fn next(&mut self) -> Option<&'a Action> {
        loop {
            if let Some(action) = self.open.last_mut()?.next() {
                let mut blocks = action.blocks();
                // Most actions have none.
                if let Some(block) = blocks.next() {
                    let (depth, first) = (self.open.len(), self.blocks.len());
                    self.blocks.extend(blocks.map(|block| (depth, block)));
                    self.blocks[first..].reverse();
                    self.open.push(block.actions.iter());
                }
                return Some(action);
            }
            self.open.pop();
            let depth = self.open.len();
            // The next block of the action that the ended one is of.
            if let Some((_, block)) = self.blocks.pop_if(|(owner, _)| *owner == depth) {
                self.open.push(block.actions.iter());
            }
        }
    }
}

/// The kinds of action.
#[derive(Debug, Clone, PartialEq)]
pub enum ActionKind {
    /// `move 4.0 meters at 9.0`
    Move(Move),
    /// `turn left 90`
    Turn(Turn),
    /// `wait 2 seconds`
    Wait(Wait),
    /// `repeat 4 times { … }`
    Repeat(Repeat),
    /// `if { … } clear { … } else { … }`
    If(If),
    /// `do side`
    Do(Do),
    /// `slam`
    Slam,
}

/// `{ … }` around actions.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// In order.
    pub actions: Vec<Action>,
    /// From brace to brace.
    pub span: Span,
}

/// `move`
#[derive(Debug, Clone, PartialEq)]
pub struct Move {
    /// The distance, in `unit`; it may be absent beside `until`.
    pub distance: Option<Number>,
    /// `meters` or `centimeters`.
    pub unit: Option<(Unit, Span)>,
    /// `at 9.0`, in centimetres per second.
    pub speed: Option<SpeedClause>,
    /// `until { … } detect`
    pub until: Option<Until>,
}

/// `at 9.0`
#[derive(Debug, Clone, PartialEq)]
pub struct SpeedClause {
    /// In centimetres per second.
    pub value: Option<Number>,
    /// From `at` to the number.
    pub span: Span,
}

/// `until { … } clear`
#[derive(Debug, Clone, PartialEq)]
pub struct Until {
    /// The condition that ends the action.
    pub condition: Condition,
    /// From `until` to the end of the condition.
    pub span: Span,
}

/// `{ front } detect within 40 centimeters`
#[derive(Debug, Clone, PartialEq)]
pub struct Condition {
    /// The sensors that it asks.
    pub sensors: References,
    /// `clear` or `detect`; only a `turn … until` of the article's form may do without.
    pub state: Option<(SensorState, Span)>,
    /// `within 40 centimeters`
    pub within: Option<Within>,
    /// From the first brace to the last word.
    pub span: Span,
}

/// The state of its sensors that a condition asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SensorState {
    /// None of them detects anything.
    Clear,
    /// At least one of them detects something.
    Detect,
}

/// `within 40 centimeters`
#[derive(Debug, Clone, PartialEq)]
pub struct Within {
    /// Only what is nearer counts, in `unit`.
    pub distance: Option<Number>,
    /// `meters` or `centimeters`.
    pub unit: Option<(Unit, Span)>,
    /// From `within` to the unit.
    pub span: Span,
}

/// Units of length.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// `meters`
    Meters,
    /// `centimeters`
    Centimeters,
}

impl Unit {
    /// Returns its length in metres.
    pub fn in_metres(self) -> f64 {
        match self {
            Self::Meters => 1.0,
            Self::Centimeters => 0.01,
        }
    }
}

/// `turn`
#[derive(Debug, Clone, PartialEq)]
pub struct Turn {
    /// `left` or `right`.
    pub direction: Option<(Direction, Span)>,
    /// The angle, in degrees; 90 where neither that nor `until` is written.
    pub angle: Option<Number>,
    /// `with radius 1.5 meters`: on a circle instead of in place.
    pub circle: Option<Circle>,
    /// `at 9.0`, in centimetres per second.
    pub speed: Option<SpeedClause>,
    /// `in reverse`
    pub reverse: Option<Span>,
    /// `until { … } clear`
    pub until: Option<Until>,
}

impl Turn {
    /// Returns whether it has the article's form `turn left until { … }` and nothing that the article does not have.
    pub fn is_of_article(&self) -> bool {
        let plain = self.circle.is_none() && self.speed.is_none() && self.reverse.is_none();
        plain && (self.until.as_ref()).is_none_or(|until| self.angle.is_none() && until.condition.is_bare())
    }
}

impl Condition {
    /// Returns whether it names its sensors and nothing else.
    pub fn is_bare(&self) -> bool {
        self.state.is_none() && self.within.is_none()
    }
}

/// `with radius 1.5 meters`
#[derive(Debug, Clone, PartialEq)]
pub struct Circle {
    /// In `unit`.
    pub radius: Option<Number>,
    /// `meters` or `centimeters`.
    pub unit: Option<(Unit, Span)>,
    /// From `with` to the unit.
    pub span: Span,
}

/// Ways to turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// Counter-clockwise seen from above.
    Left,
    /// Clockwise seen from above.
    Right,
}

/// `wait`
#[derive(Debug, Clone, PartialEq)]
pub struct Wait {
    /// The time; it may be absent beside `until`.
    pub seconds: Option<Number>,
    /// `until { … } clear`
    pub until: Option<Until>,
}

/// `repeat`
#[derive(Debug, Clone, PartialEq)]
pub struct Repeat {
    /// The number of rounds.
    pub rounds: Option<Rounds>,
    /// The actions of each round.
    pub block: Option<Block>,
}

/// The number of rounds of a block.
#[derive(Debug, Clone, PartialEq)]
pub enum Rounds {
    /// `4 times`
    Times(Number),
    /// `until { … } detect`, asked before each round.
    Until(Until),
}

/// `if … else if … else …`
#[derive(Debug, Clone, PartialEq)]
pub struct If {
    /// The `if`, and each `else if` after it. Only the block of the first whose condition holds is done.
    pub branches: Vec<Branch>,
    /// The block of `else`, which is done if no condition holds.
    pub otherwise: Option<Block>,
}

/// `if { … } clear { … }`
#[derive(Debug, Clone, PartialEq)]
pub struct Branch {
    /// When its block is done.
    pub condition: Option<Condition>,
    /// The actions.
    pub block: Option<Block>,
    /// From `if` to the closing brace.
    pub span: Span,
}

/// `do`
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Do {
    /// Another movement of the same robot.
    pub movement: Option<Name>,
}

/// `environment`
#[derive(Debug, Clone, PartialEq)]
pub struct Environment {
    /// Its name.
    pub name: Option<Name>,
    /// `with ip …`
    pub ip: Option<IpClause>,
    /// `has { … } robots`
    pub robots: Option<References>,
    /// `with { … } moves`
    pub movements: Option<References>,
}

/// `with ip ip1`, or `, ip1` in the older spelling.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct IpClause {
    /// Which ip.
    pub name: Option<Name>,
    /// From its first word or comma to its last.
    pub span: Span,
    /// True for the older spelling.
    pub with_comma: bool,
}
