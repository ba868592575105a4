//! The figures of sensing with a camera, their targets, and what views that are not right have in common.

use toposlam_model::percept::Sighting;

use super::{
    judge::Calibration,
    judged_view::{JudgedView, JudgedVisit, SceneClass, Zone},
    report::{CENTIMETRES, DEGREES, Errors, Figures, Group, Rate, halved, labelled},
    verdict::{MarkerVerdict, PlaceError, PlaceVerdict, place_errors},
};
use crate::truth::Truth;

/// Factor of the allowed rates if the camera differs from its calibration.
const LENIENCE: f64 = 3.0;

const NOT_DECIDED: &str = "not decided";
const KIND_OR_ENTRY_WRONG: &str = "kind or entry wrong";
const NOT_RIGHT: &str = "kind and entry not right";
const ONLY_POSSIBLE: &str = "right, but only possible";

/// The figures of these views and visits.
pub fn figures(views: &[JudgedView], visits: &[JudgedVisit], calibration: Calibration) -> Figures {
    let mut figures = Figures {
        rates: [places(views), markers(views), of_visits(visits)].concat(),
        ..Figures::default()
    };
    match calibration {
        Calibration::Right => {
            figures.errors = errors(views);
            figures.groups = groups(views);
        }
        Calibration::Wrong => {
            // Only kind and entry have targets.
            figures.rates.retain(|rate| rate.of != "marker");
            for rate in &mut figures.rates {
                let placed = rate.what == NOT_DECIDED || rate.what == KIND_OR_ENTRY_WRONG;
                let asked = rate.of != "visit" || placed;
                rate.limit = rate.limit.filter(|_| asked).map(|limit| LENIENCE * limit);
            }
        }
    }
    for judged in views.iter().filter(|judged| judged.counts()) {
        if let Some(class) = judged.class() {
            let said = figures.confusion.entry(class).or_default();
            *said.entry(SceneClass::from_scene(&judged.scene)).or_insert(0) += 1;
        }
    }
    figures
}

fn places(views: &[JudgedView]) -> Vec<Rate> {
    let not_right: fn(PlaceVerdict) -> bool =
        |verdict| !matches!(verdict, PlaceVerdict::Right | PlaceVerdict::Possible);
    let possible: fn(PlaceVerdict) -> bool = |verdict| verdict == PlaceVerdict::Possible;
    let unknown: fn(PlaceVerdict) -> bool = |verdict| verdict == PlaceVerdict::Unknown;
    let wrong: fn(PlaceVerdict) -> bool = PlaceVerdict::is_wrong;
    let rates = [
        (Zone::Hallway, "hallway", "not called hallway", not_right, Some(0.005)),
        (Zone::Hallway, "hallway", "called junction", wrong, Some(0.0005)),
        (Zone::Before, "junction", NOT_RIGHT, not_right, Some(0.01)),
        (Zone::Before, "junction", ONLY_POSSIBLE, possible, Some(0.02)),
        (Zone::Before, "junction", KIND_OR_ENTRY_WRONG, wrong, Some(0.001)),
        (Zone::Between, "between", "unknown", unknown, None),
        (Zone::Between, "between", ONLY_POSSIBLE, possible, None),
        (Zone::Between, "between", KIND_OR_ENTRY_WRONG, wrong, None),
        (Zone::Past, "past", NOT_RIGHT, not_right, None),
        (Zone::Past, "past", KIND_OR_ENTRY_WRONG, wrong, None),
        (Zone::Turned, "turned", "kind not right", not_right, None),
        (Zone::Turned, "turned", "kind wrong", wrong, None),
    ];
    let rates = rates.map(|(zone, of, what, fails, limit)| {
        let fails = |judged: &JudgedView| (judged.zone() == zone).then(|| fails(judged.verdict));
        Rate::counted(of, what, limit, views, fails)
    });
    rates.to_vec()
}

