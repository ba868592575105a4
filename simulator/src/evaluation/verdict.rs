//! Compares scenes with the ground truth.

use std::f64::consts::FRAC_PI_4;

use nalgebra::Point2;
use toposlam_model::{
    driving::scene::{CentreLine, JunctionView, MarkerView, Place, Scene, undirected, wrapped},
    floor_plan::JunctionKind,
};
use toposlam_vision::{
    geometry::{distance, unit},
    params::{MARKER_LENGTH, MARKER_WIDTH},
};

use crate::{
    sample_verdict::SampleVerdict,
    truth::{JunctionTruth, Truth},
};

toposlam_model::words! {
    /// The verdict on a scene's place.
    PlaceVerdict {
        Right = "right",
        /// The junction is right, but only possible.
        Possible = "possible",
        /// So is a junction that is only possible and not right.
        Unknown = "unknown",
        /// A junction was reported as a hallway.
        HallwayForJunction = "hallway-for-junction",
        /// A hallway was reported as a junction.
        JunctionForHallway = "junction-for-hallway",
        /// A junction was reported as another kind.
        WrongKind = "wrong-kind",
        /// The kind is right, but the entry door is wrong.
        WrongEntry = "wrong-entry",
    }
}

impl PlaceVerdict {
    pub fn is_wrong(self) -> bool {
        self.verdict() == SampleVerdict::Wrong
    }

    pub fn verdict(self) -> SampleVerdict {
        match self {
            Self::Right => SampleVerdict::Right,
            Self::Possible | Self::Unknown => SampleVerdict::Undecided,
            _ => SampleVerdict::Wrong,
        }
    }
}

/// What a recognized hallway or junction can be wrong by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaceError {
    HallwayDirection,
    /// The distance to the wall on one side.
    HallwaySide,
    /// The distance of a centre line from the true turning point.
    CentreLinePlace,
    CentreLineDirection,
    TurningPoint,
}

/// The verdict on a scene's marker.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum MarkerVerdict {
    /// The scene has no marker. Whether it should have one depends on the robot's pose.
    NotSeen,
    /// The marker is where the scene has it. Its door is right, wrong or not reported.
    Seen(Option<bool>),
    /// The marker is somewhere else, or nowhere.
    Phantom,
}

/// The greatest distance of a reported marker from the border of the true one, in metres.
const MARKER_OFF: f64 = 0.15;

pub fn judge(truth: &Truth, scene: &Scene) -> PlaceVerdict {
    match (judge_place(truth, &scene.place), &scene.place) {
        (PlaceVerdict::Right, Place::Junction(view)) if !view.is_certain() => {
            PlaceVerdict::Possible
        }
        (_, Place::Junction(view)) if !view.is_certain() => PlaceVerdict::Unknown,
        (verdict, _) => verdict,
    }
}

fn judge_place(truth: &Truth, place: &Place) -> PlaceVerdict {
    match (truth, place) {
        (_, Place::Unknown(_)) => PlaceVerdict::Unknown,
        (Truth::Hallway(_) | Truth::Between(..), Place::Hallway(_)) => PlaceVerdict::Right,
        (Truth::Junction(_), Place::Hallway(_)) => PlaceVerdict::HallwayForJunction,
        (Truth::Hallway(_), Place::Junction(_)) => PlaceVerdict::JunctionForHallway,
        (Truth::Junction(truth), Place::Junction(view)) => judge_junction(truth, view),
        (Truth::Between(_, truths), Place::Junction(view)) => {
            let verdicts = truths.iter().map(|truth| judge_junction(truth, view));
            // The best verdict is that of the junction that was meant.
            let worse = [PlaceVerdict::Right, PlaceVerdict::WrongEntry, PlaceVerdict::WrongKind];
            let rank = |verdict: &PlaceVerdict| worse.iter().position(|other| other == verdict);
            verdicts.min_by_key(rank).unwrap_or(PlaceVerdict::JunctionForHallway)
        }
    }
}

