//! Compares the answers of two databases to all requests of an editor.
//!
//! After each edit the queries of the database itself are compared for all files: trees, names, diagnostics,
//! environments. The features of `ide`, and planned paths, are compared for the edited file, at the edit and at one of
//! its names, and after every second edit for one other file.

use std::collections::BTreeSet;
use std::fmt::Debug;

use pydslrep_analysis::{Database, Diagnostic, EntityId, EntityRef, Facts, FileId, Snapshot, plan_movement};
use pydslrep_ide::{self as ide, FilePosition};
use pydslrep_syntax::{EntityKind, Span};
use smol_str::SmolStr;

use crate::programs::PATHS;

/// The position of the user.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Focus {
    /// The edited file.
    pub(crate) file: usize,
    /// The end of the edit.
    pub(crate) offset: u32,
    /// The number of the edit.
    pub(crate) turn: usize,
}

/// An edited database and a fresh one.
struct Pair<'a> {
    edited: &'a Database,
    fresh: &'a Database,
    file: FileId,
}

impl Pair<'_> {
    /// Compares a query; the error describes the difference.
    fn same<T: PartialEq + Debug>(&self, question: &str, ask: impl Fn(&Database) -> T) -> Result<(), String> {
        agree(question, self.fresh.path(self.file), &ask(self.edited), &ask(self.fresh))
    }
}

fn agree<T: PartialEq + Debug>(question: &str, path: &str, edited: &T, fresh: &T) -> Result<(), String> {
    // NaN does not equal itself.
    if edited == fresh || format!("{edited:?}") == format!("{fresh:?}") {
        return Ok(());
    }
    let (edited, fresh) = (format!("{edited:#?}"), format!("{fresh:#?}"));
    let mut differing = edited.lines().zip(fresh.lines()).skip_while(|(edited, fresh)| edited == fresh);
    let first = differing.next().map_or(("", ""), |(edited, fresh)| (edited.trim(), fresh.trim()));
    Err(format!(
        "{question} of {path}; the first line that differs says\n  edited: {}\n  fresh:  {}\n\
         --- edited\n{edited}\n--- fresh\n{fresh}",
        first.0, first.1
    ))
}

/// The difference between two databases with the same content, if any.
pub(crate) fn compare(
    edited: &Database,
    fresh: &Database,
    files: [FileId; 4],
    focus: &Focus,
) -> Result<(), String> {
    for file in files {
        let pair = Pair { edited, fresh, file };
        text(&pair)?;
        if fresh.text(file).is_some() {
            names(&pair)?;
            environments(&pair)?;
        }
        diagnostics(&pair)?;
    }
    let other = Some(focus.turn / 2 % files.len()).filter(|_| focus.turn.is_multiple_of(2));
    for index in std::iter::once(focus.file).chain(other) {
        let pair = Pair { edited, fresh, file: files[index] };
        if fresh.text(pair.file).is_none() {
            continue;
        }
        whole_file(&pair, focus.turn)?;
        motion(&pair)?;
        if let Some(offset) = some_name(&pair, focus.turn) {
            at_name(&pair, offset)?;
        }
        if index == focus.file {
            at_name(&pair, focus.offset)?;
            at_edit(&pair, focus.offset)?;
        }
    }
    let pair = Pair { edited, fresh, file: files[0] };
    let letters = ["", "m", "wl", "r2", "E"][focus.turn % 5];
    pair.same("workspace symbols", |database| {
        let mut search = ide::SymbolSearch::new(letters);
        database.files().for_each(|file| search.add(database, file));
        search.finish(database)
    })
}

/// The difference between a snapshot and a database with the same text, if any.
pub(crate) fn compare_snapshot(snapshot: &Snapshot, then: &Database, file: FileId) -> Result<(), String> {
    let place = "a snapshot";
    agree("the text", place, &Some(snapshot.text()), &then.text(file))?;
    let kept = snapshot.entities().map(|entity| (entity.span, entity.parse));
    let same = kept.eq(then.entities(file).map(|entity| (entity.span, entity.parse)));
    if same { Ok(()) } else { Err(format!("entities of {place}")) }
}

fn text(pair: &Pair<'_>) -> Result<(), String> {
    let file = pair.file;
    pair.same("the text", |database| database.text(file).map(ToString::to_string))?;
    pair.same("the line ending", |database| database.line_ending(file))?;
    pair.same("places of entities", |database| {
        database.entities(file).map(|entity| entity.span).collect::<Vec<_>>()
    })?;
    let parses = |facts| Facts::entities(facts, file).map(|entity| entity.parse);
    if parses(pair.edited).eq(parses(pair.fresh)) {
        return Ok(());
    }
    pair.same("trees", |database| {
        database.entities(file).map(|entity| entity.parse.clone()).collect::<Vec<_>>()
    })
}

