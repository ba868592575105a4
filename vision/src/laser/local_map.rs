//! What a local map shows around the robot: the map, the middle lines of its ways, and the places where they meet; and
//! the rays of scans that it is made of.

use nalgebra::Point2;
use toposlam_model::driving::{odometry::Odometry, scene::wrapped};

use super::{
    clearances::Clearances,
    grid::Grid,
    params::{LaserParams, LocalMapParams},
    ray_counts::Rays,
    scan::Scan,
    skeleton::Skeleton,
    viewpoint::Viewpoint,
    way_graph::{ArmJudge, CountedArms, WayGraph},
};
use crate::{
    geometry::distance,
    place::{PlaceFacts, SeenPlace},
};

/// The local map, and the ways on it.
#[derive(Clone, Debug)]
pub struct LocalMap {
    pub clearances: Clearances,
    /// The middle lines of its ways; `None` if the robot has no way.
    pub skeleton: Option<Skeleton>,
    /// All of them, arms or not.
    pub ways: WayGraph,
    /// Those that count.
    pub graph: WayGraph,
}

/// What a local map shows, on that map.
#[derive(Clone, Debug)]
pub(super) struct LocalView {
    pub map: LocalMap,
    pub places: Vec<SeenPlace>,
    /// The same if arms in doubt are arms, too.
    pub possible_places: Vec<SeenPlace>,
    /// See [`PlaceView::width`].
    pub width: Option<f64>,
}

/// Where the scans of a local map were taken.
#[derive(Clone, Debug)]
pub(super) struct LocalScans<'a> {
    /// Where the robot is now.
    pub robot: Point2<f64>,
    pub viewpoints: Vec<Viewpoint>,
    /// Where the robot was.
    pub driven: Vec<Point2<f64>>,
    /// What stopped it, and no scan shows.
    pub felt: Vec<FeltWall>,
    pub params: &'a LaserParams,
}

/// A piece of wall that stopped the robot.
#[derive(Clone, Copy, Debug)]
pub struct FeltWall {
    /// Where it stood.
    pub robot: Point2<f64>,
    /// The ends of the piece.
    pub wall: [Point2<f64>; 2],
}

/// All ways on a local map, before it is judged which of them are arms.
pub(super) struct LocalWays<'a> {
    scans: LocalScans<'a>,
    clearances: Clearances,
    skeleton: Option<Skeleton>,
    graph: WayGraph,
}

impl<'a> LocalWays<'a> {
    pub(super) fn new(mut grid: Grid, scans: LocalScans<'a>) -> Self {
        grid.clean(&scans.params.map);
        scans.felt.iter().for_each(|felt| grid.build(felt.robot, felt.wall));
        let clearances = Clearances::new(grid);
        let skeleton = Skeleton::new(&clearances, scans.robot, scans.params);
        let graph = skeleton.as_ref().map(|ways| WayGraph::new(ways, &clearances));
        Self { scans, clearances, skeleton, graph: graph.unwrap_or_default() }
    }

    /// The ways of which those to ends count as arms, and whether any of the others is in doubt.
    fn pruned(&self, counted: CountedArms) -> (WayGraph, bool) {
        let LocalScans { viewpoints, driven, params, .. } = &self.scans;
        let judge = ArmJudge { map: &self.clearances, viewpoints, driven, params: &params.arm };
        self.graph.clone().pruned(&judge, counted)
    }

    fn places(&self, counted: CountedArms) -> Vec<SeenPlace> {
        self.pruned(counted).0.places(self.scans.params)
    }

    /// See [`PlaceView::facts`](crate::place::PlaceView::facts).
    pub(super) fn facts(&self) -> PlaceFacts {
        PlaceFacts {
            driven: self.places(CountedArms::Driven),
            not_ended: self.places(CountedArms::NotEnded),
        }
    }

