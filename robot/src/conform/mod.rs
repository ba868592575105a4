//! A recorded run, held against the specification: where it first diverged, what the specification
//! would have allowed there, and whose fault it was. Sections 2 and 4 to 6.

mod cause;
mod derived;
mod events;
mod faults;
mod gathered;
mod judgement;
mod known_world;
mod quirks;
mod shorter;
mod told;

#[cfg(test)]
mod tests;

pub use cause::{Cause, Culprit, Divergence};
pub use derived::{Derivation, NEAR};
pub use events::{Ending, Event, Events, Head, Kind, OutOfOrder, Perceived, Source};
pub(crate) use faults::in_numbers;
pub use gathered::{Evidence, Gathered, Looking, NoEvents, Seen, derived, gather};
pub use judgement::{Coverage, Driver, Judgement, NotJudged, Question, Verdict, judge};
pub use known_world::KnownWorld;
pub use quirks::{Quirk, QuirkError, Quirks};
pub use shorter::{Shorter, shorter, shorter_seen};
pub use told::{Telling, direction};
