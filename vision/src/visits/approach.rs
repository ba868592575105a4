//! Visits of a robot with a camera: approaches to a junction, one after the other.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

use nalgebra::Point2;
use toposlam_model::driving::{
    odometry::{Odometry, WayLength},
    scene::{JunctionView, MarkerView, Place, Scene, wrapped},
    visit::{JunctionEstimate, JunctionShape},
};

use super::visit::{UndecidedCause, Visit, VisitExit, VisitLog};
use crate::{
    geometry::{distance, unit},
    place::{Certainty, PlaceArm, PlaceView, SeenPlace, nearest_direction},
};

/// A junction is visited if its turning point comes this near, in metres.
pub const APPROACH_RANGE: f64 = 0.3;
/// A turning point this far from the last one is of another junction, in metres.
const ANOTHER: f64 = 1.5;
/// A robot this far from the turning point has left the junction, in metres. Nearer, a hallway is ignored.
const AWAY: f64 = 0.6;

#[derive(Clone, Debug)]
pub(super) struct ApproachRule<S> {
    approach: Option<Approach<S>>,
    /// The estimate from the scenes since the last junction.
    seen: JunctionEstimate,
    /// The heading when the robot was last in a hallway.
    hallway: Option<f64>,
    /// The way since the last visit.
    way: WayLength,
}

/// Consecutive scenes of one junction.
#[derive(Clone, Debug)]
struct Approach<S> {
    first: S,
    /// Whether there is a junction: some scene shows it for certain.
    is_certain: bool,
    estimate: JunctionEstimate,
    /// The direction of the entry door in the frame of odometry.
    entry: f64,
    /// In that frame.
    turning_point: Point2<f64>,
    /// The smallest distance to the turning point, in metres, and its scene.
    nearest: f64,
    visited: S,
    /// The length of the way to the nearest scene, in metres, and the way since then.
    driven: Option<f64>,
    onwards: WayLength,
}

impl<S: Copy + Default> ApproachRule<S> {
    pub(super) fn new(marked: bool) -> Self {
        let seen = if marked { JunctionEstimate::at_marker() } else { JunctionEstimate::default() };
        Self { approach: None, seen, hallway: None, way: WayLength::default() }
    }

    pub(super) fn add_view(&mut self, log: &mut VisitLog<S>, at: S, view: &PlaceView) {
        let Some(scene) = &view.scene else { return };
        let onwards = self.approach.as_mut().map(|approach| &mut approach.onwards);
        for way in [&mut self.way].into_iter().chain(onwards) {
            way.add(view.robot);
        }
        match (&scene.place, &view.possible_places[..]) {
            (Place::Hallway(_), _) => self.in_hallway(log, at, scene, &view.robot),
            (Place::Junction(junction), [place]) => {
                // At a junction, furniture that looks like another one shows nothing.
                let is_other = |it: &mut Approach<S>| {
                    distance(it.turning_point, place.centre) > ANOTHER
                        && (junction.is_certain() || !it.is_certain)
                };
                if let Some(approach) = self.approach.take_if(is_other) {
                    self.leave(log, at, &approach, view.robot.heading);
                    self.hallway = Some(view.robot.heading);
                }
                let junction = junction.clone();
                self.at_junction(at, junction, scene.marker, place, &view.robot);
            }
            _ => {}
        }
    }

    pub(super) fn status(&self) -> Option<SeenPlace> {
        let approach = self.approach.as_ref().filter(|approach| approach.is_visit())?;
        let arms = match approach.estimate.shape() {
            Some(shape) => approach.arms(shape),
            None if approach.is_certain => Vec::new(),
            None => approach.possible_arms(None),
        };
        Some(SeenPlace { centre: approach.turning_point, clearance: 0.0, arms })
    }

    pub(super) fn finish(mut self, log: &mut VisitLog<S>) {
        if let Some(approach) = self.approach.take().filter(Approach::is_visit) {
            self.visited(log, &approach, None);
        }
    }

