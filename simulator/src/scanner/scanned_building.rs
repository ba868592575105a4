//! A building as a laser scanner sees it: walls, some of them of glass or black, rooms behind open doors,
//! furniture, and people.

use std::f64::consts::TAU;

use rand::RngExt;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{
    corridors::{Corridor, CorridorPlan},
    params::ScannerParams,
    polygon::{ConvexPolygon, Segment, border, length, part},
};
use crate::render::{StreamPurpose, about, stream};

/// A building as a laser scanner sees it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ScannedBuilding {
    /// In pieces of one surface each.
    walls: Vec<ScannedWall>,
    furniture: Vec<ConvexPolygon>,
    people: Vec<Person>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ScannedWall {
    pub(super) ends: Segment,
    pub(super) surface: WallSurface,
}

/// What a laser scanner sees of a wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WallSurface {
    /// It reflects any ray.
    Plain,
    /// It reflects a ray at a right angle.
    Glass,
    /// It reflects from nearby.
    Black,
}

/// Somebody who walks back and forth in a corridor.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Person {
    corridor: Corridor,
    /// To the left of the middle, in metres.
    left: f64,
    /// Metres a second.
    speed: f64,
    /// How far he has come at time 0, in metres.
    come: f64,
}

/// The width of the open door of a room, and the depth of a wall, in metres.
const DOOR: f64 = 0.9;
const WALL: f64 = 0.15;
/// The room between a door or a piece of furniture and the end of a corridor, besides its width, in metres.
const FROM_END: f64 = 1.0;
/// The greatest depth of furniture in a corridor, as a part of the corridor's width.
const DEEPEST: f64 = 0.2;
/// The length of a step, the distance of the feet, and the radius of a leg, in metres.
const STEP: f64 = 1.4;
const FEET: f64 = 0.2;
const LEG: f64 = 0.07;

/// A room: the gap in the wall, and what is behind it.
struct Room {
    gap: ConvexPolygon,
    floor: ConvexPolygon,
    furniture: Vec<ConvexPolygon>,
}

impl ScannedBuilding {
    /// The building of a plan. The same seed gives the same building.
    pub(super) fn new(plan: &CorridorPlan, params: &ScannerParams, seed: u64) -> Self {
        let mut floor = plan.floor();
        let mut furniture = Vec::new();
        for (number, corridor) in plan.corridors.iter().enumerate() {
            let mut chance = stream(seed, StreamPurpose::Rooms, number);
            for _ in 0..about(params.doors * corridor.length() / 10.0, &mut chance) {
                if let Some(room) = room(corridor, number, &floor, &mut chance) {
                    floor.extend([room.gap, room.floor]);
                    furniture.extend(room.furniture);
                }
            }
        }
        for (number, corridor) in plan.corridors.iter().enumerate() {
            let mut chance = stream(seed, StreamPurpose::Furniture, number);
            for _ in 0..about(params.furniture * corridor.length() / 10.0, &mut chance) {
                furniture.extend(beside_wall(corridor, number, &floor, &mut chance));
            }
        }
        let mut walls = Vec::new();
        for (number, (polygon, wall)) in border(&floor).into_iter().enumerate() {
            if polygon < plan.corridors.len() {
                let mut chance = stream(seed, StreamPurpose::Surfaces, number);
                walls.extend(surfaces(wall, params, &mut chance));
            } else {
                walls.push(ScannedWall { ends: wall, surface: WallSurface::Plain });
            }
        }
        let people = people(plan, params, &mut stream(seed, StreamPurpose::People, 0));
        Self { walls, furniture, people }
    }

    /// Everything that a ray may meet at a time, in seconds.
    pub(super) fn surfaces(&self, time: f64) -> impl Iterator<Item = ScannedWall> + '_ {
        let plain = |ends: Segment| ScannedWall { ends, surface: WallSurface::Plain };
        let furniture = self.furniture.iter().flat_map(ConvexPolygon::sides).map(plain);
        let legs = self.people.iter().flat_map(move |person| person.legs(time));
        let legs = legs.flat_map(move |leg| leg.sides().map(plain).collect::<Vec<_>>());
        self.walls.iter().copied().chain(furniture).chain(legs)
    }
}

