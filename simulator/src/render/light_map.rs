//! The light on the floor and on each wall, at the nodes of meshes.

use toposlam_model::floor_plan::{BuildingWall, Rectangle};

use crate::render::{
    lights::{CEILING, Lights},
    squares::{extent, side},
};

/// Distance of the mesh's nodes, in metres.
const MESH: f64 = 0.2;

/// The number of nodes of a wall's mesh from floor to ceiling.
const ROWS: usize = 7;

/// The light in a building; 1 is the mean light on the floor.
#[derive(Clone, Debug)]
pub(crate) struct LightMap {
    /// Nothing if the light is the same everywhere.
    floor: Option<Mesh>,
    walls: Vec<Mesh>,
}

#[derive(Clone, Debug)]
struct Mesh {
    least: [f32; 2],
    per_metre: [f32; 2],
    columns: usize,
    rows: usize,
    light: Vec<f32>,
}

impl Mesh {
    /// Interpolates between the four nodes around a place.
    #[inline]
    fn at(&self, place: [f32; 2]) -> f32 {
        let [x, y] = [0, 1].map(|axis| (place[axis] - self.least[axis]) * self.per_metre[axis]);
        let x = x.clamp(0.0, (self.columns - 1) as f32 - 0.001);
        let y = y.clamp(0.0, (self.rows - 1) as f32 - 0.001);
        let (column, row) = (x as i32 as usize, y as i32 as usize);
        let (right, up) = (x - column as f32, y - row as f32);
        let corner = row * self.columns + column;
        let [low, high] = [corner, corner + self.columns].map(|corner| {
            let ends = &self.light[corner..corner + 2];
            ends[0] + (ends[1] - ends[0]) * right
        });
        low + (high - low) * up
    }
}

impl LightMap {
    pub(crate) fn new(floors: &[Rectangle], walls: &[BuildingWall], lights: &Lights) -> Self {
        if lights.even() {
            return Self { floor: None, walls: Vec::new() };
        }
        let (least, size) = extent(floors);
        let side = side(MESH, size);
        let [columns, rows] = size.map(|length| (length / side) as usize + 2);
        // Nodes far from any floor stay undefined; they are never read.
        let mut lamplight = vec![f64::NAN; columns * rows];
        let mut grounds = Vec::new();
        for floor in floors {
            let corners = |axis: usize, count: usize| {
                let first = ((floor.least[axis] - least[axis]) / side).floor() as usize;
                let last = ((floor.greatest[axis] - least[axis]) / side).ceil() as usize;
                first..=last.min(count - 1)
            };
            for row in corners(1, rows) {
                for column in corners(0, columns) {
                    let corner = row * columns + column;
                    if !lamplight[corner].is_nan() {
                        continue;
                    }
                    let place = [least[0] + column as f64 * side, least[1] + row as f64 * side];
                    // A node behind the wall gets the light in front of it.
                    let inset = 0.01;
                    let ground = [0, 1].map(|axis| {
                        let least = floor.least[axis] + inset;
                        place[axis].clamp(least, (floor.greatest[axis] - inset).max(least))
                    });
                    lamplight[corner] =
                        lights.lamplight([ground[0], ground[1], 0.0], [0.0, 0.0, 1.0]);
                    grounds.push((corner, ground));
                }
            }
        }
        let sum: f64 = grounds.iter().map(|&(corner, _)| lamplight[corner]).sum();
        let average = sum / grounds.len() as f64;
        let mut light = vec![0.0; columns * rows];
        for &(corner, ground) in &grounds {
            light[corner] = lights.light(ground, lamplight[corner], average);
        }
        let floor = Mesh {
            least: least.map(|at| at as f32),
            per_metre: [(1.0 / side) as f32; 2],
            columns,
            rows,
            light,
        };
        let walls = walls.iter().map(|wall| wall_mesh(wall, lights, average)).collect();
        Self { floor: Some(floor), walls }
    }

    #[inline]
    pub(crate) fn on_floor(&self, place: [f32; 2]) -> f32 {
        self.floor.as_ref().map_or(1.0, |floor| floor.at(place))
    }

    #[inline]
    pub(crate) fn on_wall(&self, wall: usize, along: f32, height: f32) -> f32 {
        self.walls.get(wall).map_or(1.0, |wall| wall.at([along, height]))
    }
}

fn wall_mesh(wall: &BuildingWall, lights: &Lights, average: f64) -> Mesh {
    let columns = (wall.length() / (2.0 * MESH)).ceil().clamp(1.0, 4096.0) as usize + 1;
    let width = wall.length() / (columns - 1) as f64;
    let height = CEILING / (ROWS - 1) as f64;
    let mut normal = [0.0; 3];
    normal[1 - wall.along] = wall.floor_side;
    let mut light = Vec::with_capacity(columns * ROWS);
    for row in 0..ROWS {
        for column in 0..columns {
            let inset = 0.01_f64.min(wall.length() / 2.0);
            let along = column as f64 * width;
            let along = wall.span[0] + along.max(inset).min(wall.length() - inset);
            let mut ground = wall.foot(along);
            ground[1 - wall.along] += wall.floor_side * inset;
            let up = (row as f64 * height).min(CEILING - 0.2);
            let lamplight = lights.lamplight([ground[0], ground[1], up], normal);
            light.push(lights.light(ground, lamplight, average));
        }
    }
    Mesh {
        least: [wall.span[0] as f32, 0.0],
        per_metre: [(1.0 / width) as f32, (1.0 / height) as f32],
        columns,
        rows: ROWS,
        light,
    }
}