fn judge_junction(truth: &JunctionTruth, view: &JunctionView) -> PlaceVerdict {
    if kind(view) != Some(truth.kind) {
        PlaceVerdict::WrongKind
    } else if same_doors(truth, view).is_some() {
        PlaceVerdict::Right
    } else {
        PlaceVerdict::WrongEntry
    }
}

/// The kind of a junction with this number of doors.
fn kind(view: &JunctionView) -> Option<JunctionKind> {
    match view.doors.len() {
        1 => Some(JunctionKind::DeadEnd),
        2 => Some(JunctionKind::L),
        3 => Some(JunctionKind::T),
        _ => None,
    }
}

/// The true directions of the doors in the view's order; `None` if one of them is another door. If
/// the robot has turned, any door may come first.
fn same_doors(truth: &JunctionTruth, view: &JunctionView) -> Option<Vec<f64>> {
    let rotations = if truth.shape.is_some() { 1 } else { truth.doors.len() };
    let mut doors = truth.doors.clone();
    for _ in 0..rotations {
        let same =
            |(door, view): (&f64, &CentreLine)| wrapped(view.direction - door).abs() < FRAC_PI_4;
        if doors.len() == view.doors.len() && doors.iter().zip(&view.doors).all(same) {
            return Some(doors);
        }
        doors.rotate_left(1);
    }
    None
}

/// The errors of a place that is recognized as what it is, in metres or radians.
pub fn place_errors(truth: &Truth, place: &Place) -> Vec<(PlaceError, f64)> {
    match (truth, place) {
        (Truth::Hallway(truth), Place::Hallway(view)) => {
            // The view may have the opposite direction.
            let turned = (truth.heading - view.heading).cos() < 0.0;
            let [left, right] =
                if turned { [truth.right, truth.left] } else { [truth.left, truth.right] };
            vec![
                (PlaceError::HallwayDirection, undirected(view.heading - truth.heading).abs()),
                (PlaceError::HallwaySide, (view.left - left).abs()),
                (PlaceError::HallwaySide, (view.right - right).abs()),
            ]
        }
        (Truth::Junction(truth), Place::Junction(view)) => {
            let Some(doors) = same_doors(truth, view) else { return Vec::new() };
            let point = Point2::from(truth.turning_point);
            let lines = doors.iter().zip(&view.doors).flat_map(|(door, line)| {
                let off = unit(line.direction).perp(&(point - Point2::from(line.through))).abs();
                let turned = wrapped(line.direction - door).abs();
                [(PlaceError::CentreLinePlace, off), (PlaceError::CentreLineDirection, turned)]
            });
            let off = distance(point, view.turning_point);
            lines.chain([(PlaceError::TurningPoint, off)]).collect()
        }
        _ => Vec::new(),
    }
}

/// The verdict on a scene's marker, given the true marker, if there is one.
pub fn judge_marker(truth: Option<&MarkerView>, seen: Option<&MarkerView>) -> MarkerVerdict {
    match (truth, seen) {
        (_, None) => MarkerVerdict::NotSeen,
        (Some(truth), Some(seen)) if is_on(truth, seen.position) => {
            MarkerVerdict::Seen(seen.door.zip(truth.door).map(|(seen, door)| seen == door))
        }
        (_, Some(_)) => MarkerVerdict::Phantom,
    }
}

fn is_on(marker: &MarkerView, position: [f64; 2]) -> bool {
    let (axis, off) = (unit(marker.axis), Point2::from(position) - Point2::from(marker.position));
    axis.dot(&off).abs() <= MARKER_LENGTH / 2.0 + MARKER_OFF
        && axis.perp(&off).abs() <= MARKER_WIDTH / 2.0 + MARKER_OFF
}

