//! The language server and the simulator for a browser: what `editors/web` loads as WebAssembly.
//!
//! Knows JavaScript's values. Must never know features of its own, nor the browser's: its page, its network, its clock. A
//! worker passes messages and times in and takes messages out.
//!
//! * [`LanguageServer`]: a session of `pydslrep-server` without a disk.
//! * [`Simulator`]: the remote APIs of `pydslrep-simulator` on the world of an environment.
//! * [`runtime_files`]: the Python package that scripts import.
//!
//! WebAssembly cannot unwind, so a panic ends the instance: the worker reports it and starts another.

mod conversation;
mod executor;
mod simulation;

use std::panic;

use pydslrep_simulator::Answer;
use wasm_bindgen::prelude::*;

use crate::conversation::Conversation;
use crate::simulation::Simulation;

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(js_namespace = console, js_name = error)]
    fn console_error(message: &str);
}

/// Writes panics to the console, where there is no standard error.
#[wasm_bindgen(start)]
pub fn start() {
    panic::set_hook(Box::new(|info| console_error(&format!("pydslrep: {info}"))));
}

/// A session of the language server.
#[wasm_bindgen]
#[derive(Debug, Default)]
pub struct LanguageServer(Conversation);

#[wasm_bindgen]
impl LanguageServer {
    /// A session that waits for `initialize`.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// Handles one message, a JSON-RPC object as JSON.
    pub fn handle(&mut self, message: &str) {
        self.0.handle(message);
    }

    /// Continues long requests, a part of each, and reports the changes of earlier messages. Call it when no message
    /// waits. Returns whether there is more to do; messages may come first.
    pub fn proceed(&mut self) -> bool {
        self.0.proceed()
    }

    /// The messages to the client since the last call, as JSON.
    #[wasm_bindgen(js_name = takeMessages)]
    pub fn take_messages(&mut self) -> Vec<String> {
        self.0.take_messages()
    }
}

/// A simulated environment, and the remote APIs that scripts drive it with.
///
/// Replies are `[ticket, bytes]`: each request is answered once, immediately or with a later one. `now` is the time since
/// any fixed moment, in seconds.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Simulator(Simulation);

#[wasm_bindgen]
impl Simulator {
    /// A simulator of an environment, with a stopped simulation. `input` is JSON, see `Input` in `simulation.rs`.
    ///
    /// # Errors
    /// If there is no such environment, it has errors, or its scene has.
    #[wasm_bindgen(constructor)]
    pub fn new(input: &str) -> Result<Self, JsError> {
        Simulation::new(input).map(Self).map_err(|reason| JsError::new(&reason))
    }

    /// The name of the environment.
    #[wasm_bindgen(getter)]
    pub fn environment(&self) -> String {
        self.0.environment().to_owned()
    }

    /// The names of its robots.
    #[wasm_bindgen(getter)]
    pub fn robots(&self) -> Vec<String> {
        self.0.robots()
    }

    /// Simulation time, seconds.
    #[wasm_bindgen(getter)]
    pub fn time(&self) -> f64 {
        self.0.session.world().time()
    }

    /// The pose of each robot: x and y in metres, theta in radians.
    #[wasm_bindgen(getter)]
    pub fn poses(&self) -> Vec<f64> {
        self.0.poses()
    }

    /// Handles a request of the `ZeroMQ` remote API, one CBOR map; `connection` is who sent it.
    pub fn request(&mut self, connection: u32, ticket: u32, now: f64, bytes: &[u8]) -> Vec<JsValue> {
        let now = simulation::duration(now);
        replies(self.0.session.request(connection.into(), ticket.into(), now, bytes))
    }

    /// Handles a message of V-REP's legacy remote API. Returns its reply, whether the client is done, and the replies to
    /// requests of others that waited for it.
    ///
    /// # Errors
    /// If the message is invalid; the rest of the connection cannot be trusted then.
    #[wasm_bindgen(js_name = legacyMessage)]
    pub fn legacy_message(
        &mut self,
        connection: u32,
        now: f64,
        bytes: &[u8],
    ) -> Result<Vec<JsValue>, JsError> {
        let now = simulation::duration(now);
        let response = self.0.session.legacy_message(connection.into(), now, bytes);
        let response = response.map_err(|_| JsError::new("not a message of the legacy remote API"))?;
        Ok(vec![js_bytes(response.reply), response.is_last.into(), js_array(replies(response.answers))])
    }

    /// Removes a connection and its clients; the wheels that they drove stop.
    pub fn disconnect(&mut self, connection: u32) -> Vec<JsValue> {
        replies(self.0.session.disconnect(connection.into()))
    }

    /// Expires silent clients, and keeps those alive that wait for a step. To be called now and then.
    #[wasm_bindgen(js_name = expireClients)]
    pub fn expire_clients(&mut self, now: f64) -> Vec<JsValue> {
        replies(self.0.session.expire_clients(simulation::duration(now)))
    }

    /// Returns whether the simulation runs and no client steps it: then time passes with [`Self::tick`].
    #[wasm_bindgen(getter, js_name = isFreeRunning)]
    pub fn is_free_running(&self) -> bool {
        self.0.session.is_free_running()
    }

    /// Takes a step of a simulation that runs freely.
    pub fn tick(&mut self) -> Vec<JsValue> {
        replies(self.0.session.tick())
    }

    /// The trace since the last call, as `pydslrep sim --trace` writes it: lines of JSON.
    #[wasm_bindgen(js_name = takeTrace)]
    pub fn take_trace(&mut self) -> Vec<u8> {
        self.0.take_trace()
    }
}

fn replies(answers: Vec<Answer>) -> Vec<JsValue> {
    let reply = |Answer { ticket, bytes: reply }| {
        #[expect(clippy::cast_precision_loss, reason = "tickets come from 32 bits")]
        let ticket = JsValue::from_f64(ticket as f64);
        js_array(vec![ticket, js_bytes(reply)])
    };
    answers.into_iter().map(reply).collect()
}

/// The files of the package that scripts import: for each `[path, text]`, the path in its folder `pydslrep_runtime`.
#[wasm_bindgen(js_name = runtimeFiles)]
pub fn runtime_files() -> Vec<JsValue> {
    let files = pydslrep_script::runtime::files().into_iter().map(|file| {
        let text = String::from_utf8_lossy(&file.content);
        js_array(vec![JsValue::from_str(&file.path), JsValue::from_str(&text)])
    });
    files.collect()
}

/// An `Array`.
fn js_array(values: Vec<JsValue>) -> JsValue {
    values.into_boxed_slice().into()
}

/// A `Uint8Array`.
fn js_bytes(bytes: Vec<u8>) -> JsValue {
    bytes.into_boxed_slice().into()
}
