//! A scene in words: as labelled rows and as one line.

use toposlam_model::driving::scene::{
    HallwayStatus, HallwayView, JunctionView, MarkerView, Place, Scene, Turning,
};

/// A scene as labels and texts. The first label is `place`.
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
    let certainty = if junction.is_certain() { "" } else { "possible " };
    vec![
        ("place", format!("{certainty}{kind}, {turning}")),
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
pub fn place_in_words([x, y]: [f64; 2]) -> String {
    let side = if y < 0.0 { "right" } else { "left" };
    let (ahead, aside) = (if x < 0.0 { "behind" } else { "ahead" }, y.abs());
    format!("{:.2} m {ahead} and {aside:.2} m to the {side}", x.abs())
}

/// A direction in whole degrees, in words.
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
