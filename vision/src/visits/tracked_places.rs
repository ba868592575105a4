//! Junctions, corners and dead ends in several views, and what most of the views show.

use nalgebra::Point2;
use toposlam_model::driving::scene::wrapped;

use crate::{geometry::distance, laser::params::VisitParams, place::SeenPlace};

#[derive(Clone, Debug, Default)]
pub(super) struct TrackedPlaces {
    params: VisitParams,
    places: Vec<TrackedPlace>,
}

#[derive(Clone, Debug)]
pub(super) struct TrackedPlace {
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

#[derive(Clone, Copy, Debug)]
pub(super) struct TrackedArm {
    /// The mean, in radians.
    pub direction: f64,
    /// The part of the views that show it.
    pub part: f64,
}

impl TrackedPlaces {
    pub(super) fn new(params: VisitParams) -> Self {
        Self { params, places: Vec::new() }
    }

    /// Adds a view of the places that the robot is near, after this length of its way.
    pub(super) fn add<'a>(
        &mut self,
        seen: impl Iterator<Item = &'a SeenPlace>,
        robot: Point2<f64>,
        way: f64,
    ) {
        let VisitParams { range, views: most, memory, .. } = self.params;
        self.places.retain(|place| way - place.way < memory);
        for seen in seen {
            if distance(seen.centre, robot) > range + seen.clearance {
                continue;
            }
            let arms: Vec<f64> = seen.directions().collect();
            let is_meet = arms.len() >= 3;
            let SeenPlace { centre, clearance, .. } = *seen;
            let Some(known) = self.index_at(centre) else {
                let views = vec![arms];
                self.places.push(TrackedPlace { centre, clearance, views, is_meet, way });
                continue;
            };
            let known = &mut self.places[known];
            if is_meet || !known.is_meet {
                let views = if is_meet == known.is_meet { known.views.len() } else { 0 };
                let views = views.min(most) as f64;
                let mean = |old: f64, new: f64| (views * old + new) / (views + 1.0);
                known.centre = known.centre.coords.zip_map(&centre.coords, mean).into();
                known.clearance = mean(known.clearance, clearance);
                known.is_meet = is_meet;
            }
            known.views.push(arms);
            known.way = way;
        }
        for known in &mut self.places {
            let near = distance(known.centre, robot) < range + known.clearance;
            if near && known.way < way {
                known.views.push(Vec::new());
            }
            let old = known.views.len().saturating_sub(most);
            known.views.drain(..old);
        }
    }

    /// The nearest place that can be the one at a point.
    pub(super) fn at(&self, centre: Point2<f64>) -> Option<&TrackedPlace> {
        self.index_at(centre).map(|index| &self.places[index])
    }

    fn index_at(&self, centre: Point2<f64>) -> Option<usize> {
        let off = |index: &usize| distance(self.places[*index].centre, centre);
        (0..self.places.len())
            .filter(|index| off(index) < self.places[*index].extent(&self.params))
            .min_by(|one, other| off(one).total_cmp(&off(other)))
    }

    /// The place whose centre is nearest to a point, if the point is within the distance that a function
    /// returns for it.
    pub(super) fn nearest(
        &self,
        point: Point2<f64>,
        within: impl Fn(&TrackedPlace) -> f64,
    ) -> Option<&TrackedPlace> {
        let off = |place: &&TrackedPlace| distance(place.centre, point);
        self.places
            .iter()
            .filter(|place| place.views.iter().any(|arms| !arms.is_empty()))
            .filter(|place| off(place) < within(place))
            .min_by(|one, other| off(one).total_cmp(&off(other)))
    }
}

impl TrackedPlace {
    /// What is nearer than this to its centre is the same place, in metres.
    pub(super) fn extent(&self, params: &VisitParams) -> f64 {
        params.same.max(0.6 * self.clearance)
    }

    /// Whether enough views show a junction, and no corner.
    pub(super) fn shows_meet(&self, params: &VisitParams) -> bool {
        let meets = self.views.iter().filter(|view| view.len() >= 3).count();
        let part = params.doubted_part * self.views.len() as f64;
        meets >= params.doubted_views && meets as f64 >= part
    }

    /// The arms that are seen if it is a junction: the views that show a corner miss it.
    pub(super) fn arms_of_meet(&self, params: &VisitParams) -> Vec<TrackedArm> {
        let is_corner = |view: &&[f64]| view.len() < 3;
        let views = self.views.iter().map(Vec::as_slice).skip_while(is_corner);
        common_arms(views.map(|view| if is_corner(&view) { &[] } else { view }), params)
    }

    /// The arms that are seen if it may be a corner or a dead end.
    pub(super) fn arms(&self, params: &VisitParams) -> Vec<TrackedArm> {
        common_arms(self.views.iter().map(Vec::as_slice), params)
    }
}

/// The arms in several views.
fn common_arms<'v>(
    views: impl Iterator<Item = &'v [f64]>,
    params: &VisitParams,
) -> Vec<TrackedArm> {
    // The mean direction, the number of views, and the last of them.
    let mut groups: Vec<(f64, u32, usize)> = Vec::new();
    let mut all = 0;
    for view in views {
        all += 1;
        for &arm in view {
            let off = |group: &(f64, u32, usize)| wrapped(group.0 - arm).abs();
            let near = groups.iter_mut().filter(|group| off(group) < params.same_arm);
            if let Some(group) = near.min_by(|one, other| off(one).total_cmp(&off(other))) {
                group.0 = wrapped(group.0 + wrapped(arm - group.0) / f64::from(group.1 + 1));
                group.1 += u32::from(group.2 != all);
                group.2 = all;
            } else {
                groups.push((arm, 1, all));
            }
        }
    }
    let part = |seen: u32| f64::from(seen) / all.max(1) as f64;
    let arm = |(direction, seen, _)| TrackedArm { direction, part: part(seen) };
    groups.into_iter().map(arm).collect()
}
