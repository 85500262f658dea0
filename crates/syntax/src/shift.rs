//! Actions at another place of their text, as after an edit before them.

use smol_str::SmolStr;

use crate::Span;
use crate::ast::{
    Action, ActionKind, Block, Branch, Circle, Condition, Direction, Do, If, Move, Name, Number, References,
    Repeat, Rounds, SensorState, SpeedClause, Turn, Unit, Until, Wait, Within,
};

/// What has places in a text.
pub(crate) trait Shift {
    /// Moves its places `by` bytes.
    fn shift(&mut self, by: i64);
}

impl Shift for Span {
    fn shift(&mut self, by: i64) {
        let moved = |offset: u32| u32::try_from(i64::from(offset) + by).unwrap_or(u32::MAX);
        *self = Self { start: moved(self.start), end: moved(self.end) };
    }
}

impl<T: Shift> Shift for Option<T> {
    fn shift(&mut self, by: i64) {
        if let Some(inside) = self {
            inside.shift(by);
        }
    }
}

impl<T: Shift> Shift for Vec<T> {
    fn shift(&mut self, by: i64) {
        for item in self {
            item.shift(by);
        }
    }
}

impl<T> Shift for (T, Span) {
    fn shift(&mut self, by: i64) {
        self.1.shift(by);
    }
}

/// Values that have no places.
macro_rules! placeless {
    ($($name:ty),*) => { $(impl Shift for $name { fn shift(&mut self, _: i64) {} })* };
}

placeless!(bool, f64, SmolStr, Direction, SensorState, Unit);

/// Moves all fields of structures. They are listed by name and without `..`, so that the compiler asks for a new one.
macro_rules! fields {
    ($($name:ident { $($field:ident),* })*) => {
        $(impl Shift for $name {
            fn shift(&mut self, by: i64) {
                let Self { $($field),* } = self;
                $($field.shift(by);)*
            }
        })*
    };
}

fields! {
    Action { kind, span }
    Block { actions, span }
    Branch { condition, block, span }
    Circle { radius, unit, span }
    Condition { sensors, state, within, span }
    Do { movement }
    If { branches, otherwise }
    Move { distance, unit, speed, until }
    Name { text, span }
    Number { value, span }
    References { names, span, broken }
    Repeat { rounds, block }
    SpeedClause { value, span }
    Turn { direction, angle, circle, speed, reverse, until }
    Until { condition, span }
    Wait { seconds, until }
    Within { distance, unit, span }
}

impl Shift for ActionKind {
    fn shift(&mut self, by: i64) {
        match self {
            Self::Move(step) => step.shift(by),
            Self::Turn(turn) => turn.shift(by),
            Self::Wait(wait) => wait.shift(by),
            Self::Repeat(repeat) => repeat.shift(by),
            Self::If(choice) => choice.shift(by),
            Self::Do(call) => call.shift(by),
            Self::Slam => {}
        }
    }
}

impl Shift for Rounds {
    fn shift(&mut self, by: i64) {
        match self {
            Self::Times(count) => count.shift(by),
            Self::Until(until) => until.shift(by),
        }
    }
}