fn markers(views: &[JudgedView]) -> Vec<Rate> {
    let of = "marker";
    vec![
        Rate::counted(of, "missed, 0.2 to 0.8 m before it", None, views, |judged| {
            judged.is_marker_ahead().then_some(judged.marker == MarkerVerdict::NotSeen)
        }),
        Rate::counted(of, "seen where it is not", Some(0.0), views, |judged| {
            Some(judged.marker == MarkerVerdict::Phantom)
        }),
        Rate::counted(of, "door wrong, 0.2 to 0.8 m before it", None, views, |judged| {
            let MarkerVerdict::Seen(Some(right)) = judged.marker else { return None };
            judged.is_marker_ahead().then_some(!right)
        }),
    ]
}

fn of_visits(visits: &[JudgedVisit]) -> Vec<Rate> {
    let of = "visit";
    // The marker counts once a visit is decided. There is one, and one is seen.
    let sightings = |visit: &JudgedVisit| {
        let (_, percept) = visit.decided.filter(|_| !visit.is_wrong())?;
        let both = [visit.percept.sighting, percept.sighting];
        Some((both.map(|sighting| sighting != Sighting::Nothing), both[0] != both[1]))
    };
    vec![
        Rate::counted(of, NOT_DECIDED, None, visits, |visit| Some(visit.decided.is_none())),
        Rate::counted(of, KIND_OR_ENTRY_WRONG, Some(0.0001), visits, |visit| {
            Some(visit.is_wrong())
        }),
        Rate::counted(of, "marker missed", Some(0.0), visits, |visit| {
            let ([there, seen], _) = sightings(visit)?;
            there.then_some(!seen)
        }),
        Rate::counted(of, "marker seen where it is not", Some(0.0), visits, |visit| {
            let ([there, seen], _) = sightings(visit)?;
            (!there).then_some(seen)
        }),
        Rate::counted(of, "marker's door wrong", Some(0.0), visits, |visit| {
            let ([there, seen], differ) = sightings(visit)?;
            (there && seen).then_some(differ)
        }),
    ]
}

/// The errors of hallways and junctions that were recognized as such.
fn errors(views: &[JudgedView]) -> Vec<Errors> {
    use PlaceError::{
        CentreLineDirection, CentreLinePlace, HallwayDirection, HallwaySide, TurningPoint,
    };
    let counting = views.iter().filter(|judged| judged.counts());
    let found = counting.flat_map(|judged| place_errors(&judged.truth, &judged.scene.place));
    let found: Vec<_> = found.collect();
    [
        (HallwayDirection, "hallway", "direction", DEGREES, &[(0.5, 0.5), (0.99, 4.0)][..]),
        (HallwaySide, "hallway", "distance to a side", CENTIMETRES, &[(0.5, 2.0)]),
        (CentreLinePlace, "junction", "place of a centre line", CENTIMETRES, &[(0.95, 5.0)]),
        (CentreLineDirection, "junction", "direction of a centre line", DEGREES, &[(0.95, 3.0)]),
        (TurningPoint, "junction", "turning point", CENTIMETRES, &[]),
    ]
    .map(|(kind, of, what, unit, limits)| {
        let sample = found.iter().filter(|(other, _)| *other == kind).map(|&(_, error)| error);
        Errors { of, what, unit, sample: sample.collect(), limits: limits.to_vec() }
    })
    .into()
}

/// Groups of the views in hallways and before turning points: by look, image size, class, distance,
/// heading and offset, and by each effect above or up to its median.
fn groups(views: &[JudgedView]) -> Vec<Group> {
    let views: Vec<_> = views.iter().filter(|judged| judged.counts()).collect();
    let verdict = |judged: &&JudgedView| judged.verdict.verdict();
    [
        labelled(&views, verdict, "look", |judged| judged.view.look.name.to_owned()),
        labelled(&views, verdict, "size", |judged| {
            let [width, height] = judged.view.image;
            format!("{width}x{height}")
        }),
        labelled(&views, verdict, "place", |judged| {
            judged.class().unwrap_or(SceneClass::Other).to_string()
        }),
        labelled(&views, verdict, "distance", |judged| distance(&judged.truth).to_owned()),
        halved(&views, verdict, |judged| {
            let mut numbers = vec![("width of the hallway", judged.view.plan.hallway_width())];
            if let Some([heading, aside]) = judged.truth.off_middle() {
                numbers.extend([("turned by", heading), ("aside by", aside)]);
            }
            numbers
        }),
        halved(&views, verdict, |judged| judged.view.effects.settings()),
    ]
    .concat()
}

