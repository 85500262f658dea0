//! `legacy-port`: V-REP's port in a program whose scripts are made for `CoppeliaSim`.

use pydslrep_syntax::ast::Entity;
use rustc_hash::{FxHashMap, FxHashSet};

use super::context::{Context, Problem};
use super::{Page, Remedy, Rule};
use crate::{Database, Diagnostic, Edit, FileId, Fix, Severity, Target};

pub(super) static RULE: Rule = Rule {
    code: "legacy-port",
    severity: Severity::Hint,
    summary: "a robot has V-REP's port, and the target is `coppeliasim`",
    tag: None,
    remedy: Remedy::Suggested,
    seeks_names: false,
    page: PAGE,
    check,
};

const PAGE: Page = Page {
    what: "A robot's port is 19999, and the scripts are made for CoppeliaSim.",
    why: "19999 is the port of the older V-REP. CoppeliaSim's ZeroMQ remote API listens on 23000, so a script \
        that looks for CoppeliaSim on 19999 usually finds nothing there. (`pydslrep run` starts its own simulator on \
        whatever port the program says.) If the scripts are for V-REP, say so in pydslrep.toml: `target = \"vrep\"`.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 19999 has { wheelL wheelR } wheels

movement trip of rover { move 1 meters }

environment yard has { rover } robots with { trip } moves",
    fixed: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels

movement trip of rover { move 1 meters }

environment yard has { rover } robots with { trip } moves",
};

const LEGACY: u16 = Target::VRep.default_port();
const USUAL: u16 = Target::CoppeliaSim.default_port();

/// The fix depends on the other robots of the file, see [`offer_ports`].
fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Robot(robot)) = context.tree else { return };
    if context.database.target(context.file) != Target::CoppeliaSim {
        return;
    }
    if let Some(port) = robot.port.as_ref().filter(|port| port.value == Some(LEGACY)) {
        let message = format!("{LEGACY} is V-REP's port; CoppeliaSim listens on {USUAL}");
        problems.push(
            RULE.problem(port.span, message)
                .help("change the port, or write `target = \"vrep\"` into pydslrep.toml"),
        );
    }
}

/// Gives each such robot of a file the next port that no other robot of the file has, in the order of the text, so
/// that the fixes of several do not get in each other's way.
pub(super) fn offer_ports(database: &Database, file: FileId, diagnostics: &mut [Diagnostic]) {
    let is_legacy = |diagnostic: &&mut Diagnostic| diagnostic.rule == &RULE;
    let mut found = diagnostics.iter_mut().filter(is_legacy).peekable();
    if found.peek().is_none() {
        return;
    }
    let (legacy, others): (Vec<_>, Vec<_>) =
        ports(database, file).into_iter().partition(|(_, port)| *port == LEGACY);
    let taken: FxHashSet<u16> = others.into_iter().map(|(_, port)| port).collect();
    let free = (USUAL..=u16::MAX).filter(|port| !taken.contains(port));
    let free: FxHashMap<u32, u16> = legacy.into_iter().map(|(start, _)| start).zip(free).collect();
    for diagnostic in found {
        let span = diagnostic.span;
        diagnostic.fixes.extend(free.get(&span.start).map(|port| Fix {
            title: format!("change the port to {port}"),
            safe: false,
            edits: vec![Edit { file, span, text: port.to_string() }],
        }));
    }
}

/// Where the ports of a file's robots start, and what they are, in the order of the text.
fn ports(database: &Database, file: FileId) -> Vec<(u32, u16)> {
    let ports = database.entities(file).filter_map(|entity| match &entity.parse.entity {
        Some(Entity::Robot(robot)) => {
            let port = robot.port.as_ref()?;
            Some((port.span.start + entity.span.start, port.value?))
        }
        _ => None,
    });
    ports.collect()
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{apply, check, check_clean};
    use crate::{Database, Diagnostic, Target};

    fn robots(ports: &[&str]) -> String {
        let robot =
            |(index, port): (usize, &&str)| format!("robot r{index} with port {port} has {{ a b }} wheels\n");
        let wheels = "wheel a with radius 4\nwheel b with radius 4\n";
        wheels.to_owned() + &ports.iter().enumerate().map(robot).collect::<String>()
    }

    #[test]
    fn the_port_of_vrep_is_not_that_of_coppeliasim() {
        check(
            &robots(&["19999"]),
            &expect![[r#"
                hint[legacy-port] 3:20 "19999" 19999 is V-REP's port; CoppeliaSim listens on 23000
                  help: change the port, or write `target = "vrep"` into pydslrep.toml
                  suggestion: change the port to 23000 -> robot r0 with port 23000 has { a b } wheels
            "#]],
        );
        check_clean(&robots(&["19998"]));
        check_clean(&robots(&["23000"]));
    }

    #[test]
    fn each_robot_is_offered_the_next_free_port() {
        check(
            &robots(&["19999", "23001", "19999", "23000", "019999"]),
            &expect![[r#"
                hint[legacy-port] 3:20 "19999" 19999 is V-REP's port; CoppeliaSim listens on 23000
                  help: change the port, or write `target = "vrep"` into pydslrep.toml
                  suggestion: change the port to 23002 -> robot r0 with port 23002 has { a b } wheels
                hint[legacy-port] 5:20 "19999" 19999 is V-REP's port; CoppeliaSim listens on 23000
                  help: change the port, or write `target = "vrep"` into pydslrep.toml
                  suggestion: change the port to 23003 -> robot r2 with port 23003 has { a b } wheels
                hint[legacy-port] 7:20 "019999" 19999 is V-REP's port; CoppeliaSim listens on 23000
                  help: change the port, or write `target = "vrep"` into pydslrep.toml
                  suggestion: change the port to 23004 -> robot r4 with port 23004 has { a b } wheels
            "#]],
        );
    }

    #[test]
    fn all_offers_together_give_each_robot_a_port_of_its_own() {
        let mut program = robots(&["19999", "19999", "23001"]);
        let mut database = Database::new();
        let file = database.open("test.pyr", &program);
        let fixes: Vec<_> =
            database.diagnostics(file).into_iter().flat_map(|diagnostic| diagnostic.fixes).collect();
        let edits: Vec<_> = fixes.into_iter().flat_map(|fix| fix.edits).collect();
        program = apply(&program, file, &edits);
        assert_eq!(program, robots(&["23000", "23002", "23001"]));
    }

    #[test]
    fn for_vrep_it_is_the_right_port() {
        let mut database = Database::new();
        let file = database.open("test.pyr", &robots(&["19999"]));
        let codes = |database: &Database| -> Vec<&'static str> {
            database.diagnostics(file).iter().map(Diagnostic::code).collect()
        };
        assert_eq!(codes(&database), ["legacy-port"]);
        database.set_target(file, Target::VRep);
        assert!(codes(&database).is_empty());
        database.set_target(file, Target::CoppeliaSim);
        assert_eq!(codes(&database), ["legacy-port"]);
    }
}
