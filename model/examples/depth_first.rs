//! An explorer of your own, judged on every start: depth-first, with one directional marker.
//!
//! It always explores from the newest vertex. To find out where it has arrived, it walks home to the
//! marker as if it were at a known vertex, for each known vertex and entry that looks like it. This
//! is simple and wasteful. Run it with `cargo run --release -p toposlam-model --example depth_first`.

use std::error::Error;

use toposlam_model::{
    check::{Check, RunChoices, Shard},
    enumerate::Class,
    mapping::{ExploredMap, Explorer, Flaw, InvalidStep, Mapped, MappingError, ObservedWorld},
    marker::{Directional, MarkerKind},
    percept::{Door, Percept, Sighting, retrace},
    world::World,
};

/// A dart of the map: a vertex, and the index clockwise from the dart by which it was first entered.
pub(crate) type End = (usize, u32);

/// The state of a run.
#[derive(Clone, Default)]
pub(crate) struct DepthFirst {
    /// The map: the far end of each dart, if known. Dart 0 of a vertex leads home.
    far: Vec<Vec<Option<End>>>,
    /// The robot's pose in the map.
    pose: End,
}

impl DepthFirst {
    fn degree(&self, vertex: usize) -> u32 {
        self.far[vertex].len() as u32
    }

    fn unexplored(&self) -> Vec<End> {
        let darts = |vertex| (0..self.degree(vertex)).map(move |index| (vertex, index));
        let all = (0..self.far.len()).flat_map(darts);
        all.filter(|&(vertex, index)| self.far[vertex][index as usize].is_none()).collect()
    }

    /// The door to a dart of the vertex, for a robot that came in by `pose`.
    fn door(&self, (vertex, entry): End, index: u32) -> Door {
        Door::between(entry, index, self.degree(vertex))
    }

    fn expected(&self, pose: End) -> Percept {
        let pointing = Sighting::Pointing(self.door(pose, 0));
        let sighting = if pose.0 == 0 { pointing } else { Sighting::Nothing };
        Percept { degree: self.degree(pose.0), sighting }
    }

    /// Walks home as if the robot had come in by `pose`, and returns its pose there. If a percept
    /// shows that this is wrong, it goes back and returns nothing.
    fn walk_home<W: World>(&self, mut pose: End, world: &mut W) -> Result<Option<End>, W::Error> {
        let mut way = Vec::new();
        while let (1.., Some(next)) = (pose.0, self.far[pose.0][0]) {
            way.push((self.door(pose, 0), self.degree(pose.0)));
            world.traverse(self.door(pose, 0))?;
            if world.percept()? != self.expected(next) {
                retrace(way.into_iter()).try_for_each(|door| world.traverse(door))?;
                return Ok(None);
            }
            pose = next;
        }
        Ok(Some(pose))
    }

    /// Walks from `home`, the robot's pose at the marker, to a vertex, and takes a dart of it.
    fn take<W: World>(
        &self,
        (vertex, index): End,
        home: End,
        world: &mut W,
    ) -> Result<(), W::Error> {
        let mut pose = home;
        if let (1.., Some(parent)) = (vertex, self.far[vertex][0]) {
            self.take(parent, home, world)?;
            pose = (vertex, 0);
        }
        world.traverse(self.door(pose, index))
    }

    /// Looks for the dart by which the robot came to a known vertex, and returns it and the robot's
    /// pose after that. If there is none, the robot is at a new vertex.
    fn recognise<W: World>(&mut self, edge: End, world: &mut W) -> Result<(End, End), W::Error> {
        let degree = world.percept()?.degree;
        // The index of the dart by which it came in last, counted from that by which it arrived.
        let mut turned = 0;
        for (vertex, index) in self.unexplored() {
            let pose = (vertex, (index + turned) % self.degree(vertex));
            if (vertex, index) != edge && self.expected(pose) == world.percept()? {
                if let Some(home) = self.walk_home(pose, world)? {
                    return Ok(((vertex, index), home));
                }
                turned = Door(index).inverse(degree).0;
            }
        }
        self.far.push(vec![None; degree as usize]);
        let vertex = self.far.len() - 1;
        Ok(((vertex, 0), (vertex, turned)))
    }
}

impl Explorer for DepthFirst {
    type Aid = MarkerKind;
    type Choice = End;

    fn aid(&self) -> MarkerKind {
        Directional
    }

    fn begin<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        let degree = world.percept().map_err(MappingError::World)?.degree;
        (self.far, self.pose) = (vec![vec![None; degree as usize]], (0, 0));
        Ok(())
    }

    fn choose(&mut self) -> Result<Option<End>, InvalidStep> {
        Ok(self.unexplored().last().copied())
    }

    fn step<W: ObservedWorld>(&mut self, edge: End, world: &mut W) -> Mapped<W> {
        let lost = || MappingError::GaveUp("a known way does not lead home".to_owned());
        let home = self.walk_home(self.pose, world).map_err(MappingError::World)?;
        self.take(edge, home.ok_or_else(lost)?, world).map_err(MappingError::World)?;
        let (end, pose) = self.recognise(edge, world).map_err(MappingError::World)?;
        self.far[edge.0][edge.1 as usize] = Some(end);
        self.far[end.0][end.1 as usize] = Some(edge);
        self.pose = pose;
        Ok(())
    }

    fn explored(&self) -> Result<ExploredMap<'_>, Flaw> {
        ExploredMap::from_far_ends(&self.far, self.pose)
    }
}

#[allow(dead_code, reason = "a test has the explorer without the program")]
fn main() -> Result<(), Box<dyn Error>> {
    for edges in 1..=6 {
        let sweep = Check::new(Class::Multigraph, edges, Shard::WHOLE)?;
        let tally = sweep.run(DepthFirst::default, RunChoices::Default, &());
        println!(
            "{edges} edges: {} of {} starts mapped correctly, with up to {} moves",
            tally.mapped,
            tally.starts,
            tally.moves_max(),
        );
        if let Some(failed) = tally.failure {
            return Err(failed.flaw.into());
        }
    }
    Ok(())
}
