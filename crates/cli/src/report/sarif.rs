//! Problems in the format that tools for static analysis share: `check --format sarif`, SARIF 2.1.0.

use percent_encoding::{AsciiSet, CONTROLS, utf8_percent_encode};
use pydslrep_analysis::diagnostics::{CATALOGUE, Rule};
use pydslrep_analysis::{Diagnostic, Edit, FileId, Fix, Severity};
use pydslrep_syntax::Span;
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::inputs::Inputs;
use crate::inputs::paths::with_slashes;
use crate::inputs::scenes::{self, SceneProblem};
use crate::report::place::{self, PlaceRange};
use crate::report::{output, with_advice};

const SCHEMA: &str = "https://json.schemastore.org/sarif-2.1.0.json";

/// The characters that are escaped in a URI. A colon could be taken for the end of a scheme.
const RESERVED: &AsciiSet = &CONTROLS
    .add(b' ')
    .add(b'"')
    .add(b'#')
    .add(b'%')
    .add(b':')
    .add(b'<')
    .add(b'>')
    .add(b'?')
    .add(b'[')
    .add(b'\\')
    .add(b']')
    .add(b'^')
    .add(b'`')
    .add(b'{')
    .add(b'|')
    .add(b'}');

/// The problems as one log with one run.
///
/// # Errors
/// Never, with the values passed here.
pub(crate) fn log(
    inputs: &Inputs,
    diagnostics: &[Diagnostic],
    scene_problems: &[SceneProblem],
) -> Result<String, Failure> {
    let results = diagnostics.iter().map(|diagnostic| result(inputs, diagnostic));
    let results: Vec<Value> = results.chain(scene_problems.iter().map(in_scene)).collect();
    output::json(&json!({
        "$schema": SCHEMA,
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": {
                "name": "PyDSLRep",
                "version": env!("CARGO_PKG_VERSION"),
                "rules": CATALOGUE.into_iter().map(rule).collect::<Vec<_>>(),
            }},
            "columnKind": "unicodeCodePoints",
            "results": results,
        }],
    }))
}

fn rule(rule: &Rule) -> Value {
    let manual = rule.manual();
    json!({
        "id": rule.code,
        "shortDescription": { "text": rule.summary },
        "fullDescription": { "text": rule.page.what },
        "help": { "text": rule.page.why, "markdown": manual },
        "defaultConfiguration": { "level": level(rule.severity) },
    })
}

fn level(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Information | Severity::Hint => "note",
    }
}

fn result(inputs: &Inputs, diagnostic: &Diagnostic) -> Value {
    let text = with_advice(&diagnostic.message, diagnostic.help.as_deref(), diagnostic.note.as_deref());
    let related = diagnostic.related.iter().enumerate().map(|(index, related)| {
        json!({
            "id": index + 1,
            "physicalLocation": location(inputs, related.file, related.span),
            "message": { "text": related.message },
        })
    });
    json!({
        "ruleId": diagnostic.code(),
        "ruleIndex": CATALOGUE.iter().position(|rule| *rule == diagnostic.rule),
        "level": level(diagnostic.severity),
        "message": { "text": text },
        "locations": [{ "physicalLocation": location(inputs, diagnostic.file, diagnostic.span) }],
        "relatedLocations": related.collect::<Vec<_>>(),
        "fixes": diagnostic.fixes.iter().map(|fix| self::fix(inputs, fix)).collect::<Vec<_>>(),
    })
}

/// These have no rule in the catalogue: it is about programs.
fn in_scene(problem: &SceneProblem) -> Value {
    let SceneProblem { shown, range, problem, .. } = problem;
    let text = with_advice(&problem.message, problem.help.as_deref(), None);
    json!({
        "ruleId": problem.kind.code(),
        "level": level(scenes::SEVERITY),
        "message": { "text": text },
        "locations": [{ "physicalLocation": physical(shown, *range) }],
    })
}

fn location(inputs: &Inputs, file: FileId, span: Span) -> Value {
    physical(inputs.shown(file), place::range(inputs.database(), file, span))
}

fn physical(shown: &str, range: PlaceRange) -> Value {
    json!({ "artifactLocation": { "uri": uri(shown) }, "region": region(range) })
}

/// From the first character to right after the last one, as everywhere here.
fn region(range: PlaceRange) -> Value {
    json!({
        "startLine": range.start.line,
        "startColumn": range.start.column,
        "endLine": range.end.line,
        "endColumn": range.end.column,
    })
}

/// A path as it is printed, as a URI: relative to the current folder where the path is.
fn uri(shown: &str) -> String {
    let slashes = with_slashes(shown);
    let encoded = utf8_percent_encode(&slashes, RESERVED).to_string();
    match (slashes.starts_with('/'), slashes.as_bytes()) {
        (true, _) => format!("file://{encoded}"),
        (false, [drive, b':', b'/', ..]) if cfg!(windows) && drive.is_ascii_alphabetic() => {
            format!("file:///{encoded}")
        }
        _ => encoded,
    }
}

fn fix(inputs: &Inputs, fix: &Fix) -> Value {
    let mut files: Vec<FileId> = fix.edits.iter().map(|edit| edit.file).collect();
    files.sort_unstable();
    files.dedup();
    let change = |file: FileId| {
        let edits = fix.edits.iter().filter(|edit| edit.file == file);
        json!({
            "artifactLocation": { "uri": uri(inputs.shown(file)) },
            "replacements": edits.map(|edit| replacement(inputs, edit)).collect::<Vec<_>>(),
        })
    };
    json!({
        "description": { "text": fix.title },
        "artifactChanges": files.into_iter().map(change).collect::<Vec<_>>(),
    })
}

fn replacement(inputs: &Inputs, edit: &Edit) -> Value {
    json!({
        "deletedRegion": region(place::range(inputs.database(), edit.file, edit.span)),
        "insertedContent": { "text": edit.text },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_uris() {
        assert_eq!(uri("rooms/a b#1.pyr"), "rooms/a%20b%231.pyr");
        assert_eq!(uri("c:d.pyr"), "c%3Ad.pyr");
        assert_eq!(uri("/tmp/机.pyr"), "file:///tmp/%E6%9C%BA.pyr");
        assert_eq!(uri("<stdin>"), "%3Cstdin%3E");
    }
}
