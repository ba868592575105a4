//! Boundary points: where the floor ends at a stripe, seen from the robot outwards. Section 3, Figure 6(d).
//!
//! Joints between tiles and reflections look like stripes, too, and a wall may have the floor's colour. So a bearing
//! may have several edges, the last of them sure or not; the neighbouring bearings decide.

use std::ops::Range;

use nalgebra::Point2;

use crate::{
    bearing::{STEPS, direction, range},
    colour::{PixelClass, Stripe, StripeKind},
    ground_view::GroundView,
};

/// A stripe is at least this part of its true width. Geometry: one pixel of the image may cover the rest.
const MIN_STRIPE_WIDTH: f64 = 0.40;
/// A stripe is at most this many times its true width, plus [`STRIPE_BLUR`]. Geometry: on most bearings a wall is met
/// at an angle.
const MAX_STRIPE_WIDTH: f64 = 2.0;
/// What pixels and blur add to a stripe's width, in steps. Views.
const STRIPE_BLUR: f64 = 10.0;
/// What is this many times wider than the widest stripe is an area: lit floor may have the colour of a stripe in the
/// shade. Views.
const AREA_WIDTH: f64 = 3.0;
/// Steps between floor and stripe in which their colours mix. Views.
const MIXED_STEPS: usize = 10;
/// Fewer steps of another class do not end a stripe. Views.
const SPECK_STEPS: usize = 3;
/// Steps behind a stripe that are searched for floor. Views.
const BEHIND_STEPS: usize = 30;
/// With this many steps of floor behind a stripe, its edge is not sure. Views.
const FLOOR_BEHIND_STEPS: usize = 10;
/// After this many steps of other classes the rest of the bearing is ignored. Views.
const LOST_STEPS: usize = 60;

/// What is seen on each bearing.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundary {
    /// One for each bearing: `TAU * index / BEARINGS` radians, counter-clockwise from ahead.
    pub sights: Vec<Sight>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sight {
    /// Where floor ends at a stripe, outwards. The first ones are used, the others are `None`.
    edges: [Option<Edge>; EDGES],
    /// The range of the farthest floor, in metres; 0 without floor. Nothing is seen behind a sure edge.
    pub floor: f64,
    /// Whether the floor is hidden there, by the robot's body or what carries its camera, so that it need not end.
    pub hidden: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    pub range: f64,
    /// Whether it is a stripe without floor behind it, or part of a long straight wall.
    pub sure: bool,
    /// Whether it is a stripe without floor behind it. A long straight cable has floor behind it.
    pub clear: bool,
    /// The width of the stripe along the bearing, as a part of the widest possible stripe's.
    pub width: f64,
}

const EDGES: usize = 3;
/// How a stripe looks on a bearing.
#[derive(Clone, Debug)]
pub struct Bearings {
    /// The width of a stripe that begins at a step and is met at a right angle, in steps.
    width: Vec<f64>,
    pub(crate) stripe: Stripe,
}

impl Bearings {
    /// The bearings of a camera at this height above the floor, in metres, for walls with this stripe.
    pub fn new(stripe: Stripe, height: f64) -> Self {
        let width = (0..STEPS).map(|step| {
            let width = match stripe.kind {
                StripeKind::OnFloor => stripe.width,
                // What is above the floor appears farther away.
                StripeKind::OnWall => {
                    range(step as f64) * stripe.width / (height - stripe.width).max(stripe.width)
                }
            };
            width / GroundView::SCALE
        });
        Self { width: width.collect(), stripe }
    }

    /// What is seen on each bearing of a ground view.
    // paper: sense.boundary, sense.boundary-points
    pub fn look(&self, view: &GroundView) -> Boundary {
        let bearings = view.on_bearings().chunks_exact(STEPS);
        let sights = bearings.map(|steps| self.sight(|step| Some(view.shown(*steps.get(step)?))));
        Boundary { sights: sights.collect() }
    }

