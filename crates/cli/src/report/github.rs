//! Problems for GitHub Actions, which shows them beside the lines they are about: `check --format github`.

use pydslrep_analysis::{Diagnostic, Severity};

use crate::inputs::Inputs;
use crate::inputs::paths::with_slashes;
use crate::inputs::scenes::{self, SceneProblem};
use crate::report::place::{self, PlaceRange};
use crate::report::with_advice;

/// The problems as workflow commands, a line each.
pub(crate) fn commands(
    inputs: &Inputs,
    diagnostics: &[Diagnostic],
    scene_problems: &[SceneProblem],
) -> String {
    let commands = diagnostics.iter().map(|diagnostic| of_diagnostic(inputs, diagnostic));
    commands.chain(scene_problems.iter().map(of_scene)).collect()
}

fn of_scene(problem: &SceneProblem) -> String {
    let SceneProblem { shown, range, problem, .. } = problem;
    let message = with_advice(&problem.message, problem.help.as_deref(), None);
    command(scenes::SEVERITY, shown, *range, problem.kind.code(), &message)
}

fn of_diagnostic(inputs: &Inputs, diagnostic: &Diagnostic) -> String {
    let range = place::range(inputs.database(), diagnostic.file, diagnostic.span);
    let message = with_advice(&diagnostic.message, diagnostic.help.as_deref(), diagnostic.note.as_deref());
    let (severity, file) = (diagnostic.severity, inputs.shown(diagnostic.file));
    command(severity, file, range, diagnostic.code(), &message)
}

fn command(severity: Severity, file: &str, range: PlaceRange, code: &str, message: &str) -> String {
    format!(
        "::{} file={},line={},col={},endLine={},endColumn={},title={}::{}\n",
        command_name(severity),
        property(&with_slashes(file)),
        range.start.line,
        range.start.column,
        range.end.line,
        range.end.column,
        property(code),
        escaped(message),
    )
}

fn command_name(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Information | Severity::Hint => "notice",
    }
}

/// A text with nothing in it that would end a command.
fn escaped(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

/// The same for the value of a property, which `:` and `,` would end as well.
fn property(value: &str) -> String {
    escaped(value).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_ends_a_command_early() {
        assert_eq!(escaped("50 %: a,b\r\nc"), "50 %25: a,b%0D%0Ac");
        assert_eq!(property("c:\\50%,x\n.pyr"), "c%3A\\50%25%2Cx%0A.pyr");
    }
}
