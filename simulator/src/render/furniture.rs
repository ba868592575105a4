//! Cabinets, tables and chairs along the walls of a building, made of blocks.

use std::f64::consts::TAU;

use rand::{Rng, RngExt, seq::IndexedRandom};
use toposlam_model::{driving::scene::wrapped, floor_plan::BuildingWall};

use crate::render::{
    random_stream::{StreamPurpose, about, stream},
    rig::WorldRay,
    sight_lines::TURN_ERROR,
};

/// The room between two pieces of furniture, and beside the ends of a wall, in metres.
const APART: f64 = 0.15;

/// The greatest depth of furniture, as a share of the hallway's width.
const DEEPEST: f64 = 0.3;

/// Furniture that is nearer to the robot's centre is not there: it would be in the robot's way. In metres.
const CLEAR: f64 = 0.35;

/// Furniture that is farther away is too small to be seen, in metres.
const FAR: f64 = 15.0;

/// Reflectances: mostly dark wood, metal and cloth.
const COLOURS: [[f32; 3]; 7] = [
    [0.030, 0.028, 0.026],
    [0.055, 0.034, 0.022],
    [0.120, 0.072, 0.042],
    [0.070, 0.072, 0.078],
    [0.026, 0.040, 0.085],
    [0.075, 0.026, 0.024],
    [0.420, 0.400, 0.350],
];

