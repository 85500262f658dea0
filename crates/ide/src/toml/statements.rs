//! The lines that a statement in a TOML file takes up, also while it is being typed.

use pydslrep_schema::{Span, name_parts};

/// The lines of the table whose header has a name at a place, or else the line of the key that has it.
pub(super) fn statement(text: &str, name: Span) -> Span {
    let line_start = |offset: usize| text[..offset].rfind('\n').map_or(0, |at| at + 1);
    let line_end = |offset: usize| text[offset..].find('\n').map_or(text.len(), |at| offset + at + 1);
    let start = line_start(name.start as usize);
    let mut end = line_end(name.end as usize);
    if text[start..].trim_start().starts_with('[') {
        let parts = name_parts(text);
        let section = parts.iter().find(|part| part.span == name).map(|part| part.section);
        let last = parts.iter().rfind(|part| Some(part.section) == section).map_or(name, |part| part.span);
        let next = parts.iter().find(|part| Some(part.section) > section);
        let limit = next.map_or(text.len(), |part| line_start(part.span.start as usize));
        end = end.max(line_end(last.end as usize));
        // Values can take several lines; comments before the next table are about that.
        for line in text[end..limit.max(end)].split_inclusive('\n') {
            if line.trim().is_empty() || line.trim_start().starts_with('#') {
                break;
            }
            end += line.len();
        }
    }
    (start..end).into()
}
