//! Pictures of each step of sensing. Section 3, Figures 6 to 9.

mod legend;

use image::{Rgb, RgbImage};
use nalgebra::{Isometry2, Point2, UnitComplex};
use toposlam_model::driving::scene::{CentreLine, MarkerView, Place, Scene};

use crate::{
    camera::Camera,
    colour::PixelClass,
    corner::{Bend, CornerSource},
    draw::{self, Canvas, PEN},
    geometry::unit,
    ground_view::GroundView,
    params::{MARKER_LENGTH, MARKER_WIDTH, ROBOT_RADIUS},
    sensing::{SensingTrace, Sensor, WrongSize},
    wall::WallSegment,
};

pub use legend::{LegendSign, StageLegend, legend};

pub(crate) const BODY: Rgb<u8> = Rgb([90, 90, 90]);
/// The direction of the edge on which the robot is.
pub(crate) const GREEN: Rgb<u8> = Rgb([0, 200, 60]);
pub(crate) const RED: Rgb<u8> = Rgb([235, 30, 30]);
const BLUE: Rgb<u8> = Rgb([40, 90, 255]);
pub(crate) const WHITE: Rgb<u8> = Rgb([255, 255, 255]);
/// Edges: corners that bend outwards.
pub(crate) const ORANGE: Rgb<u8> = Rgb([255, 150, 0]);
pub(crate) const CYAN: Rgb<u8> = Rgb([0, 220, 230]);
const CLUSTERS: [Rgb<u8>; 6] = [
    Rgb([230, 80, 70]),
    Rgb([80, 170, 255]),
    Rgb([250, 200, 60]),
    Rgb([110, 220, 110]),
    Rgb([220, 120, 230]),
    Rgb([90, 220, 210]),
];
/// The length of a centre line in a picture, in metres. The legend names it, too.
const CENTRE_LINE: f64 = 1.6;
pub(crate) const REACH: Rgb<u8> = Rgb([40, 60, 40]);
const WALL: Rgb<u8> = Rgb([150, 150, 150]);
pub(crate) const DARK: Rgb<u8> = Rgb([24, 24, 28]);

/// The names of the steps, in their order.
pub const STAGES: [&str; 6] =
    ["1-classes", "2-boundary", "3-clusters", "4-lines", "5-scene", "6-image"];

