//! `pydslrep/explain`, a request of our own: the page of a diagnostic, for editors that show it. Described in
//! `docs/protocol.md`.

use pydslrep_config::find_rule;
use serde::{Deserialize, Serialize};
use tower_lsp::jsonrpc::{Error, Result};
use tower_lsp::ls_types::request::Request;

use crate::view::View;

/// The request.
pub(crate) enum Explain {}

impl Request for Explain {
    type Params = DiagnosticCode;
    type Result = Explanation;
    const METHOD: &'static str = "pydslrep/explain";
}

/// The diagnostic to explain.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct DiagnosticCode {
    code: String,
}

/// Its page.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Explanation {
    /// As in `docs/diagnostics`.
    markdown: String,
}

/// The page that `pydslrep explain` prints.
///
/// # Errors
///
/// If there is no such diagnostic.
pub(crate) fn explain(_: &View, of: &DiagnosticCode) -> Result<Explanation> {
    let rule = find_rule(&of.code).map_err(|unknown| Error::invalid_params(unknown.message))?;
    Ok(Explanation { markdown: rule.manual() })
}
