//! The name or address of a machine.

use pydslrep_schema::{Refusal, Values};

/// A machine.
pub(crate) const HOST: Values = Values::Text("a name or an address", r"^\S+$", read);

fn read(host: &str) -> Result<String, Refusal> {
    if host.is_empty() || host.chars().any(|char| char.is_whitespace() || char.is_control()) {
        return Err(Refusal {
            help: Some("without a port or a protocol: `\"127.0.0.1\"`".to_owned()),
            ..Refusal::from("is not the name or address of a machine".to_owned())
        });
    }
    Ok(host.to_owned())
}
