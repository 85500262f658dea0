//! One file per group of requests: plain functions of the state and the parameters, without a runtime.

pub(crate) mod code_actions;
pub(crate) mod diagnostics;
pub(crate) mod scripts;
pub(crate) mod synchronization;
