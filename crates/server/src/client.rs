//! The features of the client.

use serde::Deserialize;
use serde_json::Value;
use tower_lsp::ls_types::{ClientCapabilities, DiagnosticTag, MarkupKind};

use crate::positions::Encoding;

/// The client's command that lists references; its arguments are a URI, a position and locations. A client that has it
/// lists it in `capabilities.experimental.commands.commands`.
pub(crate) const SHOW_REFERENCES: &str = "pydslrep.showReferences";

/// The client's capabilities that change our answers, each off unless the client announces it.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "each is an independent yes or no of the protocol")]
pub(crate) struct ClientFeatures {
    /// The unit in which it counts columns.
    pub(crate) encoding: Encoding,
    /// It pulls diagnostics; then they are not pushed.
    pub(crate) pull_diagnostics: bool,
    /// It shows related locations of a diagnostic; otherwise they are part of the message.
    pub(crate) related_information: bool,
    /// The renderings of a diagnostic's text that it supports: unnecessary, deprecated.
    pub(crate) diagnostic_tags: Vec<DiagnosticTag>,
    /// It links a diagnostic's code to its page.
    pub(crate) code_description: bool,
    /// The format of hovers, if it names one.
    pub(crate) hover_format: Option<MarkupKind>,
    /// The format of a completion's documentation, if it names one.
    pub(crate) completion_format: Option<MarkupKind>,
    /// Completions may be snippets.
    pub(crate) snippets: bool,
    /// It requests the documentation of a completion when it shows it.
    pub(crate) resolve_completions: bool,
    /// Definitions may include the range that leads to them.
    pub(crate) definition_links: bool,
    /// The same for declarations.
    pub(crate) declaration_links: bool,
    /// The same for type definitions.
    pub(crate) type_definition_links: bool,
    /// Document links may have tooltips.
    pub(crate) link_tooltips: bool,
    /// It prepares a rename before it prompts for the new name.
    pub(crate) prepare_rename: bool,
    /// Document symbols may be a tree.
    pub(crate) symbol_tree: bool,
    /// Parameters of a signature may be offsets into its label.
    pub(crate) label_offsets: bool,
    /// It has the command that lists references.
    pub(crate) show_references: bool,
    /// It folds whole lines only.
    pub(crate) line_folding_only: bool,
    /// Code actions may be more than commands.
    pub(crate) action_literals: bool,
    /// It shows disabled code actions, with the reason.
    pub(crate) disabled_actions: bool,
    /// An action's edit may be resolved when the action is chosen.
    pub(crate) resolve_edits: bool,
    /// Edits may name the version of their document.
    pub(crate) versioned_edits: bool,
    /// It applies edits that it is sent.
    pub(crate) applies_edits: bool,
    /// Edits may create files.
    pub(crate) create_files: bool,
    /// Edits may rename files.
    pub(crate) rename_files: bool,
    /// It takes deltas of semantic tokens.
    pub(crate) token_deltas: bool,
    /// It can notify of changed files.
    pub(crate) watched_files: bool,
    /// Its settings can be requested.
    pub(crate) settings: bool,
    /// It can notify of changed settings.
    pub(crate) registers_settings: bool,
    /// It shows progress.
    pub(crate) progress: bool,
    /// It can be asked to pull diagnostics again.
    pub(crate) refreshes_diagnostics: bool,
    /// It can be asked to request inlay hints again.
    pub(crate) refreshes_inlay_hints: bool,
    /// It can be asked to request code lenses again.
    pub(crate) refreshes_code_lenses: bool,
    /// It can be asked to show a file.
    pub(crate) show_document: bool,
    /// It shows the pages of diagnostics itself, under URIs with this scheme.
    pub(crate) pages: Option<String>,
}

