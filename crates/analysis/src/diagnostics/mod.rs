//! The catalogue of problems: one module per code, with its check, its words, its fixes and its tests.

mod ambiguous_import;
mod calls;
mod consequences;
mod context;
mod deprecated_ip_clause;
mod duplicate_name;
mod duplicate_port;
mod edits;
mod empty_block;
mod empty_environment;
mod empty_movement;
mod idle_robot;
mod implausible_radius;
mod invalid_angle;
mod invalid_arc;
mod invalid_character;
mod invalid_count;
mod invalid_ip;
mod invalid_port;
mod invalid_radius;
mod invalid_speed;
mod invalid_time;
mod invalid_within;
mod manual;
mod misplaced_type;
mod missing_condition_word;
mod mixed_radii;
mod movement_of_other_robot;
mod movement_robot_missing;
mod nested_too_deep;
mod no_environment;
mod not_in_article;
mod number_out_of_range;
mod parallel_conflict;
mod planned_collision;
mod port_of_other_target;
mod problem;
mod recursive_movement;
mod repeated_robot;
mod repeated_sensor;
mod repeated_wheel;
mod script_name;
mod sensor_not_on_robot;
mod single_parallel;
mod slam_robot;
mod slam_sensors;
mod syntax_error;
mod unresolved_import;
mod unresolved_reference;
mod unterminated_comment;
mod unterminated_string;
mod unused_declaration;
mod wheel_count;
mod wheel_kind_mismatch;
mod wheel_order;
mod zero_distance;

#[cfg(test)]
mod testing;

use pydslrep_syntax::Span;

use self::consequences::Consequences;
use self::context::Context;
pub use self::manual::{Applicability, Page, index};
pub use self::nested_too_deep::MAX_BLOCK_DEPTH;
pub use self::not_in_article::beyond_article;
pub(crate) use self::planned_collision::PlannedRun;
use self::problem::Brace;
pub(crate) use self::problem::Problem;
use crate::reads::Reads;
use crate::{Database, Diagnostic, EntityId, FileId, Related, Severity};

/// A way to show text besides underlining it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tag {
    /// It does nothing; shown faded.
    Unnecessary,
    /// An older spelling; shown struck through.
    Deprecated,
}

/// A row of the catalogue.
#[derive(Debug)]
pub struct Rule {
    /// Its stable name.
    pub code: &'static str,
    /// Its usual severity.
    pub severity: Severity,
    /// A summary of what it finds, in one sentence.
    pub summary: &'static str,
    /// The way in which an editor may show the text it is about.
    pub tag: Option<Tag>,
    /// The best fix it may offer.
    pub applicability: Applicability,
    /// The manual page, which says more than its messages.
    pub page: Page,
    check: fn(&Context<'_>, &mut Vec<Problem>),
}

impl PartialEq for Rule {
    fn eq(&self, other: &Self) -> bool {
        self.code == other.code
    }
}

impl Rule {
    /// Returns whether it is about text that is not understood, so that problems of its meaning are hidden.
    pub(crate) fn is_of_text(&self) -> bool {
        let of_text = [
            &syntax_error::RULE,
            &invalid_character::RULE,
            &unterminated_comment::RULE,
            &unterminated_string::RULE,
        ];
        of_text.contains(&self)
    }
}

/// All rules, in the order of the language's contract.
pub const CATALOGUE: [&Rule; 50] = [
    &syntax_error::RULE,
    &invalid_character::RULE,
    &unterminated_comment::RULE,
    &unterminated_string::RULE,
    &misplaced_type::RULE,
    &deprecated_ip_clause::RULE,
    &number_out_of_range::RULE,
    &invalid_radius::RULE,
    &implausible_radius::RULE,
    &invalid_port::RULE,
    &port_of_other_target::RULE,
    &invalid_ip::RULE,
    &invalid_speed::RULE,
    &zero_distance::RULE,
    &invalid_angle::RULE,
    &invalid_count::RULE,
    &invalid_time::RULE,
    &invalid_within::RULE,
    &invalid_arc::RULE,
    &unresolved_reference::RULE,
    &ambiguous_import::RULE,
    &unresolved_import::RULE,
    &duplicate_name::RULE,
    &unused_declaration::RULE,
    &wheel_count::RULE,
    &wheel_kind_mismatch::RULE,
    &mixed_radii::RULE,
    &repeated_wheel::RULE,
    &repeated_sensor::RULE,
    &wheel_order::RULE,
    &sensor_not_on_robot::RULE,
    &missing_condition_word::RULE,
    &movement_of_other_robot::RULE,
    &recursive_movement::RULE,
    &slam_robot::RULE,
    &slam_sensors::RULE,
    &empty_movement::RULE,
    &empty_block::RULE,
    &nested_too_deep::RULE,
    &not_in_article::RULE,
    &empty_environment::RULE,
    &repeated_robot::RULE,
    &movement_robot_missing::RULE,
    &idle_robot::RULE,
    &parallel_conflict::RULE,
    &single_parallel::RULE,
    &duplicate_port::RULE,
    &script_name::RULE,
    &planned_collision::RULE,
    &no_environment::RULE,
];

/// The rule with a code.
pub fn rule(code: &str) -> Option<&'static Rule> {
    CATALOGUE.into_iter().find(|rule| rule.code == code)
}

