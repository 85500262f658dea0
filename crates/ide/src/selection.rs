//! Expand selection: from a word to its list, clause, action, block, movement, entity, adjacent entities of the same kind,
//! and file.

use pydslrep_analysis::{Database, EntityRef, FileId};
use pydslrep_syntax::ast::{Action, ActionKind, Entity, Move, References};
use pydslrep_syntax::{Span, Token, TokenKind};

use crate::cursor::{body, tokens, touching};

/// The ranges around each offset, from the smallest to the whole file. The entities are collected once for all offsets.
pub fn selection_ranges(database: &Database, file: FileId, offsets: &[u32]) -> Vec<Vec<Span>> {
    let entities: Vec<EntityRef<'_>> = database.entities(file).collect();
    let whole = Span::new(0, entities.last().map_or(0, |entity| entity.span.end));
    let runs = runs(&entities);
    let around = |offset: &u32| {
        let mut ranges = Ranges { offset: (*offset).min(whole.end), chain: Vec::new() };
        let index = entities.partition_point(|entity| entity.span.end <= ranges.offset);
        let index = index.min(entities.len().saturating_sub(1));
        if let (Some(entity), Some(run)) = (entities.get(index), runs.get(index)) {
            ranges.add_inside(entity);
            ranges.add(body(entity));
            ranges.add(*run);
        }
        ranges.chain.retain(|range| *range != whole);
        ranges.chain.push(whole);
        ranges.chain
    };
    offsets.iter().map(around).collect()
}