/// The light on each face of a block, as a share of that on the floor beside it: its sides along x, along
/// y, its bottom and its top.
const SHADES: [f32; 6] = [0.55, 0.55, 0.70, 0.70, 0.15, 1.0];

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Block {
    least: [f32; 3],
    greatest: [f32; 3],
    colour: [f32; 3],
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct MetBlock {
    /// The length of the ray.
    pub(crate) length: f32,
    /// A number that is different for different faces of all blocks.
    pub(crate) face: u32,
    /// Its reflectance, darker on some faces.
    pub(crate) colour: [f32; 3],
    pub(crate) place: [f32; 2],
}

/// The blocks of the furniture along these walls; `per_wall` pieces per 10 m, in hallways of this width.
pub(crate) fn furniture(
    walls: &[BuildingWall],
    per_wall: f64,
    width: f64,
    seed: u64,
) -> Vec<Block> {
    let mut blocks = Vec::new();
    for (number, wall) in walls.iter().enumerate() {
        let mut rng = stream(seed, StreamPurpose::Blocks, number);
        let mut taken: Vec<[f64; 2]> = Vec::new();
        for _ in 0..about(per_wall * wall.length() / 10.0, &mut rng) {
            let piece = Piece::drawn(&mut rng, DEEPEST * width);
            let room = wall.length() - piece.length - 2.0 * APART;
            let from = wall.span[0] + APART + rng.random::<f64>() * room.max(0.0);
            let span = [from, from + piece.length];
            let is_free =
                |other: &[f64; 2]| span[1] + APART < other[0] || other[1] + APART < span[0];
            if room >= 0.0 && taken.iter().all(is_free) {
                taken.push(span);
                blocks.extend(piece.blocks(wall, from));
            }
        }
    }
    blocks
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    Cabinet,
    Table,
    Chair,
}

/// A piece of furniture: its size along the wall, away from it and up, in metres.
struct Piece {
    kind: Kind,
    length: f64,
    depth: f64,
    height: f64,
    colour: [f32; 3],
}

impl Piece {
    fn drawn(rng: &mut impl Rng, deepest: f64) -> Self {
        let kinds = [Kind::Cabinet, Kind::Cabinet, Kind::Table, Kind::Chair, Kind::Chair];
        let kind = kinds.choose(rng).copied().unwrap_or(Kind::Chair);
        let (lengths, depths, heights) = match kind {
            Kind::Cabinet => (0.5..=1.2, 0.25..=0.45, 0.6..=1.9),
            Kind::Table => (0.7..=1.3, 0.35..=0.50, 0.68..=0.76),
            Kind::Chair => (0.40..=0.48, 0.40..=0.46, 0.80..=0.95),
        };
        let [length, depth, height] =
            [lengths, depths, heights].map(|range| rng.random_range(range));
        let colour = COLOURS.choose(rng).copied().unwrap_or_default();
        Self { kind, length, depth: depth.min(deepest), height, colour }
    }

    /// Its blocks at a place along a wall.
    fn blocks(&self, wall: &BuildingWall, from: f64) -> Vec<Block> {
        let [length, depth, height] = [self.length, self.depth, self.height];
        let block = |along: [f64; 2], out: [f64; 2], up: [f64; 2]| {
            let mut corners = [[0.0; 3]; 2];
            for (end, corner) in corners.iter_mut().enumerate() {
                corner[wall.along] = (from + along[end]) as f32;
                let out = if wall.floor_side > 0.0 { out[end] } else { out[1 - end] };
                corner[1 - wall.along] = (wall.plane + wall.floor_side * out) as f32;
                corner[2] = up[end] as f32;
            }
            Block { least: corners[0], greatest: corners[1], colour: self.colour }
        };
        let legs = |thick: f64, top: f64| -> Vec<Block> {
            let alongs = [0.0, length - thick].into_iter();
            let places = alongs.flat_map(|along| [0.0, depth - thick].map(|out| (along, out)));
            let leg = |(along, out)| block([along, along + thick], [out, out + thick], [0.0, top]);
            places.map(leg).collect()
        };
        match self.kind {
            Kind::Cabinet => vec![block([0.0, length], [0.0, depth], [0.0, height])],
            Kind::Table => {
                let top = block([0.0, length], [0.0, depth], [height - 0.04, height]);
                [legs(0.05, height - 0.04), vec![top]].concat()
            }
            Kind::Chair => {
                let seat = block([0.0, length], [0.0, depth], [0.42, 0.47]);
                let back = block([0.0, length], [0.0, 0.04], [0.47, height]);
                [legs(0.035, 0.42), vec![seat, back]].concat()
            }
        }
    }
}

impl Block {
    /// The length of a ray up to the block, and the number of the face that it meets.
    #[inline]
    fn met(&self, ray: &WorldRay) -> Option<(f32, u32)> {
        let (mut enters, mut leaves, mut face) = (0.0_f32, f32::INFINITY, 0);
        for axis in 0..3 {
            let per_length = 1.0 / ray.direction[axis];
            let [least, greatest] = [self.least[axis], self.greatest[axis]]
                .map(|plane| (plane - ray.origin[axis]) * per_length);
            let (near, far) = (least.min(greatest), least.max(greatest));
            if near > enters {
                enters = near;
                face = 2 * axis as u32 + u32::from(greatest < least);
            }
            leaves = leaves.min(far);
        }
        (enters > 0.0 && enters <= leaves).then_some((enters, face))
    }

    fn corners(&self) -> [[f64; 2]; 4] {
        let [[x, y, _], [right, top, _]] =
            [self.least, self.greatest].map(|corner| corner.map(f64::from));
        [[x, y], [right, y], [right, top], [x, top]]
    }

    /// The least distance from a place, seen from above.
    fn distance(&self, place: [f64; 2]) -> f64 {
        let off = |axis: usize| {
            let (least, greatest) = (self.least[axis].into(), self.greatest[axis].into());
            place[axis] - place[axis].clamp(least, greatest)
        };
        off(0).hypot(off(1))
    }
}

/// The number of sectors of a full turn.
const SECTORS: u16 = 256;
const PER_SECTOR: usize = 65_536 / SECTORS as usize;

/// The blocks around a place, by direction.
#[derive(Clone, Debug)]
pub(crate) struct BlocksAround<'a> {
    blocks: &'a [Block],
    /// For each sector, counter-clockwise from east, the numbers of the blocks that a ray may meet.
    sectors: Vec<Vec<u32>>,
}

impl<'a> BlocksAround<'a> {
    /// The blocks around a place, for rays that pass it within this distance.
    pub(crate) fn new(place: [f64; 2], off_axis: f64, blocks: &'a [Block]) -> Self {
        let mut sectors = Vec::new();
        for (number, block) in blocks.iter().enumerate() {
            let near = block.distance(place);
            if !(CLEAR..FAR).contains(&near) {
                continue;
            }
            sectors.resize(SECTORS.into(), Vec::new());
            let angles = block.corners().map(|[x, y]| (y - place[1]).atan2(x - place[0]));
            let off = angles.map(|angle| wrapped(angle - angles[0]));
            let rounded = TURN_ERROR as f64 / 65_536.0 * TAU;
            let slack = (off_axis / near).min(1.0).asin() + rounded;
            let sector = |angle: f64| (angle / TAU * f64::from(SECTORS)).floor() as i64;
            let first = sector(angles[0] + off.into_iter().fold(0.0, f64::min) - slack);
            let last = sector(angles[0] + off.into_iter().fold(0.0, f64::max) + slack);
            for sector in first..=last.min(first + i64::from(SECTORS) - 1) {
                sectors[sector.rem_euclid(SECTORS.into()) as usize].push(number as u32);
            }
        }
        Self { blocks, sectors }
    }

