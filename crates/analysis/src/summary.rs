//! Summaries of movements: the movements that they do themselves, and the time they take.

use std::sync::LazyLock;

use pydslrep_kinematics::{Drive, Model, StepKind};
use pydslrep_syntax::ast::{self, Action, ActionKind, Entity, Repeat, Rounds};
use smol_str::SmolStr;

use crate::environment::ResolvedActionKind;
use crate::plan::{default_model, step_kind};
use crate::resolve::simple_kind;

/// Robots of default size, in the order of [`Drive::ALL`]. Each action asks them, with each key.
static MODELS: LazyLock<[Option<Model>; Drive::ALL.len()]> = LazyLock::new(|| Drive::ALL.map(default_model));

/// The summary of a movement. An edit that leaves it as it was causes no new check of those that do the movement.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Summary {
    /// The movements that it does, each once, in the order of the text.
    pub(crate) does: Vec<SmolStr>,
    /// The least time it takes.
    pub(crate) time: Time,
}

/// The least time of a row of actions, with robots of default size: what the world decides, and what has a mistake, may be
/// over at once.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Time {
    /// Seconds for each type of robot, in the order of [`Drive::ALL`], without what is done.
    pub(crate) seconds: [f64; Drive::ALL.len()],
    /// The movements that are done, and how often.
    pub(crate) calls: Vec<(SmolStr, f64)>,
}

impl Summary {
    /// That of the movement that an entity is.
    pub(crate) fn of(entity: &Entity) -> Option<Self> {
        let Entity::Movement(movement) = entity else { return None };
        let mut does: Vec<SmolStr> = Vec::new();
        for name in movement.all_actions().filter_map(Action::done) {
            if !does.contains(&name.text) {
                does.push(name.text.clone());
            }
        }
        Some(Self { does, time: Time::of(&movement.actions) })
    }
}

impl Time {
    /// That of a row of actions.
    pub(crate) fn of(actions: &[Action]) -> Self {
        let mut time = Self::default();
        for action in actions {
            time.add(&Self::of_action(action), 1.0);
        }
        time
    }

    /// That of one action with all rounds of its blocks.
    pub(crate) fn of_action(action: &Action) -> Self {
        let is_time = |time: &Self| time.seconds.iter().all(|seconds| seconds.is_finite() && *seconds >= 0.0);
        // A number that is out of range is reported where it is.
        Self::known(action).filter(is_time).unwrap_or_default()
    }

    fn known(action: &Action) -> Option<Self> {
        if action.until().is_some() {
            return None;
        }
        match &action.kind {
            ActionKind::Repeat(Repeat { rounds: Some(Rounds::Times(count)), block: Some(block) }) => {
                let mut time = Self::default();
                time.add(&Self::of(&block.actions), count.value?.max(0.0));
                Some(time)
            }
            ActionKind::Do(call) => {
                let name = call.movement.as_ref()?.text.clone();
                Some(Self { seconds: Default::default(), calls: vec![(name, 1.0)] })
            }
            ActionKind::If(branches) => Some(Self::of_ways(branches)),
            ActionKind::Repeat(_) => None,
            simple => Self::driven(&simple_kind(simple, &[])?),
        }
    }

    /// The least of all ways. What is done in them may take no time.
    fn of_ways(statement: &ast::If) -> Self {
        if statement.otherwise.is_none() {
            return Self::default();
        }
        let blocks = statement.branches.iter().filter_map(|branch| branch.block.as_ref());
        let times = blocks.chain(&statement.otherwise).map(|block| Self::of(&block.actions).seconds);
        let least = times.reduce(|one, other| std::array::from_fn(|drive| one[drive].min(other[drive])));
        Self { seconds: least.unwrap_or_default(), calls: Vec::new() }
    }

    /// That of an action without blocks.
    fn driven(action: &ResolvedActionKind) -> Option<Self> {
        let StepKind::Action(drive) = step_kind(action) else { return None };
        let mut seconds = [0.0; Drive::ALL.len()];
        for (seconds, model) in seconds.iter_mut().zip(MODELS.iter()) {
            *seconds = drive.duration(model.as_ref()?)?;
        }
        Some(Self { seconds, calls: Vec::new() })
    }

    /// Adds another row of actions, so many times.
    pub(crate) fn add(&mut self, other: &Self, times: f64) {
        for (sum, more) in self.seconds.iter_mut().zip(other.seconds) {
            *sum += more * times;
        }
        for (name, count) in &other.calls {
            match self.calls.iter_mut().find(|(other, _)| other == name) {
                Some((_, sum)) => *sum += count * times,
                None => self.calls.push((name.clone(), count * times)),
            }
        }
    }
}
