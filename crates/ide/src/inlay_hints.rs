//! Inlay hints: behind each action how long it takes and the pose it ends at, and the speed or angle it leaves out.
//!
//! Poses count from where the movement starts. Only movements in the asked range are planned, each up to the last
//! action in it, and a movement that is still being written up to its first mistake.

use pydslrep_analysis::environment::{Action, ActionKind};
use pydslrep_analysis::{Database, EntityRef, FileId, plan_movement};
use pydslrep_syntax::Span;
use pydslrep_syntax::ast::{self, Entity};

use crate::hover::drawing::{self, number, time};
use crate::hover::motion::{action_facts, leg, why_unknown};

/// Which hints are wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InlayHintOptions {
    /// The pose after each action.
    pub pose: bool,
    /// How long each action takes.
    pub duration: bool,
    /// Speeds and angles that are left out.
    pub defaults: bool,
}

impl Default for InlayHintOptions {
    fn default() -> Self {
        Self { pose: true, duration: true, defaults: true }
    }
}

/// Something shown behind an action.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InlayHint {
    /// Where: at the end of the action.
    pub offset: u32,
    /// What is shown.
    pub label: String,
    /// Markdown.
    pub tooltip: String,
    /// What would make the program say the same, where it can.
    pub insert: Option<String>,
}

/// The hints in a range, in the order of the text.
pub fn inlay_hints(
    database: &Database,
    file: FileId,
    range: Span,
    options: InlayHintOptions,
) -> Vec<InlayHint> {
    database
        .entities_from(file, range.start.saturating_sub(1))
        .take_while(|entity| entity.span.start <= range.end)
        .flat_map(|entity| of_movement(database, &entity, range, options).unwrap_or_default())
        .collect()
}

fn of_movement(
    database: &Database,
    entity: &EntityRef<'_>,
    range: Span,
    options: InlayHintOptions,
) -> Option<Vec<InlayHint>> {
    let Some(Entity::Movement(tree)) = &entity.parse.entity else { return None };
    let end = |action: &ast::Action| action.span.end + entity.span.start;
    let first = tree.actions.partition_point(|action| end(action) < range.start);
    let after = tree.actions.partition_point(|action| end(action) <= range.end);
    if first >= after || !(options.pose || options.duration || options.defaults) {
        return None;
    }
    let (robot, movement) = database.movement_start(entity.id, after)?;
    let path = plan_movement(&robot, &movement).ok()?;
    let mut hints = Vec::new();
    for (index, (written, action)) in tree.actions.iter().zip(&movement.actions).enumerate().skip(first) {
        let offset = end(written);
        if options.defaults {
            hints.extend(left_out(written, action).map(|(label, insert)| {
                let tooltip = "What holds where nothing is written.".to_owned();
                InlayHint { offset, label, tooltip, insert: Some(insert) }
            }));
        }
        let duration = leg(&robot, &movement, &path, index).map(|leg| leg.duration);
        // A speed that is no speed is an error of its own.
        let duration = duration.filter(|seconds| options.duration && seconds.is_finite()).map(time);
        let pose = path.legs.get(index).filter(|leg| options.pose && leg.duration.is_finite());
        let pose = pose.map(|leg| format!("→ {}", drawing::pose(&leg.to)));
        let lost = options.pose && path.unknown_after.is_some_and(|cause| cause.action == index);
        let (label, tooltip) = if lost {
            let why = why_unknown(&movement, &path, index);
            ("pose unknown from here".to_owned(), format!("Poses from here on cannot be planned: {why}."))
        } else {
            let label: Vec<String> = duration.into_iter().chain(pose).collect();
            (label.join(" "), action_facts(&robot, &movement, &path, index))
        };
        if !label.is_empty() {
            hints.push(InlayHint { offset, label, tooltip, insert: None });
        }
    }
    Some(hints)
}