#[cfg(test)]
pub(super) mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use toposlam_model::{
        driving::{
            scene::{HallwayStatus, HallwayView, Reason},
            visit::JunctionShape,
        },
        embedded_graph::Vertex,
        percept::Door,
    };

    use super::*;
    use crate::truth::HallwayTruth;

    pub(in crate::evaluation) const HALLWAY: HallwayTruth =
        HallwayTruth { heading: 0.1, left: 0.9, right: 0.7 };
    pub(in crate::evaluation) const L: JunctionShape = JunctionShape([true, true, false, false]);

    /// A junction with these doors, so far ahead.
    pub(in crate::evaluation) fn junction(
        doors: &[f64],
        shape: Option<JunctionShape>,
        ahead: f64,
    ) -> JunctionTruth {
        JunctionTruth {
            vertex: Vertex(0),
            kind: [JunctionKind::DeadEnd, JunctionKind::L, JunctionKind::T][doors.len() - 1],
            shape,
            doors: doors.to_vec(),
            turning_point: [ahead, 0.0],
        }
    }

    pub(in crate::evaluation) fn in_hallway(heading: f64, left: f64, right: f64) -> Place {
        let status = HallwayStatus::Clear;
        Place::Hallway(HallwayView { heading, left, right, status, confidence: 1.0 })
    }

    fn view(doors: &[f64], turning_point: [f64; 2]) -> JunctionView {
        let line = |&direction: &f64| CentreLine { through: turning_point, direction };
        JunctionView { doors: doors.iter().map(line).collect(), turning_point, confidence: 1.0 }
    }

    pub(in crate::evaluation) fn at_junction(doors: &[f64], turning_point: [f64; 2]) -> Place {
        Place::Junction(view(doors, turning_point))
    }

    #[test]
    fn a_junction_that_is_only_possible_is_never_wrong() {
        let entered = Truth::Junction(junction(&[PI, FRAC_PI_2], Some(L), 0.4));
        for (truth, doors, verdict) in [
            (&entered, &[PI, FRAC_PI_2][..], PlaceVerdict::Possible),
            (&entered, &[PI], PlaceVerdict::Unknown),
            (&Truth::Hallway(HALLWAY), &[PI], PlaceVerdict::Unknown),
        ] {
            let view = JunctionView { confidence: 0.5, ..view(doors, [0.4, 0.0]) };
            let scene = Scene { place: Place::Junction(view), marker: None };
            assert_eq!(judge(truth, &scene), verdict, "{doors:?}");
            assert_eq!(verdict.verdict(), SampleVerdict::Undecided);
        }
    }

    #[test]
    fn the_verdict_depends_on_kind_and_entry_and_on_where_the_robot_is() {
        let near = junction(&[PI, FRAC_PI_2], Some(L), 0.4);
        let entered = Truth::Junction(near.clone());
        // After a turn any door may be the entry.
        let turned = Truth::Junction(junction(&[FRAC_PI_2, 0.0], None, 0.4));
        let between = Truth::Between(HALLWAY, vec![near.clone()]);
        let two = Truth::Between(HALLWAY, vec![near, junction(&[PI], Some(L), 0.4)]);
        let hallway = Truth::Hallway(HALLWAY);
        let scene = |doors: &[f64]| at_junction(doors, [0.4, 0.0]);
        for (truth, place, verdict) in [
            (&entered, scene(&[PI - 0.3, FRAC_PI_2 + 0.2]), PlaceVerdict::Right),
            (&entered, scene(&[-PI + 0.3, FRAC_PI_2]), PlaceVerdict::Right),
            (&entered, scene(&[FRAC_PI_2, PI]), PlaceVerdict::WrongEntry),
            (&entered, scene(&[PI, -FRAC_PI_2]), PlaceVerdict::WrongEntry),
            (&entered, scene(&[PI]), PlaceVerdict::WrongKind),
            (&entered, scene(&[PI, FRAC_PI_2, 0.0]), PlaceVerdict::WrongKind),
            (&turned, scene(&[FRAC_PI_2, 0.0]), PlaceVerdict::Right),
            (&turned, scene(&[0.0, FRAC_PI_2]), PlaceVerdict::Right),
            (&turned, scene(&[0.0, -FRAC_PI_2]), PlaceVerdict::WrongEntry),
            (&turned, scene(&[0.0]), PlaceVerdict::WrongKind),
            (&between, scene(&[PI, FRAC_PI_2]), PlaceVerdict::Right),
            (&between, scene(&[PI, -FRAC_PI_2]), PlaceVerdict::WrongEntry),
            (&between, scene(&[PI]), PlaceVerdict::WrongKind),
            (&two, scene(&[PI]), PlaceVerdict::Right),
            (&hallway, scene(&[PI]), PlaceVerdict::JunctionForHallway),
            (&entered, in_hallway(0.5, 0.1, 0.1), PlaceVerdict::HallwayForJunction),
            (&between, in_hallway(0.5, 0.1, 0.1), PlaceVerdict::Right),
            (&hallway, in_hallway(0.5, 0.1, 0.1), PlaceVerdict::Right),
            (&entered, Place::Unknown(Reason::FewWalls), PlaceVerdict::Unknown),
        ] {
            let scene = Scene { place, marker: None };
            assert_eq!(judge(truth, &scene), verdict, "{truth:?} {scene:?}");
        }
    }

    #[track_caller]
    fn close(found: &[(PlaceError, f64)], expected: &[(PlaceError, f64)]) {
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for (one, other) in found.iter().zip(expected) {
            assert!(one.0 == other.0 && (one.1 - other.1).abs() < 1e-12, "{one:?} {other:?}");
        }
    }

    #[test]
    fn a_hallway_has_errors_of_direction_and_sides_and_a_junction_of_centre_lines() {
        use PlaceError::{
            CentreLineDirection, CentreLinePlace, HallwayDirection, HallwaySide, TurningPoint,
        };
        let errors = place_errors(&Truth::Hallway(HALLWAY), &in_hallway(0.15, 0.92, 0.71));
        close(&errors, &[(HallwayDirection, 0.05), (HallwaySide, 0.02), (HallwaySide, 0.01)]);
        // Across the hallway, both of its directions are equally near to ahead.
        let across = Truth::Hallway(HallwayTruth { heading: FRAC_PI_2 - 0.01, ..HALLWAY });
        let errors = place_errors(&across, &in_hallway(-FRAC_PI_2 + 0.01, 0.7, 0.9));
        close(&errors, &[(HallwayDirection, 0.02), (HallwaySide, 0.0), (HallwaySide, 0.0)]);

        let truth = Truth::Junction(junction(&[PI, FRAC_PI_2], Some(L), 0.4));
        let mut seen = view(&[PI - 0.02, FRAC_PI_2], [0.43, 0.04]);
        seen.doors[0].through = [0.4, 0.04];
        seen.doors[1].through = [0.43, 7.0];
        let expected = [
            (CentreLinePlace, 0.04 * 0.02_f64.cos()),
            (CentreLineDirection, 0.02),
            (CentreLinePlace, 0.03),
            (CentreLineDirection, 0.0),
            (TurningPoint, 0.05),
        ];
        close(&place_errors(&truth, &Place::Junction(seen)), &expected);
        assert_eq!(place_errors(&truth, &at_junction(&[PI], [0.4, 0.0])), []);
    }

    #[test]
    fn a_marker_is_seen_only_where_it_is() {
        let at = |x, y, door: Option<u32>| MarkerView {
            position: [x, y],
            axis: 0.0,
            door: door.map(Door),
        };
        let (there, unknown) = (Some(at(0.5, 0.0, Some(0))), Some(at(0.5, 0.0, None)));
        for (truth, seen, verdict) in [
            (there, Some(at(0.5, 0.0, Some(0))), MarkerVerdict::Seen(Some(true))),
            (there, Some(at(0.9, 0.2, Some(1))), MarkerVerdict::Seen(Some(false))),
            (there, Some(at(0.9, 0.2, None)), MarkerVerdict::Seen(None)),
            (there, Some(at(1.0, 0.0, None)), MarkerVerdict::Phantom),
            (there, Some(at(0.5, 0.3, None)), MarkerVerdict::Phantom),
            (None, unknown, MarkerVerdict::Phantom),
            (there, None, MarkerVerdict::NotSeen),
            (unknown, Some(at(0.5, 0.0, Some(1))), MarkerVerdict::Seen(None)),
        ] {
            let found = judge_marker(truth.as_ref(), seen.as_ref());
            assert_eq!(found, verdict, "{truth:?} {seen:?}");
        }
    }
}
