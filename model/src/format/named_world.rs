//! A world with the names of its vertices and edges, and starts given by these names. Section 2.1.

use thiserror::Error;

use crate::{
    aid::{Aid, AidKind, PlaceNames, State},
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    floor_plan::FloorPlan,
    isomorphism::as_discovered,
    similar::similar_name,
};

#[derive(Clone, Debug, PartialEq)]
pub struct NamedWorld {
    /// The name of the world; may be empty.
    pub name: String,
    /// A short description; may be empty.
    pub about: String,
    /// The embedded graph; its vertices and darts are numbered in the order of the file.
    pub graph: EmbeddedGraph,
    /// The facing dart, if the file has a start.
    pub start: Option<Dart>,
    /// The kind of marker that the world is about, if the file has one.
    pub marker: Option<AidKind>,
    pub vertex_names: Vec<String>,
    /// The name of each dart's edge; `None` if the file lists neighbours, which it can only do for a
    /// simple graph.
    pub edge_names: Option<Vec<String>>,
    /// The position of each vertex of a floor plan: metres, x to the east, y to the north.
    pub positions: Option<Vec<[f64; 2]>>,
    /// The floor plan, if the world is one. Its junctions are the vertices, in the same order.
    pub plan: Option<FloorPlan>,
}

#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum StartError {
    #[error("`{text}` is not a start; write `vertex:facing`")]
    NoColon { text: String },
    #[error("there is no vertex `{vertex}`{similar}")]
    UnknownVertex { vertex: String, similar: String },
    #[error("vertex `{vertex}` has no neighbour `{facing}`; it has {listed}")]
    NoSuchNeighbour { vertex: String, facing: String, listed: String },
    #[error("no edge `{facing}` ends at vertex `{vertex}`; the edges there are {listed}")]
    NoSuchEdge { vertex: String, facing: String, listed: String },
    #[error("`{text}` is ambiguous: several starts are written like this")]
    Ambiguous { text: String },
    #[error("edge `{edge}` is a loop; write `{edge}:1` or `{edge}:2` for one of its ends")]
    BareLoop { edge: String },
}

impl NamedWorld {
    /// A world with generated names: vertices `v0`, `v1`, ... in their order, and edges `e0`, `e1`, ...
    /// in the order of their lower darts. Edges have names exactly if the graph is not simple.
    pub fn numbered(name: &str, about: &str, graph: EmbeddedGraph, start: Option<Dart>) -> Self {
        let edge_names = || graph.edge_numbers().iter().map(|edge| format!("e{edge}")).collect();
        let edge_names = (!graph.is_simple()).then(edge_names);
        Self {
            name: name.to_owned(),
            about: about.to_owned(),
            start,
            marker: None,
            vertex_names: (0..graph.vertex_count()).map(|n| format!("v{n}")).collect(),
            edge_names,
            positions: None,
            plan: None,
            graph,
        }
    }

    /// The world of a start, [`numbered`](Self::numbered) in the order of discovery by a robot that
    /// follows the darts of each vertex clockwise from the one by which it first came. The facing dart
    /// becomes dart 0.
    pub fn discovered(name: &str, about: &str, graph: &EmbeddedGraph, facing: Dart) -> Self {
        Self::numbered(name, about, as_discovered(graph, facing), Some(Dart(0)))
    }

    /// The same world without corners: see [`EmbeddedGraph::smoothed`]. The names and the positions of the other
    /// vertices stay, and so does the start unless it is at a corner. Edges have names if they had any, or if
    /// the result is not simple: an edge gets the name of its first part.
    #[must_use]
    pub fn smoothed(&self) -> Self {
        let (graph, darts) = self.graph.smoothed();
        let kept = |new: Vertex| self.graph.vertex(darts[graph.first_dart(new).at()]).at();
        let numbered = Self::numbered(&self.name, &self.about, graph.clone(), None);
        let edge_names = self.edge_names.as_ref().map(|names| {
            let part = |dart: Dart| names[darts[dart.min(graph.opposite(dart)).at()].at()].clone();
            graph.darts().map(part).collect()
        });
        let start = self.start.and_then(|start| darts.iter().position(|&dart| dart == start));
        let positions = self.positions.as_ref();
        Self {
            start: start.map(|place| Dart(place as u32)),
            marker: self.marker,
            vertex_names: graph
                .vertices()
                .map(|new| self.vertex_names[kept(new)].clone())
                .collect(),
            edge_names: edge_names.or(numbered.edge_names.clone()),
            positions: positions.map(|all| graph.vertices().map(|new| all[kept(new)]).collect()),
            ..numbered
        }
    }

