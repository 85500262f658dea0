//! Framing: `Content-Length` headers around JSON, read from a stream that may hold anything.

use std::io::{self, BufRead, BufReader, Read};

/// The longest message; a larger `Content-Length` is rejected before anything is allocated for it.
const MAX_BODY: u64 = 256 << 20;

/// The maximum number of bytes kept of a header line. Its beginning is dropped, which may be the rest of a broken message.
const MAX_LINE: usize = 4096;

/// A unit found on the stream.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Frame {
    /// The bytes of one message.
    Body(Vec<u8>),
    /// A header without a usable length; reading continues after it.
    BadHeader,
}

/// The header of a body, as read from its lines.
#[derive(Clone, Copy)]
enum Header {
    Length(u64),
    Unusable,
}

/// Cuts a byte stream into frames.
pub(crate) struct FrameReader<R> {
    input: BufReader<R>,
    /// After a bad header its body is read as header lines, and the next real header may follow without a line break.
    lost: bool,
}

impl<R: Read> FrameReader<R> {
    pub(crate) fn new(input: R) -> Self {
        Self { input: BufReader::with_capacity(1 << 16, input), lost: false }
    }

    /// Returns whether part of another message has already arrived.
    pub(crate) fn has_more(&self) -> bool {
        !self.input.buffer().is_empty()
    }

    /// The next frame; `None` at the end of the stream, even in the middle of a frame.
    pub(crate) fn next(&mut self) -> io::Result<Option<Frame>> {
        loop {
            let Some(header) = self.read_header()? else { return Ok(None) };
            match header {
                Header::Length(length) => {
                    self.lost = false;
                    let mut body =
                        Vec::with_capacity(usize::try_from(length.min(1 << 20)).unwrap_or_default());
                    let read = (&mut self.input).take(length).read_to_end(&mut body)?;
                    return Ok((read as u64 == length).then_some(Frame::Body(body)));
                }
                Header::Unusable if self.lost => {}
                Header::Unusable => {
                    self.lost = true;
                    return Ok(Some(Frame::BadHeader));
                }
            }
        }
    }

    /// Reads up to and including the empty line; `None` is the end of the stream.
    fn read_header(&mut self) -> io::Result<Option<Header>> {
        let mut header = Header::Unusable;
        let mut empty = true;
        loop {
            let Some(line) = self.read_line()? else { return Ok(None) };
            if line.is_empty() {
                // Blank lines before a header are harmless.
                if empty {
                    continue;
                }
                return Ok(Some(header));
            }
            empty = false;
            header = content_length(&line, self.lost).unwrap_or(header);
        }
    }

    /// The end of the next line, without its line ending.
    fn read_line(&mut self) -> io::Result<Option<Vec<u8>>> {
        let mut line = Vec::new();
        loop {
            let buffer = self.input.fill_buf()?;
            if buffer.is_empty() {
                return Ok(None);
            }
            let newline = buffer.iter().position(|&byte| byte == b'\n');
            let used = newline.map_or(buffer.len(), |at| at + 1);
            line.extend_from_slice(&buffer[..newline.unwrap_or(buffer.len())]);
            self.input.consume(used);
            if line.len() > MAX_LINE {
                line.drain(..line.len() - MAX_LINE);
            }
            if newline.is_some() {
                if line.last() == Some(&b'\r') {
                    line.pop();
                }
                return Ok(Some(line));
            }
        }
    }
}

/// The value of a `Content-Length` line; `None` for any other line.
fn content_length(line: &[u8], anywhere: bool) -> Option<Header> {
    const NAME: &[u8] = b"content-length:";
    let line = line.to_ascii_lowercase();
    let starts = |at: usize| line[at..].starts_with(NAME);
    let at = if anywhere { (0..line.len()).rev().find(|&at| starts(at))? } else { starts(0).then_some(0)? };
    let value = str::from_utf8(&line[at + NAME.len()..]).unwrap_or_default().trim();
    let length = if value.starts_with('+') { None } else { value.parse().ok() };
    Some(length.filter(|&length| length <= MAX_BODY).map_or(Header::Unusable, Header::Length))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn read(input: &[u8]) -> Vec<String> {
        let mut reader = FrameReader::new(input);
        let mut frames = Vec::new();
        while let Some(frame) = reader.next().unwrap() {
            frames.push(match frame {
                Frame::Body(body) => String::from_utf8(body).unwrap(),
                Frame::BadHeader => "bad".to_owned(),
            });
        }
        frames
    }

    #[test]
    fn frames_follow_each_other() {
        assert_eq!(read(b"Content-Length: 2\r\n\r\n{}Content-Length: 3\r\n\r\n{ }"), ["{}", "{ }"]);
    }

    #[test]
    fn headers_are_read_generously() {
        let input = b"content-type: application/vscode-jsonrpc; charset=utf-8\ncontent-LENGTH:2 \n\n{}";
        assert_eq!(read(input), ["{}"]);
        assert_eq!(read(b"\r\n\r\nContent-Length: 2\r\n\r\n{}"), ["{}"]);
    }

    #[test]
    fn reading_goes_on_after_a_header_without_a_usable_length() {
        for bad in ["", "-1", "x", "1 2", "99999999999", "999999999999999999999999", "0x10", "+2"] {
            let input = format!("Content-Length: {bad}\r\n\r\n{{\"a\":\"b\"}}Content-Length: 2\r\n\r\n{{}}");
            assert_eq!(read(input.as_bytes()), ["bad", "{}"], "Content-Length: {bad:?}");
        }
        assert_eq!(read(b"Nonsense: 1\r\n\r\n{}Content-Length: 2\r\n\r\n{}"), ["bad", "{}"]);
        assert_eq!(read(b"\xff\xfe\r\n\r\nContent-Length: 2\r\n\r\n{}"), ["bad", "{}"]);
    }

    #[test]
    fn a_long_line_of_garbage_hides_no_header() {
        let mut input = b"Content-Length: -1\r\n\r\n".to_vec();
        input.extend(std::iter::repeat_n(b'x', 300_000));
        input.extend(b"Content-Length: 2\r\n\r\n{}");
        assert_eq!(read(&input), ["bad", "{}"]);
    }

    #[test]
    fn the_stream_may_end_anywhere() {
        let whole = b"Content-Length: 2\r\n\r\n{}";
        for cut in 0..whole.len() {
            assert!(read(&whole[..cut]).is_empty(), "after {cut} bytes");
        }
        assert!(read(b"Content-Length: 200000000\r\n\r\n{}").is_empty());
    }

    proptest! {
        #[test]
        fn any_bytes_are_read_to_their_end(bytes: Vec<u8>) {
            let mut reader = FrameReader::new(&bytes[..]);
            while reader.next().unwrap().is_some() {}
        }

        /// Garbage swallows nothing but, if it looks like a header, what it asked for.
        #[test]
        fn a_frame_after_garbage_is_found(garbage in "[a-zA-Z{}:\\- \n\u{e9}]{0,80}") {
            let input = format!("{garbage}\r\n\r\nContent-Length: 2\r\n\r\n{{}}");
            prop_assert_eq!(read(input.as_bytes()).pop(), Some("{}".to_owned()));
        }
    }
}
