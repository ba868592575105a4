//! Which runs of a start are checked.

use super::{EveryWay, every_way};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Watch,
    mapping::{Explorer, Flaw},
};

/// The choices of the runs that are checked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RunChoices {
    /// The default ones: one run.
    #[default]
    Default,
    /// The default ones, and then all: every run.
    All {
        /// The number of states of one start that may be explored.
        budget: u64,
    },
}

impl RunChoices {
    /// Makes and judges the other runs of a start, if they are to be checked.
    ///
    /// # Errors
    /// Returns the first [`Flaw`].
    pub fn others<E: Explorer>(
        self,
        new: impl Fn() -> E,
        graph: &EmbeddedGraph,
        facing: Dart,
        watch: &dyn Watch,
    ) -> Result<Option<EveryWay>, Flaw> {
        match self {
            Self::Default => Ok(None),
            Self::All { budget } => every_way(new(), graph, facing, budget, watch).map(Some),
        }
    }
}