fn names(pair: &Pair<'_>) -> Result<(), String> {
    let file = pair.file;
    pair.same("imports", |database| database.imports(file).to_vec())?;
    pair.same("imported files", |database| database.imported_files(file).collect::<Vec<_>>())?;
    pair.same("importing files", |database| database.importing_files(database.path(file)))?;
    pair.same("files that import it", |database| database.importing(file))?;
    pair.same("import statements", |database| {
        let statements = database.import_statements(file).into_iter();
        statements.map(|(entity, path)| (entity.span, path)).collect::<Vec<_>>()
    })?;
    for kind in EntityKind::ALL {
        pair.same("names in sight", |database| {
            database.names_in_sight(file, kind).cloned().collect::<BTreeSet<_>>()
        })?;
        pair.same("the number of entities", |database| database.count(file, kind))?;
    }
    let mut used: Vec<(EntityKind, SmolStr)> = pair
        .fresh
        .entities(file)
        .filter_map(|entity| entity.parse.entity.as_ref())
        .flat_map(|tree| {
            let declared = tree.kind().zip(tree.name()).into_iter();
            declared
                .chain(tree.references())
                .map(|(kind, name)| (kind, name.text.clone()))
                .collect::<Vec<_>>()
        })
        .collect();
    used.sort_unstable();
    used.dedup();
    for (kind, name) in &used {
        // Resolutions are compared by location, because entity ids differ.
        pair.same("what a name means", |database| {
            let candidates = database.candidates(file, *kind, name);
            let resolved = database.resolve(file, *kind, name);
            let entity = resolved.entity().and_then(|id| database.entity(id));
            let entity = entity.map(|entity| (entity.file, entity.span));
            let is_unknown = resolved == pydslrep_analysis::Resolution::Unknown;
            (name.clone(), entity, is_unknown, places(database, &candidates), database.may_hide(file, name))
        })?;
        pair.same("references", |database| (name.clone(), database.references(file, *kind, name)))?;
        pair.same("declarations", |database| (name.clone(), database.declarations(file, *kind, name)))?;
    }
    Ok(())
}

fn places(database: &Database, ids: &[EntityId]) -> Vec<(FileId, Span)> {
    ids.iter().filter_map(|id| database.entity(*id)).map(|entity| (entity.file, entity.span)).collect()
}

fn diagnostics(pair: &Pair<'_>) -> Result<(), String> {
    let file = pair.file;
    if pair.edited.diagnostics(file) == pair.fresh.diagnostics(file) {
        return Ok(());
    }
    // Shortened for readability: a rule prints its complete manual page.
    pair.same("diagnostics", |database| {
        let plain = |it: Diagnostic| {
            (it.code(), it.severity, it.file, it.span, it.message, it.help, it.note, it.related, it.fixes)
        };
        database.diagnostics(file).into_iter().map(plain).collect::<Vec<_>>()
    })
}

fn environments(pair: &Pair<'_>) -> Result<(), String> {
    let file = pair.file;
    pair.same("environments, blocked or resolved", |database| {
        let environments = database.environments(file).into_iter();
        environments.map(|(id, name)| (name, database.environment(id))).collect::<Vec<_>>()
    })
}

/// Planned paths and inlay hints.
fn motion(pair: &Pair<'_>) -> Result<(), String> {
    let file = pair.file;
    pair.same("planned paths", |database| {
        let environments = database.environments(file).into_iter();
        environments.map(|(id, _)| ide::planned_path(database, id)).collect::<Vec<_>>()
    })?;
    pair.same("planned movements", |database| {
        let planned = |entity: EntityRef<'_>| {
            let (robot, movement) = database.movement(entity.id)?;
            Some((plan_movement(&robot, &movement).map_err(|error| error.to_string()), movement))
        };
        database.entities(file).map(planned).collect::<Vec<_>>()
    })?;
    pair.same("inlay hints", |database| {
        let places = ide::InlayHintPlaces { file, range: Span::new(0, u32::MAX), typed: &[] };
        let known = &mut ide::KnownMovements::default();
        ide::inlay_hints(database, places, ide::InlayHintOptions::default(), known)
    })
}

