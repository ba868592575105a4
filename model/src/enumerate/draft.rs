//! A start that is decided step by step: what is behind a free dart, and with which degree.
//!
//! An [`Enumeration`](super::Enumeration) decides in the order of the darts' numbers. A robot decides in the
//! order in which it takes doors. Both come to each start of a class and a size exactly once.

use std::ops::{ControlFlow, RangeInclusive};

use super::{Answer, Answers, Class, Each, EnumeratedGraph};
use crate::embedded_graph::{Dart, EmbeddedGraph, Vertex};

/// The most edges that a draft can have: its darts are the bits of a `u64`.
pub(super) const MAX_EDGES: usize = 32;

pub(super) const DARTS: usize = 2 * MAX_EDGES;

/// The number of edges in the beginnings that divide an enumeration into parts.
pub(super) const PREFIX_EDGES: usize = 4;

/// The first steps of a history.
#[derive(Clone, Copy, Debug)]
pub(super) struct Prefix {
    degree: u8,
    words: [u8; PREFIX_EDGES],
    edges: u8,
}

/// A start of a class that will have a certain number of edges, as far as it is decided, and its code so
/// far. Its facing dart is dart 0.
#[derive(Clone, Debug)]
pub(crate) struct Draft {
    class: Class,
    each: Each,
    target: usize,
    /// What is decided. The other darts have no opposite.
    pub(super) graph: EmbeddedGraph,
    /// They, as bits.
    free: u64,
    /// For each vertex, as bits, itself and those joined to it: a simple graph lets none of these be
    /// joined to it again. Kept in the classes of simple graphs only.
    adjacent: [u64; MAX_EDGES + 1],
    /// The code so far: a word an edge, as in `isomorphism::StartCode`, but in a byte.
    pub(super) words: [u8; MAX_EDGES],
    pub(super) edges: usize,
    /// The darts, as bits, with a code so far that could still become less than that of dart 0. Dart 0
    /// is not among them.
    pub(super) rivals: u64,
    /// For each free dart, the next one along the face into which it sticks, clockwise, and the one before. Kept in
    /// the class `planar` only. A dart that is not free keeps its own, to be free again.
    next_in_face: [u8; DARTS],
    last_in_face: [u8; DARTS],
}

/// The decisions that led from a draft to one with more edges, and the answers that are not tried yet.
#[derive(Clone, Debug, Default)]
pub(super) struct Decisions {
    made: Vec<Decision>,
    /// Whether the last answers of all decisions have been visited, and are to be changed.
    goes_back: bool,
}

#[derive(Clone, Copy, Debug)]
struct Decision {
    dart: Option<Dart>,
    answer: Answer,
    untried: Answers,
    /// The rivals of the draft before.
    rivals: u64,
}

/// The end of a search for the next graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SearchEnd {
    Found,
    /// As many steps as were allowed are made. The search can go on.
    Paused,
    /// There is nothing more.
    Finished,
}

impl Decisions {
    /// Changes the draft, which must be as this left it, to the next one with `edges` edges. When it is finished,
    /// the draft is what it was at first. A step makes or undoes one decision.
    pub(super) fn search(&mut self, draft: &mut Draft, edges: usize, steps: u64) -> SearchEnd {
        'steps: for _ in 0..steps {
            let (dart, mut untried, rivals) = if self.goes_back {
                let Some(Decision { dart, answer, untried, rivals }) = self.made.pop() else {
                    return SearchEnd::Finished;
                };
                draft.rivals = rivals;
                draft.undo(dart, answer);
                (dart, untried, rivals)
            } else if draft.edges == edges {
                self.goes_back = true;
                return SearchEnd::Found;
            } else {
                let dart = draft.lowest_free();
                // The start vertex comes first.
                let is_open = dart.is_some() || draft.graph.vertex_count() == 0;
                let untried = if is_open { draft.answers(dart) } else { Answers::default() };
                (dart, untried, draft.rivals)
            };
            while let Some(answer) = untried.take_first() {
                draft.decide(dart, answer);
                if draft.may_be_least() {
                    self.made.push(Decision { dart, answer, untried, rivals });
                    self.goes_back = false;
                    continue 'steps;
                }
                draft.rivals = rivals;
                draft.undo(dart, answer);
            }
            self.goes_back = true;
        }
        SearchEnd::Paused
    }
}

/// The word of an edge to a new vertex of some degree; and the degree, from the word.
pub(super) fn new_vertex(degree: u8) -> u8 {
    u8::MAX - degree
}

