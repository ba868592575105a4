//! The graph of a random building: its junctions and dead ends. Bends are no vertices.

use std::collections::BTreeMap;

use toposlam_model::embedded_graph::{Dart, EmbeddedGraph};

use super::corridor_world::CorridorWorld;

/// A building as a graph: its bends are no vertices.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SmoothedWorld {
    pub(super) graph: EmbeddedGraph,
    places: Vec<usize>,
    /// For each dart, the places to its other end.
    chains: Vec<Vec<usize>>,
}

impl SmoothedWorld {
    pub(super) fn from_world(world: &CorridorWorld) -> Option<Self> {
        let is_vertex = |place: &usize| !matches!(world.arms(*place).len(), 0 | 2);
        let places: Vec<usize> = (0..world.places.len()).filter(is_vertex).collect();
        let mut names: BTreeMap<[usize; 2], String> = BTreeMap::new();
        let mut chains = Vec::new();
        let mut lists: Vec<(String, Vec<String>)> = Vec::new();
        for &place in &places {
            let mut list = Vec::new();
            for arm in world.arms(place) {
                let mut chain = vec![place, arm.to];
                while let [.., from, at] = chain[..]
                    && world.arms(at).len() == 2
                {
                    chain.push(world.arms_from(at, from)[1].to);
                }
                // An edge is named after its first corridors at both ends.
                let &[.., before, end] = &chain[..] else { return None };
                let known = names.get(&[end, before]).cloned();
                let name = known.unwrap_or_else(|| format!("e{}", names.len()));
                names.insert([place, arm.to], name.clone());
                list.push(name);
                chains.push(chain);
            }
            lists.push((format!("v{place}"), list));
        }
        let graph = EmbeddedGraph::from_edge_lists(&lists).ok()?;
        Some(Self { graph, places, chains })
    }

    /// The place of the vertex of a dart.
    pub(super) fn place_of(&self, dart: Dart) -> usize {
        self.places[self.graph.vertex(dart).at()]
    }

    /// The places at both ends of the corridor by which a dart leaves its vertex.
    pub(super) fn first_corridor(&self, dart: Dart) -> [usize; 2] {
        let chain = &self.chains[dart.at()];
        [chain[0], chain[1]]
    }
}

#[cfg(test)]
mod tests {
    use super::{super::corridor_world::BuildingKind, *};

    #[test]
    fn the_graph_of_a_building_has_its_junctions_and_dead_ends() {
        for seed in 0..200 {
            let world = CorridorWorld::random(BuildingKind::Mixed, seed);
            let smoothed = SmoothedWorld::from_world(&world).unwrap();
            let graph = &smoothed.graph;
            let degrees = |degree: usize| {
                (0..world.places.len()).filter(|&place| world.arms(place).len() == degree).count()
            };
            assert_eq!(graph.vertex_count(), degrees(1) + degrees(3) + degrees(4) + degrees(5));
            // Each bend joins two corridors.
            assert_eq!(graph.edge_count(), world.links.len() - degrees(2));
            assert_eq!(graph.genus(), 0, "{seed}: a plan is planar");
            for dart in graph.darts() {
                let chain = &smoothed.chains[dart.at()];
                let mut back = smoothed.chains[graph.opposite(dart).at()].clone();
                back.reverse();
                assert_eq!(*chain, back, "{seed}");
                assert_eq!(chain[0], smoothed.place_of(dart));
            }
        }
    }
}
