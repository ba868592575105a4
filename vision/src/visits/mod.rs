//! Visits: where a robot came in and left, and which percepts its views cannot exclude. Sections 3 to 5.
//!
//! One machine for all sensors, live and from logs: the [`PlaceView`]s of a [`PlaceSensor`] in, [`Visit`]s out. What is
//! common is here: the arms and alternatives of a visit, turning back, and the hallway since the visit before. When a
//! visit begins and ends, and which arms count, differs in what the sensors show, so there is one file for each:
//!
//! * `approach`: a camera sees one junction at a time, in a few views, but its shape exactly, and how far its turning
//!   point is. A robot turns there, and faces the hallway by which it leaves.
//! * `mapped`: a laser scanner sees many places, with arms at any angle, all the time. An arm may show only when the robot
//!   is past it, so a visit is decided later; and where the robot left is only known by its position, since it may cut
//!   corners and need not look ahead. The two rules share no threshold: half a metre beside the turning point no camera
//!   has visited a junction, and for a scanner the robot is in the middle of it.
//!
//! Only certain facts accuse a robot. A scanner does not measure by which arm the robot left: the arm nearest to its
//! position is the one that it drove. If none is near, an arm may be missing, and the visit is undecided.

mod approach;
mod mapped;
pub mod network_fit;
mod tracked_places;
mod visit;
mod way;

use std::borrow::Cow;

use toposlam_model::driving::{odometry::Odometry, scene::wrapped};

pub use self::{
    approach::APPROACH_RANGE,
    visit::{UndecidedCause, Visit, VisitExit, VisitLog, VisitPercept},
};
use self::{approach::ApproachRule, mapped::MappedRule};
use crate::{
    geometry::distance,
    laser::{
        params::{LaserParams, VisitParams},
        scan_log::ScanLog,
        sensor::LaserSensor,
    },
    place::{Certainty, PlaceSensor, PlaceView, SeenPlace},
    sensing::SceneSensor,
};

/// The visits of a robot by the views of its log, in their order. `at` identifies a scan by its number.
pub fn logged_visits<S: Copy + Default>(
    log: &ScanLog,
    views: &[PlaceView],
    at: impl Fn(usize) -> S,
) -> VisitLog<S> {
    let mut params = *log.params();
    params.visit.views = params.visit.logged_views;
    visits_in(log, &params, views.iter().map(Cow::Borrowed), at)
}

/// The same where an arm is certain if it was driven, and possible unless it is seen to end. `None` if odometry drifts: then
/// it is not known which passes are of one place.
pub fn driven_visits<S: Copy + Default>(
    log: &ScanLog,
    views: &[PlaceView],
    at: impl Fn(usize) -> S,
) -> Option<VisitLog<S>> {
    let mut params = *log.params();
    if params.matching.rounds > 0 {
        return None;
    }
    // A way is seen to end if no view shows that it may go on.
    let visit_params = params.visit;
    params.visit = VisitParams {
        views: visit_params.logged_views,
        agree: 0.0,
        traversed: 0.0,
        doubt: 0.0,
        ..visit_params
    };
    let facts = || views.iter().filter_map(|view| Some((view, view.facts.as_ref()?)));
    let by_facts = facts().map(|(view, facts)| {
        let places = facts.not_ended.clone();
        Cow::Owned(PlaceView { places, possible_places: Vec::new(), ..view.clone() })
    });
    let mut visits = visits_in(log, &params, by_facts, at);
    for visit in &mut visits.visits {
        let is_here = |place: &&SeenPlace| distance(place.centre, visit.centre) < visit.extent;
        let driven = || facts().filter_map(|(_, facts)| facts.driven.iter().find(is_here));
        let most = driven().count().div_ceil(2).max(1);
        let exit = visit.exit.as_ref().map(|exit| exit.direction);
        for (number, arm) in visit.arms.iter_mut().enumerate() {
            let is_same = |other: f64| wrapped(other - arm.direction).abs() < visit_params.same_arm;
            let views = driven().filter(|place| place.directions().any(is_same)).count();
            let is_taken = arm.is_certain() && (number == 0 || exit.is_some_and(is_same));
            let is_driven = is_taken || views >= most;
            arm.certainty = if is_driven { Certainty::Certain } else { Certainty::Possible };
        }
    }
    // Where a log begins shows nothing of where the robot came from.
    if let (Some(visit), Some(first)) = (visits.visits.first_mut(), views.first()) {
        let begins = distance(first.robot.position, visit.centre);
        if begins < visit.extent + visit_params.beginning {
            visit.arms.clear();
        }
    }
    Some(visits)
}

