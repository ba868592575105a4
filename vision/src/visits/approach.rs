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
mod tests;
