//! What a walk proves, step by step. Beyond Section 2.3; the same folding as that of
//! [folded trails](crate::folding::FoldedTrail), with a reason for each union.

use std::{collections::BTreeMap, iter};

use super::PerceivedWalk;
use crate::{
    marker::{
        DirectedEdge, Directional, MarkerKind, TwoDistinct, TwoIdentical, Undirected,
        UndirectedEdge,
    },
    percept::{Door, MarkerSet, Percept, Sighting},
};

/// A reason why two darts of a walk are one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnionStep {
    /// At these visits the directional marker was seen.
    Mark([usize; 2]),
    /// These passages leave by one dart, so that they lead to one dart.
    Beyond([Passage; 2]),
}

/// A move over an edge, or the same edge seen from its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Passage {
    /// The number of the move, which leads from the visit of this number to the next.
    pub number: usize,
    pub is_onward: bool,
}

/// Why no world gives a walk. Visits are numbered from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WalkContradiction {
    /// This step makes two darts one that are two doors of a vertex, or at vertices with different degrees.
    Step(UnionStep),
    /// What was seen at these visits cannot be seen at one vertex, with their poses.
    Sightings([usize; 2]),
    /// The edge of this move would have one end only.
    Edge(usize),
    /// No vertex shows what was perceived at this visit.
    Percept(usize),
    /// The door taken at this visit does not exist.
    Door(usize),
    /// There is no place left for the marker, which was not seen.
    Unmarked,
}

/// The steps of a walk, and what they show.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FoldedWalk {
    pub steps: Vec<UnionStep>,
    pub end: WalkEnd,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WalkEnd {
    /// Each door is that of some move.
    Complete,
    /// So many doors were never followed.
    Open(usize),
    /// The percepts up to a visit contradict each other.
    Contradiction { visit: usize, contradiction: WalkContradiction },
}

/// Folds a walk, visit by visit, up to the first that contradicts those before it.
pub fn fold_walk(walk: &PerceivedWalk, marker: MarkerKind) -> FoldedWalk {
    let mut folding = Folding::new(marker);
    let doors = iter::once(None).chain(walk.doors().iter().copied().map(Some));
    for (visit, (door, &percept)) in doors.zip(walk.percepts()).enumerate() {
        if let Err(contradiction) = folding.arrive(door, percept) {
            let end = WalkEnd::Contradiction { visit, contradiction };
            return FoldedWalk { steps: folding.steps, end };
        }
    }
    let visit = walk.percepts().len().saturating_sub(1);
    let end = match folding.open_count() {
        0 if folding.lacks_marker() => {
            WalkEnd::Contradiction { visit, contradiction: WalkContradiction::Unmarked }
        }
        0 => WalkEnd::Complete,
        open => WalkEnd::Open(open),
    };
    FoldedWalk { steps: folding.steps, end }
}

/// The folding of a walk, visit by visit.
#[derive(Clone)]
pub(super) struct Folding {
    percepts: Vec<Percept>,
    doors: Vec<Door>,
    marker: MarkerKind,
    /// For each visit, that of its class, and the index there of the dart by which the robot came in.
    labels: Vec<(usize, u32)>,
    /// For each visit its class, if the class has its darts from this visit.
    classes: Vec<Option<VertexClass>>,
    /// The first visit at which a directional marker was seen.
    marked: Option<usize>,
    pub(super) steps: Vec<UnionStep>,
    /// Pairs of passages that leave by one dart.
    pending: Vec<[Passage; 2]>,
}

/// Visits that are known to be at one vertex.
#[derive(Clone)]
struct VertexClass {
    members: Vec<usize>,
    /// For each dart of the vertex, a passage that leaves by it.
    passages: Vec<Option<Passage>>,
    views: Views,
}

/// What was seen at a vertex, each with the visit: under index 0, as seen from dart 0; of a mark on an edge, under the
/// dart by which the robot came.
type Views = BTreeMap<u32, (usize, Percept)>;

