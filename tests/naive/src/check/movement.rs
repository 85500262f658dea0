//! Group "movement": the capabilities of a movement's robot.

use super::is_among;
use super::robot::{distance_sensors, has_more_than_two_wheels};
use crate::Finding;
use crate::program::{ActionKind, Body};
use crate::project::Scope;

pub(super) fn check(scope: Scope<'_>, findings: &mut Vec<Finding>) {
    for entity in &scope.program().entities {
        let Body::Movement(movement) = &entity.body else { continue };
        if movement.actions.is_empty() {
            findings.push(Finding::new("empty-movement", &movement.body));
        }
        let Some(robot) = scope.robot(&movement.robot.text) else { continue };
        for action in movement.statements() {
            for sensor in action.condition().iter().flat_map(|condition| &condition.sensors) {
                if scope.sensor(&sensor.text).is_some() && !is_among(sensor, &robot.sensors) {
                    findings.push(Finding::new("sensor-not-on-robot", &sensor.range));
                }
            }
            if matches!(action.kind, ActionKind::Slam) {
                if has_more_than_two_wheels(&robot) {
                    findings.push(Finding::new("slam-robot", &action.range));
                }
                if distance_sensors(&robot).is_some_and(|count| count < 5) {
                    findings.push(Finding::new("slam-sensors", &action.range));
                }
            }
        }
    }
}
