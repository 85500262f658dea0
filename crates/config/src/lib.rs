//! Settings of a project: the file `pydslrep.toml`, and the same from an editor, as plain values.
//!
//! Knows the catalogue of diagnostics, whose severities can be chosen. Must never know files, folders of this machine,
//! editors and their protocol: a text or a JSON value comes in, a [`Config`] and [`Problem`]s go out.
//!
//! * [`KEYS`] is the one list of settings. What is read, the page of documentation, the JSON schema and what an editor
//!   completes are all made from it.
//! * [`Config`] is what one place says; several are merged, and [`Config::settings`] fills in the defaults.

mod config;
mod keys;
mod manual;
mod read;
mod severities;
mod values;

pub use config::{CodeLens, CodeLensConfig, Config, InlayHints, InlayHintsConfig, LensKind, Settings};
pub use keys::{KEYS, Key, tables};
pub use manual::{json_schema, manual};
pub use pydslrep_analysis::Target;
pub use pydslrep_schema::{Problem, ProblemKind};
pub use pydslrep_text::file_names::SETTINGS_FILE as FILE_NAME;
pub use severities::{Level, Severities, UnknownWord, find_rule};
pub use values::{Values, Word};

/// Under which word an editor keeps the settings.
pub const SECTION: &str = "pydslrep";
