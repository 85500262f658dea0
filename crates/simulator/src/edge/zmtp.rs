//! The ZeroMQ message transport protocol 3.0 (RFC 23), server side, as bytes in and messages out.
//!
//! Implements only a ROUTER socket without authentication. It is our own for two reasons:
//!
//! * The pure Rust `zeromq` crate (0.7) allocates as much memory as a frame's header announces: nine bytes from anyone abort
//!   the process. Here memory grows with the received data, and frames that announce more than [`MAX_MESSAGE`] are rejected.
//! * One port serves both this protocol and that of the legacy remote API, which the listener tells apart by the first byte
//!   of a connection. Sockets of the crate open the port themselves and take no connection that is accepted already.

use super::ProtocolError;

/// The maximum size of a message; real requests have a few hundred bytes.
const MAX_MESSAGE: usize = 1 << 20;

/// The maximum number of frames; a message with its envelope has two, and intermediate routers may add some.
const MAX_FRAMES: usize = 16;

/// The first byte of every connection in this protocol.
pub(super) const MARK: u8 = 0xff;

const GREETING_LENGTH: usize = 64;
const MECHANISM: &[u8; 20] = b"NULL\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0";

const FLAG_MORE: u8 = 1;
const FLAG_LONG: u8 = 2;
const FLAG_COMMAND: u8 = 4;

/// A received message: all frames but the last are the envelope, which the reply repeats.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Message {
    pub(super) envelope: Vec<Vec<u8>>,
    pub(super) body: Vec<u8>,
}

/// The receiving end of one connection.
#[derive(Debug, Default)]
pub(super) struct Receiver {
    buffer: Vec<u8>,
    stage: Stage,
    frames: Vec<Vec<u8>>,
    size: usize,
}

#[derive(Debug, Default, PartialEq, Eq)]
enum Stage {
    #[default]
    Greeting,
    Ready,
    Messages,
}

/// Greeting and READY, sent as soon as a connection is open. With the NULL mechanism neither depends on the peer.
pub(super) fn opening() -> Vec<u8> {
    let mut bytes = vec![MARK, 0, 0, 0, 0, 0, 0, 0, 0, 0x7f, 3, 0];
    bytes.extend_from_slice(MECHANISM);
    bytes.resize(GREETING_LENGTH, 0);
    push_frame(&mut bytes, FLAG_COMMAND, b"\x05READY\x0bSocket-Type\0\0\0\x06ROUTER");
    bytes
}

/// Encodes a reply.
pub(super) fn encode(envelope: &[Vec<u8>], body: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(body.len() + 16);
    for frame in envelope {
        push_frame(&mut bytes, FLAG_MORE, frame);
    }
    push_frame(&mut bytes, 0, body);
    bytes
}

fn push_frame(bytes: &mut Vec<u8>, flags: u8, content: &[u8]) {
    if let Ok(length) = u8::try_from(content.len()) {
        bytes.extend_from_slice(&[flags, length]);
    } else {
        bytes.push(flags | FLAG_LONG);
        bytes.extend_from_slice(&(content.len() as u64).to_be_bytes());
    }
    bytes.extend_from_slice(content);
}

impl Receiver {
    /// Returns whether the handshake is complete.
    pub(super) fn is_open(&self) -> bool {
        self.stage == Stage::Messages
    }

    /// Takes received bytes and adds complete messages to `messages`.
    pub(super) fn receive(&mut self, bytes: &[u8], messages: &mut Vec<Message>) -> Result<(), ProtocolError> {
        self.buffer.extend_from_slice(bytes);
        let mut used = 0;
        while let Some(length) = self.take(used, messages)? {
            used += length;
        }
        self.buffer.drain(..used);
        Ok(())
    }