/// The problems of one entity, in the order of the text, and what was looked at to find them.
pub(crate) fn in_entity(database: &Database, id: EntityId) -> (Vec<Problem>, Reads) {
    let mut problems = Vec::new();
    let Some(context) = Context::new(database, id) else { return (problems, Reads::default()) };
    for rule in CATALOGUE {
        (rule.check)(&context, &mut problems);
    }
    problems.sort_by_key(|problem| (problem.span.start, problem.span.end));
    (problems, context.into_reads())
}

/// A problem of a file that is reported.
struct Reported<'a> {
    /// Where its entity starts.
    start: u32,
    problem: &'a Problem,
    /// True for an open brace that is closed after declarations that do not belong within it.
    is_nested: bool,
}

/// The problems of a file with absolute places.
pub(crate) fn in_file(database: &Database, file: FileId) -> Vec<Diagnostic> {
    let located = reported(database, file).into_iter().map(|Reported { start, problem, is_nested }| {
        let mut diagnostic = located(database, file, start, problem);
        if is_nested {
            syntax_error::nested(&mut diagnostic);
        }
        diagnostic
    });
    let mut diagnostics: Vec<Diagnostic> = located.collect();
    diagnostics.extend(no_environment::in_file(database, file));
    diagnostics.extend(in_scenes(database, file));
    diagnostics.sort_by_key(|diagnostic| diagnostic.span.start);
    diagnostics
}

/// The problems that the actions of a file have in any environment with a scene. Without scenes there is nothing to do.
fn in_scenes(database: &Database, file: FileId) -> Vec<Diagnostic> {
    let runs = database.planned_runs(file);
    let mut diagnostics = planned_collision::in_runs(database, file, &runs);
    diagnostics.extend(invalid_within::in_runs(database, file, &runs));
    diagnostics
}

/// Calls `visit` with the rule, the severity and the start of all that [`in_file`] returns, in no order; their places and
/// fixes, which take much longer, are not looked for.
pub(crate) fn visit_in_file(
    database: &Database,
    file: FileId,
    mut visit: impl FnMut(&'static Rule, Severity, u32),
) {
    for Reported { start, problem, .. } in reported(database, file) {
        visit(problem.rule, problem.severity, problem.span.shifted(start).start);
    }
    let of_whole = no_environment::in_file(database, file).into_iter();
    for diagnostic in of_whole.chain(in_scenes(database, file)) {
        visit(diagnostic.rule, diagnostic.severity, diagnostic.span.start);
    }
}

/// The problems of a file's entities without those that only follow from others, in the order of the text.
fn reported(database: &Database, file: FileId) -> Vec<Reported<'_>> {
    let entities = database.entities_with_problems(file);
    let ids: Vec<EntityId> = entities.iter().map(|entity| entity.id).collect();
    let problems: Vec<(u32, &Problem)> = entities
        .into_iter()
        .flat_map(|entity| {
            database.problems(entity.id).iter().map(move |problem| (entity.span.start, problem))
        })
        .collect();
    let consequences = Consequences::new(database, file, &ids, &problems);
    let mut reported: Vec<Reported<'_>> = Vec::with_capacity(problems.len());
    let mut open = None;
    for (start, problem) in problems.into_iter().filter(|(_, problem)| !consequences.include(problem)) {
        match problem.brace {
            Some(Brace::Unclosed) => open = Some(reported.len()),
            // It closes what was left open before the declarations in between.
            Some(Brace::Stray) if let Some(unclosed) = open.take() => {
                reported[unclosed].is_nested = true;
                continue;
            }
            _ => {}
        }
        reported.push(Reported { start, problem, is_nested: false });
    }
    reported
}

/// The problems of some entities, wherever they are, with absolute places.
pub(crate) fn of_entities(database: &Database, ids: &[EntityId]) -> Vec<Diagnostic> {
    let mut diagnostics = Vec::new();
    for entity in ids.iter().filter_map(|id| database.entity(*id)) {
        for problem in database.problems(entity.id) {
            diagnostics.push(located(database, entity.file, entity.span.start, problem));
        }
    }
    diagnostics
}

fn located(database: &Database, file: FileId, start: u32, problem: &Problem) -> Diagnostic {
    let related = problem.related.iter().filter_map(|related| {
        let (file, span) = absolute(database, related.entity, related.span)?;
        Some(Related { file, span, message: related.message.clone() })
    });
    Diagnostic {
        rule: problem.rule,
        severity: problem.severity,
        file,
        span: problem.span.shifted(start),
        message: problem.message.clone(),
        help: problem.help.clone(),
        note: problem.note.clone(),
        related: related.collect(),
        fixes: problem.fixes.iter().filter_map(|fix| edits::located(database, fix)).collect(),
    }
}

/// Where a part of an entity is.
fn absolute(database: &Database, id: EntityId, span: Span) -> Option<(FileId, Span)> {
    let entity = database.entity(id)?;
    Some((entity.file, span.shifted(entity.span.start)))
}