    #[inline]
    pub(crate) fn first(&self, ray: &WorldRay) -> Option<MetBlock> {
        let mut nearest: Option<(f32, u32, u32)> = None;
        for &number in self.sectors.get(usize::from(ray.turn) / PER_SECTOR)? {
            if let Some((length, face)) = self.blocks[number as usize].met(ray)
                && nearest.is_none_or(|(other, ..)| length < other)
            {
                nearest = Some((length, number, face));
            }
        }
        let (length, number, face) = nearest?;
        let shade = SHADES[face as usize];
        Some(MetBlock {
            length,
            face: 6 * number + face,
            colour: self.blocks[number as usize].colour.map(|channel| channel * shade),
            place: ray.place(length),
        })
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;
    use toposlam_model::floor_plan::walls;

    use super::*;
    use crate::plan_named;

    fn blocks() -> (Vec<BuildingWall>, Vec<Block>) {
        let walls = walls(&plan_named("shape-8").unwrap());
        let blocks = furniture(&walls, 6.0, 1.6, 3);
        (walls, blocks)
    }

    #[test]
    fn furniture_stands_on_the_floor_along_the_walls_and_leaves_the_middle_free() {
        let (walls, blocks) = blocks();
        assert!(blocks.len() > 30, "{}", blocks.len());
        for block in &blocks {
            let on_wall = walls.iter().any(|wall| {
                let [along, across] = [wall.along, 1 - wall.along];
                let out = [block.least, block.greatest]
                    .map(|corner| (f64::from(corner[across]) - wall.plane) * wall.floor_side);
                let within = f64::from(block.least[along]) >= wall.span[0]
                    && f64::from(block.greatest[along]) <= wall.span[1];
                within && out.into_iter().all(|out| (-1e-5..=0.481).contains(&out))
            });
            assert!(on_wall, "{block:?}");
            assert!((0..3).all(|axis| block.least[axis] < block.greatest[axis]), "{block:?}");
        }
        // A table and a chair stand on four legs.
        assert!(blocks.iter().filter(|block| block.least[2] == 0.0).count() > 20);
        assert_eq!(blocks, self::blocks().1);
        assert!(furniture(&walls, 0.0, 1.6, 3).is_empty());
    }

    #[test]
    fn the_sectors_have_the_first_block_of_every_ray() {
        let (_, blocks) = blocks();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
        let mut met = 0;
        for _ in 0..200 {
            let place = [rng.random_range(-0.3..=0.3), rng.random_range(0.0..=8.0)];
            let around = BlocksAround::new(place, 0.05, &blocks);
            for _ in 0..100 {
                let turn: u16 = rng.random();
                let angle = (f64::from(turn) + 0.5) / 65_536.0 * TAU;
                let aside = rng.random_range(-0.05..=0.05);
                let [x, y] = [place[0] - aside * angle.sin(), place[1] + aside * angle.cos()];
                let down: f64 = rng.random_range(-1.0..=0.8);
                let ray = WorldRay {
                    origin: [x as f32, y as f32, 1.0],
                    direction: [angle.cos() as f32, angle.sin() as f32, down as f32],
                    turn,
                };
                let there = blocks.iter().filter(|block| block.distance(place) >= CLEAR);
                let expected = there.filter_map(|block| block.met(&ray)).map(|(length, _)| length);
                let expected = expected.fold(f32::INFINITY, f32::min);
                let found = around.first(&ray).map_or(f32::INFINITY, |block| block.length);
                assert_eq!(found, expected);
                met += usize::from(found.is_finite());
            }
        }
        assert!(met > 1000, "{met}");
    }

    #[test]
    fn a_ray_meets_the_nearest_face_of_a_block() {
        let block = Block { least: [1.0, -0.5, 0.0], greatest: [2.0, 0.5, 0.8], colour: [0.1; 3] };
        let ray = |direction| WorldRay { origin: [0.0, 0.0, 1.0], direction, turn: 0 };
        // Down to the front, down to the top, above it, away from it.
        assert_eq!(block.met(&ray([1.0, 0.0, -0.5])), Some((1.0, 0)));
        let (length, face) = block.met(&ray([1.0, 0.0, -0.15])).unwrap();
        assert!((length - 0.2 / 0.15).abs() < 1e-5);
        assert_eq!(face, 5);
        assert_eq!(block.met(&ray([1.0, 0.0, 0.1])), None);
        assert_eq!(block.met(&ray([-1.0, 0.0, -0.5])), None);
    }
}
