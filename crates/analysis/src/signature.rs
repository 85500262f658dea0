//! Signatures of entities: what others may read of them.

use pydslrep_syntax::ast::{Entity, Environment, Name, Robot, Sensor, Wheel};
use pydslrep_syntax::{Parse, Span};

/// The part of an entity that others may rely on. An edit that leaves it as it was invalidates nobody else's problems;
/// so a rule sees no more than this of another entity.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Signature<'a> {
    /// A movement without its actions, which are its own.
    Movement(MovementSignature<'a>),
    /// Positions count, because others point at them.
    Whole(&'a Parse),
}

/// The part of a movement that others may rely on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MovementSignature<'a> {
    pub(crate) parallel: Option<Span>,
    pub(crate) name: Option<&'a Name>,
    pub(crate) robot: Option<&'a Name>,
}

impl PartialEq for Signature<'_> {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Movement(one), Self::Movement(other)) => one == other,
            (Self::Whole(one), Self::Whole(other)) => {
                one.entity == other.entity
                    && one.tokens == other.tokens
                    && one.errors.is_empty() == other.errors.is_empty()
            }
            _ => false,
        }
    }
}

impl<'a> Signature<'a> {
    pub(crate) fn of(parse: &'a Parse) -> Self {
        match &parse.entity {
            Some(Entity::Movement(movement)) => Self::Movement(MovementSignature {
                parallel: movement.parallel,
                name: movement.name.as_ref(),
                robot: movement.robot.as_ref(),
            }),
            _ => Self::Whole(parse),
        }
    }

    /// The name that it declares.
    pub(crate) fn name(self) -> Option<&'a Name> {
        match self {
            Self::Movement(movement) => movement.name,
            Self::Whole(parse) => parse.entity.as_ref()?.name(),
        }
    }

    pub(crate) fn wheel(self) -> Option<&'a Wheel> {
        let Entity::Wheel(wheel) = self.entity()? else { return None };
        Some(wheel)
    }

    pub(crate) fn sensor(self) -> Option<&'a Sensor> {
        let Entity::Sensor(sensor) = self.entity()? else { return None };
        Some(sensor)
    }

    pub(crate) fn robot(self) -> Option<&'a Robot> {
        let Entity::Robot(robot) = self.entity()? else { return None };
        Some(robot)
    }

    pub(crate) fn environment(self) -> Option<&'a Environment> {
        let Entity::Environment(environment) = self.entity()? else { return None };
        Some(environment)
    }

    pub(crate) fn movement(self) -> Option<MovementSignature<'a>> {
        let Self::Movement(movement) = self else { return None };
        Some(movement)
    }

    fn entity(self) -> Option<&'a Entity> {
        let Self::Whole(parse) = self else { return None };
        parse.entity.as_ref()
    }

    /// Returns whether it was read without a syntax error, so that something may be concluded from what it lacks.
    /// Always false for a movement, whose errors others cannot see.
    pub(crate) fn is_sound(self) -> bool {
        matches!(self, Self::Whole(parse) if parse.errors.is_empty())
    }

    /// The end of its last word.
    pub(crate) fn end(self) -> Option<u32> {
        let Self::Whole(parse) = self else { return None };
        parse.tokens.iter().rev().find(|(kind, _)| !kind.is_comment()).map(|(_, span)| span.end)
    }
}