    /// Takes one unit from the buffer at `start` and returns its length; `None` if it is incomplete.
    fn take(&mut self, start: usize, messages: &mut Vec<Message>) -> Result<Option<usize>, ProtocolError> {
        let Some(rest) = self.buffer.get(start..) else { return Ok(None) };
        if self.stage == Stage::Greeting {
            check_greeting(rest)?;
            if rest.len() < GREETING_LENGTH {
                return Ok(None);
            }
            self.stage = Stage::Ready;
            return Ok(Some(GREETING_LENGTH));
        }
        let Some((flags, from, to)) = frame(rest)? else { return Ok(None) };
        let Some(content) = rest.get(from..to) else { return Ok(None) };
        match (&self.stage, flags & FLAG_COMMAND != 0) {
            (Stage::Ready, true) => {
                check_ready(content)?;
                self.stage = Stage::Messages;
            }
            (Stage::Ready, false) => return Err(ProtocolError("a message before READY")),
            // Version 3.0 has no commands after the handshake; those of newer versions are ignored.
            (_, true) => {}
            (_, false) => {
                let content = content.to_vec();
                self.add_frame(content, flags & FLAG_MORE != 0, messages)?;
            }
        }
        Ok(Some(to))
    }

    fn add_frame(
        &mut self,
        content: Vec<u8>,
        more: bool,
        messages: &mut Vec<Message>,
    ) -> Result<(), ProtocolError> {
        self.size += content.len();
        if self.size > MAX_MESSAGE || self.frames.len() >= MAX_FRAMES {
            return Err(ProtocolError("a message that is too large"));
        }
        if more {
            self.frames.push(content);
        } else {
            self.size = 0;
            messages.push(Message { envelope: std::mem::take(&mut self.frames), body: content });
        }
        Ok(())
    }
}

/// Checks the received part of a greeting, so that other protocols are rejected at the first wrong byte.
fn check_greeting(bytes: &[u8]) -> Result<(), ProtocolError> {
    let is_wrong = |index: usize, wrong: fn(u8) -> bool| bytes.get(index).is_some_and(|&byte| wrong(byte));
    if is_wrong(0, |byte| byte != MARK) || is_wrong(9, |byte| byte != 0x7f) {
        return Err(ProtocolError("not ZeroMQ"));
    }
    if is_wrong(10, |byte| byte < 3) {
        return Err(ProtocolError("a ZeroMQ version before 3"));
    }
    if bytes.get(12..32).is_some_and(|mechanism| mechanism != MECHANISM) {
        return Err(ProtocolError("a security mechanism other than NULL"));
    }
    Ok(())
}

fn check_ready(command: &[u8]) -> Result<(), ProtocolError> {
    if command.starts_with(b"\x05READY") { Ok(()) } else { Err(ProtocolError("a command other than READY")) }
}

