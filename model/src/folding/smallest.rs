//! The smallest world that explains a walk.
//!
//! Each world that explains a walk arises from its folded trail: some of its vertices are one vertex, and
//! each open dart leads to another open dart or out of the trail, at best to a dead end. The search first decides, for
//! each vertex, which of the vertices before it it is, if any, and then joins open darts in pairs as far as the class
//! allows. Worlds with no fewer edges than the best one so far are left out (branch and bound). It may take exponential
//! time; it ends after a number of steps.

use std::collections::{HashSet, VecDeque};

use super::{ClosedTrail, FoldedTrail, MarkedTrails};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Class, Watch},
    isomorphism::{StartCode, code, discovery_order},
};

/// The worlds to search, and the limit of the search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WorldSearch {
    pub class: Class,
    /// The largest number of edges, if only smaller worlds are searched.
    pub max_edges: Option<usize>,
    /// The largest number of steps. A step tries to unite two vertices or to join two darts. On a long
    /// trail one try counts as several steps.
    pub steps: u64,
}

impl WorldSearch {
    /// About a second's work.
    pub const STEPS: u64 = 500_000;
}

/// The largest number of decisions on top of each other, for the stack.
const MAX_DEPTH: usize = 1000;

/// The largest number of undecided vertices and options that are kept for all decisions, for the memory.
const MAX_KEPT: usize = 1 << 22;

/// The number of undecided vertices whose options are computed before one of them is decided.
const WINDOW: usize = 64;

/// The number of vertices of the trail for which a try counts as one more step.
const VERTICES: usize = 256;

/// The smallest world that explains a walk.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SmallestWorld {
    World {
        /// The world; the robot starts with dart 0 behind it.
        graph: EmbeddedGraph,
        /// The dart along which the marker points, or a dart of the vertex at which an undirected one lies, if it
        /// was perceived.
        marker: Option<Dart>,
        /// Why the search ended before all smaller worlds were excluded; `None` if no world of the class
        /// with fewer edges explains the walk.
        limit: Option<SearchLimit>,
    },
    /// No world of the class explains the walk, whatever its size.
    NoWorld,
    /// The search ended before a world of the class was found.
    NotFound { limit: SearchLimit },
}

/// Why a search ended early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SearchLimit {
    /// It reached the largest number of edges. A larger world may explain the walk.
    Edges,
    Steps,
    Decisions,
    Stopped,
    /// The robot's marking aid moves: such worlds are not searched.
    Aid,
}

/// Finds the world of a class with the fewest edges that explains the walk of a trail: a robot from some
/// start in it, with the directional or an undirected marker somewhere or without one, has the percepts of the
/// walk. Of several, it is the first in the order of the search.
pub fn smallest_world(
    trail: &FoldedTrail,
    search: WorldSearch,
    watch: &dyn Watch,
) -> SmallestWorld {
    smallest(trail, None, search, watch)
}

/// Finds the smallest world that explains the walk of a trail and is not isomorphic to a start.
pub fn smallest_other_world(
    trail: &FoldedTrail,
    (graph, facing): (&EmbeddedGraph, Dart),
    search: WorldSearch,
    watch: &dyn Watch,
) -> SmallestWorld {
    smallest(trail, Some(&code(graph, facing)), search, watch)
}

/// The smallest world that does not have the code `except`.
fn smallest(
    trail: &FoldedTrail,
    except: Option<&StartCode>,
    search: WorldSearch,
    watch: &dyn Watch,
) -> SmallestWorld {
    if trail.marked_vertex().is_none() {
        return smallest_of_trail(trail, except, search, watch);
    }
    let MarkedTrails { trails, may_be_more } = trail.with_one_marked_vertex(watch);
    let mut limit = may_be_more.then_some(SearchLimit::Steps);
    let mut best: Option<FoundWorld> = None;
    for trail in &trails {
        match smallest_of_trail(trail, except, search, watch) {
            SmallestWorld::World { graph, marker, limit: reached } => {
                limit = limit.or(reached);
                if best.as_ref().is_none_or(|(best, _)| graph.edge_count() < best.edge_count()) {
                    best = Some((graph, marker));
                }
            }
            SmallestWorld::NotFound { limit: reached } => limit = limit.or(Some(reached)),
            SmallestWorld::NoWorld => {}
        }
    }
    SmallestWorld::new(best, limit)
}

