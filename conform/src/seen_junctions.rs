//! Junctions, corners and dead ends in several views of a laser scanner, and what most of the views show.

use nalgebra::Point2;
use toposlam_model::driving::scene::wrapped;
use toposlam_vision::{
    geometry::distance,
    laser::{junctions::LaserJunction, params::VisitParams},
};

use super::params::LASER;

/// The junctions that were seen lately.
#[derive(Clone, Debug)]
pub(super) struct SeenJunctions {
    params: VisitParams,
    junctions: Vec<SeenJunction>,
}

/// A junction in several views.
#[derive(Clone, Debug)]
pub(super) struct SeenJunction {
    /// The mean of its centre, in metres.
    pub centre: Point2<f64>,
    /// The mean distance from there to the nearest wall, in metres.
    pub clearance: f64,
    /// The directions of its arms in each view, the last one last; empty where it is not seen.
    views: Vec<Vec<f64>>,
    /// Whether a view has shown more than a corner.
    is_meet: bool,
    /// The length of the robot's way at the last view.
    way: f64,
}

/// An arm of a junction.
#[derive(Clone, Copy, Debug)]
pub(super) struct SeenArm {
    /// Its mean direction, in radians.
    pub direction: f64,
    /// The part of the views that show it.
    pub part: f64,
}

impl SeenJunctions {
    pub(super) fn new(params: VisitParams) -> Self {
        Self { params, junctions: Vec::new() }
    }

    /// Adds a view to the junctions that the robot is near, after this length of its way.
    pub(super) fn look<'a>(
        &mut self,
        junctions: impl Iterator<Item = &'a LaserJunction>,
        robot: Point2<f64>,
        way: f64,
    ) {
        let VisitParams { range, views: most, .. } = self.params;
        self.junctions.retain(|junction| way - junction.way < LASER.junction_memory);
        for junction in junctions {
            if distance(junction.centre, robot) > range + junction.clearance {
                continue;
            }
            let is_meet = junction.arms.len() >= 3;
            if let Some(known) = self.index_at(junction.centre) {
                let known = &mut self.junctions[known];
                if is_meet || !known.is_meet {
                    let views = if is_meet == known.is_meet { known.views.len() } else { 0 };
                    let views = views.min(most) as f64;
                    let mean = |old: f64, new: f64| (views * old + new) / (views + 1.0);
                    known.centre =
                        known.centre.coords.zip_map(&junction.centre.coords, mean).into();
                    known.clearance = mean(known.clearance, junction.clearance);
                    known.is_meet = is_meet;
                }
                known.views.push(junction.arms.clone());
                known.way = way;
            } else {
                self.junctions.push(SeenJunction {
                    centre: junction.centre,
                    clearance: junction.clearance,
                    views: vec![junction.arms.clone()],
                    is_meet,
                    way,
                });
            }
        }
        for known in &mut self.junctions {
            let near = distance(known.centre, robot) < range + known.clearance;
            if near && known.way < way {
                known.views.push(Vec::new());
            }
            let old = known.views.len().saturating_sub(most);
            known.views.drain(..old);
        }
    }

    /// The nearest junction that can be the one at a point.
    pub(super) fn at(&self, centre: Point2<f64>) -> Option<&SeenJunction> {
        self.index_at(centre).map(|index| &self.junctions[index])
    }

    fn index_at(&self, centre: Point2<f64>) -> Option<usize> {
        let off = |index: &usize| distance(self.junctions[*index].centre, centre);
        (0..self.junctions.len())
            .filter(|index| off(index) < self.junctions[*index].extent(&self.params))
            .min_by(|one, other| off(one).total_cmp(&off(other)))
    }

    /// The junction whose centre is nearest to a point, if the point is within the distance that a function
    /// returns for it.
    pub(super) fn nearest(
        &self,
        point: Point2<f64>,
        within: impl Fn(&SeenJunction) -> f64,
    ) -> Option<&SeenJunction> {
        let off = |junction: &&SeenJunction| distance(junction.centre, point);
        self.junctions
            .iter()
            .filter(|junction| junction.views.iter().any(|arms| !arms.is_empty()))
            .filter(|junction| off(junction) < within(junction))
            .min_by(|one, other| off(one).total_cmp(&off(other)))
    }
}

impl SeenJunction {
    /// What is nearer than this to its centre is the same junction, in metres.
    pub(super) fn extent(&self, params: &VisitParams) -> f64 {
        params.same.max(0.6 * self.clearance)
    }

    /// The number of views that show a junction, and no corner.
    pub(super) fn views_of_meet(&self) -> usize {
        self.views.iter().filter(|view| view.len() >= 3).count()
    }

    /// The arms that are seen if it is a junction: the views that show a corner miss it.
    pub(super) fn arms_of_meet(&self, params: &VisitParams) -> Vec<SeenArm> {
        let is_corner = |view: &[f64]| view.len() < 3;
        let views = self.views.iter().map(Vec::as_slice).skip_while(|view| is_corner(view));
        let views = views.map(|view| if is_corner(view) { &[] } else { view });
        common_arms(&views.collect::<Vec<_>>(), params)
    }

    /// The arms that are seen if it may be a corner or a dead end.
    pub(super) fn arms(&self, params: &VisitParams) -> Vec<SeenArm> {
        common_arms(&self.views.iter().map(Vec::as_slice).collect::<Vec<_>>(), params)
    }
}

/// The arms in several views.
fn common_arms(views: &[&[f64]], params: &VisitParams) -> Vec<SeenArm> {
    // The mean direction, the number of views, and the last of them.
    let mut groups: Vec<(f64, u32, usize)> = Vec::new();
    for (number, &view) in views.iter().enumerate() {
        for &arm in view {
            let off = |group: &(f64, u32, usize)| wrapped(group.0 - arm).abs();
            let near = groups.iter_mut().filter(|group| off(group) < params.same_arm);
            if let Some(group) = near.min_by(|one, other| off(one).total_cmp(&off(other))) {
                group.0 = wrapped(group.0 + wrapped(arm - group.0) / f64::from(group.1 + 1));
                group.1 += u32::from(group.2 != number);
                group.2 = number;
            } else {
                groups.push((arm, 1, number));
            }
        }
    }
    let all = views.len().max(1) as f64;
    let arm = |(direction, seen, _)| SeenArm { direction, part: f64::from(seen) / all };
    groups.into_iter().map(arm).collect()
}
