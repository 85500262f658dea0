//! `duplicate-port`: two robots of an environment share a port, and the target serves one robot on each.

use pydslrep_syntax::ast::{Entity, Name, Robot};

use super::context::Context;
use super::edits::ProblemEdit;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::{EntityId, Severity, Target};

pub(super) static RULE: Rule = Rule {
    code: "duplicate-port",
    severity: Severity::Warning,
    summary: "two robots of an environment share a port, and the target is `vrep`",
    tag: None,
    applicability: Applicability::Safe,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "Two robots of one environment have the same port, and the scripts are made for V-REP.",
    why: "V-REP's remote API serves one connection per port, so the second robot could not connect. (CoppeliaSim \
        serves all robots on one port, so this is no problem with that target.)",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 20000 has { wheelL wheelR } wheels
robot scout with port 20000 has { wheelL wheelR } wheels

movement trip of rover { move 1 meters }
movement walk of scout { move 1 meters }

environment yard has { rover scout } robots with { trip walk } moves",
    fixed: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 20000 has { wheelL wheelR } wheels
robot scout with port 20001 has { wheelL wheelR } wheels

movement trip of rover { move 1 meters }
movement walk of scout { move 1 meters }

environment yard has { rover scout } robots with { trip walk } moves",
};

/// A robot of the environment, with its port.
struct Listed<'a> {
    reference: &'a Name,
    id: EntityId,
    robot: &'a Robot,
    port: u16,
}

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Environment(environment)) = context.tree else { return };
    if context.target() != Target::VRep {
        return;
    }
    let names = environment.robots.iter().flat_map(|list| &list.names);
    let mut robots: Vec<Listed<'_>> = Vec::new();
    for listed in names.filter_map(|name| listed(context, name)) {
        // A robot that is listed twice is another problem.
        if robots.iter().all(|other| other.id != listed.id) {
            robots.push(listed);
        }
    }
    for (index, robot) in robots.iter().enumerate() {
        if let Some(first) = robots[..index].iter().find(|other| other.port == robot.port) {
            problems.push(problem(context, &robots, first, robot));
        }
    }
}

fn listed<'a>(context: &Context<'a>, reference: &'a Name) -> Option<Listed<'a>> {
    let (id, robot) = context.robot(reference)?;
    let port = robot.port.as_ref()?.value.filter(|port| *port > 0)?;
    Some(Listed { reference, id, robot, port })
}

fn problem(context: &Context<'_>, robots: &[Listed<'_>], first: &Listed<'_>, second: &Listed<'_>) -> Problem {
    let [one, two] = [first, second].map(|robot| &robot.reference.text);
    let mut problem = RULE.problem(
        second.reference.span,
        format!("`{two}` has port {} like `{one}`, and V-REP serves one robot on each", second.port),
    );
    for robot in [first, second] {
        if let Some(port) = &robot.robot.port {
            problem = problem.related(robot.id, port.span, format!("the port of `{}`", robot.reference.text));
        }
    }
    // Whichever environment complains, the same robot keeps its port: else two of them could go on for ever.
    let later = if context.is_before(first.id, second.id) { second } else { first };
    match (free_port(robots, later.port), &later.robot.port) {
        (Some(free), Some(port)) => {
            let edit = ProblemEdit::new(later.id, port.span, free.to_string());
            let name = context.name_of(later.id);
            let name = name.map_or("", |name| name.text.as_str());
            problem.fix(format!("give `{name}` port {free}"), [edit])
        }
        _ => problem.help("give each robot a port of its own"),
    }
}

/// The next port that no robot of the environment has.
fn free_port(robots: &[Listed<'_>], taken: u16) -> Option<u16> {
    let is_free = |port: &u16| robots.iter().all(|robot| robot.port != *port);
    (taken..=u16::MAX).find(is_free)
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use crate::diagnostics::testing::apply;
    use crate::{Database, Target};

    const WHEELS: &str = "wheel a with radius 4\nwheel b with radius 4\n";

    fn robots(ports: &[(&str, &str)]) -> String {
        let robot =
            |(name, port): &(&str, &str)| format!("robot {name} with port {port} has {{ a b }} wheels\n");
        WHEELS.to_owned() + &ports.iter().map(robot).collect::<String>()
    }

    /// Checks the messages, and the lines that each fix changes.
    fn check(target: Target, program: &str, expected: &Expect) {
        let mut database = Database::new();
        let file = database.open("test.pyr", program);
        database.set_target(file, target);
        let mut out = String::new();
        for found in database.diagnostics(file).iter().filter(|found| found.code() == "duplicate-port") {
            out += &format!("{} @ {}: {}\n", found.span.text(program), found.span.start, found.message);
            out += found.help.as_ref().map_or("", |help| help.as_str());
            for fix in &found.fixes {
                let fixed = apply(program, file, &fix.edits);
                let changed = fixed.lines().filter(|line| !program.lines().any(|old| old == *line));
                out += &format!("  {}: {}\n", fix.title, changed.collect::<Vec<_>>().join(" / "));
            }
        }
        expected.assert_eq(&out);
    }

    #[test]
    fn each_robot_of_an_environment_needs_its_port() {
        let program = robots(&[("r", "9"), ("q", "10"), ("p", "9")]);
        let together = format!("{program}environment e has {{ r q p }} robots");
        check(
            Target::VRep,
            &together,
            &expect![[r#"
            p @ 186: `p` has port 9 like `r`, and V-REP serves one robot on each
              give `p` port 11: robot p with port 11 has { a b } wheels
        "#]],
        );
        check(Target::CoppeliaSim, &together, &expect![[""]]);
        let apart = format!("{program}environment e has {{ r q }} robots\nenvironment f has {{ p }} robots");
        check(Target::VRep, &apart, &expect![[""]]);
    }

    #[test]
    fn the_robot_declared_first_keeps_its_port() {
        let program = robots(&[("r", "9"), ("q", "9")]) + "environment e has { q r r } robots";
        check(
            Target::VRep,
            &program,
            &expect![[r#"
            r @ 144: `r` has port 9 like `q`, and V-REP serves one robot on each
              give `q` port 10: robot q with port 10 has { a b } wheels
        "#]],
        );
    }

    #[test]
    fn ports_that_are_none_are_another_problem() {
        let program = robots(&[("r", "0"), ("q", "0")]) + "environment e has { q r } robots";
        check(Target::VRep, &program, &expect![[""]]);
    }

    #[test]
    fn the_last_port_has_no_next_one() {
        let program = robots(&[("r", "65535"), ("q", "65535")]) + "environment e has { r q } robots";
        check(
            Target::VRep,
            &program,
            &expect![[r#"
            q @ 152: `q` has port 65535 like `r`, and V-REP serves one robot on each
            give each robot a port of its own"#]],
        );
    }
}