/// A world that explains the walk, and the dart of its marker.
type FoundWorld = (EmbeddedGraph, Option<Dart>);

impl SmallestWorld {
    fn new(found: Option<FoundWorld>, limit: Option<SearchLimit>) -> Self {
        match (found, limit) {
            (Some((graph, marker)), limit) => Self::World { graph, marker, limit },
            (None, Some(limit)) => Self::NotFound { limit },
            (None, None) => Self::NoWorld,
        }
    }
}

/// Does the same for a trail in which only one vertex has an undirected marker.
fn smallest_of_trail(
    trail: &FoldedTrail,
    except: Option<&StartCode>,
    search: WorldSearch,
    watch: &dyn Watch,
) -> SmallestWorld {
    let mut state = Search {
        trail: trail.clone(),
        except,
        class: search.class,
        max_edges: search.max_edges,
        watch,
        steps: search.steps,
        stopped: None,
        depth: 0,
        kept: 0,
        best: None,
    };
    let order = breadth_first(trail);
    let possible = state.is_in_class();
    let Some((&first, later)) = order.split_first().filter(|_| possible) else {
        return SmallestWorld::NoWorld;
    };
    // A first world, in case that the search does not end.
    if search.class == Class::Multigraph {
        state.join_all();
    } else {
        state.propose(&[]);
    }
    // Without an open dart it is the only world.
    if trail.open_count() > 0 {
        let undecided = later.iter().map(|&dart| Undecided::new(dart)).collect();
        state.decide(&mut vec![first], undecided);
    }
    let is_bounded = state.best.is_none() && search.max_edges.is_some();
    let limit = state.stopped.or(is_bounded.then_some(SearchLimit::Edges));
    SmallestWorld::new(state.best, limit)
}

/// The first darts of the vertices, from that of the marker on, or else from that of the start.
fn breadth_first(trail: &FoldedTrail) -> Vec<Dart> {
    if trail.vertex_count() == 0 {
        return Vec::new();
    }
    let marker = trail.marker().or(trail.marked_vertex());
    let root = marker.unwrap_or_else(|| trail.start());
    let mut seen = HashSet::from([trail.vertex(root)]);
    let mut order = Vec::new();
    let mut queue = VecDeque::from([root]);
    while let Some(next) = queue.pop_front() {
        let around: Vec<Dart> = trail.darts_around(next).collect();
        order.push(around[0]);
        let far = around.into_iter().filter_map(|dart| trail.opposite(dart));
        queue.extend(far.filter(|&dart| seen.insert(trail.vertex(dart))));
    }
    order
}
/// A vertex that may be one of those that are decided to be distinct.
#[derive(Clone)]
struct Undecided {
    dart: Dart,
    /// Darts of distinct vertices; it may be any of these.
    options: Vec<Dart>,
    /// The number of distinct vertices whose darts were tried.
    tried: usize,
}

impl Undecided {
    fn new(dart: Dart) -> Self {
        Self { dart, options: Vec::new(), tried: 0 }
    }
}

struct Search<'w> {
    trail: FoldedTrail,
    /// The code of a world that is left out.
    except: Option<&'w StartCode>,
    class: Class,
    max_edges: Option<usize>,
    watch: &'w dyn Watch,
    steps: u64,
    stopped: Option<SearchLimit>,
    depth: usize,
    /// The number of undecided vertices and options that are kept for them.
    kept: usize,
    best: Option<FoundWorld>,
}

