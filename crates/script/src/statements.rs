//! The body of a coroutine: one line for each line of a movement.

use pydslrep_analysis::environment::{
    Branch, Condition, Environment, Movement, ResolvedAction, ResolvedActionKind, Robot, Source,
};
use pydslrep_kinematics::motion::RIM_SPEED;

use crate::identifiers::{CLEAR, DETECTS, Identifiers};
use crate::layout::Expression::{self, Atom, Call};
use crate::layout::{Words, comment_text, commented, float, literal};

/// The columns of a step of indentation.
const STEP: usize = 4;

/// Writes the actions of a movement.
pub(crate) struct Statements<'a> {
    robot: &'a Robot,
    /// The identifier of the robot in the script.
    identifier: &'a str,
    /// The identifiers of the movements in the script.
    movements: &'a [String],
}

impl<'a> Statements<'a> {
    pub(crate) fn new(environment: &'a Environment, movement: &Movement, names: &'a Identifiers) -> Self {
        Self {
            robot: &environment.robots[movement.robot],
            identifier: &names.robots[movement.robot],
            movements: &names.movements,
        }
    }

    /// The lines of some actions, so far to the right.
    pub(crate) fn of(&self, actions: &[ResolvedAction], indent: usize) -> Vec<String> {
        actions.iter().map(|action| self.statement(action, indent)).collect()
    }

    fn statement(&self, action: &ResolvedAction, indent: usize) -> String {
        let comment = comment(&action.source, &action.text);
        match &action.kind {
            ResolvedActionKind::Repeat { count, body } => {
                let head = self.clause(Words::For, "repeat", vec![Atom(count.to_string())]);
                self.block(&head, &comment, body, indent)
            }
            ResolvedActionKind::RepeatUntil { until, body } => {
                let head = self.clause(Words::AsyncFor, "repeat_until", vec![self.condition("", until)]);
                self.block(&head, &comment, body, indent)
            }
            ResolvedActionKind::If { branches, otherwise } => self.choice(branches, otherwise, indent),
            ResolvedActionKind::Do { movement } => {
                commented(indent, &Atom(format!("await {}()", self.movements[*movement])), "", &comment)
            }
            kind => {
                let (method, arguments) = self.method(kind);
                commented(indent, &self.clause(Words::Await, method, arguments), "", &comment)
            }
        }
    }

    fn choice(&self, branches: &[Branch], otherwise: &[ResolvedAction], indent: usize) -> String {
        let mut lines = Vec::with_capacity(branches.len() + 1);
        for (index, branch) in branches.iter().enumerate() {
            let (words, before) = if index == 0 { (Words::If, "") } else { (Words::Elif, "else ") };
            let head = self.clause(words, "check", vec![self.condition("", &branch.condition)]);
            let comment = comment(&branch.source, &format!("{before}{}", branch.text));
            lines.push(self.block(&head, &comment, &branch.body, indent));
        }
        if !otherwise.is_empty() {
            lines.push(format!("{:indent$}else:", ""));
            lines.extend(self.of(otherwise, indent + STEP));
        }
        lines.join("\n")
    }

    fn block(&self, head: &Expression, comment: &str, body: &[ResolvedAction], indent: usize) -> String {
        let mut lines = vec![commented(indent, head, ":", comment)];
        lines.extend(self.of(body, indent + STEP));
        if body.is_empty() {
            lines.push(format!("{:inner$}pass", "", inner = indent + STEP));
        }
        lines.join("\n")
    }

    /// A method of the robot after some words.
    fn clause(&self, words: Words, method: &str, arguments: Vec<Expression>) -> Expression {
        let call = Call { head: format!("{}.{method}", self.identifier), arguments };
        Expression::Clause { words, call: Box::new(call) }
    }

    /// The method of the robot that does an action without blocks, with its arguments.
    fn method(&self, kind: &ResolvedActionKind) -> (&'static str, Vec<Expression>) {
        match kind {
            ResolvedActionKind::Move { distance, speed, until } => {
                let distance = distance.map(|distance| Atom(float(distance)));
                let arguments = distance.into_iter().chain(speed_argument(*speed));
                ("move", arguments.chain(self.until(until.as_ref())).collect())
            }
            ResolvedActionKind::Turn { left, degrees, circle, speed, until } => {
                let angle = match degrees {
                    Some(degrees) => float(if *left { *degrees } else { -degrees }),
                    None => side(*left),
                };
                let mut arguments = vec![Atom(angle)];
                arguments.extend(circle.map(|circle| Atom(format!("radius={}", float(circle.radius)))));
                arguments.extend(speed_argument(*speed));
                let reverse = circle.is_some_and(|circle| circle.reverse);
                arguments.extend(reverse.then(|| Atom("reverse=True".to_owned())));
                arguments.extend(self.until(until.as_ref()));
                (if circle.is_some() { "arc" } else { "turn" }, arguments)
            }
            ResolvedActionKind::TurnUntil { left, sensors } => {
                let sensors = sensors.iter().map(|&sensor| Atom(literal(&self.robot.sensors[sensor].name)));
                ("turn_until_free", std::iter::once(Atom(side(*left))).chain(sensors).collect())
            }
            ResolvedActionKind::Wait { seconds, until } => {
                let seconds = seconds.map(|seconds| Atom(float(seconds)));
                ("wait", seconds.into_iter().chain(self.until(until.as_ref())).collect())
            }
            ResolvedActionKind::Slam => ("slam", Vec::new()),
            // They are written as statements of their own.
            ResolvedActionKind::Repeat { .. }
            | ResolvedActionKind::RepeatUntil { .. }
            | ResolvedActionKind::If { .. }
            | ResolvedActionKind::Do { .. } => ("", Vec::new()),
        }
    }

    fn until(&self, condition: Option<&Condition>) -> Option<Expression> {
        condition.map(|condition| self.condition("until=", condition))
    }

    fn condition(&self, before: &str, condition: &Condition) -> Expression {
        let name = if condition.detect { DETECTS } else { CLEAR };
        let sensors = condition.sensors.iter().map(|&sensor| Atom(literal(&self.robot.sensors[sensor].name)));
        let within = condition.within.map(|within| Atom(format!("within={}", float(within))));
        Call { head: format!("{before}{name}"), arguments: sensors.chain(within).collect() }
    }
}

fn side(left: bool) -> String {
    literal(if left { "left" } else { "right" })
}

/// The speed, unless it is the default; converting from cm/s may round.
fn speed_argument(speed: f64) -> Option<Expression> {
    ((speed - RIM_SPEED).abs() > 1e-12).then(|| Atom(format!("speed={}", float(speed))))
}

fn comment(source: &Source, text: &str) -> String {
    format!("{}: {}", place(source), comment_text(text))
}

/// The location in the program.
fn place(source: &Source) -> String {
    match &source.file {
        Some(file) => format!("{}, line {}", comment_text(file), source.line),
        None => format!("line {}", source.line),
    }
}
