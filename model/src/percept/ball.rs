//! What a robot with binoculars sees: the embedded ball around its vertex.

use std::fmt;

use crate::counts::counted;

/// The embedded ball of some radius around the robot's vertex: its vertices are those within that distance, each with its
/// doors in clockwise order; its edges are those between two of them.
///
/// It is written in 128 bits as it is traversed from the robot's pose. So balls are equal exactly if they look alike. A
/// larger one [is not seen](Self::TOO_LARGE).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Ball([u32; 4]);

/// The rooted form of a ball: for each vertex in the order of discovery, breadth first, what is behind each of its doors,
/// clockwise from the door by which it was discovered; at the robot's vertex, from its entry door.
struct Patch {
    behind: Vec<BehindDoors>,
    distance: Vec<u32>,
}

/// For each door of a vertex, the vertex and the door behind it, if they are seen.
pub type BehindDoors = Vec<Option<(usize, usize)>>;

/// A vertex of a patch, and a door there.
type Place = (usize, usize);

/// A ball with more darts takes more than 128 bits.
const MOST_DARTS: usize = 128;

/// The number of bits of the radius.
const RADIUS_BITS: u32 = 2;

impl Ball {
    /// It stands for every ball that takes more than 128 bits.
    pub const TOO_LARGE: Self = Self([0; 4]);

    /// The largest radius.
    pub const MOST_RADIUS: u32 = (1 << RADIUS_BITS) - 1;

    /// The ball around the vertex of a dart. `around` lists the darts of a vertex clockwise from one of them.
    pub(crate) fn around<D: Copy + PartialEq>(
        pose: D,
        radius: u32,
        around: impl Fn(D) -> Vec<D>,
        opposite: impl Fn(D) -> Option<D>,
    ) -> Self {
        let patch = Patch::discover(pose, radius, around, opposite);
        let words = patch.and_then(|patch| patch.write(radius));
        words.map_or(Self::TOO_LARGE, Self)
    }

    /// For each vertex, breadth first from the robot's, the vertex and the door behind each of its doors, if it is seen;
    /// clockwise from the door by which it was discovered. `None` if the ball is too large.
    pub fn behind(self) -> Option<Vec<BehindDoors>> {
        Patch::read(self.0).map(|(patch, _)| patch.behind)
    }

    pub(crate) fn words(self) -> [u32; 4] {
        self.0
    }

    /// The ball for a robot that came in by another door, counted from its entry.
    pub(super) fn seen_from(self, entry: u32) -> Self {
        let Some((patch, radius)) = Patch::read(self.0) else { return Self::TOO_LARGE };
        let degree = |vertex: usize| patch.behind.get(vertex).map_or(0, Vec::len);
        let around = |(vertex, door): Place| {
            (0..degree(vertex)).map(|turn| (vertex, (door + turn) % degree(vertex))).collect()
        };
        Self::around((0, entry as usize), radius, around, |(vertex, door)| {
            patch.behind.get(vertex).and_then(|doors| doors.get(door)).copied().flatten()
        })
    }
}

/// `sees 3 junctions: 1 2, 0 -, 0 -`: for each, the junctions behind its doors. The robot is at 0. Where several edges
/// join the same junctions, `1:2` is door 2 of junction 1.
impl fmt::Display for Ball {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let Some(behind) = self.behind() else {
            return write!(out, "sees too much");
        };
        let junction = |(here, doors): (usize, &BehindDoors)| {
            let edges_to =
                |there: usize| doors.iter().flatten().filter(|far| far.0 == there).count();
            let door = |far: &Option<Place>| match far {
                None => "-".to_owned(),
                Some((there, door)) if *there == here || edges_to(*there) > 1 => {
                    format!("{there}:{door}")
                }
                Some((there, _)) => there.to_string(),
            };
            doors.iter().map(door).collect::<Vec<_>>().join(" ")
        };
        let junctions: Vec<_> = behind.iter().enumerate().map(junction).collect();
        write!(out, "sees {}: {}", counted(behind.len(), "junction"), junctions.join(", "))
    }
}