    fn in_hallway(&mut self, log: &mut VisitLog<S>, at: S, scene: &Scene, robot: &Odometry) {
        if let Some(mut approach) = self.approach.take() {
            if !approach.is_over(robot) {
                // A junction that is still ahead looks like a hallway; its marker is visible.
                if !approach.is_visit() {
                    approach.estimate.add_scene(scene);
                }
                self.approach = Some(approach);
                return;
            }
            self.leave(log, at, &approach, robot.heading);
        } else if let Some(before) = self.hallway
            && wrapped(robot.heading - before).abs() > FRAC_PI_2
        {
            log.turned_back.push(at);
            self.seen = JunctionEstimate::default();
        }
        self.hallway = Some(robot.heading);
        self.seen.add_scene(scene);
    }

    /// The robot has left a junction or passed it.
    fn leave(&mut self, log: &mut VisitLog<S>, at: S, approach: &Approach<S>, heading: f64) {
        if approach.is_visit() {
            self.visited(log, approach, Some((at, heading)));
        } else if wrapped(heading - approach.entry).abs() < FRAC_PI_2 {
            log.turned_back.push(at);
        } else if approach.is_certain {
            log.push(approach.undecided(approach.first), |_| None);
        } else {
            log.push(approach.possible(Some((at, heading))), |_| None);
        }
    }

    fn at_junction(
        &mut self,
        at: S,
        junction: JunctionView,
        marker: Option<MarkerView>,
        place: &SeenPlace,
        robot: &Odometry,
    ) {
        let driven = self.way.length();
        let seen = &mut self.seen;
        let is_certain = junction.is_certain();
        let approach = self.approach.get_or_insert_with(|| Approach {
            first: at,
            is_certain,
            estimate: std::mem::take(seen),
            entry: entry_door(place, is_certain, robot),
            turning_point: place.centre,
            nearest: f64::INFINITY,
            visited: at,
            driven,
            onwards: WayLength::default(),
        });
        if is_certain && !approach.is_certain {
            let entry = entry_door(place, is_certain, robot);
            let (turning_point, nearest) = (place.centre, f64::INFINITY);
            *approach = Approach { is_certain, entry, turning_point, nearest, ..approach.clone() };
        }
        let centre =
            if approach.is_certain && !is_certain { approach.turning_point } else { place.centre };
        let off = distance(centre, robot.position);
        if off < approach.nearest {
            (approach.nearest, approach.visited, approach.driven) = (off, at, driven);
            approach.onwards = WayLength::default();
            approach.onwards.add(*robot);
        }
        let junction = junction.entered_from(robot.seen(approach.entry));
        approach.estimate.add_scene(&Scene { place: Place::Junction(junction), marker });
    }

    /// Adds a visit; it is undecided if the images do not decide the percept.
    fn visited(&mut self, log: &mut VisitLog<S>, approach: &Approach<S>, exit: Option<(S, f64)>) {
        let undecided = approach.undecided(approach.visited);
        let Approach { estimate, driven, onwards, .. } = approach;
        let (Some(shape), Some(percept)) = (estimate.shape(), estimate.percept()) else {
            let visit = if approach.is_certain { undecided } else { approach.possible(exit) };
            log.push(visit, |_| None);
            return;
        };
        let arms = approach.arms(shape);
        let exit = exit.map(|(at, direction)| {
            let doors: Vec<f64> = arms.iter().map(|arm| arm.direction).collect();
            let off = nearest_direction(&doors, direction)
                .map(|door| wrapped(direction - doors[door]).abs());
            VisitExit { at, direction, off }
        });
        let (shape, sighting) = (Some(shape), Some(percept.sighting));
        let visit = Visit { arms, exit, shape, sighting, doubt: None, ..undecided };
        let goes_back = visit.percept().door == Some(0);
        log.push(Visit { goes_back, ..visit }, |_| *driven);
        self.way = *onwards;
    }
}