/// Whether `free` free darts and `edges` edges to come can come out even: only the last edge may
/// leave no dart free, and each uses up two at most.
fn can_end(free: usize, edges: usize) -> bool {
    (free == 0) == (edges == 0) && free <= 2 * edges
}

fn bit(dart: Dart) -> u64 {
    1 << dart.0
}

/// The numbers of the bits that are set, from the lowest.
pub(super) fn bits(mut set: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lowest = (set != 0).then(|| set.trailing_zeros() as usize)?;
        set &= set - 1;
        Some(lowest)
    })
}

impl Draft {
    /// A start of which nothing is decided. It has at most [`MAX_EDGES`].
    pub(super) fn empty(each: Each, class: Class, target: usize) -> Self {
        Self {
            class,
            each,
            target,
            graph: EmbeddedGraph::unfinished(),
            free: 0,
            adjacent: [0; MAX_EDGES + 1],
            words: [0; MAX_EDGES],
            edges: 0,
            rivals: 0,
            next_in_face: [0; DARTS],
            last_in_face: [0; DARTS],
        }
    }

    pub(super) fn prefix(&self) -> Prefix {
        let mut words = [0; PREFIX_EDGES];
        words[..self.edges].copy_from_slice(&self.words[..self.edges]);
        Prefix { degree: self.start_degree() as u8, words, edges: self.edges as u8 }
    }

    pub(super) fn resume(&mut self, prefix: Prefix) {
        self.decide(None, Answer::NewVertex(prefix.degree));
        for &word in &prefix.words[..prefix.edges as usize] {
            let known = usize::from(word) < self.graph.dart_count();
            let answer =
                if known { Answer::Free(word) } else { Answer::NewVertex(new_vertex(word)) };
            self.decide(self.lowest_free(), answer);
            self.may_be_least();
        }
    }

    /// Decides in every way until there are `edges` edges, and visits each result.
    pub(super) fn grow_to(
        &mut self,
        edges: usize,
        visit: &mut impl FnMut(&Self) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut decisions = Decisions::default();
        loop {
            match decisions.search(self, edges, u64::MAX) {
                SearchEnd::Found => visit(self)?,
                SearchEnd::Paused => {}
                SearchEnd::Finished => return ControlFlow::Continue(()),
            }
        }
    }

    fn start_degree(&self) -> usize {
        self.graph.degree(Vertex(0)) as usize
    }

    fn highest_degree(&self) -> usize {
        let of_root = match self.each {
            Each::World if self.graph.vertex_count() > 0 => self.start_degree(),
            _ => 2 * self.target,
        };
        of_root.min(self.class.max_degree() as usize)
    }

    /// The free dart with the lowest number.
    fn lowest_free(&self) -> Option<Dart> {
        (self.free != 0).then(|| Dart(self.free.trailing_zeros()))
    }

    #[inline]
    pub(crate) fn edges_left(&self) -> usize {
        self.target - self.edges
    }

    fn free_count(&self) -> usize {
        self.graph.dart_count() - 2 * self.edges
    }

    /// Whether the number of edges lets the next edge join two free darts.
    pub(super) fn can_join(&self) -> bool {
        let free = self.free_count();
        free >= 2 && can_end(free - 2, self.edges_left() - 1)
    }

    /// The degrees that the number of edges allows for a vertex at the end of the next edge. There is a free dart.
    pub(super) fn new_degrees(&self) -> RangeInclusive<usize> {
        let free = self.free_count();
        let left = self.edges_left() - 1;
        // A dead end behind the only free dart leaves none, as the last edge does and no other one.
        let fewest = if free == 1 && left > 0 { 2 } else { 1 };
        fewest..=self.highest_degree().min((2 * left + 2).saturating_sub(free))
    }

    /// The degrees that the number of edges allows for the start vertex.
    pub(super) fn start_degrees(&self) -> RangeInclusive<usize> {
        1..=self.highest_degree()
    }

    /// The free darts, as bits, to which the class lets a dart be joined.
    pub(super) fn partners(&self, dart: Dart) -> u64 {
        let mut partners = self.free & !bit(dart);
        if self.class.is_simple() {
            for neighbour in bits(self.adjacent[self.graph.vertex(dart).at()]) {
                partners &= !self.darts_of(Vertex(neighbour as u32));
            }
        }
        if self.class == Class::Planar {
            partners &= self.free_in_face(dart.at());
        }
        partners
    }

    /// The darts of a vertex, as bits.
    fn darts_of(&self, vertex: Vertex) -> u64 {
        let darts = self.graph.darts_of(vertex);
        (u64::MAX >> (DARTS - darts.len())) << self.graph.first_dart(vertex).0
    }

