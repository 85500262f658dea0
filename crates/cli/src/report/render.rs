//! Problems for people: the source line, carets, related places, and the text of fixes.

use std::ops::Range;

use annotate_snippets::{Annotation, AnnotationKind, Element, Group, Level, Patch, Snippet};
use pydslrep_analysis::{Database, Diagnostic, FileId, Fix, Severity};
use pydslrep_config::Problem;
use pydslrep_syntax::Span;

use crate::inputs::Inputs;
use crate::report::output::renderer;

/// Problems as they are shown on a terminal, each with an empty line after it.
pub(crate) fn diagnostics(inputs: &Inputs, diagnostics: &[Diagnostic]) -> String {
    let mut text = String::new();
    for diagnostic in diagnostics {
        text += &one(inputs, diagnostic);
        text += "\n\n";
    }
    text
}

/// A problem of a `pydslrep.toml` or a scene file with its line, with an empty line after it.
pub(crate) fn problem(path: &str, text: &str, problem: &Problem) -> String {
    let span = problem.span.unwrap_or_default();
    let text = with_one_line_ending(text.to_owned());
    let place = |offset: u32| (offset as usize).min(text.len());
    let annotation = AnnotationKind::Primary.span(place(span.start)..place(span.end));
    let mut group = Group::with_title(Level::ERROR.primary_title(&problem.message))
        .element(Snippet::source(&text).path(path).annotation(annotation));
    if let Some(help) = &problem.help {
        group = group.element(Level::HELP.message(help));
    }
    format!("{}\n\n", renderer().render(&[group]))
}

fn one(inputs: &Inputs, diagnostic: &Diagnostic) -> String {
    let title = level(diagnostic.severity).primary_title(&diagnostic.message).id(diagnostic.code());
    let mut problem = title.elements(snippets(inputs, diagnostic));
    for (level, text) in [(Level::HELP, &diagnostic.help), (Level::NOTE, &diagnostic.note)] {
        if let Some(text) = text {
            problem = problem.element(level.message(text));
        }
    }
    let mut groups = vec![problem];
    groups.extend(diagnostic.fixes.iter().map(|fix| self::fix(inputs, fix)));
    renderer().render(&groups)
}

fn level(severity: Severity) -> Level<'static> {
    match severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
        Severity::Information => Level::INFO.with_name(severity.word()),
        Severity::Hint => Level::NOTE.with_name(severity.word()),
    }
}

/// The problem's own file first, then the other files that matter.
fn snippets<'a>(inputs: &'a Inputs, diagnostic: &'a Diagnostic) -> Vec<Element<'a>> {
    let mut files = vec![diagnostic.file];
    for related in &diagnostic.related {
        if !files.contains(&related.file) {
            files.push(related.file);
        }
    }
    let snippet = |file: FileId| {
        let primary = (file == diagnostic.file).then_some((diagnostic.span, None));
        let related = diagnostic.related.iter().filter(|related| related.file == file);
        let places: Vec<(Span, Option<&str>)> = primary
            .into_iter()
            .chain(related.map(|related| (related.span, Some(&*related.message))))
            .collect();
        let window = Window::about(inputs.database(), file, places.iter().map(|(span, _)| *span));
        let annotations: Vec<Annotation> = places
            .iter()
            .map(|(span, label)| {
                let kind = if label.is_none() { AnnotationKind::Primary } else { AnnotationKind::Context };
                kind.span(window.place(*span)).label(*label)
            })
            .collect();
        Snippet::source(window.text)
            .path(inputs.shown(file))
            .line_start(window.line)
            .annotations(annotations)
            .into()
    };
    files.into_iter().map(snippet).collect()
}

/// A fix with the text that it would write. Fixes that `--fix` applies are named differently from those to look at first.
fn fix<'a>(inputs: &'a Inputs, fix: &'a Fix) -> Group<'a> {
    let name = if fix.safe { "fix" } else { "suggestion" };
    let title = Level::HELP.with_name(name).secondary_title(&fix.title);
    let Some(file) = fix.edits.first().map(|edit| edit.file) else {
        return Group::with_title(title);
    };
    // Only the edits in this file are shown.
    let edits: Vec<_> = fix.edits.iter().filter(|edit| edit.file == file).collect();
    let window = Window::about(inputs.database(), file, edits.iter().map(|edit| edit.span));
    let patches: Vec<Patch> = edits
        .iter()
        .map(|edit| Patch::new(window.place(edit.span), edit.text.replace("\r\n", "\n")))
        .collect();
    title.element(
        Snippet::source(window.text).path(inputs.shown(file)).line_start(window.line).patches(patches),
    )
}

/// The lines of a text that matter: the renderer reads all it is given for every problem.
struct Window {
    text: String,
    /// Of the first line, from 1.
    line: usize,
    /// Of the first byte.
    start: usize,
}

impl Window {
    fn about(database: &Database, file: FileId, spans: impl Iterator<Item = Span>) -> Self {
        let whole = spans.reduce(Span::to).unwrap_or_default();
        let Some(rope) = database.text(file) else {
            return Self { text: String::new(), line: 1, start: 0 };
        };
        let line_of = |offset: u32| rope.byte_to_line((offset as usize).min(rope.len_bytes()));
        let (first, last) = (line_of(whole.start), line_of(whole.end));
        let (start, end) = (rope.line_to_byte(first), rope.line_to_byte((last + 1).min(rope.len_lines())));
        let text = rope.byte_slice(start..end).to_string();
        Self { text: with_one_line_ending(text), line: first + 1, start }
    }

    fn place(&self, span: Span) -> Range<usize> {
        let inside = |offset: u32| (offset as usize).saturating_sub(self.start).min(self.text.len());
        inside(span.start)..inside(span.end)
    }
}

/// The renderer knows neither a lone CR nor, in patches, CRLF. Every byte stays in its place.
fn with_one_line_ending(text: String) -> String {
    if text.contains('\r') { text.replace("\r\n", " \n").replace('\r', "\n") } else { text }
}
