//! A visit, and the bookkeeping of several.

use std::f64::consts::PI;

use nalgebra::Point2;
use toposlam_model::{
    driving::{scene::wrapped, visit::JunctionShape},
    measurement::HallwayMeasurement,
    percept::Sighting,
};

use crate::{
    laser::params::CornerParams,
    place::{Certainty, PlaceArm, nearest_direction},
};

/// The visits of a robot, in their order.
#[derive(Clone, Debug, Default)]
pub struct VisitLog<S> {
    pub visits: Vec<Visit<S>>,
    /// Where the robot has turned back since the last one.
    pub turned_back: Vec<S>,
}

/// A robot's stay at a place. Points and directions are in the frame of odometry at that time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Visit<S> {
    pub at: S,
    pub centre: Point2<f64>,
    /// The distance from the centre to the nearest wall, in metres; 0 by a camera.
    pub clearance: f64,
    /// What is nearer to the centre is within the place, in metres.
    pub extent: f64,
    /// Clockwise from the entry door; empty if nothing is known of the place.
    pub arms: Vec<PlaceArm>,
    /// The direction to where the robot came in; `None` if that is the first arm.
    pub came: Option<f64>,
    /// A dead end, and a place with two arms where a way bends by at least this angle, in radians, is a vertex; `None`:
    /// only a place with three arms is.
    pub least_bend: Option<f64>,
    /// How the robot left; `None` if the log ends there.
    pub exit: Option<VisitExit<S>>,
    /// Whether it left the way that it came.
    pub goes_back: bool,
    pub doubt: Option<UndecidedCause>,
    /// `None` if the sensor sees any shape.
    pub shape: Option<JunctionShape>,
    /// `None` if the sensor sees no markers.
    pub sighting: Option<Sighting>,
    /// Where the robot has turned back since the visit before.
    pub turned_back: Vec<S>,
    /// The hallway since the visit before; `None` if the robot turned back in it, or that visit is undecided.
    pub hallway: Option<HallwayMeasurement>,
}

/// How a robot left a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisitExit<S> {
    pub at: S,
    pub direction: f64,
    /// The angle between the door and the direction of the hallway that the robot is in, in radians; `None` if the sensor
    /// does not measure it.
    pub off: Option<f64>,
}

/// What was perceived, and the door that was taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct VisitPercept {
    pub degree: u32,
    /// `None` if the robot has not left.
    pub door: Option<u32>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UndecidedCause {
    /// Its images or scans do not show the junction clearly.
    Unclear,
    /// There may be an arm that the laser scanner did not look into.
    UnseenArm,
    /// The robot drove in a direction in which the laser scanner did not look.
    UnseenWay,
}

impl UndecidedCause {
    pub fn name(self) -> &'static str {
        match self {
            Self::Unclear => "unclear",
            Self::UnseenArm => "unseen-arm",
            Self::UnseenWay => "unseen-way",
        }
    }
}

impl<S> VisitLog<S> {
    /// Adds a visit. `length` returns the length of the hallway since the visit before, in metres.
    pub(super) fn push(
        &mut self,
        mut visit: Visit<S>,
        length: impl FnOnce(&Visit<S>) -> Option<f64>,
    ) {
        visit.turned_back = std::mem::take(&mut self.turned_back);
        let before = self.visits.last().filter(|before| before.doubt.is_none());
        let before = before.filter(|_| visit.turned_back.is_empty() && visit.doubt.is_none());
        visit.hallway = before.and_then(|before| {
            let ends = before.exit_arm().zip(visit.entry());
            let turn = ends.map(|(exit, entry)| wrapped(entry + PI - exit));
            Some(HallwayMeasurement { length: length(before)?, turn })
        });
        self.visits.push(visit);
    }
}

/// With more arms that are only possible, nothing is known of a visit: each doubles the number of its alternatives.
const MOST_POSSIBLE_ARMS: usize = 8;