/// For each entity the range of the adjacent entities of its kind, including itself.
fn runs(entities: &[EntityRef<'_>]) -> Vec<Span> {
    let kind = |entity: &EntityRef<'_>| entity.parse.entity.as_ref().map(Entity::kind);
    let mut runs = Vec::with_capacity(entities.len());
    for run in entities.chunk_by(|a, b| kind(a) == kind(b)) {
        let span = run.first().zip(run.last()).map(|(first, last)| body(first).to(body(last)));
        runs.extend(span.map(|span| std::iter::repeat_n(span, run.len())).into_iter().flatten());
    }
    runs
}

/// The ranges around an offset, growing.
struct Ranges {
    offset: u32,
    chain: Vec<Span>,
}

impl Ranges {
    /// Adds a range if it contains the offset and is larger than the last one.
    fn add(&mut self, span: Span) {
        let grows = self.chain.last().is_none_or(|last| last.to(span) == span && *last != span);
        if span.touches(self.offset) && !span.is_empty() && grows {
            self.chain.push(span);
        }
    }

    /// Adds the ranges inside an entity, the smallest first.
    fn add_inside(&mut self, entity: &EntityRef<'_>) {
        let start = entity.span.start;
        let tokens: Vec<Token> = tokens(entity).collect();
        if let Some((_, span)) = touching(tokens.iter().copied(), self.offset) {
            self.add(span);
        }
        match &entity.parse.entity {
            Some(Entity::Robot(robot)) => {
                self.add_lists([robot.wheels.as_ref(), robot.sensors.as_ref()], start);
            }
            Some(Entity::Environment(environment)) => {
                self.add_lists([environment.robots.as_ref(), environment.movements.as_ref()], start);
            }
            Some(Entity::Movement(movement)) => {
                self.add_actions(&movement.actions, start, &tokens);
                if let Some(body) = movement.body.map(|body| body.shifted(start)) {
                    if let (Some(first), Some(last)) = (movement.actions.first(), movement.actions.last()) {
                        self.add(first.span.to(last.span).shifted(start));
                    }
                    self.add(body);
                    let head = tokens.partition_point(|(_, span)| span.start < body.start);
                    return self.add_clauses(&tokens[..head]);
                }
            }
            _ => {}
        }
        self.add_clauses(&tokens);
    }

    fn add_actions(&mut self, actions: &[Action], start: u32, tokens: &[Token]) {
        for action in actions {
            self.add_action(action, start, tokens);
        }
    }

    fn add_action(&mut self, action: &Action, start: u32, tokens: &[Token]) {
        let span = action.span.shifted(start);
        if !span.touches(self.offset) {
            return;
        }
        let blocks = action.blocks().map(|block| block.span.shifted(start));
        let offset = self.offset;
        for block in action.blocks().filter(|block| block.span.shifted(start).touches(offset)) {
            self.add_actions(&block.actions, start, tokens);
            if let (Some(first), Some(last)) = (block.actions.first(), block.actions.last()) {
                self.add(first.span.to(last.span).shifted(start));
            }
            self.add(block.span.shifted(start));
        }
        for condition in action.conditions() {
            self.add_lists([Some(&condition.sensors)], start);
            self.add(condition.span.shifted(start));
        }
        if let ActionKind::If(choice) = &action.kind {
            choice.branches.iter().for_each(|branch| self.add(branch.span.shifted(start)));
        }
        // The clauses of an action with blocks end before the first of them.
        let head = blocks.map(|block| block.start).min().unwrap_or(span.end);
        if let ActionKind::Move(Move { distance: Some(distance), unit: Some((_, unit)), .. }) = &action.kind {
            self.add(distance.span.to(*unit).shifted(start));
        }
        let clause = |(token, place): &&Token| {
            matches!(token, TokenKind::At | TokenKind::Until)
                && span.start <= place.start
                && place.end <= head
        };
        if let Some((_, word)) = tokens.iter().find(clause) {
            self.add(Span::new(word.start, head));
        }
        self.add(span);
    }

    fn add_lists<const N: usize>(&mut self, lists: [Option<&References>; N], start: u32) {
        for list in lists.into_iter().flatten() {
            if let (Some(first), Some(last)) = (list.names.first(), list.names.last()) {
                self.add(first.span.to(last.span).shifted(start));
            }
            self.add(list.span.shifted(start));
        }
    }

    /// Adds the clauses of an entity's header: each reaches from its keyword to the next clause.
    fn add_clauses(&mut self, tokens: &[Token]) {
        let significant: Vec<&Token> = tokens.iter().filter(|(token, _)| !token.is_comment()).collect();
        let begins = |token| {
            matches!(
                token,
                TokenKind::With | TokenKind::Has | TokenKind::Type | TokenKind::Of | TokenKind::Colon
            )
        };
        for clause in significant.chunk_by(|_, next| !begins(next.0)) {
            if let (Some(first), Some(last)) = (clause.first(), clause.last())
                && begins(first.0)
            {
                self.add(first.1.to(last.1));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;
    use crate::fixture::at_cursor;

    fn check(fixture: &str, expected: &Expect) {
        let (database, position) = at_cursor(fixture);
        let ranges = selection_ranges(&database, position.file, &[position.offset]).remove(0);
        for pair in ranges.windows(2) {
            assert!(pair[0].to(pair[1]) == pair[1] && pair[0] != pair[1], "{ranges:?}");
        }
        let lines = ranges.iter().map(|span| format!("{:?}\n", database.slice(position.file, *span)));
        expected.assert_eq(&lines.collect::<String>());
    }

    #[test]
    fn a_name_in_an_action_grows_step_by_step() {
        check(
            "wheel a with radius 3\nmovement m of r {\n  slam\n  turn left until { s$0, t }\n}\nmovement n of r { }\n",
            &expect![[r#"
                "s"
                "s, t"
                "{ s, t }"
                "until { s, t }"
                "turn left until { s, t }"
                "slam\n  turn left until { s, t }"
                "{\n  slam\n  turn left until { s, t }\n}"
                "movement m of r {\n  slam\n  turn left until { s, t }\n}"
                "movement m of r {\n  slam\n  turn left until { s, t }\n}\nmovement n of r { }"
                "wheel a with radius 3\nmovement m of r {\n  slam\n  turn left until { s, t }\n}\nmovement n of r { }\n"
            "#]],
        );
    }

    #[test]
    fn a_number_grows_to_its_clause() {
        check(
            "movement m of r { move $04.0 meters at 9 }",
            &expect![[r#"
                "4.0"
                "4.0 meters"
                "move 4.0 meters at 9"
                "{ move 4.0 meters at 9 }"
                "movement m of r { move 4.0 meters at 9 }"
            "#]],
        );
        check(
            "wheel a with radius 3$0\nwheel b with radius 3\nsensor s",
            &expect![[r#"
                "3"
                "with radius 3"
                "wheel a with radius 3"
                "wheel a with radius 3\nwheel b with radius 3"
                "wheel a with radius 3\nwheel b with radius 3\nsensor s"
            "#]],
        );
    }

    #[test]
    fn a_list_grows_to_its_clause() {
        check(
            "robot r type tw with port 1 has { a, $0b } wheels with sensors { s }",
            &expect![[r#"
                "b"
                "a, b"
                "{ a, b }"
                "has { a, b } wheels"
                "robot r type tw with port 1 has { a, b } wheels with sensors { s }"
            "#]],
        );
    }

    #[test]
    fn entities_with_errors_are_expanded() {
        check(
            "movement m of { move mo$0re",
            &expect![[r#"
                "more"
                "move more"
                "{ move more"
                "movement m of { move more"
            "#]],
        );
        check(
            "  $0 // c",
            &expect![[r#"
            "   // c"
        "#]],
        );
    }

    #[test]
    fn several_offsets_are_handled_in_order() {
        let mut database = Database::new();
        let file = database.open("a.pyr", "wheel a with radius 3\n");
        let ranges = selection_ranges(&database, file, &[6, 0, 999]);
        let starts: Vec<Span> = ranges.iter().map(|ranges| ranges[0]).collect();
        assert_eq!(starts, [Span::new(6, 7), Span::new(0, 5), Span::new(0, 22)]);
        let empty = database.open("b.pyr", "");
        assert_eq!(selection_ranges(&database, empty, &[0, 5]), [[Span::at(0)], [Span::at(0)]]);
    }

    #[test]
    fn an_action_in_blocks_grows_block_by_block() {
        check(
            "movement m of r {\n  slam\n  repeat 2 times {\n    if { a } clear {\n      slam\n    } else {\n      turn left\n      wait $02 seconds\n    }\n  }\n}",
            &expect![[r#"
                "2"
                "wait 2 seconds"
                "turn left\n      wait 2 seconds"
                "{\n      turn left\n      wait 2 seconds\n    }"
                "if { a } clear {\n      slam\n    } else {\n      turn left\n      wait 2 seconds\n    }"
                "{\n    if { a } clear {\n      slam\n    } else {\n      turn left\n      wait 2 seconds\n    }\n  }"
                "repeat 2 times {\n    if { a } clear {\n      slam\n    } else {\n      turn left\n      wait 2 seconds\n    }\n  }"
                "slam\n  repeat 2 times {\n    if { a } clear {\n      slam\n    } else {\n      turn left\n      wait 2 seconds\n    }\n  }"
                "{\n  slam\n  repeat 2 times {\n    if { a } clear {\n      slam\n    } else {\n      turn left\n      wait 2 seconds\n    }\n  }\n}"
                "movement m of r {\n  slam\n  repeat 2 times {\n    if { a } clear {\n      slam\n    } else {\n      turn left\n      wait 2 seconds\n    }\n  }\n}"
            "#]],
        );
        check(
            "movement m of r {\n  if { a, b$0 } clear within 2 meters { slam }\n  slam\n}",
            &expect![[r#"
                "b"
                "a, b"
                "{ a, b }"
                "{ a, b } clear within 2 meters"
                "if { a, b } clear within 2 meters { slam }"
                "if { a, b } clear within 2 meters { slam }\n  slam"
                "{\n  if { a, b } clear within 2 meters { slam }\n  slam\n}"
                "movement m of r {\n  if { a, b } clear within 2 meters { slam }\n  slam\n}"
            "#]],
        );
    }
}
