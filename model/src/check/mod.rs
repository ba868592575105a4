//! The exhaustive check: Algorithm 1 run on every start of every small world, and judged.

mod costs;
mod every_way;
mod judge;
mod sweep;
mod tally;

pub use costs::Costs;
pub use every_way::{EveryWay, every_way};
pub use judge::{Algorithm, Algorithm1, FalseStep, Flaw, first_false_step, judge, move_bound};
pub use sweep::{Choice, Shard, ShardError, Sweep, Watch, check_world};
pub use tally::{Failure, Tally, WorstStart};
