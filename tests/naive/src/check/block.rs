//! Blocks ("The language grows").

use crate::Finding;
use crate::program::{Action, Body};
use crate::project::Scope;

pub(super) fn check(scope: Scope<'_>, findings: &mut Vec<Finding>) {
    for entity in &scope.program().entities {
        let Body::Movement(movement) = &entity.body else { continue };
        for block in movement.statements().iter().flat_map(|action| action.blocks()) {
            if block.actions.is_empty() {
                findings.push(Finding::new("empty-block", &block.range));
            }
        }
        nested_too_deep(&movement.actions, 0, findings);
    }
}

const MAX_DEPTH: usize = 16;

/// Statements inside `depth` blocks: reported at the first word of those whose blocks are the first that are too deep. An
/// `else if` is as deep as its `if`, and no second error.
fn nested_too_deep(actions: &[Action], depth: usize, findings: &mut Vec<Finding>) {
    for action in actions {
        if depth == MAX_DEPTH && !action.blocks().is_empty() {
            findings.push(Finding::new("nested-too-deep", &action.keyword));
        }
        for part in std::iter::successors(Some(action), |action| action.else_if()) {
            for block in part.blocks() {
                nested_too_deep(&block.actions, depth + 1, findings);
            }
        }
    }
}
