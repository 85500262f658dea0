//! The meaning of an action as a text that is equal for equal actions: units, defaults, commas and comments make no
//! difference.

use std::fmt::Write as _;

use pydslrep_analysis::DEFAULT_ANGLE;
use pydslrep_kinematics::motion::RIM_SPEED;
use pydslrep_syntax::ast::{
    Action, ActionKind, Block, Condition, If, Move, Number, Repeat, Rounds, SpeedClause, Turn, Unit, Until,
    Wait,
};

/// Returns the meaning of an action; `None` if part of it is missing.
pub(super) fn meaning(action: &Action) -> Option<String> {
    let mut words = Words::default();
    words.action(action)?;
    Some(words.text)
}

#[derive(Default)]
struct Words {
    text: String,
}

impl Words {
    fn action(&mut self, action: &Action) -> Option<()> {
        match &action.kind {
            ActionKind::Move(step) => self.step(step),
            ActionKind::Turn(turn) => self.turn(turn),
            ActionKind::Wait(wait) => self.wait(wait),
            ActionKind::Repeat(repeat) => self.repeat(repeat),
            ActionKind::If(choice) => self.choice(choice),
            ActionKind::Do(call) => {
                self.word("do");
                self.word(&call.movement.as_ref()?.text);
                Some(())
            }
            ActionKind::Slam => {
                self.word("slam");
                Some(())
            }
        }
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

    fn wait(&mut self, wait: &Wait) -> Option<()> {
        self.word("wait");
        if let Some(seconds) = &wait.seconds {
            self.number(seconds.value?);
        }
        self.until(wait.until.as_ref())
    }

    fn repeat(&mut self, repeat: &Repeat) -> Option<()> {
        self.word("repeat");
        match repeat.rounds.as_ref()? {
            Rounds::Times(count) => self.number(count.value?),
            Rounds::Until(until) => self.until(Some(until))?,
        }
        self.block(repeat.block.as_ref()?)
    }

    fn choice(&mut self, choice: &If) -> Option<()> {
        for branch in &choice.branches {
            self.word("if");
            self.condition(branch.condition.as_ref()?)?;
            self.block(branch.block.as_ref()?)?;
        }
        if let Some(block) = &choice.otherwise {
            self.word("else");
            self.block(block)?;
        }
        Some(())
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