    /// What is seen on one bearing, from the class of each step, from the robot outwards.
    fn sight(&self, class: impl Fn(usize) -> Option<PixelClass>) -> Sight {
        let is = |step: usize, wanted: PixelClass| class(step) == Some(wanted);
        let is_hidden = |mut steps: Range<usize>| steps.any(|step| is(step, PixelClass::Unseen));
        // The next steps behind one, in which colours mix.
        let after = |step: usize| step + 1..step + 1 + MIXED_STEPS;
        let mut sight = Sight::default();
        let mut edges = sight.edges.iter_mut();
        let mut floor: Option<usize> = None;
        let (mut step, mut lost) = (0, 0);
        while let Some(here) = class(step) {
            match here {
                PixelClass::Floor | PixelClass::Marker => {
                    floor = Some(step);
                    lost = 0;
                }
                PixelClass::Stripe => {
                    let from = step;
                    while (step + 1..=step + SPECK_STEPS).any(|next| is(next, PixelClass::Stripe)) {
                        step += 1;
                    }
                    let width = (step + 1 - from) as f64;
                    // The border of what is hidden looks like a stripe, and a stripe that is partly hidden does not
                    // show where the floor ends.
                    let before =
                        floor.map_or(0, |floor| floor + 1).max(from.saturating_sub(MIXED_STEPS));
                    if let Some(floor) = floor
                        && !is_hidden(before..from)
                        && !is_hidden(after(step))
                        && width >= MIN_STRIPE_WIDTH * self.width[from]
                    {
                        // The edge is at the end of the floor's last pixel. Floor that was taken for
                        // something else has no such pixel.
                        let (last, seen) = if from - floor <= MIXED_STEPS {
                            (floor, true)
                        } else {
                            (from - 1, false)
                        };
                        let widest = MAX_STRIPE_WIDTH * self.width[from] + STRIPE_BLUR;
                        let width = width / widest;
                        let sure = seen
                            && width < AREA_WIDTH
                            && !floor_follows((step + 1..).map_while(&class));
                        let range = range(last as f64 + 0.5);
                        let edge = Edge { range, sure, clear: sure, width };
                        let Some(next) = edges.next() else { break };
                        *next = Some(edge);
                        if sure {
                            break;
                        }
                    }
                }
                PixelClass::Unseen | PixelClass::Unknown | PixelClass::Other => lost += 1,
            }
            if floor.is_some() && lost > LOST_STEPS {
                break;
            }
            step += 1;
        }
        sight.floor = floor.map_or(0.0, |floor| range(floor as f64 + 0.5));
        sight.hidden = floor.is_some_and(|floor| is_hidden(after(floor)));
        sight
    }
}

impl Sight {
    #[cfg(test)]
    pub(crate) fn at(range: Option<f64>) -> Self {
        let edge = range.map(|range| Edge { range, sure: true, clear: true, width: 0.5 });
        let floor = range.unwrap_or_default();
        Self { edges: [edge, None, None], floor, hidden: false }
    }

    pub fn edges(&self) -> impl Iterator<Item = Edge> + '_ {
        self.edges.iter().flatten().copied()
    }

    pub fn sure(&self) -> Option<f64> {
        self.edges().find(|edge| edge.sure).map(|edge| edge.range)
    }
}

/// Whether floor goes on behind a stripe; more stripe does not matter.
fn floor_follows(behind: impl Iterator<Item = PixelClass>) -> bool {
    let behind = behind.filter(|&class| class != PixelClass::Stripe).take(BEHIND_STEPS);
    behind.filter(|&class| class == PixelClass::Floor).count() >= FLOOR_BEHIND_STEPS
}

