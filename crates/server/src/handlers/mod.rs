//! One file per group of requests: plain functions of the state and the parameters, without a runtime.

pub(crate) mod call_hierarchy;
pub(crate) mod code_actions;
pub(crate) mod code_lenses;
pub(crate) mod completion;
pub(crate) mod diagnostics;
pub(crate) mod document_links;
pub(crate) mod document_symbols;
pub(crate) mod file_operations;
pub(crate) mod folding;
pub(crate) mod formatting;
pub(crate) mod hover;
pub(crate) mod inlay_hints;
pub(crate) mod navigation;
pub(crate) mod planned_path;
pub(crate) mod references;
pub(crate) mod rename;
#[cfg(feature = "process")]
pub(crate) mod runs;
pub(crate) mod scripts;
pub(crate) mod selection;
pub(crate) mod semantic_tokens;
pub(crate) mod signature;
pub(crate) mod synchronization;
pub(crate) mod workspace;
pub(crate) mod workspace_symbols;
