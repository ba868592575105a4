//! Agreement: an outline compared with what is seen on each bearing. Section 3.
//!
//! Floor behind a wall of an outline, or a wall where it has floor, contradicts it. A door of the floor's colour looks
//! like floor, too, but it is narrower than any hallway, and there is wall on both sides of it.

use nalgebra::{Point2, Vector2};

use crate::{
    bearing::{BEARINGS, direction},
    boundary::{Boundary, Edge, Sight},
    outline::{Outline, OutlineSide, near},
    wall::WallFrame,
};

/// Weight of a bearing on which the floor ends without a stripe, against 1 for one on which the wall is seen. Views.
const ENDED_WEIGHT: f64 = 0.5;
/// Weight of a bearing on which floor is seen behind a wall. Views.
const THROUGH_WEIGHT: f64 = 1.5;
/// Weight of a bearing on which a wall is seen in front of the outline. Views.
const AGAINST_WEIGHT: f64 = 3.0;
/// The most bearings with a wall in front of the outline, as a part of those in support. Views.
const MAX_AGAINST: f64 = 0.12;
/// Weight of a bearing on which a long wall is seen with floor behind it, for what agrees in its direction. Views: a wall
/// may have the floor's colour, but a straight cable looks like it.
const LONG_WEIGHT: f64 = 0.5;
/// Weight of a bearing on which floor is seen through a door, for what agrees in its direction. Views.
const DOOR_WEIGHT: f64 = 0.5;
/// The most bearings with doors, as a multiple of those in support. Views.
const MAX_DOORS: f64 = 2.0;
/// Walls farther away are not expected to be seen. Geometry: a pixel of the image covers as much there as a stripe.
const MAX_RANGE: f64 = 2.1;
/// A direction need not be seen if it has at most this part of all bearings. Views.
const NARROW: f64 = 0.02;
/// In any other direction, at least this part of the bearings must be seen. Views.
const MIN_DIRECTION_SEEN: f64 = 0.25;
/// Fewer bearings in a direction show nothing of it. Geometry: 3 degrees.
const FEW_BEARINGS: f64 = 6.0 / BEARINGS as f64;
/// A bearing is open if floor is seen for this part of the way. Views.
const OPEN: f64 = 0.8;
/// A gap in a wall is a door if it is narrower than this part of a hallway. Geometry.
pub(crate) const DOOR_WIDTH: f64 = 0.75;
/// Beside a door, this part of the usual distance is near: around the corner of an opening there is wall, too. Views.
const DOOR_NEAR: f64 = 0.5;
/// The length of wall that must be seen beside a door. Views.
const DOOR_WALL: f64 = 0.30;
/// The part of that wall's bearings on which it must be seen. Views.
const DOOR_WALL_SEEN: f64 = 0.75;

/// How an outline agrees with what is seen: the number of bearings of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OutlineAgreement {
    pub support: u32,
    /// The floor ends at the wall of the outline, but without a stripe: at a door or a gap.
    pub ended: u32,
    /// The outline has a wall, but nothing is seen there.
    pub silent: u32,
    /// Floor is seen behind a wall of the outline, through a door.
    pub door: u32,
    /// Floor is seen behind a wall of the outline, where there can be no door.
    pub through: u32,
    pub against: u32,
    /// The number of the four directions in which neither its wall nor its floor is seen.
    pub blank: u32,
    /// Of the four directions, the one in which least agrees: the part of its bearings on which its wall or its floor is
    /// seen, from 0 to 1. The walls of a hallway support a junction in it, too: only this shows whether an arm is there.
    pub least: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Held {
    Support,
    /// A long straight wall is seen where the outline has one, but floor behind it.
    Long,
    /// The wall of the outline may be seen, or something on the floor: floor is seen behind it.
    Doubtful,
    Ended,
    Silent,
    Through,
    Against,
    Door,
    Open,
    Unseen,
}