/// A room at a random place along a corridor; `None` if there is no space for it.
fn room(
    corridor: &Corridor,
    number: usize,
    floor: &[ConvexPolygon],
    chance: &mut Xoshiro256PlusPlus,
) -> Option<Room> {
    let (along, side) = place_in(corridor, DOOR / 2.0, chance)?;
    let [wide, deep] = [chance.random_range(3.0..6.0), chance.random_range(3.0..5.0)];
    let aside = (wide / 2.0 - DOOR) * chance.random_range(-1.0..=1.0);
    let wall = corridor.width / 2.0;
    let direction = corridor.direction();
    let inside = |along: f64, depth: f64| corridor.point(along, side * (wall + WALL + depth));
    let middle = inside(along + aside, deep / 2.0);
    let half = [wide / 2.0, deep / 2.0];
    // The gap reaches into the corridor and into the room.
    let gap = ConvexPolygon::rectangle(inside(along, -WALL / 2.0), [DOOR / 2.0, WALL], direction);
    let with_walls = half.map(|half| half + WALL / 2.0);
    let with_walls = ConvexPolygon::rectangle(middle, with_walls, direction);
    let is_free = floor.iter().enumerate().all(|(other, polygon)| {
        !polygon.meets(&with_walls) && (other == number || !polygon.meets(&gap))
    });
    if !is_free {
        return None;
    }
    let mut furniture = Vec::new();
    for _ in 0..chance.random_range(1..=3) {
        let half_sides = [(); 2].map(|()| chance.random_range(0.15..0.5));
        let [across, depth] = [chance.random_range(-0.8..0.8), chance.random_range(0.4..0.85)];
        let place = inside(along + aside + across * half[0], depth * deep);
        furniture.push(ConvexPolygon::rectangle(place, half_sides, chance.random_range(0.0..TAU)));
    }
    let floor = ConvexPolygon::rectangle(middle, half, direction);
    Some(Room { gap, floor, furniture })
}

/// A piece of furniture at a wall of a corridor; `None` if something else is there.
fn beside_wall(
    corridor: &Corridor,
    number: usize,
    floor: &[ConvexPolygon],
    chance: &mut Xoshiro256PlusPlus,
) -> Option<ConvexPolygon> {
    let half = chance.random_range(0.2..0.7);
    let depth = chance.random_range(0.2..0.45_f64).min(DEEPEST * corridor.width);
    let (along, side) = place_in(corridor, half, chance)?;
    let middle = corridor.point(along, side * (corridor.width - depth) / 2.0);
    let piece = ConvexPolygon::rectangle(middle, [half, depth / 2.0], corridor.direction());
    let others = floor.iter().enumerate().filter(|&(other, _)| other != number);
    others.into_iter().all(|(_, other)| !other.meets(&piece)).then_some(piece)
}

/// A random place along a corridor for something with this half length, and the side: 1 is the left one.
fn place_in(corridor: &Corridor, half: f64, chance: &mut Xoshiro256PlusPlus) -> Option<(f64, f64)> {
    let from_end = corridor.width / 2.0 + FROM_END + half;
    let free = corridor.length() - 2.0 * from_end;
    let (share, is_left) = (chance.random::<f64>(), chance.random::<bool>());
    (free > 0.0).then(|| (from_end + share * free, if is_left { 1.0 } else { -1.0 }))
}

/// A wall with its stretches of glass and its black ones.
fn surfaces(
    wall: Segment,
    params: &ScannerParams,
    chance: &mut Xoshiro256PlusPlus,
) -> Vec<ScannedWall> {
    let whole = length(wall);
    let mut stretches: Vec<(f64, f64, WallSurface)> = Vec::new();
    for (often, surface, least, greatest) in
        [(params.glass, WallSurface::Glass, 1.0, 3.0), (params.black, WallSurface::Black, 0.5, 1.5)]
    {
        for _ in 0..about(often * whole / 10.0, chance) {
            let long: f64 = chance.random_range(least..greatest);
            let from = chance.random::<f64>() * (whole - long);
            let meets =
                |&(other, to, _): &(f64, f64, WallSurface)| from < to && other < from + long;
            if from >= 0.0 && !stretches.iter().any(meets) {
                stretches.push((from, from + long, surface));
            }
        }
    }
    stretches.sort_by(|one, other| one.0.total_cmp(&other.0));
    let mut pieces = Vec::new();
    let mut piece = |from: f64, to: f64, surface| {
        if to > from {
            pieces.push(ScannedWall { ends: part(wall, from / whole, to / whole), surface });
        }
    };
    let mut done = 0.0;
    for (from, to, surface) in stretches {
        piece(done, from, WallSurface::Plain);
        piece(from, to, surface);
        done = to;
    }
    piece(done, whole, WallSurface::Plain);
    pieces
}

