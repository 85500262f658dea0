//! Matches snippets against programs.

/// A part of a snippet: text, or a tab stop with its number and default.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Part {
    Text(String),
    Stop(u32, String),
}

/// A tab stop matched with a range of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Filled {
    pub(crate) number: u32,
    /// The range in the program.
    pub(crate) start: usize,
    pub(crate) end: usize,
    /// True if it equals the default.
    pub(crate) is_default: bool,
}

fn parts(snippet: &str) -> Vec<Part> {
    let mut parts = Vec::new();
    let mut rest = snippet;
    while let Some((text, after)) = rest.split_once('$') {
        parts.push(Part::Text(text.to_owned()));
        if let Some(stop) = after.strip_prefix('{') {
            let (stop, after) = stop.split_once('}').unwrap();
            let (number, default) = stop.split_once(':').unwrap();
            parts.push(Part::Stop(number.parse().unwrap(), default.to_owned()));
            rest = after;
        } else {
            let digits = after.find(|c: char| !c.is_ascii_digit()).unwrap_or(after.len());
            parts.push(Part::Stop(after[..digits].parse().unwrap(), String::new()));
            rest = &after[digits..];
        }
    }
    parts.push(Part::Text(rest.to_owned()));
    parts
}

/// Matches a snippet with the rest of a program, at most up to its last tab stop: the end of the match, and the tab stops.
///
/// Tab stops take only names, numbers and spaces, so that one ends at the text that follows it.
pub(crate) fn matched(snippet: &str, program: &str, start: usize) -> Option<(usize, Vec<Filled>)> {
    let parts = parts(snippet);
    let mut at = start;
    let mut filled: Vec<Filled> = Vec::new();
    for (index, part) in parts.iter().enumerate() {
        match part {
            Part::Text(text) => at = program[at..].starts_with(text.as_str()).then_some(at + text.len())?,
            // The body is typed after that.
            Part::Stop(0, _) => return Some((at, filled)),
            Part::Stop(number, default) => {
                let Some(Part::Text(next)) = parts.get(index + 1) else { return None };
                let end = at + stop_length(&program[at..], next)?;
                let written = &program[at..end];
                if filled
                    .iter()
                    .any(|other| other.number == *number && &program[other.start..other.end] != written)
                {
                    return None;
                }
                filled.push(Filled { number: *number, start: at, end, is_default: written == default });
                at = end;
            }
        }
    }
    Some((at, filled))
}

fn stop_length(program: &str, next: &str) -> Option<usize> {
    let is_filling = |c: char| c.is_ascii_alphanumeric() || " ,._-^\n".contains(c);
    let longest = program.find(|c: char| !is_filling(c)).unwrap_or(program.len());
    if next.is_empty() {
        // The last stop of a line.
        return program[..longest].find('\n').or(Some(longest));
    }
    let end = program.find(next)?;
    (end <= longest).then_some(end)
}

#[test]
fn a_snippet_is_matched_with_what_is_written() {
    let program = "wheel big with radius 4.5\nwheel";
    let (end, filled) = matched("wheel ${1:wheelL} with radius ${2:4.5}", program, 0).unwrap();
    assert_eq!(&program[..end], "wheel big with radius 4.5");
    let names: Vec<_> = filled.iter().map(|stop| (&program[stop.start..stop.end], stop.is_default)).collect();
    assert_eq!(names, [("big", false), ("4.5", true)]);
    assert_eq!(matched("wheelH ${1:wheelL} with radius ${2:4.5}", program, 0), None);
}
