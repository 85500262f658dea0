//! The rules of statements ("Grammar" of "The language grows").
//!
//! The words that are new there are contextual. No rule has a choice between such a word and a name: a statement begins with
//! none, and a name always follows `do`, `,` or another name. So `do wait` is always the movement `wait`.

use super::Reader;
use crate::program::{
    Action, ActionKind, Block, Clause, Condition, Else, Length, Number, Rounds, Stop, Turn,
};

impl Reader<'_> {
    // Block = "{" { Action } "}" ;
    pub(super) fn block(&mut self) -> Option<Block> {
        let start = self.word("{")?.start;
        let mut actions = Vec::new();
        while !self.sees("}") {
            actions.push(self.action()?);
        }
        let range = start..self.word("}")?.end;
        Some(Block { actions, range })
    }

    // Action = Move | Turn | Wait | Repeat | If | Do | "slam" ;
    fn action(&mut self) -> Option<Action> {
        let keyword = self.start();
        let kind = if self.word("move").is_some() {
            self.move_()?
        } else if self.word("turn").is_some() {
            self.turn()?
        } else if self.contextual("wait").is_some() {
            self.wait()?
        } else if self.contextual("repeat").is_some() {
            self.repeat()?
        } else if self.contextual("if").is_some() {
            return self.if_(keyword);
        } else if self.contextual("do").is_some() {
            ActionKind::Do { movement: self.name()? }
        } else {
            self.word("slam")?;
            ActionKind::Slam
        };
        Some(self.action_from(keyword, kind))
    }

    /// A complete statement; its first word began at `start`.
    fn action_from(&self, start: usize, kind: ActionKind) -> Action {
        let length = match &kind {
            ActionKind::Move { .. } | ActionKind::Turn(_) | ActionKind::Wait { .. } | ActionKind::Slam => 4,
            ActionKind::Repeat { .. } => 6,
            ActionKind::If { .. } | ActionKind::Do { .. } => 2,
        };
        Action { range: start..self.last_end(), keyword: start..start + length, kind }
    }

    // Move = "move" ( Number Unit [ "at" Number ] [ Stop ] | [ "at" Number ] Stop ) ;
    fn move_(&mut self) -> Option<ActionKind> {
        let distance = match self.number() {
            Some(number) => Some(self.with_unit(number)?),
            None => None,
        };
        let speed = if self.word("at").is_some() { Some(self.number()?) } else { None };
        let until = self.stop()?;
        (distance.is_some() || until.is_some()).then_some(ActionKind::Move { distance, speed, until })
    }

    // Turn = "turn" Side [ Number ] [ "with" "radius" Number Unit ] [ "at" Number ] [ "in" "reverse" ] [ Stop ] ;
    fn turn(&mut self) -> Option<ActionKind> {
        self.one_of(&["left", "right"])?;
        let angle = self.number();
        let circle = match self.word("with") {
            Some(with) => {
                self.word("radius")?;
                let value = self.length()?;
                Some(Clause { range: with.start..self.last_end(), value })
            }
            None => None,
        };
        let speed = match self.word("at") {
            Some(at) => {
                let value = self.number()?;
                Some(Clause { range: at.start..self.last_end(), value })
            }
            None => None,
        };
        let reverse = match self.contextual("in") {
            Some(word) => Some(word.start..self.contextual("reverse")?.end),
            None => None,
        };
        let until = self.stop()?;
        Some(ActionKind::Turn(Turn { angle, circle, speed, reverse, until }))
    }

    // Wait = "wait" ( Number "seconds" [ Stop ] | Stop ) ;
    fn wait(&mut self) -> Option<ActionKind> {
        let seconds = self.number();
        if seconds.is_some() {
            self.contextual("seconds")?;
        }
        let until = self.stop()?;
        (seconds.is_some() || until.is_some()).then_some(ActionKind::Wait { seconds, until })
    }

    // Repeat = "repeat" ( Number "times" | "until" Condition ) Block ;
    fn repeat(&mut self) -> Option<ActionKind> {
        let rounds = if let Some(number) = self.number() {
            self.contextual("times")?;
            Rounds::Times(number)
        } else {
            self.word("until")?;
            Rounds::Until(self.condition()?)
        };
        Some(ActionKind::Repeat { rounds, body: self.block()? })
    }

    // If = "if" Condition Block [ "else" ( If | Block ) ] ;
    fn if_(&mut self, start: usize) -> Option<Action> {
        let condition = self.condition()?;
        let then = self.block()?;
        let mut otherwise = None;
        if self.contextual("else").is_some() {
            let start = self.start();
            otherwise = Some(if self.contextual("if").is_some() {
                Else::If(Box::new(self.if_(start)?))
            } else {
                Else::Block(self.block()?)
            });
        }
        Some(self.action_from(start, ActionKind::If { condition, then, otherwise }))
    }

    // [ Stop ], Stop = "until" Condition ;
    #[allow(
        clippy::option_option,
        reason = "outside: whether it is in the language; inside: whether it is there"
    )]
    fn stop(&mut self) -> Option<Option<Stop>> {
        let Some(until) = self.word("until") else { return Some(None) };
        let value = self.condition()?;
        Some(Some(Stop { range: until.start..self.last_end(), value }))
    }

    // Condition = "{" Refs(Sensor) "}" [ "clear" | "detect" ] [ "within" Number Unit ] ;
    fn condition(&mut self) -> Option<Condition> {
        let (sensors, list) = self.some_braced_refs()?;
        let word = self.contextual("clear").or_else(|| self.contextual("detect"));
        let within = match self.contextual("within") {
            Some(within) => {
                let value = self.length()?;
                Some(Clause { range: within.start..self.last_end(), value })
            }
            None => None,
        };
        Some(Condition { sensors, list, word, within })
    }

    // Number Unit
    fn length(&mut self) -> Option<Length> {
        let number = self.number()?;
        self.with_unit(number)
    }

    // Unit = "meters" | "centimeters" ;
    fn with_unit(&mut self, number: Number) -> Option<Length> {
        let meters = self.one_of(&["meters", "centimeters"])? == "meters";
        Some(Length { number, meters })
    }
}
