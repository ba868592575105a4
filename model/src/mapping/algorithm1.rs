//! Algorithm 1: mapping with a single directional immovable marker. Section 2.3.
//!
//! The numbers are those of the printed lines. The state is a plain value: to try every choice, clone it together
//! with the world where the run waits for one, at line 4 or at line 8. Memory is reused from run to run.

use std::{cmp::Reverse, mem};

use super::{
    Contradiction, CostOrder, Explorer, ExplorerInfo, InvalidStep, MapDart, MapWalk, Mapped,
    MappingError, MappingEvent, ObservedWorld, PartialMap, StateLevel, StepPurpose,
    map_walk::has_walk, partial_map::START,
};
use crate::{
    clone_in_place::clone_in_place,
    embedded_graph::Dart,
    marker::DirectionalMarker,
    percept::{Door, Percept, Sighting, retrace},
};

/// One open choice, made. A run takes one step for each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MappingChoice {
    /// Line 5: the unexplored dart to explore next.
    Edge(Dart),
    /// Line 9: the index of the hypothesis to try next, among those that are left.
    Hypothesis(usize),
}

/// The state of a run of Algorithm 1: the robot's walk, and the hypotheses about its place.
#[derive(Debug, Default)]
pub struct Algorithm1Run {
    walk: MapWalk,
    current: CurrentVertex,
    /// H, from the farthest to the nearest.
    hypotheses: Vec<Dart>,
    /// Within a step: the degree of each vertex since the path began, and the door taken there.
    trail: Vec<(u32, Door)>,
}

clone_in_place!(Algorithm1Run { walk, current, hypotheses; scratch trail });

has_walk!(Algorithm1Run);

#[derive(Clone, Copy, Debug)]
struct CurrentVertex {
    degree: u32,
    /// The door, counted from the reference dart, by which it really came in. It differs from
    /// [`Door::BACK`] after a rejected hypothesis.
    entry: Door,
}

impl Default for CurrentVertex {
    fn default() -> Self {
        Self { degree: 0, entry: Door::BACK }
    }
}

/// Algorithm 1. The default choices are the nearest edge and the nearest hypothesis.
// paper: alg1.return, alg1.terminates, alg1.every-world
impl Explorer for Algorithm1Run {
    type Aid = DirectionalMarker;
    type Choice = MappingChoice;

    fn info(&self) -> ExplorerInfo {
        ExplorerInfo {
            option: "algorithm1",
            title: "Algorithm 1",
            in_words: "Algorithm 1",
            order: CostOrder::EdgesSquaredVertices,
        }
    }

    fn aid(&self) -> DirectionalMarker {
        DirectionalMarker
    }

    fn limit_darts(&mut self, max_darts: usize) {
        self.walk.set_bound(max_darts);
    }

    /// Lines 1 to 3: the marker lies at v0; S is v0; U is its edges.
    // paper: alg1.1, alg1.2, alg1.3
    fn begin<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        self.walk.clear();
        self.current = CurrentVertex::default();
        self.hypotheses.clear();
        self.trail.clear();
        let percept = world.percept().map_err(MappingError::World)?;
        if percept.degree == 0 || percept.sighting != Sighting::Pointing(Door::BACK) {
            return Err(Contradiction::Start { perceived: percept }.into());
        }
        self.walk.begin(percept, world)?;
        self.enter(percept.degree);
        Ok(())
    }

    /// Lines 4 and 8: the choice to go on with; `None` when S is the map.
    // paper: alg1.5
    #[inline]
    fn choose(&mut self) -> Result<Option<MappingChoice>, InvalidStep> {
        Ok(if self.is_at_line_8() {
            self.hypotheses.len().checked_sub(1).map(MappingChoice::Hypothesis)
        } else {
            self.walk.nearest_unexplored().map(MappingChoice::Edge)
        })
    }

    fn add_choices(&mut self, choices: &mut Vec<MappingChoice>) -> Result<(), InvalidStep> {
        self.add_open_choices(choices);
        Ok(())
    }

    /// The first part of line 6.
    #[inline]
    fn approach<W: ObservedWorld>(&mut self, choice: MappingChoice, world: &mut W) -> Mapped<W> {
        match choice {
            MappingChoice::Edge(edge) => {
                self.walk.travel_to(self.map().vertex(edge), PartialMap::expected, world)
            }
            MappingChoice::Hypothesis(_) => Ok(()),
        }
    }

    #[inline]
    fn step<W: ObservedWorld>(&mut self, choice: MappingChoice, world: &mut W) -> Mapped<W> {
        self.step_with(choice, world, Self::try_path)
    }

    fn map_walk(&self) -> Option<&MapWalk> {
        Some(&self.walk)
    }

    fn write_key(&self, key: &mut Vec<u32>) -> Option<StateLevel> {
        Some(if self.is_at_line_8() {
            StateLevel::within_round(&self.hypotheses, key)
        } else {
            StateLevel::between_rounds(self.map(), self.map().vertex(self.robot()), key)
        })
    }

    fn purpose(&self, choice: Option<MappingChoice>) -> StepPurpose {
        let named = |dart| MapDart::new(self.map(), dart);
        match choice {
            None => StepPurpose::Done,
            Some(MappingChoice::Edge(edge)) => StepPurpose::Explore(named(edge)),
            Some(MappingChoice::Hypothesis(index)) => {
                StepPurpose::Try(named(self.hypotheses[index]))
            }
        }
    }

    /// `m n + 2 m^2 (n - 1)`.
    // paper: cost.bound
    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        let (m, n) = (edges as u64, vertices as u64);
        let paths = m.saturating_mul(m).saturating_mul(n.saturating_sub(1).saturating_mul(2));
        m.saturating_mul(n).saturating_add(paths)
    }
}

