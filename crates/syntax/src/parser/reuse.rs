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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Parse, TokenKind, lex, parse, parse_again};

    const PROGRAM: &str = "movement m of rover {\n  move 3.2 meters at 18.7\n  turn left until { front, back }\n  \
        repeat 5 times {\n    turn right 45.0 // a comment\n    if { front } detect within 1.0 meters {\n      \
        move 1.2 meters\n      wait 2 seconds\n    } else if { back } clear {\n      do side\n    } else {\n      \
        repeat until { front } detect {\n        turn left with radius 2 meters in reverse\n        \
        move at 3.4 until { back } clear\n      }\n    }\n    wait until { front, back } clear\n  }\n  \
        move 143.3 centimeters at 2.4\n  turn left 22.5\n  do other\n  slam\n  move 1 meters\n  turn left\n}\n";

    /// Words that mean much where they do not belong.
    const TYPED: [&str; 25] = [
        " ",
        "{",
        "}",
        "move ",
        "m",
        "wait ",
        "else ",
        "until ",
        "3.5 ",
        "front ",
        "/*",
        "*/",
        "// x\n",
        "at ",
        "\"",
        "repeat 2 times { slam } ",
        "sensor s ",
        "-1",
        ".",
        "’s",
        "-",
        "ä",
        "\n",
        "/",
        "# ",
    ];

    fn again(before: &(Span, Parse), edited: Span, typed: &str, text: &str) -> Vec<(Span, Parse)> {
        let growth = i64::try_from(typed.len()).unwrap() - i64::from(edited.len());
        let mut end = Span::at(before.0.end);
        end.shift(growth);
        let now = Span::new(before.0.start, end.end);
        parse_again(text, Some(Earlier { parse: &before.1, now, edited, growth }))
    }

    /// Every place, every word: with what each edit leaves behind, as it is typed on.
    #[test]
    fn what_is_read_again_is_what_is_read_anew() {
        let places: Vec<u32> =
            lex(PROGRAM).iter().flat_map(|(_, span)| [span.start, span.start + 1, span.end]).collect();
        for (number, place) in places.iter().flat_map(|place| [place; 4]).enumerate() {
            let place = *place;
            let mut text = PROGRAM.to_owned();
            let mut before = parse(&text);
            let steps = (0..4).map(|step| (TYPED[(number + step * 7) % TYPED.len()], step % 2 == 0));
            for (typed, replaces) in steps {
                let [only] = &before[..] else { break };
                let end = (place + 5 * u32::from(replaces)).min(only.0.end);
                let edited = Span::new(place.min(end), end);
                text.replace_range(std::ops::Range::from(edited), typed);
                let now = again(only, edited, typed, &text);
                assert_eq!(now, parse(&text), "{text}");
                before = now;
            }
        }
    }

    #[test]
    fn an_edit_in_the_middle_leaves_most_actions_as_they_are() {
        let before = parse(PROGRAM).remove(0).1;
        let place = u32::try_from(PROGRAM.find("side").unwrap()).unwrap();
        let edited = Span::new(place, place + 1);
        let text = PROGRAM.replace("side", "outside");
        let earlier = Earlier { parse: &before, now: Span::of(&text), edited, growth: 3 };
        let now: Vec<Token> = without_trivia(&lex(&text));
        let known = known_actions(&earlier, &now);
        assert!(known.iter().all(|known| now.iter().any(|(_, token)| token.start == known.start)));
        let known: Vec<TokenKind> = known.iter().map(|known| known.action.keyword()).collect();
        let (far, turn, wait) = (TokenKind::Move, TokenKind::Turn, TokenKind::Wait);
        let after = [TokenKind::Repeat, wait, far, turn, TokenKind::Do, TokenKind::Slam, far, turn];
        assert_eq!(
            known,
            [&[far, turn, turn, far, wait][..], &after].concat(),
            "all but two that are open and one"
        );
    }
}
