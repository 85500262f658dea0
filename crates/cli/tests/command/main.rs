//! The command as people use it: started as a process, judged by what it prints, writes and returns.

#![allow(clippy::unwrap_used, clippy::panic)] // what they share is test code too

mod build;
mod check;
mod editor;
mod explain;
#[cfg(unix)]
mod fake_python;
mod fix;
mod fmt;
mod help;
mod new;
mod newcomer;
mod own;
mod plan;
mod process;
mod project;
mod run;
mod runtime;
#[cfg(unix)]
mod sim;
mod stats;