impl<S: Copy + Default> Approach<S> {
    fn is_visit(&self) -> bool {
        self.nearest <= APPROACH_RANGE
    }

    /// Whether a robot in a hallway has left this junction: it is away from it after a visit, has passed it
    /// without one, or faces back.
    fn is_over(&self, robot: &Odometry) -> bool {
        let off = Point2::from(robot.position) - self.turning_point;
        let inwards = -off.dot(&unit(self.entry));
        let looks_back = wrapped(robot.heading - self.entry).abs() < FRAC_PI_2;
        off.norm() >= AWAY && (self.is_visit() || looks_back || inwards >= AWAY)
    }

    /// The arms of a shape, clockwise from the entry door.
    fn arms(&self, shape: JunctionShape) -> Vec<PlaceArm> {
        let arm = |quarter| wrapped(self.entry - f64::from(quarter) * FRAC_PI_2);
        shape.quarters().into_iter().map(|quarter| PlaceArm::certain(arm(quarter))).collect()
    }

    /// The arms of what may be a junction, clockwise from the entry door: that the robot came in and left is certain.
    fn possible_arms(&self, exit: Option<f64>) -> Vec<PlaceArm> {
        let driven = exit.map(|direction| self.quarter(direction));
        let arm = |quarter: u32| PlaceArm {
            direction: wrapped(self.entry - f64::from(quarter) * FRAC_PI_2),
            certainty: match quarter {
                0 => Certainty::Certain,
                _ if driven == Some(quarter) => Certainty::Certain,
                _ => Certainty::Possible,
            },
        };
        (0..4).map(arm).collect()
    }

    /// The quarter turns clockwise from the entry door to a direction.
    fn quarter(&self, direction: f64) -> u32 {
        let quarters = wrapped(self.entry - direction).rem_euclid(TAU) / FRAC_PI_2;
        quarters.round() as u32 % 4
    }

    /// A visit of what may be a junction, or a hallway.
    fn possible(&self, exit: Option<(S, f64)>) -> Visit<S> {
        let direction = exit.map(|(_, direction)| direction);
        Visit {
            arms: self.possible_arms(direction),
            least_bend: Some(FRAC_PI_4),
            exit: exit.map(|(at, direction)| VisitExit { at, direction, off: None }),
            goes_back: direction.is_some_and(|direction| self.quarter(direction) == 0),
            ..self.undecided(self.visited)
        }
    }

    /// A visit of which nothing is known.
    fn undecided(&self, at: S) -> Visit<S> {
        Visit {
            at,
            centre: self.turning_point,
            extent: APPROACH_RANGE,
            least_bend: Some(0.0),
            doubt: Some(UndecidedCause::Unclear),
            ..Visit::default()
        }
    }
}

/// The direction of the door by which a robot comes in. Of what is only possible it is the one of four directions that is
/// behind the robot: there may be no door where there seems to be one.
fn entry_door(place: &SeenPlace, is_certain: bool, robot: &Odometry) -> f64 {
    let Some(first) = place.arms.first().map(|arm| arm.direction) else { return 0.0 };
    let quarters =
        if is_certain { 0.0 } else { (wrapped(robot.heading + PI - first) / FRAC_PI_2).round() };
    wrapped(first + quarters * FRAC_PI_2)
}

#[cfg(test)]
mod tests {
    use toposlam_model::{
        driving::scene::{CentreLine, HallwayStatus, HallwayView, Reason},
        percept::{Door, Sighting},
    };

    use super::*;
    use crate::visits::{VisitPercept, Visits};

    type Seen = (Place, [f64; 2], f64);

    /// What a robot sees that looks along x and has come along it; the junction has a door behind it and
    /// one to its left.
    fn junction(ahead: f64) -> Place {
        let through = [ahead, 0.0];
        let line = |direction| CentreLine { through, direction };
        let doors = vec![line(PI), line(FRAC_PI_2)];
        Place::Junction(JunctionView { doors, turning_point: through, confidence: 1.0 })
    }

