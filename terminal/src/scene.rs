//! A scene as JSON, as labelled rows and as one line.

use std::f64::consts::{FRAC_PI_2, PI};

use serde::Serialize;
use toposlam_model::driving::scene::{
    CentreLine, HallwayStatus, HallwayView, JunctionView, MarkerView, Place, Scene, Turning,
};

/// A scene as JSON. The keys have the documented order.
#[allow(missing_docs, reason = "the keys of the lines are documented in `docs/schema`")]
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "scene", rename_all = "lowercase")]
pub enum SceneLine {
    Hallway {
        status: &'static str,
        reason: Option<String>,
        heading: f64,
        left: f64,
        right: f64,
        confidence: f64,
        marker: Option<MarkerLine>,
    },
    Junction {
        degree: usize,
        doors: Vec<f64>,
        centre_lines: Vec<[f64; 3]>,
        turning_point: TurningLine,
        confidence: f64,
        marker: Option<MarkerLine>,
    },
    Unknown {
        reason: String,
        marker: Option<MarkerLine>,
    },
}

/// A turning point as JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TurningLine {
    state: String,
    distance: f64,
}

/// The marker as JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MarkerLine {
    position: [f64; 2],
    axis: f64,
    door: Option<u32>,
}

impl From<&Scene> for SceneLine {
    fn from(scene: &Scene) -> Self {
        let marker = scene.marker.as_ref().map(MarkerLine::from);
        match &scene.place {
            Place::Hallway(HallwayView { heading, left, right, status, confidence }) => {
                let (status, reason) = match status {
                    HallwayStatus::Clear => ("clear", None),
                    HallwayStatus::Unclear(reason) => ("unclear", Some(reason.to_string())),
                };
                let heading = rounded_angle(*heading, FRAC_PI_2);
                let [left, right] = [*left, *right].map(rounded);
                let confidence = rounded(*confidence);
                Self::Hallway { status, reason, heading, left, right, confidence, marker }
            }
            Place::Junction(junction) => {
                let doors = &junction.doors;
                let line = |door: &CentreLine| {
                    let [x, y] = door.through.map(rounded);
                    [x, y, rounded_angle(door.direction, PI)]
                };
                let centre_lines: Vec<_> = doors.iter().map(line).collect();
                Self::Junction {
                    degree: doors.len(),
                    doors: centre_lines.iter().map(|line| line[2]).collect(),
                    centre_lines,
                    turning_point: TurningLine {
                        state: junction.turning().to_string(),
                        distance: rounded(junction.distance()),
                    },
                    confidence: rounded(junction.confidence),
                    marker,
                }
            }
            Place::Unknown(reason) => Self::Unknown { reason: reason.to_string(), marker },
        }
    }
}

impl From<&MarkerView> for MarkerLine {
    fn from(marker: &MarkerView) -> Self {
        Self {
            position: marker.position.map(rounded),
            axis: rounded_angle(marker.axis, FRAC_PI_2),
            door: marker.door.map(|door| door.0),
        }
    }
}

/// Rounds to six decimal places.
#[must_use]
pub fn rounded(value: f64) -> f64 {
    // Adding zero turns negative zero into zero.
    (value * 1e6).round() / 1e6 + 0.0
}

/// Rounds an angle to six decimal places and keeps it within `greatest`.
#[must_use]
pub fn rounded_angle(angle: f64, greatest: f64) -> f64 {
    let greatest = (greatest * 1e6).floor() / 1e6;
    rounded(angle).clamp(-greatest, greatest)
}

/// A scene as labels and texts. The first label is `place`.
#[must_use]
pub fn rows(scene: &Scene) -> Vec<(&'static str, String)> {
    let mut rows = match &scene.place {
        Place::Hallway(hallway) => hallway_rows(hallway),
        Place::Junction(junction) => junction_rows(junction),
        Place::Unknown(reason) => vec![("place", format!("unknown: {reason}"))],
    };
    rows.extend(scene.marker.as_ref().map(|marker| ("marker", marker_in_words(marker))));
    rows
}

/// A scene in one line.
#[must_use]
pub fn in_words(scene: &Scene) -> String {
    let texts = rows(scene).into_iter().map(|(label, text)| match label {
        "place" => text,
        _ => format!("{label} {text}"),
    });
    texts.collect::<Vec<_>>().join("; ")
}

fn hallway_rows(hallway: &HallwayView) -> Vec<(&'static str, String)> {
    let status = match hallway.status {
        HallwayStatus::Clear => "clear".to_owned(),
        HallwayStatus::Unclear(reason) => format!("unclear ({reason})"),
    };
    let HallwayView { heading, left, right, confidence, .. } = hallway;
    vec![
        ("place", format!("hallway, {status}, {}", bearing(*heading))),
        ("walls", format!("{left:.2} m to the left and {right:.2} m to the right")),
        ("confidence", format!("{confidence:.2}")),
    ]
}