impl Outline {
    /// How the outline agrees with what is seen, on one bearing in `every`.
    pub fn agreement(
        &self,
        boundary: &Boundary,
        frame: &WallFrame,
        every: usize,
    ) -> OutlineAgreement {
        let mut agreement = OutlineAgreement::default();
        let mut towards = [Seen::default(); 4];
        let mut gap: Option<Gap> = None;
        for bearing in (0..BEARINGS).step_by(every) {
            let ray = frame.walls_from_robot() * direction(bearing);
            let sight = &boundary.sights[bearing];
            let Some((range, number)) = self.first_on(ray).filter(|&(range, _)| {
                range <= MAX_RANGE || sight.sure().is_some_and(|wall| wall <= MAX_RANGE)
            }) else {
                continue;
            };
            let side = &self.sides[number];
            let mut held = self.held(side, range, ray, sight);
            if held == Held::Through {
                let (along, _) = side.along.split();
                let at = range * ray[along];
                let in_gap = |gap: &Gap| gap.side == number && gap.from <= at && at <= gap.to;
                let around = gap
                    .filter(in_gap)
                    .unwrap_or_else(|| self.gap(number, bearing, at, boundary, frame));
                if around.to - around.from < DOOR_WIDTH * self.width {
                    held = Held::Door;
                }
                gap = Some(around);
            }
            let seen = &mut towards[side.towards];
            seen.all += 1;
            seen.doors += u32::from(held == Held::Door);
            seen.due += u32::from(held != Held::Door);
            match held {
                Held::Support | Held::Long | Held::Doubtful => agreement.support += 1,
                Held::Ended => agreement.ended += 1,
                Held::Silent => agreement.silent += 1,
                Held::Door => agreement.door += 1,
                Held::Through => agreement.through += 1,
                Held::Against => agreement.against += 1,
                Held::Open | Held::Unseen => {}
            }
            seen.visible += u32::from(matches!(
                held,
                Held::Support | Held::Long | Held::Doubtful | Held::Ended | Held::Open
            ));
            seen.agreeing += match held {
                Held::Support | Held::Open => 1.0,
                Held::Ended => ENDED_WEIGHT,
                Held::Long => LONG_WEIGHT,
                _ => 0.0,
            };
        }
        agreement.blank = towards.iter().filter(|seen| seen.is_blank(every)).count() as u32;
        agreement.least = towards.iter().map(|seen| seen.agreement(every)).fold(1.0, f64::min);
        agreement
    }

    /// What is seen on a bearing that first meets this side, at the range `at`.
    fn held(&self, side: &OutlineSide, at: f64, ray: Vector2<f64>, sight: &Sight) -> Held {
        // The distance of something in front of the side, perpendicular to it.
        let (_, across) = side.along.split();
        let before = |range: f64| (at - range) * ray[across].abs();
        let is_wall = side.is_wall();
        let fits = |edge: &Edge| {
            let near = near(edge.range);
            is_wall && before(edge.range).abs() < near
                || self.distance(Point2::from(edge.range * ray)) < near
        };
        match sight.edges().find(fits) {
            Some(edge) if edge.width * ray[across].abs() <= 1.0 => match (edge.clear, edge.sure) {
                (true, _) => Held::Support,
                (false, true) => Held::Long,
                (false, false) => Held::Doubtful,
            },
            // A wider edge is not a stripe, but a wall of its colour, or a shadow.
            Some(_) => Held::Silent,
            None if sight.sure().is_some_and(|wall| wall < at) => Held::Against,
            None if is_wall && before(sight.floor).abs() < near(at) => {
                if sight.hidden {
                    Held::Silent
                } else {
                    Held::Ended
                }
            }
            None if is_wall && before(sight.floor) < -near(at) => Held::Through,
            None if is_wall => Held::Silent,
            None if sight.floor >= OPEN * at => Held::Open,
            None => Held::Unseen,
        }
    }

