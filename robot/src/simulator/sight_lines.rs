//! Which walls can be seen in which direction from a place.

use std::f64::consts::TAU;

use super::walls::Wall;

/// Directions that are told apart, of 65,536 to a full turn each so many.
const SECTORS: usize = 512;
const PER_SECTOR: usize = 65_536 / SECTORS;

/// For each sector of directions, counter-clockwise from east, the walls that a ray may meet first,
/// nearest first.
#[derive(Clone, Debug)]
pub(super) struct SightLines {
    begin: Vec<u32>,
    walls: Vec<u32>,
}

/// A wall as it is seen: the sectors that it is in, and how near and far it is in them.
struct Seen {
    wall: u32,
    near: f64,
    far: f64,
    covers: bool,
}

impl SightLines {
    /// The walls around a place, for rays that pass from it by no more than so far.
    pub(super) fn from(place: [f64; 2], off_axis: f64, walls: &[Wall]) -> Self {
        let mut sectors: Vec<Vec<Seen>> = (0..SECTORS).map(|_| Vec::new()).collect();
        for (number, wall) in walls.iter().enumerate() {
            let out = (place[1 - wall.along] - wall.plane) * wall.floor_side;
            // The back of a wall is hidden behind other walls.
            if out > -off_axis {
                enter(number, wall, place, off_axis, &mut sectors);
            }
        }
        let mut lines = Self { begin: vec![0], walls: Vec::new() };
        for seen in &mut sectors {
            let hidden = seen.iter().filter(|wall| wall.covers).map(|wall| wall.far);
            let hidden = hidden.fold(f64::INFINITY, f64::min);
            seen.retain(|wall| wall.near <= hidden);
            seen.sort_by(|one, other| one.near.total_cmp(&other.near));
            lines.walls.extend(seen.iter().map(|wall| wall.wall));
            lines.begin.push(lines.walls.len() as u32);
        }
        lines
    }

    /// The walls that a ray in this direction may meet first; of 65,536 to a full turn from east.
    #[inline]
    pub(super) fn walls(&self, turn: u16) -> &[u32] {
        let sector = usize::from(turn) / PER_SECTOR;
        &self.walls[self.begin[sector] as usize..self.begin[sector + 1] as usize]
    }
}

/// Enters a wall in all sectors in which it may be seen.
fn enter(number: usize, wall: &Wall, place: [f64; 2], off_axis: f64, sectors: &mut [Vec<Seen>]) {
    let ends = wall.span.map(|along| {
        let foot = wall.foot(along);
        [foot[0] - place[0], foot[1] - place[1]]
    });
    let across = (place[1 - wall.along] - wall.plane).abs();
    let along = [wall.span[0] - place[wall.along], wall.span[1] - place[wall.along]];
    let beside = along[0].max(-along[1]).max(0.0);
    let near = across.hypot(beside);
    // Rays that pass beside the place see the wall turned by this at most.
    let slack = if near > 2.0 * off_axis { (off_axis / near).asin() + 1e-6 } else { TAU };
    let angles = ends.map(|[x, y]| y.atan2(x));
    let from = if wrapped(angles[1] - angles[0]) > 0.0 { angles[0] } else { angles[1] };
    let extent = wrapped(angles[1] - angles[0]).abs();
    let per_turn = SECTORS as f64 / TAU;
    let sector = |angle: f64| (angle * per_turn).floor() as i64;
    let first = sector(from - slack);
    let count = if slack >= TAU {
        SECTORS as i64
    } else {
        (sector(from + extent + slack) - first + 1).min(SECTORS as i64)
    };
    for sector in first..first + count {
        let (low, high) = (sector as f64 / per_turn, (sector + 1) as f64 / per_turn);
        let covers = slack < TAU && low >= from + slack && high <= from + extent - slack;
        // How far the wall is along the sector's edges, or its nearer point where it is no farther.
        let far = if covers {
            let normal = across.max(1e-9);
            let towards =
                if wall.along == 0 { [low.sin(), high.sin()] } else { [low.cos(), high.cos()] };
            towards.map(|share| normal / share.abs().max(1e-9)).into_iter().fold(0.0, f64::max)
        } else {
            f64::INFINITY
        };
        let index = sector.rem_euclid(SECTORS as i64) as usize;
        // As near as a sector's edge sees it, or as its nearest point.
        sectors[index].push(Seen {
            wall: number as u32,
            near: near_in(low, high, wall, place, near) - off_axis,
            far: far + off_axis,
            covers,
        });
    }
}

/// How near a wall's plane is at least within a sector.
fn near_in(low: f64, high: f64, wall: &Wall, place: [f64; 2], near: f64) -> f64 {
    let across = (place[1 - wall.along] - wall.plane).abs();
    let share = |angle: f64| if wall.along == 0 { angle.sin() } else { angle.cos() }.abs();
    // Within a sector as narrow as this the greatest share is at most this much more than at an edge.
    let most = (share(low).max(share(high)) + (high - low)).min(1.0);
    near.max(across / most)
}

/// An angle brought into [-pi, pi).
fn wrapped(angle: f64) -> f64 {
    (angle + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0
}