    fn hallway(position: [f64; 2], heading: f64) -> Seen {
        let status = HallwayStatus::Clear;
        let view = HallwayView { heading: 0.0, left: 0.8, right: 0.8, status, confidence: 1.0 };
        (Place::Hallway(view), position, heading)
    }

    /// A robot that comes along x to a junction at the origin, and visits it.
    fn visit() -> Vec<Seen> {
        let from = |x: f64| (junction(-x), [x, 0.0], 0.0);
        vec![hallway([-2.0, 0.0], 0.0), from(-0.8), from(-0.5), from(-0.2)]
    }

    fn visits(places: &[Seen], marked: bool) -> VisitLog<usize> {
        let mut visits = Visits::by_camera(marked);
        for (number, (place, position, heading)) in places.iter().enumerate() {
            let scene = Scene { place: place.clone(), marker: None };
            visits.add_frame(number, &scene, &Odometry { position: *position, heading: *heading });
        }
        visits.finish()
    }

    /// The door of each visit; `None` for what is undecided, and where the robot turned back.
    fn events(places: &[Seen], marked: bool) -> (Vec<Option<u32>>, Vec<usize>) {
        let VisitLog { visits, turned_back } = visits(places, marked);
        let door = |visit: &Visit<usize>| {
            visit.percept().door.filter(|_| visit.doubt.is_none() && visit.turned_back.is_empty())
        };
        (visits.iter().map(door).collect(), turned_back)
    }

    #[test]
    fn a_visit_is_a_percept_and_the_door_by_which_it_ends() {
        let away = hallway([0.0, 1.0], FRAC_PI_2);
        let mut places = [visit(), vec![away]].concat();
        let seen = visits(&places, false).visits;
        let [Visit { at: 3, exit: Some(VisitExit { at: 4, off: Some(off), .. }), .. }] = &seen[..]
        else {
            panic!("{seen:?}")
        };
        assert!(*off < 1e-9 && seen[0].percept().degree == 2);
        assert_eq!(seen[0].alternatives(), [Some(seen[0].percept())]);
        assert_eq!(events(&places, false), (vec![Some(1)], vec![]));
        // What cannot be recognised, and a hallway beside the turning point, change nothing.
        let unknown = (Place::Unknown(Reason::NothingFits), [0.0; 2], 0.0);
        places.splice(4..4, [unknown, hallway([0.0, 0.1], 0.0)]);
        assert_eq!(events(&places, false), (vec![Some(1)], vec![]));
        // Between the doors.
        let seen = visits(&[visit(), vec![hallway([0.7, 0.7], FRAC_PI_4)]].concat(), false).visits;
        assert!((seen[0].exit.unwrap().off.unwrap() - FRAC_PI_4).abs() < 1e-9);
    }

    #[test]
    fn turning_back_is_noticed_in_a_hallway_and_before_a_junction() {
        let mut places = visit();
        places.push(hallway([0.0, 2.0], FRAC_PI_2));
        places.push(hallway([0.0, 1.9], -FRAC_PI_2));
        assert_eq!(events(&places, false), (vec![Some(1)], vec![5]));
        let mut places = visit()[..3].to_vec();
        places.push(hallway([-0.7, 0.0], PI));
        assert_eq!(events(&places, false), (vec![], vec![3]));
    }

    #[test]
    fn a_junction_that_is_passed_or_seen_once_is_undecided() {
        let passed = [visit()[..2].to_vec(), vec![hallway([0.7, 0.0], 0.0)]].concat();
        assert_eq!(events(&passed, false), (vec![None], vec![]));
        let once = [(junction(0.2), [-0.2, 0.0], 0.0), hallway([0.0, 1.0], FRAC_PI_2)];
        assert_eq!(events(&once, false), (vec![None], vec![]));
        assert_eq!(visits(&once, false).visits[0].alternatives(), [], "anything is possible");
    }

