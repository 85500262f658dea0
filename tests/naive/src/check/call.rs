//! `do` ("The language grows").

use crate::Finding;
use crate::program::{Body, Entity, Movement};
use crate::project::{Declared, Scope};

pub(super) fn check(scope: Scope<'_>, findings: &mut Vec<Finding>) {
    for entity in &scope.program().entities {
        let Body::Movement(movement) = &entity.body else { continue };
        let robot = scope.robot(&movement.robot.text);
        for name in movement.done() {
            let Some(done) = scope.movement(&name.text) else { continue };
            let robots = robot.as_ref().zip(done.home.robot(&done.robot.text));
            if robots.is_some_and(|(own, other)| !own.is(&other)) {
                findings.push(Finding::new("movement-of-other-robot", &name.range));
            }
            if leads_to(done, entity) {
                findings.push(Finding::new("recursive-movement", &name.range));
            }
        }
    }
}

/// Whether a movement is this entity, or does one that leads to it.
fn leads_to(movement: Declared<'_, Movement>, entity: &Entity) -> bool {
    let mut reached = vec![movement];
    let mut next = 0;
    while next < reached.len() {
        let movement = &reached[next];
        let done: Vec<_> =
            movement.done().iter().filter_map(|name| movement.home.movement(&name.text)).collect();
        for other in done {
            if !reached.iter().any(|known| known.is(&other)) {
                reached.push(other);
            }
        }
        next += 1;
    }
    reached.iter().any(|movement| movement.is_entity(entity))
}
