//! Other passes of the robot by a place: how they lie on the local map of one, and whether they are of the same place.
//!
//! A pass is moved by a little, so that its walls lie on those of the map (Censi, *An ICP variant using a point-to-line metric*,
//! 2008). It is of another place if it would fit better elsewhere along the walls (the search of Olson, *Real-time correlative
//! scan matching*, 2009): corridors look alike, and a pass that lies two metres off agrees with most of what is seen.

use std::collections::BTreeSet;

use nalgebra::{Isometry2, Vector2};
use toposlam_model::driving::odometry::Odometry;

use super::{
    drift::ROUNDS,
    matching::{ScanMatcher, WallPoint},
    params::{LocalMapParams, MatchingParams},
    ray_counts::{NearWalls, RayCounts, Rays},
};
use crate::geometry::from_robot;

/// What is near a wall is at most so many cells off.
const NEAR_WALL: i64 = 2;
/// With fewer hits where the map is known it is not known whether a pass agrees.
const LEAST_HITS: usize = 200;
/// The standard deviation of odometry between two passes, in metres and in radians. Logs: corrected ones are so far off.
const DEVIATION: [f64; 2] = [0.3, 0.05];
/// So many points of a pass are matched with walls, and ...
const POINTS: usize = 200;
/// ... so many of its hits are looked for elsewhere.
const HITS: usize = 1000;
/// A pass is looked for up to this far along the walls of the map and across, in metres. Geometry: farther away, rooms of the
/// same width look alike.
const FARTHEST: f64 = 4.0;
/// The nearest place at which it is looked for, in cells. Geometry: nearer ones are the same place.
const NEAREST: i64 = 6;
/// It lies elsewhere if this much more of its hits are near walls there, ... Logs.
const MORE: f64 = 0.02;
/// ... or this much more, if of the hits that are near none here at most ... Geometry: along a corridor most hits are near its
/// walls wherever it lies.
const LITTLE_MORE: f64 = 0.004;
/// ... this part are near none there either. Geometry: a third.
const STILL_ASTRAY: f64 = 0.33;

/// What a local map shows of its own pass.
pub(super) struct OwnPass<'a> {
    counts: &'a RayCounts,
    /// What is near to the ends of its rays, of which some are not at walls: ...
    near_hits: NearWalls,
    /// ... and near to its walls.
    near_walls: NearWalls,
}

/// The walls of a map's own pass, by points of them, each with the pose of its scan on that map.
pub(super) fn own_walls<'a>(
    walls: impl IntoIterator<Item = (&'a [WallPoint], Odometry)>,
    params: &MatchingParams,
) -> ScanMatcher {
    let mut matcher = ScanMatcher::new(MatchingParams { rounds: ROUNDS, ..*params });
    for (points, pose) in walls {
        matcher.add(points, &pose);
    }
    matcher
}

impl<'a> OwnPass<'a> {
    /// The pass of a map by its rays.
    pub(super) fn new(counts: &'a RayCounts, params: &LocalMapParams) -> Self {
        let [near_hits, near_walls] = counts.near_hits_and_walls(NEAR_WALL as usize, params);
        Self { counts, near_hits, near_walls }
    }

    /// The small motion of another pass after which its walls lie on those of the map, by points of its walls on the map;
    /// none if they do not match.
    pub(super) fn correction(
        &self,
        own: &ScanMatcher,
        walls: impl Iterator<Item = WallPoint>,
    ) -> Isometry2<f64> {
        let is_known =
            |wall: &WallPoint| self.near_hits.at(self.counts.cell_at(wall.point)).is_some();
        let points = some_of(walls.filter(is_known).collect(), POINTS);
        let matched = own.matched(&points, &Odometry::default(), DEVIATION);
        matched.map_or_else(Isometry2::identity, |pose| from_robot(&pose))
    }

    /// The cells of the hits of another pass, by its scans, each with the motion to the map.
    pub(super) fn hits<'r>(
        &self,
        pass: impl Iterator<Item = (&'r Rays, Isometry2<f64>)>,
    ) -> Vec<[i64; 2]> {
        let mut cells = Vec::new();
        for (rays, motion) in pass {
            cells.extend(self.counts.cells_at(&rays.hits, &motion));
        }
        cells
    }

