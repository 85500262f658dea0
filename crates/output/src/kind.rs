//! What files this program writes, and how each is recognised: by its content, since a name says nothing.

use std::path::Path;

use pydslrep_files::{read_bytes, read_start};
use pydslrep_script::{Origin, origin};
use pydslrep_workspace::ReadError;
use serde_json::Value;

/// More than any script or map, bytes.
const MAX_BYTES: u64 = 64 << 20;

/// More than a line of a trace, and than what is before the mark of a picture, bytes.
const START: u64 = 64 << 10;

/// What pictures say of themselves (`picture/src/lib.rs`).
const PICTURE_MARK: &str = "Drawn by PyDSLRep";

/// How worlds begin (`scene/src/mjcf/mod.rs`).
const WORLD_MARK: &[u8] = b"<!-- A world for MuJoCo, written by PyDSLRep -->";

/// What a file that this program writes is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A script.
    Script,
    /// The steps of a run, as JSON lines.
    Trace,
    /// What robots explored, as JSON.
    Map,
    /// The result of a run, as JSON.
    Figures,
    /// A picture, as SVG or PNG.
    Picture,
    /// What happens in a run, as JSON lines.
    Events,
    /// A world for `MuJoCo`, as MJCF.
    World,
}

impl Kind {
    /// For "is not …".
    pub(crate) fn noun(self) -> &'static str {
        match self {
            Self::Script => "a generated script",
            Self::Trace => "a trace",
            Self::Map => "a map",
            Self::Figures => "the result of a run",
            Self::Picture => "a picture by PyDSLRep",
            Self::Events => "a file of events",
            Self::World => "a world by PyDSLRep",
        }
    }

    /// Whether a file is of this kind, and as this program wrote it.
    pub(crate) fn inspect(self, path: &Path) -> Result<Origin, ReadError> {
        let content = match self {
            Self::Trace | Self::Picture | Self::Events | Self::World => read_start(path, START)?,
            Self::Script | Self::Map | Self::Figures => match read_bytes(path, MAX_BYTES) {
                Err(ReadError::TooLarge) => return Ok(Origin::Foreign),
                read => read?,
            },
        };
        Ok(self.origin(&content))
    }

    fn origin(self, content: &[u8]) -> Origin {
        let is_ours = match self {
            _ if content.is_empty() => true,
            Self::Script => return origin(content),
            Self::Trace => has_keys(first_line(content), &["t", "robot", "x", "y", "theta"]),
            Self::Events => has_keys(first_line(content), &["event"]),
            Self::Map => has_keys(content, &["environment", "nodes", "edges"]),
            Self::Figures => has_keys(content, &["environment", "complete", "simulated", "robots"]),
            Self::Picture => is_picture(content),
            Self::World => content.starts_with(WORLD_MARK),
        };
        if is_ours { Origin::Generated } else { Origin::Foreign }
    }
}

fn first_line(content: &[u8]) -> &[u8] {
    content.split(|byte| *byte == b'\n').next().unwrap_or_default()
}

fn has_keys(json: &[u8], keys: &[&str]) -> bool {
    let Ok(Value::Object(found)) = serde_json::from_slice(json) else { return false };
    keys.iter().all(|key| found.contains_key(*key))
}

/// An SVG or PNG with our mark.
fn is_picture(content: &[u8]) -> bool {
    let is_one = content.starts_with(b"<svg") || content.starts_with(b"\x89PNG\r\n\x1a\n");
    is_one && content.windows(PICTURE_MARK.len()).any(|window| window == PICTURE_MARK.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kind_knows_its_own() {
        let ours: [(Kind, &str); 6] = [
            (Kind::Trace, "{\"t\": 0.05, \"robot\": \"r\", \"x\": 0, \"y\": 0, \"theta\": 0}\nand so on"),
            (Kind::Map, "{\"environment\": \"e\", \"nodes\": [], \"edges\": []}"),
            (Kind::Figures, "{\"environment\":\"e\",\"complete\":true,\"simulated\":1,\"robots\":[]}"),
            (Kind::Events, "{\"event\": \"started\"}\n{\"event\": \"note\"}"),
            (Kind::World, "<!-- A world for MuJoCo, written by PyDSLRep -->\n<mujoco/>"),
            (Kind::Picture, "<svg><!-- Drawn by PyDSLRep --></svg>"),
        ];
        for (kind, content) in ours {
            assert_eq!(kind.origin(b""), Origin::Generated);
            for (other, _) in ours {
                let expected = if other == kind { Origin::Generated } else { Origin::Foreign };
                assert_eq!(other.origin(content.as_bytes()), expected, "{content} as {other:?}");
            }
            assert_eq!(Kind::Script.origin(content.as_bytes()), Origin::Foreign);
            for foreign in [&b"wheel a with radius 4\n"[..], b"{}", b"<svg></svg>", b"\xff", b"[]\n"] {
                assert_eq!(kind.origin(foreign), Origin::Foreign, "{kind:?}");
            }
        }
    }
}
