//! Graphs of other programs whose nodes have positions, as worlds: the clockwise order of the edges around a node is that of
//! their directions. x points to the right and y up.

mod graphml;
mod tmap2;

use std::{
    collections::{BTreeMap, BTreeSet},
    f64::consts::TAU,
};

use thiserror::Error;
use toposlam_model::{
    embedded_graph::{EmbeddedGraph, ListError},
    format::{named_world::NamedWorld, world_file},
};

pub(crate) use graphml::read as read_graphml;
pub(crate) use tmap2::read as read_tmap2;

/// A graph whose nodes may have positions.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct PlacedGraph {
    name: String,
    nodes: Vec<PlacedNode>,
    edges: Vec<PlacedEdge>,
}

#[derive(Clone, Debug, PartialEq)]
struct PlacedNode {
    name: String,
    position: Option<[f64; 2]>,
}

/// An edge between two nodes, by their names.
#[derive(Clone, Debug, PartialEq, Eq)]
struct PlacedEdge {
    ends: [String; 2],
    /// Whether another edge must lead back.
    is_directed: bool,
}

/// Why a graph with positions is not a world.
#[derive(Clone, Debug, PartialEq, Error)]
pub(crate) enum PlacedGraphError {
    #[error("line {line}: {message}")]
    Syntax { line: usize, message: String },
    #[error("the graph has no nodes")]
    NoNodes,
    #[error("node `{node}` is there twice")]
    NodeTwice { node: String },
    #[error("`{node}` is no name of a vertex")]
    NotAName { node: String },
    #[error("an edge of `{other}` leads to `{node}`, which is no node")]
    UnknownNode { node: String, other: String },
    #[error(
        "node `{node}` has no position, and others have: the clockwise order of its edges is not known"
    )]
    NoPosition { node: String },
    #[error("the position of node `{node}` is not a number")]
    NotFinite { node: String },
    #[error(
        "an edge of node `{node}` leads to itself: from positions it is not known in which directions it leaves"
    )]
    Loop { node: String },
    #[error(
        "an edge leads from `{from}` to `{to}`, and none leads back: the edges of a world lead both ways"
    )]
    OneWay { from: String, to: String },
    #[error(
        "two edges lead from `{from}` to `{to}`: from positions their clockwise order is not known"
    )]
    Parallel { from: String, to: String },
    #[error(
        "the edges from `{node}` to `{one}` and `{other}` lead in the same direction: their clockwise order is not known"
    )]
    SameDirection { node: String, one: String, other: String },
    #[error(
        "nodes `{one}` and `{other}` are at the same place, so the edge between them has no direction"
    )]
    SamePlace { one: String, other: String },
    #[error(transparent)]
    List(#[from] ListError),
}

/// Edges whose directions differ by less are in the same one, in radians.
const SAME_DIRECTION: f64 = 1e-3;

impl PlacedGraph {
    /// The world of a graph; `None` if no node has a position.
    pub(crate) fn world(&self) -> Result<Option<NamedWorld>, PlacedGraphError> {
        if self.nodes.is_empty() {
            return Err(PlacedGraphError::NoNodes);
        }
        if self.nodes.iter().all(|node| node.position.is_none()) {
            return Ok(None);
        }
        let positions = self.positions()?;
        let lists = self.clockwise(&self.neighbours(&positions)?, &positions)?;
        let graph = EmbeddedGraph::from_neighbour_lists(&lists)?;
        let name = if world_file::is_name(&self.name) { &self.name } else { "" };
        Ok(Some(NamedWorld {
            vertex_names: self.nodes.iter().map(|node| node.name.clone()).collect(),
            positions: Some(self.nodes.iter().map(|node| positions[&*node.name]).collect()),
            ..NamedWorld::numbered(name, "", graph, None)
        }))
    }