pub type Stages = [(&'static str, RgbImage); 6];

/// The scene in an image, and a picture of each step that leads to it.
///
/// # Errors
/// Returns an error if the image is not of the calibrated camera's size.
pub fn stages(sensor: &mut Sensor, image: &RgbImage) -> Result<(Scene, Stages), WrongSize> {
    let (found, trace) = sensor.trace(image)?;
    let [one, two, three, four, five, six] = STAGES;
    let stages = [
        (one, classes(sensor.ground_view())),
        (two, boundary(&trace)),
        (three, clusters(&trace)),
        (four, lines(&trace)),
        (five, scene(&found, &trace)),
        (six, over(image, sensor.camera(), &found)),
    ];
    Ok((found, stages))
}

pub fn shade(class: PixelClass) -> Rgb<u8> {
    match class {
        PixelClass::Unseen => Rgb([0, 0, 0]),
        PixelClass::Unknown => Rgb([110, 40, 110]),
        PixelClass::Floor => Rgb([70, 110, 70]),
        PixelClass::Stripe => Rgb([250, 240, 200]),
        PixelClass::Marker => BLUE,
        PixelClass::Other => Rgb([60, 50, 50]),
    }
}

pub fn classes(view: &GroundView) -> RgbImage {
    let mut canvas = empty();
    for (pixel, class) in canvas.picture.pixels_mut().zip(view.classes()) {
        *pixel = shade(class);
    }
    with_body(canvas).picture
}

pub fn boundary(trace: &SensingTrace) -> RgbImage {
    let mut canvas = empty();
    for (bearing, sight) in
        trace.boundary.iter().flat_map(|boundary| boundary.sights.iter().enumerate())
    {
        let at = |range: f64| Point2::from(range * crate::bearing::direction(bearing));
        if sight.floor > 0.0 {
            canvas.line(at(0.30), at(sight.floor), REACH);
        }
        for edge in sight.edges() {
            canvas.dot(at(edge.range), 1, if edge.sure { WHITE } else { ORANGE });
        }
    }
    with_body(canvas).picture
}

pub fn clusters(trace: &SensingTrace) -> RgbImage {
    let mut canvas = empty();
    for (cluster, colour) in trace.clusters.iter().zip(CLUSTERS.into_iter().cycle()) {
        for &point in &cluster.points {
            canvas.dot(point, 2, colour);
        }
    }
    with_body(canvas).picture
}

/// Straight lines, in the colours of their clusters. Walls are thick, with a point at both ends.
pub fn lines(trace: &SensingTrace) -> RgbImage {
    let mut canvas = empty();
    for piece in &trace.lines {
        canvas.line(piece.from, piece.to, CLUSTERS[piece.cluster % CLUSTERS.len()]);
    }
    for wall in &trace.walls {
        let Some([from, to]) = ends(trace, wall) else { continue };
        canvas.thick(from, to, CLUSTERS[wall.cluster % CLUSTERS.len()]);
        canvas.dot(from, 4, WHITE);
        canvas.dot(to, 4, WHITE);
    }
    with_body(canvas).picture
}

pub fn scene(scene: &Scene, trace: &SensingTrace) -> RgbImage {
    let mut canvas = empty();
    for wall in &trace.walls {
        let Some([from, to]) = ends(trace, wall) else { continue };
        canvas.thick(from, to, WALL);
    }
    for corner in trace.corners.iter().filter(|corner| corner.formed != CornerSource::End) {
        let Some(frame) = trace.frame else { continue };
        let colour = match corner.bend {
            Bend::Inwards => CYAN,
            Bend::Outwards => ORANGE,
        };
        canvas.ring(frame.robot_from_walls() * corner.position, 9, colour);
    }
    let mut canvas = with_body(canvas);
    for (from, to, colour) in centre_lines(scene) {
        canvas.thick(from, to, colour);
    }
    if let Place::Junction(junction) = &scene.place {
        canvas.dot(junction.turning_point.into(), 6, WHITE);
    }
    if let Some(marker) = &scene.marker {
        draw::convex_polygon(&mut canvas.picture, &rectangle(marker).map(at), BLUE);
    }
    canvas.picture
}

pub fn over(image: &RgbImage, camera: &Camera, scene: &Scene) -> RgbImage {
    let mut picture = image.clone();
    let mut path = |from: Point2<f64>, to: Point2<f64>, colour| {
        // A straight line on the floor is a curve in the mirror.
        let point = |step: u32| from + f64::from(step) / 40.0 * (to - from);
        for step in 0..40 {
            let ends =
                [camera.ground_to_pixel(point(step)), camera.ground_to_pixel(point(step + 1))];
            if let [Some(from), Some(to)] = ends {
                for [right, down] in PEN.map(|off| off.map(f64::from)) {
                    let end =
                        |pixel: Point2<f64>| [(pixel.x + right) as f32, (pixel.y + down) as f32];
                    draw::line(&mut picture, end(from), end(to), colour);
                }
            }
        }
    };
    for (from, to, colour) in centre_lines(scene) {
        path(from, to, colour);
    }
    if let Some(marker) = &scene.marker {
        let corners = rectangle(marker);
        for side in 0..4 {
            path(corners[side], corners[(side + 1) % 4], BLUE);
        }
    }
    picture
}

/// The centre lines of a scene. That of the edge on which the robot stands is green, others are red.
// paper: sense.centre-lines
fn centre_lines(scene: &Scene) -> Vec<(Point2<f64>, Point2<f64>, Rgb<u8>)> {
    match &scene.place {
        Place::Hallway(hallway) => {
            let aside = (hallway.left - hallway.right) / 2.0;
            let turn = UnitComplex::new(hallway.heading);
            let [from, to] = [-1.5, 2.0].map(|far| turn * Point2::new(far, aside));
            vec![(from, to, GREEN)]
        }
        Place::Junction(junction) => {
            let drawn = |(door, line): (usize, &CentreLine)| {
                let colour = if door == 0 { GREEN } else { RED };
                let through = Point2::from(line.through);
                (through, through + CENTRE_LINE * unit(line.direction), colour)
            };
            junction.doors.iter().enumerate().map(drawn).collect()
        }
        Place::Unknown(_) => Vec::new(),
    }
}

fn rectangle(marker: &MarkerView) -> [Point2<f64>; 4] {
    let robot_from_marker = Isometry2::new(marker.position.into(), marker.axis);
    [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].map(|(ahead, left)| {
        robot_from_marker * Point2::new(ahead * MARKER_LENGTH / 2.0, left * MARKER_WIDTH / 2.0)
    })
}

fn ends(trace: &SensingTrace, wall: &WallSegment) -> Option<[Point2<f64>; 2]> {
    let robot_from_walls = trace.frame?.robot_from_walls();
    Some([wall.from, wall.to].map(|end| robot_from_walls * wall.along.point(end, wall.offset)))
}

fn empty() -> Canvas<fn(Point2<f64>) -> [f32; 2]> {
    let side = GroundView::SIDE as u32;
    let pixel = |point: Point2<f64>| at(point).map(|part| part as f32);
    Canvas { picture: RgbImage::from_pixel(side, side, DARK), pixel }
}

/// The pixel of a ground view that contains a point of the floor.
fn at(point: Point2<f64>) -> [i32; 2] {
    let middle = GroundView::SIDE as f64 / 2.0;
    [point.y, point.x].map(|part| (middle - part / GroundView::SCALE) as i32)
}

/// The picture with the robot: its outline, and a line ahead.
// paper: sense.contour
fn with_body<P: Fn(Point2<f64>) -> [f32; 2]>(mut canvas: Canvas<P>) -> Canvas<P> {
    let (middle, radius) = (Point2::origin(), (ROBOT_RADIUS / GroundView::SCALE) as i32);
    canvas.dot(middle, radius, BODY);
    draw::ring(&mut canvas.picture, at(middle), radius, WHITE);
    canvas.line(middle, Point2::new(ROBOT_RADIUS, 0.0), WHITE);
    canvas
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use toposlam_model::driving::scene::{HallwayStatus, HallwayView, JunctionView, Reason};

    use super::*;
    use crate::colour::Confusion;

    fn l_with_aid() -> Scene {
        let through = [0.5, -0.1];
        let doors = [3.0, -1.7].map(|direction| CentreLine { through, direction }).to_vec();
        let place =
            Place::Junction(JunctionView { doors, turning_point: through, confidence: 0.9 });
        let marker = MarkerView { position: through, axis: -0.14, door: None };
        Scene { place, marker: Some(marker) }
    }

    fn colour(picture: &RgbImage, [u, v]: [i32; 2]) -> Rgb<u8> {
        *picture.get_pixel(u as u32, v as u32)
    }

    #[test]
    fn the_entered_edge_is_green_the_other_red_and_the_marker_blue() {
        let scene_picture = scene(&l_with_aid(), &SensingTrace::default());
        let camera = Camera::superscout();
        let image = RgbImage::new(camera.image[0], camera.image[1]);
        let over = over(&image, &camera, &l_with_aid());
        let onwards = |direction: f64| Point2::new(0.5, -0.1) + unit(direction);
        for (point, expected) in [(onwards(3.0), GREEN), (onwards(-1.7), RED)] {
            assert_eq!(colour(&scene_picture, at(point)), expected);
            let pixel =
                camera.ground_to_pixel(point).unwrap().map(|part| part.round() as i32).into();
            assert_eq!(colour(&over, pixel), expected);
        }
        assert_eq!(colour(&scene_picture, at(Point2::new(0.75, -0.13))), BLUE);
        let corner = rectangle(&l_with_aid().marker.unwrap())[0];
        let pixel = camera.ground_to_pixel(corner).unwrap().map(|part| part.round() as i32).into();
        assert_eq!(colour(&over, pixel), BLUE);
    }

    #[test]
    fn a_hallways_centre_line_is_between_its_walls_and_an_unknown_place_has_none() {
        let hallway = HallwayView {
            heading: 0.0,
            left: 1.0,
            right: 0.6,
            status: HallwayStatus::Clear,
            confidence: 1.0,
        };
        let lines = |place| centre_lines(&Scene { place, marker: None });
        let [(from, to, colour)] = lines(Place::Hallway(hallway))[..] else { panic!("one line") };
        assert_eq!(colour, GREEN, "the robot is on it");
        assert!((from[1] - 0.2).abs() < 1e-9 && (to[1] - 0.2).abs() < 1e-9);
        assert!(lines(Place::Unknown(Reason::NoFloor)).is_empty());
    }

    #[test]
    fn every_class_has_its_own_shade() {
        let mut view = GroundView::drawn();
        view.classes[..5].copy_from_slice(&Confusion::GIVEN);
        let picture = classes(&view);
        let shades: HashSet<_> = picture.pixels().take(6).collect();
        assert_eq!(shades.len(), 6);
    }
}
