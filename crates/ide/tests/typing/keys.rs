//! The minimum number of keys to type a program.
//!
//! The keys are those of an editor with default settings: the list opens automatically after a letter, and after a space
//! where the server opens it; Ctrl+Space opens it anywhere; Down selects the next item, Tab accepts the selected item or
//! moves to the next tab stop, End leaves a snippet. Enter indents the next line and closes a brace opened before it.

use pydslrep_ide::CompletionTrigger;

use crate::snippet::{Filled, matched};
use crate::typed::Typed;

/// The minimum number of keys.
pub(crate) fn keys(program: &str) -> usize {
    let mut fewest = vec![usize::MAX; program.len() + 1];
    fewest[0] = 0;
    let mut typed = Typed::new(program);
    for at in 0..program.len() {
        let so_far = fewest[at];
        if so_far == usize::MAX {
            continue;
        }
        typed.type_to(at);
        let next = next_key(program, at);
        fewest[next] = fewest[next].min(so_far + 1);
        for (end, keys) in accepted(&typed, program) {
            fewest[end] = fewest[end].min(so_far + keys);
        }
    }
    fewest[program.len()]
}

/// The offset after one key: a character, or a line break with the indentation that the editor adds.
fn next_key(program: &str, at: usize) -> usize {
    let rest = &program[at..];
    let first = rest.chars().next().map_or(0, char::len_utf8);
    if !rest.starts_with('\n') {
        return at + first;
    }
    let blanks = rest[1..].len() - rest[1..].trim_start_matches(' ').len();
    // Down, to the brace that was closed automatically.
    let closes = usize::from(rest[1 + blanks..].starts_with('}'));
    at + 1 + blanks + closes
}

/// The acceptable items with the resulting offset and their number of keys.
fn accepted(typed: &Typed, program: &str) -> Vec<(usize, usize)> {
    let before = program[..typed.length()].chars().last();
    let opened = match before {
        Some(letter) if letter.is_ascii_alphanumeric() || letter == '_' => {
            typed.offered(CompletionTrigger::Letter)
        }
        Some(other) => typed.offered(CompletionTrigger::Character(other)),
        None => Vec::new(),
    };
    let (items, open) =
        if opened.is_empty() { (typed.offered(CompletionTrigger::Invoked), 1) } else { (opened, 0) };
    let items = items.iter().enumerate().filter(|(_, item)| item.import_edit.is_none());
    items
        .filter_map(|(rank, item)| {
            let start = item.replace.start as usize;
            let (end, stops) = if item.is_snippet {
                matched(&indented(&item.insert, program, start), program, start)?
            } else {
                (program[start..].starts_with(&item.insert).then_some(start + item.insert.len())?, Vec::new())
            };
            let is_whole = !program[end..].starts_with(|c: char| c.is_ascii_alphanumeric() || c == '_');
            let ends_line = program[end..].starts_with('\n') && !item.insert.contains("$0");
            (is_whole && end > typed.length()).then(|| (end, open + rank + 1 + filled_in(&stops, ends_line)))
        })
        .collect()
}

/// A snippet with its lines indented as the line that it is accepted in, as editors do.
fn indented(snippet: &str, program: &str, start: usize) -> String {
    let line = &program[program[..start].rfind('\n').map_or(0, |end| end + 1)..];
    let blank = &line[..line.len() - line.trim_start_matches(' ').len()];
    snippet.replace('\n', &format!("\n{blank}"))
}

/// The keys to fill in the tab stops: matching defaults stay, everything else is typed.
fn filled_in(stops: &[Filled], ends_line: bool) -> usize {
    let mut numbers: Vec<u32> = stops.iter().map(|stop| stop.number).collect();
    numbers.sort_unstable();
    numbers.dedup();
    let first = |number: &u32| stops.iter().find(|stop| stop.number == *number);
    let changed: Vec<Option<&Filled>> =
        numbers.iter().map(|number| first(number).filter(|stop| !stop.is_default)).collect();
    let typed: usize = changed.iter().flatten().map(|stop| stop.end - stop.start).sum();
    let last_changed = changed.iter().rposition(Option::is_some).unwrap_or(0);
    let to_the_end = match numbers.len() {
        0 => 0,
        // End leaves what remains as it is.
        _ if ends_line => 1,
        count => count - last_changed,
    };
    last_changed + typed + to_the_end
}