impl ClientFeatures {
    /// Reads them from the parameters of `initialize`, each at its path in the protocol.
    pub(crate) fn new(client: &ClientCapabilities) -> Self {
        let offered = client.general.as_ref().and_then(|general| general.position_encodings.as_deref());
        let encoding = Encoding::negotiate(offered);
        let client = serde_json::to_value(client).unwrap_or_default();
        let has = |path: &str| client.pointer(path).is_some();
        let can = |path: &str| client.pointer(path) == Some(&Value::Bool(true));
        let list = |path: &str| client.pointer(path).and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
        let lists = |path: &str, word: &str| list(path).iter().any(|other| other == word);
        let best_format = |path: &str| {
            let formats = [("markdown", MarkupKind::Markdown), ("plaintext", MarkupKind::PlainText)];
            formats.into_iter().find(|(word, _)| lists(path, word)).map(|(_, format)| format)
        };
        let pushed_tags = client.pointer("/textDocument/publishDiagnostics/tagSupport/valueSet");
        let pushed_tags = pushed_tags.and_then(|tags| Vec::deserialize(tags).ok()).unwrap_or_default();
        let all_tags = || vec![DiagnosticTag::UNNECESSARY, DiagnosticTag::DEPRECATED];
        let operations = "/workspace/workspaceEdit/resourceOperations";
        Self {
            encoding,
            pull_diagnostics: has("/textDocument/diagnostic"),
            // Before 3.18 the protocol had this, tags and descriptions of codes for pushed diagnostics only.
            related_information: can("/textDocument/publishDiagnostics/relatedInformation")
                || can("/textDocument/diagnostic/relatedInformation"),
            diagnostic_tags: if has("/textDocument/diagnostic/tagSupport") {
                all_tags()
            } else {
                pushed_tags
            },
            code_description: can("/textDocument/publishDiagnostics/codeDescriptionSupport")
                || can("/textDocument/diagnostic/codeDescriptionSupport"),
            hover_format: best_format("/textDocument/hover/contentFormat"),
            completion_format: best_format("/textDocument/completion/completionItem/documentationFormat"),
            snippets: can("/textDocument/completion/completionItem/snippetSupport"),
            resolve_completions: lists(
                "/textDocument/completion/completionItem/resolveSupport/properties",
                "documentation",
            ),
            definition_links: can("/textDocument/definition/linkSupport"),
            declaration_links: can("/textDocument/declaration/linkSupport"),
            type_definition_links: can("/textDocument/typeDefinition/linkSupport"),
            link_tooltips: can("/textDocument/documentLink/tooltipSupport"),
            prepare_rename: can("/textDocument/rename/prepareSupport"),
            symbol_tree: can("/textDocument/documentSymbol/hierarchicalDocumentSymbolSupport"),
            label_offsets: can(
                "/textDocument/signatureHelp/signatureInformation/parameterInformation/labelOffsetSupport",
            ),
            show_references: lists("/experimental/commands/commands", SHOW_REFERENCES),
            line_folding_only: can("/textDocument/foldingRange/lineFoldingOnly"),
            action_literals: has("/textDocument/codeAction/codeActionLiteralSupport"),
            disabled_actions: can("/textDocument/codeAction/disabledSupport"),
            resolve_edits: can("/textDocument/codeAction/dataSupport")
                && lists("/textDocument/codeAction/resolveSupport/properties", "edit"),
            // Neovim lists only operations, which only versioned edits can contain.
            versioned_edits: can("/workspace/workspaceEdit/documentChanges") || !list(operations).is_empty(),
            applies_edits: can("/workspace/applyEdit"),
            create_files: lists(operations, "create"),
            rename_files: lists(operations, "rename"),
            token_deltas: can("/textDocument/semanticTokens/requests/full/delta"),
            watched_files: can("/workspace/didChangeWatchedFiles/dynamicRegistration"),
            settings: can("/workspace/configuration"),
            registers_settings: can("/workspace/didChangeConfiguration/dynamicRegistration"),
            progress: can("/window/workDoneProgress"),
            refreshes_diagnostics: can("/workspace/diagnostics/refreshSupport"),
            refreshes_inlay_hints: can("/workspace/inlayHint/refreshSupport"),
            refreshes_code_lenses: can("/workspace/codeLens/refreshSupport"),
            show_document: can("/window/showDocument/support"),
            pages: client.pointer("/experimental/pages").and_then(Value::as_str).map(str::to_owned),
        }
    }

