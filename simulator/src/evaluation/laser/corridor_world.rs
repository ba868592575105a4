//! Random buildings for laser scanners: corridors at any angle and of different widths, junctions with up to
//! five doors, bends, dead ends, alcoves and round lobbies.
//!
//! Corridors join neighbours in a lattice whose points are moved a little. Every corridor is longer than the 10 m
//! that make an arm of a junction.

use std::f64::consts::{SQRT_2, TAU};

use nalgebra::{Point2, Rotation2};
use rand::{RngExt, SeedableRng, seq::IndexedRandom};
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_model::{driving::scene::wrapped, embedded_graph::EmbeddedGraph};
use toposlam_vision::geometry::{direction, distance};

use crate::{Corridor, CorridorPlan, Lobby};

/// A building whose graph is known.
#[derive(Clone, Debug, PartialEq)]
pub struct CorridorWorld {
    /// Where corridors end, in metres.
    pub places: Vec<Point2<f64>>,
    /// The places that each corridor joins.
    pub links: Vec<[usize; 2]>,
    /// The corridors, in the order of the links; then the alcoves. The lobbies.
    pub plan: CorridorPlan,
}

/// A corridor that begins at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CorridorArm {
    pub to: usize,
    pub direction: f64,
    pub width: f64,
}

/// The graph of a building's junctions and dead ends. Its bends are no vertices.
#[derive(Debug)]
pub(super) struct SmoothedWorld {
    pub(super) graph: EmbeddedGraph,
    /// For each dart, the places from and to which its first corridor leads.
    pub(super) corridors: Vec<[usize; 2]>,
}

/// The kind of a random building.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "evaluate", derive(clap::ValueEnum))]
pub enum BuildingKind {
    /// Corridors of 11 to 24 m that meet at right angles, or at 60 and 120 degrees, and near these
    Mixed,
    /// Corridors of 20 to 55 m with loops
    Long,
    /// Corridors of 11 to 35 m that bend by 45 degrees, and fork
    Diagonal,
}

/// Least and greatest distance of neighbouring points, in metres.
const SPACING: [f64; 2] = [16.0, 22.0];
/// The same in a building with long corridors.
const LONG_SPACING: [f64; 2] = [28.0, 45.0];
/// Least and greatest number of corridors.
const CORRIDORS: [usize; 2] = [6, 14];
/// The greatest number of doors.
const MOST_ARMS: usize = 5;
/// The least angle between two arms, in radians.
const LEAST_ANGLE: f64 = 0.9;
/// Least and greatest width, in metres.
const WIDTHS: [f64; 2] = [1.65, 2.4];
/// The greatest length of an alcove from the middle of its corridor, in metres. At 10 m it would be an arm.
const ALCOVE: f64 = 7.5;

/// Points, those that may be joined, and how far they may be moved, as a part of their distance.
struct Lattice {
    points: Vec<Point2<f64>>,
    pairs: Vec<[usize; 2]>,
    moved: f64,
}

impl CorridorWorld {
    /// The greatest width of a corridor, in metres.
    pub const WIDEST: f64 = WIDTHS[1];

    /// The random building of a kind and a seed. It has a junction with at least three doors.
    pub fn random(kind: BuildingKind, seed: u64) -> Self {
        let mut chance = Xoshiro256PlusPlus::seed_from_u64(seed);
        loop {
            let world = Self::drawn(kind, &mut chance);
            if (0..world.places.len()).any(|place| world.is_junction(place)) {
                return world;
            }
        }
    }

    fn drawn(kind: BuildingKind, chance: &mut Xoshiro256PlusPlus) -> Self {
        let lattice = match kind {
            BuildingKind::Mixed => match chance.random_range(0..3) {
                0 => Lattice::square(),
                1 => Lattice::triangular(|_, _| true),
                _ => Lattice::triangular(|x, y| (x + 2 * y) % 3 != 0),
            },
            BuildingKind::Long => Lattice::square(),
            BuildingKind::Diagonal => Lattice::with_diagonals(),
        };
        let [least, most] = match kind {
            BuildingKind::Long => LONG_SPACING,
            BuildingKind::Mixed | BuildingKind::Diagonal => SPACING,
        };
        let spacing = chance.random_range(least..most);
        let turn = Rotation2::new(chance.random_range(0.0..TAU));
        let mut place = |point: &Point2<f64>| {
            let moved = point.map(|part| part + lattice.moved * chance.random_range(-1.0..=1.0));
            turn * moved.map(|part| spacing * part)
        };
        let places: Vec<Point2<f64>> = lattice.points.iter().map(&mut place).collect();
        let links = grown(&places, &lattice.pairs, chance);
        let plan = planned(&places, &links, chance);
        Self { places, links, plan }
    }

