//! Junctions: the corners and walls of each kind of junction, and its doors. Section 3, Figures 8 and 9.
//!
//! A corner and the width of the hallways give a turning point, and the type of the corner the junctions that it can
//! belong to. Each of these candidates is compared with all that is seen.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Vector2, distance};
use toposlam_model::driving::scene::{CERTAIN, CentreLine, JunctionView, wrapped};

use crate::{
    agreement::{OutlineAgreement, bearings},
    boundary::Boundary,
    corner::{Bend, Corner},
    hallway::{FittedHallway, HALF_WIDTH, status},
    outline::{DIRECTIONS, Outline, Square},
    wall::{Axis, WallFrame, WallSegment},
};

/// The robot is at a junction if its turning point is at most this far ahead or aside. Views.
const AHEAD: f64 = 1.0;
/// The robot has left a junction whose turning point is farther behind. Views.
const BEHIND: f64 = 0.75;
/// Turning points farther away on either axis are not considered. Geometry: their walls are too far away to be seen.
const MAX_DISTANCE: f64 = 1.9;
/// Every candidate is first compared on one bearing in this many. Views: faster, with the same results.
const COARSE_STEP: usize = 5;
/// The number of candidates that are then fitted. Views.
const SHORT_LIST: usize = 6;
/// The least trust in a junction. Views.
const MIN_TRUST: f64 = 0.75;
/// The least part of its walls that must be seen. Views.
const MIN_COVER: f64 = 0.40;
/// The fewest bearings in support, as a part of all. Views.
const MIN_SUPPORT: f64 = 0.17;
/// The least lead over a different junction, in bearings as a part of all. Views.
const MIN_LEAD: f64 = 0.04;
/// Junctions whose turning points are nearer to each other are the same. Views.
const SAME_PLACE: f64 = 0.25;
/// Candidates are the same if turning points and half widths differ by less. Views.
const SAME_CANDIDATE: f64 = 0.05;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FittedJunction {
    pub frame: WallFrame,
    /// Whether there is a door in each of the four [`DIRECTIONS`] of the frame.
    pub doors: [bool; 4],
    /// The turning point, and half the width between the edges that are seen.
    pub square: Square,
    pub agreement: OutlineAgreement,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JunctionSearch {
    Junction(FittedJunction),
    Ambiguous,
    Nothing,
}

/// The junction that fits the corners and walls.
// paper: sense.junction.type, sense.junction.two, sense.junction.three
pub fn junction(
    corners: &[Corner],
    walls: &[WallSegment],
    boundary: &Boundary,
    frame: &WallFrame,
) -> JunctionSearch {
    let mut guesses: Vec<FittedJunction> = Vec::new();
    for half in half_widths(walls) {
        for corner in corners {
            let (square, kinds) = around(corner, half);
            if square.middle.coords.amax() > MAX_DISTANCE {
                continue;
            }
            for doors in kinds {
                let known = guesses.iter().any(|guess| {
                    guess.doors == doors
                        && apart(guess.square, square) < SAME_CANDIDATE
                        && (guess.square.half - half).abs() < SAME_CANDIDATE
                });
                if !known {
                    let outline = Outline::junction(doors, square);
                    let every = COARSE_STEP;
                    let agreement = outline.agreement(boundary, frame, every);
                    guesses.push(FittedJunction { frame: *frame, doors, square, agreement });
                }
            }
        }
    }
    best_first(&mut guesses);
    guesses.truncate(SHORT_LIST);
    let mut found: Vec<_> = guesses.into_iter().map(|guess| guess.fitted(boundary)).collect();
    best_first(&mut found);
    decided(&found)
}

/// The best junction, if it is seen well and no different one is about as good. The best is first.
fn decided(found: &[FittedJunction]) -> JunctionSearch {
    let Some(&best) = found.first() else { return JunctionSearch::Nothing };
    let wide = HALF_WIDTH.contains(&best.square.half);
    let seen = best.agreement.cover() >= MIN_COVER
        && best.agreement.good() >= bearings(MIN_SUPPORT, 1)
        && best.agreement.blank == 0;
    if !wide || !seen || !best.agreement.holds(MIN_TRUST) {
        return JunctionSearch::Nothing;
    }
    // In a hallway it does not matter which junction is far ahead or behind.
    let differs = |other: &FittedJunction| {
        (best.is_here() || other.is_here())
            && (other.doors != best.doors || apart(other.square, best.square) > SAME_PLACE)
    };
    let lead = |other: &FittedJunction| best.agreement.balance() - other.agreement.balance();
    if found.iter().any(|other| differs(other) && lead(other) < bearings(MIN_LEAD, 1)) {
        return JunctionSearch::Ambiguous;
    }
    JunctionSearch::Junction(best)
}

fn best_first(guesses: &mut [FittedJunction]) {
    guesses.sort_by(|one, other| other.agreement.balance().total_cmp(&one.agreement.balance()));
}

fn apart(one: Square, other: Square) -> f64 {
    distance(&one.middle, &other.middle)
}

/// Half the distance between each two walls on opposite sides of the robot, each once.
fn half_widths(walls: &[WallSegment]) -> Vec<f64> {
    let same = SAME_CANDIDATE / 2.0;
    let mut halves: Vec<f64> = Vec::new();
    for (number, one) in walls.iter().enumerate() {
        for other in &walls[..number] {
            let half = (one.offset - other.offset).abs() / 2.0;
            let opposite = one.along == other.along && one.offset * other.offset < 0.0;
            let known = halves.iter().any(|&known: &f64| (known - half).abs() < same);
            if opposite && HALF_WIDTH.contains(&half) && !known {
                halves.push(half);
            }
        }
    }
    halves
}

/// The turning point of a junction with this corner, and the doors that the junction can have.
fn around(corner: &Corner, half: f64) -> (Square, [[bool; 4]; 3]) {
    let [x, y] = corner.arms.into();
    // The directions of the corner's two walls.
    let of_x = if x > 0.0 { 0 } else { 2 };
    let of_y = if y > 0.0 { 1 } else { 3 };
    let doors = |open: &[usize]| [0, 1, 2, 3].map(|direction| open.contains(&direction));
    let opposite = |direction: usize| (direction + 2) % 4;
    let (outwards, kinds) = match corner.bend {
        Bend::Outwards => (
            -half,
            [
                doors(&[of_x, of_y]),
                doors(&[of_x, of_y, opposite(of_x)]),
                doors(&[of_x, of_y, opposite(of_y)]),
            ],
        ),
        Bend::Inwards => (half, [doors(&[of_x, of_y]), doors(&[of_x]), doors(&[of_y])]),
    };
    (Square { middle: corner.position + outwards * corner.arms, half }, kinds)
}

impl FittedJunction {
    fn fitted(self, boundary: &Boundary) -> Self {
        let (mut square, mut frame) = (self.square, self.frame);
        for _ in 0..3 {
            let outline = Outline::junction(self.doors, square);
            (square, frame) = outline.fitted(square, boundary, &frame);
        }
        let outline = Outline::junction(self.doors, square);
        let agreement = outline.agreement(boundary, &frame, 1);
        Self { frame, square, agreement, ..self }
    }

    /// Whether the robot is there: the turning point is neither far ahead nor far behind.
    pub fn is_here(&self) -> bool {
        let away = -self.square.middle.x;
        let aside = self.square.middle.y.abs();
        (-AHEAD..=BEHIND).contains(&away) && aside <= AHEAD
    }

    pub fn hallway(&self, walls: &[WallSegment]) -> Option<FittedHallway> {
        let axis = self.arm()?;
        let mut square = self.square;
        square.middle[axis.split().0] = 0.0;
        let status = status(axis, self.frame.ahead(axis), square, walls);
        let agreement = self.agreement;
        let hallway = FittedHallway { frame: self.frame, axis, square, status, agreement };
        Some(hallway).filter(FittedHallway::has_robot)
    }

    fn arm(&self) -> Option<Axis> {
        let far = |direction: Vector2<f64>| -direction.dot(&self.square.middle.coords);
        (0..4)
            .filter(|&number| {
                self.doors[number] && far(DIRECTIONS[number]) > self.square.half / 2.0
            })
            .map(|number| if number % 2 == 0 { Axis::X } else { Axis::Y })
            .next()
    }

    /// The confidence in a junction that an image shows. Patterns on the floor look like walls, so each direction counts.
    pub fn confidence_in_image(&self) -> f64 {
        self.agreement.confidence().min(self.agreement.least)
    }

    /// The junction in a scene: its doors clockwise from the one behind. What a scanner shows is certain.
    // paper: sense.junction.entry, sense.centre-lines
    pub fn view(&self) -> JunctionView {
        let turning_point = (self.frame.robot_from_walls() * self.square.middle).into();
        let doors = (0..4).rev().filter(|&number| self.doors[number]).map(|number| CentreLine {
            through: turning_point,
            direction: wrapped(self.frame.angle() + number as f64 * FRAC_PI_2),
        });
        let confidence = self.agreement.confidence().max(CERTAIN);
        JunctionView { doors: doors.collect(), turning_point, confidence }
            .entered_from(std::f64::consts::PI)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Point2;

    use super::*;
    use crate::{
        bearing::{BEARINGS, bearing},
        boundary::Sight,
        corner::{CornerSource, corners},
        drawn_place::{self, DrawnPlace},
    };

    const HALF: f64 = 0.8;

    fn seen(doors: [bool; 4], hidden: std::ops::Range<usize>) -> JunctionSearch {
        let mut boundary = DrawnPlace::junction(doors, HALF).boundary([-0.3, 0.1], 0.2);
        for bearing in hidden {
            boundary.sights[bearing % BEARINGS] = Sight::default();
        }
        finding(&boundary, &drawn_place::walls(&boundary).unwrap())
    }

    fn finding(
        boundary: &Boundary,
        (frame, walls): &(WallFrame, Vec<WallSegment>),
    ) -> JunctionSearch {
        junction(&corners(walls), walls, boundary, frame)
    }

    #[test]
    fn no_junction_is_found_if_half_of_the_view_is_dark() {
        // The dark half has the difference between the L and the T.
        for doors in [[false, true, true, false], [false, true, true, true]] {
            let found = seen(doors, BEARINGS / 2..BEARINGS);
            assert!(!matches!(found, JunctionSearch::Junction(_)), "{doors:?}: {found:?}");
        }
    }

    #[test]
    fn no_junction_is_found_if_one_direction_is_dark() {
        let doors = [false, true, true, true];
        assert!(matches!(seen(doors, 0..0), JunctionSearch::Junction(_)));
        // The wall ahead, of a robot that is turned by 0.2.
        let ahead = BEARINGS - bearing(0.2);
        assert_eq!(
            seen(doors, ahead - BEARINGS / 9..ahead + BEARINGS / 9),
            JunctionSearch::Nothing
        );
    }

    #[test]
    fn no_junction_is_found_on_few_bearings() {
        let far_off = DrawnPlace::junction([false, true, true, true], 0.55);
        let boundary = far_off.boundary([-1.9, 0.0], 0.2);
        let walls = drawn_place::walls(&boundary).unwrap();
        let found = |every: usize| {
            let mut boundary = boundary.clone();
            for (bearing, sight) in boundary.sights.iter_mut().enumerate() {
                if bearing % every != 0 {
                    *sight = Sight::default();
                }
            }
            finding(&boundary, &walls)
        };
        // Half of its walls is seen, but on only a seventh of all bearings.
        assert!(matches!(found(1), JunctionSearch::Junction(_)));
        assert_eq!(found(2), JunctionSearch::Nothing);
    }

    #[test]
    fn a_corner_gives_the_turning_point_and_the_possible_doors() {
        let corner = |bend| Corner {
            position: Point2::new(0.5, 0.8),
            arms: Vector2::new(-1.0, 1.0),
            bend,
            formed: CornerSource::Clusters,
        };
        // An edge between the hallway behind and the one to the left.
        let (square, kinds) = around(&corner(Bend::Outwards), HALF);
        assert!((square.middle[0] - 1.3).abs() < 1e-9 && square.middle[1].abs() < 1e-9);
        assert_eq!(kinds[0], [false, true, true, false]);
        assert_eq!(kinds[1], [true, true, true, false]);
        assert_eq!(kinds[2], [false, true, true, true]);
        // A corner of the room, ahead to the right.
        let corner = Corner { position: Point2::new(0.5, -0.8), ..corner(Bend::Inwards) };
        let (square, kinds) = around(&corner, HALF);
        assert!((square.middle[0] + 0.3).abs() < 1e-9 && square.middle[1].abs() < 1e-9);
        assert_eq!(kinds[0], [false, true, true, false]);
        assert_eq!(kinds[1], [false, false, true, false]);
        assert_eq!(kinds[2], [false, true, false, false]);
    }
}