    /// The position of each node.
    fn positions(&self) -> Result<BTreeMap<&str, [f64; 2]>, PlacedGraphError> {
        let mut positions = BTreeMap::new();
        for PlacedNode { name, position } in &self.nodes {
            let node = shown(name);
            if !world_file::is_name(name) {
                return Err(PlacedGraphError::NotAName { node });
            }
            let Some(position) = *position else {
                return Err(PlacedGraphError::NoPosition { node });
            };
            if !position.iter().all(|number| number.is_finite()) {
                return Err(PlacedGraphError::NotFinite { node });
            }
            if positions.insert(&**name, position).is_some() {
                return Err(PlacedGraphError::NodeTwice { node });
            }
        }
        Ok(positions)
    }

    /// The neighbours of each node.
    fn neighbours<'g>(
        &'g self,
        positions: &BTreeMap<&str, [f64; 2]>,
    ) -> Result<BTreeMap<&'g str, BTreeSet<&'g str>>, PlacedGraphError> {
        let mut neighbours: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
        for PlacedEdge { ends: [from, to], is_directed } in &self.edges {
            for [node, other] in [[from, to], [to, from]] {
                if !positions.contains_key(&**node) {
                    let [node, other] = [shown(node), shown(other)];
                    return Err(PlacedGraphError::UnknownNode { node, other });
                }
            }
            if from == to {
                return Err(PlacedGraphError::Loop { node: shown(from) });
            }
            let mut is_new = neighbours.entry(from).or_default().insert(to);
            if !is_directed {
                is_new &= neighbours.entry(to).or_default().insert(from);
            }
            if !is_new {
                let [from, to] = [shown(from), shown(to)];
                return Err(PlacedGraphError::Parallel { from, to });
            }
        }
        for (from, others) in &neighbours {
            let leads_back = |to: &&&str| neighbours.get(**to).is_some_and(|it| it.contains(from));
            if let Some(to) = others.iter().find(|to| !leads_back(to)) {
                return Err(PlacedGraphError::OneWay { from: shown(from), to: shown(to) });
            }
        }
        Ok(neighbours)
    }

    /// The neighbours of each node, clockwise from the direction of y.
    fn clockwise(
        &self,
        neighbours: &BTreeMap<&str, BTreeSet<&str>>,
        positions: &BTreeMap<&str, [f64; 2]>,
    ) -> Result<Vec<(String, Vec<String>)>, PlacedGraphError> {
        let mut lists = Vec::new();
        for PlacedNode { name, .. } in &self.nodes {
            let [x, y] = positions[&**name];
            let mut around: Vec<(f64, &str)> = Vec::new();
            for &other in neighbours.get(&**name).into_iter().flatten() {
                let [east, north] = positions[other];
                if (east - x).hypot(north - y) == 0.0 {
                    let [one, other] = [shown(name), shown(other)];
                    return Err(PlacedGraphError::SamePlace { one, other });
                }
                around.push(((east - x).atan2(north - y).rem_euclid(TAU), other));
            }
            around.sort_by(|one, other| one.0.total_cmp(&other.0));
            let next = around.iter().skip(1).chain(around.first().filter(|_| around.len() > 1));
            for (one, other) in around.iter().zip(next) {
                let turn = (other.0 - one.0).rem_euclid(TAU);
                if turn.min(TAU - turn) < SAME_DIRECTION {
                    let [node, one, other] = [name, one.1, other.1].map(shown);
                    return Err(PlacedGraphError::SameDirection { node, one, other });
                }
            }
            lists.push((name.clone(), around.into_iter().map(|(_, to)| to.to_owned()).collect()));
        }
        Ok(lists)
    }
}