impl VertexClass {
    fn degree(&self) -> u32 {
        self.passages.len() as u32
    }

    /// Adds what was seen at a vertex. What was seen before must be the same.
    fn add_views(&mut self, views: Views) -> Result<(), WalkContradiction> {
        for (index, (visit, percept)) in views {
            let (earlier, seen) = *self.views.entry(index).or_insert((visit, percept));
            if seen != percept {
                return Err(WalkContradiction::Sightings([earlier, visit]));
            }
        }
        Ok(())
    }
}

impl Folding {
    pub(super) fn new(marker: MarkerKind) -> Self {
        Self {
            percepts: Vec::new(),
            doors: Vec::new(),
            marker,
            labels: Vec::new(),
            classes: Vec::new(),
            marked: None,
            steps: Vec::new(),
            pending: Vec::new(),
        }
    }

    /// The percept of the last visit.
    pub(super) fn last_percept(&self) -> Option<Percept> {
        self.percepts.last().copied()
    }

    /// Whether a directional marker was not seen.
    pub(super) fn lacks_marker(&self) -> bool {
        self.marker == Directional && self.marked.is_none()
    }

    pub(super) fn marks_edges(&self) -> bool {
        matches!(self.marker, UndirectedEdge | DirectedEdge)
    }

    /// The robot comes to its next visit, by a door if it is not the first one. After a contradiction the folding is of no
    /// more use.
    pub(super) fn arrive(
        &mut self,
        door: Option<Door>,
        percept: Percept,
    ) -> Result<(), WalkContradiction> {
        let visit = self.percepts.len();
        let passage = door.zip(visit.checked_sub(1));
        if let Some((door, number)) = passage {
            if door.0 >= self.percepts[number].degree {
                return Err(WalkContradiction::Door(number));
            }
            self.doors.push(door);
        }
        self.percepts.push(percept);
        if !can_be_perceived(percept, self.marker) {
            return Err(WalkContradiction::Percept(visit));
        }
        self.labels.push((visit, 0));
        self.classes.push(Some(VertexClass {
            members: vec![visit],
            passages: vec![None; percept.degree as usize],
            views: Views::from([(0, (visit, percept))]),
        }));
        if let Some((_, number)) = passage {
            self.pass(Passage { number, is_onward: true });
            self.pass(Passage { number, is_onward: false });
            self.follow()?;
        }
        if let Sighting::Pointing(door) = percept.sighting {
            let first = *self.marked.get_or_insert(visit);
            if let Sighting::Pointing(first_door) = self.percepts[first].sighting {
                self.unite(UnionStep::Mark([first, visit]), (first, first_door), (visit, door))?;
                self.follow()?;
            }
        }
        Ok(())
    }

    /// Enters a passage at the dart by which it leaves.
    fn pass(&mut self, passage: Passage) {
        let (root, index) = self.locate(self.near(passage));
        let Some(class) = &mut self.classes[root] else { return };
        match class.passages[index as usize] {
            Some(earlier) => self.pending.push([earlier, passage]),
            None => class.passages[index as usize] = Some(passage),
        }
    }

    /// Unites what is behind darts that are one.
    fn follow(&mut self) -> Result<(), WalkContradiction> {
        while let Some(passages) = self.pending.pop() {
            let [one, other] = passages.map(|passage| self.far(passage));
            self.unite(UnionStep::Beyond(passages), one, other)?;
        }
        Ok(())
    }

    /// The dart by which a passage leaves: the door of a visit.
    fn near(&self, Passage { number, is_onward }: Passage) -> (usize, Door) {
        if is_onward { (number, self.doors[number]) } else { (number + 1, Door::BACK) }
    }

    /// The dart to which it leads.
    fn far(&self, passage: Passage) -> (usize, Door) {
        self.near(Passage { is_onward: !passage.is_onward, ..passage })
    }

