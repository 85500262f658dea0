//! How messages of V-REP's legacy remote API travel: cut into packets of a six byte header and data.
//!
//! The header has a byte-order mark (1), the length of the data and how many packets of the message are still to come,
//! as 16-bit numbers, least significant byte first.

use super::Violation;

/// What the first two bytes of a connection are in this protocol, and in no other that is spoken here.
pub(super) const MARK: [u8; 2] = [1, 0];

const HEADER: usize = 6;

/// Packets are no longer than this with their header, as the server of V-REP has it: clients reserve by the first one.
const LONGEST_SENT: usize = 1300;

/// Clients may be set to longer packets, but not beyond this.
const LONGEST_RECEIVED: usize = 30_000;

/// Real messages have some hundred bytes.
const LARGEST_MESSAGE: usize = 1 << 16;

/// The receiving end of one connection.
#[derive(Debug, Default)]
pub(super) struct Receiver {
    buffer: Vec<u8>,
    message: Vec<u8>,
    /// Packets of the message that are still to come; `None` before its first one.
    awaited: Option<u16>,
}

impl Receiver {
    /// Takes bytes as they come and adds whole messages to `messages`.
    pub(super) fn receive(&mut self, bytes: &[u8], messages: &mut Vec<Vec<u8>>) -> Result<(), Violation> {
        self.buffer.extend_from_slice(bytes);
        let mut used = 0;
        while let Some(rest) = self.buffer.get(used..) {
            let Some(packet) = Packet::of(rest)? else { break };
            if self.awaited.is_some_and(|awaited| awaited != packet.still_to_come + 1) {
                return Err(Violation("packets out of order"));
            }
            if self.message.len() + packet.data.len() > LARGEST_MESSAGE {
                return Err(Violation("a message that is too large"));
            }
            self.message.extend_from_slice(packet.data);
            used += HEADER + packet.data.len();
            self.awaited = Some(packet.still_to_come).filter(|&count| count > 0);
            if self.awaited.is_none() {
                messages.push(std::mem::take(&mut self.message));
            }
        }
        self.buffer.drain(..used);
        Ok(())
    }
}

struct Packet<'a> {
    data: &'a [u8],
    still_to_come: u16,
}

impl<'a> Packet<'a> {
    /// The packet at the start of `bytes`; `None` when it is not all there. What is wrong is told from the header, before
    /// anything is waited for.
    fn of(bytes: &'a [u8]) -> Result<Option<Self>, Violation> {
        if !MARK.starts_with(bytes) && !bytes.starts_with(&MARK) {
            return Err(Violation("this is not the legacy remote API, or of another byte order"));
        }
        let Some(&[_, _, low, high, count_low, count_high]) = bytes.first_chunk::<HEADER>() else {
            return Ok(None);
        };
        let length = usize::from(u16::from_le_bytes([low, high]));
        let still_to_come = u16::from_le_bytes([count_low, count_high]);
        if length > LONGEST_RECEIVED {
            return Err(Violation("a packet that is too large"));
        }
        // So that adding one to it is always possible, and because it would never fit a message.
        if still_to_come == u16::MAX {
            return Err(Violation("a message that is too large"));
        }
        let data = bytes.get(HEADER..HEADER + length);
        Ok(data.map(|data| Self { data, still_to_come }))
    }
}

/// A message as it goes out: all packets but the last are equally long.
pub(super) fn encode(message: &[u8]) -> Vec<u8> {
    let parts: Vec<&[u8]> = message.chunks(LONGEST_SENT - HEADER).collect();
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

    fn receive_all(bytes: &[u8]) -> Result<Vec<Vec<u8>>, Violation> {
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
    fn strangers_are_turned_away_at_the_first_wrong_byte() {
        for wrong in [&b"G"[..], b"\x00", b"\x01\x01", b"\xff"] {
            assert!(receive_all(wrong).is_err(), "{wrong:?}");
        }
        assert_eq!(receive_all(b"\x01"), Ok(vec![]));
    }

    #[test]
    fn announced_lengths_cost_nothing() {
        assert_eq!(receive_all(b"\x01\x00\xff\xff\x00\x00"), Err(Violation("a packet that is too large")));
        assert_eq!(receive_all(b"\x01\x00\x00\x00\xff\xff"), Err(Violation("a message that is too large")));
        assert_eq!(
            receive_all(b"\x01\x00\x00\x00\x05\x00\x01\x00\x00\x00\x03\x00"),
            Err(Violation("packets out of order"))
        );
        let flood = [&b"\x01\x00\x20\x4e\x09\x00"[..], &vec![0; 20_000]].concat();
        let mut flood: Vec<u8> = flood.repeat(4);
        for (index, count) in [9, 8, 7, 6].into_iter().enumerate() {
            flood[index * 20_006 + 4] = count;
        }
        assert_eq!(receive_all(&flood), Err(Violation("a message that is too large")));
    }

    proptest! {
        #[test]
        fn any_bytes_are_survived(bytes in prop::collection::vec(any::<u8>(), 0..200), marked in any::<bool>()) {
            let bytes = if marked { [&MARK[..], &bytes].concat() } else { bytes };
            let _ = receive_all(&bytes);
        }

        #[test]
        fn it_does_not_matter_how_the_bytes_are_cut(
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