    pub fn vertex_named(&self, name: &str) -> Option<Vertex> {
        let number = self.vertex_names.iter().position(|known| known == name)?;
        Some(Vertex(number as u32))
    }

    /// The dart of a start in the form of the command line, `vertex:facing`. Names may contain colons.
    ///
    /// # Errors
    /// Returns an error if there is no colon, no such dart, or several.
    pub fn start_from_text(&self, text: &str) -> Result<Dart, StartError> {
        let Some((at, facing)) = text.split_once(':') else {
            return Err(StartError::NoColon { text: shown(text) });
        };
        let split_after = |name: &'_ String| {
            let facing = text.strip_prefix(name.as_str())?.strip_prefix(':')?;
            Some(self.start_from_names(name, facing))
        };
        let readings = self.vertex_names.iter().filter_map(split_after);
        let (darts, errors): (Vec<_>, Vec<_>) = readings.partition(Result::is_ok);
        let mut readings = darts.into_iter().chain(errors);
        match (readings.next(), readings.next()) {
            (Some(Ok(_)), Some(Ok(_))) => Err(StartError::Ambiguous { text: shown(text) }),
            (Some(reading), _) => reading,
            (None, _) => self.start_from_names(at, facing),
        }
    }

    /// The dart at the vertex `at` with the name `facing`: a neighbour's name if the world lists
    /// neighbours, else an edge's. For a loop it is `e:1` or `e:2`, the first or second of its ends in
    /// the order of the file.
    ///
    /// # Errors
    /// Returns an error if there is no such dart, or if the edge is a loop and no end is named.
    pub fn start_from_names(&self, at: &str, facing: &str) -> Result<Dart, StartError> {
        let vertex = self.vertex_named(at).ok_or_else(|| StartError::UnknownVertex {
            vertex: shown(at),
            similar: similar_name(at, self.vertex_names.iter().map(String::as_str)),
        })?;
        let edge = facing.strip_suffix(":1").or(facing.strip_suffix(":2"));
        let mut bare_loop = false;
        let mut found = None;
        for dart in self.graph.darts_of(vertex) {
            let name = self.leads_to(dart);
            let is_loop = self.is_named_loop(dart);
            if is_loop && name == facing {
                bare_loop = true;
            } else if (!is_loop && name == facing)
                || (is_loop && Some(name) == edge && self.facing_text(dart) == facing)
            {
                // An edge can have the name of an end of a loop.
                if found.replace(dart).is_some() {
                    return Err(StartError::Ambiguous { text: shown(facing) });
                }
            }
        }
        if let Some(dart) = found {
            return Ok(dart);
        }
        let (listed, at, facing) = (self.listed(vertex), at.to_owned(), shown(facing));
        Err(if bare_loop {
            StartError::BareLoop { edge: facing }
        } else if self.edge_names.is_some() {
            StartError::NoSuchEdge { vertex: at, facing, listed }
        } else {
            StartError::NoSuchNeighbour { vertex: at, facing, listed }
        })
    }

    /// The text `vertex:facing` of this dart, the inverse of
    /// [`start_from_text`](Self::start_from_text).
    pub fn start_text(&self, dart: Dart) -> String {
        format!("{}:{}", self.at_text(dart), self.facing_text(dart))
    }

    /// A state of a robot in this world: its pose as `vertex:door`, where the first door that is listed
    /// at the vertex is 0; and the state of an aid that moves: see [`Aid::placed_text`].
    pub fn state_text<A: Aid>(&self, aid: &A, state: &State<A::Placed>) -> String {
        self.dart(state.pose) + &aid.placed_text(&state.placed, self)
    }

    pub fn at_text(&self, dart: Dart) -> &str {
        &self.vertex_names[self.graph.vertex(dart).at()]
    }

    pub fn facing_text(&self, dart: Dart) -> String {
        let name = self.leads_to(dart);
        if self.is_named_loop(dart) {
            let end = if dart < self.graph.opposite(dart) { 1 } else { 2 };
            format!("{name}:{end}")
        } else {
            name.to_owned()
        }
    }

    /// The name that the file lists for the dart: its edge, or the neighbour at its other end.
    pub fn leads_to(&self, dart: Dart) -> &str {
        match &self.edge_names {
            Some(names) => &names[dart.at()],
            None => self.at_text(self.graph.opposite(dart)),
        }
    }

    fn is_named_loop(&self, dart: Dart) -> bool {
        self.edge_names.is_some()
            && self.graph.vertex(dart) == self.graph.vertex(self.graph.opposite(dart))
    }

    fn listed(&self, vertex: Vertex) -> String {
        const SHOWN: usize = 8;
        let darts = self.graph.darts_of(vertex);
        let more = if darts.len() > SHOWN { ", ..." } else { "" };
        let shown: Vec<_> = darts.take(SHOWN).map(|dart| self.facing_text(dart)).collect();
        shown.join(", ") + more
    }
}