    /// The gap in a wall through which floor is seen on a bearing: from the last place of the wall to
    /// the next. It is a door if it is narrower than a hallway.
    fn gap(
        &self,
        number: usize,
        bearing: usize,
        at: f64,
        boundary: &Boundary,
        frame: &WallFrame,
    ) -> Gap {
        let side = &self.sides[number];
        let (along, across) = side.along.split();
        // The place at which another bearing meets the wall, and whether the wall is seen there.
        let on_wall = |bearing: usize| {
            let ray = frame.walls_from_robot() * direction(bearing);
            let range = side.offset / ray[across];
            let off = |edge: Edge| ((edge.range - range) * ray[across]).abs();
            let seen = |edge: Edge| edge.sure && off(edge) < DOOR_NEAR * near(range);
            (range > 0.0 && range <= MAX_RANGE)
                .then(|| (range * ray[along], boundary.sights[bearing].edges().any(seen)))
        };
        let edge = |step: usize| {
            let nth = |steps: usize| on_wall((bearing + steps * step) % BEARINGS);
            (1..BEARINGS)
                .map_while(|steps| Some((steps, nth(steps)?)))
                .find(|&(steps, (_, seen))| seen && goes_on((steps..BEARINGS).map_while(nth)))
                .map(|(_, (on, _))| on)
        };
        let edges = [edge(1), edge(BEARINGS - 1)];
        // Bearings follow a wall in one direction or the other.
        let before = edges.iter().flatten().copied().filter(|&edge| edge <= at);
        let behind = edges.iter().flatten().copied().filter(|&edge| edge > at);
        Gap {
            side: number,
            from: before.fold(f64::NEG_INFINITY, f64::max),
            to: behind.fold(f64::INFINITY, f64::min),
        }
    }
}

/// Whether a wall goes on from the first of these places; each with whether the wall is seen there.
fn goes_on(wall: impl Iterator<Item = (f64, bool)>) -> bool {
    let mut wall = wall.peekable();
    let Some(&(first, _)) = wall.peek() else { return false };
    let (mut all, mut seen, mut length) = (0, 0, 0.0);
    for (on, is_seen) in wall.take_while(|(on, _)| (on - first).abs() <= DOOR_WALL) {
        (all, seen, length) = (all + 1, seen + u32::from(is_seen), (on - first).abs());
    }
    length >= 0.8 * DOOR_WALL && f64::from(seen) >= DOOR_WALL_SEEN * f64::from(all)
}

/// A gap in a side of an outline, from one place along it to another, in metres.
#[derive(Clone, Copy, Debug)]
struct Gap {
    side: usize,
    from: f64,
    to: f64,
}

/// The number of bearings in a direction: all, those on which something should be seen, those on which it is, and the
/// weight of those that agree.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    all: u32,
    /// Those that look through a door.
    doors: u32,
    /// The others.
    due: u32,
    visible: u32,
    agreeing: f64,
}

impl Seen {
    fn is_blank(self, every: usize) -> bool {
        let Self { due, visible, .. } = self;
        f64::from(due) > bearings(NARROW, every)
            && f64::from(visible) < MIN_DIRECTION_SEEN * f64::from(due)
    }

    /// The part of the bearings that agree; 0 if they are few. Doors count if they are in a wall that is seen.
    fn agreement(self, every: usize) -> f64 {
        let [all, doors] = [self.all, self.doors].map(f64::from);
        let doors = if doors <= MAX_DOORS * self.agreeing { DOOR_WEIGHT * doors } else { 0.0 };
        if all < bearings(FEW_BEARINGS, every) { 0.0 } else { (self.agreeing + doors) / all }
    }
}

impl OutlineAgreement {
    /// What supports the outline minus what contradicts it, which has more weight.
    pub fn balance(&self) -> f64 {
        self.good()
            - THROUGH_WEIGHT * f64::from(self.through)
            - AGAINST_WEIGHT * f64::from(self.against)
    }

    /// The part of what is seen that supports the outline, from 0 to 1.
    pub fn trust(&self) -> f64 {
        let good = self.good();
        good / (good + f64::from(self.through + self.against)).max(1.0)
    }

