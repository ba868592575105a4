//! The lights of a building: lamps along the hallways, hot spots and shadows.

use rand::RngExt;
use toposlam_model::floor_plan::{BuildingWall, FloorPlan, Rectangle};

use crate::render::{
    effects::Effects,
    random_stream::{StreamPurpose, about, stream},
    squares::Squares,
};

/// Height of the ceiling, in metres.
pub(crate) const CEILING: f64 = 2.5;

/// Brightness of a lamp that is seen directly; a white surface in mean light has 1.
const LAMP_BRIGHTNESS: f64 = 6.0;

/// Range of a lamp's light, in metres.
const REACH: f64 = 6.0;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Lamp {
    pub(crate) middle: [f32; 2],
    /// Half its length along x and along y.
    pub(crate) half: [f32; 2],
    pub(crate) brightness: f32,
}

struct Spot {
    middle: [f64; 2],
    /// Half its extent along x and along y.
    half: [f64; 2],
    /// Relative change of the light in its middle.
    change: f64,
}

/// The spot ends at this multiple of its half extent.
const FADED: f64 = 2.5;

pub(crate) struct Lights {
    pub(crate) lamps: Vec<Lamp>,
    /// The lamps whose light reaches a place, each with the walls that its light may meet.
    reaching: Squares<(Lamp, Vec<BuildingWall>)>,
    spots: Squares<Spot>,
    falloff: f64,
}

/// The middle line of a hallway: its beginning, length and axis.
fn middle_line(floor: &Rectangle, width: f64) -> ([f64; 2], f64, usize) {
    let size = [0, 1].map(|axis| floor.greatest[axis] - floor.least[axis]);
    let along = usize::from(size[1] > size[0]);
    (floor.least.map(|least| least + width / 2.0), size[along] - width, along)
}

impl Lights {
    pub(crate) fn new(
        plan: &FloorPlan,
        walls: &[BuildingWall],
        effects: &Effects,
        seed: u64,
    ) -> Self {
        let width = plan.hallway_width();
        let mut lamps = Vec::new();
        let mut spots = Vec::new();
        for (number, floor) in plan.floor().enumerate() {
            let (start, length, along) = middle_line(&floor, width);
            let count = (length / 2.4).round().clamp(1.0, 1e4);
            let mut rng = stream(seed, StreamPurpose::Lamps, number);
            for lamp in 0..count as usize {
                let mut middle = start;
                middle[along] += length * (lamp as f64 + 0.5) / count;
                let share = 1.0 + effects.lamp_spread * rng.random_range(-1.0..=1.0);
                let burns = rng.random::<f64>() >= effects.lamps_out;
                let mut half = [0.15; 2];
                half[along] = 0.6;
                lamps.push(Lamp {
                    middle: middle.map(|coordinate| coordinate as f32),
                    half: half.map(|length| length as f32),
                    brightness: if burns { (LAMP_BRIGHTNESS * share) as f32 } else { 0.35 },
                });
            }
            let strewn = [
                (StreamPurpose::Spots, effects.hot_spots, 0.2..=0.6, 1.0),
                (StreamPurpose::Shadows, -effects.shadows, 0.3..=1.2, 3.0),
            ];
            for (purpose, change, sizes, apart) in strewn {
                let mut rng = stream(seed, purpose, number);
                for _ in 0..about(length / apart, &mut rng) {
                    let mut middle = start;
                    middle[along] += length * rng.random::<f64>();
                    middle[1 - along] += width * rng.random_range(-0.5..=0.5);
                    let half = [(); 2].map(|()| rng.random_range(sizes.clone()));
                    let change = change * rng.random_range(0.4..=1.0);
                    spots.push(Spot { middle, half, change });
                }
            }
        }
        spots.retain(|spot| spot.change != 0.0);
        let reach = |lamp: &Lamp| lamp.rectangle().widened(REACH);
        let with_walls = |&lamp: &Lamp| {
            let near = |wall: &&BuildingWall| {
                let [least, greatest] = wall.span.map(|at| wall.foot(at));
                reach(&lamp).meets(&Rectangle { least, greatest })
            };
            (lamp, walls.iter().filter(near).copied().collect())
        };
        let reaching = lamps.iter().map(with_walls).collect();
        let faded =
            |spot: &Spot| Rectangle::centred(spot.middle, spot.half.map(|half| FADED * half));
        let floors: Vec<_> = plan.floor().collect();
        Self {
            lamps,
            reaching: Squares::new(&floors, 1.0, reaching, |(lamp, _)| reach(lamp)),
            spots: Squares::new(&floors, 1.0, spots, faded),
            falloff: effects.lamp_falloff,
        }
    }

    pub(crate) fn even(&self) -> bool {
        self.falloff == 0.0 && self.spots.things().is_empty()
    }

    /// The light of the lamps on a surface at this place, up to a factor.
    pub(crate) fn lamplight(&self, place: [f64; 3], normal: [f64; 3]) -> f64 {
        let mut sum = 0.0;
        for (lamp, walls) in self.reaching.at([place[0] as f32, place[1] as f32]) {
            let middle = lamp.middle.map(f64::from);
            let [x, y] = [middle[0] - place[0], middle[1] - place[1]];
            let height = CEILING - place[2];
            let square = x * x + y * y + height * height;
            let facing = x * normal[0] + y * normal[1] + height * normal[2];
            if facing <= 0.0 || x * x + y * y > REACH * REACH {
                continue;
            }
            let size = f64::from(lamp.half[0].max(lamp.half[1]));
            // A lamp has an extent, which limits how near it can be.
            let square = square + size * size / 3.0;
            let ground = [place[0], place[1]];
            if walls.iter().all(|wall| !wall.is_between(ground, middle)) {
                sum += f64::from(lamp.brightness) * facing * height / (square * square);
            }
        }
        sum
    }

    /// The light at a place, given its lamplight and the floor's average lamplight.
    pub(crate) fn light(&self, ground: [f64; 2], lamplight: f64, average: f64) -> f32 {
        let lamps = if average > 0.0 { lamplight / average } else { 0.0 };
        let mut light = 1.0 - self.falloff + self.falloff * lamps;
        for spot in self.spots.at(ground.map(|at| at as f32)) {
            let [x, y] = [0, 1].map(|axis| (ground[axis] - spot.middle[axis]) / spot.half[axis]);
            let square = x * x + y * y;
            if square < FADED * FADED {
                light *= 1.0 + spot.change * (-square * square / 2.0).exp();
            }
        }
        light as f32
    }
}

impl Lamp {
    pub(crate) fn rectangle(&self) -> Rectangle {
        let edge =
            |side: f32| [0, 1].map(|axis| f64::from(self.middle[axis] + side * self.half[axis]));
        Rectangle { least: edge(-1.0), greatest: edge(1.0) }
    }
}
