//! The time that a team takes, in synchronous rounds: in each, every robot makes at most one move.
//!
//! A robot moves as soon as it knows where to. What a scout perceives is known to all at once.

/// When each robot has made its last move.
#[derive(Clone, Debug, Default)]
pub(super) struct Rounds {
    explorer: u64,
    scouts: Vec<u64>,
    /// When all that the next moves of the scouts depend on was known.
    known: u64,
}

impl Rounds {
    pub(super) fn of(scouts: usize) -> Self {
        Self { explorer: 0, scouts: vec![0; scouts], known: 0 }
    }

    /// When all have made their last moves.
    pub(super) fn so_far(&self) -> u64 {
        self.scouts.iter().copied().fold(self.explorer, u64::max)
    }

    pub(super) fn sent(&mut self, scout: usize) {
        if let Some(time) = self.scouts.get_mut(scout) {
            *time = 1 + (*time).max(self.known);
        }
    }

    pub(super) fn explorer_moved(&mut self) {
        self.explorer += 1;
    }

    /// The explorer looks whether a scout is here, once that one has come to its end.
    pub(super) fn waited_for(&mut self, scout: usize) {
        self.explorer = self.explorer.max(self.scouts.get(scout).copied().unwrap_or(0));
    }

    /// What happens next depends on all that happened so far.
    pub(super) fn all_know(&mut self) {
        self.known = self.so_far();
        self.explorer = self.known;
    }
}
