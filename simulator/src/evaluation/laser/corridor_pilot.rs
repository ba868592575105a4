//! Where a robot drives that leaves a place in a direction: along a corridor, into an alcove, or up to a wall.

use nalgebra::{Point2, Vector2};
use toposlam_model::driving::scene::wrapped;
use toposlam_vision::geometry::{direction, distance, unit};

use super::{corridor_world::CorridorWorld, nearest};
use crate::{ConvexPolygon, Corridor};

/// Keeps a robot on the floor of a building. It knows the plan as a robot knows the walls beside it, and never what is a
/// junction.
#[derive(Clone, Debug)]
pub(super) struct CorridorPilot<'w> {
    world: &'w CorridorWorld,
    floor: Vec<ConvexPolygon>,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct PilotLeg {
    /// Its end, in metres.
    pub to: Point2<f64>,
    /// Where the way goes on from there.
    next: LegEnd,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum LegEnd {
    Place {
        from: usize,
        at: usize,
    },
    /// The mouth of an alcove, by the index of its corridor.
    Mouth(usize),
    Blocked,
}

/// A way in this direction is taken for that of the robot, in radians.
const SAME_WAY: f64 = 0.6;
/// A robot this near to a place, or to the mouth of an alcove, can leave by it, in metres besides the clearance.
const AT_PLACE: f64 = 2.5;
/// A robot this far beside the middle of a corridor is in it, in metres besides half of its width.
const BESIDE: f64 = 0.3;
/// A leg is longer than this, in metres.
const SHORTEST: f64 = 0.3;
/// The distance from the robot's centre to a wall before which it stops, and the step in which it looks for it, in
/// metres.
const RADIUS: f64 = 0.4;
const STEP: f64 = 0.1;

impl<'w> CorridorPilot<'w> {
    pub(super) fn new(world: &'w CorridorWorld) -> Self {
        Self { world, floor: world.plan.floor() }
    }

    /// The way of a robot at a point that leaves in a direction: the corridor or the alcove that begins in about this
    /// direction, or the free floor up to a wall.
    pub(super) fn leave(&self, from: Point2<f64>, towards: f64) -> PilotLeg {
        let world = self.world;
        let mut ways: Vec<(f64, PilotLeg)> = Vec::new();
        let off = |ahead: f64| wrapped(ahead - towards).abs();
        for (&[one, other], corridor) in world.links.iter().zip(&world.plan.corridors) {
            for [begin, at] in [[one, other], [other, one]] {
                let (start, end) = (world.places[begin], world.places[at]);
                let is_at_place = distance(from, start) < world.clearance(begin) + AT_PLACE;
                if distance(from, end) > SHORTEST && (is_at_place || is_within(corridor, from)) {
                    let leg = PilotLeg { to: end, next: LegEnd::Place { from: begin, at } };
                    ways.push((off(direction(start, end)), leg));
                }
            }
        }
        let alcoves = world.plan.corridors.iter().enumerate().skip(world.links.len());
        for (number, alcove) in alcoves {
            if distance(from, alcove.ends[0]) < AT_PLACE {
                let leg = PilotLeg { to: alcove.ends[0], next: LegEnd::Mouth(number) };
                ways.push((off(alcove.direction()), leg));
            }
        }
        let way = nearest(ways, |way| way.0).filter(|way| way.0 < SAME_WAY);
        way.map_or_else(|| self.ahead(from, towards), |(_, leg)| leg)
    }

    /// Straight on up to a wall.
    fn ahead(&self, from: Point2<f64>, towards: f64) -> PilotLeg {
        let at = |length: f64| from + length * unit(towards);
        let steps = (0_u32..).map(|step| STEP * f64::from(step));
        let free = steps.take_while(|&length| self.is_floor(at(length + RADIUS))).last();
        PilotLeg { to: at(free.unwrap_or_default()), next: LegEnd::Blocked }
    }

    /// The leg after one: through a bend, past a junction as straight on as possible; `None` if the robot cannot go on.
    pub(super) fn after(&self, leg: &PilotLeg) -> Option<PilotLeg> {
        match leg.next {
            LegEnd::Blocked => None,
            LegEnd::Mouth(alcove) => {
                let to = self.world.plan.corridors[alcove].ends[1];
                Some(PilotLeg { to, next: LegEnd::Blocked })
            }
            LegEnd::Place { from, at } => {
                let [start, end] = [from, at].map(|place| self.world.places[place]);
                let ahead = direction(start, end);
                let others = self.world.arms(at).into_iter().filter(|arm| arm.to != from);
                let on = nearest(others, |arm| wrapped(arm.direction - ahead).abs())?;
                let next = LegEnd::Place { from: at, at: on.to };
                Some(PilotLeg { to: self.world.places[on.to], next })
            }
        }
    }

    pub(super) fn has_space_at(&self, point: Point2<f64>) -> bool {
        let [along, across] = [Vector2::new(RADIUS, 0.0), Vector2::new(0.0, RADIUS)];
        [along, -along, across, -across].into_iter().all(|off| self.is_floor(point + off))
    }

    fn is_floor(&self, point: Point2<f64>) -> bool {
        self.floor.iter().any(|piece| piece.holds(point))
    }
}

impl PilotLeg {
    /// Whether the robot passes a junction at its end.
    pub(super) fn ends_at_junction(&self, world: &CorridorWorld) -> bool {
        matches!(self.next, LegEnd::Place { at, .. } if world.is_junction(at))
    }
}

/// Whether a point is within a corridor or a little beside it.
fn is_within(corridor: &Corridor, point: Point2<f64>) -> bool {
    ConvexPolygon::along(corridor.ends, corridor.width + 2.0 * BESIDE, BESIDE).holds(point)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use toposlam_vision::laser::params::ArmParams;

    use super::{super::corridor_world::BuildingKind, *};

    fn worlds() -> impl Iterator<Item = CorridorWorld> {
        let kinds = [BuildingKind::Mixed, BuildingKind::Long, BuildingKind::Diagonal];
        kinds
            .into_iter()
            .flat_map(|kind| (0..40).map(move |seed| CorridorWorld::random(kind, seed)))
    }

    #[test]
    fn a_robot_that_leaves_by_an_arm_comes_to_its_other_end_and_in_an_alcove_not_so_far() {
        let mut alcoves = 0;
        for world in worlds() {
            let pilot = CorridorPilot::new(&world);
            for place in 0..world.places.len() {
                for arm in world.arms(place) {
                    for off in [-0.3, 0.0, 0.3] {
                        let leg = pilot.leave(world.places[place], arm.direction + off);
                        assert_eq!(leg.to, world.places[arm.to]);
                    }
                }
            }
            for alcove in &world.plan.corridors[world.links.len()..] {
                // From the middle of the corridor.
                let begin = alcove.point(-alcove.width / 2.0, 0.0);
                let into = pilot.leave(begin, alcove.direction());
                let end = pilot.after(&into).unwrap();
                assert_eq!(end.to, alcove.ends[1]);
                assert_eq!(pilot.after(&end), None);
                assert!(distance(begin, end.to) < ArmParams::default().min_arm);
                alcoves += 1;
            }
            // Where there is no way it stops before the wall.
            for corridor in &world.plan.corridors[..world.links.len()] {
                let middle = corridor.point(corridor.length() / 4.0, 0.0);
                for across in [PI / 2.0, -PI / 2.0] {
                    let leg = pilot.leave(middle, corridor.direction() + across);
                    if leg.next == LegEnd::Blocked {
                        assert!(distance(middle, leg.to) < corridor.width / 2.0);
                        assert_eq!(pilot.after(&leg), None);
                    }
                }
            }
        }
        assert!(alcoves > 50, "{alcoves}");
    }
}
