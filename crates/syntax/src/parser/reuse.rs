//! Reading a movement again after an edit: the actions that the edit cannot have changed are taken from the earlier tree.
//!
//! An action about which the rules complained nowhere, neither in it nor in the few tokens after it, is read in the same way
//! again as long as these tokens stay: only recovery from a mistake looks at more.

use chumsky::input::InputRef;
use chumsky::prelude::{Parser, custom};

use super::piece::without_trivia;
use super::slot::Fault;
use super::{Extra, Input};
use crate::ast::{Action, Entity};
use crate::shift::Shift;
use crate::{Earlier, Span, Token};

/// The tokens after an action that must be as they were, too. The rules look at two of them.
const MARGIN: usize = 8;

/// An action that need not be read again.
#[derive(Debug, Clone, Copy)]
pub(super) struct Known<'a> {
    action: &'a Action,
    /// How far it has moved.
    by: i64,
    /// Where it begins now.
    start: u32,
    /// The number of its tokens.
    tokens: usize,
}

/// The actions that need not be read again, in the order of the text.
pub(super) fn known_actions<'a>(earlier: &Earlier<'a>, now: &[Token]) -> Vec<Known<'a>> {
    let before = without_trivia(&earlier.parse.tokens);
    let mut known = Vec::new();
    if let Some(Entity::Movement(movement)) = &earlier.parse.entity {
        Settled::new(earlier, &before, now).add(&movement.actions, &mut known);
        count_tokens(&mut known, now);
    }
    known
}

/// Counts the tokens of each action.
fn count_tokens(known: &mut [Known<'_>], tokens: &[Token]) {
    let mut index = 0;
    for action in known {
        let mut end = action.action.span;
        end.shift(action.by);
        index += tokens[index..].iter().take_while(|(_, span)| span.start < action.start).count();
        action.tokens = tokens[index..].iter().take_while(|(_, span)| span.start < end.end).count();
    }
}

/// The parts of the earlier text in which an action is read as before.
struct Settled {
    /// Up to here before the edit.
    head: u32,
    /// From here on after it.
    tail: u32,
    /// How far what is after it has moved.
    growth: i64,
    /// Up to here before the first complaint, and from here on after the last one.
    faultless: (u32, u32),
}

impl Settled {
    fn new(earlier: &Earlier<'_>, before: &[Token], now: &[Token]) -> Self {
        let Earlier { edited, growth, .. } = *earlier;
        let head = before.iter().zip(now).take_while(|(old, new)| old == new && old.1.end <= edited.start);
        let tail = before.iter().rev().zip(now.iter().rev()).take_while(|(old, new)| {
            let (mut there, edited) = (**old, old.1.start < edited.end);
            there.1.shift(growth);
            !edited && there == **new
        });
        let tail = before.len() - tail.count();
        let faults = earlier.parse.faults;
        Self {
            head: end_of(before, head.count()),
            tail: before.get(tail).map_or(u32::MAX, |(_, span)| span.start),
            growth,
            faultless: faults.map_or((u32::MAX, 0), |faults| {
                let first = before.partition_point(|(_, span)| span.end <= faults.start);
                (end_of(before, first), faults.end.saturating_add(1))
            }),
        }
    }

    /// Adds the actions that need not be read again, and of the others those in their blocks.
    fn add<'a>(&self, actions: &'a [Action], known: &mut Vec<Known<'a>>) {
        for action in actions {
            let Some(by) = self.shift_of(action.span) else {
                action.blocks().for_each(|block| self.add(&block.actions, known));
                continue;
            };
            let mut at = action.span;
            at.shift(by);
            known.push(Known { action, by, start: at.start, tokens: 0 });
        }
    }

    /// How far an action has moved that need not be read again.
    fn shift_of(&self, action: Span) -> Option<i64> {
        let (first, last) = self.faultless;
        if action.end > first && action.start < last {
            None
        } else if action.end <= self.head {
            Some(0)
        } else {
            (action.start >= self.tail).then_some(self.growth)
        }
    }
}

/// Where an action must end before the token at `index`.
fn end_of(tokens: &[Token], index: usize) -> u32 {
    index.checked_sub(MARGIN + 1).map_or(0, |last| tokens[last].1.end)
}

/// An action that is known already.
pub(super) fn known_action<'s>() -> impl Parser<'s, Input<'s>, Action, Extra<'s>> + Clone {
    custom(|input: &mut InputRef<'s, '_, Input<'s>, Extra<'s>>| {
        let begin = input.cursor();
        input.skip();
        let first = input.span_since(&begin);
        let all = input.state().known;
        let Ok(index) = all.binary_search_by_key(&first.start, |known| known.start) else {
            return Err(Fault::nothing(first));
        };
        let known = &all[index];
        (1..known.tokens).for_each(|_| input.skip());
        let mut action = known.action.clone();
        if known.by != 0 {
            action.shift(known.by);
        }
        Ok(action)
    })
}
