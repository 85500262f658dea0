//! `slam-robot`: only two-wheeled robots can slam.

use pydslrep_syntax::ast::{ActionKind, Entity};

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "slam-robot",
    severity: Severity::Error,
    summary: "`slam` on a robot with four wheels",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A movement contains `slam`, but its robot has four wheels.",
    why: "With `slam` a robot explores an area and maps it. For the parts of the map to fit together, it has to turn \
        exactly on the spot. A robot with two wheels can do that; with four, some of the wheels always slip.",
    imports: &[],
    example: "\
wheel frontL with radius 5
wheel rearL with radius 5
wheel frontR with radius 5
wheel rearR with radius 5

sensor eye1
sensor eye2
sensor eye3
sensor eye4
sensor eye5

robot rover with port 23000
  has { frontL rearL frontR rearR } wheels
  with sensors { eye1, eye2, eye3, eye4, eye5 }

movement explore of rover { slam }

environment maze has { rover } robots with { explore } moves",
    fixed: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5

sensor eye1
sensor eye2
sensor eye3
sensor eye4
sensor eye5

robot rover with port 23000
  has { wheelL wheelR } wheels
  with sensors { eye1, eye2, eye3, eye4, eye5 }

movement explore of rover { slam }

environment maze has { rover } robots with { explore } moves",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Movement(movement)) = context.tree else { return };
    let Some((id, robot)) = movement.robot.as_ref().and_then(|name| context.robot(name)) else { return };
    let Some(drive) = context.drive(id).filter(|drive| !drive.row().explores) else { return };
    let Some(name) = &robot.name else { return };
    for action in context.actions().filter(|action| action.kind == ActionKind::Slam) {
        problems.push(
            RULE.problem(
                action.span,
                format!(
                    "only a two-wheeled robot can `slam`, and `{}` has {} wheels",
                    name.text,
                    drive.wheel_count()
                ),
            )
            .related(id, name.span, format!("`{}` is declared here", name.text))
            .help("let a robot of type `tw` explore"),
        );
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    const PARTS: &str = "wheel a with radius 4\nwheel b with radius 4\nwheel c with radius 4\nwheel d with radius 4\n\
                         sensor s sensor t sensor u sensor v sensor w\n";

    #[test]
    fn explorers_have_two_wheels() {
        let program = |wheels: &str| {
            format!(
                "{PARTS}robot r with port 1 has {{ {wheels} }} wheels with sensors {{ s, t, u, v, w }}\nmovement m of r {{ slam }}"
            )
        };
        check(
            &program("a b c d"),
            &expect![[r#"
                error[slam-robot] 7:19 "slam" only a two-wheeled robot can `slam`, and `r` has 4 wheels
                  see 6:7 "r" `r` is declared here
                  help: let a robot of type `tw` explore
            "#]],
        );
        check_clean(&program("a b"));
    }
}