impl Search<'_> {
    /// Decides which vertices are distinct. Those in `distinct` are, each given by a dart.
    fn decide(&mut self, distinct: &mut Vec<Dart>, mut undecided: Vec<Undecided>) {
        if self.stopped.is_some() {
            return;
        }
        let before = distinct.len();
        self.settle(distinct, &mut undecided);
        let kept: usize = undecided.iter().map(|one| 1 + one.options.len()).sum();
        if self.descend(kept) {
            // The vertex with the fewest options; of several, the first.
            let window = 0..undecided.len().min(WINDOW);
            let fewest = window.min_by_key(|&index| undecided[index].options.len());
            match fewest {
                _ if self.is_too_large(distinct) => {}
                None => self.join(),
                Some(index) => {
                    let Undecided { dart, options, .. } = undecided.remove(index);
                    for option in options {
                        if self.is_over() || self.is_too_large(distinct) {
                            break;
                        }
                        let changes = self.trail.classes.change_count();
                        if self.unite(dart, option, distinct) {
                            self.decide(distinct, undecided.clone());
                            self.trail.classes.undo_to(changes);
                        }
                    }
                    distinct.push(dart);
                    self.decide(distinct, undecided);
                }
            }
            self.ascend(kept);
        }
        distinct.truncate(before);
    }

    /// Leaves out vertices that became one with others, and computes which distinct vertices the first of the
    /// others may be. One that can be none of them is distinct.
    fn settle(&mut self, distinct: &mut Vec<Dart>, undecided: &mut Vec<Undecided>) {
        let mut seen: HashSet<usize> =
            distinct.iter().map(|&dart| self.trail.vertex(dart)).collect();
        undecided.retain(|one| seen.insert(self.trail.vertex(one.dart)));
        for one in undecided.iter_mut().take(WINDOW) {
            one.options.retain(|&option| self.may_unite(one.dart, option, distinct));
        }
        loop {
            let known = distinct.len();
            let mut looked_at = 0;
            undecided.retain_mut(|one| {
                if looked_at == WINDOW || self.stopped.is_some() {
                    return true;
                }
                for place in one.tried..distinct.len() {
                    for option in self.trail.darts_around(distinct[place]) {
                        if self.may_unite(one.dart, option, distinct) {
                            one.options.push(option);
                        }
                    }
                }
                one.tried = distinct.len();
                let may_be_one = !one.options.is_empty() || self.stopped.is_some();
                if may_be_one {
                    looked_at += 1;
                } else {
                    distinct.push(one.dart);
                }
                may_be_one
            });
            if distinct.len() == known || self.stopped.is_some() {
                return;
            }
        }
    }

    /// Whether two vertices can become one, so that one dart is the other.
    fn may_unite(&mut self, one: Dart, other: Dart, distinct: &[Dart]) -> bool {
        if self.trail.degree(one) != self.trail.degree(other) || self.is_over() {
            return false;
        }
        let changes = self.trail.classes.change_count();
        let united = self.unite(one, other, distinct);
        self.trail.classes.undo_to(changes);
        united
    }

    /// Makes one vertex of two, unless that contradicts the walk, the class or that vertices are distinct.
    fn unite(&mut self, one: Dart, other: Dart, distinct: &[Dart]) -> bool {
        let changes = self.trail.classes.change_count();
        let more = self.trail.vertex_count() / VERTICES;
        self.steps = self.steps.saturating_sub(more as u64);
        if self.trail.unite(one, other).is_err() {
            return false;
        }
        let mut seen = HashSet::with_capacity(distinct.len());
        let fits = distinct.iter().all(|&dart| seen.insert(self.trail.vertex(dart)))
            && (!self.class.is_simple() || self.trail.is_simple());
        if !fits {
            self.trail.classes.undo_to(changes);
        }
        fits
    }

    /// Whether a world with these distinct vertices has too many edges, or no fewer than the best one.
    fn is_too_large(&self, distinct: &[Dart]) -> bool {
        let darts: usize = distinct.iter().map(|&dart| self.trail.degree(dart) as usize).sum();
        self.exceeds(darts.div_ceil(2))
    }

    fn exceeds(&self, edges: usize) -> bool {
        self.max_edges.is_some_and(|max| edges > max)
            || self.best.as_ref().is_some_and(|(best, _)| edges >= best.edge_count())
    }

    /// Joins open darts in pairs; all vertices are distinct.
    fn join(&mut self) {
        if self.class == Class::Multigraph && self.except.is_none() {
            self.join_all();
        } else if self.propose(&[]) {
            let open: Vec<Dart> = self.trail.open_darts().collect();
            self.join_some(&open, &mut Vec::new());
        }
    }

    /// Joins all open darts in pairs, each with the next one.
    fn join_all(&mut self) {
        let open: Vec<Dart> = self.trail.open_darts().collect();
        let edges: Vec<_> = open.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect();
        self.propose(&edges);
    }

    /// Joins these open darts with each other as far as the class allows, in every way.
    fn join_some(&mut self, open: &[Dart], edges: &mut Vec<(Dart, Dart)>) {
        let without = self.edges_without_joins();
        let Some((&dart, rest)) = open.split_first() else { return };
        // Each further pair saves one edge.
        if self.exceeds(without - edges.len() - open.len() / 2) || !self.descend(open.len()) {
            return;
        }
        for (place, &other) in rest.iter().enumerate() {
            if self.is_over() {
                break;
            }
            if self.may_join(dart, other, edges) {
                edges.push((dart, other));
                if self.propose(edges) {
                    let left = [&rest[..place], &rest[place + 1..]].concat();
                    self.join_some(&left, edges);
                }
                edges.pop();
            }
        }
        self.join_some(rest, edges);
        self.ascend(open.len());
    }

    /// Whether an edge between two open darts leaves the world in the class.
    fn may_join(&self, one: Dart, other: Dart, edges: &[(Dart, Dart)]) -> bool {
        if !self.class.is_simple() {
            return true;
        }
        let trail = &self.trail;
        let ends = [one, other].map(|dart| trail.vertex(dart));
        let is_between = |one: Dart, other: Dart| {
            let these = [one, other].map(|dart| trail.vertex(dart));
            these == ends || these == [ends[1], ends[0]]
        };
        let adjacent = trail
            .darts_around(one)
            .any(|dart| trail.opposite(dart).is_some_and(|far| is_between(dart, far)));
        ends[0] != ends[1] && !adjacent && !edges.iter().any(|&(one, far)| is_between(one, far))
    }

    /// The number of edges with a dead end behind each open dart.
    fn edges_without_joins(&self) -> usize {
        let darts: usize =
            self.trail.vertices().map(|first| self.trail.degree(first) as usize).sum();
        let open = self.trail.open_count();
        (darts - open) / 2 + open
    }

    /// The world in which these pairs of open darts are edges becomes the best one if it has fewer edges.
    /// `false` if it is not in the class.
    fn propose(&mut self, joined: &[(Dart, Dart)]) -> bool {
        let edges = self.edges_without_joins() - joined.len();
        let better = !self.exceeds(edges);
        // What is simple and within the degrees stays so; the genus is to be computed.
        if !better && self.class != Class::Planar {
            return true;
        }
        let ClosedTrail { mut graph, marker, start, .. } = self.trail.closed_by(joined);
        if self.class == Class::Planar && graph.genus() > 0 {
            return false;
        }
        if better && self.except.is_some_and(|except| code(&graph, start) == *except) {
            // With one edge more behind a dead end it is another world.
            let has_dead_end = self.trail.open_count() > 2 * joined.len();
            if !has_dead_end || self.exceeds(edges + 1) {
                return true;
            }
            graph.lengthen_dead_end();
        }
        if better {
            let order = discovery_order(&graph, start);
            let place = |dart| order.iter().position(|&known| known == dart);
            let marker = marker.and_then(place).map(|place| Dart(place as u32));
            self.best = Some((graph.renumbered(&order), marker));
        }
        true
    }

    /// Whether the folded trail fits the class, apart from its genus.
    fn is_in_class(&self) -> bool {
        let degrees = self.trail.vertices().map(|first| self.trail.degree(first));
        degrees.max().is_none_or(|degree| degree <= self.class.max_degree())
            && (!self.class.is_simple() || self.trail.is_simple())
    }

    /// Begins a decision for which so much is kept; not if the search is over.
    fn descend(&mut self, kept: usize) -> bool {
        if self.stopped.is_none() && (self.depth == MAX_DEPTH || self.kept + kept > MAX_KEPT) {
            self.stopped = Some(SearchLimit::Decisions);
        }
        if self.stopped.is_some() {
            return false;
        }
        self.depth += 1;
        self.kept += kept;
        true
    }

    fn ascend(&mut self, kept: usize) {
        self.depth -= 1;
        self.kept -= kept;
    }

    /// Takes a step; `true` if the search is over.
    fn is_over(&mut self) -> bool {
        if self.stopped.is_none() {
            if self.watch.stop() {
                self.stopped = Some(SearchLimit::Stopped);
            } else if self.steps == 0 {
                self.stopped = Some(SearchLimit::Steps);
            }
            self.steps = self.steps.saturating_sub(1);
        }
        self.stopped.is_some()
    }
}

#[cfg(test)]
mod tests;
