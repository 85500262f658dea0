//! Editor features, one file each: a database and a position in, plain structs out. Those for settings and scenes, in
//! `toml`, take a text instead.
//!
//! Knows `analysis` and the crates below it. Must never know the editors' protocol, lines and columns (positions are byte
//! offsets), the file system, or threads.

mod call_hierarchy;
mod code_lenses;
mod completion;
mod cursor;
mod definition;
mod document_links;
mod file_rename;
mod fix_all;
mod folding;
mod formatting;
mod highlights;
mod hover;
mod inlay_hints;
mod keyword_pages;
mod linked_editing;
mod on_type;
mod planned_action;
mod planned_path;
mod quick_fixes;
mod refactorings;
mod references;
mod rename;
mod selection;
mod semantic_tokens;
mod signature;
mod statements;
mod symbols;
mod toml;
mod type_definition;
mod unsettled;
mod users;
mod workspace_symbols;

#[cfg(test)]
mod fixture;

pub use call_hierarchy::{Call, CallItem, call_item, call_items, incoming_calls, outgoing_calls};
pub use code_lenses::{CodeLens, ShownLenses, code_lenses};
pub use completion::{
    Completion, CompletionKind, CompletionTrigger, Documentation, completion_documentation, completions,
};
pub use definition::{Definition, Target, goto_definition};
pub use document_links::{DocumentLink, document_links};
pub use file_rename::{FileRename, rename_files};
pub use fix_all::{codes_to_fix_all, fix_all, has_safe_fix};
pub use folding::{Fold, FoldKind, folding_ranges};
pub use formatting::{format, format_range};
pub use highlights::{Highlight, highlights};
pub use hover::{Hover, hover};
pub use inlay_hints::{InlayHint, InlayHintOptions, InlayHintPlaces, KnownMovements, inlay_hints};
pub use keyword_pages::{KeywordPage, keyword_page};
pub use linked_editing::linked_editing_ranges;
pub use on_type::{format_after_brace, format_after_line_break};
pub use planned_action::{ActionAt, NumberedAction, PlannedAt, PlannedCall, action_place, planned_at};
pub use planned_path::{
    BodySize, CollisionTarget, NoPath, Obstacle, ObstaclePath, Outline, PlannedAction, PlannedCollision,
    PlannedLeg, PlannedPath, PlannedPose, PlannedRobot, PossibleWay, SensorCone, planned_path,
};
pub use quick_fixes::{QuickFix, quick_fixes};
pub use refactorings::{Refactoring, RefactoringKind, refactorings};
pub use references::{count_mentions, declaration, references};
pub use rename::{RenameError, RenameTarget, prepare_rename, rename};
pub use selection::selection_ranges;
pub use semantic_tokens::{HighlightKind, Modifier, SemanticToken, entity_tokens, semantic_tokens};
pub use signature::{Signature, SignatureHelp, SignatureTrigger, signature_help};
pub use symbols::{Symbol, SymbolKind, document_symbols};
pub use toml::{
    KeyFix, NameInScene, SceneAction, SceneChanges, ScenePlace, TomlFile, highlights_in_scene,
    mentions_in_scenes, name_in_scene, rename_in_scenes, scene_actions, toml_completions, toml_fixes,
    toml_hover, toml_symbols,
};
pub use type_definition::goto_type_definition;
pub use unsettled::TypedStatement;
pub use workspace_symbols::{SymbolSearch, WorkspaceSymbol};

use pydslrep_analysis::FileId;

/// A position in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FilePosition {
    /// The file.
    pub file: FileId,
    /// The offset in bytes.
    pub offset: u32,
}
