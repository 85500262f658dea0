//! A client of the ZeroMQ remote API, with the bytes of RFC 23 and nothing of the simulator's own reader and writer. The
//! scripts' tests drive the simulator with libzmq.

use std::time::Duration;

use ciborium::{Value, cbor};
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;

/// The time limit, which turns hanging tests into failures.
pub(crate) const LIMIT: Duration = Duration::from_secs(60);

/// The greeting of a client and its command READY.
pub(crate) fn introduction() -> Vec<u8> {
    let mut bytes = vec![0xff, 0, 0, 0, 0, 0, 0, 0, 0, 0x7f, 3, 0];
    bytes.extend_from_slice(b"NULL");
    bytes.resize(64, 0);
    bytes.extend_from_slice(b"\x04\x19\x05READY\x0bSocket-Type\0\0\0\x03REQ");
    bytes
}

/// A connected REQ socket.
pub(crate) struct Client {
    stream: TcpStream,
    name: String,
}

impl Client {
    /// Connects and completes the handshake.
    pub(crate) async fn connect(port: u16, name: &str) -> Self {
        let mut stream = TcpStream::connect(("127.0.0.1", port)).await.unwrap();
        stream.write_all(&introduction()).await.unwrap();
        let mut client = Self { stream, name: name.to_owned() };
        assert_eq!(client.read(64).await[0], 0xff);
        let (flags, ready) = client.frame().await;
        assert!(flags == 4 && ready.starts_with(b"\x05READY"), "{ready:?}");
        client
    }

    /// Calls a function and returns its first result.
    pub(crate) async fn call(&mut self, function: &str, arguments: Value) -> Value {
        let request =
            cbor!({ "func" => function, "args" => arguments, "uuid" => self.name.as_str() }).unwrap();
        let mut body = Vec::new();
        ciborium::into_writer(&request, &mut body).unwrap();
        let reply = tokio::time::timeout(LIMIT, self.exchange(&body)).await.expect("a reply in time");
        let map: Value = ciborium::from_reader(reply.as_slice()).unwrap();
        let ret = map.as_map().unwrap().iter().find(|(key, _)| key.as_text() == Some("ret"));
        match ret.unwrap_or_else(|| panic!("{function}: {map:?}")).1.clone() {
            Value::Array(values) => values.into_iter().next().unwrap_or(Value::Null),
            _ => Value::Null,
        }
    }

    /// Sends a message after the empty frame of a REQ socket, and returns the reply without it.
    async fn exchange(&mut self, body: &[u8]) -> Vec<u8> {
        let mut bytes = vec![1, 0, 2];
        bytes.extend_from_slice(&(body.len() as u64).to_be_bytes());
        bytes.extend_from_slice(body);
        self.stream.write_all(&bytes).await.unwrap();
        assert_eq!(self.frame().await, (1, vec![]));
        let (flags, reply) = self.frame().await;
        assert_eq!(flags & !2, 0, "the last frame of a message");
        reply
    }

    /// The flags and the content of the next frame.
    async fn frame(&mut self) -> (u8, Vec<u8>) {
        let flags = self.read(1).await[0];
        let length = if flags & 2 == 0 {
            u64::from(self.read(1).await[0])
        } else {
            u64::from_be_bytes(self.read(8).await.try_into().unwrap())
        };
        (flags, self.read(length.try_into().unwrap()).await)
    }

    async fn read(&mut self, length: usize) -> Vec<u8> {
        let mut bytes = vec![0; length];
        self.stream.read_exact(&mut bytes).await.unwrap();
        bytes
    }
}