    /// The class of a visit, and the index of the dart behind a door there.
    fn locate(&self, (visit, door): (usize, Door)) -> (usize, u32) {
        let (root, entry) = self.labels[visit];
        (root, turned(entry, door.0, self.percepts[visit].degree))
    }

    /// Two darts, each a door of a visit, are one.
    fn unite(
        &mut self,
        step: UnionStep,
        one: (usize, Door),
        other: (usize, Door),
    ) -> Result<(), WalkContradiction> {
        let [(mut root, mut to), (mut child, mut from)] =
            [one, other].map(|dart| self.locate(dart));
        if root == child {
            return if to == from { Ok(()) } else { Err(WalkContradiction::Step(step)) };
        }
        let size = |root: usize| self.classes[root].as_ref().map_or(0, |class| class.members.len());
        if size(root) < size(child) {
            ((root, to), (child, from)) = ((child, from), (root, to));
        }
        let Some(smaller) = self.classes[child].take() else { return Ok(()) };
        let Some(class) = &mut self.classes[root] else { return Ok(()) };
        let degree = class.degree();
        if smaller.degree() != degree {
            return Err(WalkContradiction::Step(step));
        }
        self.steps.push(step);
        // The index in the larger class of dart 0 of the smaller one.
        let shift = turned(to, degree - from, degree);
        for (index, passage) in (0..).zip(smaller.passages) {
            let Some(passage) = passage else { continue };
            let slot = &mut class.passages[turned(index, shift, degree) as usize];
            match *slot {
                Some(earlier) => self.pending.push([earlier, passage]),
                None => *slot = Some(passage),
            }
        }
        for &visit in &smaller.members {
            let (_, entry) = self.labels[visit];
            self.labels[visit] = (root, turned(entry, shift, degree));
        }
        class.members.extend(smaller.members);
        let is_on_edge = matches!(self.marker, UndirectedEdge | DirectedEdge);
        let back = Door(turned(0, degree - shift, degree));
        let views = smaller.views.into_iter().map(|(index, (visit, percept))| {
            if is_on_edge {
                (turned(index, shift, degree), (visit, percept))
            } else {
                (index, (visit, percept.seen_from(back)))
            }
        });
        class.add_views(views.collect())?;
        self.check_edges(root)
    }

    /// No edge at a vertex has one end only.
    fn check_edges(&self, root: usize) -> Result<(), WalkContradiction> {
        let Some(class) = &self.classes[root] else { return Ok(()) };
        let mut passages = (0..).zip(&class.passages);
        let one_end = passages.find_map(|(index, passage)| {
            passage.filter(|&passage| self.locate(self.far(passage)) == (root, index))
        });
        one_end.map_or(Ok(()), |passage| Err(WalkContradiction::Edge(passage.number)))
    }

    pub(super) fn open_count(&self) -> usize {
        let darts = self.classes.iter().flatten().flat_map(|class| &class.passages);
        darts.filter(|passage| passage.is_none()).count()
    }
}

/// An index at a vertex, turned clockwise; `by` is at most the degree.
pub(super) fn turned(index: u32, by: u32, degree: u32) -> u32 {
    ((u64::from(index) + u64::from(by)) % u64::from(degree)) as u32
}

/// Whether a robot with this marker perceives this at some vertex.
fn can_be_perceived(percept: Percept, marker: MarkerKind) -> bool {
    let shown = match percept.sighting {
        Sighting::Nothing => true,
        Sighting::Pointing(door) => marker == Directional && door.0 < percept.degree,
        Sighting::Lying(1) => [Undirected, TwoIdentical].contains(&marker),
        Sighting::Lying(2) => marker == TwoIdentical,
        Sighting::These(set) => {
            marker == TwoDistinct && MarkerSet::from_numbers([0, 1]).is_some_and(|both| set <= both)
        }
        Sighting::Passed => marker == UndirectedEdge,
        Sighting::PassedAlong | Sighting::PassedAgainst => marker == DirectedEdge,
        _ => false,
    };
    percept.degree > 0 && shown
}
