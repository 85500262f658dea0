//! The package's files as they are in this version, and the record of what was written.

use std::collections::BTreeMap;

use pydslrep_script::runtime::{File, VERSION, files};
use pydslrep_script::sha256;
use serde::{Deserialize, Serialize};

/// The file in the package with the record of what was written.
pub(crate) const RECORD: &str = "_written.json";

/// The record of the files written into a folder, which distinguishes changes by others from an older version.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Record {
    /// The package's version.
    pub(crate) version: String,
    /// The SHA-256 of each file by its path in the package, with `/` between its parts.
    pub(crate) files: BTreeMap<String, String>,
}

impl Record {
    /// The record of this version.
    pub(crate) fn current() -> Self {
        let files = files().into_iter().map(|File { path, content }| (path.into_owned(), sha256(&content)));
        Self { version: VERSION.to_owned(), files: files.collect() }
    }

    /// `None` if it is not a record.
    pub(crate) fn parse(text: &[u8]) -> Option<Self> {
        serde_json::from_slice(text).ok()
    }

    /// As it is written.
    pub(crate) fn to_json(&self) -> String {
        // Strings and maps of them always have a form in JSON.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// Distinguishes packages, also of the same version.
    pub(crate) fn fingerprint(&self) -> String {
        sha256(self.to_json().as_bytes())
    }
}
