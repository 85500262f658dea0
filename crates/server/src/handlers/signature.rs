//! `textDocument/signatureHelp`.

use pydslrep_ide as ide;
use tower_lsp::ls_types::{
    ParameterInformation, ParameterLabel, ServerCapabilities, SignatureHelp, SignatureHelpContext,
    SignatureHelpOptions, SignatureHelpParams, SignatureHelpTriggerKind, SignatureInformation,
};

use crate::client::ClientFeatures;
use crate::view::View;

pub(crate) fn announce(server: &mut ServerCapabilities, _: &ClientFeatures) {
    server.signature_help_provider = Some(SignatureHelpOptions {
        retrigger_characters: Some([" ", ",", "{", "}"].map(str::to_owned).to_vec()),
        ..SignatureHelpOptions::default()
    });
}

/// The shape of the statement at a position.
pub(crate) fn signature_help(view: &View, params: &SignatureHelpParams) -> Option<SignatureHelp> {
    let place = view.place(&params.text_document_position_params)?;
    let trigger = trigger(params.context.as_ref())?;
    let found = ide::signature_help(view.database(), place.position(), trigger)?;
    let current = found.signatures.get(found.active).and_then(|signature| signature.current);
    Some(SignatureHelp {
        signatures: found.signatures.iter().map(|signature| convert(view, signature)).collect(),
        active_signature: u32::try_from(found.active).ok(),
        active_parameter: Some(index(found.signatures.get(found.active)?, current)),
    })
}

/// A client that gives no context asks because its user does. Typing alone never opens signature help.
fn trigger(context: Option<&SignatureHelpContext>) -> Option<ide::SignatureTrigger> {
    match context {
        Some(context) if context.trigger_kind != SignatureHelpTriggerKind::INVOKED => {
            context.is_retrigger.then_some(ide::SignatureTrigger::Retriggered)
        }
        _ => Some(ide::SignatureTrigger::Invoked),
    }
}

/// Without documentation: it is a single line next to the one being typed.
fn convert(view: &View, signature: &ide::Signature) -> SignatureInformation {
    // Labels are ASCII: offsets are the same in every unit.
    let parameter = |span: &pydslrep_syntax::Span| ParameterInformation {
        label: if view.client.label_offsets {
            ParameterLabel::LabelOffsets([span.start, span.end])
        } else {
            ParameterLabel::Simple(span.text(&signature.label).to_owned())
        },
        documentation: None,
    };
    SignatureInformation {
        label: signature.label.clone(),
        documentation: None,
        parameters: Some(signature.parts.iter().map(parameter).collect()),
        active_parameter: Some(index(signature, signature.current)),
    }
}

/// Where no part is active it is one past the last: clients then highlight none.
fn index(signature: &ide::Signature, current: Option<usize>) -> u32 {
    u32::try_from(current.unwrap_or(signature.parts.len())).unwrap_or(u32::MAX)
}
