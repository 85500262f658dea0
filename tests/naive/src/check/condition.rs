//! Conditions ("The language grows").

use crate::Finding;
use crate::program::{Action, ActionKind, Body, Condition};
use crate::project::Scope;

pub(super) fn check(scope: Scope<'_>, findings: &mut Vec<Finding>) {
    for entity in &scope.program().entities {
        let Body::Movement(movement) = &entity.body else { continue };
        for action in movement.statements() {
            let Some(condition) = action.condition() else { continue };
            if condition.word.is_none() && !may_lack_word(action, condition) {
                findings.push(Finding::new("missing-condition-word", &condition.list));
            }
            findings.extend(within_of_bumpers(scope, condition));
        }
    }
}

/// Only the exact form of the article: `turn SIDE until {…}`.
pub(super) fn may_lack_word(action: &Action, condition: &Condition) -> bool {
    matches!(&action.kind, ActionKind::Turn(turn) if turn.is_until_free()) && condition.within.is_none()
}

/// Bumpers measure no distance. A distance that is wrong by itself is one error only.
fn within_of_bumpers(scope: Scope<'_>, condition: &Condition) -> Option<Finding> {
    let within = &condition.within.as_ref()?.value;
    let is_distance = within.value() > 0.0 && within.value() <= super::value::MAX_DISTANCE;
    let is_bumper =
        |name: &crate::program::Name| scope.sensor(&name.text).is_some_and(|sensor| sensor.bumper);
    let only_bumpers = condition.sensors.iter().all(is_bumper);
    (is_distance && only_bumpers).then(|| Finding::new("invalid-within", &within.number.range))
}