    /// Whether a place has at least three doors.
    pub(super) fn is_junction(&self, place: usize) -> bool {
        self.arms(place).len() >= 3
    }

    /// The corridors that begin at a place, clockwise.
    pub fn arms(&self, place: usize) -> Vec<CorridorArm> {
        let arm = |(&link, corridor): (&[usize; 2], &Corridor)| {
            let to = other_end(link, place)?;
            let direction = direction(self.places[place], self.places[to]);
            Some(CorridorArm { to, direction, width: corridor.width })
        };
        let mut arms: Vec<_> =
            self.links.iter().zip(&self.plan.corridors).filter_map(arm).collect();
        arms.sort_by(|one, other| other.direction.total_cmp(&one.direction));
        arms
    }

    /// The corridors that begin at a place, clockwise from the one to another place.
    pub fn arms_from(&self, place: usize, from: usize) -> Vec<CorridorArm> {
        let mut arms = self.arms(place);
        let entry = arms.iter().position(|arm| arm.to == from).unwrap_or_default();
        arms.rotate_left(entry);
        arms
    }

    /// The graph of its junctions and dead ends.
    pub(super) fn smoothed(&self) -> Option<SmoothedWorld> {
        let mut corridors = Vec::new();
        let mut lists = Vec::new();
        for place in 0..self.places.len() {
            let arms = self.arms(place);
            corridors.extend(arms.iter().map(|arm| [place, arm.to]));
            if !arms.is_empty() {
                let neighbours: Vec<_> = arms.iter().map(|arm| arm.to.to_string()).collect();
                lists.push((place.to_string(), neighbours));
            }
        }
        let (graph, darts) = EmbeddedGraph::from_neighbour_lists(&lists).ok()?.smoothed();
        let corridors = darts.into_iter().map(|dart| corridors[dart.at()]).collect();
        Some(SmoothedWorld { graph, corridors })
    }

    /// The radius of the free circle around a place, in metres.
    pub fn clearance(&self, place: usize) -> f64 {
        let lobby = self.lobby(place).map(|lobby| lobby.radius);
        let widest = self.arms(place).iter().map(|arm| arm.width / 2.0).fold(0.0, f64::max);
        lobby.unwrap_or(widest)
    }

    pub fn is_lobby(&self, place: usize) -> bool {
        self.lobby(place).is_some()
    }

    fn lobby(&self, place: usize) -> Option<&Lobby> {
        let middle = self.places[place];
        self.plan.lobbies.iter().find(|lobby| distance(lobby.middle, middle) < 0.1)
    }
}

impl Lattice {
    fn square() -> Self {
        let points = (0..12).map(|number| Point2::new(number % 4, number / 4).map(f64::from));
        Self::near(points.collect(), 0.12)
    }

    /// The same, and one diagonal of each square may be a corridor, too.
    fn with_diagonals() -> Self {
        let square = Self::square();
        let is_even = |point: usize| point.is_multiple_of(2) == (point / 4).is_multiple_of(2);
        let diagonals =
            pairs_at(&square.points, SQRT_2).into_iter().filter(|pair| is_even(pair[0]));
        let pairs = square.pairs.iter().copied().chain(diagonals).collect();
        Self { pairs, ..square }
    }

    /// Points of the triangular lattice; those that leave out every third are corners of hexagons.
    fn triangular(is_point: fn(i32, i32) -> bool) -> Self {
        let all = (0..4).flat_map(|row| (0..5).map(move |column| (column, row)));
        let kept = all.filter(|&(column, row)| is_point(column, row));
        let height = 0.75_f64.sqrt();
        let point = |(column, row): (i32, i32)| {
            Point2::new(f64::from(column) + 0.5 * f64::from(row), height * f64::from(row))
        };
        Self::near(kept.map(point).collect(), 0.05)
    }

