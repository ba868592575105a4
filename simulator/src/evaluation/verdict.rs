//! Compares scenes with the ground truth.

use std::{f64::consts::FRAC_PI_4, fmt};

use nalgebra::Point2;
use toposlam_model::{
    driving::scene::{
        CentreLine, HallwayView, JunctionView, MarkerView, Place, Scene, undirected, wrapped,
    },
    floor_plan::JunctionKind,
};
use toposlam_vision::{
    geometry::{distance, unit},
    params::{MARKER_LENGTH, MARKER_WIDTH},
};

use crate::{
    sample_verdict::SampleVerdict,
    truth::{HallwayTruth, JunctionTruth, MarkerTruth, Truth},
};

/// The verdict on a scene's place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum PlaceVerdict {
    Right,
    Unknown,
    /// A junction was reported as a hallway.
    HallwayForJunction,
    /// A hallway was reported as a junction.
    JunctionForHallway,
    /// A junction was reported as another kind.
    WrongKind,
    /// The kind is right, but the entry door is wrong.
    WrongEntry,
}

impl PlaceVerdict {
    pub fn is_wrong(self) -> bool {
        self.verdict() == SampleVerdict::Wrong
    }

    pub fn verdict(self) -> SampleVerdict {
        match self {
            Self::Right => SampleVerdict::Right,
            Self::Unknown => SampleVerdict::Undecided,
            _ => SampleVerdict::Wrong,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HallwayErrors {
    /// Error of the direction, in radians.
    pub heading: f64,
    /// Errors of the distances to the left and the right wall, in metres.
    pub sides: [f64; 2],
}

#[derive(Clone, Debug, PartialEq)]
pub struct JunctionErrors {
    /// For each centre line, clockwise from the entry door: its distance from the true turning
    /// point in metres, and the error of its direction in radians.
    pub lines: Vec<(f64, f64)>,
    /// Error of the turning point, in metres.
    pub turning_point: f64,
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
    match (truth, &scene.place) {
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
    let rotations = if truth.form.is_some() { 1 } else { truth.doors.len() };
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

pub fn hallway_errors(truth: &HallwayTruth, view: &HallwayView) -> HallwayErrors {
    // The view may have the opposite direction.
    let turned = (truth.heading - view.heading).cos() < 0.0;
    let [left, right] = if turned { [truth.right, truth.left] } else { [truth.left, truth.right] };
    HallwayErrors {
        heading: undirected(view.heading - truth.heading).abs(),
        sides: [(view.left - left).abs(), (view.right - right).abs()],
    }
}

/// The errors of a junction in a scene; `None` if the doors are not its doors.
pub fn junction_errors(truth: &JunctionTruth, view: &JunctionView) -> Option<JunctionErrors> {
    let doors = same_doors(truth, view)?;
    let point = Point2::from(truth.turning_point);
    let lines = doors.iter().zip(&view.doors).map(|(door, line)| {
        let off = unit(line.direction).perp(&(point - Point2::from(line.through))).abs();
        (off, wrapped(line.direction - door).abs())
    });
    let turning_point = distance(point, view.turning_point);
    Some(JunctionErrors { lines: lines.collect(), turning_point })
}

/// The verdict on a scene's marker, given the true marker, if there is one.
pub fn judge_marker(truth: Option<&MarkerTruth>, seen: Option<&MarkerView>) -> MarkerVerdict {
    match (truth, seen) {
        (_, None) => MarkerVerdict::NotSeen,
        (Some(truth), Some(seen)) if is_on(truth, seen.position) => {
            MarkerVerdict::Seen(seen.door.zip(truth.door).map(|(seen, door)| seen == door))
        }
        (_, Some(_)) => MarkerVerdict::Phantom,
    }
}

fn is_on(marker: &MarkerTruth, position: [f64; 2]) -> bool {
    let (axis, off) = (unit(marker.axis), Point2::from(position) - Point2::from(marker.position));
    axis.dot(&off).abs() <= MARKER_LENGTH / 2.0 + MARKER_OFF
        && axis.perp(&off).abs() <= MARKER_WIDTH / 2.0 + MARKER_OFF
}

impl fmt::Display for PlaceVerdict {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.pad(match self {
            Self::Right => "right",
            Self::Unknown => "unknown",
            Self::HallwayForJunction => "hallway-for-junction",
            Self::JunctionForHallway => "junction-for-hallway",
            Self::WrongKind => "wrong-kind",
            Self::WrongEntry => "wrong-entry",
        })
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use toposlam_model::{
        driving::{
            scene::{HallwayStatus, Reason},
            visit::JunctionShape,
        },
        embedded_graph::Vertex,
        percept::Door,
    };

    use super::*;

    const HALLWAY: HallwayTruth = HallwayTruth { heading: 0.1, left: 0.9, right: 0.7 };

    /// The shape does not matter here.
    const ENTERED: Option<JunctionShape> = Some(JunctionShape([true; 4]));

    fn junction(doors: &[f64], form: Option<JunctionShape>) -> JunctionTruth {
        JunctionTruth {
            vertex: Vertex(0),
            kind: [JunctionKind::DeadEnd, JunctionKind::L, JunctionKind::T][doors.len() - 1],
            form,
            doors: doors.to_vec(),
            turning_point: [0.4, 0.0],
        }
    }

    fn scene(place: Place) -> Scene {
        Scene { place, marker: None }
    }

    fn hallway(heading: f64, left: f64, right: f64) -> HallwayView {
        HallwayView { heading, left, right, status: HallwayStatus::Clear, confidence: 1.0 }
    }

    fn view(doors: &[f64]) -> JunctionView {
        let turning_point = [0.4, 0.0];
        let line = |&direction: &f64| CentreLine { through: turning_point, direction };
        JunctionView { doors: doors.iter().map(line).collect(), turning_point, confidence: 1.0 }
    }

    fn says(truth: &Truth, doors: &[f64]) -> PlaceVerdict {
        judge(truth, &scene(Place::Junction(view(doors))))
    }

    #[test]
    fn the_verdict_depends_on_kind_and_entry_and_on_where_the_robot_is() {
        let entered = Truth::Junction(junction(&[PI, FRAC_PI_2], ENTERED));
        // After a turn any door may be the entry.
        let turned = Truth::Junction(junction(&[FRAC_PI_2, 0.0], None));
        let near = junction(&[PI, FRAC_PI_2], ENTERED);
        let between = Truth::Between(HALLWAY, vec![near.clone()]);
        let two = Truth::Between(HALLWAY, vec![near, junction(&[PI], ENTERED)]);
        let hallway_truth = Truth::Hallway(HALLWAY);
        for (truth, doors, verdict) in [
            (&entered, &[PI - 0.3, FRAC_PI_2 + 0.2][..], PlaceVerdict::Right),
            (&entered, &[-PI + 0.3, FRAC_PI_2], PlaceVerdict::Right),
            (&entered, &[FRAC_PI_2, PI], PlaceVerdict::WrongEntry),
            (&entered, &[PI, -FRAC_PI_2], PlaceVerdict::WrongEntry),
            (&entered, &[PI], PlaceVerdict::WrongKind),
            (&entered, &[PI, FRAC_PI_2, 0.0], PlaceVerdict::WrongKind),
            (&turned, &[FRAC_PI_2, 0.0], PlaceVerdict::Right),
            (&turned, &[0.0, FRAC_PI_2], PlaceVerdict::Right),
            (&turned, &[0.0, -FRAC_PI_2], PlaceVerdict::WrongEntry),
            (&turned, &[0.0], PlaceVerdict::WrongKind),
            (&between, &[PI, FRAC_PI_2], PlaceVerdict::Right),
            (&between, &[PI, -FRAC_PI_2], PlaceVerdict::WrongEntry),
            (&between, &[PI], PlaceVerdict::WrongKind),
            (&two, &[PI], PlaceVerdict::Right),
            (&hallway_truth, &[PI], PlaceVerdict::JunctionForHallway),
        ] {
            assert_eq!(says(truth, doors), verdict, "{truth:?} {doors:?}");
        }
        for (truth, verdict) in [
            (&entered, PlaceVerdict::HallwayForJunction),
            (&between, PlaceVerdict::Right),
            (&hallway_truth, PlaceVerdict::Right),
        ] {
            let place = Place::Hallway(hallway(0.5, 0.1, 0.1));
            assert_eq!(judge(truth, &scene(place)), verdict, "{truth:?}");
        }
        let unknown = Place::Unknown(Reason::FewWalls);
        assert_eq!(judge(&entered, &scene(unknown)), PlaceVerdict::Unknown);
    }

    #[test]
    fn a_hallway_has_errors_of_direction_and_sides() {
        let errors = hallway_errors(&HALLWAY, &hallway(0.15, 0.92, 0.71));
        assert!((errors.heading - 0.05).abs() < 1e-12);
        assert!((errors.sides[0] - 0.02).abs() < 1e-12 && (errors.sides[1] - 0.01).abs() < 1e-12);
        // Across the hallway, both of its directions are equally near to ahead.
        let across = HallwayTruth { heading: FRAC_PI_2 - 0.01, ..HALLWAY };
        let errors = hallway_errors(&across, &hallway(-FRAC_PI_2 + 0.01, 0.7, 0.9));
        assert!((errors.heading - 0.02).abs() < 1e-12, "{errors:?}");
        assert!(errors.sides.iter().all(|&side| side < 1e-12), "{errors:?}");
    }

    #[test]
    fn a_junction_has_errors_of_centre_lines() {
        let truth = junction(&[PI, FRAC_PI_2], ENTERED);
        let mut seen = view(&[PI - 0.02, FRAC_PI_2]);
        seen.turning_point = [0.43, 0.04];
        seen.doors[0].through = [0.4, 0.04];
        seen.doors[1].through = [0.43, 7.0];
        let errors = junction_errors(&truth, &seen).unwrap();
        assert!((errors.turning_point - 0.05).abs() < 1e-12);
        assert!((errors.lines[0].0 - 0.04 * 0.02_f64.cos()).abs() < 1e-12);
        assert!((errors.lines[0].1 - 0.02).abs() < 1e-12);
        assert!((errors.lines[1].0 - 0.03).abs() < 1e-12 && errors.lines[1].1 < 1e-12);
        assert_eq!(junction_errors(&truth, &view(&[PI])), None);
    }

    #[test]
    fn a_marker_is_seen_only_where_it_is() {
        let truth = MarkerTruth {
            position: [0.5, 0.0],
            axis: 0.0,
            points: PI,
            door: Some(Door(0)),
            distance: Some(0.5),
        };
        let at = |x, y, door: Option<u32>| MarkerView {
            position: [x, y],
            axis: 0.0,
            door: door.map(Door),
        };
        let phantom = MarkerVerdict::Phantom;
        for (x, y, door, verdict) in [
            (0.5, 0.0, Some(0), MarkerVerdict::Seen(Some(true))),
            (0.9, 0.2, Some(1), MarkerVerdict::Seen(Some(false))),
            (0.9, 0.2, None, MarkerVerdict::Seen(None)),
            (1.0, 0.0, None, phantom),
            (0.5, 0.3, None, phantom),
        ] {
            assert_eq!(judge_marker(Some(&truth), Some(&at(x, y, door))), verdict, "{x} {y}");
        }
        assert_eq!(judge_marker(None, Some(&at(0.5, 0.0, None))), phantom);
        assert_eq!(judge_marker(Some(&truth), None), MarkerVerdict::NotSeen);
        let truth = MarkerTruth { door: None, ..truth };
        let seen = judge_marker(Some(&truth), Some(&at(0.5, 0.0, Some(1))));
        assert_eq!(seen, MarkerVerdict::Seen(None));
    }
}
