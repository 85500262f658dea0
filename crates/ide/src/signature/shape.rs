//! Shortens signatures to one line, clause by clause.

use pydslrep_syntax::Span;

use super::Signature;

/// The maximum width: editors wrap longer lines.
const WIDTH: usize = 48;

/// Replaces omitted clauses.
const MORE: &str = "...";

/// The keywords that begin a clause.
const BEGINNINGS: [&str; 9] = ["type", "with", "has", "radius", "at", "in", "until", "within", "else"];

/// The block of a statement, a clause as well.
const BLOCK: &str = "{ ACTIONS }";

/// The clauses around the current part that fit on a line.
pub(super) fn window(signature: &Signature) -> Signature {
    let label = &signature.label;
    if label.len() <= WIDTH {
        return signature.clone();
    }
    let clauses = clauses(label);
    let place = current_start(signature);
    let middle = clauses.iter().rposition(|clause| clause.start <= place).unwrap_or(0);
    let (mut first, mut last) = (middle, middle);
    let fits = |first: usize, last: usize| {
        let marks = usize::from(first > 0) + usize::from(last + 1 < clauses.len());
        let length = (clauses[last].end - clauses[first].start) as usize;
        length + marks * (MORE.len() + 1) <= WIDTH
    };
    loop {
        if last + 1 < clauses.len() && fits(first, last + 1) {
            last += 1;
        } else if first > 0 && fits(first - 1, last) {
            first -= 1;
        } else {
            break;
        }
    }
    let before = if first > 0 { format!("{MORE} ") } else { String::new() };
    let after = if last + 1 < clauses.len() { format!(" {MORE}") } else { String::new() };
    cut(signature, clauses[first].to(clauses[last]), &before, &after)
}

fn current_start(signature: &Signature) -> u32 {
    let current = signature.current.and_then(|current| signature.parts.get(current));
    current.map_or(0, |part| part.start)
}

/// The clauses of a label, without the space between them.
fn clauses(label: &str) -> Vec<Span> {
    let mut clauses: Vec<Span> = Vec::new();
    let mut start = 0;
    let is_block = |at: u32| label.get(at as usize..).is_some_and(|rest| rest.starts_with(BLOCK));
    for word in label.split(' ') {
        let span = Span::of(word).shifted(start);
        start = span.end + 1;
        let begins = BEGINNINGS.contains(&word.trim_start_matches('[')) || is_block(span.start);
        match clauses.last_mut() {
            Some(last) if !begins => *last = last.to(span),
            _ => clauses.push(span),
        }
    }
    clauses
}

/// A range of a signature's label, with text before and after it.
fn cut(signature: &Signature, range: Span, before: &str, after: &str) -> Signature {
    let is_in = |part: &Span| range.start <= part.start && part.end <= range.end;
    let parts = signature.parts.iter().filter(|part| is_in(part));
    let skipped = signature.parts.iter().take_while(|part| part.start < range.start).count();
    let moved = |offset: u32| offset - range.start + Span::of(before).len();
    Signature {
        label: format!("{before}{}{after}", range.text(&signature.label)),
        parts: parts.map(|part| Span::new(moved(part.start), moved(part.end))).collect(),
        current: signature.current.and_then(|current| current.checked_sub(skipped)),
    }
}
