//! Compares scenes with the ground truth.

use std::{f64::consts::FRAC_PI_4, fmt};

use toposlam_model::{
    driving::scene::{
        CentreLine, HallwayView, JunctionView, MarkerView, Place, Scene, undirected, wrapped,
    },
    floor_plan::JunctionKind,
};
use toposlam_vision::params::{MARKER_LENGTH, MARKER_WIDTH};

use crate::truth::{HallwayTruth, JunctionTruth, MarkerTruth, Truth};

/// The verdict on a scene's place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum PlaceVerdict {
    /// It is right.
    Right,
    /// The scene is unknown.
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
    /// Whether the scene is wrong: neither right nor unknown.
    #[must_use]
    pub fn is_wrong(self) -> bool {
        !matches!(self, Self::Right | Self::Unknown)
    }
}

/// The errors of a hallway in a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HallwayErrors {
    /// Error of the direction, in radians.
    pub heading: f64,
    /// Errors of the distances to the left and the right wall, in metres.
    pub sides: [f64; 2],
}

/// The errors of a junction in a scene.
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

/// The verdict on a scene's place.
#[must_use]
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

/// The errors of a hallway in a scene.
#[must_use]
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
#[must_use]
pub fn junction_errors(truth: &JunctionTruth, view: &JunctionView) -> Option<JunctionErrors> {
    let doors = same_doors(truth, view)?;
    let [x, y] = truth.turning_point;
    let lines = doors.iter().zip(&view.doors).map(|(door, line)| {
        let [east, north] = [x - line.through[0], y - line.through[1]];
        let off = (north * line.direction.cos() - east * line.direction.sin()).abs();
        (off, wrapped(line.direction - door).abs())
    });
    let [u, v] = view.turning_point;
    Some(JunctionErrors { lines: lines.collect(), turning_point: (x - u).hypot(y - v) })
}

/// The verdict on a scene's marker, given the true marker, if there is one.
#[must_use]
pub fn judge_marker(truth: Option<&MarkerTruth>, seen: Option<&MarkerView>) -> MarkerVerdict {
    match (truth, seen) {
        (_, None) => MarkerVerdict::NotSeen,
        (Some(truth), Some(seen)) if is_on(truth, seen.position) => {
            MarkerVerdict::Seen(seen.door.zip(truth.door).map(|(seen, door)| seen == door))
        }
        (_, Some(_)) => MarkerVerdict::Phantom,
    }
}

/// Whether a position is on the marker or near it.
fn is_on(marker: &MarkerTruth, [x, y]: [f64; 2]) -> bool {
    let [u, v] = [x - marker.position[0], y - marker.position[1]];
    let (sine, cosine) = marker.axis.sin_cos();
    let [along, across] = [u * cosine + v * sine, v * cosine - u * sine].map(f64::abs);
    along <= MARKER_LENGTH / 2.0 + MARKER_OFF && across <= MARKER_WIDTH / 2.0 + MARKER_OFF
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
    fn at_a_junction_kind_and_entry_decide() {
        let truth = Truth::Junction(junction(&[PI, FRAC_PI_2], ENTERED));
        assert_eq!(says(&truth, &[PI - 0.3, FRAC_PI_2 + 0.2]), PlaceVerdict::Right);
        assert_eq!(says(&truth, &[-PI + 0.3, FRAC_PI_2]), PlaceVerdict::Right);
        assert_eq!(says(&truth, &[FRAC_PI_2, PI]), PlaceVerdict::WrongEntry);
        assert_eq!(says(&truth, &[PI, -FRAC_PI_2]), PlaceVerdict::WrongEntry);
        assert_eq!(says(&truth, &[PI]), PlaceVerdict::WrongKind);
        assert_eq!(says(&truth, &[PI, FRAC_PI_2, 0.0]), PlaceVerdict::WrongKind);
        let place = Place::Hallway(hallway(0.0, 0.8, 0.8));
        assert_eq!(judge(&truth, &scene(place)), PlaceVerdict::HallwayForJunction);
        let place = Place::Unknown(Reason::FewWalls);
        assert_eq!(judge(&truth, &scene(place)), PlaceVerdict::Unknown);
    }

    #[test]
    fn after_a_turn_any_door_may_be_the_entry() {
        let truth = Truth::Junction(junction(&[FRAC_PI_2, 0.0], None));
        assert_eq!(says(&truth, &[FRAC_PI_2, 0.0]), PlaceVerdict::Right);
        assert_eq!(says(&truth, &[0.0, FRAC_PI_2]), PlaceVerdict::Right);
        assert_eq!(says(&truth, &[0.0, -FRAC_PI_2]), PlaceVerdict::WrongEntry);
        assert_eq!(says(&truth, &[0.0]), PlaceVerdict::WrongKind);
    }

    #[test]
    fn between_places_the_hallway_and_the_right_junction_are_right() {
        let near = junction(&[PI, FRAC_PI_2], ENTERED);
        let truth = Truth::Between(HALLWAY, vec![near.clone()]);
        let place = Place::Hallway(hallway(0.0, 0.8, 0.8));
        assert_eq!(judge(&truth, &scene(place)), PlaceVerdict::Right);
        assert_eq!(says(&truth, &[PI, FRAC_PI_2]), PlaceVerdict::Right);
        assert_eq!(says(&truth, &[PI, -FRAC_PI_2]), PlaceVerdict::WrongEntry);
        assert_eq!(says(&truth, &[PI]), PlaceVerdict::WrongKind);
        let other = junction(&[PI], ENTERED);
        assert_eq!(says(&Truth::Between(HALLWAY, vec![near, other]), &[PI]), PlaceVerdict::Right);
    }

    #[test]
    fn far_from_junctions_only_the_hallway_is_right() {
        assert_eq!(says(&Truth::Hallway(HALLWAY), &[PI]), PlaceVerdict::JunctionForHallway);
        let place = Place::Hallway(hallway(0.5, 0.1, 0.1));
        assert_eq!(judge(&Truth::Hallway(HALLWAY), &scene(place)), PlaceVerdict::Right);
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
        let at = |x, y, door| MarkerView { position: [x, y], axis: 0.0, door };
        let judged = |x, y, door| judge_marker(Some(&truth), Some(&at(x, y, door)));
        assert_eq!(judged(0.5, 0.0, Some(Door(0))), MarkerVerdict::Seen(Some(true)));
        assert_eq!(judged(0.9, 0.2, Some(Door(1))), MarkerVerdict::Seen(Some(false)));
        assert_eq!(judged(0.9, 0.2, None), MarkerVerdict::Seen(None));
        assert_eq!(judged(1.0, 0.0, None), MarkerVerdict::Phantom);
        assert_eq!(judged(0.5, 0.3, None), MarkerVerdict::Phantom);
        assert_eq!(judge_marker(None, Some(&at(0.5, 0.0, None))), MarkerVerdict::Phantom);
        assert_eq!(judge_marker(Some(&truth), None), MarkerVerdict::NotSeen);
        let truth = MarkerTruth { door: None, ..truth };
        assert_eq!(
            judge_marker(Some(&truth), Some(&at(0.5, 0.0, Some(Door(1))))),
            MarkerVerdict::Seen(None)
        );
    }
}