    /// The free darts, as bits, that stick out into the same face as a free dart, and it too. In the class
    /// `planar`.
    fn free_in_face(&self, dart: usize) -> u64 {
        let mut found = 1 << dart;
        let mut at = self.next_in_face[dart] as usize;
        while at != dart {
            found |= 1 << at;
            at = self.next_in_face[at] as usize;
        }
        found
    }

    fn follow(&mut self, dart: u8, next: u8) {
        self.next_in_face[dart as usize] = next;
        self.last_in_face[next as usize] = dart;
    }

    /// An edge between two free darts divides their face, or unites their faces: each is followed by what
    /// followed the other.
    fn join_in_face(&mut self, one: usize, other: usize) {
        let [(last, next), (last_other, next_other)] =
            [one, other].map(|dart| (self.last_in_face[dart], self.next_in_face[dart]));
        let [one, other] = [one, other].map(|dart| dart as u8);
        match (next == one, next_other == other) {
            // The only one in its face.
            (true, true) => {}
            (true, false) => self.follow(last_other, next_other),
            (false, true) => self.follow(last, next),
            (false, false) => {
                if next_other != one {
                    self.follow(last, next_other);
                }
                if next != other {
                    self.follow(last_other, next);
                }
            }
        }
    }

    fn unjoin_in_face(&mut self, one: usize, other: usize) {
        for dart in [one, other] {
            let (last, next) = (self.last_in_face[dart], self.next_in_face[dart]);
            self.next_in_face[last as usize] = dart as u8;
            self.last_in_face[next as usize] = dart as u8;
        }
    }

    /// Whether the class can leave no way to use up the free darts.
    pub(super) fn can_get_stuck(&self) -> bool {
        self.class.is_simple()
    }

    /// Whether the class leaves a way to use up the free darts. (A necessary condition; that of
    /// [`can_end`] has been checked.)
    pub(super) fn can_still_end(&self) -> bool {
        let left = self.edges_left();
        // As many edges as free darts are always enough: a dead end at each.
        if !self.can_get_stuck() || self.free_count() <= left {
            return true;
        }
        if self.class != Class::Planar {
            return self.edges_needed(self.free) <= left;
        }
        let (mut unseen, mut needed) = (self.free, 0);
        while unseen != 0 {
            let face = self.free_in_face(unseen.trailing_zeros() as usize);
            unseen &= !face;
            needed += self.edges_needed(face);
        }
        needed <= left
    }

    /// The least number of edges that can use up these free darts, if none may be joined to one at
    /// its own vertex.
    fn edges_needed(&self, free: u64) -> usize {
        let (mut rest, mut most_at_one) = (free, 0);
        while rest != 0 {
            let here = self.darts_of(self.graph.vertex(Dart(rest.trailing_zeros())));
            most_at_one = most_at_one.max((rest & here).count_ones());
            rest &= !here;
        }
        free.count_ones().div_ceil(2).max(most_at_one) as usize
    }

    pub(super) fn add_vertex(&mut self, degree: u32) {
        let new = self.graph.add_vertex(degree);
        let darts = self.darts_of(new);
        self.free |= darts;
        // Only a vertex with as many darts can rival the start, and dart 0 is no rival to itself.
        if self.each == Each::World && degree as usize == self.start_degree() {
            self.rivals |= darts & !1;
        }
        if self.class.is_simple() {
            self.adjacent[new.at()] = 1 << new.0;
        }
        if self.class == Class::Planar {
            for dart in self.graph.darts_of(new) {
                self.follow(dart.0 as u8, self.graph.clockwise(dart).0 as u8);
            }
        }
    }

    pub(super) fn remove_vertex(&mut self) {
        if let Some(last) = self.graph.vertices().next_back() {
            let darts = self.darts_of(last);
            self.free &= !darts;
            self.rivals &= !darts;
        }
        self.graph.remove_vertex();
    }

    pub(super) fn join(&mut self, one: Dart, other: Dart, word: u8) {
        self.graph.join(one, other);
        self.free &= !(bit(one) | bit(other));
        self.words[self.edges] = word;
        self.edges += 1;
        if self.class.is_simple() {
            let [from, to] = [one, other].map(|dart| self.graph.vertex(dart));
            self.adjacent[from.at()] |= 1 << to.0;
            self.adjacent[to.at()] |= 1 << from.0;
        }
        if self.class == Class::Planar {
            self.join_in_face(one.at(), other.at());
        }
    }

