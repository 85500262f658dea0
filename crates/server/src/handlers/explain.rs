//! `pydslrep/explain`, a request of our own: the page of a diagnostic, for editors that show it. Described in
//! `docs/protocol.md`.

use pydslrep_config::find_rule;
use serde::{Deserialize, Serialize};
use tower_lsp::jsonrpc::{Error, Result};

/// Name of the request.
pub(crate) const EXPLAIN: &str = "pydslrep/explain";

/// Which diagnostic is meant.
#[derive(Debug, Deserialize)]
pub(crate) struct Explain {
    code: String,
}

/// Its page.
#[derive(Debug, Serialize)]
pub(crate) struct Explanation {
    /// As in `docs/diagnostics`.
    markdown: String,
}

/// The page that `pydslrep explain` prints.
///
/// # Errors
///
/// If there is no such diagnostic.
pub(crate) fn explain(of: &Explain) -> Result<Explanation> {
    let rule = find_rule(&of.code).map_err(|unknown| Error::invalid_params(unknown.message))?;
    Ok(Explanation { markdown: rule.manual() })
}
