//! Figures that were measured on many views and visits, and their targets.

use std::collections::BTreeMap;

use toposlam_model::{
    driving::scene::{HallwayView, JunctionView, Place},
    percept::Sighting,
};

use super::{
    bound::{cases_needed, lower_bound, upper_bound},
    calibration::Calibration,
    judged_view::{JudgedView, JudgedVisit, Zone},
    quantile::{ErrorSample, Quantile},
    scene_class::SceneClass,
    verdict::{MarkerVerdict, PlaceVerdict, hallway_errors, junction_errors},
};
use crate::truth::{HallwayTruth, JunctionTruth, Truth};

/// The figures of an evaluation of sensing.
#[derive(Clone, Debug, PartialEq)]
pub struct VisionReport {
    /// Whether the camera agrees with its calibration.
    pub calibration: Calibration,
    /// Rates of failures.
    pub rates: Vec<Rate>,
    /// Sizes of errors.
    pub errors: Vec<Errors>,
    /// For each true class, the number of scenes of each class; of hallways, and of junctions up to
    /// their turning points.
    pub confusion: BTreeMap<SceneClass, BTreeMap<SceneClass, usize>>,
}

/// The subject of a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ReportSubject {
    /// Views in hallways.
    Hallway,
    /// Views between hallways and junctions.
    Between,
    /// Views of junctions up to their turning points.
    Junction,
    /// Views of junctions past their turning points.
    Past,
    /// Views of junctions after the robot has turned.
    Turned,
    /// The marker in single views.
    Marker,
    /// Visits.
    Visit,
    /// Walks through whole buildings.
    Walk,
    /// Whole runs.
    Run,
    /// Percepts in whole runs.
    Percept,
    /// Traversals from junction to junction.
    Traversal,
}

/// The rate of a failure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rate {
    /// The subject.
    pub subject: ReportSubject,
    /// The failure, in a few words.
    pub what: &'static str,
    /// The number of failures.
    pub seen: usize,
    /// The number of cases.
    pub cases: usize,
    /// The target: the greatest allowed share of the cases.
    pub limit: Option<f64>,
}

/// The sizes of an error.
#[derive(Clone, Debug, PartialEq)]
pub struct Errors {
    /// The subject.
    pub subject: ReportSubject,
    /// The quantity, in a few words.
    pub what: &'static str,
    /// The unit of output.
    pub unit: ErrorUnit,
    /// The errors, in metres or radians.
    pub sample: ErrorSample,
    /// The targets: quantiles and their greatest allowed values, in the unit.
    pub limits: Vec<(Quantile, f64)>,
}

/// A unit of output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorUnit {
    /// For errors in radians.
    Degrees,
    /// For errors in metres.
    Centimetres,
}

/// Whether a target is met, by the one-sided intervals of the rate with a confidence of 95 %.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum TargetStatus {
    /// The upper bound is within the target, or there is no target.
    Met,
    /// The target lies between the bounds: the sample is too small.
    NotShown,
    /// The lower bound is beyond the target.
    Missed,
}

impl TargetStatus {
    /// The status of a greatest allowed rate.
    #[must_use]
    pub fn of(seen: usize, cases: usize, limit: f64) -> Self {
        if lower_bound(seen, cases) > limit {
            Self::Missed
        } else if upper_bound(seen, cases) <= shown_as(limit) {
            Self::Met
        } else {
            Self::NotShown
        }
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Met => "met",
            Self::NotShown => "not shown",
            Self::Missed => "missed",
        }
    }
}

/// No sample shows that something never happens. A target of 0 is met if it was not seen, and the rate is
/// at most this.
const NEVER: f64 = 0.001;

/// The rate that must be shown for a target.
fn shown_as(limit: f64) -> f64 {
    if limit > 0.0 { limit } else { NEVER }
}

/// Factor of the allowed rates if the camera differs from its calibration.
const LENIENCE: f64 = 3.0;

impl VisionReport {
    /// The figures of these views and visits.
    #[must_use]
    pub fn of(views: &[JudgedView], visits: &[JudgedVisit], calibration: Calibration) -> Self {
        let mut rates = [places(views), markers(views), of_visits(visits)].concat();
        let mut errors = Vec::new();
        match calibration {
            Calibration::Right => errors = all_errors(views),
            Calibration::Wrong => {
                // Only kind and entry have targets.
                rates.retain(|rate| rate.subject != ReportSubject::Marker);
                for rate in &mut rates {
                    let placed = rate.what == NOT_DECIDED || rate.what == DECIDED_WRONGLY;
                    let asked = rate.subject != ReportSubject::Visit || placed;
                    rate.limit = rate.limit.filter(|_| asked).map(|limit| LENIENCE * limit);
                }
            }
        }
        let mut confusion: BTreeMap<_, BTreeMap<_, _>> = BTreeMap::new();
        for judged in views {
            if let (Zone::Hallway | Zone::Before, Some(class)) = (judged.zone(), judged.class()) {
                let said = confusion.entry(class).or_default();
                *said.entry(SceneClass::of(&judged.scene)).or_insert(0) += 1;
            }
        }
        Self { calibration, rates, errors, confusion }
    }

