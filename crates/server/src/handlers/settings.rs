//! The client's settings.

use pydslrep_config::SECTION;
use serde_json::Value;
use tower_lsp::ls_types::{ConfigurationItem, MessageType};

use crate::message::Outbox;
use crate::state::State;

/// Our section of the client's settings.
pub(crate) fn wanted() -> Vec<ConfigurationItem> {
    vec![ConfigurationItem { scope_uri: None, section: Some(SECTION.to_owned()) }]
}

/// Applies the client's settings, and reports their problems.
pub(crate) fn set(state: &mut State, settings: &Value, outbox: &Outbox) {
    for problem in state.set_client_settings(settings) {
        let help = problem.help.map(|help| format!(" ({help})")).unwrap_or_default();
        let message = format!("settings of PyDSLRep: {}{help}", problem.message);
        outbox.tell(MessageType::WARNING, message);
    }
}
