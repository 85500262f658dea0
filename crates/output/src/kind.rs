//! The kinds of files that this program writes. Each is recognised by its content, since a name says nothing.

use std::path::Path;

use pydslrep_files::{read_bytes, read_start};
use pydslrep_script::{Origin, origin};
use pydslrep_workspace::ReadError;
use serde_json::Value;

/// The maximum size of a script or a map, bytes.
const MAX_BYTES: u64 = 64 << 20;

/// The bytes read from the start: more than a line of a trace, and more than a picture has before its mark.
const START: u64 = 64 << 10;

/// The mark of pictures (`picture/src/lib.rs`).
const PICTURE_MARK: &str = "Drawn by PyDSLRep";

/// The first bytes of bags, and the mark of ours right after them (`bag/src/lib.rs`).
const BAG_MAGIC: &[u8] = b"\x89MCAP0\r\n";
const BAG_LIBRARY: &[u8] = b"PyDSLRep";

/// The bytes of a bag up to its library, at most: a record's head, a profile and the lengths of both come before.
const BAG_HEAD: usize = 128;

/// The first bytes of worlds (`scene/src/mjcf/mod.rs`).
const WORLD_MARK: &[u8] = b"<!-- A world for MuJoCo, written by PyDSLRep -->";

/// The kind of a file that this program writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A script.
    Script,
    /// The steps of a run, as JSON lines.
    Trace,
    /// The steps of a run, as MCAP.
    Bag,
    /// The map made by exploring robots, as JSON.
    Map,
    /// The result of a run, as JSON.
    Figures,
    /// A picture, as SVG or PNG.
    Picture,
    /// The events of a run, as JSON lines.
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
            Self::Bag => "a trace by PyDSLRep",
            Self::Map => "a map",
            Self::Figures => "the result of a run",
            Self::Picture => "a picture by PyDSLRep",
            Self::Events => "a file of events",
            Self::World => "a world by PyDSLRep",
        }
    }

    /// Returns whether a file is of this kind, and as this program wrote it.
    pub(crate) fn inspect(self, path: &Path) -> Result<Origin, ReadError> {
        let content = match self {
            Self::Trace | Self::Bag | Self::Picture | Self::Events | Self::World => read_start(path, START)?,
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
            Self::Bag => is_bag(content),
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

/// An MCAP file whose header has our name.
fn is_bag(content: &[u8]) -> bool {
    let head = &content[..content.len().min(BAG_HEAD)];
    head.starts_with(BAG_MAGIC) && head.windows(BAG_LIBRARY.len()).any(|window| window == BAG_LIBRARY)
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
        let ours: [(Kind, &[u8]); 7] = [
            (Kind::Trace, b"{\"t\": 0.05, \"robot\": \"r\", \"x\": 0, \"y\": 0, \"theta\": 0}\nand so on"),
            (Kind::Map, b"{\"environment\": \"e\", \"nodes\": [], \"edges\": []}"),
            (Kind::Figures, b"{\"environment\":\"e\",\"complete\":true,\"simulated\":1,\"robots\":[]}"),
            (Kind::Events, b"{\"event\": \"started\"}\n{\"event\": \"note\"}"),
            (Kind::Bag, b"\x89MCAP0\r\n\x01\x1d\0\0\0\0\0\0\0\x04\0\0\0ros2\x0e\0\0\0PyDSLRep 0.2.0"),
            (Kind::World, b"<!-- A world for MuJoCo, written by PyDSLRep -->\n<mujoco/>"),
            (Kind::Picture, b"<svg><!-- Drawn by PyDSLRep --></svg>"),
        ];
        for (kind, content) in ours {
            assert_eq!(kind.origin(b""), Origin::Generated);
            for (other, _) in ours {
                let expected = if other == kind { Origin::Generated } else { Origin::Foreign };
                assert_eq!(other.origin(content), expected, "{kind:?} as {other:?}");
            }
            assert_eq!(Kind::Script.origin(content), Origin::Foreign);
            for foreign in
                [&b"wheel a with radius 4\n"[..], b"{}", b"<svg></svg>", b"\x89MCAP0\r\n", b"\xff", b"[]\n"]
            {
                assert_eq!(kind.origin(foreign), Origin::Foreign, "{kind:?}");
            }
        }
    }
}
