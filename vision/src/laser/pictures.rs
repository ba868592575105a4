//! Pictures of the steps of sensing with a laser scanner: the scan, the local map, the middle lines of its
//! ways, and the junctions.

use image::{Rgb, RgbImage};
use nalgebra::Point2;

use super::{ends::WayEnd, grid::Grid, local_map::LocalMap, scan::Scan};
use crate::{
    annotate::{BODY, CYAN, DARK, GREEN, LegendSign, ORANGE, REACH, RED, StageLegend, WHITE},
    draw::Canvas,
    geometry::{from_robot, unit},
    place::{PlaceView, SeenPlace},
};

/// The names of the steps, in their order.
pub const STAGES: [&str; 4] = ["1-scan", "2-map", "3-ways", "4-junctions"];

/// The pixels of a side of a cell.
const ZOOM: usize = 4;
const FREE: Rgb<u8> = Rgb([62, 74, 92]);
/// Free space behind what else is drawn.
const DIM: Rgb<u8> = Rgb([44, 50, 60]);
/// Walls behind what else is drawn.
const WALL: Rgb<u8> = Rgb([150, 150, 150]);
/// How far the lines of the doors of a junction reach beyond its walls, in metres.
const DOOR: f64 = 1.5;
/// The radius of the robot, in metres.
const ROBOT: f64 = 0.25;

/// The legend of the picture of a step, by the step's name; empty for any other name.
pub fn legend(stage: &str, cell: f64) -> StageLegend {
    use LegendSign::{Areas, Dot, Line, Ring, Robot, Thick};
    let walls = (Areas(vec![WALL]), "wall or obstacle");
    let mut entries = match stage {
        "1-scan" => {
            vec![(Areas(vec![REACH]), "up to what a ray met"), (Dot(WHITE), "where a ray ended")]
        }
        "2-map" => vec![
            (Areas(vec![FREE]), "free"),
            (Areas(vec![WHITE]), "wall or obstacle"),
            (Areas(vec![DARK]), "unknown"),
        ],
        "3-ways" => vec![
            walls,
            (Line(CYAN), "middle line of a way"),
            (Ring(ORANGE), "end of what is known"),
            (Ring(RED), "end of a way"),
        ],
        "4-junctions" => vec![
            walls,
            (Line(CYAN), "way that counts"),
            (Dot(WHITE), "centre of a junction"),
            (Thick(GREEN), "door"),
        ],
        _ => Vec::new(),
    };
    if entries.is_empty() {
        return StageLegend { entries, metre: None };
    }
    entries.push((Robot { body: BODY, outline: WHITE }, "robot"));
    StageLegend { entries, metre: Some(ZOOM as f64 / cell) }
}

/// A map with each cell in the colour of its kind: unknown, free or occupied.
fn drawn(grid: &Grid, colours: [Rgb<u8>; 3]) -> Canvas<impl Fn(Point2<f64>) -> [f32; 2]> {
    let [width, height] = [grid.columns, grid.rows()].map(|count| (count * ZOOM) as u32);
    let picture = RgbImage::from_fn(width, height, |u, v| {
        let [column, row] = [u, height - 1 - v].map(|at| at as usize / ZOOM);
        colours[grid.cells[row * grid.columns + column] as usize]
    });
    let pixel = move |point: Point2<f64>| {
        let [right, up] =
            ((point - grid.origin) / grid.cell * ZOOM as f64).map(|at| at as f32).into();
        [right, height as f32 - up]
    };
    Canvas { picture, pixel }
}

/// The name of each step from a scan to what is seen with it, and its picture. The x axis of the map points to the right.
pub fn stages(view: &PlaceView, map: &LocalMap, scan: &Scan) -> [(&'static str, RgbImage); 4] {
    let grid = &map.clearances.grid;
    let background = [DARK, DIM, WALL];
    let mut canvases =
        [[DARK; 3], [DARK, FREE, WHITE], background, background].map(|it| drawn(grid, it));
    let [scanned, _, ways, places] = &mut canvases;
    let map_from_robot = from_robot(&view.robot);
    let hits: Vec<Point2<f64>> = scan.hits().map(|hit| map_from_robot * hit).collect();
    let scanner = map_from_robot * scan.scanner();
    for &hit in &hits {
        scanned.line(scanner, hit, REACH);
    }
    for &hit in &hits {
        scanned.dot(hit, 1, WHITE);
    }
    if let Some(skeleton) = &map.skeleton {
        for at in (0..skeleton.cells.len()).filter(|&at| skeleton.cells[at]) {
            ways.dot(grid.point(at), 1, CYAN);
        }
        for end in &skeleton.ends {
            let colour = if end.kind == WayEnd::Closed { RED } else { ORANGE };
            ways.ring(grid.point(end.cell), 6, colour);
        }
    }
    for two in map.graph.ways.iter().flat_map(|way| way.line.windows(2)) {
        places.line(two[0].0, two[1].0, CYAN);
    }
    for place @ SeenPlace { centre, clearance, .. } in &view.places {
        for arm in place.directions() {
            let [near, far] =
                [*clearance, clearance + DOOR].map(|range| centre + range * unit(arm));
            places.thick(near, far, GREEN);
        }
        places.dot(*centre, 5, WHITE);
    }
    let robot = Point2::from(view.robot.position);
    let radius = (ROBOT / grid.cell * ZOOM as f64) as i32;
    let mut stages = STAGES.into_iter();
    canvases.map(|mut canvas| {
        canvas.dot(robot, radius, BODY);
        canvas.ring(robot, radius, WHITE);
        canvas.line(robot, robot + 2.0 * ROBOT * unit(view.robot.heading), WHITE);
        (stages.next().unwrap_or_default(), canvas.picture)
    })
}
