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
mod planned_run;
mod port_of_other_target;
mod problem;
mod recursive_movement;
mod repeated_robot;
mod repeated_sensor;
mod repeated_wheel;
mod reported;
mod rule;
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

pub use self::manual::index;
pub use self::nested_too_deep::MAX_BLOCK_DEPTH;
pub use self::not_in_article::beyond_article;
pub(crate) use self::planned_run::PlannedRun;
pub(crate) use self::problem::Problem;
pub(crate) use self::reported::{in_entity, in_file, of_entities, visit_in_file};
pub use self::rule::{Applicability, Page, Rule, Tag};

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