/// The distance from the turning point, in words.
fn distance(truth: &Truth) -> &'static str {
    let Truth::Junction(junction) = truth else { return "1.5 m or more" };
    match junction.distance() {
        None => "turned away",
        Some(distance) if distance > 0.3 => "0.3 to 0.5 m before",
        Some(distance) if distance > 0.1 => "0.1 to 0.3 m before",
        Some(distance) if distance >= -0.1 => "within 0.1 m",
        Some(_) => "farther past",
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use toposlam_model::{
        driving::{
            scene::{Place, Reason, Scene},
            visit::JunctionShape,
        },
        percept::{Door, Percept},
    };

    use super::*;
    use crate::{
        LOOKS,
        evaluation::{
            report::TargetStatus,
            verdict::{
                self,
                tests::{HALLWAY, L, at_junction, in_hallway, junction},
            },
        },
        view_sampler::{RenderedView, ViewSampler, WhichEffects},
    };

    fn judged(truth: &Truth, place: Place) -> JudgedView {
        let views = ViewSampler::from_looks(&LOOKS, [640, 480], 0).unwrap();
        let views = ViewSampler { effects: WhichEffects::None, ..views };
        let view = RenderedView { marker: None, ..views.view(0).unwrap() };
        let scene = Scene { place, marker: None };
        let verdict = verdict::judge(truth, &scene);
        JudgedView { view, truth: truth.clone(), scene, verdict, marker: MarkerVerdict::NotSeen }
    }

    fn corner(before: f64) -> Truth {
        Truth::Junction(junction(&[PI, FRAC_PI_2], Some(L), before))
    }

    /// A hallway that is seen nearly as it is.
    fn seen_hallway(off: f64) -> Place {
        in_hallway(HALLWAY.heading + off, HALLWAY.left + 0.01, HALLWAY.right - 0.01)
    }

    fn seen(doors: &[f64]) -> Place {
        at_junction(doors, [0.3, 0.01])
    }

    fn rate(figures: &Figures, of: &str, what: &str) -> Rate {
        let is_it = |rate: &&Rate| rate.of == of && rate.what == what;
        *figures.rates.iter().find(is_it).unwrap()
    }

    #[test]
    fn views_are_counted_in_their_zones() {
        let hallway = Truth::Hallway(HALLWAY);
        let (l, unknown) = (seen(&[PI, FRAC_PI_2]), Place::Unknown(Reason::FewWalls));
        let views = [
            judged(&hallway, seen_hallway(0.01)),
            judged(&hallway, seen_hallway(-0.02)),
            judged(&hallway, unknown.clone()),
            judged(&hallway, seen(&[PI])),
            judged(&corner(0.3), l.clone()),
            judged(&corner(0.3), seen(&[PI])),
            judged(&corner(-0.2), unknown),
            judged(&Truth::Between(HALLWAY, Vec::new()), seen_hallway(0.0)),
        ];
        let figures = figures(&views, &[], Calibration::Right);
        for (of, what, counts) in [
            ("hallway", "not called hallway", (2, 4)),
            ("hallway", "called junction", (1, 4)),
            ("junction", NOT_RIGHT, (1, 2)),
            ("junction", KIND_OR_ENTRY_WRONG, (1, 2)),
            ("past", NOT_RIGHT, (1, 1)),
            ("between", "unknown", (0, 1)),
            ("turned", "kind wrong", (0, 0)),
        ] {
            let rate = rate(&figures, of, what);
            assert_eq!((rate.seen, rate.cases), counts, "{of}: {what}");
        }
        // The four hallways are too few to show a rate, but half of them are not hallways.
        assert_eq!(figures.status(), TargetStatus::Missed);
        for (what, count, most) in [
            ("direction", 2, 0.02_f64.to_degrees()),
            ("distance to a side", 4, 1.0),
            ("place of a centre line", 2, 1.0),
        ] {
            let errors = figures.errors.iter().find(|errors| errors.what == what).unwrap();
            assert_eq!(errors.sample.count(), count, "{what}");
            assert!((errors.quantile(1.0).unwrap() - most).abs() < 1e-9, "{what}");
        }
        let said = &figures.confusion[&SceneClass::Hallway];
        assert_eq!((said[&SceneClass::Hallway], said[&SceneClass::Unknown]), (2, 1));
        // Views past the turning point or between places are not in the confusion matrix.
        assert_eq!(figures.confusion.values().flat_map(|said| said.values()).sum::<usize>(), 6);
    }

    #[test]
    fn a_visit_is_wrong_undecided_or_right_and_so_is_its_marker() {
        let pointing = |door| Sighting::Pointing(Door(door));
        let visit = |sighting, decided: Option<(JunctionShape, Sighting)>| JudgedVisit {
            views: Vec::new(),
            shape: L,
            percept: Percept { degree: 2, sighting },
            decided: decided
                .map(|(shape, sighting)| (shape, Percept { degree: shape.degree(), sighting })),
        };
        let dead_end = JunctionShape([true, false, false, false]);
        let visits = [
            visit(Sighting::Nothing, Some((L, Sighting::Nothing))),
            visit(Sighting::Nothing, Some((L, pointing(0)))),
            visit(pointing(1), Some((L, pointing(1)))),
            visit(pointing(1), Some((L, pointing(0)))),
            visit(pointing(1), Some((L, Sighting::Nothing))),
            visit(pointing(1), Some((dead_end, Sighting::Nothing))),
            visit(pointing(1), None),
        ];
        let figures = figures(&[], &visits, Calibration::Right);
        for (what, counts) in [
            (NOT_DECIDED, (1, 7)),
            (KIND_OR_ENTRY_WRONG, (1, 7)),
            ("marker missed", (1, 3)),
            ("marker seen where it is not", (1, 2)),
            ("marker's door wrong", (1, 2)),
        ] {
            let rate = rate(&figures, "visit", what);
            assert_eq!((rate.seen, rate.cases), counts, "{what}");
        }
    }

    #[test]
    fn the_targets_of_places_are_these_and_an_empty_report_does_not_meet_them() {
        let figures = figures(&[], &[], Calibration::Right);
        assert_eq!(figures.status(), TargetStatus::NotShown);
        let targets =
            figures.rates.iter().filter_map(|rate| Some((rate.of, rate.what, rate.limit?)));
        let of_places = targets.filter(|(of, ..)| ["hallway", "junction"].contains(of));
        let expected = [
            ("hallway", "not called hallway", 0.005),
            ("hallway", "called junction", 0.0005),
            ("junction", NOT_RIGHT, 0.01),
            ("junction", ONLY_POSSIBLE, 0.02),
            ("junction", KIND_OR_ENTRY_WRONG, 0.001),
        ];
        assert_eq!(of_places.collect::<Vec<_>>(), expected);
    }

    #[test]
    fn a_wrong_calibration_triples_the_allowed_rates() {
        let [right, wrong] =
            [Calibration::Right, Calibration::Wrong].map(|which| figures(&[], &[], which));
        for what in [NOT_RIGHT, KIND_OR_ENTRY_WRONG] {
            let [right, wrong] =
                [&right, &wrong].map(|figures| rate(figures, "junction", what).limit.unwrap());
            assert!((wrong / right - 3.0).abs() < 1e-12, "{what}");
        }
        assert!(wrong.errors.is_empty());
        assert!(wrong.rates.iter().all(|rate| rate.of != "marker"));
        assert_eq!(rate(&wrong, "visit", "marker missed").limit, None);
    }
}
