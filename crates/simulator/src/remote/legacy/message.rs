//! Messages of the legacy remote API: an 18-byte header, then commands, each with a 26-byte header, a key that
//! distinguishes it from others of its kind, and a payload. Numbers are little-endian.

const VERSION: u8 = 11;
const HEADER: usize = 18;
const COMMAND_HEADER: usize = 26;

/// The status bit of a command that failed.
const FAILED: u8 = 1;

/// A message from a client.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Message {
    pub(super) id: i32,
    /// Returned unchanged: clients measure latency with it.
    pub(super) client_time: i32,
    pub(super) commands: Vec<Command>,
}

/// A command of a client.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Command {
    pub(super) name: Name,
    pub(super) mode: u16,
    /// For streams: the minimum time between replies, milliseconds.
    pub(super) period: u16,
    pub(super) payload: Vec<u8>,
}

/// The identity of a command, which its replies repeat: its kind and key.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Name {
    pub(super) kind: u16,
    pub(super) key: Vec<u8>,
}

/// Operation modes, the high half of a command's number. The others are internal to clients or split commands.
pub(super) mod mode {
    pub(in super::super) const ONESHOT: u16 = 0;
    pub(in super::super) const BLOCKING: u16 = 1;
    pub(in super::super) const STREAMING: u16 = 2;
    pub(in super::super) const DISCONTINUE: u16 = 5;
}

/// An invalid message; the connection cannot be used any more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Malformed;

impl Message {
    /// Reads a message.
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, Malformed> {
        let header = bytes.get(..HEADER).ok_or(Malformed)?;
        if header[2] != VERSION {
            return Err(Malformed);
        }
        let (id, client_time) = (number(header, 3).ok_or(Malformed)?, number(header, 7).ok_or(Malformed)?);
        let mut commands = Vec::new();
        let mut rest = &bytes[HEADER..];
        while !rest.is_empty() {
            let (command, size) = Command::parse(rest).ok_or(Malformed)?;
            commands.push(command);
            rest = &rest[size..];
        }
        Ok(Self { id, client_time, commands })
    }
}

impl Command {
    /// The command at the start of `bytes` and its size there.
    fn parse(bytes: &[u8]) -> Option<(Self, usize)> {
        let size = usize::try_from(number(bytes, 0)?).ok()?;
        let key_size = usize::from(u16::from_le_bytes(*bytes.get(8..10)?.first_chunk()?));
        let [kind, mode] =
            [14, 16].map(|at| bytes.get(at..at + 2)?.first_chunk().map(|two| u16::from_le_bytes(*two)));
        let period = u16::from_le_bytes(*bytes.get(18..20)?.first_chunk()?);
        let content = bytes.get(COMMAND_HEADER..size)?;
        let (key, payload) = content.split_at_checked(key_size)?;
        let name = Name { kind: kind?, key: key.to_vec() };
        Some((Self { name, mode: mode?, period, payload: payload.to_vec() }, size))
    }
}

/// The integer at an offset.
pub(super) fn number(bytes: &[u8], at: usize) -> Option<i32> {
    bytes.get(at..)?.first_chunk().map(|four| i32::from_le_bytes(*four))
}

/// The float at an offset.
pub(super) fn fraction(bytes: &[u8], at: usize) -> Option<f64> {
    bytes.get(at..)?.first_chunk().map(|four| f64::from(f32::from_le_bytes(*four)))
}

/// The result of a command.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Outcome {
    pub(super) payload: Vec<u8>,
    pub(super) failed: bool,
}

impl Outcome {
    pub(super) fn done() -> Self {
        Self::default()
    }

    pub(super) fn failure() -> Self {
        Self { failed: true, ..Self::default() }
    }

    pub(super) fn number(value: i32) -> Self {
        Self { payload: value.to_le_bytes().to_vec(), failed: false }
    }

    pub(super) fn fractions(values: impl IntoIterator<Item = f64>) -> Self {
        #[allow(clippy::cast_possible_truncation)] // the protocol has single precision
        let payload = values.into_iter().flat_map(|value| (value as f32).to_le_bytes()).collect();
        Self { payload, failed: false }
    }

    pub(super) fn but_failed(self) -> Self {
        Self { failed: true, ..self }
    }
}

/// A reply under construction.
#[derive(Debug)]
pub(super) struct Reply {
    bytes: Vec<u8>,
    /// Simulation time in milliseconds, for the commands.
    time: i32,
}

impl Reply {
    pub(super) fn new(client_time: i32, server_time: i32, simulation_time: i32) -> Self {
        let mut bytes = vec![0, 0, VERSION];
        // No command has been executed yet.
        bytes.extend_from_slice(&(-1_i32).to_le_bytes());
        bytes.extend_from_slice(&client_time.to_le_bytes());
        bytes.extend_from_slice(&server_time.to_le_bytes());
        bytes.extend_from_slice(&[0; 3]);
        Self { bytes, time: simulation_time }
    }

    /// Adds the result of a command.
    pub(super) fn add(&mut self, name: &Name, mode: u16, outcome: &Outcome) {
        let size = COMMAND_HEADER + name.key.len() + outcome.payload.len();
        let size = i32::try_from(size).unwrap_or(i32::MAX).to_le_bytes();
        self.bytes.extend_from_slice(&size);
        self.bytes.extend_from_slice(&size);
        self.bytes.extend_from_slice(&u16::try_from(name.key.len()).unwrap_or(u16::MAX).to_le_bytes());
        self.bytes.extend_from_slice(&[0; 4]);
        self.bytes.extend_from_slice(&name.kind.to_le_bytes());
        self.bytes.extend_from_slice(&mode.to_le_bytes());
        self.bytes.extend_from_slice(&[0; 2]);
        self.bytes.extend_from_slice(&self.time.to_le_bytes());
        self.bytes.extend_from_slice(&[if outcome.failed { FAILED } else { 0 }, 0]);
        self.bytes.extend_from_slice(&name.key);
        self.bytes.extend_from_slice(&outcome.payload);
    }

    /// The bytes of the reply. `state` is the server's state after all commands. The message's `id` is only included if
    /// a command was executed.
    pub(super) fn finish(mut self, id: i32, state: u8) -> Vec<u8> {
        if self.bytes.len() > HEADER {
            self.bytes[3..7].copy_from_slice(&id.to_le_bytes());
        }
        self.bytes[17] = state;
        self.bytes
    }
}
