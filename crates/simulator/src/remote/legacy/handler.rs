//! Handles messages of the legacy remote API: executes their commands and builds the reply.

use std::time::Duration;

use super::super::session::{Answer, Session, State};
use super::client::Client;
use super::commands;
use super::message::{self, Command, Malformed, Message, Name, Outcome, Reply, mode};

const SYNCHRONOUS_ON: u16 = 0x0001;
const SYNCHRONOUS_OFF: u16 = 0x0002;
const TRIGGER: u16 = 0x0003;
const DISCONNECT: u16 = 0x000a;
const START_PAUSE_STOP: u16 = 0x1007;

/// The response to a message.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LegacyResponse {
    /// The reply, for the client.
    pub reply: Vec<u8>,
    /// True if the client disconnects after this message.
    pub is_last: bool,
    /// Answers to other clients that waited for this one.
    pub answers: Vec<Answer>,
}

impl Session {
    /// Handles a message of the legacy remote API; `now` is the time since any fixed moment.
    ///
    /// # Errors
    /// If the message is invalid. The rest of the connection cannot be trusted then.
    pub fn legacy_message(
        &mut self,
        connection: u64,
        now: Duration,
        bytes: &[u8],
    ) -> Result<LegacyResponse, Malformed> {
        let message = Message::parse(bytes)?;
        let mut client = self.legacy.remove(&connection).unwrap_or_default();
        let milliseconds = |time: Duration| i32::try_from(time.as_millis()).unwrap_or(i32::MAX);
        let time = if self.state == State::Stopped {
            Duration::ZERO
        } else {
            Duration::from_secs_f64(self.world.time())
        };
        // Step times are not exact in binary: 0.15 s is slightly less than 150 ms.
        let time = milliseconds(time + Duration::from_micros(500));
        let mut reply = Reply::new(message.client_time, milliseconds(now), time);
        let mut is_last = false;
        for command in &message.commands {
            is_last |= command.name.kind == DISCONNECT;
            let outcome = self.command(&mut client, connection, now, command);
            reply.add(&command.name, command.mode, &outcome);
        }
        self.execute_streams(&mut client, connection, now, &message, &mut reply);
        let reply = reply.finish(message.id, self.legacy_state());
        self.legacy.insert(connection, client);
        // The reply to a trigger precedes the step, as from the real server.
        let mut answers = self.answer_held_requests(now);
        answers.extend(self.step_if_ready());
        Ok(LegacyResponse { reply, is_last, answers })
    }

    fn command(&mut self, client: &mut Client, connection: u64, now: Duration, command: &Command) -> Outcome {
        client.remove_stream(&command.name);
        match command.mode {
            mode::STREAMING if !client.add_stream(command, now) => Outcome::failure(),
            mode::ONESHOT | mode::BLOCKING | mode::STREAMING => {
                self.execute(client, connection, &command.name, &command.payload)
            }
            mode::DISCONTINUE => Outcome::done(),
            _ => Outcome::failure(),
        }
    }

    /// Executes the streams that are due, except for those that this message started or changed.
    fn execute_streams(
        &mut self,
        client: &mut Client,
        connection: u64,
        now: Duration,
        message: &Message,
        reply: &mut Reply,
    ) {
        let mut streams = std::mem::take(&mut client.streams);
        for stream in &mut streams {
            let is_new = message.commands.iter().any(|command| command.name == stream.name);
            let is_due = now.saturating_sub(stream.last) >= Duration::from_millis(stream.period.into());
            if is_due && !is_new {
                stream.last = now;
                let outcome = self.execute(client, connection, &stream.name, &stream.payload);
                reply.add(&stream.name, mode::STREAMING, &outcome);
            }
        }
        client.streams = streams;
    }

    fn execute(&mut self, client: &mut Client, connection: u64, name: &Name, payload: &[u8]) -> Outcome {
        match name.kind {
            SYNCHRONOUS_ON => {
                client.synchronous = true;
                client.triggered = false;
            }
            SYNCHRONOUS_OFF => client.synchronous = false,
            TRIGGER if client.synchronous && self.state == State::Running => client.triggered = true,
            DISCONNECT => {}
            START_PAUSE_STOP => match message::number(&name.key, 0) {
                Some(0) => self.start(),
                Some(1) => self.pause(),
                Some(2) => {
                    self.stop();
                    // It is not in the map while it is served.
                    client.leave_synchronous_mode();
                }
                _ => return Outcome::failure(),
            },
            _ => return commands::execute(&mut self.context(connection), name, payload),
        }
        Outcome::done()
    }

    /// The state byte: bit 0 not stopped, bit 1 paused, bit 2 real time.
    fn legacy_state(&self) -> u8 {
        match self.state {
            State::Stopped => 0b100,
            State::Paused => 0b111,
            State::Running => 0b101,
        }
    }
}
