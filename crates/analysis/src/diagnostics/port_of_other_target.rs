//! `port-of-other-target`: a port of V-REP's in a program whose scripts are made for `CoppeliaSim`.

use std::ops::RangeInclusive;

use pydslrep_syntax::ast::Entity;

use super::context::Context;
use super::example::trip;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::{Severity, Target};

pub(super) static RULE: Rule = Rule {
    code: "port-of-other-target",
    severity: Severity::Hint,
    summary: "a robot has a port of V-REP's, and the target is `coppeliasim`",
    tag: None,
    applicability: Applicability::Suggested,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A robot's port is 19997, 19998 or 19999, and the scripts are made for CoppeliaSim.",
    why: "These are the ports of the older V-REP. CoppeliaSim's ZeroMQ remote API listens on 23000 and serves all \
        robots there, so a script that connects to 19999 usually gets no answer. (`pydslrep run` starts its own \
        simulator on whatever port the program has.) If the scripts are for V-REP, set it in pydslrep.toml: \
        `target = \"vrep\"`.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 19999 has { wheelL wheelR } wheels

movement trip of rover { move 1 meters }

environment yard has { rover } robots with { trip } moves",
    fixed: trip!("{ move 1 meters }"),
};

/// 19997 is in V-REP's own configuration, and programs count up from there to the 19999 of its examples.
const OF_VREP: RangeInclusive<u16> = 19997..=Target::VRep.default_port();

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Robot(robot)) = context.tree else { return };
    if context.target() != Target::CoppeliaSim {
        return;
    }
    let Some(port) = &robot.port else { return };
    let Some(number) = port.value.filter(|number| OF_VREP.contains(number)) else { return };
    let usual = Target::CoppeliaSim.default_port();
    problems.push(
        RULE.problem(port.span, format!("{number} is a port of V-REP's; CoppeliaSim listens on {usual}"))
            .help("change the port, or set `target = \"vrep\"` in pydslrep.toml")
            .suggestion(
                format!("change the port to {usual}"),
                [context.replace(port.span, usual.to_string())],
            ),
    );
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};
    use crate::{Database, Diagnostic, Target};

    fn robots(ports: &[&str]) -> String {
        let robot =
            |(index, port): (usize, &&str)| format!("robot r{index} with port {port} has {{ a b }} wheels\n");
        let wheels = "wheel a with radius 4\nwheel b with radius 4\n";
        wheels.to_owned() + &ports.iter().enumerate().map(robot).collect::<String>()
    }

    #[test]
    fn the_ports_of_vrep_are_not_those_of_coppeliasim() {
        check(
            &robots(&["19999", "019997"]),
            &expect![[r#"
            hint[port-of-other-target] 3:20 "19999" 19999 is a port of V-REP's; CoppeliaSim listens on 23000
              help: change the port, or set `target = "vrep"` in pydslrep.toml
              suggestion: change the port to 23000 -> robot r0 with port 23000 has { a b } wheels
            hint[port-of-other-target] 4:20 "019997" 19997 is a port of V-REP's; CoppeliaSim listens on 23000
              help: change the port, or set `target = "vrep"` in pydslrep.toml
              suggestion: change the port to 23000 -> robot r1 with port 23000 has { a b } wheels
        "#]],
        );
        check_clean(&robots(&["19996", "20000", "23000"]));
    }

    #[test]
    fn for_vrep_it_is_the_right_port() {
        let mut database = Database::new();
        let file = database.open("test.pyr", &robots(&["19999"]));
        let codes = |database: &Database| -> Vec<&'static str> {
            database.diagnostics(file).iter().map(Diagnostic::code).collect()
        };
        assert_eq!(codes(&database), ["port-of-other-target"]);
        database.set_target(file, Target::VRep);
        assert!(codes(&database).is_empty());
        database.set_target(file, Target::CoppeliaSim);
        assert_eq!(codes(&database), ["port-of-other-target"]);
    }
}
