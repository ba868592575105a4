//! What a robot perceives at a vertex and how it moves: degrees, doors, sightings, door sequences
//! and the way back. Section 2.1, "Robot motion and perception".

mod ball;
mod words;

use std::{cmp::Ordering, fmt};

use serde::{Serialize, Serializer};

use crate::{
    counts::counted,
    direction::Direction,
    embedded_graph::{Dart, EmbeddedGraph},
};

pub use ball::{Ball, BehindDoors};
pub use words::UnknownSighting;

/// A way out of a vertex: the `i`-th dart clockwise from the one by which the robot came in. Door 0
/// is the way back.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub struct Door(pub u32);

impl Door {
    pub const BACK: Door = Door(0);

    /// The door that leads from the dart with index `from` to the one with index `to`, at a vertex
    /// of the given degree; both indices are below it.
    #[inline]
    #[must_use]
    pub fn between(from: u32, to: u32, degree: u32) -> Self {
        Self(if to >= from { to - from } else { degree.wrapping_sub(from - to) })
    }

    /// The door `-d`: the one that undoes this one, at a vertex of the given degree.
    #[inline]
    #[must_use]
    pub fn inverse(self, degree: u32) -> Self {
        Self::between(self.0, 0, degree)
    }

    /// The door as it is called when the robot counts from the dart behind `entry` instead of from
    /// its entry dart.
    #[inline]
    #[must_use]
    pub fn seen_from(self, entry: Door, degree: u32) -> Self {
        Self::between(entry.0, self.0, degree)
    }
}

/// What the marker in use adds to a percept.
#[expect(clippy::derived_hash_with_manual_eq, reason = "equal sightings have equal fields")]
#[derive(Clone, Copy, Debug, Eq, PartialOrd, Ord, Hash)]
pub enum Sighting {
    Nothing,
    /// The directional marker is here and points along this door.
    Pointing(Door),
    /// This number of undirected markers that look alike are here; at least one.
    Lying(u32),
    /// A directional marker that stays, and one that is carried; at least one of them is here.
    TwoMarkers(TwoMarkersView),
    /// Of markers that look different, these are here.
    These(MarkerSet),
    Passed,
    /// The edge just traversed is marked, by an arrow in the sense of the traversal.
    PassedAlong,
    /// The edge just traversed is marked, by an arrow in the opposite sense.
    PassedAgainst,
    /// A string is here.
    String(StringView),
    /// The other robots of the team.
    Team(TeamView),
    /// What is near, through binoculars.
    Ball(Ball),
    /// Where the doors lead, by a compass.
    Compass(CompassView),
}

/// What Algorithm 1 compares in each move is inlined.
impl PartialEq for Sighting {
    #[inline]
    fn eq(&self, other: &Self) -> bool {
        use Sighting::{Nothing, Pointing};
        match (self, other) {
            (Nothing, Nothing) => true,
            (Pointing(one), Pointing(other)) => one == other,
            (Nothing | Pointing(_), _) | (_, Nothing | Pointing(_)) => false,
            _ => self.is_same_rare(other),
        }
    }
}

impl Sighting {
    /// Whether two sightings of other kinds are equal.
    #[inline(never)]
    fn is_same_rare(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

/// The direction of each of at most four doors, from door 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CompassView([Option<Direction>; 4]);

impl CompassView {
    /// Directions after the fourth are left out.
    pub fn new(directions: impl IntoIterator<Item = Direction>) -> Self {
        let mut view = Self::default();
        for (shown, direction) in view.0.iter_mut().zip(directions) {
            *shown = Some(direction);
        }
        view
    }

    pub fn directions(self) -> impl Iterator<Item = Direction> {
        self.0.into_iter().flatten()
    }

    fn seen_from(self, entry: Door, degree: u32) -> Self {
        let doors = (0..degree).map(|door| (entry.0 + door) % degree);
        Self::new(doors.filter_map(|door| self.0.get(door as usize).copied().flatten()))
    }
}

/// `doors to the south, the north and the east`.
impl fmt::Display for CompassView {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let names: Vec<_> = self.directions().map(|direction| format!("the {direction}")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let plural = if names.len() == 1 { "" } else { "s" };
        write!(out, "door{plural} to {}", listed(&names))
    }
}

/// Some of at most eight markers that look different; at least one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct MarkerSet(u8);

impl MarkerSet {
    /// The set of the markers with these numbers, from 0; `None` if it is empty.
    pub fn from_numbers(numbers: impl IntoIterator<Item = usize>) -> Option<Self> {
        let set = numbers.into_iter().filter(|&at| at < 8).fold(0, |set, at| set | 1_u8 << at);
        (set != 0).then_some(Self(set))
    }

    pub(crate) fn bits(self) -> u32 {
        self.0.into()
    }

    /// The numbers of its markers, from 0.
    pub fn numbers(self) -> impl Iterator<Item = usize> {
        (0..8).filter(move |at| self.0 >> at & 1 == 1)
    }
}

/// The names of markers that look different.
const MARKER_NAMES: [&str; 8] =
    ["first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth"];

impl MarkerSet {
    /// The names of its markers: `first`, `second` and so on.
    pub fn names(self) -> Vec<&'static str> {
        self.numbers().map(|at| MARKER_NAMES[at]).collect()
    }
}

/// `first marker`, `first and third marker`.
impl fmt::Display for MarkerSet {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        write!(out, "{} marker", listed(&self.names()))
    }
}

