//! One file per group of requests: plain functions of the state and the parameters, without a runtime.

pub(crate) mod synchronization;
