//! The folding explorer, to be judged on every start with all or only strict tests.

use super::{Algorithm, ExploredMap, Explorer, ExplorerWorld, Flaw, Folding, judge::explored};
use crate::{
    mapping::{FoldingExploration, map_by_folding},
    marker::Directional,
};

/// The folding explorer.
#[derive(Clone, Debug, Default)]
pub struct FoldingExplorer {
    exploration: FoldingExploration,
}

impl FoldingExplorer {
    /// One that only makes [strict tests](FoldingExploration::strict).
    #[must_use]
    pub fn strict() -> Self {
        Self { exploration: FoldingExploration::strict() }
    }
}

impl Explorer for FoldingExplorer {
    type Marker = Directional;

    fn marker(&self) -> Directional {
        Directional
    }

    fn explore(&mut self, world: &mut ExplorerWorld) -> Result<ExploredMap<'_>, Flaw> {
        map_by_folding(world, &mut self.exploration, &mut ())?;
        explored(&self.exploration)
    }

    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        Folding.move_bound(edges, vertices)
    }
}
