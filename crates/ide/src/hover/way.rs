//! The distances and angles that actions drive.

use std::fmt;

use pydslrep_analysis::environment::{Movement, ResolvedAction, ResolvedActionKind};

use super::format::number;

/// The distance and the angle that a movement drives, in metres and degrees, without parts that only the world decides.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Way {
    length: f64,
    turning: f64,
}

impl fmt::Display for Way {
    /// As in `2 m and turns 90°`, after *drives*.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} m and turns {}°", number(self.length, 3), number(self.turning, 1))
    }
}

impl Way {
    /// Those of some movements, each of which may do the ones before it.
    pub(super) fn of_movements(movements: &[Movement]) -> Vec<Self> {
        let mut ways: Vec<Self> = Vec::with_capacity(movements.len());
        for movement in movements {
            let way = Self::of(&movement.actions, &ways);
            ways.push(way);
        }
        ways
    }

    /// That of some actions; `done` has those of the movements that they do.
    pub(super) fn of(actions: &[ResolvedAction], done: &[Self]) -> Self {
        actions.iter().fold(Self::default(), |sum, action| sum.and(Self::of_action(&action.kind, done), 1.0))
    }

    fn of_action(kind: &ResolvedActionKind, done: &[Self]) -> Self {
        match kind {
            ResolvedActionKind::Move { distance: Some(distance), until: None, .. } => {
                Self { length: distance.abs(), turning: 0.0 }
            }
            ResolvedActionKind::Turn { degrees: Some(degrees), circle, until: None, .. } => Self {
                length: circle.map_or(0.0, |circle| circle.radius * degrees.abs().to_radians()),
                turning: degrees.abs(),
            },
            ResolvedActionKind::Repeat { count, body } => {
                Self::default().and(Self::of(body, done), f64::from(*count))
            }
            ResolvedActionKind::Do { movement } => done.get(*movement).copied().unwrap_or_default(),
            _ => Self::default(),
        }
    }

    /// Both, the other one so many times.
    pub(super) fn and(self, other: Self, times: f64) -> Self {
        Self { length: self.length + other.length * times, turning: self.turning + other.turning * times }
    }
}