fn people(
    plan: &CorridorPlan,
    params: &ScannerParams,
    chance: &mut Xoshiro256PlusPlus,
) -> Vec<Person> {
    let total: f64 = plan.corridors.iter().map(Corridor::length).sum();
    let count = about(params.people * total / 100.0, chance);
    let mut people = Vec::new();
    for _ in 0..count {
        // Long corridors have more of them.
        let mut place = chance.random::<f64>() * total;
        let corridor = plan.corridors.iter().find(|corridor| {
            place -= corridor.length();
            place <= 0.0
        });
        let Some(&corridor) = corridor else { continue };
        people.push(Person {
            corridor,
            left: 0.25 * corridor.width * chance.random_range(-1.0..=1.0),
            speed: chance.random_range(0.8..1.5),
            come: 2.0 * corridor.length() * chance.random::<f64>(),
        });
    }
    people
}

impl Person {
    fn legs(&self, time: f64) -> [ConvexPolygon; 2] {
        let come = self.come + self.speed * time;
        let there = self.corridor.length();
        let along = come.rem_euclid(2.0 * there);
        let along = if along > there { 2.0 * there - along } else { along };
        let swing = 0.25 * STEP * (TAU * come / STEP).sin();
        [1.0, -1.0].map(|side| {
            let left = self.left + side * FEET / 2.0;
            ConvexPolygon::round(self.corridor.point(along + side * swing, left), LEG, 8)
        })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Point2, center};

    use super::*;

    fn corridor() -> CorridorPlan {
        let corridors =
            vec![Corridor { ends: [Point2::new(0.0, 0.0), Point2::new(40.0, 0.0)], width: 2.0 }];
        CorridorPlan { corridors, lobbies: Vec::new() }
    }

    fn total(building: &ScannedBuilding, surface: WallSurface) -> f64 {
        let walls = building.walls.iter().filter(|wall| wall.surface == surface);
        walls.map(|wall| length(wall.ends)).sum()
    }

    #[test]
    fn an_open_door_is_a_gap_of_90_cm_with_a_room_behind_it() {
        let params = ScannerParams { doors: 0.25, ..ScannerParams::PLAIN };
        let building = ScannedBuilding::new(&corridor(), &params, 3);
        let on_wall =
            |wall: &&ScannedWall| wall.ends.iter().all(|end| (end.y.abs() - 1.0).abs() < 1e-6);
        let walls: f64 = building.walls.iter().filter(on_wall).map(|w| length(w.ends)).sum();
        // One door in 40 m; the walls at both ends are 2 m wide.
        assert!((walls - (84.0 + 4.0 - 0.9)).abs() < 1e-4, "{walls}");
        let depth = |wall: &ScannedWall| wall.ends.map(|end| end.y.abs());
        let deepest = building.walls.iter().flat_map(depth).fold(0.0, f64::max);
        assert!((4.1..6.2).contains(&deepest), "{deepest}");
        assert!(!building.furniture.is_empty());
    }

    #[test]
    fn glass_and_black_walls_are_as_frequent_as_asked() {
        let params = ScannerParams { glass: 0.5, black: 1.0, ..ScannerParams::PLAIN };
        let mut lengths = [0.0; 3];
        for seed in 0..200 {
            let building = ScannedBuilding::new(&corridor(), &params, seed);
            let kinds = [WallSurface::Plain, WallSurface::Glass, WallSurface::Black];
            for (sum, surface) in lengths.iter_mut().zip(kinds) {
                *sum += total(&building, surface) / 200.0;
            }
        }
        assert!((lengths.iter().sum::<f64>() - 88.0).abs() < 1e-6, "{lengths:?}");
        // In 88 m: 4.4 stretches of 2 m, 8.8 of 1 m; some are left out because they would overlap.
        assert!(
            (7.0..8.9).contains(&lengths[1]) && (6.5..8.9).contains(&lengths[2]),
            "{lengths:?}"
        );
    }

    #[test]
    fn furniture_leaves_the_middle_of_the_corridor_free() {
        let params = ScannerParams { furniture: 5.0, ..ScannerParams::PLAIN };
        let building = ScannedBuilding::new(&corridor(), &params, 1);
        assert!(building.furniture.len() >= 18, "{}", building.furniture.len());
        for corner in building.furniture.iter().flat_map(ConvexPolygon::sides).flatten() {
            assert!((0.6 - 1e-9..=1.0 + 1e-9).contains(&corner.y.abs()), "{corner:?}");
        }
    }

    #[test]
    fn people_walk_to_and_fro() {
        let corridor = corridor().corridors[0];
        let person = Person { corridor, left: 0.3, speed: 1.25, come: 0.0 };
        let at = |time: f64| {
            let feet = person.legs(time).map(|leg| leg.sides().next().unwrap()[0]);
            center(&feet[0], &feet[1])
        };
        for (time, x) in [(0.0, 0.0), (8.0, 10.0), (32.0, 40.0), (40.0, 30.0), (64.0, 0.0)] {
            let off = at(time) - Point2::new(x + LEG, 0.3);
            assert!(off.amax() < 1e-9, "{time}: {off}");
        }
    }
}
