//! The check without repetition: all starts whose first percepts agree share the beginning of their run.
//!
//! The algorithm runs against an adversary that decides the world while the robot explores: the degree of the start
//! vertex when the robot first looks, and what is behind a door when the robot takes it. Where more than one answer is
//! possible, the search follows one after the other, depth first. [`Draft`](crate::enumerate) is the *record* of what
//! has been revealed; [`LazyWorld`] is the record with a robot and a marker in it. `RunSearch` runs steps until the
//! explorer returns its map, goes back to the latest decision with an answer left, restores the explorer and the robot
//! as they were before the step of that decision, and repeats this step. `LeafJudge` judges each end by a bijection
//! between the explorer's map and the record. [`SharedPrefixCheck`] divides the tree into *units*, subtrees of equal
//! first decisions. Which start is the worst or the first that fails does not depend on the order of the runs: starts
//! are compared by their place in the [`Enumeration`](crate::enumerate::Enumeration).
//!
//! An explorer may return a map, or fail, before it has taken every door. Such an end stands for all starts
//! that agree with the record: in each of them the same run ends with the same map. Each is counted and judged. At most
//! one is right. If there is only one, the map may be right although the explorer has guessed; where its run is shorter
//! than the certificate, `below_certificate` counts it.
//!
//! In the class `multigraph` each answer leads to a start. The other classes drop answers from which there is
//! provably no way to end with the right number of edges. That test is not exact: if the robot takes a door
//! and no answer is left, the search goes back, and nothing is counted.

mod check;
mod leaf;
mod search;
mod world;

pub use check::{CheckPieces, FinishedUnits, Probe, SharedPrefixCheck};
pub use world::LazyWorld;