    /// What the map shows around the robot.
    pub(super) fn view(self) -> LocalView {
        let (graph, any_in_doubt) = self.pruned(CountedArms::Seen);
        let LocalScans { robot, params, .. } = self.scans;
        let places = graph.places(params);
        let possible_places =
            if any_in_doubt { self.places(CountedArms::SeenOrInDoubt) } else { places.clone() };
        let Self { clearances, skeleton, graph: ways, .. } = self;
        let width =
            skeleton.as_ref().and_then(|ways| ways.width_at(robot, &clearances, &params.map));
        let map = LocalMap { clearances, skeleton, ways, graph };
        LocalView { map, places, possible_places, width }
    }
}

/// The rays of a scan.
pub(super) fn rays(scan: &Scan, params: &LocalMapParams) -> Rays {
    let mut rays = Rays::default();
    let from = scan.scanner();
    let readings: Vec<(f64, Option<f64>)> = scan.ranges_hit().collect();
    // Nothing beyond is on the map while the scan is remembered.
    let farthest = 2.0 * params.reach + params.memory;
    let ends: Vec<Option<Point2<f64>>> =
        readings.iter().map(|&(bearing, range)| Some(scan.point(bearing, range?))).collect();
    let end = |index: usize| *ends.get(index)?;
    // The next reading with a return, if those without one in between cover a small angle only.
    let next = |index: usize| {
        let (bearing, _) = readings[index];
        let mut others = (index + 1..readings.len()).chain(0..index);
        let (at, next, range) =
            others.find_map(|at| readings[at].1.map(|range| (at, readings[at].0, range)))?;
        let step = wrapped(next - bearing);
        let is_near = at == index + 1 || (0.0..=params.max_silence).contains(&step);
        is_near.then_some((at, step, range))
    };
    for (index, &(bearing, range)) in readings.iter().enumerate() {
        let Some(range) = range else { continue };
        let point = |range| scan.point(bearing, range);
        rays.free.push([from, point(range.min(farthest))]);
        if range > farthest {
            continue;
        }
        rays.hits.push(point(range));
        let Some((at, step, other)) = next(index) else { continue };
        // Rays closer than cells, from where these two are a cell apart, up to where the map ends.
        let (apart, latest) = (params.cell / step.abs(), range.min(other).min(farthest));
        let parts = (step.abs() * params.reach / params.cell).ceil() as u32;
        for part in (1..parts).take_while(|_| apart < latest) {
            let bearing = bearing + step * f64::from(part) / f64::from(parts);
            rays.free.push([apart, latest].map(|range| scan.point(bearing, range)));
        }
        if at != index + 1 {
            continue;
        }
        let four = [index.checked_sub(1).and_then(end), end(index), end(index + 1), end(index + 2)];
        let [Some(before), Some(one), Some(two), Some(after)] = four else { continue };
        let gap = distance(one, two);
        let off = |line: [Point2<f64>; 2], towards: Point2<f64>, range: f64| {
            met(from, towards, line).map_or(f64::INFINITY, |met| (met - range).abs() / gap.max(0.3))
        };
        let off = [off([before, one], two, other), off([after, two], one, range)];
        let is_straight = off.iter().all(|&off| off < params.straight)
            || off.iter().any(|&off| off < params.continued);
        if (params.cell..=params.bridge).contains(&gap) && is_straight {
            rays.walls.push([one, two]);
        }
    }
    rays
}

/// The range at which the ray from one point towards another meets the line through two points.
fn met(from: Point2<f64>, towards: Point2<f64>, [one, other]: [Point2<f64>; 2]) -> Option<f64> {
    let (ray, line) = ((towards - from).normalize(), other - one);
    let met = (one - from).perp(&line) / ray.perp(&line);
    (met.is_finite() && met > 0.0).then_some(met)
}

/// Odometry beyond this is wrong, in metres; cells near it would have no place.
const FARTHEST: f64 = 1e7;

/// Whether the odometry is not more than 10,000 km from its origin.
pub(super) fn is_near_origin(odometry: &Odometry) -> bool {
    let pose = odometry.position.into_iter().chain([odometry.heading]);
    pose.into_iter().all(|number| (-FARTHEST..=FARTHEST).contains(&number))
}