impl Algorithm1Run {
    /// At line 8: the hypotheses that are left, each the unexplored dart by which the robot would
    /// have come in, from the farthest from the marker to the nearest.
    pub fn hypotheses(&self) -> &[Dart] {
        &self.hypotheses
    }

    /// Whether the run waits at line 8, for a hypothesis, and not at line 4, for an edge.
    pub(crate) fn is_at_line_8(&self) -> bool {
        self.walk.edge.is_some()
    }

    /// Adds edges in the order of their numbers, or hypotheses from the farthest to the nearest.
    pub(crate) fn add_open_choices(&self, choices: &mut Vec<MappingChoice>) {
        if self.is_at_line_8() {
            choices.extend((0..self.hypotheses.len()).map(MappingChoice::Hypothesis));
        } else {
            choices.extend(self.map().unexplored().map(MappingChoice::Edge));
        }
    }

    /// Lines 4 to 23, from one choice to the next, with this function for lines 10 to 17.
    // paper: alg1.4, alg1.8, alg1.9, alg1.17, alg1.18, alg1.21
    #[inline]
    fn step_with<W: ObservedWorld>(
        &mut self,
        choice: MappingChoice,
        world: &mut W,
        try_path: impl FnOnce(&mut Self, Dart, &mut W) -> Mapped<W, bool>,
    ) -> Mapped<W> {
        match choice {
            // 4, 5: U is not empty; remove the unexplored edge e from it.
            MappingChoice::Edge(edge) => {
                // 6, 7: follow e to its unknown end vu; H is the hypotheses about it.
                self.explore(edge, world)?;
            }
            // 8, 9: H is not empty; remove a hypothesis from it.
            MappingChoice::Hypothesis(index) => {
                let left = self.hypotheses.len();
                if index >= left {
                    return Err(InvalidStep::NoHypothesis { index, left }.into());
                }
                let hypothesis = self.hypotheses.remove(index);
                // 10 to 17: if it is confirmed, no other is tried.
                if try_path(self, hypothesis, world)? {
                    // 18, 19, 20: a loop was closed.
                    self.close_loop(hypothesis, world)?;
                }
            }
        }
        // 21, 22, 23: H is empty, and no hypothesis was confirmed: vu is a new place.
        if self.is_at_line_8() && self.hypotheses.is_empty() {
            self.add_place(world)?;
        }
        Ok(())
    }

    /// Lines 10 to 17: follows the path that leads to the marker if the hypothesis is true, as long as
    /// the percepts along it are as expected. Returns whether it is confirmed: then the robot stands at the marker;
    /// otherwise it is back where it was.
    // paper: alg1.10, alg1.11, alg1.12, alg1.13, alg1.14, alg1.15, alg1.16, alg1.17, alg1.validation
    fn try_path<W: ObservedWorld>(&mut self, hypothesis: Dart, world: &mut W) -> Mapped<W, bool> {
        self.trail.clear();
        let mut pose = hypothesis;
        let mut followed = 0;
        // 10: the motions of the path to v0, and the percepts expected along it.
        while let Some((door, next)) = self.walk.from_start.toward_root(self.map(), pose) {
            let expected = self.map().expected(next);
            // 11: try to traverse it.
            let perceived = self.go_through(door, world)?;
            followed += 1;
            // 12, 13: the percepts do not match.
            if perceived != expected {
                // 14, 15: reject the hypothesis, and retrace the path back to vu.
                self.retrace(world)?;
                let event = MappingEvent::Rejected { hypothesis, followed, expected, perceived };
                world.event(&self.walk, event);
                return Ok(false);
            }
            pose = next;
        }
        // 16, 17: the percepts match throughout; confirm the hypothesis.
        self.arrive_at_marker(pose);
        world.event(&self.walk, MappingEvent::Confirmed { hypothesis, followed });
        Ok(true)
    }