fn visits_in<'v, S: Copy + Default>(
    log: &ScanLog,
    params: &LaserParams,
    views: impl Iterator<Item = Cow<'v, PlaceView>>,
    at: impl Fn(usize) -> S,
) -> VisitLog<S> {
    let mut rule = MappedRule::new(params);
    let mut visits = VisitLog::default();
    for (number, view) in views.enumerate() {
        let sight = |from, direction, limit| log.sight(number, from, direction, limit);
        rule.add_view(&mut visits, at(log.scan(number)), &view, &sight);
    }
    rule.finish(&mut visits);
    visits
}

/// Makes visits of what a sensor sees. `S` identifies a frame.
#[derive(Clone, Debug)]
pub struct Visits<P, S> {
    sensor: P,
    rule: VisitRule<S>,
    log: VisitLog<S>,
}

#[derive(Clone, Debug)]
enum VisitRule<S> {
    Approach(Box<ApproachRule<S>>),
    Mapped(Box<MappedRule<S>>),
}

impl<S: Copy + Default> Visits<LaserSensor, S> {
    /// The visits of a robot with a laser scanner.
    pub fn by_laser(params: LaserParams) -> Self {
        let rule = VisitRule::Mapped(Box::new(MappedRule::new(&params)));
        Self { sensor: LaserSensor::new(params), rule, log: VisitLog::default() }
    }
}

impl<S: Copy + Default> Visits<SceneSensor, S> {
    /// The visits of a robot with a camera; if it is `marked`, it puts its marker down at its start.
    pub fn by_camera(marked: bool) -> Self {
        let rule = VisitRule::Approach(Box::new(ApproachRule::new(marked)));
        Self { sensor: SceneSensor, rule, log: VisitLog::default() }
    }
}

impl<P: PlaceSensor, S: Copy + Default> Visits<P, S> {
    /// Takes the next frame, and the odometry at its time. Returns the view in it, as [`PlaceSensor::view`] does.
    pub fn add_frame(&mut self, at: S, frame: &P::Frame, odometry: &Odometry) -> Option<PlaceView> {
        let view = self.sensor.view(frame, odometry)?;
        match &mut self.rule {
            VisitRule::Approach(rule) => rule.add_view(&mut self.log, at, &view),
            VisitRule::Mapped(rule) => {
                let sensor = &self.sensor;
                let sight = |from, direction, limit| sensor.sight(from, direction, limit);
                rule.add_view(&mut self.log, at, &view, &sight);
            }
        }
        Some(view)
    }

    pub fn sensor(&self) -> &P {
        &self.sensor
    }

    pub fn sensor_mut(&mut self) -> &mut P {
        &mut self.sensor
    }

    /// The place in which the robot is now, in the frame of the map: a junction, or what looked like one in some view;
    /// `None` within a corridor. It has no arms if it is none, and possible ones if the views do not decide.
    pub fn status(&self) -> Option<SeenPlace> {
        match &self.rule {
            VisitRule::Approach(rule) => rule.status(),
            VisitRule::Mapped(rule) => rule.status(),
        }
    }

    /// The visits, after the last frame.
    #[must_use]
    pub fn finish(mut self) -> VisitLog<S> {
        match self.rule {
            VisitRule::Approach(rule) => rule.finish(&mut self.log),
            VisitRule::Mapped(rule) => rule.finish(&mut self.log),
        }
        self.log
    }
}
