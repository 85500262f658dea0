//! A program being typed.

use pydslrep_analysis::{Database, FileId};
use pydslrep_ide::{Completion, CompletionTrigger, FilePosition, completions};
use pydslrep_syntax::Span;

/// A program of which only the beginning is typed.
pub(crate) struct Typed<'a> {
    program: &'a str,
    database: Database,
    file: FileId,
    length: usize,
}

impl<'a> Typed<'a> {
    /// Nothing is typed yet.
    pub(crate) fn new(program: &'a str) -> Self {
        let mut database = Database::new();
        let file = database.open("a.pyr", "");
        Self { program, database, file, length: 0 }
    }

    /// How many bytes are typed.
    pub(crate) fn length(&self) -> usize {
        self.length
    }

    /// Types on, up to a byte that is not typed yet.
    pub(crate) fn type_to(&mut self, end: usize) {
        self.database.edit(self.file, Span::at(offset(self.length)), &self.program[self.length..end]);
        self.length = end;
    }

    /// What completion offers at the end of what is typed.
    pub(crate) fn offered(&self, trigger: CompletionTrigger) -> Vec<Completion> {
        let position = FilePosition { file: self.file, offset: offset(self.length) };
        completions(&self.database, position, trigger, 9.0)
    }
}

fn offset(length: usize) -> u32 {
    u32::try_from(length).unwrap()
}
