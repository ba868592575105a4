//! Sensing on a few hundred rendered views against the floor plan: a small `evaluate
//! vision`.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

use toposlam_simulator::{
    LOOKS,
    evaluation::{
        judge::{Calibration, Judge},
        judged_view::{JudgedView, Zone},
        report::TargetStatus,
        sampling::sample,
        verdict::{MarkerVerdict, PlaceVerdict},
        vision_report,
    },
    view_sampler::ViewSampler,
};
use toposlam_vision::camera::Camera;

/// The numbers of views and visits.
const VIEWS: u64 = 240;
const VISITS: u64 = 16;

fn views() -> ViewSampler {
    ViewSampler { random_plans: true, ..ViewSampler::from_looks(&LOOKS, [640, 480], 2024).unwrap() }
}

/// The number of views in a zone, and the number of right ones.
fn right(judged: &[JudgedView], zone: Zone) -> (usize, usize) {
    let there = judged.iter().filter(|judged| judged.zone() == zone);
    (there.clone().count(), there.filter(|judged| judged.verdict == PlaceVerdict::Right).count())
}

// paper: sense.place
// paper: sense.junction.type
// paper: sense.junction.entry
#[test]
#[ignore = "a long sweep, for `.ci/run --all`"]
fn sensing_is_never_wrong_and_seldom_unknown() {
    let views = views();
    let judge = Judge::new(&Camera::superscout(), &views, &[Calibration::Right], &()).unwrap();
    let judged = sample(0..VIEWS, &(), |number| {
        Some(judge.view(views.view(number).unwrap(), Calibration::Right).unwrap())
    });
    for judged in &judged {
        assert!(!judged.verdict.is_wrong(), "{judged:#?}");
        assert_ne!(judged.marker, MarkerVerdict::Phantom, "{judged:#?}");
    }
    let zones = [Zone::Hallway, Zone::Between, Zone::Before, Zone::Past, Zone::Turned];
    let counted = zones.map(|zone| right(&judged, zone));
    assert_eq!(counted.map(|(all, _)| all), [59, 100, 51, 24, 6]);
    let least = [59, 99, 51, 23, 6];
    let enough = counted.iter().zip(least).all(|((_, right), least)| *right >= least);
    assert!(enough, "of each, and right: {counted:?}");
    let visits = sample(0..VISITS, &(), |number| {
        judge.visit(views.visit(number).unwrap(), Calibration::Right, &()).unwrap()
    });
    let decided = visits.iter().filter(|visit| visit.decided.is_some());
    assert!(decided.clone().count() >= 15, "{}", decided.count());
    for visit in decided {
        assert_eq!(visit.decided, Some((visit.shape, visit.percept)), "{visit:#?}");
    }
    for errors in vision_report::figures(&judged, &visits, Calibration::Right).errors {
        // These views are too few to show some targets.
        assert_ne!(errors.status(), TargetStatus::Missed, "{errors:?}");
    }
}
