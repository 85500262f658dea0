//! The parts of a bag, which may be compressed.

use std::io::{self, Read};

use lz4_flex::frame::FrameDecoder as Lz4;
use mcap::records::ChunkHeader;
use ruzstd::decoding::StreamingDecoder as Zstd;

use crate::BagError;

/// More than tools write at once, bytes: no file can ask for more memory than that.
const MAX_CHUNK: u64 = 1 << 30;

/// The records of a chunk.
pub(crate) fn decompress(header: &ChunkHeader, data: &[u8]) -> Result<Vec<u8>, BagError> {
    let size = header.uncompressed_size;
    if size > MAX_CHUNK {
        return Err(BagError::Content(format!(
            "a part of it has {size} bytes, of which {MAX_CHUNK} are read"
        )));
    }
    let content = match header.compression.as_str() {
        "" => Ok(data.to_vec()),
        "lz4" => all(Lz4::new(data), size),
        "zstd" => Zstd::new(data).map_err(io::Error::other).and_then(|decoder| all(decoder, size)),
        other => {
            return Err(BagError::Content(format!("it is compressed with {other}, not with zstd or lz4")));
        }
    };
    let content = content.map_err(|error| BagError::Content(format!("a part of it is damaged ({error})")))?;
    if content.len() as u64 == size {
        Ok(content)
    } else {
        Err(BagError::Content("a part of it is incomplete".to_owned()))
    }
}

fn all(decoder: impl Read, size: u64) -> io::Result<Vec<u8>> {
    let mut content = Vec::new();
    decoder.take(size).read_to_end(&mut content)?;
    Ok(content)
}
