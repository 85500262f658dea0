//! Shrinks and describes a failure.

use std::fmt;

use pydslrep_syntax::lex;

use crate::answers::{self, Focus};
use crate::editing::{Change, Model};
use crate::panics::without_panic;
use crate::programs::PATHS;

/// Texts, an edit, and the difference after it.
#[derive(Debug, Clone)]
pub(crate) struct Failure {
    pub(crate) before: Model,
    pub(crate) change: Change,
    pub(crate) difference: String,
    /// True if a database that was fresh before this edit fails as well.
    is_alone: bool,
}

impl Failure {
    pub(crate) fn new(before: Model, change: Change, difference: String) -> Self {
        Self { before, change, difference, is_alone: false }
    }

    /// The same failure with as little text around the edit as possible.
    pub(crate) fn smallest(mut self) -> Self {
        let Some(difference) = differs(&self.before, &self.change) else { return self };
        (self.difference, self.is_alone) = (difference, true);
        while self.try_smaller() {}
        self
    }

    /// Removes a part if the failure remains.
    fn try_smaller(&mut self) -> bool {
        for (before, change) in smaller(&self.before, &self.change) {
            if let Some(difference) = differs(&before, &change) {
                (self.before, self.change, self.difference) = (before, change, difference);
                return true;
            }
        }
        false
    }
}

/// The difference after one edit of a fresh database.
fn differs(before: &Model, change: &Change) -> Option<String> {
    without_panic(|| compare(before, change)).err()
}

fn compare(before: &Model, change: &Change) -> Result<(), String> {
    let (mut database, files) = before.fresh(0);
    let reported = files.map(|file| database.diagnostics(file));
    database.take_touched();
    change.tell(&mut database, files);
    let mut after = before.clone();
    after.apply(change);
    let fresh = after.fresh(1).0;
    for turn in 0..4 {
        let focus = Focus { file: change.file(), offset: after.following(change), turn };
        answers::compare(&database, &fresh, files, &focus)?;
    }
    let touched = database.take_touched();
    answers::unreported(&database, files, &touched, &reported)
}

/// Variants with less around the edit: without a scene, with a closed file, or without tokens; long runs first.
fn smaller(before: &Model, change: &Change) -> Vec<(Model, Change)> {
    let mut found = Vec::new();
    for key in before.scenes.keys() {
        let mut without = before.clone();
        without.scenes.remove(key);
        found.push((without, change.clone()));
    }
    for file in 0..PATHS.len() {
        let Some(text) = &before.texts[file] else { continue };
        if file != change.file() {
            let mut without = before.clone();
            without.apply(&Change::Close { file });
            found.push((without, change.clone()));
        }
        let mut ends: Vec<usize> = lex(text).iter().map(|(_, span)| span.end as usize).collect();
        ends.insert(0, 0);
        let mut run = ends.len();
        while run > 0 {
            for window in ends.windows(run + 1).step_by(run.div_ceil(2)) {
                let (start, end) = (window[0], window[run]);
                if let Some(change) = moved(change, file, start, end) {
                    let mut shorter = before.clone();
                    shorter.texts[file] = Some([&text[..start], &text[end..]].concat());
                    found.push((shorter, change));
                }
            }
            run /= 2;
        }
    }
    found
}

/// The edit after a range of its file is removed; `None` if they touch.
fn moved(change: &Change, file: usize, start: usize, end: usize) -> Option<Change> {
    let mut moved = change.clone();
    if let Change::Edit { file: edited, span, .. } = &mut moved
        && *edited == file
    {
        let (start, end) = (u32::try_from(start).ok()?, u32::try_from(end).ok()?);
        if end < span.start {
            *span = pydslrep_syntax::Span::new(span.start - (end - start), span.end - (end - start));
        } else if start <= span.end {
            return None;
        }
    }
    Some(moved)
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (path, text) in PATHS.iter().zip(&self.before.texts) {
            match text {
                Some(text) => writeln!(f, "--- {path}\n{}", text.trim_end_matches('\n').replace('\r', "␍"))?,
                None => writeln!(f, "--- {path} is closed")?,
            }
        }
        for ((file, path), why) in &self.before.absences {
            writeln!(f, "--- {} cannot import {path}: {why:?}", PATHS[*file])?;
        }
        for ((file, environment), text) in &self.before.scenes {
            writeln!(f, "--- {environment}.scene.toml of {}\n{}", PATHS[*file], text.trim_end())?;
        }
        writeln!(f, "--- targets: {:?}", self.before.targets)?;
        match &self.change {
            Change::Edit { file, span, text } => {
                let removed = self.before.texts[*file].as_deref().unwrap_or_default();
                let removed = removed.get(span.start as usize..span.end as usize).unwrap_or("…");
                let path = PATHS[*file];
                writeln!(f, "--- the edit: at byte {} of {path}, {removed:?} becomes {text:?}", span.start)?;
            }
            other => writeln!(f, "--- the edit: {other:?}")?,
        }
        if !self.is_alone {
            writeln!(f, "--- (it takes what was done before)")?;
        }
        writeln!(f, "--- what differs: {}", self.difference)
    }
}
