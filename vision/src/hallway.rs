//! Hallways: two parallel walls on opposite sides of the robot, and floor that goes on. Section 3,
//! Figure 7.

use toposlam_model::driving::scene::{HallwayView, Status, Unclear, undirected};

use crate::{
    boundary::{BEARINGS, Boundary, direction},
    outline::{Agreement, Outline, Square},
    wall::{Axis, Frame, Wall},
};

/// A hallway that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Hallway {
    /// Turned so that the walls lie best on what is seen.
    pub frame: Frame,
    /// Along which axis of the frame it runs.
    pub axis: Axis,
    /// Its centre line and half its width, between the edges that were seen.
    pub square: Square,
    /// Whether it is clear.
    pub status: Status,
    /// How its walls agree with what is seen.
    pub agreement: Agreement,
}

/// Half the width of a hallway, in metres.
pub const HALF_WIDTH: std::ops::RangeInclusive<f64> = 0.45..=1.35;
/// A turning point that is farther ahead than this is not yet there: the robot is in the hallway
/// before it. In metres.
pub const AHEAD: f64 = 1.0;
/// A turning point that is farther behind than this has been left, in metres.
pub const BEHIND: f64 = 0.75;
/// Nearer than this to a turning point, the walls are open at a side; in metres. So much wall is
/// looked at, to either end, less half the width.
const CLOSED: f64 = 1.4;
/// A major cluster is at least so long, in metres,
const MAJOR: f64 = 0.25;
/// and begins no farther from the robot, along the hallway.
const BESIDE: f64 = 0.9;
/// What is seen must support the walls at least so much,
const TRUST: f64 = 0.90;
/// and this part of them must be seen.
const COVER: f64 = 0.35;
/// The floor is looked at so far to either side of the hallway's direction, in bearings.
const SECTOR: usize = BEARINGS / 30;
/// Further clusters nearer than this beside the robot count neither as ahead nor as behind, in metres.
const ABREAST: f64 = 0.3;
/// A further cluster is off the walls by more than this, in metres.
const OFF: f64 = 0.15;
/// The major clusters are of very different sizes where one is less than this part of the other.
const SIZES: f64 = 0.5;

/// The hallway in which the robot is, if it is in one.
// paper: sense.hallway.two-clusters
// paper: sense.hallway.major
#[must_use]
pub fn hallway(walls: &[Wall], boundary: &Boundary, frame: &Frame) -> Option<Hallway> {
    [Axis::X, Axis::Y]
        .into_iter()
        .filter_map(|axis| along(axis, walls, boundary, frame))
        .max_by(|one, other| one.agreement.balance().total_cmp(&other.agreement.balance()))
}

fn along(axis: Axis, walls: &[Wall], boundary: &Boundary, frame: &Frame) -> Option<Hallway> {
    let left = major(axis, 1.0, walls)?;
    let right = major(axis, -1.0, walls)?;
    let mut square = Square {
        middle: axis.point(0.0, f64::midpoint(left.offset, right.offset)),
        half: (left.offset - right.offset) / 2.0,
    };
    if !HALF_WIDTH.contains(&square.half) {
        return None;
    }
    let reach = CLOSED - square.half;
    let mut frame = *frame;
    for _ in 0..2 {
        let outline = Outline::hallway(axis, square, -reach - 0.3, reach + 0.3);
        (square, frame) = outline.fitted(square, boundary, &frame);
        square.middle[axis.split().0] = 0.0;
    }
    let agreement = Outline::hallway(axis, square, -reach, reach).agreement(boundary, &frame, 1);
    let goes_on = goes_on(axis, 1.0, square, boundary, &frame)
        && goes_on(axis, -1.0, square, boundary, &frame);
    (agreement.trust() >= TRUST && agreement.cover() >= COVER && goes_on).then(|| Hallway {
        frame,
        axis,
        square,
        status: status(axis, square, walls),
        agreement,
    })
}

