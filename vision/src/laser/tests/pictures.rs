//! The pictures of the steps of sensing in a room of known size.

use image::Rgb;
use nalgebra::Point2;
use toposlam_model::driving::odometry::Odometry;

use super::Walls;
use crate::{
    annotate::{BODY, CYAN, DARK, GREEN, ORANGE, REACH, RED, WHITE},
    geometry::unit,
    laser::{
        ends::WayEnd,
        params::LaserParams,
        pictures::{STAGES, legend, stages},
        sensor::LaserSensor,
    },
    place::PlaceSensor,
};

#[test]
fn each_picture_shows_at_each_point_what_is_there() {
    // Two corridors of 2 m that cross, and go on for 20 m.
    let crossing = Walls::new(&[
        &[
            [-20.0, 1.0],
            [-1.0, 1.0],
            [-1.0, 20.0],
            [1.0, 20.0],
            [1.0, 1.0],
            [20.0, 1.0],
            [20.0, -1.0],
        ],
        &[
            [20.0, -1.0],
            [1.0, -1.0],
            [1.0, -20.0],
            [-1.0, -20.0],
            [-1.0, -1.0],
            [-20.0, -1.0],
            [-20.0, 1.0],
        ],
    ]);
    let mut sensor = LaserSensor::new(LaserParams::default());
    let there = Odometry { position: [0.0, -0.1], heading: 0.0 };
    let scan = crossing.scan(&there, -180, 360);
    let view = sensor.view(&scan, &there).unwrap();
    let map = sensor.map().unwrap();
    let grid = &map.clearances.grid;
    let pictures = stages(&view, map, &scan);
    assert_eq!(pictures.each_ref().map(|(name, _)| *name), STAGES);
    let [scanned, mapped, ways, places] = pictures.map(|(_, picture)| picture);
    let size = (4 * grid.columns as u32, 4 * grid.rows() as u32);
    assert_eq!([&scanned, &mapped, &ways, &places].map(image::RgbImage::dimensions), [size; 4]);
    // A cell of 0.15 m has four pixels.
    let pixel = |point: Point2<f64>| {
        let [right, up] = ((point - grid.origin) / 0.15 * 4.0).map(|at| at as u32).into();
        (right, size.1 - 1 - up)
    };
    let at = |picture: &image::RgbImage, point: Point2<f64>| {
        let (u, v) = pixel(point);
        *picture.get_pixel(u, v)
    };
    let robot = Point2::from(view.robot.position);
    for picture in [&scanned, &mapped, &ways, &places] {
        assert_eq!(at(picture, robot + 0.1 * unit(2.0)), BODY);
        // The line from its middle shows where it looks.
        assert_eq!(at(picture, robot + 0.4 * unit(0.0)), WHITE);
    }
    assert_eq!(at(&mapped, robot + 0.7 * unit(0.0)), Rgb([62, 74, 92]), "the line ends");
    // 1.1 m to the south-west corner: 3 m along the corridor is its wall.
    let seen = |x: f64, y: f64| Point2::new(x, y + 0.1);
    for (x, y, colour) in
        [(3.0, 0.3, Rgb([62, 74, 92])), (0.4, -4.0, Rgb([62, 74, 92])), (3.0, 3.0, DARK)]
    {
        let point = robot + (seen(x, y) - Point2::origin());
        assert_eq!(at(&mapped, point), colour, "({x}, {y})");
    }
    // Rays are drawn from the scanner to what they met, and a dot there.
    let hits: Vec<Point2<f64>> = scan.hits().map(|hit| hit + robot.coords).collect();
    for hit in hits.iter().filter(|hit| (**hit - robot).norm() < 5.0) {
        assert_eq!(at(&scanned, *hit), WHITE);
        let half = robot + 0.5 * (hit - robot);
        let [u, v] = [pixel(half).0, pixel(half).1];
        let around = (u - 1..=u + 1).flat_map(|u| (v - 1..=v + 1).map(move |v| (u, v)));
        assert!(
            around.into_iter().any(|(u, v)| [REACH, BODY, WHITE].contains(scanned.get_pixel(u, v)))
        );
    }
    let skeleton = map.skeleton.as_ref().unwrap();
    let cells = (0..skeleton.cells.len()).filter(|&cell| skeleton.cells[cell]);
    let is_far = |point: &Point2<f64>| (*point - robot).norm() > 1.0;
    let middles: Vec<_> = cells.map(|cell| grid.point(cell)).filter(is_far).collect();
    assert!(middles.len() > 50);
    let lines = middles.iter().filter(|middle| at(&ways, **middle) == CYAN).count();
    assert!(lines > middles.len() - 20, "but for the rings around the ends: {lines}");
    for end in &skeleton.ends {
        let ring = grid.point(end.cell) + 5.5 / 4.0 * 0.15 * unit(0.0);
        let colour = if end.kind == WayEnd::Closed { RED } else { ORANGE };
        let (u, v) = pixel(ring);
        assert!((u - 1..=u + 1).any(|u| *ways.get_pixel(u, v) == colour), "{end:?}");
    }
    let [place] = &view.places[..] else { panic!("{:?}", view.places) };
    assert_eq!(place.arms.len(), 4);
    for arm in place.directions() {
        // A door is drawn from the walls of the junction to 1.5 m behind them.
        for (range, is_door) in [(0.2, true), (1.3, true), (1.8, false)] {
            let point = place.centre + (place.clearance + range) * unit(arm);
            assert_eq!(at(&places, point) == GREEN, is_door, "{arm}: {range}");
        }
    }
}

#[test]
fn each_step_has_a_legend_with_its_scale() {
    for (stage, entries) in STAGES.iter().zip([3, 4, 5, 5]) {
        let legend = legend(stage, 0.15);
        assert_eq!(legend.entries.len(), entries, "{stage}");
        assert!((legend.metre.unwrap() - 4.0 / 0.15).abs() < 1e-9);
    }
    let none = legend("5-nothing", 0.15);
    assert!(none.entries.is_empty() && none.metre.is_none());
}