    /// The same place, if it is only possible.
    fn possible((place, position, heading): Seen) -> Seen {
        let Place::Junction(view) = place else { return (place, position, heading) };
        let view = JunctionView { confidence: 0.5, ..view };
        (Place::Junction(view), position, heading)
    }

    #[test]
    fn what_is_only_possibly_a_junction_is_a_visit_with_no_junction_among_its_alternatives() {
        let onwards = hallway([0.7, 0.0], 0.0);
        let aside = hallway([0.0, 0.7], FRAC_PI_2);
        let back = hallway([-0.7, 0.0], PI);
        let percept = |degree, door| Some(VisitPercept { degree, door: Some(door) });
        let seen = |away: &[Seen]| {
            let come = visit().into_iter().map(possible).collect();
            let log = visits(&[come, away.to_vec()].concat(), false);
            assert_eq!((log.visits.len(), &log.turned_back[..]), (1, &[][..]));
            log.visits[0].alternatives()
        };
        let (straight, left) =
            ([percept(3, 1), percept(3, 2), percept(4, 2)], [percept(2, 1), percept(3, 1)]);
        assert_eq!(seen(&[onwards]), [&[None], &straight[..]].concat());
        // A hallway does not bend.
        assert_eq!(seen(&[aside]), [&left[..], &[percept(4, 1)]].concat()[..]);
        let dead_end_or_more = [1, 2, 3, 4].map(|degree| percept(degree, 0));
        assert_eq!(seen(&[back]), [&[None], &dead_end_or_more[..]].concat());
        // The log ends there.
        assert!(seen(&[]).contains(&None));
    }

    #[test]
    fn what_is_passed_and_only_possibly_a_junction_is_a_visit_and_what_is_turned_away_from_is_none()
    {
        let before = possible((junction(0.8), [-0.8, 0.0], 0.0));
        let passed = [before.clone(), hallway([0.7, 0.0], 0.0)];
        let log = visits(&passed, false);
        assert!(log.visits[0].alternatives().contains(&None), "{log:?}");
        let turned = [before, hallway([-0.9, 0.0], PI)];
        assert_eq!(events(&turned, false), (vec![], vec![1]));
    }

    #[test]
    fn a_possible_junction_has_its_place_and_arms_once_it_is_certain() {
        // It seems to be half a metre farther on, and turned by 20 degrees.
        let turned = 20.0_f64.to_radians();
        let seems = |x: f64| {
            let through = [0.5 - x, 0.0];
            let line = |direction| CentreLine { through, direction: wrapped(direction + turned) };
            let doors = vec![line(PI), line(FRAC_PI_2)];
            let view = JunctionView { doors, turning_point: through, confidence: 0.5 };
            (Place::Junction(view), [x, 0.0], 0.0)
        };
        let mut robot = Visits::by_camera(false);
        let mut at = 0..;
        let mut go = |(place, position, heading): Seen| {
            let scene = Scene { place, marker: None };
            robot.add_frame(at.next().unwrap(), &scene, &Odometry { position, heading });
            robot.status()
        };
        let directions = |place: &SeenPlace| {
            let direction = |arm: &PlaceArm| (arm.direction.to_degrees().round(), arm.certainty);
            place.arms.iter().map(direction).collect::<Vec<_>>()
        };
        assert_eq!(go(hallway([-2.0, 0.0], 0.0)), None);
        assert_eq!(go(seems(-0.8)), None);
        let possible = go(seems(0.3)).unwrap();
        assert!((possible.centre.x - 0.5).abs() < 1e-9, "{possible:?}");
        let certainty = [Certainty::Certain, Certainty::Possible];
        let [entry, others] = certainty;
        let expected = [(-160.0, entry), (110.0, others), (20.0, others), (-70.0, others)];
        assert_eq!(directions(&possible), expected);
        go((junction(-0.1), [0.1, 0.0], 0.0));
        let certain = go((junction(-0.2), [0.2, 0.0], 0.0)).unwrap();
        assert!(certain.centre.x.abs() < 1e-9, "{certain:?}");
        assert_eq!(directions(&certain), [(180.0, entry), (90.0, entry)]);
    }

