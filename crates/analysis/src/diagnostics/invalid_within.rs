//! `invalid-within`: a distance after `within` that no sensor can see something at.

use std::sync::Arc;

use pydslrep_scene::ENDING;
use pydslrep_syntax::EntityKind;
use pydslrep_syntax::ast::{Action, Condition, SensorKeyword, Within};

use super::context::Context;
use super::example::sensing_trip;
use super::number_out_of_range::MAX_DISTANCE;
use super::planned_run::{OutOfRange, PlannedRun};
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::signature::Signature;
use crate::{Diagnostic, Facts, FileId, Severity};

pub(super) static RULE: Rule = Rule {
    code: "invalid-within",
    severity: Severity::Error,
    summary: "a distance after `within` that no sensor can see something at",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    checks: Checks::of_entity(check).and_runs(in_runs),
};

const PAGE: Page = Page {
    what: "The distance after `within` is zero or negative. It is a warning that all sensors of the condition are \
        bumpers, or that the distance is beyond the range that all of them have in the scene of an environment.",
    why: "`within` counts only what is nearer than that, and nothing is nearer than nothing. A bumper tells \
        that it touches something, but not how far away that is. Beyond the range of a sensor nothing is detected, \
        so a longer distance is the same as none.",
    imports: &[],
    example: sensing_trip!("{ move until { front } detect within 0 meters }"),
    fixed: sensing_trip!("{ move until { front } detect within 40 centimeters }"),
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    for condition in context.actions().flat_map(Action::conditions) {
        let Some(within) = &condition.within else { continue };
        problems.extend(problem(context, condition, within));
    }
}

fn problem(context: &Context<'_>, condition: &Condition, within: &Within) -> Option<Problem> {
    let distance = within.distance.as_ref()?;
    let value = distance.value.filter(|value| value.is_finite())?;
    if value <= 0.0 {
        let written = context.short_text(distance.span);
        return Some(
            RULE.problem(distance.span, format!("nothing is nearer than {written}"))
                .help("write a distance above zero, or leave out `within`"),
        );
    }
    let far = value * within.unit.map_or(1.0, |(unit, _)| unit.in_metres()) > MAX_DISTANCE;
    (!far && are_bumpers(context, condition)).then(|| {
        RULE.problem(distance.span, "a bumper does not measure distances")
            .severity(Severity::Warning)
            .help("leave out `within`, or ask a distance sensor")
    })
}

/// The problems of the conditions of a file in the runs of its environments; each once.
fn in_runs(facts: &Facts, file: FileId, runs: &[Arc<PlannedRun>]) -> Vec<Diagnostic> {
    let mut diagnostics: Vec<Diagnostic> = Vec::new();
    for run in runs {
        let found = run.out_of_range.iter().filter_map(|found| located(facts, run, found));
        for diagnostic in found.filter(|diagnostic| diagnostic.file == file) {
            if diagnostics.iter().all(|other| other.span != diagnostic.span) {
                diagnostics.push(diagnostic);
            }
        }
    }
    diagnostics
}

fn located(facts: &Facts, run: &PlannedRun, found: &OutOfRange) -> Option<Diagnostic> {
    let entity = facts.entity(found.movement)?;
    let environment = &run.environment.name;
    let sensors = if found.count == 1 { "this sensor sees nothing" } else { "these sensors see nothing" };
    Some(Diagnostic {
        rule: &RULE,
        severity: Severity::Warning,
        file: entity.file,
        span: found.span.shifted(entity.span.start),
        message: format!("{sensors} farther away than {} m", found.range),
        help: Some(format!(
            "write a shorter distance, leave out `within`, or change the `range` in `{environment}{ENDING}`"
        )),
        note: Some(format!("this is so for the environment `{environment}` in its scene")),
        related: Vec::new(),
        fixes: Vec::new(),
    })
}

/// Returns whether all its sensors are known to be bumpers.
fn are_bumpers(context: &Context<'_>, condition: &Condition) -> bool {
    let is_bumper = |name| {
        let id = context.resolve(EntityKind::Sensor, name).entity();
        let sensor = id.and_then(|id| context.signature(id)).and_then(Signature::sensor);
        sensor.is_some_and(|sensor| matches!(sensor.kind, Some((SensorKeyword::Bumper, _))))
    };
    let names = &condition.sensors.names;
    !names.is_empty() && !condition.sensors.broken && names.iter().all(is_bumper)
}