    /// Lines 6 and 7: goes through the known map to the known end of an unexplored edge, follows it
    /// to its unknown end, and lists the hypotheses about that: each unexplored dart by which the
    /// robot may have come in, except those that its percept contradicts at once.
    // paper: alg1.6, alg1.7
    fn explore<W: ObservedWorld>(&mut self, edge: Dart, world: &mut W) -> Mapped<W> {
        self.trail.clear();
        self.walk.explore(edge, PartialMap::expected, world)?;
        let percept = self.walk.arrival;
        self.enter(percept.degree);
        self.list_hypotheses(edge)?;
        let hypotheses = self.hypotheses.len();
        let contradicted = self.map().unexplored_count() as usize - 1 - hypotheses;
        let event = MappingEvent::Arrived { edge, percept, contradicted, hypotheses };
        world.event(&self.walk, event);
        Ok(())
    }

    // paper: alg1.hypotheses
    fn list_hypotheses(&mut self, edge: Dart) -> Result<(), Contradiction> {
        let Self { walk: MapWalk { map, arrival, from_start, .. }, hypotheses, .. } = self;
        let marked = arrival.sighting != Sighting::Nothing;
        hypotheses.clear();
        for dart in map.unexplored().rev() {
            let may_be = map.degree_around(dart) == arrival.degree
                && (map.vertex(dart) == START) == marked
                && dart != edge;
            // Without a marker, all darts of a vertex look alike.
            if may_be && (!marked || map.expected(dart) == *arrival) {
                hypotheses.push(dart);
            }
        }
        if hypotheses.is_empty() {
            let (vertex, index) = (map.vertex(edge), map.index(edge));
            let perceived = *arrival;
            return match perceived.sighting {
                Sighting::Nothing => Ok(()),
                _ => Err(Contradiction::Marker { vertex, index, perceived }),
            };
        }
        from_start.grow_from_unless_rooted(map, START);
        if hypotheses.len() > 1 {
            let hops = |dart: Dart| from_start.hops(map.vertex(dart));
            hypotheses.sort_unstable_by_key(|&dart| Reverse((hops(dart), dart)));
        }
        Ok(())
    }

    #[inline]
    fn go_through<W: ObservedWorld>(&mut self, door: Door, world: &mut W) -> Mapped<W, Percept> {
        let CurrentVertex { degree, entry } = self.current;
        self.trail.push((degree, door));
        let perceived = self.walk.go(door.seen_from(entry, degree), world)?;
        self.enter(perceived.degree);
        Ok(perceived)
    }

    /// Line 15: goes back along the trail, and counts doors there as before.
    // paper: alg1.15
    fn retrace<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        let trail = mem::take(&mut self.trail);
        let doors = retrace(trail.iter().map(|&(degree, door)| (door, degree)));
        for (back, &(degree, _)) in doors.zip(trail.iter().rev()) {
            let perceived = self.walk.go(back, world)?;
            // The path did not come to the marker.
            let expected = Percept { degree, sighting: Sighting::Nothing };
            if perceived != expected {
                return Err(Contradiction::WayBack { expected, perceived }.into());
            }
        }
        if let Some(&(degree, entry)) = trail.first() {
            self.current = CurrentVertex { degree, entry };
        }
        self.trail = trail;
        Ok(())
    }

    /// Lines 16 and 17: a path was followed to its end, and the robot knows that it has come to the
    /// marker by the dart `pose`.
    fn arrive_at_marker(&mut self, pose: Dart) {
        self.walk.robot = pose;
        self.enter(self.current.degree);
    }

    #[inline]
    fn enter(&mut self, degree: u32) {
        self.current = CurrentVertex { degree, entry: Door::BACK };
    }

    /// Lines 18 to 20: the edge leads to the known vertex of the hypothesis.
    // paper: alg1.18, alg1.19, alg1.20
    fn close_loop(
        &mut self,
        hypothesis: Dart,
        world: &mut impl ObservedWorld,
    ) -> Result<(), InvalidStep> {
        self.walk.close_loop(hypothesis, world)?;
        self.hypotheses.clear();
        Ok(())
    }

    /// Lines 21 to 23: the edge leads to a new vertex, whose other edges are unexplored. The robot
    /// is still there.
    // paper: alg1.21, alg1.22, alg1.23
    fn add_place<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        // The robot may have come back by another dart than it first came in by.
        let vertex = self.walk.add_place(self.current.entry, world)?;
        self.enter(self.map().degree(vertex));
        self.hypotheses.clear();
        Ok(())
    }
}

#[cfg(test)]
mod tests;
