//! Robots that a class of the user's own drives, in place of a simulator.

use std::ffi::OsString;

use pydslrep_analysis::environment::{Environment, Robot};

use crate::failure::Failure;
use crate::options::check_robots;

/// The value of `--robot`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct OwnRobot {
    /// `None` for all robots.
    robot: Option<String>,
    /// As Python names it: `MODULE:CLASS`.
    class: String,
}

impl OwnRobot {
    /// Parses `[ROBOT=]MODULE:CLASS`.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let (robot, class) =
            text.rsplit_once('=').map_or((None, text), |(robot, class)| (Some(robot), class));
        match class.split_once(':') {
            Some((module, name)) if !module.is_empty() && !name.is_empty() => {
                Ok(Self { robot: robot.map(str::to_owned), class: class.to_owned() })
            }
            _ => {
                Err("expected a class in a module, such as my_robot:Rover or scout=my_robot:Rover".to_owned())
            }
        }
    }

    fn drives(&self, robot: &Robot) -> bool {
        self.robot.as_ref().is_none_or(|name| *name == robot.name)
    }

    fn argument(&self) -> OsString {
        self.robot
            .as_ref()
            .map_or_else(|| self.class.clone(), |robot| format!("{robot}={}", self.class))
            .into()
    }
}

/// The indices of the robots that are left to a simulator.
///
/// # Errors
/// If a robot is named that the environment does not have.
pub(crate) fn simulated(own: &[OwnRobot], environment: &Environment) -> Result<Vec<usize>, Failure> {
    let robots = &environment.robots;
    check_robots(own.iter().filter_map(|choice| choice.robot.as_deref()), environment)?;
    let is_simulated = |index: &usize| !own.iter().any(|choice| choice.drives(&robots[*index]));
    Ok((0..robots.len()).filter(is_simulated).collect())
}

/// The script's arguments for them.
pub(crate) fn arguments(own: &[OwnRobot]) -> impl Iterator<Item = OsString> {
    own.iter().flat_map(|choice| ["--robot".into(), choice.argument()])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_are_for_one_robot_or_for_all() {
        let parsed = |text: &str| OwnRobot::parse(text).map(|own| (own.robot, own.class));
        assert_eq!(parsed("my_robot:Rover"), Ok((None, "my_robot:Rover".to_owned())));
        assert_eq!(parsed("a=b.c:D"), Ok((Some("a".to_owned()), "b.c:D".to_owned())));
        for wrong in ["my_robot", "my_robot:", ":Rover", "a=", ""] {
            assert!(parsed(wrong).unwrap_err().contains("my_robot:Rover"), "{wrong}");
        }
    }
}