impl Patch {
    /// `None` if there are too many darts.
    fn discover<D: Copy + PartialEq>(
        pose: D,
        radius: u32,
        around: impl Fn(D) -> Vec<D>,
        opposite: impl Fn(D) -> Option<D>,
    ) -> Option<Self> {
        let mut vertices = vec![around(pose)];
        let mut distance = vec![0];
        let mut darts = vertices[0].len();
        let mut next = 0;
        while let Some((here, &at)) = vertices.get(next).zip(distance.get(next)) {
            if darts > MOST_DARTS {
                return None;
            }
            next += 1;
            let far = if at < radius { here.clone() } else { Vec::new() };
            for far in far.into_iter().filter_map(&opposite) {
                if !vertices.iter().flatten().any(|&known| known == far) {
                    let new = around(far);
                    darts += new.len();
                    if darts > MOST_DARTS {
                        return None;
                    }
                    vertices.push(new);
                    distance.push(at + 1);
                }
            }
        }
        let place = |dart: D| {
            let places = vertices.iter().enumerate();
            let mut found = places.filter_map(|(vertex, darts)| {
                darts.iter().position(|&known| known == dart).map(|door| (vertex, door))
            });
            found.next()
        };
        let behind = |darts: &Vec<D>| -> BehindDoors {
            darts.iter().map(|&dart| opposite(dart).and_then(place)).collect()
        };
        Some(Self { behind: vertices.iter().map(behind).collect(), distance })
    }

    /// `None` if it takes too many bits.
    fn write(&self, radius: u32) -> Option<[u32; 4]> {
        let mut bits = Bits::default();
        bits.push(radius, RADIUS_BITS)?;
        let mut degrees = self.behind.iter().map(|doors| doors.len() as u32);
        bits.push_degree(degrees.next()?)?;
        let mut known = 1;
        for (here, (doors, &distance)) in self.behind.iter().zip(&self.distance).enumerate() {
            for (door, &far) in doors.iter().enumerate() {
                let Some(far) = far else {
                    bits.push(0, 1)?;
                    continue;
                };
                if far < (here, door) {
                    continue;
                }
                let is_new = far.0 == known;
                // Behind a door at less than the radius is a vertex of the ball, known or not; behind one at the radius, a
                // known vertex or none.
                bits.push(u32::from(is_new || distance == radius), 1)?;
                if is_new {
                    known += 1;
                    bits.push_degree(degrees.next()?)?;
                } else {
                    let open = self.open_after((here, door), known);
                    let index = open.iter().position(|&other| other == far)?;
                    bits.push(index as u32, width(open.len()))?;
                }
            }
        }
        Some(bits.words)
    }

    /// The darts of the known vertices behind this one that no edge before it has as an end.
    fn open_after(&self, at: Place, known: usize) -> Vec<Place> {
        let vertices = self.behind.iter().enumerate().take(known).skip(at.0);
        let places = vertices.flat_map(|(vertex, doors)| {
            doors.iter().enumerate().map(move |(door, far)| ((vertex, door), *far))
        });
        let open = places.filter(|&(place, far)| place > at && far.is_none_or(|far| far >= at));
        open.map(|(place, _)| place).collect()
    }

    /// The patch and its radius; `None` if the bits are not those of one.
    fn read(words: [u32; 4]) -> Option<(Self, u32)> {
        let mut bits = Bits { words, used: 0 };
        let radius = bits.take(RADIUS_BITS).filter(|&radius| radius > 0)?;
        let mut patch = Self { behind: Vec::new(), distance: Vec::new() };
        patch.add_vertex(bits.take_degree()?, 0)?;
        let mut here = 0;
        while let Some((degree, distance)) = patch.vertex(here) {
            for door in 0..degree {
                let is_joined = patch.behind.get(here)?.get(door)?.is_some();
                if is_joined {
                    continue;
                }
                let flag = bits.take(1)? == 1;
                let far = match (distance < radius, flag) {
                    (false, false) => continue,
                    (true, true) => {
                        patch.add_vertex(bits.take_degree()?, distance + 1)?;
                        (patch.behind.len() - 1, 0)
                    }
                    (true, false) | (false, true) => {
                        let open = patch.open_after((here, door), patch.behind.len());
                        let index = bits.take(width(open.len()))?;
                        *open.get(index as usize)?
                    }
                };
                patch.join((here, door), far)?;
            }
            here += 1;
        }
        Some((patch, radius))
    }

    fn vertex(&self, vertex: usize) -> Option<(usize, u32)> {
        Some((self.behind.get(vertex)?.len(), *self.distance.get(vertex)?))
    }

    fn add_vertex(&mut self, degree: u32, distance: u32) -> Option<()> {
        let degree = usize::try_from(degree).ok().filter(|&degree| degree <= MOST_DARTS)?;
        self.behind.push(vec![None; degree]);
        self.distance.push(distance);
        Some(())
    }

    fn join(&mut self, one: Place, other: Place) -> Option<()> {
        for (near, far) in [(one, other), (other, one)] {
            *self.behind.get_mut(near.0)?.get_mut(near.1)? = Some(far);
        }
        Some(())
    }
}

/// The number of bits of an index below this number.
fn width(count: usize) -> u32 {
    usize::BITS - count.saturating_sub(1).leading_zeros()
}

/// A queue of bits.
#[derive(Default)]
struct Bits {
    words: [u32; 4],
    used: u32,
}

