//! Whether a building is a network of corridors at all: halls, castles and campuses are none, and their junctions mean
//! nothing.

use serde::Serialize;

use super::VisitLog;
use crate::{laser::params::NetworkParams, place::PlaceView};

/// How well a network of corridors describes a building.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct NetworkFit {
    /// The part of the robot's way on which free space is wider than a corridor.
    pub wide: f64,
    /// The number of visits of places that have, or may have, more doors than a junction of corridors.
    pub many_doors: usize,
    /// Why it is no network of corridors; `None` if it may be one.
    pub fault: Option<NetworkFault>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum NetworkFault {
    /// Too much of the way is wider than a corridor.
    Wide,
    /// Too many junctions have too many doors.
    ManyDoors,
}

impl NetworkFit {
    /// The fit of the views and the visits of a log.
    pub fn new<S>(views: &[PlaceView], log: &VisitLog<S>, params: &NetworkParams) -> Self {
        let is_wide = |width: Option<f64>| width.is_some_and(|width| width > params.widest);
        let wide = views.iter().filter(|view| is_wide(view.width)).count();
        let wide = wide as f64 / views.len().max(1) as f64;
        let doors = log.visits.iter().map(|visit| {
            let seen = visit.alternatives().into_iter().flatten();
            seen.map(|percept| percept.degree).max().unwrap_or_default()
        });
        let many_doors = doors.filter(|&doors| doors as usize >= params.many_doors).count();
        let fault = if wide > params.wide_part {
            Some(NetworkFault::Wide)
        } else if many_doors >= params.many_visits
            && many_doors as f64 >= params.many_part * log.visits.len() as f64
        {
            Some(NetworkFault::ManyDoors)
        } else {
            None
        };
        Self { wide, many_doors, fault }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Isometry2;
    use toposlam_model::driving::odometry::Odometry;

    use super::*;
    use crate::{
        place::{PlaceArm, ViewSector},
        visits::Visit,
    };

    /// The fault of a way with these widths, and of places with these numbers of doors.
    fn fault(widths: &[f64], doors: &[u32]) -> Option<NetworkFault> {
        let view = |&width: &f64| PlaceView {
            robot: Odometry::default(),
            odometry_from_map: Isometry2::identity(),
            places: Vec::new(),
            possible_places: Vec::new(),
            facts: None,
            sector: ViewSector::ALL_AROUND,
            width: Some(width),
            scene: None,
        };
        let visit = |&doors: &u32| Visit::<()> {
            arms: (0..doors).map(|door| PlaceArm::certain(f64::from(door) * 0.6)).collect(),
            ..Visit::default()
        };
        let views: Vec<_> = widths.iter().map(view).collect();
        let log = VisitLog { visits: doors.iter().map(visit).collect(), turned_back: Vec::new() };
        NetworkFit::new(&views, &log, &NetworkParams::DEFAULT).fault
    }

    #[test]
    fn halls_and_places_with_many_doors_are_no_network_of_corridors_and_a_lobby_is_part_of_one() {
        assert_eq!(fault(&[2.0, 2.4, 3.3, 2.0, 1.6], &[3, 4, 3, 5]), None);
        assert_eq!(fault(&[2.0, 2.4, 6.0, 2.0, 1.6, 2.0], &[3, 4, 5, 5, 3, 3, 3]), None);
        assert_eq!(fault(&[2.0, 6.0, 5.0, 2.0], &[3, 3]), Some(NetworkFault::Wide));
        assert_eq!(fault(&[2.0], &[5, 6, 3, 5, 3]), Some(NetworkFault::ManyDoors));
        assert_eq!(fault(&[], &[]), None);
        // At the limits: as wide as a corridor may be, a fifth of the way, and three places, more than a third of all.
        assert_eq!(fault(&[4.0; 3], &[]), None);
        assert_eq!(fault(&[6.0, 2.0, 2.0, 2.0, 2.0], &[]), None);
        assert_eq!(fault(&[], &[5, 5]), None);
        assert_eq!(fault(&[], &[5, 5, 5, 3, 3, 3, 3, 3]), Some(NetworkFault::ManyDoors));
        assert_eq!(fault(&[], &[5, 5, 5, 3, 3, 3, 3, 3, 3]), None);
    }
}
