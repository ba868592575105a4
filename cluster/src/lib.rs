//! Exhaustive checks and searches on several machines.
//!
//! The machines run the same command. The processes connect to each other over TCP, and [timely dataflow] moves
//! what they exchange. [`ClusterProcess`] is one process of them.
//!
//! # Data
//!
//! * Each process lists the tasks of the work by itself: units of a [check](ClusterProcess::check), parts of the worlds of
//!   a [search](ClusterProcess::search). The lists are equal.
//! * Process 0 assigns tasks to the process that asks next, so no process waits while there are tasks: many at first, one
//!   at the end. A process has at most two assignments for each of its threads: one that runs and one that is next.
//! * The result of a task goes to process 0, which adds it up and may record it.
//! * What a task finds under a key goes to the process of this key. When no task is left, each process groups what
//!   it has, and process 0 collects the groups.
//! * Process 0 sends the sum to all, so that all of them know how the work ended.
//!
//! If a process ends before the work does, the others lose their connection to it, and end too.
//!
//! [timely dataflow]: https://docs.rs/timely

mod check;
mod cluster;
mod connect;
mod dataflow;
mod handshake;
mod hosts;
mod loss;
mod search;

pub use cluster::{ClusterError, ClusterProcess, ThreadUse};
pub use connect::{ConnectError, Setting};
pub use hosts::{Hosts, HostsError};
