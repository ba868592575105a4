//! Pictures of the steps of sensing with a laser scanner: the scan, the local map, the middle lines of its
//! ways, and the junctions.

use image::{Rgb, RgbImage};
use nalgebra::Point2;

use super::{ends::WayEnd, grid::Grid, scan::Scan, sensor::LocalMap};
use crate::{
    annotate::{BODY, CYAN, DARK, GREEN, LegendSign, ORANGE, REACH, RED, StageLegend, WHITE},
    draw,
    geometry::{from_robot, unit},
    place::{PlaceView, SeenPlace},
};

/// The names of the steps, in their order.
pub const STAGES: [&str; 4] = ["1-scan", "2-map", "3-ways", "4-junctions"];

/// The pixels of a side of a cell.
const ZOOM: usize = 4;
/// Free space of the local map.
const FREE: Rgb<u8> = Rgb([62, 74, 92]);
/// Free space behind what else is drawn.
const DIM: Rgb<u8> = Rgb([44, 50, 60]);
/// Walls behind what else is drawn.
const WALL: Rgb<u8> = Rgb([150, 150, 150]);
/// How far the lines of the doors of a junction reach beyond its walls, in metres.
const DOOR: f64 = 1.5;
/// The radius of the robot, in metres.
const ROBOT: f64 = 0.25;

/// The name of each step from a scan to what is seen with it, and its picture. The x axis of the map points to the right.
pub fn stages(view: &PlaceView, map: &LocalMap, scan: &Scan) -> [(&'static str, RgbImage); 4] {
    let background = [DARK, DIM, WALL];
    let canvases = [
        rays(Canvas::new(&map.grid, [DARK; 3]), view, scan),
        Canvas::new(&map.grid, [DARK, FREE, WHITE]),
        ways(Canvas::new(&map.grid, background), map),
        junctions(Canvas::new(&map.grid, background), view, map),
    ];
    let mut pictures = canvases.map(|canvas| canvas.with_robot(view)).into_iter();
    STAGES.map(|stage| (stage, pictures.next().unwrap_or_default()))
}

/// The legend of the picture of a step, by the step's name; empty for any other name.
pub fn legend(stage: &str, cell: f64) -> StageLegend {
    use LegendSign::{Areas, Dot, Line, Ring, Robot, Thick};
    let walls = (Areas(vec![WALL]), "wall or obstacle");
    let entries = match stage {
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
    let mut entries: Vec<_> =
        entries.into_iter().map(|(sign, text)| (sign, text.to_owned())).collect();
    if entries.is_empty() {
        return StageLegend { entries, metre: None };
    }
    entries.push((Robot { body: BODY, outline: WHITE }, "robot".to_owned()));
    StageLegend { entries, metre: Some(ZOOM as f64 / cell) }
}

struct Canvas<'g> {
    picture: RgbImage,
    grid: &'g Grid,
}

impl<'g> Canvas<'g> {
    /// Each cell in the colour of its kind: unknown, free or occupied.
    fn new(grid: &'g Grid, colours: [Rgb<u8>; 3]) -> Self {
        let [width, height] = [grid.columns, grid.rows()].map(|count| (count * ZOOM) as u32);
        let picture = RgbImage::from_fn(width, height, |u, v| {
            let [column, row] = [u, height - 1 - v].map(|at| at as usize / ZOOM);
            colours[grid.cells[row * grid.columns + column] as usize]
        });
        Self { picture, grid }
    }

    fn at(&self, point: Point2<f64>) -> [f32; 2] {
        let pixel = |axis: usize| {
            ((point[axis] - self.grid.origin[axis]) / self.grid.cell * ZOOM as f64) as f32
        };
        [pixel(0), self.picture.height() as f32 - pixel(1)]
    }

    fn pixel(&self, point: Point2<f64>) -> [i32; 2] {
        self.at(point).map(|at| at as i32)
    }

    fn line(&mut self, from: Point2<f64>, to: Point2<f64>, colour: Rgb<u8>) {
        let (from, to) = (self.at(from), self.at(to));
        draw::line(&mut self.picture, from, to, colour);
    }

    fn ring(&mut self, point: Point2<f64>, radius: i32, colour: Rgb<u8>) {
        let at = self.pixel(point);
        for radius in [radius, radius - 1] {
            draw::ring(&mut self.picture, at, radius, colour);
        }
    }

    fn dot(&mut self, point: Point2<f64>, radius: i32, colour: Rgb<u8>) {
        let at = self.pixel(point);
        draw::disc(&mut self.picture, at, radius, colour);
    }

    fn with_robot(mut self, view: &PlaceView) -> RgbImage {
        let radius = (ROBOT / self.grid.cell * ZOOM as f64) as i32;
        let robot = Point2::from(view.robot.position);
        self.dot(robot, radius, BODY);
        self.ring(robot, radius, WHITE);
        self.line(robot, robot + 2.0 * ROBOT * unit(view.robot.heading), WHITE);
        self.picture
    }
}

fn rays<'g>(mut canvas: Canvas<'g>, view: &PlaceView, scan: &Scan) -> Canvas<'g> {
    let map_from_robot = from_robot(&view.robot);
    let hits: Vec<Point2<f64>> = scan.hits().map(|hit| map_from_robot * hit).collect();
    let scanner = map_from_robot * scan.scanner();
    for &hit in &hits {
        canvas.line(scanner, hit, REACH);
    }
    for &hit in &hits {
        canvas.dot(hit, 1, WHITE);
    }
    canvas
}

fn ways<'g>(mut canvas: Canvas<'g>, map: &LocalMap) -> Canvas<'g> {
    let Some(skeleton) = &map.skeleton else { return canvas };
    for at in (0..skeleton.cells.len()).filter(|&at| skeleton.cells[at]) {
        canvas.dot(map.grid.point(at), 1, CYAN);
    }
    for end in &skeleton.ends {
        let colour = if end.kind == WayEnd::Closed { RED } else { ORANGE };
        canvas.ring(map.grid.point(end.cell), 6, colour);
    }
    canvas
}

fn junctions<'g>(mut canvas: Canvas<'g>, view: &PlaceView, map: &LocalMap) -> Canvas<'g> {
    for two in map.graph.ways.iter().flat_map(|way| way.line.windows(2)) {
        canvas.line(two[0].0, two[1].0, CYAN);
    }
    for place @ SeenPlace { centre, clearance, .. } in &view.places {
        for arm in place.directions() {
            let [near, far] =
                [*clearance, clearance + DOOR].map(|range| canvas.at(centre + range * unit(arm)));
            for [right, down] in [[0.0, 0.0], [1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]] {
                let pen = |[u, v]: [f32; 2]| [u + right, v + down];
                draw::line(&mut canvas.picture, pen(near), pen(far), GREEN);
            }
        }
        canvas.dot(*centre, 5, WHITE);
    }
    canvas
}