/// The piece of wall that is nearest to the robot, on one side of an axis.
// paper: sense.opposite
// paper: sense.parallel
fn major(axis: Axis, side: f64, walls: &[Wall]) -> Option<&Wall> {
    walls
        .iter()
        .filter(|wall| {
            wall.along == axis
                && side * wall.offset > 0.0
                && wall.length() >= MAJOR
                && wall.from < BESIDE
                && wall.to > -BESIDE
        })
        .min_by(|one, other| one.offset.abs().total_cmp(&other.offset.abs()))
}

/// Whether the floor goes on, ahead or behind, so far that no turning point is near.
fn goes_on(axis: Axis, sign: f64, square: Square, boundary: &Boundary, frame: &Frame) -> bool {
    let (along, _) = axis.split();
    let whither = frame.unframed(axis.point(sign, 0.0));
    // The frame's x is nearest to ahead.
    let ahead = if axis == Axis::X { sign > 0.0 } else { whither[0] > 0.0 };
    let least = square.half + if ahead { AHEAD } else { BEHIND };
    let bearing = whither[1].atan2(whither[0]) / std::f64::consts::TAU * BEARINGS as f64;
    let first = (bearing.round() as i64 - SECTOR as i64).rem_euclid(BEARINGS as i64) as usize;
    let (mut far, mut near) = (0, 0);
    for bearing in (first..=first + 2 * SECTOR).map(|bearing| bearing % BEARINGS) {
        let sight = boundary.sights[bearing];
        let forwards = sign * frame.framed(direction(bearing))[along];
        match sight.wall {
            Some(wall) if wall * forwards < least => near += 1,
            None if sight.floor * forwards < least => {}
            _ => far += 1,
        }
    }
    far > 2 * near && far > SECTOR / 3
}

/// Whether the hallway is clear; by its direction that is nearer to ahead.
// paper: sense.clear.two
// paper: sense.clear.behind
// paper: sense.unclear.ahead
// paper: sense.unclear.sizes
// paper: sense.unclear.behind
pub(crate) fn status(axis: Axis, square: Square, walls: &[Wall]) -> Status {
    let (_, across) = axis.split();
    let centre = square.middle[across];
    let on = |wall: &&Wall, side: f64| {
        wall.along == axis && (wall.offset - centre - side * square.half).abs() < OFF
    };
    let is_major = |wall: &Wall| on(&wall, 1.0) || on(&wall, -1.0);
    let forwards = |wall: &Wall| {
        if wall.along == axis { f64::midpoint(wall.from, wall.to) } else { wall.offset }
    };
    if walls.iter().any(|wall| !is_major(wall) && forwards(wall) > ABREAST) {
        return Status::Unclear(Unclear::ClustersAhead);
    }
    let sides = [1.0, -1.0].map(|side| walls.iter().filter(move |wall| on(wall, side)));
    let [left, right] = sides.clone().map(|side| side.map(Wall::length).sum::<f64>());
    if left.min(right) < SIZES * left.max(right) {
        return Status::Unclear(Unclear::SizesDiffer);
    }
    let ends = sides.map(|side| side.map(|wall| wall.to).fold(f64::MIN, f64::max));
    if ends.iter().any(|&end| end < 0.0) {
        return Status::Unclear(Unclear::ClusterBehind);
    }
    Status::Clear
}

impl Hallway {
    /// What the robot is told of it; `margin` is from the edges that were seen to the wall planes.
    // paper: sense.distances
    #[must_use]
    pub fn view(&self, margin: f64) -> HallwayView {
        let heading = undirected(self.frame.angle() + self.axis.direction());
        let (_, across) = self.axis.split();
        // The robot's left is where the frame's y is, or the opposite of its x for a hallway along y.
        let leftwards = match self.axis {
            Axis::X => 1.0,
            Axis::Y if heading > 0.0 => -1.0,
            Axis::Y => 1.0,
        };
        let centre = leftwards * self.square.middle[across];
        let half = self.square.half + margin;
        HallwayView {
            heading,
            left: half + centre,
            right: half - centre,
            status: self.status,
            confidence: self.agreement.trust() * self.agreement.cover().sqrt(),
        }
    }
}
