//! Worlds that a marker does not distinguish: two starts from which every door sequence gives the same
//! percepts. Section 2.2.
//!
//! Whether two starts are indistinguishable is decided by the coarsest partition of the states
//! of both worlds; what a [`Comparison`] returns is a [witness](Relation), which is verified
//! without it. The [`AmbiguitySearch`] finds all such worlds of a class by the quotient of each.

mod candidate;
mod certificate;
mod comparison;
mod findings;
mod grouping;
mod partition;
mod quotient;
mod search;
mod sorter;
mod space;
mod state_classes;
mod twins;
mod witness;

pub use candidate::AmbiguityCandidate;
pub use certificate::shortest_certificate;
pub use comparison::{Bisimulation, Comparison};
pub use findings::{AmbiguousGroup, Findings, KeptPairs, PlacedWorld, SizeFindings, Unfinished};
pub use search::{AmbiguitySearch, SearchPart};
pub use sorter::{CandidateSorter, CandidatesInMemory, SearchError, SortedCandidates, SorterError};
pub use space::{PlacedRobot, has_more_states};
pub use state_classes::StateClasses;
pub use twins::{Twin, Twins, twins};
pub use witness::{Relation, Walk, replay};