/// Some of the first [`MOST`](Self::MOST) doors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct DoorSet(u32);

impl DoorSet {
    /// A set holds doors below this number.
    pub const MOST: u32 = u32::BITS;

    /// Adds a door, which is below [`MOST`](Self::MOST).
    pub fn insert(&mut self, door: Door) {
        self.0 |= 1_u32.checked_shl(door.0).unwrap_or_default();
    }

    pub(crate) fn bits(self) -> u32 {
        self.0
    }

    pub fn doors(self) -> impl Iterator<Item = Door> {
        (0..Self::MOST).filter(move |door| self.0 >> door & 1 == 1).map(Door)
    }

    fn seen_from(self, entry: Door, degree: u32) -> Self {
        let mut turned = Self::default();
        self.doors().for_each(|door| turned.insert(door.seen_from(entry, degree)));
        turned
    }
}

/// What a robot sees of a string at a vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct StringView {
    /// The doors through which it runs.
    pub doors: DoorSet,
    /// Whether the end that is fixed is here.
    pub fixed_end: bool,
    /// Whether the other end lies here.
    pub free_end: bool,
    /// If the robot holds that end: the door through which the string runs from its hand.
    pub hand: Option<Door>,
}

impl fmt::Display for StringView {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let doors: Vec<_> = self.doors.doors().map(|door| door.0.to_string()).collect();
        let doors: Vec<&str> = doors.iter().map(String::as_str).collect();
        let plural = if doors.len() == 1 { "" } else { "s" };
        let runs =
            (!doors.is_empty()).then(|| format!("string through door{plural} {}", listed(&doors)));
        let hand = self.hand.map(|door| format!("from the hand through door {}", door.0));
        let ends = [(self.fixed_end, "fixed end"), (self.free_end, "free end")];
        let ends = ends.into_iter().filter(|(is_here, _)| *is_here).map(|(_, end)| end.to_owned());
        let parts: Vec<_> = runs.into_iter().chain(hand).chain(ends).collect();
        write!(out, "{}", parts.join(", "))
    }
}

/// What a robot sees of a directional marker that stays, and of one that is carried.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TwoMarkersView {
    /// If the directional marker is here: the door along which it points.
    pub along: Option<Door>,
    /// Whether the movable marker lies here.
    pub movable: bool,
}

impl TwoMarkersView {
    /// What it adds to a percept.
    pub fn sighting(self) -> Sighting {
        if self == Self::default() { Sighting::Nothing } else { Sighting::TwoMarkers(self) }
    }
}

/// `directional marker along door 1, movable marker`.
impl fmt::Display for TwoMarkersView {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let along = self.along.map(|door| format!("directional marker along door {}", door.0));
        let movable = self.movable.then(|| "movable marker".to_owned());
        let parts: Vec<_> = along.into_iter().chain(movable).collect();
        write!(out, "{}", parts.join(", "))
    }
}

/// What a robot knows of the others of its team: the second robot, and the third.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TeamView(pub [OtherRobot; 2]);

/// Another robot of a team.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum OtherRobot {
    /// There is none.
    #[default]
    Absent,
    /// At a vertex with so many doors, where none of the robots before it is.
    Elsewhere { degree: u32 },
    /// Here; it does not show along which door it stands.
    Here,
    /// Here, along this door.
    HereAlong(Door),
    /// Where the second robot is; it does not show along which door it stands.
    WithSecond,
    /// Where the second robot is, along this door as that one counts.
    WithSecondAlong(Door),
}

