//! The transport of V-REP's legacy remote API: messages are split into packets with a six-byte header.
//!
//! The header holds a byte-order mark (1), the length of the data and the number of remaining packets of the message, as
//! 16-bit little-endian numbers.

use super::ProtocolError;

/// The first two bytes of every connection in this protocol.
pub(super) const MARK: [u8; 2] = [1, 0];

const HEADER: usize = 6;

/// The maximum size of sent packets including their header, as in V-REP: clients allocate by the first packet.
const MAX_SENT: usize = 1300;

/// The maximum data size of received packets; clients can be configured for longer packets than V-REP sends.
const MAX_RECEIVED: usize = 30_000;

/// The maximum size of a message; real ones have a few hundred bytes.
const MAX_MESSAGE: usize = 1 << 16;

/// The receiving end of one connection.
#[derive(Debug, Default)]
pub(super) struct Receiver {
    buffer: Vec<u8>,
    message: Vec<u8>,
    /// The number of remaining packets of the message; `None` before its first one.
    remaining: Option<u16>,
}

impl Receiver {
    /// Takes received bytes and adds complete messages to `messages`.
    pub(super) fn receive(&mut self, bytes: &[u8], messages: &mut Vec<Vec<u8>>) -> Result<(), ProtocolError> {
        self.buffer.extend_from_slice(bytes);
        let mut used = 0;
        while let Some(rest) = self.buffer.get(used..) {
            let Some(packet) = Packet::of(rest)? else { break };
            if self.remaining.is_some_and(|remaining| remaining != packet.packets_left + 1) {
                return Err(ProtocolError("packets out of order"));
            }
            if self.message.len() + packet.data.len() > MAX_MESSAGE {
                return Err(ProtocolError("a message that is too large"));
            }
            self.message.extend_from_slice(packet.data);
            used += HEADER + packet.data.len();
            self.remaining = Some(packet.packets_left).filter(|&count| count > 0);
            if self.remaining.is_none() {
                messages.push(std::mem::take(&mut self.message));
            }
        }
        self.buffer.drain(..used);
        Ok(())
    }
}

struct Packet<'a> {
    data: &'a [u8],
    packets_left: u16,
}

impl<'a> Packet<'a> {
    /// The packet at the start of `bytes`; `None` if it is incomplete. Invalid headers are rejected immediately.
    fn of(bytes: &'a [u8]) -> Result<Option<Self>, ProtocolError> {
        if !MARK.starts_with(bytes) && !bytes.starts_with(&MARK) {
            return Err(ProtocolError("not the legacy remote API, or another byte order"));
        }
        let Some(&[_, _, low, high, count_low, count_high]) = bytes.first_chunk::<HEADER>() else {
            return Ok(None);
        };
        let length = usize::from(u16::from_le_bytes([low, high]));
        let packets_left = u16::from_le_bytes([count_low, count_high]);
        if length > MAX_RECEIVED {
            return Err(ProtocolError("a packet that is too large"));
        }
        // It would exceed any message, and adding one to it would overflow.
        if packets_left == u16::MAX {
            return Err(ProtocolError("a message that is too large"));
        }
        let data = bytes.get(HEADER..HEADER + length);
        Ok(data.map(|data| Self { data, packets_left }))
    }
}

/// Encodes a message; all packets but the last have the maximum size.
pub(super) fn encode(message: &[u8]) -> Vec<u8> {
    let parts: Vec<&[u8]> = message.chunks(MAX_SENT - HEADER).collect();
    let mut bytes = Vec::with_capacity(message.len() + parts.len() * HEADER);
    for (index, part) in parts.iter().enumerate() {
        let number = |count: usize| u16::try_from(count).unwrap_or(u16::MAX).to_le_bytes();
        bytes.extend_from_slice(&MARK);
        bytes.extend_from_slice(&number(part.len()));
        bytes.extend_from_slice(&number(parts.len() - 1 - index));
        bytes.extend_from_slice(part);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn receive_all(bytes: &[u8]) -> Result<Vec<Vec<u8>>, ProtocolError> {
        let mut messages = Vec::new();
        Receiver::default().receive(bytes, &mut messages)?;
        Ok(messages)
    }

    #[test]
    fn a_message_byte_by_byte() {
        assert_eq!(encode(b"abc"), b"\x01\x00\x03\x00\x00\x00abc");
        let long = encode(&[7; 1300]);
        assert_eq!(long.len(), 1312);
        assert_eq!(
            (&long[..7], &long[1300..]),
            (&[1, 0, 0x0e, 5, 1, 0, 7][..], &[1, 0, 6, 0, 0, 0, 7, 7, 7, 7, 7, 7][..])
        );
        assert_eq!(
            receive_all(b"\x01\x00\x02\x00\x01\x00ab\x01\x00\x01\x00\x00\x00c"),
            Ok(vec![b"abc".to_vec()])
        );
    }

    #[test]
    fn other_protocols_are_rejected_at_the_first_wrong_byte() {
        for wrong in [&b"G"[..], b"\x00", b"\x01\x01", b"\xff"] {
            assert!(receive_all(wrong).is_err(), "{wrong:?}");
        }
        assert_eq!(receive_all(b"\x01"), Ok(vec![]));
    }

    #[test]
    fn announced_lengths_allocate_nothing() {
        assert_eq!(
            receive_all(b"\x01\x00\xff\xff\x00\x00"),
            Err(ProtocolError("a packet that is too large"))
        );
        assert_eq!(
            receive_all(b"\x01\x00\x00\x00\xff\xff"),
            Err(ProtocolError("a message that is too large"))
        );
        assert_eq!(
            receive_all(b"\x01\x00\x00\x00\x05\x00\x01\x00\x00\x00\x03\x00"),
            Err(ProtocolError("packets out of order"))
        );
        let flood = [&b"\x01\x00\x20\x4e\x09\x00"[..], &vec![0; 20_000]].concat();
        let mut flood: Vec<u8> = flood.repeat(4);
        for (index, count) in [9, 8, 7, 6].into_iter().enumerate() {
            flood[index * 20_006 + 4] = count;
        }
        assert_eq!(receive_all(&flood), Err(ProtocolError("a message that is too large")));
    }

    proptest! {
        #[test]
        fn arbitrary_bytes_do_not_panic(bytes in prop::collection::vec(any::<u8>(), 0..200), marked in any::<bool>()) {
            let bytes = if marked { [&MARK[..], &bytes].concat() } else { bytes };
            let _ = receive_all(&bytes);
        }

        #[test]
        fn chunking_does_not_matter(
            sent in prop::collection::vec(prop::collection::vec(any::<u8>(), 1..4000), 1..4),
            cut in 1usize..2000,
        ) {
            let bytes: Vec<u8> = sent.iter().flat_map(|message| encode(message)).collect();
            let (mut receiver, mut messages) = (Receiver::default(), Vec::new());
            for part in bytes.chunks(cut) {
                receiver.receive(part, &mut messages).unwrap();
            }
            prop_assert_eq!(messages, sent);
            prop_assert!(receiver.buffer.is_empty() && receiver.message.is_empty());
        }
    }
}