fn shown(text: impl AsRef<str>) -> String {
    text.as_ref().escape_debug().take(80).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn graph(nodes: &[(&str, [f64; 2])], edges: &[[&str; 2]], is_directed: bool) -> PlacedGraph {
        let node = |&(name, position): &(&str, _)| PlacedNode {
            name: name.to_owned(),
            position: Some(position),
        };
        let edge = |ends: &[&str; 2]| PlacedEdge { ends: ends.map(str::to_owned), is_directed };
        PlacedGraph {
            name: String::new(),
            nodes: nodes.iter().map(node).collect(),
            edges: edges.iter().map(edge).collect(),
        }
    }

    const CROSSING: [(&str, [f64; 2]); 5] = [
        ("x", [1.0, 1.0]),
        ("west", [0.0, 1.0]),
        ("north", [1.0, 9.0]),
        ("south", [1.0, -3.0]),
        ("east", [2.0, 1.0]),
    ];
    const ARMS: [[&str; 2]; 4] = [["x", "west"], ["x", "north"], ["x", "south"], ["x", "east"]];

    #[test]
    fn the_order_is_clockwise_by_the_directions_of_the_edges() {
        let expected = "[clockwise]\nx = [\"north\", \"east\", \"south\", \"west\"]\nwest = [\"x\"]\n\
                        north = [\"x\"]\nsouth = [\"x\"]\neast = [\"x\"]\n";
        let expected = world_file::read(expected.as_bytes()).unwrap();
        let back = ARMS.map(|[from, to]| [to, from]);
        let both = [ARMS, back].concat();
        for graph in [graph(&CROSSING, &ARMS, false), graph(&CROSSING, &both, true)] {
            let world = graph.world().unwrap().unwrap();
            assert_eq!(world.graph, expected.graph);
            assert_eq!(world.vertex_names, expected.vertex_names);
            assert_eq!(world.positions.map(|at| at[2].map(|part| part as i32)), Some([1, 9]));
        }
    }

    #[test]
    fn a_graph_whose_order_is_not_known_is_an_error_that_names_the_edge() {
        let with = |edge| [&ARMS[..], &[edge]].concat();
        let moved = |at: usize, position| {
            let mut nodes = CROSSING;
            nodes[at].1 = position;
            nodes
        };
        for (graph, error) in [
            (graph(&CROSSING, &with(["x", "x"]), false), "an edge of node `x` leads to itself"),
            (graph(&CROSSING, &with(["north", "x"]), false), "two edges lead from `north` to `x`"),
            (
                graph(&CROSSING, &ARMS, true),
                "an edge leads from `x` to `east`, and none leads back",
            ),
            (
                graph(&moved(1, [1.0, 2.0]), &ARMS, false),
                "the edges from `x` to `north` and `west` lead in the same direction",
            ),
            (
                graph(&moved(2, [1.0, 1.0]), &ARMS, false),
                "nodes `x` and `north` are at the same place",
            ),
            (graph(&moved(2, [f64::NAN, 1.0]), &ARMS, false), "the position of node `north`"),
            (graph(&CROSSING, &with(["x", "up"]), false), "an edge of `x` leads to `up`"),
            (graph(&CROSSING, &ARMS[..3], false), "`east`"),
            (graph(&[], &[], false), "the graph has no nodes"),
            (
                graph(&[CROSSING[0], CROSSING[0], CROSSING[1]], &ARMS[..1], false),
                "node `x` is there twice",
            ),
        ] {
            let found = graph.world().unwrap_err().to_string();
            assert!(found.contains(error), "{found}");
        }
        let mut some = graph(&CROSSING, &ARMS, false);
        some.nodes[3].position = None;
        let found = some.world().unwrap_err().to_string();
        assert!(found.starts_with("node `south` has no position"), "{found}");
        some.nodes.iter_mut().for_each(|node| node.position = None);
        assert_eq!(some.world(), Ok(None));
    }

    #[test]
    fn directions_on_both_sides_of_north_can_be_the_same() {
        let nodes = [("x", [0.0, 0.0]), ("a", [1e-5, 1.0]), ("b", [-1e-5, 2.0])];
        let error = graph(&nodes, &[["x", "a"], ["x", "b"]], false).world().unwrap_err();
        assert!(matches!(error, PlacedGraphError::SameDirection { .. }), "{error}");
    }
}
