//! The walls of a floor plan: the border of the union of its floors. Section 2.4.

use toposlam_model::floor_plan::{FloorPlan, Rectangle};

/// Coordinates that differ by no more are the same, in metres.
const TOLERANCE: f64 = 1e-6;

/// A straight wall along an axis, with floor on one side of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// Along which axis it runs: 0 for x, 1 for y.
    pub along: usize,
    /// Where it stands on the other axis, in metres.
    pub plane: f64,
    /// On which side of it the floor is: 1 to greater coordinates, -1 to lesser ones.
    pub floor_side: f64,
    /// Where it begins and ends along its axis, in metres.
    pub span: [f64; 2],
    /// At either end, whether the floor goes round it: the wall juts out there.
    pub juts: [bool; 2],
}

impl Wall {
    /// How long it is, in metres.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.span[1] - self.span[0]
    }

    /// The point of its foot that is so far along its axis.
    #[must_use]
    pub fn foot(&self, along: f64) -> [f64; 2] {
        if self.along == 0 { [along, self.plane] } else { [self.plane, along] }
    }
}

/// The walls around a union of rectangles, those along x first, in order of plane and beginning.
#[must_use]
pub fn walls(plan: &FloorPlan) -> Vec<Wall> {
    let floors: Vec<Rectangle> = plan.floor().collect();
    let mut walls: Vec<Wall> = (0..2).flat_map(|along| walls_along(&floors, along)).collect();
    for wall in &mut walls {
        wall.juts = [0, 1].map(|end| juts(wall, end, &floors));
    }
    walls
}

/// The walls along one axis. On every line on which a rectangle ends, each stretch between two
/// rectangles' corners has floor on both sides, on neither, or on one: then it is wall.
fn walls_along(floors: &[Rectangle], along: usize) -> Vec<Wall> {
    let across = 1 - along;
    let ends = |axis: usize, floor: &Rectangle| [floor.least[axis], floor.greatest[axis]];
    let planes = distinct(floors.iter().flat_map(|floor| ends(across, floor)).collect());
    let mut walls: Vec<Wall> = Vec::new();
    for plane in planes {
        let touching: Vec<&Rectangle> = floors
            .iter()
            .filter(|floor| {
                let [least, greatest] = ends(across, floor);
                least - TOLERANCE <= plane && plane <= greatest + TOLERANCE
            })
            .collect();
        let cuts = distinct(touching.iter().flat_map(|floor| ends(along, floor)).collect());
        for cut in cuts.windows(2) {
            let middle = f64::midpoint(cut[0], cut[1]);
            let floor_at = |across_at: f64| {
                touching.iter().any(|floor| {
                    let ([from, to], [least, greatest]) = (ends(along, floor), ends(across, floor));
                    from <= middle && middle <= to && least <= across_at && across_at <= greatest
                })
            };
            let sides = [-1.0, 1.0].map(|side: f64| floor_at(plane + side * 2.0 * TOLERANCE));
            let floor_side = match sides {
                [false, true] => 1.0,
                [true, false] => -1.0,
                _ => continue,
            };
            match walls.last_mut() {
                Some(wall)
                    if wall.plane.total_cmp(&plane).is_eq()
                        && wall.floor_side.total_cmp(&floor_side).is_eq()
                        && (wall.span[1] - cut[0]).abs() <= TOLERANCE =>
                {
                    wall.span[1] = cut[1];
                }
                _ => walls.push(Wall {
                    along,
                    plane,
                    floor_side,
                    span: [cut[0], cut[1]],
                    juts: [false; 2],
                }),
            }
        }
    }
    walls
}

/// Whether there is floor just beyond an end of a wall and just behind its plane.
fn juts(wall: &Wall, end: usize, floors: &[Rectangle]) -> bool {
    let outwards = if end == 0 { -1.0 } else { 1.0 };
    let mut beyond = wall.foot(wall.span[end] + outwards * 2.0 * TOLERANCE);
    beyond[1 - wall.along] -= wall.floor_side * 2.0 * TOLERANCE;
    floors.iter().any(|floor| floor.holds(beyond))
}

/// Sorted, each once.
fn distinct(mut coordinates: Vec<f64>) -> Vec<f64> {
    coordinates.sort_by(f64::total_cmp);
    coordinates.dedup_by(|one, other| (*one - *other).abs() <= TOLERANCE);
    coordinates
}