    /// Points at a distance of 1 may be joined.
    fn near(points: Vec<Point2<f64>>, moved: f64) -> Self {
        Self { pairs: pairs_at(&points, 1.0), points, moved }
    }
}

/// The pairs of points with this distance.
fn pairs_at(points: &[Point2<f64>], apart: f64) -> Vec<[usize; 2]> {
    let pairs = (0..points.len()).flat_map(|one| (0..one).map(move |other| [one, other]));
    let is_at =
        |[one, other]: &[usize; 2]| (distance(points[*one], points[*other]) - apart).abs() < 0.01;
    pairs.filter(is_at).collect()
}

/// Connected links.
fn grown(
    places: &[Point2<f64>],
    pairs: &[[usize; 2]],
    chance: &mut Xoshiro256PlusPlus,
) -> Vec<[usize; 2]> {
    let wanted = chance.random_range(CORRIDORS[0]..=CORRIDORS[1]);
    let mut links: Vec<[usize; 2]> = Vec::new();
    let fits = |links: &[[usize; 2]], pair: [usize; 2]| {
        pair.into_iter().zip([pair[1], pair[0]]).all(|(here, there)| {
            let ahead = direction(places[here], places[there]);
            let arms: Vec<_> = links.iter().filter_map(|&link| other_end(link, here)).collect();
            let is_apart = |&to: &usize| {
                wrapped(direction(places[here], places[to]) - ahead).abs() >= LEAST_ANGLE
            };
            arms.iter().all(is_apart) && arms.len() < MOST_ARMS
        })
    };
    for _ in 0..40 * wanted {
        let Some(&pair) = pairs.choose(chance) else { break };
        let is_joined = links.is_empty()
            || links.iter().any(|link| pair.iter().any(|place| link.contains(place)));
        if is_joined && !links.contains(&pair) && fits(&links, pair) {
            links.push(pair);
        }
        if links.len() == wanted {
            break;
        }
    }
    links
}

/// The corridors of links, alcoves and lobbies.
fn planned(
    places: &[Point2<f64>],
    links: &[[usize; 2]],
    chance: &mut Xoshiro256PlusPlus,
) -> CorridorPlan {
    let usual = chance.random_range(WIDTHS[0]..WIDTHS[1]);
    let is_varied = chance.random::<bool>();
    let corridor = |&[one, other]: &[usize; 2]| {
        let width = if is_varied { chance.random_range(WIDTHS[0]..WIDTHS[1]) } else { usual };
        Corridor { ends: [places[one], places[other]], width }
    };
    let corridors: Vec<Corridor> = links.iter().map(corridor).collect();
    let mut plan = CorridorPlan { corridors, lobbies: Vec::new() };
    let often = if chance.random() { 0.5 } else { 0.0 };
    for (place, &middle) in places.iter().enumerate() {
        let at = links.iter().zip(&plan.corridors).filter(|(link, _)| link.contains(&place));
        let (count, widest) = at.fold((0, 0.0_f64), |(count, widest), (_, corridor)| {
            (count + 1, widest.max(corridor.width))
        });
        let radius = widest / 2.0 * chance.random_range(1.2..2.0);
        if chance.random::<f64>() < often && count >= 3 {
            plan.lobbies.push(Lobby { middle, radius });
        }
    }
    for number in 0..links.len() {
        let corridor = plan.corridors[number];
        let along = corridor.length() * chance.random_range(0.35..0.65);
        let side = if chance.random() { 1.0 } else { -1.0 };
        let deep = chance.random_range(2.5..ALCOVE);
        let width = chance.random_range(1.2..2.2);
        // Its floor begins in the middle of the corridor.
        let ends = [width / 2.0, deep].map(|left| corridor.point(along, side * left));
        let alcove = Corridor { ends, width };
        let others = plan.floor();
        let mut others = others.iter().enumerate().filter(|&(other, _)| other != number);
        if chance.random::<f64>() < 0.25 && others.all(|(_, other)| !other.meets(&alcove.floor())) {
            plan.corridors.push(alcove);
        }
    }
    plan
}

