//! `slam-sensors`: exploring takes five distance sensors.

use pydslrep_syntax::ast::{ActionKind, Entity, Robot, SensorKeyword};

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::{EntityId, Severity};

pub(super) static RULE: Rule = Rule {
    code: "slam-sensors",
    severity: Severity::Error,
    summary: "`slam` with fewer than five distance sensors",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A movement contains `slam`, but its robot has fewer than five distance sensors. A `: bumper` does not count, \
        since it detects nothing before contact.",
    why: "With `slam` a robot explores an area and maps it. To find openings and corners it has to look in several \
        directions at once, which takes five sensors.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5

sensor eye1
sensor eye2

robot rover with port 23000
  has { wheelL wheelR } wheels
  with sensors { eye1, eye2 }

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

const NEEDED: usize = 5;

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Movement(movement)) = context.tree else { return };
    let Some((id, robot)) = movement.robot.as_ref().and_then(|name| context.robot(name)) else { return };
    let (Some(name), Some(count)) = (&robot.name, distance_sensors(context, id, robot)) else { return };
    // More of them may be in what was not understood.
    if count >= NEEDED || !context.is_sound(id) {
        return;
    }
    let has = match count {
        0 => "none".to_owned(),
        count => format!("only {count}"),
    };
    let carried = robot.sensors.as_ref().map_or(0, |list| list.names.len());
    for action in context.actions().filter(|action| action.kind == ActionKind::Slam) {
        let problem = RULE
            .problem(
                action.span,
                format!("`slam` needs {NEEDED} distance sensors, and `{}` has {has}", name.text),
            )
            .related(id, name.span, format!("`{}` is declared here", name.text))
            .help("declare more sensors, and add them to the robot: `with sensors { … }`");
        problems.push(if carried > count {
            problem.note("each sensor counts once, and a `bumper` does not count")
        } else {
            problem
        });
    }
}

/// Returns the number of distance sensors of the robot; `None` where one of its sensors is not known.
fn distance_sensors(context: &Context<'_>, id: EntityId, robot: &Robot) -> Option<usize> {
    let names = robot.sensors.as_ref().map_or(&[][..], |list| &list.names);
    let mut counted: Vec<&str> = Vec::new();
    for name in names {
        let sensor = context.sensor_of(id, name)?.sensor()?;
        let sees = !matches!(sensor.kind, Some((SensorKeyword::Bumper, _)));
        if sees && !counted.contains(&name.text.as_str()) {
            counted.push(&name.text);
        }
    }
    Some(counted.len())
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    const PARTS: &str = "wheel a with radius 4\nwheel b with radius 4\nsensor s sensor t sensor u sensor v sensor w\nsensor x : bumper\n";

    #[test]
    fn what_was_not_understood_may_hold_more() {
        let mut database = crate::Database::new();
        let program = format!(
            "{PARTS}robot r with port 1 has {{ a b }} wheels sensors {{ s t u v w }}\nmovement m of r {{ slam }}"
        );
        let file = database.open("a.pyr", &program);
        let codes: Vec<_> = database.diagnostics(file).iter().map(crate::Diagnostic::code).collect();
        assert_eq!(codes, ["syntax-error"]);
    }

    #[test]
    fn sensors_are_those_of_the_robots_file() {
        let mut database = crate::Database::new();
        let robot = "import \"sensors.pyr\"\nwheel a with radius 4\nwheel b with radius 4\nrobot r with port 1 has { a b } wheels with sensors { s t u v w }";
        database.open("robot.pyr", robot);
        database.open("sensors.pyr", "sensor s sensor t sensor u sensor v sensor w");
        let bumper = "sensor s : bumper\n";
        let program = format!("import \"robot.pyr\"\n{bumper}movement m of r {{ slam }}");
        let file = database.open("a.pyr", &program);
        let codes = |database: &crate::Database| -> Vec<&str> {
            database.diagnostics(file).iter().map(crate::Diagnostic::code).collect()
        };
        assert!(!codes(&database).contains(&"slam-sensors"));
        database.open("sensors.pyr", "sensor s sensor t sensor u sensor v sensor w : bumper");
        assert!(codes(&database).contains(&"slam-sensors"));
    }

    #[test]
    fn explorers_see_in_five_directions() {
        let program = |clause: &str| {
            format!("{PARTS}robot r with port 1 has {{ a b }} wheels{clause}\nmovement m of r {{ slam }}")
        };
        check(
            &program(""),
            &expect![[r#"
                error[slam-sensors] 6:19 "slam" `slam` needs 5 distance sensors, and `r` has none
                  see 5:7 "r" `r` is declared here
                  help: declare more sensors, and add them to the robot: `with sensors { … }`
            "#]],
        );
        check(
            &program(" with sensors { s, t, u, v, x }"),
            &expect![[r#"
                error[slam-sensors] 6:19 "slam" `slam` needs 5 distance sensors, and `r` has only 4
                  see 5:7 "r" `r` is declared here
                  help: declare more sensors, and add them to the robot: `with sensors { … }`
                  note: each sensor counts once, and a `bumper` does not count
            "#]],
        );
        check_clean(&program(" with sensors { s, t, u, v, w }"));
    }
}
