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
    ("diary.py", include_str!("../python/pydslrep_parts/diary.py")),
    ("drive_four_mecanum.py", include_str!("../python/pydslrep_parts/drive_four_mecanum.py")),
    ("drive_four_wheel.py", include_str!("../python/pydslrep_parts/drive_four_wheel.py")),
    ("drive_two_wheel.py", include_str!("../python/pydslrep_parts/drive_two_wheel.py")),
    ("errors.py", include_str!("../python/pydslrep_parts/errors.py")),
    ("explorer.py", include_str!("../python/pydslrep_parts/explorer.py")),
    ("fleet.py", include_str!("../python/pydslrep_parts/fleet.py")),
    ("floor.py", include_str!("../python/pydslrep_parts/floor.py")),
    ("grain.py", include_str!("../python/pydslrep_parts/grain.py")),
    ("matching.py", include_str!("../python/pydslrep_parts/matching.py")),
    ("memory.py", include_str!("../python/pydslrep_parts/memory.py")),
    ("model.py", include_str!("../python/pydslrep_parts/model.py")),
    ("movement.py", include_str!("../python/pydslrep_parts/movement.py")),
    ("odometer.py", include_str!("../python/pydslrep_parts/odometer.py")),
    ("pose.py", include_str!("../python/pydslrep_parts/pose.py")),
    ("pose_graph.py", include_str!("../python/pydslrep_parts/pose_graph.py")),
    ("robot.py", include_str!("../python/pydslrep_parts/robot.py")),
    ("settings.py", include_str!("../python/pydslrep_parts/settings.py")),
    ("steering.py", include_str!("../python/pydslrep_parts/steering.py")),
    ("survey.py", include_str!("../python/pydslrep_parts/survey.py")),
    ("surveyor.py", include_str!("../python/pydslrep_parts/surveyor.py")),
    ("sweep.py", include_str!("../python/pydslrep_parts/sweep.py")),
    ("topology.py", include_str!("../python/pydslrep_parts/topology.py")),
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