#[cfg(test)]
mod tests {
    use expect_test::expect;
    use pydslrep_syntax::Span;

    use crate::Database;
    use crate::diagnostics::testing::{check, check_clean, program};

    #[test]
    fn something_can_be_nearer() {
        check(
            &program("move until { s } detect within -1 meters"),
            &expect![[r#"
            error[invalid-within] 6:50 "-1" nothing is nearer than -1
              help: write a distance above zero, or leave out `within`
        "#]],
        );
        check_clean(&program("move until { s } detect within 0.1 centimeters"));
    }

    /// The warnings of a program, whose environment has this scene.
    fn warnings(database: &Database, path: &str) -> String {
        let file = database.file(path).unwrap();
        let diagnostics = database.diagnostics(file).into_iter();
        let own = diagnostics.filter(|found| found.code() == "invalid-within");
        let lines = own.map(|found| {
            assert_eq!(found.severity, crate::Severity::Warning);
            format!("{}: {}\n", database.slice(file, found.span), found.message)
        });
        lines.collect::<Vec<_>>().concat()
    }

    const ENVIRONMENT: &str = "\nenvironment e has { r } robots with { m } moves";

    #[test]
    fn the_scene_has_the_ranges() {
        let actions = "move until { s } detect within 3 meters if { s, t } clear within 150 centimeters { turn left } \
            wait until { t } clear within 2 meters";
        let text = program(actions) + ENVIRONMENT;
        let mut database = Database::new();
        let file = database.open("a.pyr", &text);
        let mut warnings_with = |scene: Option<&str>| {
            database.set_scene(file, "e", scene);
            warnings(&database, "a.pyr")
        };
        let without = warnings_with(None);
        expect![[r#"
            2: a bumper does not measure distances
        "#]]
        .assert_eq(&without);
        expect![[r#"
            3: this sensor sees nothing farther away than 1 m
            150: these sensors see nothing farther away than 1 m
            2: a bumper does not measure distances
        "#]]
        .assert_eq(&warnings_with(Some("")));
        expect![[r#"
            3: this sensor sees nothing farther away than 2 m
            2: a bumper does not measure distances
        "#]]
        .assert_eq(&warnings_with(Some("[robots.r.sensors.s]\nrange = 2")));
        assert_eq!(warnings_with(Some("[robots.r.sensors.s]\nrange = 3")), without);
        assert_eq!(
            warnings_with(Some("[robots.r.sensors.s]\nrange = \"far\"")),
            without,
            "what is wrong is not known"
        );
    }

    #[test]
    fn in_the_file_of_the_movement_and_after_every_edit() {
        let mut database = Database::new();
        let parts = database.open("parts.pyr", &program("move until { s } detect within 3 meters"));
        let main = database.open("main.pyr", &format!("import \"parts.pyr\"{ENVIRONMENT}"));
        database.set_scene(main, "e", Some(""));
        assert_eq!(warnings(&database, "main.pyr"), "");
        let reported = warnings(&database, "parts.pyr");
        assert!(reported.starts_with("3: this sensor sees nothing"), "{reported}");
        let f = format!("{ENVIRONMENT} environment f has {{ r }} robots with {{ m }} moves");
        database.open("main.pyr", &format!("import \"parts.pyr\"{f}"));
        database.set_scene(main, "f", Some(""));
        assert_eq!(warnings(&database, "parts.pyr"), reported, "once for all environments");
        database.take_touched();
        // The place of the warning has moved, though the movement itself is the same.
        database.edit(parts, Span::at(0), "\n");
        assert!(database.take_touched().contains(&parts));
        assert_eq!(warnings(&database, "parts.pyr"), reported);
        let text = database.text(parts).unwrap().to_string();
        let place = u32::try_from(text.find("within 3").unwrap()).unwrap();
        database.edit(parts, Span::new(place + 7, place + 8), "1");
        assert_eq!(warnings(&database, "parts.pyr"), "");
    }

    #[test]
    fn bumpers_measure_nothing() {
        check(
            &program("move until { t } detect within 1 meters"),
            &expect![[r#"
            warning[invalid-within] 6:50 "1" a bumper does not measure distances
              help: leave out `within`, or ask a distance sensor
        "#]],
        );
        check_clean(&program("move until { s, t } detect within 1 meters"));
    }
}
