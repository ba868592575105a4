//! An explorer of your own, judged on every start: depth-first, with one directional marker.
//!
//! It always explores from the newest vertex. To find out where it has arrived, it walks home to the
//! marker as if it were at a known vertex, for each known vertex and entry that looks like it. This
//! is simple and wasteful. Run it with `cargo run --release -p toposlam-model --example depth_first`.

use std::error::Error;

use toposlam_model::{
    check::{ExploredMap, Explorer, ExplorerWorld, Flaw, Shard, Sweep},
    enumerate::Class,
    marker::Directional,
    percept::{Door, Percept, Sighting, retrace},
    world::{RefusedAction, World},
};

/// A dart of the map: a vertex, and the index clockwise from the dart by which it was first entered.
pub(crate) type End = (usize, u32);

/// The map: the far end of each dart, if known. Dart 0 of a vertex leads home.
#[derive(Default)]
pub(crate) struct DepthFirst {
    map: Vec<Vec<Option<End>>>,
}

impl DepthFirst {
    fn degree(&self, (vertex, _): End) -> u32 {
        self.map[vertex].len() as u32
    }

    fn door(&self, pose: End, index: u32) -> Door {
        Door::between(pose.1, index, self.degree(pose))
    }

    fn expected(&self, pose: End) -> Percept {
        let pointing = Sighting::Pointing(self.door(pose, 0));
        let sighting = if pose.0 == 0 { pointing } else { Sighting::Nothing };
        Percept { degree: self.degree(pose), sighting }
    }

    fn far(&self, vertex: usize, index: u32) -> Option<End> {
        self.map[vertex][index as usize]
    }

    fn join(&mut self, one: End, other: End) {
        self.map[one.0][one.1 as usize] = Some(other);
        self.map[other.0][other.1 as usize] = Some(one);
    }

    fn unexplored(&self) -> impl Iterator<Item = End> {
        let ends = |vertex: usize| (0..self.degree((vertex, 0))).map(move |index| (vertex, index));
        (0..self.map.len())
            .flat_map(ends)
            .filter(|&(vertex, index)| self.far(vertex, index).is_none())
    }

    /// Walks home as if the robot had come in by `pose`, and returns its pose at the marker; or, if
    /// that is wrong, goes back and returns nothing. `turned` is the door by which the robot really
    /// came in, counted from `pose`.
    fn walk_home(
        &self,
        mut pose: End,
        turned: &mut Door,
        world: &mut ExplorerWorld,
    ) -> Result<Option<End>, RefusedAction> {
        let mut trail = Vec::new();
        while let (1.., Some(next)) = (pose.0, self.far(pose.0, 0)) {
            let (door, degree) = (self.door(pose, 0), self.degree(pose));
            let entry = if trail.is_empty() { *turned } else { Door::BACK };
            world.traverse(door.seen_from(entry, degree))?;
            trail.push((door, degree));
            if world.percept()? != self.expected(next) {
                *turned = trail[0].0;
                return retrace(trail.into_iter())
                    .try_for_each(|door| world.traverse(door))
                    .map(|()| None);
            }
            pose = next;
        }
        Ok(Some(pose))
    }

    /// Walks from the marker to a vertex, and returns the robot's pose there.
    fn walk_to(
        &self,
        vertex: usize,
        from: End,
        world: &mut ExplorerWorld,
    ) -> Result<End, RefusedAction> {
        match self.far(vertex, 0) {
            Some((parent, index)) if vertex > 0 => {
                let pose = self.walk_to(parent, from, world)?;
                world.traverse(self.door(pose, index))?;
                Ok((vertex, 0))
            }
            _ => Ok(from),
        }
    }
}

impl Explorer for DepthFirst {
    type Marker = Directional;

    fn marker(&self) -> Directional {
        Directional
    }

    fn explore(&mut self, world: &mut ExplorerWorld) -> Result<ExploredMap<'_>, Flaw> {
        self.map = vec![vec![None; world.percept()?.degree as usize]];
        // The pose in the map, and the door by which the robot really came in.
        let (mut robot, mut turned) = ((0, 0), Door::BACK);
        'explore: while let Some(edge) = self.unexplored().last() {
            let lost = || Flaw::GaveUp("a known way does not lead home".to_owned());
            let home = self.walk_home(robot, &mut turned, world)?.ok_or_else(lost)?;
            let pose = self.walk_to(edge.0, home, world)?;
            world.traverse(self.door(pose, edge.1))?;
            turned = Door::BACK;
            let arrival = world.percept()?;
            let alike = |&end: &End| end != edge && self.expected(end) == arrival;
            for end in self.unexplored().filter(alike).collect::<Vec<_>>() {
                if let Some(home) = self.walk_home(end, &mut turned, world)? {
                    (robot, turned) = (home, Door::BACK);
                    self.join(edge, end);
                    continue 'explore;
                }
            }
            robot = (self.map.len(), 0);
            self.map.push(vec![None; arrival.degree as usize]);
            self.join(edge, robot);
        }
        let robot = (robot.0, (robot.1 + turned.0) % self.degree(robot));
        let first = |vertex| self.map[..vertex].iter().map(Vec::len).sum::<usize>() as u32;
        let number = |(vertex, index): End| first(vertex) + index;
        let ends = || {
            (0..self.map.len())
                .flat_map(|vertex| (0..self.degree((vertex, 0))).map(move |index| (vertex, index)))
        };
        let opposite: Vec<_> =
            ends().filter_map(|(vertex, index)| self.far(vertex, index)).map(number).collect();
        let clockwise: Vec<_> =
            ends().map(|end| number((end.0, (end.1 + 1) % self.degree(end)))).collect();
        ExploredMap::from_permutations(&opposite, &clockwise, 0, number(robot))
    }
}

#[allow(dead_code, reason = "a test has the explorer without the program")]
fn main() -> Result<(), Box<dyn Error>> {
    for edges in 1..=6 {
        let sweep = Sweep::new(Class::Multigraph, edges, Shard::WHOLE)?;
        let tally = sweep.run_explorers(DepthFirst::default, &());
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
