//! A scene as JSON.

use std::f64::consts::{FRAC_PI_2, PI};

use serde::Serialize;
pub use toposlam_draw::scene::{bearing, in_words, place_in_words, rows};
use toposlam_model::driving::scene::{
    CentreLine, HallwayStatus, HallwayView, MarkerView, Place, Scene,
};

/// A scene as JSON. The keys have the documented order.
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
        certain: bool,
        marker: Option<MarkerLine>,
    },
    Unknown {
        reason: String,
        marker: Option<MarkerLine>,
    },
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TurningLine {
    state: String,
    distance: f64,
}

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
                    certain: junction.is_certain(),
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

pub fn rounded(value: f64) -> f64 {
    // Adding zero turns negative zero into zero.
    (value * 1e6).round() / 1e6 + 0.0
}

/// Rounds an angle to six decimal places and keeps it within `greatest`.
pub fn rounded_angle(angle: f64, greatest: f64) -> f64 {
    let greatest = (greatest * 1e6).floor() / 1e6;
    rounded(angle).clamp(-greatest, greatest)
}

#[cfg(test)]
mod tests {
    use toposlam_model::{
        driving::scene::{JunctionView, Reason, Unclear},
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
                + r#""turning_point":{"state":"before","distance":0.42},"confidence":0.9,"certain":true,"#
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
