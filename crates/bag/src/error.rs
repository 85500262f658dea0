//! Why a bag cannot be read or written.

use std::fmt;
use std::io;

use mcap::McapError;

/// Why a bag cannot be read or written, in words that can follow "cannot read FILE: ".
#[derive(Debug)]
pub enum BagError {
    /// The file or the device.
    Io(io::Error),
    /// The content.
    Content(String),
}

impl fmt::Display for BagError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(error) => error.fmt(formatter),
            Self::Content(what) => formatter.write_str(what),
        }
    }
}

impl std::error::Error for BagError {}

impl From<McapError> for BagError {
    fn from(error: McapError) -> Self {
        match error {
            McapError::Io(error) => Self::Io(error),
            McapError::BadMagic => Self::Content("it is not an MCAP file".to_owned()),
            // The library's own words begin with a capital.
            other => Self::Content(format!("it is damaged ({other})")),
        }
    }
}

impl From<io::Error> for BagError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}
