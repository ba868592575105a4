//! Who watches a long check, and may break it off.

use super::Tally;

/// Watches a long check, from several threads at once.
pub trait Watch: Sync {
    /// The number of parts of the check.
    fn parts(&self, _count: usize) {}

    /// One of them is done.
    fn part_done(&self, _tally: &Tally) {}

    /// Whether to break off.
    fn stop(&self) -> bool {
        false
    }
}

/// Nobody watches.
impl Watch for () {}