impl TeamView {
    fn seen_from(self, entry: Door, degree: u32) -> Self {
        Self(self.0.map(|robot| match robot {
            OtherRobot::HereAlong(door) => OtherRobot::HereAlong(door.seen_from(entry, degree)),
            other => other,
        }))
    }
}

/// `robot 2 here along door 1, robot 3 elsewhere at 4 doors`.
impl fmt::Display for TeamView {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let robot = |(number, robot): (u8, &OtherRobot)| {
            let place = match robot {
                OtherRobot::Absent => return None,
                OtherRobot::Elsewhere { degree } => {
                    format!("elsewhere at {}", counted(*degree as usize, "door"))
                }
                OtherRobot::Here => "here".to_owned(),
                OtherRobot::HereAlong(door) => format!("here along door {}", door.0),
                OtherRobot::WithSecond => "with robot 2".to_owned(),
                OtherRobot::WithSecondAlong(door) => format!("with robot 2 along door {}", door.0),
            };
            Some(format!("robot {number} {place}"))
        };
        let robots: Vec<_> = (2..).zip(&self.0).filter_map(robot).collect();
        write!(out, "{}", robots.join(", "))
    }
}

/// `1`, `1 and 2`, `1, 2 and 3`.
fn listed(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [name] => (*name).to_owned(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

impl fmt::Display for Sighting {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Nothing => write!(out, "no marker"),
            Self::Pointing(door) => write!(out, "marker along door {}", door.0),
            Self::Lying(1) => write!(out, "marker"),
            Self::Lying(count) => write!(out, "{count} markers"),
            Self::TwoMarkers(view) => write!(out, "{view}"),
            Self::These(markers) => write!(out, "{markers}"),
            Self::Passed => write!(out, "past the mark"),
            Self::PassedAlong => write!(out, "past the mark, along its arrow"),
            Self::PassedAgainst => write!(out, "past the mark, against its arrow"),
            Self::String(view) => write!(out, "{view}"),
            Self::Team(view) => write!(out, "{view}"),
            Self::Ball(ball) => write!(out, "{ball}"),
            Self::Compass(view) => write!(out, "{view}"),
        }
    }
}

/// In words.
impl Serialize for Sighting {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

// paper: percept.degree, percept.featureless
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub struct Percept {
    pub degree: u32,
    pub sighting: Sighting,
}

/// The number of doors, and the marker if it is noticed: `3 doors, marker along door 1`.
impl fmt::Display for Percept {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let Self { degree, sighting } = self;
        write!(out, "{degree} door{}", if *degree == 1 { "" } else { "s" })?;
        if *sighting == Sighting::Nothing { Ok(()) } else { write!(out, ", {sighting}") }
    }
}

impl Percept {
    /// The percept of the same vertex for a robot that came in by the door `entry` instead. A mark on
    /// that edge is not known, and left out.
    #[inline]
    #[must_use]
    pub fn seen_from(self, entry: Door) -> Self {
        use Sighting::{
            Ball, Compass, Nothing, Passed, PassedAgainst, PassedAlong, Pointing, String, Team,
            TwoMarkers,
        };
        let seen_from = |door: Door| door.seen_from(entry, self.degree);
        let sighting = match self.sighting {
            Pointing(door) => Pointing(seen_from(door)),
            TwoMarkers(view) => {
                TwoMarkers(TwoMarkersView { along: view.along.map(seen_from), ..view })
            }
            String(view) => String(StringView {
                doors: view.doors.seen_from(entry, self.degree),
                hand: view.hand.map(seen_from),
                ..view
            }),
            Team(view) => Team(view.seen_from(entry, self.degree)),
            Ball(ball) => Ball(ball.seen_from(entry.0)),
            Compass(view) => Compass(view.seen_from(entry, self.degree)),
            Passed | PassedAlong | PassedAgainst if entry != Door::BACK => Nothing,
            same => same,
        };
        Self { sighting, ..self }
    }
}

/// An event of a walk. Percepts and doors take turns: percept 0 at the start, door 0, percept 1, door 1 and so on.
/// Events are ordered as they happen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WalkEvent {
    Percept(usize),
    /// The door that is taken after this many moves.
    Door(usize),
}

impl WalkEvent {
    /// The event with this index among all events of the walk, counted from 0.
    pub fn at(index: usize) -> Self {
        let moves = index / 2;
        if index.is_multiple_of(2) { Self::Percept(moves) } else { Self::Door(moves) }
    }

    /// The index of the event among all events of the walk, counted from 0.
    pub fn index(self) -> usize {
        match self {
            Self::Percept(moves) => 2 * moves,
            Self::Door(moves) => 2 * moves + 1,
        }
    }

