//! `script-name`: an environment's script cannot be called like the environment.

use pydslrep_syntax::ast::{Entity, Name};

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::facts::script_name::{Obstacle, obstacle};
use crate::{EntityId, Severity};

pub(super) static RULE: Rule = Rule {
    code: "script-name",
    severity: Severity::Warning,
    summary: "an environment whose script cannot have the same name",
    tag: None,
    applicability: Applicability::Suggested,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "The script of an environment is named after it: `yard` becomes `yard.py`. This name cannot be used: it \
        belongs to a module of Python or to one that scripts need, Python runs a file of that name when it starts, \
        Windows has no files of that name, or another environment's name differs only in case. The script's name then gets the suffix `_env`.",
    why: "When a script runs `import math`, Python looks for `math.py` next to the script first. A script of that name \
        would import itself and stop. And where a computer treats `yard.py` and `Yard.py` as the same file, one \
        script would overwrite the other. With `_env` everything works, but you might look for the script under the \
        wrong name.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels

movement trip of rover { move 1 meters }

environment math has { rover } robots with { trip } moves",
    fixed: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels

movement trip of rover { move 1 meters }

environment math_room has { rover } robots with { trip } moves",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Environment(environment)) = context.tree else { return };
    let Some(name) = &environment.name else { return };
    if obstacle(&name.text).is_none() && !context.has_twin(name) {
        return;
    }
    let Some((script, other)) = context.script_name(name) else { return };
    let Some(obstacle) = script.obstacle else { return };
    problems.push(problem(context, name, &script.stem, obstacle, other));
}

fn problem(
    context: &Context<'_>,
    name: &Name,
    stem: &str,
    obstacle: Obstacle,
    other: Option<EntityId>,
) -> Problem {
    let text = &name.text;
    let other = other.and_then(|id| Some((id, context.name_of(id)?)));
    let why = match obstacle {
        Obstacle::StandardModule => format!("a script `{text}.py` would hide Python's own module `{text}`"),
        Obstacle::ClientModule => {
            format!("a script `{text}.py` would hide the module `{text}`, which scripts need")
        }
        Obstacle::StartModule => format!("Python would run a script `{text}.py` whenever it starts"),
        Obstacle::ReservedOnWindows => format!("Windows has no files called `{text}.py`"),
        Obstacle::SameButForCase(_) => {
            let other = other.map_or("", |(_, other)| other.text.as_str());
            format!("some computers take `{text}.py` and `{other}.py` for the same file")
        }
    };
    let problem = RULE
        .problem(name.span, format!("{why}, so the script is called `{stem}.py`"))
        .help("give the environment another name")
        .suggestion(format!("rename the environment to `{stem}`"), [context.replace(name.span, stem)]);
    match other {
        Some((id, other)) => {
            problem.related(id, other.span, format!("this script is called `{}.py`", other.text))
        }
        None => problem,
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::Database;
    use crate::diagnostics::testing::{check, check_clean};

    const PARTS: &str =
        "wheel a with radius 4\nwheel b with radius 4\nrobot r with port 1 has { a b } wheels\n";

    fn program(environments: &[&str]) -> String {
        let environment = |name: &&str| format!("environment {name} has {{ r }} robots\n");
        format!("{PARTS}{}", environments.iter().map(environment).collect::<String>())
    }

    #[test]
    fn a_script_hides_nothing_and_overwrites_nothing() {
        check(
            &program(&["math"]),
            &expect![[r#"
            warning[script-name] 4:13 "math" a script `math.py` would hide Python's own module `math`, so the script is called `math_env.py`
              help: give the environment another name
              suggestion: rename the environment to `math_env` -> environment math_env has { r } robots
        "#]],
        );
        check(
            &program(&["sitecustomize"]),
            &expect![[r#"
            warning[script-name] 4:13 "sitecustomize" Python would run a script `sitecustomize.py` whenever it starts, so the script is called `sitecustomize_env.py`
              help: give the environment another name
              suggestion: rename the environment to `sitecustomize_env` -> environment sitecustomize_env has { r } robots
        "#]],
        );
        check(
            &program(&["zmq"]),
            &expect![[r#"
            warning[script-name] 4:13 "zmq" a script `zmq.py` would hide the module `zmq`, which scripts need, so the script is called `zmq_env.py`
              help: give the environment another name
              suggestion: rename the environment to `zmq_env` -> environment zmq_env has { r } robots
        "#]],
        );
        check(
            &program(&["Con"]),
            &expect![[r#"
            warning[script-name] 4:13 "Con" Windows has no files called `Con.py`, so the script is called `Con_env.py`
              help: give the environment another name
              suggestion: rename the environment to `Con_env` -> environment Con_env has { r } robots
        "#]],
        );
        check(
            &program(&["yard", "field", "Yard"]),
            &expect![[r#"
            warning[script-name] 6:13 "Yard" some computers take `Yard.py` and `yard.py` for the same file, so the script is called `Yard_env.py`
              see 4:13 "yard" this script is called `yard.py`
              help: give the environment another name
              suggestion: rename the environment to `Yard_env` -> environment Yard_env has { r } robots
        "#]],
        );
        check_clean(&program(&["yard", "field", "yard_2"]));
    }

    #[test]
    fn a_name_can_be_wrong_in_two_ways() {
        check(
            &program(&["math", "math"]),
            &expect![[r#"
                warning[script-name] 4:13 "math" a script `math.py` would hide Python's own module `math`, so the script is called `math_env.py`
                  help: give the environment another name
                  suggestion: rename the environment to `math_env` -> environment math_env has { r } robots
                error[duplicate-name] 5:13 "math" there is already an environment called `math`
                  see 4:13 "math" first declared here
                  help: give one of them another name
                  suggestion: rename this one to `math_2` -> environment math_2 has { r } robots
                warning[script-name] 5:13 "math" a script `math.py` would hide Python's own module `math`, so the script is called `math_env.py`
                  help: give the environment another name
                  suggestion: rename the environment to `math_env` -> environment math_env has { r } robots
            "#]],
        );
    }

    #[test]
    fn the_script_has_the_name_that_is_told() {
        let mut database = Database::new();
        let file = database.open("test.pyr", program(&["yard", "Yard", "math"]).as_str());
        let scripts: Vec<String> = database
            .environments(file)
            .iter()
            .map(|(id, _)| database.environment(*id).expect("no errors").script)
            .collect();
        assert_eq!(scripts, ["yard", "Yard_env", "math_env"]);
    }
}
