//! Edits on top of edits, as edits of the first text.

use pydslrep_syntax::Span;

use crate::{Edit, FileId};

/// A text that was changed, as what is left of the one it was and what came in between.
#[derive(Debug)]
pub(super) struct Patch {
    /// The length of the original text, in bytes.
    len: u32,
    fragments: Vec<Fragment>,
}

#[derive(Debug)]
enum Fragment {
    /// Text that was there.
    Kept(Span),
    /// Text that came.
    New(String),
}

impl Patch {
    /// A text as it is.
    pub(super) fn of(text: &str) -> Self {
        let all = Span::of(text);
        Self { len: all.len(), fragments: vec![Fragment::Kept(all)] }
    }

    /// Changes the text; the edits are of what it is now, in its order.
    pub(super) fn apply(&mut self, edits: &[&Edit]) {
        let mut changed = Vec::with_capacity(self.fragments.len() + 2 * edits.len());
        let mut done = 0;
        for edit in edits {
            self.copy(Span::new(done, edit.span.start), &mut changed);
            changed.push(Fragment::New(edit.text.clone()));
            done = edit.span.end;
        }
        self.copy(Span::new(done, u32::MAX), &mut changed);
        self.fragments = changed;
    }

    /// The fragments of a range of the text as it is now, cut to it.
    fn copy(&self, range: Span, to: &mut Vec<Fragment>) {
        let mut start = 0;
        for fragment in &self.fragments {
            let end = start + fragment.len();
            let (from, until) = (range.start.max(start), range.end.min(end));
            if from < until {
                to.push(fragment.part(Span::new(from - start, until - start)));
            }
            start = end;
        }
    }

    /// Returns the changes, as edits of the original text.
    pub(super) fn edits(&self, file: FileId) -> Vec<Edit> {
        let mut edits = Vec::new();
        let (mut done, mut come) = (0, String::new());
        let end = Fragment::Kept(Span::at(self.len));
        for fragment in self.fragments.iter().chain([&end]) {
            match fragment {
                Fragment::New(text) => come += text,
                Fragment::Kept(span) => {
                    if done < span.start || !come.is_empty() {
                        let text = std::mem::take(&mut come);
                        edits.push(Edit { file, span: Span::new(done, span.start), text });
                    }
                    done = span.end;
                }
            }
        }
        edits
    }
}

impl Fragment {
    fn len(&self) -> u32 {
        match self {
            Self::Kept(span) => span.len(),
            Self::New(text) => Span::of(text).len(),
        }
    }

    fn part(&self, part: Span) -> Self {
        match self {
            Self::Kept(span) => Self::Kept(Span::new(span.start + part.start, span.start + part.end)),
            Self::New(text) => Self::New(part.text(text).to_owned()),
        }
    }
}