    #[test]
    fn furniture_far_beside_a_junction_does_not_end_its_visit() {
        // Before the second image of the junction, without which it is not decided.
        let far = possible((junction(2.0), [-0.3, 0.0], 0.0));
        let mut places = [visit(), vec![hallway([0.0, 1.0], FRAC_PI_2)]].concat();
        places.insert(2, far);
        assert_eq!(events(&places, false), (vec![Some(1)], vec![]));
        assert_eq!(visits(&places, false).visits.len(), 1);
    }

    #[test]
    fn furniture_beside_a_junction_does_not_change_its_visit() {
        // A false dead end before it, at it and behind it.
        let false_end = |ahead: f64, x: f64| {
            let through = [ahead, 0.0];
            let doors = vec![CentreLine { through, direction: -FRAC_PI_2 }];
            let view = JunctionView { doors, turning_point: through, confidence: 0.5 };
            (Place::Junction(view), [x, 0.0], 0.0)
        };
        let away = hallway([0.0, 1.0], FRAC_PI_2);
        let mut places = [visit(), vec![away]].concat();
        places.insert(4, false_end(1.8, -0.1));
        places.insert(2, false_end(0.1, -0.6));
        places.insert(1, false_end(0.5, -1.0));
        let seen = visits(&places, false).visits;
        assert_eq!(seen.len(), 1, "{seen:?}");
        assert_eq!(seen[0].alternatives(), [Some(seen[0].percept())]);
        assert_eq!(events(&places, false), (vec![Some(1)], vec![]));
    }

    /// The visits do not depend on the direction in which odometry begins.
    #[test]
    fn a_robot_that_begins_in_another_direction_has_the_same_visits() {
        let away = hallway([0.0, 1.0], FRAC_PI_2);
        let turned_back = hallway([-0.7, 0.0], PI);
        let back = hallway([-1.0, 0.0], PI);
        let round = [hallway([0.0, 2.0], FRAC_PI_2), hallway([0.0, 1.9], -FRAC_PI_2)];
        let maybe: Vec<_> = visit().into_iter().map(possible).collect();
        for way in [
            [visit(), vec![away.clone()]].concat(),
            [visit(), vec![back.clone()]].concat(),
            [visit()[..3].to_vec(), vec![turned_back]].concat(),
            [visit(), round.to_vec()].concat(),
            [visit()[..2].to_vec(), vec![hallway([0.7, 0.0], 0.0)]].concat(),
            [maybe.clone(), vec![away]].concat(),
            [maybe, vec![back]].concat(),
        ] {
            let seen = |turn: f64| {
                let (sine, cosine) = turn.sin_cos();
                let turned = way.iter().map(|(place, [x, y], heading)| {
                    let position = [cosine * x - sine * y, sine * x + cosine * y];
                    (place.clone(), position, wrapped(heading + turn))
                });
                let log = visits(&turned.collect::<Vec<_>>(), false);
                let visit = |visit: &Visit<usize>| {
                    (visit.at, visit.alternatives(), visit.goes_back, visit.turned_back.clone())
                };
                (log.visits.iter().map(visit).collect::<Vec<_>>(), log.turned_back)
            };
            for turn in [0.9, 2.0, -1.2, -2.6] {
                assert_eq!(seen(turn), seen(0.0), "{turn}");
            }
        }
    }

