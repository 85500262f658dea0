//! Kinds of entities in the data of answers, which clients send back: each by its noun. For serde's `with`.

use pydslrep_syntax::EntityKind;
use serde::de::{Error, Unexpected};
use serde::{Deserialize, Deserializer, Serializer};

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it with a reference")]
pub(crate) fn serialize<S: Serializer>(kind: &EntityKind, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(kind.noun())
}

/// # Errors
///
/// If there is no such kind.
pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<EntityKind, D::Error> {
    let noun = String::deserialize(deserializer)?;
    let known = EntityKind::ALL.into_iter().find(|kind| kind.noun() == noun);
    known.ok_or_else(|| D::Error::invalid_value(Unexpected::Str(&noun), &"a kind of declaration"))
}
