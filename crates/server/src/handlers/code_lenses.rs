//! `textDocument/codeLens`: commands for environments, and for all other declarations how often they are used, which is
//! counted only for visible lenses.

use pydslrep_analysis::FileId;
use pydslrep_config::CodeLens as Wanted;
use pydslrep_ide as ide;
use pydslrep_syntax::EntityKind;
use serde::{Deserialize, Serialize};
use tower_lsp::jsonrpc::{Error, Result};
use tower_lsp::ls_types::{CodeLens, CodeLensParams, Command, Location, Range, Uri};

use crate::chosen::ChosenEnvironment;
use crate::client::SHOW_REFERENCES;
use crate::handlers::code_actions::GENERATE_SCRIPT;
#[cfg(feature = "process")]
use crate::handlers::runs;
use crate::positions::LineTable;
use crate::typing::Typing;
use crate::view::View;

/// The commands for an environment, with their labels. The argument of each is a [`ChosenEnvironment`].
const OF_ENVIRONMENTS: &[(IsShown, &str, &str)] = &[
    #[cfg(feature = "process")]
    (|wanted| wanted.run, "Run", runs::RUN),
    #[cfg(feature = "process")]
    (|wanted| wanted.preview, "Preview", runs::PREVIEW_PATH),
    (|wanted| wanted.generate_script, "Generate script", GENERATE_SCRIPT),
];

/// Returns whether the settings show a lens.
type IsShown = fn(&Wanted) -> bool;

/// Returns whether the references of a kind are shown; `None` for environments, which have none.
fn shows_references(wanted: &Wanted, kind: EntityKind) -> Option<bool> {
    match kind {
        EntityKind::Wheel => Some(wanted.wheels),
        EntityKind::Sensor => Some(wanted.sensors),
        EntityKind::Ip => Some(wanted.ips),
        EntityKind::Robot => Some(wanted.robots),
        EntityKind::Movement => Some(wanted.movements),
        EntityKind::Environment => None,
    }
}

/// The declaration of a lens: its data until it is visible.
#[derive(Debug, Serialize, Deserialize)]
struct LensOf {
    uri: Uri,
    #[serde(with = "crate::noun")]
    kind: EntityKind,
    name: String,
}

/// The lenses of a document, which keeps track of them.
pub(crate) fn code_lenses(view: &View, params: &CodeLensParams) -> Option<Vec<CodeLens>> {
    let uri = &params.text_document.uri;
    let document = view.document(uri)?;
    let wanted = &document.settings.code_lens;
    if let Some((which, _)) = view.driven_in(uri) {
        return Some(of_environment(&which.uri, &which.environment, Range::default(), wanted));
    }
    let typing = view.typing.as_ref().filter(|typing| typing.key == document.key);
    let typed = typing.map_or(&[][..], Typing::unsaved_places);
    let found =
        ide::code_lenses(view.database(), document.file?, typed, &mut document.memory().lenses.lock());
    let table = LineTable::new(document.text, view.client.encoding);
    let mut lenses = Vec::new();
    for lens in found {
        let range = table.range(lens.span);
        let Some(is_shown) = shows_references(wanted, lens.kind) else {
            lenses.extend(of_environment(uri, &lens.name, range, wanted));
            continue;
        };
        if is_shown {
            let data = LensOf { uri: uri.clone(), kind: lens.kind, name: lens.name.to_string() };
            lenses.push(CodeLens { range, command: None, data: serde_json::to_value(&data).ok() });
        }
    }
    Some(lenses)
}

fn of_environment(uri: &Uri, name: &str, range: Range, wanted: &Wanted) -> Vec<CodeLens> {
    let argument = serde_json::to_value(ChosenEnvironment { uri: uri.clone(), environment: name.to_owned() });
    let arguments = argument.ok().map(|argument| vec![argument]);
    OF_ENVIRONMENTS
        .iter()
        .filter(|(is_shown, ..)| is_shown(wanted))
        .map(|(_, title, command)| {
            let command = Command::new((*title).to_owned(), (*command).to_owned(), arguments.clone());
            CodeLens { range, command: Some(command), data: None }
        })
        .collect()
}

/// The references to the declarations of a file, in programs and in scenes.
fn locations(view: &View, file: FileId, kind: EntityKind, name: &str) -> Vec<Location> {
    let (database, name) = (view.database(), name.into());
    let in_programs = database.references(file, kind, &name).into_iter();
    let in_programs = in_programs.filter_map(|place| view.location(place.file, place.span));
    let first = database.definitions(file, kind, &name).first();
    let declared = first.and_then(|id| ide::declaration(database, *id));
    let in_scenes = declared.map(|position| ide::mentions_in_scenes(database, position)).unwrap_or_default();
    in_programs.chain(view.scene_locations(&in_scenes)).collect()
}

/// `codeLens/resolve`: counts the references.
pub(crate) fn resolve(view: &View, lens: &CodeLens) -> Result<CodeLens> {
    let lens = lens.clone();
    let Some(data) = &lens.data else { return Ok(lens) };
    let of: LensOf = serde_json::from_value(data.clone())
        .map_err(|error| Error::invalid_params(format!("not a lens of this server: {error}")))?;
    // A document may be closed before its lenses are resolved.
    let analysed = view.analysed(&of.uri);
    let places = analysed.map(|(_, file)| locations(view, file, of.kind, &of.name)).unwrap_or_default();
    let title = match places.len() {
        1 => "1 reference".to_owned(),
        count => format!("{count} references"),
    };
    let mut command = Command::new(title, String::new(), None);
    if view.client.show_references && !places.is_empty() {
        SHOW_REFERENCES.clone_into(&mut command.command);
        command.arguments = Some(vec![
            serde_json::to_value(&of.uri).unwrap_or_default(),
            serde_json::to_value(lens.range.start).unwrap_or_default(),
            serde_json::to_value(places).unwrap_or_default(),
        ]);
    }
    Ok(CodeLens { command: Some(command), ..lens })
}
