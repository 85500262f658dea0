//! Puts the template and the Python parts together.

use minijinja::{
    AutoEscape, Environment as Templates, Error, UndefinedBehavior, syntax::SyntaxConfig, value::Serde,
};

use crate::{ScriptError, context::Script};

const TEMPLATE: &str = "environment.py.j2";

/// Every source by the name that `include` knows it by.
const SOURCES: [(&str, &str); 29] = [
    (TEMPLATE, include_str!("../templates/environment.py.j2")),
    ("approach.py", include_str!("../python/pydslrep_parts/approach.py")),
    ("command.py", include_str!("../python/pydslrep_parts/command.py")),
    ("coppeliasim.py", include_str!("../python/pydslrep_parts/coppeliasim.py")),
    ("dominant_orientation.py", include_str!("../python/pydslrep_parts/dominant_orientation.py")),
    ("drive_four_mecanum.py", include_str!("../python/pydslrep_parts/drive_four_mecanum.py")),
    ("drive_four_wheel.py", include_str!("../python/pydslrep_parts/drive_four_wheel.py")),
    ("drive_two_wheel.py", include_str!("../python/pydslrep_parts/drive_two_wheel.py")),
    ("errors.py", include_str!("../python/pydslrep_parts/errors.py")),
    ("explorer.py", include_str!("../python/pydslrep_parts/explorer.py")),
    ("fleet.py", include_str!("../python/pydslrep_parts/fleet.py")),
    ("model.py", include_str!("../python/pydslrep_parts/model.py")),
    ("movement.py", include_str!("../python/pydslrep_parts/movement.py")),
    ("occupancy_grid.py", include_str!("../python/pydslrep_parts/occupancy_grid.py")),
    ("odometer.py", include_str!("../python/pydslrep_parts/odometer.py")),
    ("pose.py", include_str!("../python/pydslrep_parts/pose.py")),
    ("pose_graph.py", include_str!("../python/pydslrep_parts/pose_graph.py")),
    ("robot.py", include_str!("../python/pydslrep_parts/robot.py")),
    ("scan.py", include_str!("../python/pydslrep_parts/scan.py")),
    ("scan_log.py", include_str!("../python/pydslrep_parts/scan_log.py")),
    ("scan_matching.py", include_str!("../python/pydslrep_parts/scan_matching.py")),
    ("settings.py", include_str!("../python/pydslrep_parts/settings.py")),
    ("slam_backend.py", include_str!("../python/pydslrep_parts/slam_backend.py")),
    ("slam_rover.py", include_str!("../python/pydslrep_parts/slam_rover.py")),
    ("slam_session.py", include_str!("../python/pydslrep_parts/slam_session.py")),
    ("steering.py", include_str!("../python/pydslrep_parts/steering.py")),
    ("topological_map.py", include_str!("../python/pydslrep_parts/topological_map.py")),
    ("trace_file.py", include_str!("../python/pydslrep_parts/trace_file.py")),
    ("vrep.py", include_str!("../python/pydslrep_parts/vrep.py")),
];

/// The text of a script.
pub(crate) fn script(script: &Script) -> Result<String, ScriptError> {
    render(script).map_err(|error| ScriptError::Template(format!("{error:#}")))
}

fn render(script: &Script) -> Result<String, Error> {
    let mut templates = Templates::new();
    templates.set_undefined_behavior(UndefinedBehavior::Strict);
    templates.set_auto_escape_callback(|_| AutoEscape::None);
    // In the Python parts, template statements must be comments.
    templates.set_syntax(SyntaxConfig::builder().line_statement_prefix("#:").build()?);
    templates.add_filter("literal", literal);
    templates.add_filter("width", width);
    for (name, source) in SOURCES {
        templates.add_template(name, source)?;
    }
    templates.get_template(TEMPLATE)?.render(Serde(script))
}

/// A Python string literal, whatever the text.
fn literal(text: &str) -> String {
    let escaped: String = text
        .chars()
        .map(|c| match c {
            '"' | '\\' => format!("\\{c}"),
            ' '..='~' => c.to_string(),
            _ => format!("\\U{:08x}", u32::from(c)),
        })
        .collect();
    format!("\"{escaped}\"")
}

/// The most columns that a text takes up.
fn width(text: &str) -> usize {
    text.chars().map(|c| if c.is_ascii() { 1 } else { 2 }).sum()
}