impl Bits {
    /// `None` if there is no space left.
    fn push(&mut self, value: u32, width: u32) -> Option<()> {
        for bit in (0..width).rev() {
            let word = self.words.get_mut((self.used / u32::BITS) as usize)?;
            *word |= (value >> bit & 1) << (u32::BITS - 1 - self.used % u32::BITS);
            self.used += 1;
        }
        Some(())
    }

    fn take(&mut self, width: u32) -> Option<u32> {
        let mut value = 0;
        for _ in 0..width {
            let word = self.words.get((self.used / u32::BITS) as usize)?;
            value = value << 1 | word >> (u32::BITS - 1 - self.used % u32::BITS) & 1;
            self.used += 1;
        }
        Some(value)
    }

    /// A degree of 1, 2 or 3 takes two bits; another one `11`, and Elias' gamma code.
    fn push_degree(&mut self, degree: u32) -> Option<()> {
        if (1..4).contains(&degree) {
            return self.push(degree - 1, 2);
        }
        self.push(3, 2)?;
        let more = degree.checked_sub(3)?;
        let length = u32::BITS - more.leading_zeros();
        self.push(0, length - 1)?;
        self.push(more, length)
    }

    fn take_degree(&mut self) -> Option<u32> {
        let short = self.take(2)?;
        if short < 3 {
            return Some(short + 1);
        }
        let mut length = 1;
        while self.take(1)? == 0 {
            length += 1;
        }
        let rest = self.take(length - 1)?;
        1_u32.checked_shl(length - 1)?.checked_add(rest)?.checked_add(3)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{
        any_graph::{Class, any_graph},
        embedded_graph::{Dart, EmbeddedGraph},
        percept::Door,
    };

    fn ball(graph: &EmbeddedGraph, pose: Dart, radius: u32) -> Ball {
        let around = |dart| {
            let doors = 0..graph.degree_around(dart);
            doors.map(|door| graph.behind(dart, Door(door))).collect()
        };
        Ball::around(pose, radius, around, |dart| Some(graph.opposite(dart)))
    }

    #[test]
    fn a_ball_in_words_lists_what_is_behind_the_doors_of_each_junction() {
        let text = |graph: &EmbeddedGraph, radius| ball(graph, Dart(0), radius).to_string();
        assert_eq!(text(&EmbeddedGraph::cycle(3), 1), "sees 3 junctions: 1 2, 0 2, 0 1");
        assert_eq!(text(&EmbeddedGraph::cycle(4), 1), "sees 3 junctions: 1 2, 0 -, 0 -");
        assert_eq!(text(&EmbeddedGraph::chain(1), 1), "sees 2 junctions: 1, 0");
        let two = EmbeddedGraph::from_edge_lists(&[
            ("v", vec!["a", "b", "loop", "loop"]),
            ("w", vec!["b", "a"]),
        ]);
        let seen = "sees 2 junctions: 1:0 1:1 0:3 0:2, 0:0 0:1";
        assert_eq!(text(&two.unwrap(), 1), seen);
        assert_eq!(Ball::TOO_LARGE.to_string(), "sees too much");
    }

    proptest! {
        /// No two balls are written alike: what is read is what was written.
        #[test]
        fn a_ball_is_read_as_it_was_written(
            graph in any_graph(Class::Multigraph, 9),
            radius in 1..=Ball::MOST_RADIUS,
        ) {
            for pose in graph.darts() {
                let around = |dart| {
                    let doors = 0..graph.degree_around(dart);
                    doors.map(|door| graph.behind(dart, Door(door))).collect()
                };
                let opposite = |dart| Some(graph.opposite(dart));
                let patch = Patch::discover(pose, radius, around, opposite).unwrap();
                let words = patch.write(radius).unwrap();
                let (read, its_radius) = Patch::read(words).unwrap();
                prop_assert_eq!(its_radius, radius);
                prop_assert_eq!(read.behind, patch.behind);
                prop_assert_eq!(read.distance, patch.distance);
            }
        }

        #[test]
        fn a_ball_is_turned_with_the_robot(
            graph in any_graph(Class::Multigraph, 9),
            radius in 1..=Ball::MOST_RADIUS,
        ) {
            for pose in graph.darts() {
                for door in 0..graph.degree_around(pose) {
                    let turned = graph.behind(pose, Door(door));
                    prop_assert_eq!(
                        ball(&graph, pose, radius).seen_from(door),
                        ball(&graph, turned, radius)
                    );
                }
            }
        }

        #[test]
        fn any_bits_are_read_without_a_panic(words in any::<[u32; 4]>(), door in 0..40_u32) {
            let ball = Ball(words);
            let _ = (ball.to_string(), ball.seen_from(door));
        }
    }
}