/// The clause that an action leaves out: as shown, and as it would be written.
fn left_out(written: &ast::Action, action: &Action) -> Option<(String, String)> {
    let text = match (&written.kind, &action.kind) {
        (ast::ActionKind::Move(ast::Move { speed: None, .. }), ActionKind::Move { speed, .. }) => {
            let speed = number(speed * 100.0, 3);
            if speed.contains('.') { format!("at {speed}") } else { format!("at {speed}.0") }
        }
        (ast::ActionKind::Turn(ast::Turn { extent: None, .. }), ActionKind::Turn { degrees }) => {
            number(degrees.abs(), 3)
        }
        _ => return None,
    };
    let insert = format!(" {text}");
    Some((text, insert))
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;
    use crate::fixture::PARTS;

    fn hints(text: &str, range: Span, options: InlayHintOptions) -> Vec<InlayHint> {
        let mut database = Database::new();
        let file = database.open("a.pyr", text);
        inlay_hints(&database, file, range, options)
    }

    /// The program's movements with the hints in it, each in `«…»`.
    fn shown(movements: &str, options: InlayHintOptions) -> String {
        let text = format!("{PARTS}{movements}");
        let mut shown = text.clone();
        for hint in hints(&text, Span::of(&text), options).iter().rev() {
            shown.insert_str(hint.offset as usize, &format!("«{}»", hint.label));
        }
        shown.split_off(PARTS.len())
    }

    fn check(movements: &str, expected: &Expect) {
        expected.assert_eq(&shown(movements, InlayHintOptions::default()));
    }

    const MOVES: &str =
        "movement m of rover {\n  move 1 meters\n  turn left // far\n  move -50 centimeters at 10\n}\n";

    #[test]
    fn each_action_has_its_pose_and_time() {
        check(
            MOVES,
            &expect![[r#"
            movement m of rover {
              move 1 meters«at 9.0»«11.3 s → (1 m, 0 m, 0°)»
              turn left«90»«2.8 s → (1 m, 0 m, 90°)» // far
              move -50 centimeters at 10«5.2 s → (1 m, -0.5 m, 90°)»
            }
        "#]],
        );
    }

    #[test]
    fn each_kind_can_be_switched_off() {
        let none = InlayHintOptions { pose: false, duration: false, defaults: false };
        assert_eq!(shown(MOVES, none), MOVES);
        expect![[r#"
            movement m of rover {
              move 1 meters«→ (1 m, 0 m, 0°)»
              turn left«→ (1 m, 0 m, 90°)» // far
              move -50 centimeters at 10«→ (1 m, -0.5 m, 90°)»
            }
        "#]]
        .assert_eq(&shown(MOVES, InlayHintOptions { pose: true, ..none }));
        expect![[r#"
            movement m of rover {
              move 1 meters«11.3 s»
              turn left«2.8 s» // far
              move -50 centimeters at 10«5.2 s»
            }
        "#]]
        .assert_eq(&shown(MOVES, InlayHintOptions { duration: true, ..none }));
        expect![[r#"
            movement m of rover {
              move 1 meters«at 9.0»
              turn left«90» // far
              move -50 centimeters at 10
            }
        "#]]
        .assert_eq(&shown(MOVES, InlayHintOptions { defaults: true, ..none }));
    }

    #[test]
    fn what_is_unknown_is_said_once() {
        check(
            "movement m of rover {\n  move 1 meters at 9\n  turn left until { front }\n  move 1 meters at 9\n  slam\n}\n",
            &expect![[r#"
                movement m of rover {
                  move 1 meters at 9«11.3 s → (1 m, 0 m, 0°)»
                  turn left until { front }«pose unknown from here»
                  move 1 meters at 9«11.3 s»
                  slam
                }
            "#]],
        );
        let text = format!("{PARTS}movement m of rover {{ turn left until {{ front }} move 1 meters at 9 }}");
        let tooltips: Vec<String> = hints(&text, Span::of(&text), InlayHintOptions::default())
            .into_iter()
            .map(|hint| hint.tooltip)
            .collect();
        expect![[r#"
            Poses from here on cannot be planned: `turn left until { front }` ends when the way is free.
            ---
            Takes 11.3 s. Where it starts cannot be planned: `turn left until { front }` ends when the way is free.

            Wheel rates: `wheelL` 2 rad/s, `wheelR` 2 rad/s."#]].assert_eq(&tooltips.join("\n---\n"));
    }

    #[test]
    fn broken_movements_have_hints_up_to_the_mistake() {
        check(
            "movement m of rover {\n  turn right\n  move 1 meters at 0\n  move\n  turn left 45\n",
            &expect![[r#"
                movement m of rover {
                  turn right«90»«2.8 s → (0 m, 0 m, -90°)»
                  move 1 meters at 0
                  move
                  turn left 45
            "#]],
        );
        check("movement m of nobody { turn right }", &expect!["movement m of nobody { turn right }"]);
    }

    #[test]
    fn only_the_range_is_answered() {
        let text = format!("{PARTS}{MOVES}{}", MOVES.replace("movement m", "movement n"));
        let line = text.find("  turn left").unwrap();
        let range = Span::new(u32::try_from(line).unwrap(), u32::try_from(line + 11).unwrap());
        let labels: Vec<String> =
            hints(&text, range, InlayHintOptions::default()).into_iter().map(|hint| hint.label).collect();
        assert_eq!(labels, ["90", "2.8 s → (1 m, 0 m, 90°)"]);
    }

    #[test]
    fn what_is_left_out_can_be_written() {
        let text = format!("{PARTS}{MOVES}");
        let options = InlayHintOptions { pose: false, duration: false, defaults: true };
        let mut written = text.clone();
        for hint in hints(&text, Span::of(&text), options).iter().rev() {
            written.insert_str(hint.offset as usize, hint.insert.as_deref().unwrap());
        }
        assert!(written.contains("move 1 meters at 9.0\n  turn left 90 // far\n"), "{written}");
        assert_eq!(hints(&written, Span::of(&written), options), []);
    }
}