    /// A false dead end seems to open to the right.
    #[test]
    fn a_robot_enters_a_possible_junction_by_the_door_behind_it_whatever_seems_to_be_a_door() {
        for (turn, opens) in [(0.0, -FRAC_PI_2), (0.0, FRAC_PI_2), (0.0, 0.0), (2.0, -FRAC_PI_2)] {
            let through = [0.1, 0.0];
            let doors = vec![CentreLine { through, direction: opens }];
            let view = JunctionView { doors, turning_point: through, confidence: 0.5 };
            let mut robot = Visits::by_camera(false);
            let scene = Scene { place: Place::Junction(view), marker: None };
            robot.add_frame(0, &scene, &Odometry { position: [0.0; 2], heading: turn });
            let arms = robot.status().unwrap().arms;
            assert!(
                wrapped(arms[0].direction - turn - PI).abs() < 1e-9,
                "{turn} {opens}: {arms:?}"
            );
            assert!(arms[0].is_certain() && !arms[1].is_certain());
        }
    }

    #[test]
    fn a_junction_that_is_seen_from_another_one_ends_the_visit_of_that() {
        // The next one is 4 m to the left, and no image shows the hallway between them.
        let next = [1.0, 3.2, 3.5, 3.8].map(|y| (junction(4.0 - y), [0.0, y], FRAC_PI_2));
        let places = [visit(), next.to_vec()].concat();
        assert_eq!(events(&places, false), (vec![Some(1), None], vec![]));
        // The same place half a metre off is no other one.
        let near = (junction(0.7), [-0.2, 0.0], 0.0);
        let away = hallway([0.0, 1.0], FRAC_PI_2);
        assert_eq!(visits(&[visit(), vec![near, away]].concat(), false).visits.len(), 1);
    }

    #[test]
    fn a_junction_is_visited_where_its_last_image_has_it_and_has_arms_once_two_images_agree() {
        let status = |places: &[Seen]| {
            let mut robot = Visits::by_camera(false);
            for (number, (place, position, heading)) in places.iter().enumerate() {
                let scene = Scene { place: place.clone(), marker: None };
                robot.add_frame(
                    number,
                    &scene,
                    &Odometry { position: *position, heading: *heading },
                );
            }
            robot.status().map(|place| place.arms.len())
        };
        let at = |ahead: f64, x: f64| (junction(ahead), [x, 0.0], 0.0);
        assert_eq!(status(&[at(0.8, -0.8), at(0.2, -0.2)]), Some(2));
        // It is 40 cm farther on than it seemed.
        assert_eq!(status(&[at(0.8, -0.8), at(0.6, -0.2)]), None);
        assert_eq!(status(&[at(0.2, -0.2)]), Some(0));
    }

    /// A junction that is still ahead looks like a hallway, in which its marker is visible.
    #[test]
    fn the_marker_of_a_junction_ahead_is_seen_from_the_hallway_before_it() {
        let sighting = |is_before: bool| {
            let mut robot = Visits::by_camera(false);
            let marker = Some(MarkerView { position: [0.4, 0.3], axis: FRAC_PI_2, door: None });
            let ahead = (hallway([-0.6, 0.0], 0.0), marker);
            let beside = (hallway([-0.1, 0.0], 0.0), marker);
            let mut seen: Vec<_> = visit().into_iter().map(|seen| (seen, None)).collect();
            seen.insert(if is_before { 2 } else { 4 }, if is_before { ahead } else { beside });
            seen.push((hallway([0.0, 1.0], FRAC_PI_2), None));
            for (number, ((place, position, heading), marker)) in seen.into_iter().enumerate() {
                let scene = Scene { place, marker };
                robot.add_frame(number, &scene, &Odometry { position, heading });
            }
            robot.finish().visits[0].sighting
        };
        assert_eq!(sighting(true), Some(Sighting::Pointing(Door(1))));
        assert_eq!(sighting(false), Some(Sighting::Nothing));
    }

    #[test]
    fn a_robot_that_begins_with_a_marker_has_it_along_its_entry() {
        let here = (junction(0.0), [0.0; 2], 0.0);
        let places = [here.clone(), here, hallway([-1.0, 0.0], PI)];
        assert_eq!(events(&places, true), (vec![Some(0)], vec![]));
        // Without a marker it would have to be looked at from farther off.
        assert_eq!(events(&places, false), (vec![None], vec![]));
    }
}
