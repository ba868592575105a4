//! The check without repetition: all starts whose first percepts agree share the beginning of their run.
//!
//! The algorithm does not run in a world. It runs against an adversary that decides the world while the
//! robot explores: the degree of the start vertex when the robot first looks, and what is behind a door
//! when the robot takes it. Where more than one answer is possible, the search follows one after the other,
//! depth first. Each end of a run is one start, if everything was decided by then.
//!
//! # Data
//!
//! * [`Draft`](crate::enumerate) is the *record*: what has been revealed of the start, as an embedded graph
//!   with free darts. It knows the class and the number of edges, so it knows which answers still lead to a
//!   start. Decisions are made and undone like a stack.
//! * [`LazyWorld`] is the record with a robot and a marker in it, as a [`World`](crate::world::World). It
//!   pushes a *decision* for each answer that it chooses: the answer, and those that are left.
//! * [`Explorer`](crate::mapping::Explorer) is the state of a run, which is a sequence of steps, and which can be
//!   cloned between two of them.
//! * `RunSearch` runs steps until the explorer returns its map, and then goes back to the latest decision with an
//!   answer left. It restores the explorer and the robot as they were before the step of that decision, and
//!   repeats this step. The record has the new answer already, so the step passes there without asking. Only
//!   the moves of this step before the decision are made again.
//! * `LeafJudge` judges each end by a bijection between the explorer's map and the record: by the identity if they
//!   are equal, dart for dart. It does not know the algorithm.
//! * [`SharedPrefixCheck`] divides the tree into *units*, subtrees of equal first decisions, and adds up their
//!   [`PartTally`](super::PartTally)s. Which start is the worst or the first that fails does not depend on the order of the runs:
//!   starts are compared by their place in the [`Enumeration`](crate::enumerate::Enumeration), as in a
//!   [`Check`](super::Check).
//!
//! # Ends at which not everything is decided
//!
//! An explorer may return a map, or fail, before it has taken every door. Such an end stands for all starts
//! that agree with the record: in each of them the same run ends with the same map. They are enumerated, and
//! each is counted and judged. Their maps are equal, and no two of them are isomorphic, so at most one is
//! right. If there are two or more, the explorer is wrong on all others. If there is only one (the number of
//! edges can force what is behind the last doors), the map may be right, and it is then counted as right, as
//! in a `Check`, although the explorer has guessed. It is wrong in a world of another size in which it makes the
//! same walk; and where its run is shorter than the certificate, `below_certificate` counts it.
//!
//! # Answers that lead to no start
//!
//! In the class `multigraph` each answer leads to a start. The other classes drop answers from which there is
//! provably no way to end with the right number of edges. That test is not exact: if the robot takes a door
//! and no answer is left, the search goes back, and nothing is counted.

mod check;
mod leaf;
mod search;
mod units;
mod world;

pub use check::{FinishedUnits, Probe, SharedPrefixCheck};
pub use units::CheckPieces;
pub use world::LazyWorld;
