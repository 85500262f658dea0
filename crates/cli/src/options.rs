//! Options that several commands have.

use clap::ValueEnum;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use pydslrep_analysis::environment::{Environment, Robot};
use pydslrep_config::{Level, Severities, Target, find_rule};
pub(crate) use pydslrep_server::edition_parser;
use pydslrep_simulator::Server;

use crate::failure::Failure;

/// Parses a simulator by its name in settings.
pub(crate) fn target_parser() -> impl TypedValueParser<Value = Target> {
    let word = |target: Target| PossibleValue::new(target.word()).help(target.summary());
    PossibleValuesParser::new(Target::ALL.map(word))
        .try_map(|word| Target::from_word(&word).ok_or("no target"))
}

/// The engine that moves the robots.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Engine {
    /// Robots move exactly as their wheels roll
    Embedded,
    /// Wheels roll by friction, bodies collide: the physics engine MuJoCo
    #[value(name = "mujoco")]
    MuJoCo,
}

/// Parses a server to imitate by its name.
pub(crate) fn server_parser() -> impl TypedValueParser<Value = Server> {
    let word = |server: Server| PossibleValue::new(server.word()).help(server.summary());
    PossibleValuesParser::new(Server::ALL.map(word))
        .try_map(|word| Server::from_word(&word).ok_or("no server"))
}

/// Parses a number above zero.
pub(crate) fn above_zero(text: &str) -> Result<f64, String> {
    let speed = text.parse().ok().filter(|speed: &f64| speed.is_finite() && *speed > 0.0);
    speed.ok_or_else(|| "expected a number above zero, such as 1 or 2.5".to_owned())
}

/// The value of `--port`: a port, for one robot or for all.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Port {
    robot: Option<String>,
    number: u16,
}

impl Port {
    /// Parses `[ROBOT=]PORT`.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let (robot, number) =
            text.rsplit_once('=').map_or((None, text), |(robot, number)| (Some(robot.to_owned()), number));
        let number = number.parse().ok().filter(|number| *number > 0);
        number
            .map(|number| Self { robot, number })
            .ok_or_else(|| "expected a port from 1 to 65535".to_owned())
    }

    /// The port of each robot of an environment; a choice for one robot comes before one for all.
    ///
    /// # Errors
    /// If a robot is named that the environment does not have.
    pub(crate) fn of_robots(choices: &[Self], environment: &Environment) -> Result<Vec<u16>, Failure> {
        let robots = &environment.robots;
        check_robots(choices.iter().filter_map(|choice| choice.robot.as_deref()), environment)?;
        let chosen = |robot: Option<&str>| {
            choices.iter().rev().find(|choice| choice.robot.as_deref() == robot).map(|choice| choice.number)
        };
        let port = |robot: &Robot| chosen(Some(&robot.name)).or(chosen(None)).unwrap_or(robot.port);
        Ok(robots.iter().map(port).collect())
    }
}

/// Checks the names of robots in options.
///
/// # Errors
/// If a robot is named that the environment does not have.
pub(crate) fn check_robots<'a>(
    mut named: impl Iterator<Item = &'a str>,
    environment: &Environment,
) -> Result<(), Failure> {
    let robots = &environment.robots;
    let Some(unknown) = named.find(|name| robots.iter().all(|robot| robot.name != *name)) else {
        return Ok(());
    };
    let names: Vec<String> = robots.iter().map(|robot| format!("`{}`", robot.name)).collect();
    Err(Failure::new(format!("there is no robot `{unknown}` in `{}`", environment.name))
        .help(format!("its robots: {}", names.join(", "))))
}

/// Parses `CODE=LEVEL` options; the last one for a code wins.
///
/// # Errors
/// If there is no such code or level.
pub(crate) fn severities(choices: &[String]) -> Result<Severities, Failure> {
    let mut severities = Severities::default();
    for choice in choices {
        let (code, level) = choice.split_once('=').ok_or_else(|| {
            Failure::new(format!("`--severity {choice}` has no level"))
                .help(format!("write the code, `=` and a level: `--severity {choice}=off`"))
        })?;
        severities.set(find_rule(code)?.code, Level::from_word(level)?);
    }
    Ok(severities)
}
