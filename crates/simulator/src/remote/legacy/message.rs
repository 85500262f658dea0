//! Messages of the legacy remote API: a header of 18 bytes, then commands, each with a header of 26 bytes, a key that
//! tells it from others of its kind, and a payload. Numbers have their least significant byte first.

const VERSION: u8 = 11;
const HEADER: usize = 18;
const COMMAND_HEADER: usize = 26;

/// The status bit of a command that failed.
const FAILED: u8 = 1;

/// A message from a client.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Message {
    pub(super) id: i32,
    /// Goes back as it came: clients measure with it.
    pub(super) client_time: i32,
    pub(super) commands: Vec<Command>,
}

/// What a client wants to have done.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Command {
    pub(super) name: Name,
    pub(super) mode: u16,
    /// For streams: milliseconds from one reply to the next.
    pub(super) period: u16,
    pub(super) payload: Vec<u8>,
}

/// What replies are filed by: the kind of a command and its key.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Name {
    pub(super) kind: u16,
    pub(super) key: Vec<u8>,
}

/// Operation modes, the high half of a command's number. Others than these are of clients only, or come in pieces.
pub(super) mod mode {
    pub(in super::super) const ONESHOT: u16 = 0;
    pub(in super::super) const BLOCKING: u16 = 1;
    pub(in super::super) const STREAMING: u16 = 2;
    pub(in super::super) const DISCONTINUE: u16 = 5;
}

/// Not a message, so the connection is of no use any more.
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

/// The whole number at that place.
pub(super) fn number(bytes: &[u8], at: usize) -> Option<i32> {
    bytes.get(at..)?.first_chunk().map(|four| i32::from_le_bytes(*four))
}

/// The fraction at that place.
pub(super) fn fraction(bytes: &[u8], at: usize) -> Option<f64> {
    bytes.get(at..)?.first_chunk().map(|four| f64::from(f32::from_le_bytes(*four)))
}

/// What came of a command.
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

/// A reply to a message, as it grows.
#[derive(Debug)]
pub(super) struct Reply {
    bytes: Vec<u8>,
    /// Simulation time in milliseconds, for the commands.
    time: i32,
}

impl Reply {
    pub(super) fn new(client_time: i32, server_time: i32, simulation_time: i32) -> Self {
        let mut bytes = vec![0, 0, VERSION];
        // Nothing was executed so far.
        bytes.extend_from_slice(&(-1_i32).to_le_bytes());
        bytes.extend_from_slice(&client_time.to_le_bytes());
        bytes.extend_from_slice(&server_time.to_le_bytes());
        bytes.extend_from_slice(&[0; 3]);
        Self { bytes, time: simulation_time }
    }

    /// Adds what came of a command.
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

    /// The reply's bytes. `state` is the server's after all commands. The message's `id` is only in it when something
    /// was executed.
    pub(super) fn finish(mut self, id: i32, state: u8) -> Vec<u8> {
        if self.bytes.len() > HEADER {
            self.bytes[3..7].copy_from_slice(&id.to_le_bytes());
        }
        self.bytes[17] = state;
        self.bytes
    }
}