impl Boundary {
    /// The boundary points, counter-clockwise from ahead, each with its bearing.
    pub fn points(&self) -> impl Iterator<Item = (usize, Point2<f64>)> + '_ {
        self.sights.iter().enumerate().flat_map(|(bearing, sight)| {
            let ray = direction(bearing);
            sight.edges().map(move |edge| (bearing, Point2::from(edge.range * ray)))
        })
    }

    /// Makes the edges sure that lie on long walls: what is behind a wall may have the floor's colour.
    pub(crate) fn confirm(&mut self, is_on_long_wall: impl Fn(Point2<f64>) -> bool) {
        for (bearing, sight) in self.sights.iter_mut().enumerate() {
            for edge in sight.edges.iter_mut().flatten() {
                edge.sure |= is_on_long_wall(Point2::from(edge.range * direction(bearing)));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawn_place;

    /// Classes on a bearing: one letter is eight steps of a class.
    fn on(letters: &str) -> Vec<PixelClass> {
        let class = |letter| match letter {
            'f' => PixelClass::Floor,
            's' => PixelClass::Stripe,
            'm' => PixelClass::Marker,
            'o' => PixelClass::Other,
            '?' => PixelClass::Unknown,
            _ => PixelClass::Unseen,
        };
        letters.chars().flat_map(|letter| [class(letter); 8]).collect()
    }

    fn sight_of(classes: &[PixelClass]) -> Sight {
        drawn_place::bearings().sight(|step| classes.get(step).copied())
    }

    fn sight(letters: &str) -> Sight {
        sight_of(&on(letters))
    }

    // paper: sense.boundary, sense.boundary-points
    #[test]
    fn a_wall_is_where_floor_ends_at_a_stripe() {
        for classes in ["ffffsoooo", "ffff?soooo", "   fsoooo", "ffmmsoooo", "ffffsoo?oo   "] {
            let sight = sight(classes);
            assert!(sight.sure().is_some(), "{classes}");
            assert_eq!(sight.sure(), Some(sight.floor), "{classes}");
        }
        assert_eq!(sight("ffffsoooo").sure(), Some(range(31.5)));
    }

    #[test]
    fn an_edge_behind_which_floor_is_seen_is_not_sure() {
        let ranges = |sight: Sight| sight.edges().map(|edge| edge.range).collect::<Vec<_>>();
        let lamp = sight("fffsfffsoooo");
        assert_eq!(lamp.sure(), Some(range(55.5)));
        assert_eq!(ranges(lamp), [range(23.5), range(55.5)]);
        let wall_like_floor = sight("fffsffffffff");
        assert_eq!(wall_like_floor.sure(), None);
        assert_eq!(ranges(wall_like_floor), [range(23.5)]);
        assert_eq!(wall_like_floor.floor, range(95.5));
        let floor_like_wall = sight("ffffooosoooo");
        assert_eq!(floor_like_wall.sure(), None);
        assert_eq!(ranges(floor_like_wall), [range(55.5)]);
    }

    #[test]
    fn an_area_of_the_stripes_colour_is_not_a_sure_edge() {
        let stripe = sight("ffffsssoooo");
        assert_eq!(stripe.sure(), Some(range(31.5)));
        let lit_floor = sight("ffffsssssssssoooo");
        assert_eq!(lit_floor.sure(), None);
        assert_eq!(lit_floor.edges().count(), 1);
    }

    #[test]
    fn a_joint_between_tiles_is_narrower_than_the_stripe() {
        let mut classes = on("ffffffffffff");
        classes[40..42].fill(PixelClass::Stripe);
        assert_eq!(sight_of(&classes).edges().count(), 0);
    }

    #[test]
    fn a_stripe_without_floor_before_it_is_not_an_edge() {
        assert_eq!(sight("    soooo").edges().count(), 0);
        assert_eq!(sight("foooooooosooo").edges().count(), 0);
    }

    #[test]
    fn without_a_wall_the_farthest_floor_counts() {
        assert_eq!(sight("fffffoooo").edges().count(), 0);
        assert_eq!(sight("fffffoooo").floor, range(39.5));
        assert_eq!(sight("         "), Sight::default());
        assert_eq!(sight("ffoofffffff").floor, range(87.5));
    }
}
