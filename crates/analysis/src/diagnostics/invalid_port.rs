//! `invalid-port`: a number no port has.

use pydslrep_syntax::ast::Entity;

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "invalid-port",
    severity: Severity::Error,
    summary: "a port is not between 1 and 65535",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A robot's port is not between 1 and 65535.",
    why: "The script finds the simulator on its computer by the port. Ports are numbered from 1 to 65535. CoppeliaSim \
        listens on port 23000, the older V-REP on 19999.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 70000 has { wheelL wheelR } wheels",
    fixed: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Robot(robot)) = context.tree else { return };
    if let Some(port) = robot.port.as_ref().filter(|port| port.whole && port.value.is_none()) {
        let written = context.text(port.span);
        problems.push(
            RULE.problem(port.span, format!("there is no port {written}: ports go from 1 to 65535"))
                .help("write the port of your simulator: normally CoppeliaSim has 23000 and V-REP 19999"),
        );
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    #[test]
    fn ports_have_sixteen_bits() {
        let program = |port: &str| {
            format!(
                "wheel a with radius 4\nwheel b with radius 4\nrobot r with port {port} has {{ a b }} wheels"
            )
        };
        check(
            &program("0"),
            &expect![[r#"
                error[invalid-port] 3:19 "0" there is no port 0: ports go from 1 to 65535
                  help: write the port of your simulator: normally CoppeliaSim has 23000 and V-REP 19999
            "#]],
        );
        check(
            &program("-1"),
            &expect![[r#"
                error[invalid-port] 3:19 "-1" there is no port -1: ports go from 1 to 65535
                  help: write the port of your simulator: normally CoppeliaSim has 23000 and V-REP 19999
            "#]],
        );
        check(
            &program("65536"),
            &expect![[r#"
                error[invalid-port] 3:19 "65536" there is no port 65536: ports go from 1 to 65535
                  help: write the port of your simulator: normally CoppeliaSim has 23000 and V-REP 19999
            "#]],
        );
        check(
            &program("99999999999999999999999999"),
            &expect![[r#"
                error[invalid-port] 3:19 "99999999999999999999999999" there is no port 99999999999999999999999999: ports go from 1 to 65535
                  help: write the port of your simulator: normally CoppeliaSim has 23000 and V-REP 19999
            "#]],
        );
        check_clean(&program("65535"));
    }
}