    /// The part of the outline's walls that is seen, from 0 to 1.
    pub fn cover(&self) -> f64 {
        let all = self.support + self.ended + self.silent + self.door + self.through + self.against;
        self.good() / f64::from(all.max(1))
    }

    /// How certain the place is, from 0 to 1.
    pub fn confidence(&self) -> f64 {
        self.trust() * self.cover().sqrt()
    }

    /// What supports the outline, as a number of bearings on which its wall is seen.
    pub fn good(&self) -> f64 {
        f64::from(self.support) + ENDED_WEIGHT * f64::from(self.ended)
    }

    /// Whether the trust is at least this, few bearings contradict the outline, and there is not
    /// much more door than wall.
    pub fn holds(&self, trust: f64) -> bool {
        let good = self.good();
        self.trust() >= trust
            && f64::from(self.against) <= MAX_AGAINST * good
            && f64::from(self.door) <= MAX_DOORS * good
    }
}

/// A part of all bearings, as a number of bearings, of which one in `every` is used.
pub fn bearings(part: f64, every: usize) -> f64 {
    part * (BEARINGS / every) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        colour::PixelClass,
        drawn_place::{self, DrawnPlace},
        ground_view::GroundView,
        outline::Square,
        wall::Axis,
    };

    const HALF: f64 = 0.8;
    const SQUARE: Square = Square { middle: Point2::new(0.0, 0.0), half: HALF - drawn_place::TAPE };

    fn seen(place: &DrawnPlace) -> Boundary {
        place.boundary([0.0, 0.0], 0.0)
    }

    fn agreement(outline: &Outline, boundary: &Boundary) -> OutlineAgreement {
        outline.agreement(boundary, &WallFrame::along(0.0), 1)
    }

    fn held(doors: [bool; 4], boundary: &Boundary) -> OutlineAgreement {
        agreement(&Outline::junction(doors, SQUARE), boundary)
    }

    #[test]
    fn the_walls_of_a_junction_support_its_own_outline_and_no_other() {
        let shapes: Vec<[bool; 4]> = (1..15_u32)
            .map(|shape| std::array::from_fn(|door| shape & 1 << door != 0))
            .filter(|doors: &[bool; 4]| *doors != [true, false, true, false])
            .filter(|doors| *doors != [false, true, false, true])
            .collect();
        for &doors in &shapes {
            let boundary = seen(&DrawnPlace::junction(doors, HALF));
            let own = held(doors, &boundary);
            assert!(own.trust() > 0.99 && own.cover() > 0.9, "{doors:?}: {own:?}");
            assert_eq!((own.against, own.blank), (0, 0), "{doors:?}");
            for other in shapes.iter().filter(|&&other| other != doors) {
                let agreement = held(*other, &boundary);
                assert!(!agreement.holds(0.85), "{other:?} at {doors:?}: {agreement:?}");
                assert!(agreement.balance() < own.balance() - 100.0, "{other:?} at {doors:?}");
            }
        }
    }

    #[test]
    fn floor_behind_a_door_is_not_an_opening_but_behind_a_gap_as_wide_as_a_hallway_it_is() {
        let outline = Outline::hallway(Axis::X, SQUARE, -0.6, 0.6);
        let beside = |gap: [f64; 2]| {
            let mut hallway = DrawnPlace::junction([true, false, true, false], HALF);
            hallway.floor.push([gap[0], 0.0, gap[1], 9.0]);
            agreement(&outline, &seen(&hallway))
        };
        for from in [-0.45, -0.2, 0.1] {
            let door = beside([from, from + 0.9]);
            assert_eq!(door.through, 0, "a door from {from}: {door:?}");
            assert!(door.door > 50, "a door from {from}: {door:?}");
        }
        let opening = beside([-HALF, HALF]);
        assert!(opening.through > 150 && !opening.holds(0.7), "{opening:?}");
    }

    #[test]
    fn a_wall_far_off_in_what_should_be_open_stands_against_it() {
        let dead_end = DrawnPlace::junction([false, false, true, false], HALF);
        let boundary = dead_end.boundary([-0.8, 0.0], 0.0);
        let square = Square { middle: Point2::new(0.8, 0.0), half: HALF - drawn_place::TAPE };
        let l = Outline::junction([false, true, true, false], square);
        let agreement = agreement(&l, &boundary);
        assert!(agreement.against > 60, "{agreement:?}");
        assert!(!agreement.holds(0.75), "{agreement:?}");
    }

    #[test]
    fn beside_the_opening_of_a_t_its_corners_do_not_make_a_door_of_it() {
        let t = DrawnPlace::junction([false, true, true, true], 0.7);
        for before in [0.4, 0.5, 0.55] {
            let boundary = t.boundary([-before, 0.0], 0.0);
            // A little too wide and too near: a camera that is not as calibrated gives such an error.
            let square = Square { middle: Point2::new(before - 0.05, 0.0), half: 0.75 };
            let bar = Outline::hallway(Axis::Y, square, -0.65, 0.65);
            let agreement = agreement(&bar, &boundary);
            assert_eq!(agreement.door, 0, "{before} before: {agreement:?}");
        }
    }

    #[test]
    fn lines_on_the_floor_of_an_opening_do_not_make_a_door_of_it() {
        let mut hallway = DrawnPlace::junction([true, false, true, false], HALF);
        hallway.floor.push([-HALF, 0.0, HALF, 9.0]);
        let mut view = hallway.seen_from([0.0, 0.0], 0.0);
        // Where the wall would be, on both sides of what would be a door.
        for (index, class) in view.classes.iter_mut().enumerate() {
            let [x, y] = GroundView::ground(index).into();
            let on_line = x.abs() > 0.3 && (HALF - drawn_place::TAPE..HALF).contains(&y);
            if on_line && *class == PixelClass::Floor {
                *class = PixelClass::Stripe;
            }
        }
        let boundary = drawn_place::bearings().look(&view);
        let outline = Outline::hallway(Axis::X, SQUARE, -0.6, 0.6);
        let agreement = agreement(&outline, &boundary);
        assert!(agreement.door == 0 && agreement.through > 60, "{agreement:?}");
    }

    #[test]
    fn a_hallway_supports_a_junction_in_it_but_not_its_arm() {
        let hallway = [true, false, true, false];
        let t = [true, true, true, false];
        for (place, least) in [(t, 0.9..=1.0), (hallway, 0.0..=0.2)] {
            let agreement = held(t, &seen(&DrawnPlace::junction(place, HALF)));
            assert!(least.contains(&agreement.least), "{place:?}: {agreement:?}");
        }
    }

    /// A view of a place with a cable on its floor, where `on_cable` says.
    fn with_cable(doors: [bool; 4], on_cable: impl Fn(Point2<f64>) -> bool) -> Boundary {
        let mut view = DrawnPlace::junction(doors, HALF).seen_from([0.0, 0.0], 0.0);
        for (index, class) in view.classes.iter_mut().enumerate() {
            if on_cable(GroundView::ground(index)) && *class == PixelClass::Floor {
                *class = PixelClass::Stripe;
            }
        }
        drawn_place::bearings().look(&view)
    }

    #[test]
    fn a_cable_on_the_floor_of_an_opening_is_no_wall() {
        let (t, opening) = ([true, true, true, false], HALF - drawn_place::TAPE..HALF);
        let boundary = with_cable(t, |at| opening.contains(&at.y) && at.x.abs() < 0.5);
        for closed in [[true, false, true, true], [false, false, true, false]] {
            let agreement = held(closed, &boundary);
            assert!(agreement.least < 0.4, "{closed:?}: {agreement:?}");
        }
    }

    #[test]
    fn a_cable_across_a_hallway_is_no_dead_end() {
        let across = HALF - drawn_place::TAPE..HALF;
        let crooked = with_cable([true, false, true, false], |at| across.contains(&at.x));
        let (frame, walls) = drawn_place::walls(&crooked).unwrap();
        let on_wall =
            |point| walls.iter().any(|wall| wall.confirms(frame.walls_from_robot() * point));
        let mut straight = crooked.clone();
        straight.confirm(on_wall);
        for (cable, most) in [(crooked, 0.1), (straight, 0.6)] {
            let agreement = held([false, false, true, false], &cable);
            assert!(agreement.trust() > 0.9 && agreement.least < most, "{agreement:?}");
        }
    }

    #[test]
    fn floor_that_ends_where_it_is_hidden_shows_no_wall() {
        let dead_end = [false, false, true, false];
        let drawn = DrawnPlace::junction(dead_end, HALF).seen_from([0.0, 0.0], 0.0);
        let instead_of_stripes = |seen: PixelClass| {
            let mut view = drawn.clone();
            for class in view.classes.iter_mut().filter(|class| **class != PixelClass::Floor) {
                *class = seen;
            }
            held(dead_end, &drawn_place::bearings().look(&view))
        };
        let [ends, hidden] = [PixelClass::Other, PixelClass::Unseen].map(instead_of_stripes);
        assert!(ends.ended > 100 && ends.silent < 20, "{ends:?}");
        assert_eq!((hidden.ended, hidden.silent), (0, ends.ended + ends.silent));
    }

    #[test]
    fn a_direction_of_few_bearings_shows_nothing() {
        let seen = |all: u32| Seen { all, due: all, visible: all, agreeing: all.into(), doors: 0 };
        assert_eq!([5, 6].map(|all| seen(all).agreement(1)), [0.0, 1.0]);
    }

    #[test]
    fn doors_count_in_a_wall_that_is_seen() {
        let seen = |wall: u32, doors| Seen {
            all: wall + doors,
            agreeing: wall.into(),
            doors,
            ..Seen::default()
        };
        let agreement = |wall, doors| seen(wall, doors).agreement(1);
        assert_eq!(
            [agreement(60, 0), agreement(30, 30), agreement(20, 40)],
            [1.0, 0.75, 2.0 / 3.0]
        );
        assert!(agreement(19, 41) < 1.0 / 3.0);
    }

    #[test]
    fn an_outline_with_more_than_twice_as_much_door_as_wall_does_not_hold() {
        let with_doors = |door| OutlineAgreement {
            support: 100,
            ended: 20,
            door,
            ..OutlineAgreement::default()
        };
        assert!(with_doors(220).holds(1.0));
        assert!(!with_doors(221).holds(0.0));
    }

    #[test]
    fn a_direction_in_which_nothing_is_seen_is_blank() {
        let doors = [false, true, true, true];
        let mut boundary = seen(&DrawnPlace::junction(doors, HALF));
        for bearing in 0..BEARINGS / 8 {
            boundary.sights[bearing] = Sight::default();
            boundary.sights[BEARINGS - 1 - bearing] = Sight::default();
        }
        let outline = Outline::junction(doors, SQUARE);
        let agreement = agreement(&outline, &boundary);
        assert_eq!(agreement.blank, 1, "{agreement:?}");
        assert!(agreement.trust() > 0.99, "what is not seen does not speak against it");
    }

    #[test]
    fn an_open_direction_is_blank_where_the_floor_is_not_seen_to_go_on() {
        let doors = [false, true, true, true];
        let square = Square { middle: Point2::origin(), half: 0.55 };
        let mut boundary = seen(&DrawnPlace::junction(doors, square.half + drawn_place::TAPE));
        let blank =
            |boundary: &Boundary| agreement(&Outline::junction(doors, square), boundary).blank;
        assert_eq!(blank(&boundary), 0);
        for bearing in 3 * BEARINGS / 8..5 * BEARINGS / 8 {
            boundary.sights[bearing] = Sight::default();
            boundary.sights[bearing].floor = 0.6;
        }
        assert_eq!(blank(&boundary), 1);
    }
}
