//! An action: how long it takes, where it leads, and what its rounds, its circle or the movement that it does come to.

use pydslrep_analysis::environment::{Movement, ResolvedAction, ResolvedActionKind, Robot};
use pydslrep_analysis::{Database, Driver, EntityId};
use pydslrep_kinematics::{Leg, Pose};

use super::arc::Arc;
use super::format::{number, pose, time};
use super::motion::facts;
use super::way::Way;
use super::within::Within;

/// The statement with a number, which is the action with an index or in its blocks, of a movement that starts at the
/// origin.
pub(super) fn action(database: &Database, id: EntityId, index: usize, number: usize) -> Option<String> {
    let (robot, movements) = database.movement_start(id, index + 1)?;
    let (movement, done) = movements.split_last()?;
    let driver = Driver::new(&robot).ok()?.with_done(done);
    let start = Ok(Pose::default());
    let statement = find(&driver, &movement.actions, number, start, Within::default())?;
    let text = &statement.action.text;
    let details = Details { robot: &robot, done, driver: &driver }.describe(&statement);
    Some(format!("```pydslrep\n{text}\n```\n{details}"))
}

/// An action in its place.
struct Statement<'a> {
    action: &'a ResolvedAction,
    /// Its start pose; the action that makes it unknown.
    start: Result<Pose, &'a ResolvedAction>,
    within: Within,
}

/// The statement with a number among some actions and those in their blocks, of which the first starts at a pose.
fn find<'a>(
    driver: &Driver,
    actions: &'a [ResolvedAction],
    number: usize,
    mut start: Result<Pose, &'a ResolvedAction>,
    within: Within,
) -> Option<Statement<'a>> {
    let begun = actions.partition_point(|action| action.number <= number).checked_sub(1)?;
    for action in actions.get(..begun)? {
        let end = |pose| driver.drive(pose, &action.kind).map(|leg| leg.to);
        start = start.and_then(|pose| end(pose).ok_or_else(|| cause(driver, action)));
    }
    let action = actions.get(begun)?;
    if action.number == number {
        return Some(Statement { action, start, within });
    }
    let within = match action.kind {
        ResolvedActionKind::Repeat { .. } => within.rounds(),
        ResolvedActionKind::RepeatUntil { .. } => within.rounds().condition(),
        _ => within.condition(),
    };
    action.kind.blocks().find_map(|block| find(driver, block, number, start, within))
}

/// Returns the action that makes the end of an action unknown: in rounds, the first such action.
fn cause<'a>(driver: &Driver, action: &'a ResolvedAction) -> &'a ResolvedAction {
    let ResolvedActionKind::Repeat { body, .. } = &action.kind else { return action };
    let inner = body.iter().find(|inner| driver.drive(Pose::default(), &inner.kind).is_none());
    inner.map_or(action, |inner| cause(driver, inner))
}

struct Details<'a> {
    robot: &'a Robot,
    /// The movements that may be done, each after those that it does.
    done: &'a [Movement],
    driver: &'a Driver,
}

impl Details<'_> {
    fn describe(&self, statement: &Statement<'_>) -> String {
        let &Statement { action, start, within } = statement;
        let leg = self.driver.drive(start.unwrap_or_default(), &action.kind);
        let unknown_start =
            |cause: &ResolvedAction| format!("The start pose cannot be planned: {}.", open_end(cause));
        let poses = match (&leg, start) {
            (Some(leg), Ok(_)) => format!("{} {}", within.opening(), way_of(leg)),
            (None, Ok(_)) => format!("The end pose cannot be planned: {}.", open_end(action)),
            (_, Err(cause)) => unknown_start(cause),
        };
        let more = self.more(action, leg.as_ref(), start.ok());
        let text = match &leg {
            Some(leg) if more.is_none() => describe_leg(self.robot, leg, &poses),
            Some(leg) => format!("Takes {}. {poses}", time(leg.duration)),
            None => poses,
        };
        more.map_or_else(|| text.clone(), |more| format!("{text}\n\n{more}"))
    }

    /// Returns the details that only some kinds of actions have.
    fn more(&self, action: &ResolvedAction, leg: Option<&Leg>, start: Option<Pose>) -> Option<String> {
        match &action.kind {
            ResolvedActionKind::Repeat { count, body } => Some(self.rounds(*count, body)),
            ResolvedActionKind::RepeatUntil { body, .. } => {
                let times =
                    self.time_of(body).map_or_else(String::new, |seconds| format!(" in {}", time(seconds)));
                Some(format!("A round drives {}{times}.", self.way_of(body)))
            }
            ResolvedActionKind::Do { movement } => {
                let done = self.done.get(..=*movement)?;
                Some(format!("`{}` {}", done.last()?.name, facts(self.robot, done)?))
            }
            ResolvedActionKind::Turn { circle: Some(_), .. } => {
                Some(Arc::new(self.robot, self.driver.model(), &action.kind)?.describe(leg, start))
            }
            _ => None,
        }
    }

    /// Describes the rounds of a block and their total.
    fn rounds(&self, count: u32, body: &[ResolvedAction]) -> String {
        let way = self.way_of(body);
        let all = Way::default().and(way, f64::from(count));
        match self.time_of(body) {
            Some(seconds) => format!(
                "{count} rounds, each of which drives {way} in {}: together {all} in {}.",
                time(seconds),
                time(seconds * f64::from(count))
            ),
            None => format!("{count} rounds, each of which drives {way}, what sensors decide not counted."),
        }
    }

    fn way_of(&self, body: &[ResolvedAction]) -> Way {
        Way::of(body, &Way::of_movements(self.done))
    }

    /// Seconds, if they are known.
    fn time_of(&self, body: &[ResolvedAction]) -> Option<f64> {
        let round = ResolvedActionKind::Repeat { count: 1, body: body.to_vec() };
        self.driver.drive(Pose::default(), &round).map(|leg| leg.duration)
    }
}

/// The details of a leg; `poses` describes its poses.
pub(crate) fn describe_leg(robot: &Robot, leg: &Leg, poses: &str) -> String {
    let rates: Vec<String> = robot
        .wheels
        .iter()
        .zip(&leg.rates)
        .map(|(wheel, rate)| format!("`{}` {} rad/s", wheel.name, number(*rate, 2)))
        .collect();
    let rates =
        if rates.is_empty() { String::new() } else { format!("\n\nWheel rates: {}.", rates.join(", ")) };
    format!("Takes {}. {poses}{rates}", time(leg.duration))
}

/// The poses at the start and end of a leg, after *from*.
pub(crate) fn way_of(leg: &Leg) -> String {
    format!("{} to {}, relative to the start of the movement.", pose(&leg.from), pose(&leg.to))
}

pub(super) fn open_end(action: &ResolvedAction) -> String {
    open_end_reason(&action.kind, &action.text)
}

/// Why the end of an action depends on the world.
pub(crate) fn open_end_reason(kind: &ResolvedActionKind, text: &str) -> String {
    match kind {
        ResolvedActionKind::Slam => "the path of `slam` depends on what it explores".to_owned(),
        ResolvedActionKind::TurnUntil { .. } => format!("`{text}` ends when the way is clear"),
        ResolvedActionKind::If { .. } => format!("what `{text}` does depends on its sensors"),
        _ if kind.conditions().next().is_some() => format!("`{text}` ends when its condition holds"),
        _ => format!("what `{text}` does depends on what sensors detect"),
    }
}