fn other_end([one, other]: [usize; 2], place: usize) -> Option<usize> {
    match place {
        _ if place == one => Some(other),
        _ if place == other => Some(one),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use std::{collections::BTreeSet, f64::consts::FRAC_PI_2};

    use super::*;

    fn worlds(kind: BuildingKind, count: u64) -> impl Iterator<Item = CorridorWorld> {
        (0..count).map(move |seed| CorridorWorld::random(kind, seed))
    }

    #[test]
    fn corridors_are_longer_than_an_arm_and_apart_from_each_other_and_alcoves_are_shorter() {
        let others = [BuildingKind::Long, BuildingKind::Diagonal];
        let others = others.into_iter().flat_map(|kind| worlds(kind, 100));
        for world in worlds(BuildingKind::Mixed, 300).chain(others) {
            let floor = world.plan.floor();
            let (corridors, alcoves) = world.plan.corridors.split_at(world.links.len());
            for (number, link) in world.links.iter().enumerate() {
                assert!(corridors[number].length() > 11.5, "{:?}", corridors[number]);
                for (other, other_link) in world.links.iter().enumerate().take(number) {
                    let meet = link.iter().any(|place| other_link.contains(place));
                    assert!(meet || !floor[number].meets(&floor[other]));
                }
            }
            for alcove in alcoves {
                assert!(alcove.length() + alcove.width / 2.0 < 9.0);
            }
        }
    }

    #[test]
    fn worlds_have_every_degree_any_angle_lobbies_and_alcoves() {
        let (mut degrees, mut slants) = (BTreeSet::new(), BTreeSet::new());
        let (mut lobbies, mut alcoves) = (0, 0);
        for world in worlds(BuildingKind::Mixed, 300) {
            lobbies += world.plan.lobbies.len();
            alcoves += world.plan.corridors.len() - world.links.len();
            for corridor in &world.plan.corridors {
                let slant = corridor.direction().rem_euclid(FRAC_PI_2);
                slants.insert((slant.to_degrees() / 10.0) as u32);
            }
            for place in 0..world.places.len() {
                let arms = world.arms(place);
                degrees.insert(arms.len());
                for (number, arm) in arms.iter().enumerate() {
                    for other in &arms[..number] {
                        let apart = wrapped(arm.direction - other.direction).abs();
                        assert!(apart >= LEAST_ANGLE, "{apart}");
                    }
                }
            }
        }
        assert!((1..=5).all(|degree| degrees.contains(&degree)), "{degrees:?}");
        assert_eq!(slants.len(), 9, "{slants:?}");
        assert!(lobbies > 50 && alcoves > 100, "{lobbies} {alcoves}");
    }

    #[test]
    fn the_darts_of_the_graph_are_the_corridors_at_junctions_and_dead_ends_clockwise() {
        for world in worlds(BuildingKind::Mixed, 200) {
            let SmoothedWorld { graph, corridors } = world.smoothed().unwrap();
            assert_eq!(graph.genus(), 0, "a plan is planar");
            for dart in graph.darts() {
                let [place, to] = corridors[dart.at()];
                let arms = world.arms_from(place, to);
                assert_ne!(arms.len(), 2, "a bend");
                assert_eq!(graph.degree_around(dart) as usize, arms.len());
                let next = arms[1 % arms.len()].to;
                assert_eq!(corridors[graph.clockwise(dart).at()], [place, next]);
            }
        }
    }

    #[test]
    fn corridors_are_long_or_bend_by_half_a_right_angle() {
        for world in worlds(BuildingKind::Long, 100) {
            let corridors = &world.plan.corridors[..world.links.len()];
            assert!(corridors.iter().all(|corridor| corridor.length() > 20.0));
        }
        let is_slanted = |world: &CorridorWorld| {
            (0..world.places.len()).any(|place| {
                let [one, other] = world.arms(place)[..] else { return false };
                let bend = wrapped(one.direction - other.direction).abs().to_degrees();
                (125.0..145.0).contains(&bend)
            })
        };
        assert!(worlds(BuildingKind::Diagonal, 100).filter(is_slanted).count() > 30);
    }
}
