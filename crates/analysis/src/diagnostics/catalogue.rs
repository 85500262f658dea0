//! All rules.

use super::rule::Rule;

impl Rule {
    /// Returns whether it is about text that is not understood, so that problems of its meaning are hidden.
    pub(crate) fn is_of_text(&self) -> bool {
        let of_text = [
            &super::syntax_error::RULE,
            &super::invalid_character::RULE,
            &super::unterminated_comment::RULE,
            &super::unterminated_string::RULE,
        ];
        of_text.contains(&self)
    }
}

/// All rules, in the order of the language's contract.
pub const CATALOGUE: [&Rule; 50] = [
    &super::syntax_error::RULE,
    &super::invalid_character::RULE,
    &super::unterminated_comment::RULE,
    &super::unterminated_string::RULE,
    &super::misplaced_type::RULE,
    &super::deprecated_ip_clause::RULE,
    &super::number_out_of_range::RULE,
    &super::invalid_radius::RULE,
    &super::implausible_radius::RULE,
    &super::invalid_port::RULE,
    &super::port_of_other_target::RULE,
    &super::invalid_ip::RULE,
    &super::invalid_speed::RULE,
    &super::zero_distance::RULE,
    &super::invalid_angle::RULE,
    &super::invalid_count::RULE,
    &super::invalid_time::RULE,
    &super::invalid_within::RULE,
    &super::invalid_arc::RULE,
    &super::unresolved_reference::RULE,
    &super::ambiguous_import::RULE,
    &super::unresolved_import::RULE,
    &super::duplicate_name::RULE,
    &super::unused_declaration::RULE,
    &super::wheel_count::RULE,
    &super::wheel_kind_mismatch::RULE,
    &super::mixed_radii::RULE,
    &super::repeated_wheel::RULE,
    &super::repeated_sensor::RULE,
    &super::wheel_order::RULE,
    &super::sensor_not_on_robot::RULE,
    &super::missing_condition_word::RULE,
    &super::movement_of_other_robot::RULE,
    &super::recursive_movement::RULE,
    &super::slam_robot::RULE,
    &super::slam_sensors::RULE,
    &super::empty_movement::RULE,
    &super::empty_block::RULE,
    &super::nested_too_deep::RULE,
    &super::not_in_article::RULE,
    &super::empty_environment::RULE,
    &super::repeated_robot::RULE,
    &super::movement_robot_missing::RULE,
    &super::idle_robot::RULE,
    &super::parallel_conflict::RULE,
    &super::single_parallel::RULE,
    &super::duplicate_port::RULE,
    &super::script_name::RULE,
    &super::planned_collision::RULE,
    &super::no_environment::RULE,
];

/// The rule with a code.
pub fn rule(code: &str) -> Option<&'static Rule> {
    CATALOGUE.into_iter().find(|rule| rule.code == code)
}
