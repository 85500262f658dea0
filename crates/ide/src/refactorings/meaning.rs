//! The meaning of an action as a text that is equal for equal actions: units, defaults, commas and comments make no
//! difference.

use std::fmt::Write as _;

use pydslrep_analysis::DEFAULT_ANGLE;
use pydslrep_kinematics::motion::RIM_SPEED;
use pydslrep_syntax::ast::{
    Action, ActionKind, Block, Condition, Move, Number, SpeedClause, Turn, Unit, Until,
};

use super::Selection;

/// Returns the meaning of an action; `None` if part of it is missing.
pub(super) fn meaning(selection: &Selection<'_>, action: &Action) -> Option<String> {
    let mut words = Words { selection, text: String::new() };
    words.action(action)?;
    Some(words.text)
}

struct Words<'a> {
    selection: &'a Selection<'a>,
    text: String,
}

impl Words<'_> {
    fn action(&mut self, action: &Action) -> Option<()> {
        match &action.kind {
            ActionKind::Move(step) => self.step(step),
            ActionKind::Turn(turn) => self.turn(turn),
            // The others mean what their words say.
            _ => self.written(action),
        }
    }

    /// The words of an action as the program has them; the meaning of its numbers, conditions and blocks.
    fn written(&mut self, action: &Action) -> Option<()> {
        let tokens = &self.selection.entity.parse.tokens;
        let (mut numbers, mut conditions) = (action.numbers().peekable(), action.conditions().peekable());
        let mut blocks = action.blocks().peekable();
        let mut next = action.span.start;
        while next < action.span.end {
            let (token, span) = *tokens.get(tokens.partition_point(|(_, span)| span.start < next))?;
            next = span.end;
            if let Some(number) = numbers.next_if(|number| number.span == span) {
                self.number(number.value?);
            } else if let Some(condition) = conditions.next_if(|part| part.span.start == span.start) {
                self.condition(condition)?;
                next = condition.span.end;
            } else if let Some(block) = blocks.next_if(|block| block.span.start == span.start) {
                self.block(block)?;
                next = block.span.end;
            } else if let Some(word) = token.spelling() {
                self.word(word);
            } else if !token.is_comment() {
                self.word(self.selection.text(span).trim_start_matches('^'));
            }
        }
        Some(())
    }

    fn step(&mut self, step: &Move) -> Option<()> {
        self.word("move");
        if let Some(distance) = &step.distance {
            self.length(distance, step.unit?.0)?;
        }
        self.speed(step.speed.as_ref())?;
        self.until(step.until.as_ref())
    }

    fn turn(&mut self, turn: &Turn) -> Option<()> {
        self.word("turn");
        let (direction, _) = turn.direction?;
        write!(self.text, "{direction:?} ").ok()?;
        match &turn.angle {
            Some(angle) => self.number(angle.value?),
            None if turn.until.is_none() => self.number(DEFAULT_ANGLE),
            None => {}
        }
        if let Some(circle) = &turn.circle {
            self.word("with");
            self.length(circle.radius.as_ref()?, circle.unit?.0)?;
        }
        self.speed(turn.speed.as_ref())?;
        if turn.reverse.is_some() {
            self.word("reverse");
        }
        self.until(turn.until.as_ref())
    }

    fn block(&mut self, block: &Block) -> Option<()> {
        self.word("{");
        block.actions.iter().try_for_each(|action| self.action(action))?;
        self.word("}");
        Some(())
    }

    fn until(&mut self, until: Option<&Until>) -> Option<()> {
        let Some(until) = until else { return Some(()) };
        self.word("until");
        self.condition(&until.condition)
    }

    fn condition(&mut self, condition: &Condition) -> Option<()> {
        if condition.sensors.broken {
            return None;
        }
        condition.sensors.names.iter().for_each(|name| self.word(&name.text));
        if let Some((state, _)) = condition.state {
            write!(self.text, "{state:?} ").ok()?;
        }
        if let Some(within) = &condition.within {
            self.word("within");
            self.length(within.distance.as_ref()?, within.unit?.0)?;
        }
        Some(())
    }

    fn speed(&mut self, clause: Option<&SpeedClause>) -> Option<()> {
        self.word("at");
        let speed = match clause {
            Some(clause) => clause.value.as_ref()?.value? / 100.0,
            None => RIM_SPEED,
        };
        self.number(speed);
        Some(())
    }

    fn length(&mut self, number: &Number, unit: Unit) -> Option<()> {
        let value = number.value?;
        // Divided, not multiplied, so that `400 centimeters` is exactly 4.
        let metres = match unit {
            Unit::Meters => value,
            Unit::Centimeters => value / 100.0,
        };
        self.number(metres);
        Some(())
    }

    fn number(&mut self, value: f64) {
        // Writing to a string cannot fail.
        let _ = write!(self.text, "{value:?} ");
    }

    fn word(&mut self, word: &str) {
        self.text.push_str(word);
        self.text.push(' ');
    }
}