    pub(super) fn unjoin(&mut self, one: Dart, other: Dart) {
        if self.class == Class::Planar {
            self.unjoin_in_face(one.at(), other.at());
        }
        // In a simple graph it is the only edge between them.
        if self.class.is_simple() {
            let [from, to] = [one, other].map(|dart| self.graph.vertex(dart));
            self.adjacent[from.at()] &= !(1 << to.0);
            self.adjacent[to.at()] &= !(1 << from.0);
        }
        self.edges -= 1;
        self.free |= bit(one) | bit(other);
        self.graph.unjoin(one, other);
    }

    pub(super) fn show(
        &self,
        visit: &mut impl FnMut(EnumeratedGraph) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let automorphisms = self.rivals.count_ones() + 1;
        visit(EnumeratedGraph { graph: &self.graph, automorphisms })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Vertices of these degrees, edges between some of their darts, and so many edges left.
    fn grown(class: Class, degrees: &[u32], edges: &[(u32, u32)], left: usize) -> Draft {
        let mut draft = Draft::empty(Each::Start, class, edges.len() + left);
        for &degree in degrees {
            draft.add_vertex(degree);
        }
        for &(one, other) in edges {
            draft.join(Dart(one), Dart(other), other as u8);
        }
        draft
    }

    /// The darts of a face that are free, along its border.
    fn free_along_the_border(draft: &Draft, dart: Dart) -> u64 {
        let mut found = 0;
        let mut at = dart;
        loop {
            match draft.graph.joined(at) {
                None => found |= bit(at),
                Some(far) => at = far,
            }
            at = draft.graph.clockwise(at);
            if at == dart {
                return found;
            }
        }
    }

    /// In every planar draft on the way to 6 edges.
    #[test]
    fn the_free_darts_of_a_face_are_those_along_its_border() {
        for left in 0..=3 {
            let mut seen = 0;
            let mut compare = |draft: &Draft| {
                for dart in bits(draft.free) {
                    let along = free_along_the_border(draft, Dart(dart as u32));
                    assert_eq!(draft.free_in_face(dart), along);
                    let last = draft.last_in_face[dart] as usize;
                    assert_eq!(draft.next_in_face[last] as usize, dart);
                    seen += 1;
                }
                ControlFlow::Continue(())
            };
            let _ = Draft::empty(Each::Start, Class::Planar, 6).grow_to(6 - left, &mut compare);
            assert_eq!(seen > 100, left > 0);
        }
    }

    #[test]
    fn a_word_encodes_the_degree_of_a_new_vertex_and_is_no_dart() {
        for degree in 1..=DARTS as u8 {
            assert_eq!(new_vertex(new_vertex(degree)), degree);
            assert!(usize::from(new_vertex(degree)) >= DARTS);
        }
    }

    /// An edge uses up two free darts, but not two at one vertex.
    #[test]
    fn free_darts_at_one_vertex_need_an_edge_each() {
        let needed = |degrees: &[u32]| {
            let draft = grown(Class::Simple, degrees, &[], 0);
            draft.edges_needed(draft.free)
        };
        assert_eq!(needed(&[1, 1, 1, 1]), 2);
        assert_eq!(needed(&[1, 1, 1]), 2);
        assert_eq!(needed(&[3, 1, 1]), 3);
        assert_eq!(needed(&[4]), 4);
        let can_still_end = |class, left| grown(class, &[3, 1, 1], &[], left).can_still_end();
        assert!(can_still_end(Class::Simple, 3) && !can_still_end(Class::Simple, 2));
        assert!(can_still_end(Class::Multigraph, 2));
    }

    /// A triangle with two free darts: in the plane, one inside and one outside are not joined.
    #[test]
    fn free_darts_in_two_faces_need_an_edge_each_in_the_plane() {
        let triangle = |class, free_at_one| {
            // Clockwise 3, 4, 5 at the one: the side of the free dart is that of the turn.
            let out = if free_at_one == 4 { 5 } else { 4 };
            grown(class, &[3, 3, 2], &[(0, 3), (out, 6), (7, 2)], 1)
        };
        assert_eq!(triangle(Class::Planar, 4).free_in_face(1), 1 << 1);
        assert_eq!(triangle(Class::Planar, 5).free_in_face(1), 1 << 1 | 1 << 5);
        assert!(!triangle(Class::Planar, 4).can_still_end());
        assert!(triangle(Class::Planar, 5).can_still_end());
        assert!(triangle(Class::Simple, 4).can_still_end());
    }
}
