//! The incremental database: documents, entities, names, problems, and environments ready to run.
//!
//! Knows many files at once, each as a text with an opaque path. Must never know editors and their protocol, where
//! files come from, threads or clocks.
//!
//! The unit of change is the top-level entity. Entities tile their file and carry spans relative to their own start,
//! so an edit re-reads only the entities it touches, and answers again only for those and for the ones that use a name
//! whose meaning changed. Whatever is asked of a database that was edited equals what a fresh one would answer.

mod blocked;
mod cancellation;
mod database;
mod defaults;
mod diagnostic;
pub mod diagnostics;
mod edition;
mod entity;
pub mod environment;
mod facts;
mod fingerprint;
mod fix_validator;
mod fixing;
pub mod path;
mod plan;
mod reads;
mod resolve;
mod signature;
mod summary;
mod target;

pub use blocked::Blocked;
pub use cancellation::{CancellationToken, Cancelled, cancellable, check_cancelled};
pub use database::{Database, EditCounts};
pub use defaults::DEFAULT_ANGLE;
pub use diagnostic::{Diagnostic, Edit, Fix, Related, Severity};
pub use diagnostics::MAX_BLOCK_DEPTH;
pub use edition::Edition;
pub use entity::{EntityId, EntityRef, FileId, FileSpan, Resolution};
pub use environment::COUNTS;
pub use facts::{Absence, Facts, Snapshot};
pub use fingerprint::Fingerprint;
pub use fix_validator::{FixValidator, Offers};
pub use fixing::Fixing;
pub use plan::{Driver, plan, plan_movement, reach, scene, summary_of_movement};
pub use resolve::KnownStatements;
pub use target::Target;
