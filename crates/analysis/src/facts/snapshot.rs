//! A file as it was at one moment, to be worked on while the database goes on.

use std::sync::Arc;

use pydslrep_syntax::{Parse, Span};
use ropey::Rope;

use crate::{CancellationToken, EntityId, EntityRef, Facts, FileId};

/// A file, or a part of it, as it was. It shares text and trees with the database, so it costs little to take and to
/// keep.
#[derive(Debug, Clone)]
pub struct Snapshot {
    file: FileId,
    text: Rope,
    start: u32,
    slots: Vec<Kept>,
    cancellation: Vec<CancellationToken>,
}

#[derive(Debug, Clone)]
struct Kept {
    entity: EntityId,
    len: u32,
    parse: Arc<Parse>,
}

impl Facts {
    /// A file as it is now, or the entities of it that touch a range; `None` for a closed file.
    pub fn snapshot(&self, file: FileId, range: Option<Span>) -> Option<Snapshot> {
        let text = self.text(file)?.clone();
        // The one that ends where the range begins touches it too.
        let (from, end) = range.map_or((0, u32::MAX), |range| (range.start.saturating_sub(1), range.end));
        let (_, start) = self.slot_at(file, from);
        let touched = self.entities_from(file, from).take_while(|entity| entity.span.start <= end);
        let keep = |entity: EntityRef<'_>| {
            let parse = Arc::clone(self.shared_parse(entity.id)?);
            Some(Kept { entity: entity.id, len: entity.span.len(), parse })
        };
        let slots = touched.filter_map(keep).collect();
        Some(Snapshot { file, text, start, slots, cancellation: Vec::new() })
    }
}

impl Snapshot {
    /// The whole text of the file.
    pub fn text(&self) -> &Rope {
        &self.text
    }

    /// A part of the text; empty where it does not fit.
    pub fn slice(&self, span: Span) -> String {
        span.slice(&self.text)
    }

    /// Its entities in the order of the text; they end early once it is [cancelled](Self::cancelled_by).
    pub fn entities(&self) -> impl Iterator<Item = EntityRef<'_>> {
        let mut at = self.start;
        self.slots.iter().take_while(|_| !self.is_cancelled()).map(move |kept| {
            let span = Span::new(at, at + kept.len);
            at = span.end;
            EntityRef { id: kept.entity, file: self.file, span, parse: &kept.parse }
        })
    }

    /// Ends work on it early once the token is cancelled, or any token it was given before.
    pub fn cancelled_by(mut self, token: CancellationToken) -> Self {
        self.cancellation.push(token);
        self
    }

    /// Returns whether work on it should stop.
    pub fn is_cancelled(&self) -> bool {
        self.cancellation.iter().any(CancellationToken::is_cancelled)
    }

    /// Returns the number of entities at the start and at the end that read as they did before, in the same order.
    pub fn unchanged_ends(&self, before: &Self) -> (usize, usize) {
        let same = |(a, b): &(&Kept, &Kept)| Arc::ptr_eq(&a.parse, &b.parse);
        let head = self.slots.iter().zip(&before.slots).take_while(same).count();
        let (ours, theirs) = (self.slots[head..].iter().rev(), before.slots[head..].iter().rev());
        (head, ours.zip(theirs).take_while(same).count())
    }

    /// Returns the number of its entities.
    pub fn len(&self) -> usize {
        self.slots.len()
    }

    /// Returns whether it has no entities, which only a part of a file can be.
    pub fn is_empty(&self) -> bool {
        self.slots.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Database;

    const TEXT: &str = "wheel a with radius 4\nsensor s\nsensor t\n";

    fn spans(snapshot: &Snapshot) -> Vec<String> {
        snapshot.entities().map(|entity| snapshot.slice(entity.span)).collect()
    }

    #[test]
    fn a_snapshot_stays_as_it_was() {
        let mut database = Database::new();
        let file = database.open("a.pyr", TEXT);
        let before = database.snapshot(file, None).unwrap();
        database.edit(file, Span::at(22), "sensor r ");
        database.edit(file, Span::at(0), "// x\n");
        assert_eq!(spans(&before).concat(), TEXT);
        let after = database.snapshot(file, None).unwrap();
        assert_eq!((after.len(), after.unchanged_ends(&before)), (before.len() + 2, (0, 1)));
        database.close(file);
        assert!(database.snapshot(file, None).is_none());
        assert_eq!(spans(&before).concat(), TEXT);
    }

    #[test]
    fn a_range_takes_what_it_touches() {
        let mut database = Database::new();
        let file = database.open("a.pyr", TEXT);
        let part = |start, end| spans(&database.snapshot(file, Some(Span::new(start, end))).unwrap());
        assert_eq!(part(25, 26), ["sensor s\n"]);
        assert_eq!(part(22, 31), ["wheel a with radius 4\n", "sensor s\n", "sensor t\n"]);
        assert_eq!(part(40, 90), ["sensor t\n"]);
    }

    #[test]
    fn cancelled_work_stops() {
        let mut database = Database::new();
        let file = database.open("a.pyr", TEXT);
        let token = CancellationToken::default();
        let snapshot = database.snapshot(file, None).unwrap().cancelled_by(token.clone());
        let mut entities = snapshot.entities();
        assert!(entities.next().is_some());
        token.cancel();
        assert!(entities.next().is_none());
    }
}
