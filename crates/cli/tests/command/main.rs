//! The command as people use it: started as a process, judged by what it prints, writes and returns.

mod build;
mod check;
mod editor;
#[cfg(unix)]
mod fake_python;
mod new;
mod plan;
mod process;
mod run;