impl PlaceNames for NamedWorld {
    fn vertex(&self, dart: Dart) -> String {
        self.at_text(dart).to_owned()
    }

    fn dart(&self, dart: Dart) -> String {
        format!("{}:{}", self.at_text(dart), self.graph.index(dart))
    }
}

fn shown(text: &str) -> String {
    text.escape_debug().to_string()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{
        any_graph::{Class, any_graph},
        format::world_file,
    };

    fn world(file: &str) -> NamedWorld {
        world_file::read(file.as_bytes()).unwrap()
    }

    /// A loop `a` and two edges `b`, `c` to a second vertex.
    fn with_loop() -> NamedWorld {
        world("doors = {u = ['a', 'b', 'a', 'c'], v = ['b', 'c']}")
    }

    fn path(names: [&str; 3]) -> NamedWorld {
        let [one, middle, other] = names;
        let ends = format!("'{one}' = ['{middle}'], '{middle}' = ['{one}', '{other}']");
        world(&format!("clockwise = {{{ends}, '{other}' = ['{middle}']}}"))
    }

    /// A ring with two corners at a vertex `t`, and a dead end.
    #[test]
    fn a_world_without_corners_keeps_its_other_names() {
        let world = world(
            "name = 'w'\n[clockwise]\nc1 = ['t', 'c2']\nt = ['c1', 'c2', 'end']\nc2 = ['c1', 't']\n\
             end = ['t']\n[positions]\nc1 = [0, 1]\nt = [0, 0]\nc2 = [1, 0]\nend = [0, -1]",
        );
        let started =
            |text| NamedWorld { start: world.start_from_text(text).ok(), ..world.clone() };
        let smooth = started("t:end").smoothed();
        assert_eq!(smooth.vertex_names, ["t", "end"]);
        assert_eq!(smooth.positions, Some(vec![[0.0, 0.0], [0.0, -1.0]]));
        assert_eq!(smooth.edge_names.as_deref().unwrap(), ["e0", "e0", "e1", "e1"]);
        assert_eq!(smooth.start_text(smooth.start.unwrap()), "t:e1");
        assert_eq!(started("c1:c2").smoothed().start, None);
        assert_eq!(smooth.smoothed(), smooth);
        // Names of edges stay, those of the first parts.
        let edges = ["a", "b", "a", "c", "d", "b", "c", "d"].map(str::to_owned).to_vec();
        let named = NamedWorld { edge_names: Some(edges), ..world.clone() };
        assert_eq!(named.smoothed().edge_names.unwrap(), ["a", "a", "d", "d"]);
    }

    #[test]
    fn a_start_faces_a_neighbour_or_an_edge_or_an_end_of_a_loop() {
        let world = with_loop();
        for (text, dart) in
            [("u:a:1", 0), ("u:b", 1), ("u:a:2", 2), ("u:c", 3), ("v:b", 4), ("v:c", 5)]
        {
            assert_eq!(world.start_from_text(text), Ok(Dart(dart)));
            assert_eq!(world.start_text(Dart(dart)), text);
        }
    }

    #[test]
    fn names_with_colons_are_read_if_only_one_start_is_written_like_this() {
        let overlapping = path(["a", "a:b", "c:d"]);
        // From a to b:c, or from a:b to c: only one of them is there.
        let one_of_two = path(["b:c", "a", "a:b"]);
        let both = world("doors = {a = ['b:c', 'x'], 'a:b' = ['c', 'x'], p = ['b:c', 'c']}");
        let loop_and_edge = world("doors = {u = ['e', 'e:1', 'e', 'f'], v = ['e:1', 'f']}");
        let ambiguous = |text: &str| Err(StartError::Ambiguous { text: text.to_owned() });
        for (world, text, start) in [
            (path(["v0", "v1", "v2"]), "v1:v2", Ok(Dart(2))),
            (overlapping.clone(), "a:b:c:d", Ok(Dart(2))),
            (overlapping.clone(), "c:d:a:b", Ok(Dart(3))),
            (overlapping, "a:a:b", Ok(Dart(0))),
            (one_of_two, "a:b:c", Ok(Dart(1))),
            (both, "a:b:c", ambiguous("a:b:c")),
            (loop_and_edge.clone(), "u:e:1", ambiguous("e:1")),
            (loop_and_edge.clone(), "u:e:2", Ok(Dart(2))),
            (loop_and_edge, "v:e:1", Ok(Dart(4))),
        ] {
            assert_eq!(world.start_from_text(text), start, "{text}");
        }
    }

    #[test]
    fn the_error_for_a_wrong_start_lists_the_right_ones() {
        let star = world(
            "[doors]\nhub = ['1', '2', '3', '4', '5', '6', '7', '8', '9']\na = ['1', '2', '3']\n\
             b = ['4', '5', '6', '7', '8', '9']",
        );
        for (world, text, message) in [
            (with_loop(), "\u{7}", "`\\u{7}` is not a start; write `vertex:facing`"),
            (with_loop(), "w\n:a", "there is no vertex `w\\n`"),
            (
                with_loop(),
                "v:\u{1b}[1m",
                "no edge `\\u{1b}[1m` ends at vertex `v`; the edges there are b, c",
            ),
            (
                path(["corner", "tee", "end"]),
                "corne:tee",
                "there is no vertex `corne`; did you mean `corner`?",
            ),
            (
                star,
                "hub:q",
                "no edge `q` ends at vertex `hub`; the edges there are 1, 2, 3, 4, 5, 6, 7, 8, ...",
            ),
        ] {
            assert_eq!(world.start_from_text(text).unwrap_err().to_string(), message);
        }
        for wrong in ["d", "a:3", "b:1", "a:1:1", ""] {
            assert_eq!(
                with_loop().start_from_names("u", wrong).unwrap_err().to_string(),
                format!("no edge `{wrong}` ends at vertex `u`; the edges there are a:1, b, a:2, c")
            );
        }
    }

    #[test]
    fn generated_names_are_in_the_order_of_discovery() {
        // From v facing c: its darts clockwise are c, b; c leads to u, entered by c, whose other
        // darts are, clockwise, a, b, a.
        let graph = with_loop().graph;
        let world = NamedWorld::discovered("made", "by a test", &graph, Dart(5));
        assert_eq!((world.name.as_str(), world.about.as_str()), ("made", "by a test"));
        assert_eq!(world.vertex_names, ["v0", "v1"]);
        assert_eq!(world.edge_names.as_deref().unwrap(), ["e0", "e1", "e0", "e2", "e1", "e2"]);
        assert_eq!(world.start_text(world.start.unwrap()), "v0:e0");
    }

    proptest! {
        #[test]
        fn discovery_renumbers_the_graph_and_changes_nothing_else(
            graph in any_graph(Class::Multigraph, 12), start in any::<u32>()
        ) {
            let start = Dart(start % graph.dart_count() as u32);
            let world = NamedWorld::discovered("", "", &graph, start);
            prop_assert_eq!(world.edge_names.is_none(), graph.is_simple());
            // The renumbering is the one that carries the start along all walks.
            let mut image = vec![None; graph.dart_count()];
            let mut open = vec![(start, Dart(0))];
            while let Some((here, there)) = open.pop() {
                match image[here.at()].replace(there) {
                    None => {
                        open.push((graph.clockwise(here), world.graph.clockwise(there)));
                        open.push((graph.opposite(here), world.graph.opposite(there)));
                    }
                    Some(earlier) => prop_assert_eq!(earlier, there),
                }
            }
            // Numbering it again changes nothing.
            let again = NamedWorld::discovered("", "", &world.graph, Dart(0));
            prop_assert_eq!(again, world);
        }

        #[test]
        fn the_text_of_a_start_gives_it_back(graph in any_graph(Class::Multigraph, 12)) {
            let world = NamedWorld::numbered("", "", graph, None);
            for dart in world.graph.darts() {
                prop_assert_eq!(world.start_from_text(&world.start_text(dart)), Ok(dart));
            }
        }
    }
}