/// The flags and content range of the frame at the start of `bytes`; `None` while its header is incomplete.
fn frame(bytes: &[u8]) -> Result<Option<(u8, usize, usize)>, ProtocolError> {
    let Some((&flags, rest)) = bytes.split_first() else { return Ok(None) };
    if flags & !(FLAG_MORE | FLAG_LONG | FLAG_COMMAND) != 0 {
        return Err(ProtocolError("reserved bits in a frame's flags"));
    }
    let (from, length) = if flags & FLAG_LONG == 0 {
        let Some(&length) = rest.first() else { return Ok(None) };
        (2, usize::from(length))
    } else {
        let Some(length) = rest.first_chunk::<8>() else { return Ok(None) };
        (9, usize::try_from(u64::from_be_bytes(*length)).unwrap_or(usize::MAX))
    };
    if length > MAX_MESSAGE {
        return Err(ProtocolError("a frame that is too large"));
    }
    Ok(Some((flags, from, from + length)))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The bytes that libzmq's REQ socket sends before its first message.
    fn client_opening() -> Vec<u8> {
        let mut bytes = opening();
        bytes.truncate(GREETING_LENGTH);
        bytes[11] = 1;
        push_frame(&mut bytes, FLAG_COMMAND, b"\x05READY\x0bSocket-Type\0\0\0\x03REQ\x08Identity\0\0\0\0");
        bytes
    }

    fn receive_all(receiver: &mut Receiver, bytes: &[u8]) -> Result<Vec<Message>, ProtocolError> {
        let mut messages = Vec::new();
        receiver.receive(bytes, &mut messages)?;
        Ok(messages)
    }

    fn refusal(bytes: &[u8]) -> ProtocolError {
        let mut receiver = Receiver::default();
        receive_all(&mut receiver, &client_opening()).unwrap();
        receive_all(&mut receiver, bytes).unwrap_err()
    }

    #[test]
    fn a_request_with_its_envelope() {
        let mut receiver = Receiver::default();
        assert_eq!(receive_all(&mut receiver, &client_opening()), Ok(vec![]));
        assert!(receiver.is_open());
        let messages = receive_all(&mut receiver, b"\x01\x00\x00\x02hi").unwrap();
        assert_eq!(messages, [Message { envelope: vec![vec![]], body: b"hi".to_vec() }]);
        assert_eq!(encode(&messages[0].envelope, b"yes"), b"\x01\x00\x00\x03yes");
    }

    #[test]
    fn long_replies_have_long_headers() {
        let bytes = encode(&[], &[7; 300]);
        assert_eq!(bytes[..9], [FLAG_LONG, 0, 0, 0, 0, 0, 0, 1, 44]);
        assert_eq!(bytes.len(), 309);
    }

    #[test]
    fn other_protocols_are_rejected_immediately() {
        let mut receiver = Receiver::default();
        assert_eq!(receive_all(&mut receiver, b"G"), Err(ProtocolError("not ZeroMQ")));
        let mut old = client_opening();
        old[10] = 1;
        assert!(receive_all(&mut Receiver::default(), &old).is_err());
        let mut secured = client_opening();
        secured[12..17].copy_from_slice(b"CURVE");
        assert!(receive_all(&mut Receiver::default(), &secured).is_err());
    }

    #[test]
    fn announced_lengths_allocate_nothing() {
        assert_eq!(
            refusal(b"\x02\x00\x00\x7f\xff\xff\xff\xff\xff"),
            ProtocolError("a frame that is too large")
        );
        assert_eq!(
            refusal(b"\x02\xff\xff\xff\xff\xff\xff\xff\xff"),
            ProtocolError("a frame that is too large")
        );
        assert_eq!(
            refusal(&b"\x01\x00".repeat(MAX_FRAMES + 1)),
            ProtocolError("a message that is too large")
        );
        assert_eq!(refusal(b"\x08\x00"), ProtocolError("reserved bits in a frame's flags"));
        let mut most = vec![FLAG_LONG | FLAG_MORE];
        most.extend_from_slice(&(MAX_MESSAGE as u64).to_be_bytes());
        most.resize(9 + MAX_MESSAGE, 0);
        most.extend_from_slice(b"\x00\x01x");
        assert_eq!(refusal(&most), ProtocolError("a message that is too large"));
    }

    proptest! {
        #[test]
        fn arbitrary_bytes_do_not_panic(bytes in prop::collection::vec(any::<u8>(), 0..200), greet in any::<bool>()) {
            let mut receiver = Receiver::default();
            let mut messages = Vec::new();
            if greet {
                receiver.receive(&client_opening(), &mut messages).unwrap();
            }
            let _ = receiver.receive(&bytes, &mut messages);
        }

        #[test]
        fn chunking_does_not_matter(
            bodies in prop::collection::vec(prop::collection::vec(any::<u8>(), 0..400), 1..5),
            cut in 1usize..100,
        ) {
            let mut bytes = client_opening();
            for body in &bodies {
                bytes.extend(encode(&[vec![]], body));
            }
            let mut receiver = Receiver::default();
            let mut messages = Vec::new();
            for part in bytes.chunks(cut) {
                receiver.receive(part, &mut messages).unwrap();
            }
            let found: Vec<_> = messages.into_iter().map(|message| message.body).collect();
            prop_assert_eq!(found, bodies);
            prop_assert!(receiver.buffer.is_empty());
        }
    }
}
