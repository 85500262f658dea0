//! Fuzz targets: functions of bytes that panic if anything is wrong.
//!
//! `cargo test` runs them over the corpus and some mutations of it; `libfuzzer` explores with coverage, see the readme.

mod edits;
mod program;
mod remote;
mod session;
mod toml;

/// A fuzz target.
pub struct Target {
    /// The name of its corpus and of its binary.
    pub name: &'static str,
    /// Panics if the input breaks something.
    pub run: fn(&[u8]),
}

/// All fuzz targets.
pub const TARGETS: [Target; 7] = [
    Target { name: "program", run: program::run },
    Target { name: "edits", run: edits::run },
    Target { name: "session", run: session::run },
    Target { name: "calls", run: remote::calls },
    Target { name: "frames", run: remote::frames },
    Target { name: "settings", run: toml::settings },
    Target { name: "scene", run: toml::scene },
];

/// Runs the target of a name.
///
/// # Panics
/// If there is none, and if the input breaks something.
#[expect(clippy::panic, reason = "a mistake in a binary of this crate")]
pub fn run(name: &str, data: &[u8]) {
    match TARGETS.iter().find(|target| target.name == name) {
        Some(target) => (target.run)(data),
        None => panic!("no target {name}"),
    }
}
