//! Settings of a project, from the file `pydslrep.toml` or from an editor, as plain values.
//!
//! Knows the catalogue of diagnostics, whose severities can be set. Must never know files, folders of this machine, editors
//! or their protocol: a text or a JSON value comes in, a [`Config`] and [`Problem`]s come out.
//!
//! * [`SCHEMA`] is the list of settings. The reader, the page of the documentation, the JSON schema and what editors
//!   complete all follow from it.
//! * [`Config`] holds what one place sets; several can be merged, and [`Config::settings`] fills in the defaults.

mod config;
mod folder;
mod host;
mod keys;
mod severities;

pub use config::Config;
pub use keys::{CodeLens, InlayHints, SCHEMA, Settings, SimulatorAddress};
pub use pydslrep_analysis::{Edition, Target};
pub use pydslrep_schema::{Problem, ProblemKind};
pub use pydslrep_text::file_names::SETTINGS_FILE as FILE_NAME;
pub use severities::{Level, Severities, UnknownWord, find_rule};

/// The section of an editor's settings that is ours.
pub const SECTION: &str = "pydslrep";

const EXAMPLE: &str = "\
output = \"scripts\"
generate-on-save = true

[severity]
unused-declaration = \"off\"
wheel-order = \"warning\"

[inlay-hints]
duration = false
";

/// The page of the documentation, in Markdown.
pub fn manual() -> String {
    format!(
        "# Configuration\n\n\
        A file `{FILE_NAME}` sets how the programs in its folder, and in all folders below, are checked and built. For each\n\
        program, the nearest file above it applies. Imports may lead anywhere in its folder. Nothing in it is required:\n\n\
        ```toml\n{EXAMPLE}```\n\n\
        Options of a command override the file. So do the settings of an editor, under `pydslrep`, where keys can also be\n\
        written like `generateOnSave`. Unknown keys and wrong values are reported with their location; an editor still applies\n\
        the rest, while the command stops with exit code 2.\n\n\
        Editors that support JSON schemas complete and check the file with [pydslrep.schema.json](../editors/pydslrep.schema.json).\n\n\
        {}",
        SCHEMA.page_of_keys()
    )
}

/// The JSON schema of the file, for editors that check TOML by one.
pub fn json_schema() -> serde_json::Value {
    SCHEMA.json_schema(FILE_NAME, "How the programs of a folder are checked and built by PyDSLRep.")
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use expect_test::expect_file;

    use super::*;

    #[test]
    fn the_manual_and_the_schema_are_up_to_date() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        expect_file![root.join("docs/configuration.md")].assert_eq(&manual());
        let schema = serde_json::to_string_pretty(&json_schema()).unwrap() + "\n";
        expect_file![root.join("editors/pydslrep.schema.json")].assert_eq(&schema);
    }

    #[test]
    fn the_example_is_correct() {
        let (config, problems) = Config::from_toml(EXAMPLE);
        assert_eq!((config.settings().output.as_deref(), problems), (Some("scripts"), vec![]));
    }
}
