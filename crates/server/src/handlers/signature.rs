//! `textDocument/signatureHelp`.

use pydslrep_ide as ide;
use tower_lsp::ls_types::{
    Documentation, MarkupContent, MarkupKind, ParameterInformation, ParameterLabel, SignatureHelp,
    SignatureHelpParams, SignatureInformation,
};

use crate::state::State;

/// The shape of the statement at a position.
pub(crate) fn signature_help(state: &State, params: &SignatureHelpParams) -> Option<SignatureHelp> {
    let place = state.place(&params.text_document_position_params)?;
    let found = ide::signature_help(&state.database, place.position())?;
    let current = found.signatures.get(found.active).and_then(|signature| signature.current);
    Some(SignatureHelp {
        signatures: found.signatures.iter().map(|signature| convert(state, signature)).collect(),
        active_signature: u32::try_from(found.active).ok(),
        active_parameter: Some(index(found.signatures.get(found.active)?, current)),
    })
}

fn convert(state: &State, signature: &ide::Signature) -> SignatureInformation {
    // Labels are ASCII: an offset is the same in every unit.
    let parameter = |span: &pydslrep_syntax::Span| ParameterInformation {
        label: if state.client.label_offsets {
            ParameterLabel::LabelOffsets([span.start, span.end])
        } else {
            ParameterLabel::Simple(span.text(signature.label).to_owned())
        },
        documentation: None,
    };
    let meaning = MarkupContent { kind: MarkupKind::Markdown, value: signature.meaning.to_owned() };
    SignatureInformation {
        label: signature.label.to_owned(),
        documentation: Some(if state.client.signature_markdown {
            Documentation::MarkupContent(meaning)
        } else {
            Documentation::String(meaning.value)
        }),
        parameters: Some(signature.parts.iter().map(parameter).collect()),
        active_parameter: Some(index(signature, signature.current)),
    }
}

/// Where no part is current it is one behind the last: clients then mark none.
fn index(signature: &ide::Signature, current: Option<usize>) -> u32 {
    u32::try_from(current.unwrap_or(signature.parts.len())).unwrap_or(u32::MAX)
}
