//! The folding explorer, to be judged on every start.

use std::borrow::Cow;

use super::{ExploredMap, Explorer, ExplorerWorld, Flaw};
use crate::{
    folding::ClosedTrail,
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
        map_by_folding(world, &mut self.exploration)?;
        let trail = self.exploration.trail();
        let Some(ClosedTrail { graph, marker: Some(facing), pose }) = trail.closed() else {
            return Err(Flaw::GaveUp("the marker was not seen".to_owned()));
        };
        Ok(ExploredMap { graph: Cow::Owned(graph), facing, pose })
    }

    /// `4 n m^2 + 4 n m + 400`.
    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        let (m, n) = (edges as u64, vertices as u64);
        let nm = n.saturating_mul(m);
        nm.saturating_mul(m).saturating_add(nm).saturating_mul(4).saturating_add(400)
    }
}