impl<S> Visit<S> {
    /// The percepts that the views cannot exclude, of which `None` is no junction; empty if nothing is known. The door is 0
    /// if the robot left the way that it came, and only then.
    pub fn alternatives(&self) -> Vec<Option<VisitPercept>> {
        let possible = self.arms.iter().filter(|arm| arm.certainty == Certainty::Possible).count();
        if self.arms.is_empty() || possible > MOST_POSSIBLE_ARMS {
            return Vec::new();
        }
        let alternative = |chosen: u32| {
            let mut next = 0;
            let is_there = |arm: &&PlaceArm| match arm.certainty {
                Certainty::Certain => true,
                Certainty::Excluded => false,
                Certainty::Possible => {
                    next += 1;
                    chosen >> (next - 1) & 1 == 1
                }
            };
            let arms: Vec<f64> =
                self.arms.iter().filter(is_there).map(|arm| arm.direction).collect();
            self.is_vertex(&arms).then(|| self.percept_with(&arms))
        };
        let fits = |seen: &Option<VisitPercept>| {
            let door = seen.and_then(|seen| seen.door);
            door.is_none_or(|door| (door == 0) == self.goes_back)
        };
        let mut all: Vec<_> = (0..1 << possible).map(alternative).filter(fits).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    fn is_vertex(&self, arms: &[f64]) -> bool {
        match (arms, self.least_bend) {
            (&[one, other], Some(least)) => CornerParams::bend([one, other]) >= least,
            ([_, _, _, ..], _) | ([_], Some(_)) => true,
            _ => false,
        }
    }

    /// The percept of the arms that are certain, and the door that was taken.
    pub fn percept(&self) -> VisitPercept {
        self.percept_with(&self.doors())
    }

    fn percept_with(&self, arms: &[f64]) -> VisitPercept {
        let degree = arms.len();
        let entry = self.came.and_then(|way| nearest_direction(arms, way)).unwrap_or_default();
        let exit = self.exit.as_ref().and_then(|exit| nearest_direction(arms, exit.direction));
        let door = exit.map(|exit| ((exit + degree - entry) % degree) as u32);
        VisitPercept { degree: degree as u32, door }
    }

    /// The directions of the arms that are certain, clockwise from the entry door.
    pub fn doors(&self) -> Vec<f64> {
        self.arms.iter().filter(|arm| arm.is_certain()).map(|arm| arm.direction).collect()
    }

    pub fn entry(&self) -> Option<f64> {
        self.arms.first().map(|arm| arm.direction)
    }

    /// The direction of the door by which the robot left.
    fn exit_arm(&self) -> Option<f64> {
        let doors = self.doors();
        Some(doors[nearest_direction(&doors, self.exit.as_ref()?.direction)?])
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    /// A visit by a robot that came from the west and left to the east, with a possible arm in the north.
    fn visit(least_bend: Option<f64>) -> Visit<()> {
        let arm = |direction, certainty| PlaceArm { direction, certainty };
        let (north, south) = (FRAC_PI_2, -FRAC_PI_2);
        Visit {
            arms: vec![
                arm(PI, Certainty::Certain),
                arm(north, Certainty::Possible),
                arm(0.0, Certainty::Certain),
                arm(south, Certainty::Excluded),
            ],
            least_bend,
            exit: Some(VisitExit { at: (), direction: 0.1, off: None }),
            doubt: Some(UndecidedCause::UnseenArm),
            ..Visit::default()
        }
    }

    #[test]
    fn an_arm_that_is_possible_makes_alternatives_and_one_that_is_excluded_none() {
        let percept = |degree, door| Some(VisitPercept { degree, door: Some(door) });
        assert_eq!(visit(None).alternatives(), [None, percept(3, 2)]);
        assert_eq!(
            visit(Some(1.0)).alternatives(),
            [None, percept(3, 2)],
            "the way goes straight on"
        );
        let mut corner = visit(Some(1.0));
        corner.arms[2].direction = -1.0;
        assert_eq!(corner.alternatives(), [percept(2, 1), percept(3, 2)]);
        let mut unknown = visit(None);
        unknown.arms.clear();
        assert_eq!(unknown.alternatives(), []);
        // No alternative is left out: with too many possible arms there is none at all.
        let arm = PlaceArm { direction: 1.0, certainty: Certainty::Possible };
        unknown.arms = vec![arm; MOST_POSSIBLE_ARMS];
        assert!(!unknown.alternatives().is_empty());
        unknown.arms.push(arm);
        assert_eq!(unknown.alternatives(), []);
    }

    #[test]
    fn a_hallway_is_measured_between_two_visits_that_are_decided() {
        let turned = |turned_back: bool, doubts: [bool; 2]| {
            let mut log = VisitLog::default();
            for doubt in doubts {
                let doubt = doubt.then_some(UndecidedCause::Unclear);
                log.push(Visit { doubt, ..visit(None) }, |_| Some(7.0));
                log.turned_back.extend(turned_back.then_some(()));
            }
            log.visits[1].hallway.map(|hallway| (hallway.length, hallway.turn))
        };
        // It went straight on.
        assert_eq!(turned(false, [false, false]), Some((7.0, Some(0.0))));
        for (turned_back, doubts) in
            [(true, [false, false]), (false, [true, false]), (false, [false, true])]
        {
            assert_eq!(turned(turned_back, doubts), None);
        }
    }

    #[test]
    fn a_hallway_turns_by_the_angle_from_where_a_robot_left_to_how_it_came_in() {
        let mut log = VisitLog::default();
        // It left to the north, and comes in from the west: it drives east.
        let mut first = Visit { doubt: None, ..visit(None) };
        first.arms[1].certainty = Certainty::Certain;
        first.exit = Some(VisitExit { at: (), direction: 1.5, off: None });
        let second = Visit { doubt: None, ..visit(None) };
        log.push(first, |_| panic!("there is no hallway before"));
        log.push(second, |before| Some(before.arms.len() as f64));
        let hallway = log.visits[1].hallway.unwrap();
        assert_eq!((hallway.length, hallway.turn), (4.0, Some(-FRAC_PI_2)));
    }

    #[test]
    fn what_leaves_a_visit_undecided_has_a_name() {
        use UndecidedCause::{Unclear, UnseenArm, UnseenWay};
        let names = [Unclear, UnseenArm, UnseenWay].map(UndecidedCause::name);
        assert_eq!(names, ["unclear", "unseen-arm", "unseen-way"]);
    }

    #[test]
    fn a_door_is_counted_clockwise_from_where_the_robot_came_in() {
        let (north, south) = (FRAC_PI_2, -FRAC_PI_2);
        let fork = |came: f64, left: f64| {
            let arms = [PI, north, 0.0, south].map(PlaceArm::certain).to_vec();
            let exit = Some(VisitExit { at: (), direction: left, off: None });
            Visit { arms, exit, came: Some(came), ..visit(None) }.percept()
        };
        for (came, left, door) in [
            (PI, PI, 0),
            (PI, north, 1),
            (PI, south, 3),
            (0.0, south, 1),
            (south, PI, 1),
            (south, 0.0, 3),
        ] {
            assert_eq!(fork(came, left), VisitPercept { degree: 4, door: Some(door) });
        }
    }

    #[test]
    fn a_percept_by_whose_doors_a_robot_that_went_through_went_back_is_none() {
        // Without the possible arm in the north, the arm nearest to where the robot left is the one by which it came in.
        let left = VisitExit { at: (), direction: 2.2, off: None };
        let mut through = Visit { exit: Some(left), came: Some(PI), ..visit(None) };
        through.arms[3].certainty = Certainty::Certain;
        let percept = |degree, door| Some(VisitPercept { degree, door: Some(door) });
        assert_eq!(through.alternatives(), [percept(4, 1)]);
        through.goes_back = true;
        assert_eq!(through.alternatives(), [percept(3, 0)]);
    }
}
