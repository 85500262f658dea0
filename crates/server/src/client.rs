//! The features of the client.

use tower_lsp::ls_types::{
    ClientCapabilities, DiagnosticTag, GotoCapability, MarkupKind, ResourceOperationKind,
    SemanticTokensFullOptions, TextDocumentClientCapabilities, WorkspaceClientCapabilities,
};

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
    /// Reads them from the parameters of `initialize`.
    pub(crate) fn new(client: &ClientCapabilities) -> Self {
        let mut features = Self::default();
        let offered = client.general.as_ref().and_then(|general| general.position_encodings.as_deref());
        features.encoding = Encoding::negotiate(offered);
        if let Some(window) = &client.window {
            features.show_document = window.show_document.as_ref().is_some_and(|show| show.support);
            features.progress = window.work_done_progress == Some(true);
        }
        let commands =
            client.experimental.as_ref().and_then(|extra| extra.pointer("/commands/commands")?.as_array());
        features.show_references =
            commands.is_some_and(|commands| commands.iter().any(|command| command == SHOW_REFERENCES));
        let pages = client.experimental.as_ref().and_then(|extra| extra.pointer("/pages")?.as_str());
        features.pages = pages.map(str::to_owned);
        if let Some(workspace) = &client.workspace {
            features.read_workspace(workspace);
        }
        if let Some(document) = &client.text_document {
            features.read_diagnostics(document);
            features.read_documents(document);
        }
        features
    }

    fn read_workspace(&mut self, workspace: &WorkspaceClientCapabilities) {
        self.watched_files = workspace
            .did_change_watched_files
            .is_some_and(|watched| watched.dynamic_registration == Some(true));
        self.settings = workspace.configuration == Some(true);
        self.registers_settings = workspace
            .did_change_configuration
            .is_some_and(|settings| settings.dynamic_registration == Some(true));
        self.refreshes_inlay_hints =
            workspace.inlay_hint.as_ref().is_some_and(|hints| hints.refresh_support == Some(true));
        self.refreshes_code_lenses =
            workspace.code_lens.as_ref().is_some_and(|lenses| lenses.refresh_support == Some(true));
        self.refreshes_diagnostics =
            workspace.diagnostics.as_ref().is_some_and(|pulled| pulled.refresh_support == Some(true));
        self.applies_edits = workspace.apply_edit == Some(true);
        let Some(edit) = &workspace.workspace_edit else { return };
        let operations = edit.resource_operations.as_deref().unwrap_or_default();
        self.create_files = operations.contains(&ResourceOperationKind::Create);
        self.rename_files = operations.contains(&ResourceOperationKind::Rename);
        // Neovim lists only operations, which only versioned edits can contain.
        self.versioned_edits = edit.document_changes == Some(true) || !operations.is_empty();
    }

    fn read_diagnostics(&mut self, document: &TextDocumentClientCapabilities) {
        self.pull_diagnostics = document.diagnostic.is_some();
        if let Some(pushed) = &document.publish_diagnostics {
            self.related_information = pushed.related_information == Some(true);
            self.diagnostic_tags = pushed.tag_support.clone().map(|tags| tags.value_set).unwrap_or_default();
            self.code_description = pushed.code_description_support == Some(true);
        }
        if let Some(pulled) = &document.diagnostic {
            // Before 3.18 the protocol had these for pushed diagnostics only.
            self.related_information |= pulled.related_information == Some(true);
            if pulled.tag_support.is_some() {
                self.diagnostic_tags = vec![DiagnosticTag::UNNECESSARY, DiagnosticTag::DEPRECATED];
            }
            self.code_description |= pulled.code_description_support == Some(true);
        }
    }

    fn read_documents(&mut self, document: &TextDocumentClientCapabilities) {
        let best = |formats: Option<&Vec<MarkupKind>>| {
            let offers = |kind: &MarkupKind| formats.is_some_and(|formats| formats.contains(kind));
            [MarkupKind::Markdown, MarkupKind::PlainText].into_iter().find(offers)
        };
        self.hover_format = best(document.hover.as_ref().and_then(|hover| hover.content_format.as_ref()));
        if let Some(item) =
            document.completion.as_ref().and_then(|completion| completion.completion_item.as_ref())
        {
            self.completion_format = best(item.documentation_format.as_ref());
            self.snippets = item.snippet_support == Some(true);
            self.resolve_completions = item
                .resolve_support
                .as_ref()
                .is_some_and(|support| support.properties.iter().any(|property| property == "documentation"));
        }
        let links = |goto: Option<&GotoCapability>| goto.is_some_and(|goto| goto.link_support == Some(true));
        self.definition_links = links(document.definition.as_ref());
        self.declaration_links = links(document.declaration.as_ref());
        self.type_definition_links = links(document.type_definition.as_ref());
        self.link_tooltips =
            document.document_link.as_ref().is_some_and(|link| link.tooltip_support == Some(true));
        self.prepare_rename =
            document.rename.as_ref().is_some_and(|rename| rename.prepare_support == Some(true));
        self.token_deltas = document.semantic_tokens.as_ref().is_some_and(|tokens| {
            matches!(tokens.requests.full, Some(SemanticTokensFullOptions::Delta { delta: Some(true) }))
        });
        self.symbol_tree = document
            .document_symbol
            .as_ref()
            .is_some_and(|symbols| symbols.hierarchical_document_symbol_support == Some(true));
        if let Some(signature) =
            document.signature_help.as_ref().and_then(|help| help.signature_information.as_ref())
        {
            let parameter = signature.parameter_information.as_ref();
            self.label_offsets =
                parameter.is_some_and(|parameter| parameter.label_offset_support == Some(true));
        }
        self.line_folding_only =
            document.folding_range.as_ref().is_some_and(|folding| folding.line_folding_only == Some(true));
        if let Some(action) = &document.code_action {
            self.action_literals = action.code_action_literal_support.is_some();
            self.disabled_actions = action.disabled_support == Some(true);
            self.resolve_edits = action.data_support == Some(true)
                && action
                    .resolve_support
                    .as_ref()
                    .is_some_and(|support| support.properties.iter().any(|property| property == "edit"));
        }
    }
}
