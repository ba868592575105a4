//! Junctions, corners and dead ends in several views, and what most of the views show.

use nalgebra::Point2;
use toposlam_model::driving::scene::wrapped;

use crate::{
    geometry::distance,
    laser::params::{LaserParams, VisitParams},
    place::SeenPlace,
};

#[derive(Clone, Debug, Default)]
pub(super) struct TrackedPlaces {
    params: VisitParams,
    /// Whether a place may lie elsewhere when the robot comes back: where scans are not matched, odometry drifts.
    drifts: bool,
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
    /// The number of views before it lay where it is now: odometry drifts, so it may lie elsewhere when the robot comes back.
    elsewhere: usize,
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
    pub(super) fn new(params: &LaserParams) -> Self {
        let drifts = params.matching.rounds == 0;
        Self { params: params.visit, drifts, places: Vec::new() }
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
                let new = TrackedPlace { centre, clearance, views, elsewhere: 0, is_meet, way };
                self.places.push(new);
                continue;
            };
            let known = &mut self.places[known];
            if is_meet || !known.is_meet {
                let came_back = self.drifts && way - known.way > 2.0 * range;
                let has_moved =
                    came_back && distance(known.centre, centre) > self.params.same / 2.0;
                if has_moved {
                    known.elsewhere = known.views.len();
                }
                let views = known.views.len() - known.elsewhere;
                let views = if is_meet == known.is_meet { views as f64 } else { 0.0 };
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
            known.elsewhere = known.elsewhere.saturating_sub(old);
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

    /// Whether the last views show it, so many in turn; `None` if some do, or if there are fewer.
    pub(super) fn shown_by_last(&self, count: usize) -> Option<bool> {
        let last = self.views.len().checked_sub(count).map(|first| &self.views[first..])?;
        let shown = last.iter().filter(|arms| !arms.is_empty()).count();
        (shown == 0 || shown == count).then_some(shown > 0)
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

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;
    use crate::place::PlaceArm;

    const FORK: [f64; 3] = [PI, FRAC_PI_2, 0.0];
    const CORNER: [f64; 2] = [PI, FRAC_PI_2];

    fn seen(x: f64, clearance: f64, arms: &[f64]) -> SeenPlace {
        let arms = arms.iter().map(|&direction| PlaceArm::certain(direction)).collect();
        SeenPlace { centre: Point2::new(x, 0.0), clearance, arms }
    }

    /// The last three views decide.
    fn tracked() -> TrackedPlaces {
        let visit = VisitParams { views: 3, ..VisitParams::DEFAULT };
        TrackedPlaces::new(&LaserParams { visit, ..LaserParams::DEFAULT })
    }

    /// The places after views of a robot at the origin, one in each metre of its way.
    fn after(views: &[&[SeenPlace]]) -> TrackedPlaces {
        let mut places = tracked();
        for (way, view) in views.iter().enumerate() {
            places.add(view.iter(), Point2::origin(), way as f64);
        }
        places
    }

    #[track_caller]
    fn assert_near(one: f64, other: f64) {
        assert!((one - other).abs() < 1e-9, "{one} {other}");
    }

    #[test]
    fn a_place_is_in_the_mean_of_the_last_views_and_a_junction_is_not_moved_by_a_corner() {
        let [first, second, third] =
            [(0.0, 1.0), (0.4, 1.2), (0.8, 1.4)].map(|(x, clearance)| [seen(x, clearance, &FORK)]);
        let places = after(&[&first, &second, &third]);
        let [place] = &places.places[..] else { panic!("{places:?}") };
        assert_near(place.centre.x, 0.4);
        assert_near(place.clearance, 1.2);
        // Of four views the last one counts as one of four, and so does a fifth.
        let fifth = [seen(1.2, 1.2, &FORK)];
        let places = after(&[&first, &second, &third, &fifth, &fifth]);
        assert_near(places.places[0].centre.x, 0.6 + 0.25 * 0.6);
        // What was taken for a corner is where it was seen to be a junction, and stays there.
        let [corner, fork] = [[seen(0.0, 1.0, &CORNER)], [seen(1.0, 2.0, &FORK)]];
        for views in [&[&corner[..], &fork][..], &[&corner, &fork, &corner]] {
            let places = after(views);
            assert_near(places.places[0].centre.x, 1.0);
            assert_near(places.places[0].clearance, 2.0);
        }
        let corners = after(&[&corner, &[seen(1.0, 2.0, &CORNER)]]);
        assert_near(corners.places[0].centre.x, 0.5);
    }

    #[test]
    fn a_place_is_where_it_was_seen_since_the_robot_came_back() {
        let range = VisitParams::DEFAULT.range;
        let far = 2.0 * range + 0.1;
        for (away, there, x) in [(far - 0.2, 1.0, 0.5), (far, 1.0, 1.0), (far, 0.7, 0.35)] {
            let mut places = tracked();
            for (way, x) in [(0.0, 0.0), (away, there)] {
                places.add([seen(x, 1.0, &FORK)].iter(), Point2::origin(), way);
            }
            assert_near(places.places[0].centre.x, x);
        }
    }

    #[test]
    fn a_place_is_shown_lately_if_each_of_the_last_views_shows_it_and_gone_if_none_does() {
        let fork = [seen(0.0, 1.0, &FORK)];
        let shown = |views: &[&[SeenPlace]], count| after(views).places[0].shown_by_last(count);
        assert_eq!(
            [1, 2, 3].map(|count| shown(&[&fork, &fork], count)),
            [Some(true), Some(true), None]
        );
        let gone: [&[SeenPlace]; 3] = [&fork, &[], &[]];
        assert_eq!([1, 2, 3].map(|count| shown(&gone, count)), [Some(false), Some(false), None]);
    }

    #[test]
    fn places_nearer_than_their_extent_are_one() {
        let here = seen(0.0, 1.0, &FORK);
        // 1.5 m, or three fifths of the distance to the wall.
        for (apart, clearance, count) in
            [(1.4, 1.0, 1), (1.6, 1.0, 2), (1.7, 3.0, 1), (1.9, 3.0, 2)]
        {
            let places = after(&[
                &[SeenPlace { clearance, ..here.clone() }],
                &[seen(apart, clearance, &FORK)],
            ]);
            assert_eq!(places.places.len(), count, "{apart} {clearance}");
        }
        let two = after(&[&[here, seen(2.0, 1.0, &FORK)]]);
        let x_at = |x| two.at(Point2::new(x, 0.0)).map(|place| place.centre.x);
        assert_eq!([0.9, 1.1, -1.6].map(x_at), [Some(0.0), Some(2.0), None]);
        let x_within =
            |x, within| two.nearest(Point2::new(x, 0.0), |_| within).map(|place| place.centre.x);
        assert_eq!(x_within(0.9, 5.0), Some(0.0));
        assert_eq!(x_within(1.1, 5.0), Some(2.0));
        assert_eq!(x_within(1.1, 0.8), None);
    }

    #[test]
    fn a_place_is_seen_from_nearby_and_forgotten_after_a_long_way() {
        let VisitParams { range, memory, .. } = VisitParams::DEFAULT;
        for (off, count) in [(range + 0.9, 1), (range + 1.1, 0)] {
            assert_eq!(after(&[&[seen(off, 1.0, &FORK)]]).places.len(), count, "{off}");
        }
        let mut places = after(&[&[seen(0.0, 1.0, &FORK)]]);
        for (way, count) in [(memory - 1.0, 1), (memory, 0)] {
            places.add([].iter(), Point2::new(20.0, 0.0), way);
            assert_eq!(places.places.len(), count, "{way}");
        }
    }

    #[test]
    fn an_arm_counts_as_often_as_views_from_nearby_show_it() {
        let fork = [seen(0.0, 1.0, &FORK)];
        let parts = |places: &TrackedPlaces| {
            let params = &places.params;
            places.places[0].arms(params).iter().map(|arm| arm.part).collect::<Vec<_>>()
        };
        assert_eq!(parts(&after(&[&fork, &[]])), [0.5; 3]);
        // The last three views.
        assert_eq!(parts(&after(&[&fork, &[], &fork, &fork])), [2.0 / 3.0; 3]);
        let elsewhere = |x: f64, way: f64| {
            let mut places = after(&[&fork]);
            places.add([].iter(), Point2::new(x, 0.0), way);
            parts(&places)
        };
        assert_eq!(elsewhere(4.9, 1.0), [0.5; 3]);
        assert_eq!(elsewhere(5.1, 1.0), [1.0; 3]);
        // While the robot stands still no view misses it.
        assert_eq!(elsewhere(0.0, 0.0), [1.0; 3]);
        // What no view shows any more is no place at which a robot may be.
        let gone = after(&[&fork, &[], &[], &[]]);
        assert!(gone.nearest(Point2::origin(), |_| 1.0).is_none());
    }

    #[test]
    fn arms_of_one_direction_are_one_arm_in_their_mean_direction() {
        let arms = |views: &[&[f64]]| common_arms(views.iter().copied(), &VisitParams::DEFAULT);
        let [behind, left] = arms(&[&[PI - 0.3, 1.0], &[-PI + 0.1, 1.3], &[PI - 0.1]])[..] else {
            panic!()
        };
        assert_near(wrapped(behind.direction - (PI - 0.1)), 0.0);
        assert_near(left.direction, 1.15);
        assert_eq!((behind.part, left.part), (1.0, 2.0 / 3.0));
        // Two arms of one view that are near to each other are seen once.
        let [one] = arms(&[&[0.0, 0.2], &[]])[..] else { panic!() };
        assert_near(one.direction, 0.1);
        assert_near(one.part, 0.5);
        // An arm between two others is the nearer one.
        let [_, other] = arms(&[&[0.0, 1.0], &[0.55]])[..] else { panic!() };
        assert_near(other.direction, 0.775);
        assert!(arms(&[]).is_empty());
    }

    #[test]
    fn a_junction_is_shown_by_enough_of_the_views_and_a_corner_before_it_misses_no_arm() {
        let [corner, fork] = [[seen(0.0, 1.0, &CORNER)], [seen(0.0, 1.0, &FORK)]];
        let shows = |views: &[&[SeenPlace]]| {
            let places = after(views);
            places.places[0].shows_meet(&places.params)
        };
        assert!(!shows(&[&fork]) && shows(&[&fork, &fork]));
        // Two of three views.
        assert!(shows(&[&fork, &fork, &corner]) && !shows(&[&fork, &corner, &corner]));
        // Two of four are too few.
        let mut usual = TrackedPlaces::new(&LaserParams::DEFAULT);
        for (way, view) in [&fork, &fork, &corner, &corner].into_iter().enumerate() {
            usual.add(view.iter(), Point2::origin(), way as f64);
        }
        assert!(!usual.places[0].shows_meet(&usual.params));
        let places = after(&[&corner, &fork, &corner]);
        let parts = |arms: Vec<TrackedArm>| arms.iter().map(|arm| arm.part).collect::<Vec<_>>();
        assert_eq!(parts(places.places[0].arms_of_meet(&places.params)), [0.5; 3]);
        assert_eq!(parts(places.places[0].arms(&places.params)), [1.0, 1.0, 1.0 / 3.0]);
    }
}
