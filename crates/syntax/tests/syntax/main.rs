//! The language as text, through what the crate makes public: for tests inside it, it would be compiled a second time.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests, too")]

mod cut;
mod earlier;
mod expectation;
mod format;
mod lexer;
mod parser;
mod reuse;
mod token;