fn whole_file(pair: &Pair<'_>, turn: usize) -> Result<(), String> {
    let file = pair.file;
    let end = pair.fresh.text(file).map_or(0, |text| u32::try_from(text.len_bytes()).unwrap());
    let part = Span::new(end / 3, end / 2);
    pair.same("code lenses", |database| {
        ide::code_lenses(database, file, &[], &mut ide::ShownLenses::default())
    })?;
    pair.same("links", |database| ide::document_links(database, file))?;
    pair.same("quick fixes", |database| ide::quick_fixes(database, file, part))?;
    match turn % 4 {
        0 => pair.same("document symbols", |database| {
            database.snapshot(file, None).map(|snapshot| ide::document_symbols(&snapshot).collect::<Vec<_>>())
        }),
        1 => pair.same("semantic tokens", |database| {
            let whole = database.snapshot(file, None).map(|snapshot| ide::semantic_tokens(&snapshot, None));
            let part_of = database
                .snapshot(file, Some(part))
                .map(|snapshot| ide::semantic_tokens(&snapshot, Some(part)));
            (whole, part_of)
        }),
        2 => pair.same("folds", |database| {
            database.snapshot(file, None).map(|snapshot| ide::folding_ranges(&snapshot))
        }),
        _ => pair.same("formatting", |database| {
            let whole = database.snapshot(file, None).map(|snapshot| ide::format(&snapshot));
            (whole, database.snapshot(file, None).map(|snapshot| ide::format_range(&snapshot, part)))
        }),
    }
}

/// A name of the file, a different one each time.
fn some_name(pair: &Pair<'_>, turn: usize) -> Option<u32> {
    let trees = pair.fresh.entities(pair.file).filter_map(|entity| {
        let tree = entity.parse.entity.as_ref()?;
        let references = tree.references().into_iter().map(|(_, name)| name);
        let names = tree.name().into_iter().chain(references);
        Some(names.map(|name| name.span.start + entity.span.start).collect::<Vec<_>>())
    });
    let names: Vec<u32> = trees.flatten().collect();
    names.get(turn.checked_rem(names.len())?).copied()
}

fn at_name(pair: &Pair<'_>, offset: u32) -> Result<(), String> {
    let position = FilePosition { file: pair.file, offset };
    pair.same("hover", |database| ide::hover(database, position))?;
    pair.same("definition", |database| ide::goto_definition(database, position))?;
    pair.same("type definition", |database| ide::goto_type_definition(database, position))?;
    pair.same("references of the name there", |database| ide::references(database, position, true))?;
    pair.same("highlights", |database| ide::highlights(database, position))?;
    pair.same("linked editing", |database| ide::linked_editing_ranges(database, position))?;
    pair.same("rename", |database| {
        (ide::prepare_rename(database, position), ide::rename(database, position, "other"))
    })?;
    pair.same("calls", |database| calls(database, position))
}

/// A call item without its entity id, which differs.
type Item = (FileId, EntityKind, String, String, Span, Span);

/// Calls with the ranges of their references.
type Calls = Vec<(Item, Vec<Span>)>;

/// The items at a position with their incoming and outgoing calls.
fn calls(database: &Database, position: FilePosition) -> Vec<(Item, Calls)> {
    let plain = |item: &ide::CallItem| {
        (item.file, item.kind, item.name.clone(), item.detail.clone(), item.full, item.focus)
    };
    let items = ide::call_items(database, position).into_iter();
    items
        .map(|item| {
            let mut calls = ide::incoming_calls(database, &item);
            calls.extend(ide::outgoing_calls(database, &item));
            (plain(&item), calls.into_iter().map(|call| (plain(&call.item), call.ranges)).collect())
        })
        .collect()
}

fn at_edit(pair: &Pair<'_>, offset: u32) -> Result<(), String> {
    let position = FilePosition { file: pair.file, offset };
    pair.same("completions", |database| {
        ide::completions(database, position, ide::CompletionTrigger::Invoked, 9.0)
    })?;
    pair.same("signature help", |database| {
        ide::signature_help(database, position, ide::SignatureTrigger::Invoked)
    })?;
    pair.same("selection", |database| ide::selection_ranges(database, position.file, &[offset]))?;
    pair.same("formatting after a brace", |database| ide::format_after_brace(database, position))?;
    pair.same("formatting after a line break", |database| ide::format_after_line_break(database, position))
}

/// An error if the diagnostics of a file have changed although `take_touched` does not list it.
pub(crate) fn unreported(
    database: &Database,
    files: [FileId; 4],
    touched: &[FileId],
    reported: &[Vec<Diagnostic>; 4],
) -> Result<(), String> {
    let is_unreported = |(file, reported): &(FileId, &Vec<Diagnostic>)| {
        !touched.contains(file) && database.diagnostics(*file) != **reported
    };
    match files.into_iter().zip(reported).position(|pair| is_unreported(&pair)) {
        Some(index) => Err(format!("take_touched() leaves out {}, whose diagnostics changed", PATHS[index])),
        None => Ok(()),
    }
}