    /// Whether each target is met.
    pub fn statuses(&self) -> impl Iterator<Item = TargetStatus> + '_ {
        let rates = self.rates.iter().map(Rate::standing);
        rates.chain(self.errors.iter().map(Errors::standing))
    }

    /// Whether all targets are met.
    #[must_use]
    pub fn standing(&self) -> TargetStatus {
        self.statuses().max().unwrap_or(TargetStatus::NotShown)
    }
}

/// A failure to count in a zone: its name, its test, and its target.
type Counted = (&'static str, fn(&JudgedView) -> bool, Option<f64>);

const NOT_DECIDED: &str = "not decided";
const DECIDED_WRONGLY: &str = "kind or entry wrong";

fn places(views: &[JudgedView]) -> Vec<Rate> {
    let not_right: fn(&JudgedView) -> bool = |judged| judged.verdict != PlaceVerdict::Right;
    let wrong: fn(&JudgedView) -> bool = |judged| judged.verdict.is_wrong();
    let zones: [(Zone, ReportSubject, Vec<Counted>); 5] = [
        (
            Zone::Hallway,
            ReportSubject::Hallway,
            vec![
                ("not called hallway", not_right, Some(0.005)),
                ("called junction", wrong, Some(0.0005)),
            ],
        ),
        (
            Zone::Before,
            ReportSubject::Junction,
            vec![
                ("kind and entry not right", not_right, Some(0.01)),
                ("kind or entry wrong", wrong, Some(0.001)),
            ],
        ),
        (
            Zone::Between,
            ReportSubject::Between,
            vec![
                ("unknown", |judged| judged.verdict == PlaceVerdict::Unknown, None),
                ("kind or entry wrong", wrong, None),
            ],
        ),
        (
            Zone::Past,
            ReportSubject::Past,
            vec![
                ("kind and entry not right", not_right, None),
                ("kind or entry wrong", wrong, None),
            ],
        ),
        (
            Zone::Turned,
            ReportSubject::Turned,
            vec![("kind not right", not_right, None), ("kind wrong", wrong, None)],
        ),
    ];
    let rates = zones.into_iter().flat_map(|(zone, subject, counted)| {
        let there: Vec<_> = views.iter().filter(|judged| judged.zone() == zone).collect();
        let rate = move |(what, counts, limit): Counted| Rate {
            subject,
            what,
            seen: there.iter().filter(|judged| counts(judged)).count(),
            cases: there.len(),
            limit,
        };
        counted.into_iter().map(rate).collect::<Vec<_>>()
    });
    rates.collect()
}

fn markers(views: &[JudgedView]) -> Vec<Rate> {
    let rate = |what, limit, counted: &dyn Fn(&JudgedView) -> Option<bool>| {
        let cases: Vec<_> = views.iter().filter_map(counted).collect();
        let seen = cases.iter().filter(|&&seen| seen).count();
        Rate { subject: ReportSubject::Marker, what, seen, cases: cases.len(), limit }
    };
    vec![
        rate("missed, 0.2 to 0.8 m before it", None, &|judged| {
            judged.marker_ahead().map(|_| judged.marker == MarkerVerdict::NotSeen)
        }),
        rate("seen where it is not", Some(0.0), &|judged| {
            Some(judged.marker == MarkerVerdict::Phantom)
        }),
        rate("door wrong, 0.2 to 0.8 m before it", None, &|judged| {
            let MarkerVerdict::Seen(Some(right)) = judged.marker else { return None };
            judged.marker_ahead().map(|_| !right)
        }),
    ]
}

fn of_visits(visits: &[JudgedVisit]) -> Vec<Rate> {
    let rate = |what, limit, counted: &dyn Fn(&JudgedVisit) -> Option<bool>| {
        let cases: Vec<_> = visits.iter().filter_map(counted).collect();
        let seen = cases.iter().filter(|&&seen| seen).count();
        Rate { subject: ReportSubject::Visit, what, seen, cases: cases.len(), limit }
    };
    // The marker counts once a visit is decided.
    let sightings = |visit: &JudgedVisit| {
        let (_, percept) = visit.decided.filter(|_| !visit.is_wrong())?;
        Some((visit.percept.sighting, percept.sighting))
    };
    vec![
        rate(NOT_DECIDED, None, &|visit| Some(visit.decided.is_none())),
        rate(DECIDED_WRONGLY, Some(0.0001), &|visit| Some(visit.is_wrong())),
        rate("marker missed", Some(0.0), &|visit| {
            let (there, seen) = sightings(visit)?;
            (there != Sighting::Nothing).then_some(seen == Sighting::Nothing)
        }),
        rate("marker seen where it is not", Some(0.0), &|visit| {
            let (there, seen) = sightings(visit)?;
            (there == Sighting::Nothing).then_some(seen != Sighting::Nothing)
        }),
        rate("marker's door wrong", Some(0.0), &|visit| {
            let (there, seen) = sightings(visit)?;
            let both = there != Sighting::Nothing && seen != Sighting::Nothing;
            both.then_some(there != seen)
        }),
    ]
}

fn all_errors(views: &[JudgedView]) -> Vec<Errors> {
    let hallways: Vec<_> =
        views.iter().filter_map(hallway).map(|(truth, view)| hallway_errors(truth, view)).collect();
    let junctions: Vec<_> = views
        .iter()
        .filter(|judged| judged.zone() == Zone::Before)
        .filter_map(junction)
        .filter_map(|(truth, view)| junction_errors(truth, view))
        .collect();
    let lines = || junctions.iter().flat_map(|errors| &errors.lines);
    let of = |subject, what, unit, sample, limits: &[(Quantile, f64)]| Errors {
        subject,
        what,
        unit,
        sample,
        limits: limits.to_vec(),
    };
    vec![
        of(
            ReportSubject::Hallway,
            "direction",
            ErrorUnit::Degrees,
            hallways.iter().map(|errors| errors.heading).collect(),
            &[(Quantile::Median, 0.5), (Quantile::P99, 4.0)],
        ),
        of(
            ReportSubject::Hallway,
            "distance to a side",
            ErrorUnit::Centimetres,
            hallways.iter().flat_map(|errors| errors.sides).collect(),
            &[(Quantile::Median, 2.0)],
        ),
        of(
            ReportSubject::Junction,
            "place of a centre line",
            ErrorUnit::Centimetres,
            lines().map(|&(off, _)| off).collect(),
            &[(Quantile::P95, 5.0)],
        ),
        of(
            ReportSubject::Junction,
            "direction of a centre line",
            ErrorUnit::Degrees,
            lines().map(|&(_, turned)| turned).collect(),
            &[(Quantile::P95, 3.0)],
        ),
        of(
            ReportSubject::Junction,
            "turning point",
            ErrorUnit::Centimetres,
            junctions.iter().map(|errors| errors.turning_point).collect(),
            &[],
        ),
    ]
}

/// The truth and the view of a hallway that was recognized as one.
fn hallway(judged: &JudgedView) -> Option<(&HallwayTruth, &HallwayView)> {
    match (&judged.truth, &judged.scene.place) {
        (Truth::Hallway(truth), Place::Hallway(view)) => Some((truth, view)),
        _ => None,
    }
}

/// The truth and the view of a junction that was recognized as one.
fn junction(judged: &JudgedView) -> Option<(&JunctionTruth, &JunctionView)> {
    match (&judged.truth, &judged.scene.place) {
        (Truth::Junction(truth), Place::Junction(view)) => Some((truth, view)),
        _ => None,
    }
}

impl Rate {
    /// The share of failures; `None` without cases.
    #[must_use]
    pub fn rate(&self) -> Option<f64> {
        (self.cases > 0).then(|| self.seen as f64 / self.cases as f64)
    }

    /// The upper bound of the rate, with a confidence of 95 %.
    #[must_use]
    pub fn upper_bound(&self) -> f64 {
        upper_bound(self.seen, self.cases)
    }

    /// Whether the target is met.
    #[must_use]
    pub fn standing(&self) -> TargetStatus {
        self.limit.map_or(TargetStatus::Met, |limit| TargetStatus::of(self.seen, self.cases, limit))
    }

    /// The least number of cases, all without a failure, that meet the target.
    #[must_use]
    pub fn cases_needed(&self) -> Option<usize> {
        self.limit.map(|limit| cases_needed(shown_as(limit)))
    }
}

impl Errors {
    /// A quantile of the errors, in the unit.
    #[must_use]
    pub fn quantile(&self, quantile: Quantile) -> Option<f64> {
        self.sample.quantile(quantile.part()).map(|value| value * self.factor())
    }

    /// A unit of the sample in the unit of output.
    fn factor(&self) -> f64 {
        match self.unit {
            ErrorUnit::Degrees => 1.0_f64.to_degrees(),
            ErrorUnit::Centimetres => 100.0,
        }
    }

    /// Whether the targets are met: a quantile is at most its limit if no more than the rest of the errors
    /// exceed the limit.
    #[must_use]
    pub fn standing(&self) -> TargetStatus {
        let standing = self.limits.iter().map(|&(quantile, limit)| {
            let exceeding = self.sample.exceeding(limit / self.factor());
            TargetStatus::of(exceeding, self.sample.count(), 1.0 - quantile.part())
        });
        standing.max().unwrap_or(TargetStatus::Met)
    }

    /// The least number of cases, none beyond its limit, that meet the targets.
    #[must_use]
    pub fn cases_needed(&self) -> Option<usize> {
        let needed = self.limits.iter();
        needed.map(|(quantile, _)| cases_needed(shown_as(1.0 - quantile.part()))).max()
    }
}

impl ReportSubject {
    /// The name of the subject.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Hallway => "hallway",
            Self::Between => "between",
            Self::Junction => "junction",
            Self::Past => "past",
            Self::Turned => "turned",
            Self::Marker => "marker",
            Self::Visit => "visit",
            Self::Walk => "walk",
            Self::Run => "run",
            Self::Percept => "percept",
            Self::Traversal => "control",
        }
    }
}

#[cfg(test)]
mod tests;
