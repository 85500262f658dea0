//! `textDocument/hover`, also as a command for robots.

use pydslrep_ide as ide;
use pydslrep_syntax::EntityKind;
use serde::Deserialize;
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::{Hover, HoverContents, HoverParams, LSPAny, MarkedString, MarkupContent, Uri};

use crate::handlers::scripts::{failure, opened};
use crate::view::View;

/// Returns the kinematics of a robot as Markdown; its argument is a [`RobotOf`].
pub(crate) const SHOW_KINEMATICS: &str = "pydslrep.showKinematics";

/// A robot of a program.
#[derive(Debug, Deserialize)]
pub(crate) struct RobotOf {
    /// The program.
    uri: Uri,
    /// The robot in it.
    robot: String,
}

/// The command [`SHOW_KINEMATICS`]: shows the text of a hover over the robot.
pub(crate) fn show_kinematics(view: &View, RobotOf { uri, robot }: &RobotOf) -> Result<Option<LSPAny>> {
    let (_, file) = opened(view, uri)?;
    let declared = view.database().declarations(file, EntityKind::Robot, &robot.as_str().into());
    let at = declared.first().map(|span| ide::FilePosition { file, offset: span.start });
    let found = at.and_then(|position| ide::hover(view.database(), position));
    let found = found.ok_or_else(|| failure(format!("there is no robot `{robot}`")))?;
    Ok(Some(found.markdown.into()))
}

/// Returns the hover at a position.
pub(crate) fn hover(view: &View, params: &HoverParams) -> Option<Hover> {
    let at = &params.text_document_position_params;
    let (document, found) = if let Some((document, file, text)) = view.toml_text(&at.text_document.uri) {
        (document, ide::toml_hover(file, &text, view.offset(document, at.position))?)
    } else {
        let place = view.place(at)?;
        (place.document, ide::hover(view.database(), place.position())?)
    };
    let contents = match &view.client.hover_format {
        Some(kind) => HoverContents::Markup(MarkupContent { kind: kind.clone(), value: found.markdown }),
        // The older form, which is Markdown by definition.
        None => HoverContents::Scalar(MarkedString::String(found.markdown)),
    };
    Some(Hover { contents, range: Some(view.range(document, found.span)) })
}
