//! The walls that are visible from a place in each direction.

use std::f64::consts::TAU;

use toposlam_model::{driving::scene::wrapped, floor_plan::BuildingWall};

/// The number of sectors of a full turn.
const SECTORS: u16 = 512;
const PER_SECTOR: u16 = (65_536 / SECTORS as u32) as u16;

/// The greatest error of a ray's direction, in 1/65,536 of a turn.
pub(crate) const TURN_ERROR: i64 = 64;

/// For each sector, counter-clockwise from east, the walls that a ray may meet first, nearest
/// first.
#[derive(Clone, Debug)]
pub(crate) struct SightLines(Vec<Vec<u32>>);

struct Seen {
    wall: u32,
    near: f64,
    far: f64,
    covers: bool,
}

impl SightLines {
    /// The walls around a place, for rays that pass it within this distance.
    pub(crate) fn from(place: [f64; 2], off_axis: f64, walls: &[BuildingWall]) -> Self {
        let mut sectors: Vec<Vec<Seen>> = (0..SECTORS).map(|_| Vec::new()).collect();
        for (number, wall) in walls.iter().enumerate() {
            let out = (place[1 - wall.along] - wall.plane) * wall.floor_side;
            // The back of a wall is hidden behind other walls.
            if out > -off_axis {
                enter(number, wall, place, off_axis, &mut sectors);
            }
        }
        let visible = sectors.into_iter().map(|mut seen| {
            let hidden = seen.iter().filter(|wall| wall.covers).map(|wall| wall.far);
            let hidden = hidden.fold(f64::INFINITY, f64::min);
            seen.retain(|wall| wall.near <= hidden);
            seen.sort_by(|one, other| one.near.total_cmp(&other.near));
            seen.iter().map(|wall| wall.wall).collect()
        });
        Self(visible.collect())
    }

    /// The walls that a ray in this direction may meet first. The direction is in 1/65,536 of a
    /// turn from east.
    #[inline]
    pub(crate) fn walls(&self, turn: u16) -> &[u32] {
        &self.0[usize::from(turn / PER_SECTOR)]
    }
}

/// Adds a wall to all sectors in which it may be visible.
fn enter(
    number: usize,
    wall: &BuildingWall,
    place: [f64; 2],
    off_axis: f64,
    sectors: &mut [Vec<Seen>],
) {
    let ends = wall.span.map(|along| {
        let foot = wall.foot(along);
        [foot[0] - place[0], foot[1] - place[1]]
    });
    let across = (place[1 - wall.along] - wall.plane).abs();
    let along = [wall.span[0] - place[wall.along], wall.span[1] - place[wall.along]];
    let beside = along[0].max(-along[1]).max(0.0);
    let near = across.hypot(beside);
    // Rays that pass beside the place see the wall turned by at most this angle.
    let rounded = TURN_ERROR as f64 / 65_536.0 * TAU;
    let slack = if near > 2.0 * off_axis { (off_axis / near).asin() + rounded } else { TAU };
    let angles = ends.map(|[x, y]| y.atan2(x));
    let from = if wrapped(angles[1] - angles[0]) > 0.0 { angles[0] } else { angles[1] };
    let extent = wrapped(angles[1] - angles[0]).abs();
    let per_turn = f64::from(SECTORS) / TAU;
    let sector = |angle: f64| (angle * per_turn).floor() as i64;
    let first = sector(from - slack);
    let count = if slack >= TAU {
        i64::from(SECTORS)
    } else {
        (sector(from + extent + slack) - first + 1).min(i64::from(SECTORS))
    };
    for sector in first..first + count {
        let (low, high) = (sector as f64 / per_turn, (sector + 1) as f64 / per_turn);
        let covers = slack < TAU && low >= from + slack && high <= from + extent - slack;
        let share = |angle: f64| if wall.along == 0 { angle.sin() } else { angle.cos() }.abs();
        let shares = [low, high].map(share);
        // Distance of the wall along the sector's edges, if it covers the sector.
        let far = if covers {
            let lengths = shares.map(|share| across.max(1e-9) / share.max(1e-9));
            lengths.into_iter().fold(0.0, f64::max)
        } else {
            f64::INFINITY
        };
        // The least distance of the wall's plane within the sector, or that of the wall's nearest point. Within such a
        // narrow sector, the share is at most this much greater than at an edge.
        let most = (shares[0].max(shares[1]) + (high - low)).min(1.0);
        let near = near.max(across / most);
        let index = sector.rem_euclid(i64::from(SECTORS)) as usize;
        sectors[index].push(Seen {
            wall: number as u32,
            near: near - off_axis,
            far: far + off_axis,
            covers,
        });
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;
    use toposlam_model::floor_plan::walls;

    use super::*;
    use crate::plan_named;

    /// The first of these walls that a ray meets.
    fn first<'a>(
        walls: impl Iterator<Item = (usize, &'a BuildingWall)>,
        origin: [f64; 2],
        angle: f64,
    ) -> Option<usize> {
        let direction = [angle.cos(), angle.sin()];
        let mut nearest = (f64::INFINITY, None);
        for (number, wall) in walls {
            let across = 1 - wall.along;
            let length = (wall.plane - origin[across]) / direction[across];
            let at = origin[wall.along] + length * direction[wall.along];
            if length > 0.0 && length < nearest.0 && wall.span[0] <= at && at <= wall.span[1] {
                nearest = (length, Some(number));
            }
        }
        nearest.1
    }

    #[test]
    fn the_first_wall_of_every_ray_is_found() {
        let plan = plan_named("building-25").unwrap();
        let walls = walls(&plan);
        let floors: Vec<_> = plan.floor().collect();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
        let (mut rays, mut looked_at) = (0, 0);
        for number in 0..400 {
            let floor = floors[number % floors.len()];
            let place =
                [0, 1].map(|axis| rng.random_range(floor.least[axis]..=floor.greatest[axis]));
            for off_axis in [0.0, 0.01, 0.05] {
                let lines = SightLines::from(place, off_axis, &walls);
                for _ in 0..50 {
                    let turn: u16 = rng.random();
                    let angle = (f64::from(turn) + 0.5) / 65_536.0 * TAU;
                    let aside = rng.random_range(-off_axis..=off_axis);
                    let origin = [place[0] - aside * angle.sin(), place[1] + aside * angle.cos()];
                    if !floors.iter().any(|floor| floor.holds(origin)) {
                        continue;
                    }
                    let found = lines.walls(turn).iter().map(|&wall| wall as usize);
                    let found = found.inspect(|_| looked_at += 1).map(|wall| (wall, &walls[wall]));
                    let expected = first(walls.iter().enumerate(), origin, angle);
                    assert_eq!(first(found, origin, angle), expected, "{place:?} {angle}");
                    rays += 1;
                }
            }
        }
        assert!(rays > 50_000 && looked_at < 3 * rays, "{looked_at} of {rays}");
    }
}