fn junction_rows(junction: &JunctionView) -> Vec<(&'static str, String)> {
    let kind = match junction.doors.len() {
        1 => "dead end",
        2 => "L",
        3 => "T",
        _ => "junction",
    };
    let doors: Vec<_> = junction.doors.iter().map(|door| bearing(door.direction)).collect();
    let distance = junction.distance();
    let turning = match junction.turning() {
        Turning::Before => format!("{distance:.2} m before its turning point"),
        Turning::At => "at its turning point".to_owned(),
        Turning::Past => format!("{:.2} m past its turning point", -distance),
    };
    vec![
        ("place", format!("{kind}, {turning}")),
        ("doors", doors.join(", ")),
        ("confidence", format!("{:.2}", junction.confidence)),
    ]
}

fn marker_in_words(marker: &MarkerView) -> String {
    let along = match marker.door {
        Some(door) => format!("along door {}", door.0),
        None => bearing(marker.axis),
    };
    format!("{}, {along}", place_in_words(marker.position))
}

/// A place in metres ahead and to the left of the robot, in words.
#[must_use]
pub fn place_in_words([x, y]: [f64; 2]) -> String {
    let side = if y < 0.0 { "right" } else { "left" };
    let (ahead, aside) = (if x < 0.0 { "behind" } else { "ahead" }, y.abs());
    format!("{:.2} m {ahead} and {aside:.2} m to the {side}", x.abs())
}

/// A direction in whole degrees, in words.
#[must_use]
pub fn bearing(angle: f64) -> String {
    let degrees = angle.to_degrees().round();
    match degrees {
        0.0 => "straight ahead".to_owned(),
        1.0 => "1 degree to the left".to_owned(),
        -1.0 => "1 degree to the right".to_owned(),
        180.0 | -180.0 => "straight behind".to_owned(),
        _ if degrees > 0.0 => format!("{degrees} degrees to the left"),
        _ => format!("{} degrees to the right", -degrees),
    }
}

#[cfg(test)]
mod tests {
    use toposlam_model::{
        driving::scene::{Reason, Unclear},
        percept::Door,
    };

    use super::*;

    fn json(scene: &Scene) -> String {
        serde_json::to_string(&SceneLine::from(scene)).unwrap()
    }

    #[test]
    fn scenes_have_the_documented_form() {
        let hallway = HallwayView {
            heading: 0.02,
            left: 0.78,
            right: 0.81,
            status: HallwayStatus::Clear,
            confidence: 0.97,
        };
        let scene = Scene { place: Place::Hallway(hallway), marker: None };
        assert_eq!(
            json(&scene),
            r#"{"scene":"hallway","status":"clear","reason":null,"heading":0.02,"left":0.78,"#
                .to_owned()
                + r#""right":0.81,"confidence":0.97,"marker":null}"#
        );
        assert_eq!(
            in_words(&scene),
            "hallway, clear, 1 degree to the left; walls 0.78 m to the left and 0.81 m to the \
             right; confidence 0.97"
        );
        let status = HallwayStatus::Unclear(Unclear::SizesDiffer);
        let place = Place::Hallway(HallwayView { status, ..hallway });
        let unclear = json(&Scene { place, marker: None });
        assert!(unclear.contains(r#""status":"unclear","reason":"sizes-differ","#), "{unclear}");
        let through = [0.42, 0.0];
        let line = |direction| CentreLine { through, direction };
        let junction = JunctionView {
            doors: vec![line(PI), line(FRAC_PI_2), line(0.0)],
            turning_point: through,
            confidence: 0.9,
        };
        let marker = MarkerView { position: [0.4, -0.1], axis: -0.000_000_1, door: Some(Door(1)) };
        let scene = Scene { place: Place::Junction(junction), marker: Some(marker) };
        assert_eq!(
            json(&scene),
            r#"{"scene":"junction","degree":3,"doors":[3.141592,1.570796,0.0],"#.to_owned()
                + r#""centre_lines":[[0.42,0.0,3.141592],[0.42,0.0,1.570796],[0.42,0.0,0.0]],"#
                + r#""turning_point":{"state":"before","distance":0.42},"confidence":0.9,"#
                + r#""marker":{"position":[0.4,-0.1],"axis":0.0,"door":1}}"#
        );
        assert_eq!(
            in_words(&scene),
            "T, 0.42 m before its turning point; doors straight behind, 90 degrees to the left, \
             straight ahead; confidence 0.90; marker 0.40 m ahead and 0.10 m to the right, along door 1"
        );
        let scene = Scene { place: Place::Unknown(Reason::NoFloor), marker: None };
        assert_eq!(json(&scene), r#"{"scene":"unknown","reason":"no-floor","marker":null}"#);
        assert_eq!(in_words(&scene), "unknown: no-floor");
    }
}
