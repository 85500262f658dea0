//! Progress of a run: simulated and wall time, and the current action of each robot.

use std::collections::VecDeque;
use std::ops::Range;
use std::time::Duration;

use indicatif::{MultiProgress, ProgressBar, ProgressState, ProgressStyle};

use pydslrep_analysis::environment::{ResolvedAction, ResolvedActionKind};
use pydslrep_trace::Moment;

use crate::report::numbers::fixed;
use crate::report::output;
use crate::run::planned::PlannedEnvironment;

/// At most this many robots are shown one by one.
const MAX_ROBOTS: usize = 12;

/// A bar for the time, and one per robot with its current action; drawn on standard error if that is a terminal.
pub(crate) struct Progress {
    tasks: Vec<Tasks>,
    bars: MultiProgress,
    time: ProgressBar,
    lines: Vec<ProgressBar>,
}

/// The actions a robot has left, in order.
struct Tasks {
    robot: String,
    left: VecDeque<Task>,
}

/// A statement of a listed movement, with all that is in its blocks and in the movements that it does.
struct Task {
    group: usize,
    movement: String,
    /// The numbers of the statements in it.
    numbers: Range<usize>,
    text: String,
}

impl Task {
    /// Returns whether an action that a script reports is part of it.
    fn includes(&self, moment: &Moment) -> bool {
        let number = moment.calls.first().map_or(moment.action, |call| call.action);
        self.movement == moment.movement && self.numbers.contains(&number)
    }

    /// Returns whether it ends with the first of its actions that ends.
    fn is_single(&self, moment: &Moment) -> bool {
        self.numbers.len() == 1 && moment.calls.is_empty()
    }
}

impl Progress {
    /// Shows the run of a plan; with `quiet`, nothing.
    pub(crate) fn new(planned: &PlannedEnvironment, quiet: bool) -> Self {
        let bars = MultiProgress::new();
        if quiet {
            bars.set_draw_target(indicatif::ProgressDrawTarget::hidden());
        }
        let time = bars.add(time_bar(planned.plan.duration));
        let tasks = tasks(planned);
        let line = |tasks: &Tasks| {
            let style = ProgressStyle::with_template("  {bar:10} {msg}");
            let bar = ProgressBar::new(tasks.left.len() as u64);
            bars.add(bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar())))
        };
        let lines = tasks.iter().take(MAX_ROBOTS).map(line).collect();
        let progress = Self { tasks, bars, time, lines };
        progress.show_tasks();
        progress
    }

    /// Shows the simulation time, seconds.
    pub(crate) fn pass(&self, seconds: f64) {
        self.time.set_position(milliseconds(seconds));
        self.time.tick();
    }

    /// A robot begins an action: all before that is done.
    pub(crate) fn begin_action(&mut self, moment: &Moment) {
        if let Some(tasks) = self.tasks.iter_mut().find(|tasks| tasks.robot == moment.robot)
            && let Some(place) = tasks.left.iter().position(|task| task.includes(moment))
        {
            tasks.left.drain(..place);
        }
        self.show_tasks();
    }

    /// A robot has ended an action.
    pub(crate) fn end_action(&mut self, moment: &Moment) {
        let tasks = self.tasks.iter_mut().find(|tasks| tasks.robot == moment.robot);
        if let Some(tasks) = tasks
            && tasks.left.front().is_some_and(|task| task.includes(moment) && task.is_single(moment))
        {
            tasks.left.pop_front();
        }
        self.show_tasks();
    }

    /// Prints a note above the bars.
    pub(crate) fn note(&self, text: &str) {
        self.bars.suspend(|| output::note(text));
    }

    /// Prints a warning above the bars.
    pub(crate) fn warn(&self, text: &str, help: Option<&str>) {
        self.bars.suspend(|| output::warning(text, help));
    }

    /// Removes the bars from the terminal.
    pub(crate) fn clear(&self) {
        // A terminal that cannot be cleared is no reason to fail.
        let _ = self.bars.clear();
    }

    fn show_tasks(&self) {
        let group = self.group();
        for (line, tasks) in self.lines.iter().zip(&self.tasks) {
            line.set_position(line.length().unwrap_or(0).saturating_sub(tasks.left.len() as u64));
            line.set_message(format!("{}  {}", tasks.robot, tasks.now(group)));
        }
    }

    /// The group of movements that runs now.
    fn group(&self) -> Option<usize> {
        self.tasks.iter().filter_map(|tasks| tasks.left.front()).map(|task| task.group).min()
    }
}

impl Tasks {
    fn now(&self, group: Option<usize>) -> &str {
        match self.left.front() {
            None => "done",
            Some(task) if Some(task.group) == group => &task.text,
            Some(_) => "waits for others",
        }
    }
}

fn tasks(planned: &PlannedEnvironment) -> Vec<Tasks> {
    let environment = &planned.environment;
    let mut all: Vec<Tasks> = environment
        .robots
        .iter()
        .map(|robot| Tasks { robot: robot.name.clone(), left: VecDeque::new() })
        .collect();
    for (group, runs) in environment.schedule.iter().enumerate() {
        for movement in runs.iter().filter_map(|run| environment.movements.get(*run)) {
            let after = movement.actions.iter().skip(1).map(|action| action.number).chain([usize::MAX]);
            let tasks = movement.actions.iter().zip(after).map(|(action, after)| Task {
                group,
                movement: movement.name.clone(),
                numbers: action.number..after.min(last_number(action) + 1),
                text: format!("{}: {}", movement.name, action.text),
            });
            if let Some(robot) = all.get_mut(movement.robot) {
                robot.left.extend(tasks);
            }
        }
    }
    all
}

/// The largest number of the statements in an action.
fn last_number(action: &ResolvedAction) -> usize {
    let branches = match &action.kind {
        ResolvedActionKind::If { branches, .. } => branches.last().map_or(0, |branch| branch.number),
        _ => 0,
    };
    let inside = action.kind.blocks().filter_map(|block| block.last()).map(last_number);
    inside.fold(action.number.max(branches), usize::max)
}

fn time_bar(duration: Option<f64>) -> ProgressBar {
    let seconds = |milliseconds: u64| Duration::from_millis(milliseconds).as_secs_f64();
    let (template, length) = match duration {
        Some(duration) => {
            ("{bar:32} {simulated} of {planned} s simulated in {wall} s", milliseconds(duration))
        }
        None => ("{spinner} {simulated} s simulated in {wall} s", 0),
    };
    let style = ProgressStyle::with_template(template)
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .with_key("simulated", move |state: &ProgressState, out: &mut dyn std::fmt::Write| {
            let _ = out.write_str(&fixed(seconds(state.pos()), 1));
        })
        .with_key("planned", move |state: &ProgressState, out: &mut dyn std::fmt::Write| {
            let _ = out.write_str(&fixed(seconds(state.len().unwrap_or(0)), 1));
        })
        .with_key("wall", |state: &ProgressState, out: &mut dyn std::fmt::Write| {
            let _ = out.write_str(&fixed(state.elapsed().as_secs_f64(), 1));
        });
    ProgressBar::new(length).with_style(style)
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates, and is only shown
fn milliseconds(seconds: f64) -> u64 {
    (seconds * 1000.0) as u64
}
