//! Where the user is typing. The protocol has no cursor, but a change ends at the cursor, and some requests are about
//! the position it moved to.
//!
//! A change counts as typing at its end: on the line that Enter begins, on the last line of pasted text; but before a brace or
//! quote that the editor closes, and on the line in the middle where it makes two of Enter. A message with
//! several changes is typing with several cursors if all of them insert the same text; otherwise it is formatting or a
//! rename, and the cursor has not moved.

use pydslrep_syntax::{Span, offset};
use ropey::Rope;
use tower_lsp::ls_types::{Range, TextDocumentContentChangeEvent};

/// Nobody types with more cursors than this.
const MAX_CURSORS: usize = 32;

/// Where the last change was made.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Typing {
    /// The key of the document.
    pub(crate) key: String,
    /// The byte offsets of the cursors.
    places: Vec<u32>,
    /// True if the document has been saved since.
    is_saved: bool,
    /// The number of requests for completion there since.
    completions: u32,
}

/// A change of a text.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Replacement {
    /// The range replaced in the old text.
    span: Span,
    /// The length of the new text.
    length: u32,
    /// Where the cursor is in the new text.
    cursor: u32,
}

/// Where the cursor is after a text was typed, in bytes from its start.
fn cursor_in(text: &str) -> u32 {
    let breaks = text.matches('\n').count();
    let end = if matches!(text, "{}" | "\"\"") {
        1
    } else if breaks > 1 && text.trim().is_empty() {
        let before = text.rfind('\n').map_or(text, |last| &text[..last]);
        before.strip_suffix('\r').unwrap_or(before).len()
    } else {
        text.len()
    };
    offset(end)
}

/// Returns the replacements of one message; `spans` has the range of each, `None` if the whole text was sent.
pub(crate) fn replacements(
    changes: &[TextDocumentContentChangeEvent],
    spans: &[Option<Span>],
    before: &Rope,
    after: &Rope,
) -> Vec<Replacement> {
    if spans.iter().any(Option::is_none) {
        return whole(before, after).into_iter().collect();
    }
    let each = spans.iter().zip(changes);
    each.filter_map(|(span, change)| {
        let (length, cursor) = (Span::of(&change.text).len(), cursor_in(&change.text));
        Some(Replacement { span: (*span)?, length, cursor })
    })
    .collect()
}

/// The difference between two texts, as one change; clients that send whole texts may send the same text again.
fn whole(before: &Rope, after: &Rope) -> Option<Replacement> {
    let head = before.bytes().zip(after.bytes()).take_while(|(a, b)| a == b).count();
    let rest = before.len_bytes().min(after.len_bytes()) - head;
    let (old, new) = (before.bytes_at(before.len_bytes()), after.bytes_at(after.len_bytes()));
    let tail = old.reversed().zip(new.reversed()).take(rest).take_while(|(a, b)| a == b).count();
    let span = Span::new(offset(head), offset(before.len_bytes() - tail));
    let length = offset(after.len_bytes() - tail - head);
    // Not a multiple of a character, if characters share bytes.
    let text = after.get_byte_slice(head..after.len_bytes() - tail).map(|text| text.to_string());
    let cursor = text.map_or(length, |text| cursor_in(&text));
    (!span.is_empty() || length > 0).then_some(Replacement { span, length, cursor })
}

impl Typing {
    /// The state after the changes of one message to a document; `are_alike` if all of them insert the same text.
    pub(crate) fn after(
        before: Option<Self>,
        key: &str,
        changes: &[Replacement],
        are_alike: bool,
    ) -> Option<Self> {
        if changes.is_empty() {
            return before;
        }
        let is_typed = changes.len() == 1 || are_alike && changes.len() <= MAX_CURSORS;
        let stays = before.filter(|before| before.key == key && !is_typed);
        if !is_typed && stays.is_none() {
            return None;
        }
        let mut places = stays.map_or_else(Vec::new, |before| before.places);
        for Replacement { span, length, cursor } in changes {
            for place in &mut places {
                if *place >= span.end {
                    *place = *place - span.len() + length;
                } else if *place > span.start {
                    *place = span.start + length;
                }
            }
            if is_typed {
                places.push(span.start + cursor);
            }
        }
        Some(Self { key: key.to_owned(), places, is_saved: false, completions: 0 })
    }

    /// The lines being typed in, without their endings.
    pub(crate) fn lines(&self, text: &Rope) -> Vec<Span> {
        let line = |place: &u32| {
            let line = text.byte_to_line((*place as usize).min(text.len_bytes()));
            let start = text.line_to_byte(line);
            let content = text.line(line).chars().take_while(|c| !matches!(c, '\n' | '\r'));
            let end = start + content.map(char::len_utf8).sum::<usize>();
            Span::from(start..end)
        };
        self.places.iter().map(line).collect()
    }

    /// The byte offsets; none once the document is saved, because saved text counts as finished.
    pub(crate) fn unsaved_places(&self) -> &[u32] {
        if self.is_saved { &[] } else { &self.places }
    }

    /// Notes that completion is requested at an offset.
    pub(crate) fn note_completion(&mut self, key: &str, offset: u32) {
        if self.is_at(key, offset) {
            self.completions += 1;
        }
    }

    /// Returns whether the last request for completion at an offset was the first one since a change there.
    pub(crate) fn is_first_completion(&self, key: &str, offset: u32) -> bool {
        self.is_at(key, offset) && self.completions == 1
    }

    fn is_at(&self, key: &str, offset: u32) -> bool {
        self.key == key && self.places.contains(&offset)
    }

    /// Notes that a document was saved; returns whether that changes anything.
    pub(crate) fn save(&mut self, key: &str) -> bool {
        self.key == key && !std::mem::replace(&mut self.is_saved, true)
    }

    /// Returns whether a cursor on these lines of a document has left the lines being typed in.
    pub(crate) fn is_left(&self, key: &str, range: Range, text: &Rope) -> bool {
        let line_of = |place: &u32| text.byte_to_line((*place as usize).min(text.len_bytes()));
        let cursor = range.start.line as usize..=range.end.line as usize;
        self.key != key || !self.places.iter().any(|place| cursor.contains(&line_of(place)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cursor_is_before_what_the_editor_adds() {
        assert_eq!(["a", "{", "{}", "\"\"", "}"].map(cursor_in), [1, 1, 1, 1, 1]);
        assert_eq!(["\n  ", "\n  \n", "\r\n  \r\n", "a\n\nb"].map(cursor_in), [3, 3, 4, 4]);
    }
}