    pub fn moves(self) -> usize {
        match self {
            Self::Percept(moves) | Self::Door(moves) => moves,
        }
    }
}

impl Ord for WalkEvent {
    fn cmp(&self, other: &Self) -> Ordering {
        self.index().cmp(&other.index())
    }
}

impl PartialOrd for WalkEvent {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl EmbeddedGraph {
    /// The dart behind a door, for a robot that came in by the dart `pose`; doors are counted
    /// modulo the degree. This is also the dart by which the robot leaves.
    // paper: percept.entry, percept.doors
    #[inline]
    pub fn behind(&self, pose: Dart, door: Door) -> Dart {
        let degree = self.degree_around(pose);
        let turn = if door.0 < degree { door.0 } else { door.0 % degree };
        let index = self.index(pose);
        // Never overflows: `index + turn - degree` is computed without the sum.
        let step = if turn >= degree - index { turn.wrapping_sub(degree) } else { turn };
        Dart(pose.0.wrapping_add(step))
    }

    /// The pose after leaving by a door: the robot comes in by the other end of that edge.
    // paper: motion.door
    #[inline]
    pub fn after(&self, pose: Dart, door: Door) -> Dart {
        self.opposite(self.behind(pose, door))
    }

    /// The pose at the end of a door sequence.
    // paper: motion.path
    pub fn walk(&self, pose: Dart, doors: &[Door]) -> Dart {
        doors.iter().fold(pose, |pose, &door| self.after(pose, door))
    }
}

/// The door sequence that leads back along a path, from the doors that it took and the degrees of
/// the vertices at which it took them, in the order in which they were met.
///
/// After `d1 ... dk` the way back is `0, -dk, ..., -d2`; it ends at the vertex where the path
/// began, and the robot then has come in by the door `d1`, as it was called at the beginning.
// paper: alg1.15
pub fn retrace<P>(path: P) -> impl Iterator<Item = Door>
where
    P: DoubleEndedIterator<Item = (Door, u32)> + ExactSizeIterator,
{
    let back = (path.len() > 0).then_some(Door::BACK);
    back.into_iter().chain(path.skip(1).rev().map(|(door, degree)| door.inverse(degree)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::any_graph::by_neighbours;

    #[test]
    fn the_events_of_a_walk_take_turns() {
        use WalkEvent::{Door, Percept};
        let events = [Percept(0), Door(0), Percept(1), Door(1), Percept(2)];
        assert!(events.is_sorted());
        for (index, event) in events.into_iter().enumerate() {
            assert_eq!((WalkEvent::at(index), event.index()), (event, index));
        }
        assert_eq!(events.map(WalkEvent::moves), [0, 0, 1, 1, 2]);
    }

    fn k4() -> EmbeddedGraph {
        by_neighbours("a: b c d | b: a d c | c: a b d | d: a c b")
    }

    #[test]
    fn doors_are_counted_clockwise_from_the_entry() {
        let graph = k4();
        for pose in graph.darts() {
            assert_eq!(graph.behind(pose, Door(0)), pose);
            assert_eq!(graph.behind(pose, Door(1)), graph.clockwise(pose));
            assert_eq!(graph.behind(pose, Door(2)), graph.counterclockwise(pose));
            assert_eq!(graph.behind(pose, Door(3)), pose);
            assert_eq!(graph.behind(pose, Door(u32::MAX)), pose);
        }
    }

    #[test]
    fn the_way_back_ends_where_the_path_began_turned_by_its_first_door() {
        let graph = k4();
        for pose in graph.darts() {
            for doors in (0..27).map(|n| [Door(n % 3), Door(n / 3 % 3), Door(n / 9)]) {
                let path = doors.map(|door| (door, 3));
                let back: Vec<_> = retrace(path.into_iter()).collect();
                let end = graph.walk(graph.walk(pose, &doors), &back);
                assert_eq!(end, graph.behind(pose, doors[0]));
            }
        }
        assert_eq!(retrace(std::iter::empty()).count(), 0);
    }

    /// A mark on an edge is noticed by a robot that has just traversed it.
    #[test]
    fn a_mark_on_the_edge_of_another_entry_is_left_out() {
        for sighting in [Sighting::Passed, Sighting::PassedAlong, Sighting::PassedAgainst] {
            let percept = Percept { degree: 3, sighting };
            assert_eq!(percept.seen_from(Door::BACK), percept);
            let nothing = Percept { degree: 3, sighting: Sighting::Nothing };
            assert_eq!(percept.seen_from(Door(1)), nothing);
        }
    }
}