    /// Corrects what a client, by its name, announces wrongly.
    pub(crate) fn correct(&mut self, client: &str) {
        match client {
            // It shows documents without announcing it.
            "helix" => self.show_document = true,
            // Neovim (up to 0.12) pulls the diagnostics of an open document only after edits in that document; those
            // about what another file says would never change.
            "Neovim" => {
                self.pull_diagnostics = false;
                self.refreshes_diagnostics = false;
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn features(client: Value) -> ClientFeatures {
        ClientFeatures::new(&serde_json::from_value(client).unwrap())
    }

    #[test]
    fn a_client_without_capabilities_has_no_features() {
        assert_eq!(features(json!({})), ClientFeatures::default());
    }

    /// Each path is one that the framework's types have.
    #[test]
    fn a_client_with_all_capabilities_has_all_features() {
        let item = json!({
            "documentationFormat": ["plaintext"],
            "snippetSupport": true,
            "resolveSupport": { "properties": ["detail", "documentation"] },
        });
        let label = json!({ "parameterInformation": { "labelOffsetSupport": true } });
        let action = json!({
            "codeActionLiteralSupport": { "codeActionKind": { "valueSet": [] } },
            "disabledSupport": true,
            "dataSupport": true,
            "resolveSupport": { "properties": ["edit"] },
        });
        let document = json!({
            "publishDiagnostics": {
                "relatedInformation": true,
                "codeDescriptionSupport": true,
                "tagSupport": { "valueSet": [2] },
            },
            "hover": { "contentFormat": ["plaintext", "markdown"] },
            "completion": { "completionItem": item },
            "definition": { "linkSupport": true },
            "declaration": { "linkSupport": true },
            "typeDefinition": { "linkSupport": true },
            "documentLink": { "tooltipSupport": true },
            "rename": { "prepareSupport": true },
            "documentSymbol": { "hierarchicalDocumentSymbolSupport": true },
            "signatureHelp": { "signatureInformation": label },
            "foldingRange": { "lineFoldingOnly": true },
            "codeAction": action,
            "semanticTokens": {
                "requests": { "full": { "delta": true } },
                "tokenTypes": [], "tokenModifiers": [], "formats": [],
            },
        });
        let workspace = json!({
            "applyEdit": true,
            "workspaceEdit": { "resourceOperations": ["create", "rename"] },
            "didChangeWatchedFiles": { "dynamicRegistration": true },
            "configuration": true,
            "didChangeConfiguration": { "dynamicRegistration": true },
            "diagnostics": { "refreshSupport": true },
            "inlayHint": { "refreshSupport": true },
            "codeLens": { "refreshSupport": true },
        });
        let mut client = json!({
            "general": { "positionEncodings": ["utf-8", "utf-16"] },
            "window": { "workDoneProgress": true, "showDocument": { "support": true } },
            "experimental": { "commands": { "commands": [SHOW_REFERENCES] }, "pages": "pages" },
            "textDocument": document,
            "workspace": workspace,
        });
        let all = ClientFeatures {
            encoding: Encoding::Utf8,
            pull_diagnostics: false,
            related_information: true,
            diagnostic_tags: vec![DiagnosticTag::DEPRECATED],
            code_description: true,
            hover_format: Some(MarkupKind::Markdown),
            completion_format: Some(MarkupKind::PlainText),
            snippets: true,
            resolve_completions: true,
            definition_links: true,
            declaration_links: true,
            type_definition_links: true,
            link_tooltips: true,
            prepare_rename: true,
            symbol_tree: true,
            label_offsets: true,
            show_references: true,
            line_folding_only: true,
            action_literals: true,
            disabled_actions: true,
            resolve_edits: true,
            versioned_edits: true,
            applies_edits: true,
            create_files: true,
            rename_files: true,
            token_deltas: true,
            watched_files: true,
            settings: true,
            registers_settings: true,
            progress: true,
            refreshes_diagnostics: true,
            refreshes_inlay_hints: true,
            refreshes_code_lenses: true,
            show_document: true,
            pages: Some("pages".to_owned()),
        };
        assert_eq!(features(client.clone()), all);
        let pulled = json!({
            "relatedInformation": true,
            "codeDescriptionSupport": true,
            "tagSupport": { "valueSet": [] },
        });
        client["textDocument"]["publishDiagnostics"] = Value::Null;
        client["textDocument"]["diagnostic"] = pulled;
        let diagnostic_tags = vec![DiagnosticTag::UNNECESSARY, DiagnosticTag::DEPRECATED];
        assert_eq!(features(client), ClientFeatures { pull_diagnostics: true, diagnostic_tags, ..all });
    }

    #[test]
    fn what_some_clients_announce_is_corrected() {
        let corrected = |name: &str, mut features: ClientFeatures| {
            features.correct(name);
            features
        };
        let pulls = ClientFeatures {
            pull_diagnostics: true,
            refreshes_diagnostics: true,
            ..ClientFeatures::default()
        };
        assert_eq!(corrected("Neovim", pulls.clone()), ClientFeatures::default());
        assert_eq!(corrected("Visual Studio Code", pulls.clone()), pulls);
        let shows = ClientFeatures { show_document: true, ..ClientFeatures::default() };
        assert_eq!(corrected("helix", ClientFeatures::default()), shows);
    }
}