    /// The part of the hits of another pass that lie on walls, where the map is known; `None` if too few do.
    pub(super) fn part_on_walls(&self, hits: &[[i64; 2]]) -> Option<f64> {
        part_near(&self.near_hits, hits, [0, 0], LEAST_HITS)
    }

    /// The widest wall in free space that another pass sees, in metres, by its hits on the map; `None` if less than this part of
    /// them lies on walls, or if more would elsewhere.
    pub(super) fn widest_astray(&self, hits: &[[i64; 2]], least: f64) -> Option<f64> {
        self.part_on_walls(hits).filter(|&part| part >= least)?;
        let is_known = |hit: &[i64; 2]| self.near_hits.at(*hit).is_some();
        let known = hits.iter().copied().filter(is_known).collect();
        if self.fit_elsewhere(&some_of(known, HITS)) {
            return None;
        }
        let is_astray = |hit: &[i64; 2]| self.near_hits.at(*hit) == Some(false);
        let astray = groups(hits.iter().copied().filter(is_astray).collect());
        let widest = astray.into_iter().map(|sides| sides.norm()).fold(0.0, f64::max);
        Some(self.counts.cell * widest)
    }

    /// Whether more of these hits are near walls after a shift. Where most of them leave what is known it is not known how
    /// they fit.
    fn fit_elsewhere(&self, hits: &[[i64; 2]]) -> bool {
        let part = |shift| part_near(&self.near_walls, hits, shift, hits.len().div_ceil(2));
        let Some(here) = part([0, 0]) else { return false };
        let farthest = (FARTHEST / self.counts.cell) as i64;
        (NEAREST..=farthest)
            .step_by(NEAR_WALL as usize)
            .flat_map(|cells| [[cells, 0], [-cells, 0], [0, cells], [0, -cells]])
            .filter_map(part)
            .any(|there| {
                let explains_most = 1.0 - there <= STILL_ASTRAY * (1.0 - here);
                there > here + if explains_most { LITTLE_MORE } else { MORE }
            })
    }
}

/// The part of cells that are near walls after a shift, of those where the map is known; `None` if these are fewer than
/// `least`.
fn part_near(
    walls: &NearWalls,
    cells: &[[i64; 2]],
    [east, north]: [i64; 2],
    least: usize,
) -> Option<f64> {
    let (mut known, mut near) = (0, 0);
    for &[column, row] in cells {
        // Without a branch, which would be hard to predict.
        let is_near = walls.at([column + east, row + north]);
        known += usize::from(is_near.is_some());
        near += usize::from(is_near == Some(true));
    }
    (known >= least.max(1)).then(|| near as f64 / known as f64)
}

/// At most so many of these, evenly chosen.
fn some_of<T>(all: Vec<T>, most: usize) -> Vec<T> {
    let step = all.len().div_ceil(most).max(1);
    all.into_iter().step_by(step).collect()
}

/// The sides of the rectangles around the groups of these cells, in cells. Cells of a group are at most [`NEAR_WALL`] apart.
fn groups(mut cells: BTreeSet<[i64; 2]>) -> Vec<Vector2<f64>> {
    let mut groups = Vec::new();
    while let Some(first) = cells.pop_first() {
        let (mut low, mut high) = (first, first);
        let mut open = vec![first];
        while let Some([column, row]) = open.pop() {
            for near in (-NEAR_WALL..=NEAR_WALL)
                .flat_map(|x| (-NEAR_WALL..=NEAR_WALL).map(move |y| [column + x, row + y]))
            {
                if cells.remove(&near) {
                    low = [0, 1].map(|axis| low[axis].min(near[axis]));
                    high = [0, 1].map(|axis| high[axis].max(near[axis]));
                    open.push(near);
                }
            }
        }
        groups.push(Vector2::from([0, 1].map(|axis| (high[axis] - low[axis] + 1) as f64)));
    }
    groups
}
