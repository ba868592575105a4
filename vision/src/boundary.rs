//! Boundary points: where the floor ends at a stripe, as seen from the robot outwards. Section 3,
//! Figure 6(d).
//!
//! Walls are higher than the camera, so that on each bearing the first stripe behind the floor is the
//! only wall that can be seen. A stripe behind which the floor goes on is none: a joint between tiles,
//! a lamp's reflection, a speck.

use std::f64::consts::TAU;

use crate::{colour::Class, ground_view::GroundView};

/// What is seen on each bearing.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundary {
    /// On bearing `TAU * index / BEARINGS`, counter-clockwise from ahead.
    pub sights: Vec<Sight>,
}

/// What is seen on one bearing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sight {
    /// How far away the floor ends at a stripe, in metres.
    pub wall: Option<f64>,
    /// How far away floor was seen, in metres; 0 if nowhere.
    pub floor: f64,
}

/// How many bearings are looked at.
pub const BEARINGS: usize = 720;
/// From where on floor is looked at, in metres.
const NEAREST: f64 = 0.30;
/// Up to where, in metres. Farther away a pixel covers more than a stripe.
pub const REACH: f64 = 2.6;
/// Steps along a bearing, a pixel of the ground view each.
const STEPS: usize = ((REACH - NEAREST) / GroundView::SCALE) as usize;
/// A stripe is at least so wide, along a bearing, in steps.
const STRIPE: usize = 2;
/// Between floor and stripe colours mix, over so many steps.
const MIXED: usize = 10;
/// Behind a stripe so many steps are looked at;
const BEHIND: usize = 30;
/// if so many of them are floor, it is no wall.
const FLOOR_BEHIND: usize = 10;
/// Where no floor was seen for so many steps, what comes behind is not believed.
const LOST: usize = 60;

/// The pixels of the ground view on each bearing, from the robot outwards.
#[derive(Clone, Debug)]
pub struct Bearings {
    /// [`STEPS`] for each bearing.
    pixels: Vec<u32>,
}

impl Default for Bearings {
    fn default() -> Self {
        let pixels = (0..BEARINGS)
            .flat_map(|bearing| {
                let [x, y] = direction(bearing);
                (0..STEPS).map(move |step| {
                    let range = range(step as f64);
                    GroundView::index([range * x, range * y]).unwrap_or_default() as u32
                })
            })
            .collect();
        Self { pixels }
    }
}

impl Bearings {
    /// What is seen on each bearing of a ground view.
    // paper: sense.boundary
    // paper: sense.boundary-points
    pub fn look(&self, view: &GroundView) -> Boundary {
        let sights = self.pixels.chunks_exact(STEPS).map(|pixels| {
            let mut classes = [Class::Unseen; STEPS];
            for (class, &pixel) in classes.iter_mut().zip(pixels) {
                *class = view.classes[pixel as usize];
            }
            sight(&classes)
        });
        Boundary { sights: sights.collect() }
    }
}

/// What is seen on one bearing, by the classes on it from the robot outwards.
fn sight(classes: &[Class]) -> Sight {
    let mut floor: Option<usize> = None;
    let mut step = 0;
    while let Some(&class) = classes.get(step) {
        match class {
            Class::Floor | Class::Marker => floor = Some(step),
            Class::Stripe => {
                let from = step;
                while classes.get(step + 1) == Some(&Class::Stripe) {
                    step += 1;
                }
                let before = floor.filter(|&floor| from - floor <= MIXED);
                if let Some(before) = before
                    && step + 1 - from >= STRIPE
                    && is_wall(&classes[step + 1..])
                {
                    // The edge is where the floor's last pixel ends.
                    let wall = range(before as f64 + 0.5);
                    return Sight { wall: Some(wall), floor: wall };
                }
            }
            Class::Unseen | Class::Unknown | Class::Other => {}
        }
        if floor.is_some_and(|floor| step > floor + LOST) {
            break;
        }
        step += 1;
    }
    Sight { wall: None, floor: floor.map_or(0.0, |floor| range(floor as f64 + 0.5)) }
}

/// Whether what is behind a stripe is not floor.
fn is_wall(behind: &[Class]) -> bool {
    let floor = behind.iter().take(BEHIND).filter(|&&class| class == Class::Floor).count();
    floor < FLOOR_BEHIND
}

/// How far away a step is.
fn range(step: f64) -> f64 {
    NEAREST + step * GroundView::SCALE
}

/// The unit vector on a bearing.
#[must_use]
pub fn direction(bearing: usize) -> [f64; 2] {
    let (sine, cosine) = (TAU * bearing as f64 / BEARINGS as f64).sin_cos();
    [cosine, sine]
}

impl Boundary {
    /// The boundary points, counter-clockwise from ahead: their bearing and their position.
    pub fn points(&self) -> impl Iterator<Item = (usize, [f64; 2])> + '_ {
        self.sights.iter().enumerate().filter_map(|(bearing, sight)| {
            let range = sight.wall?;
            Some((bearing, direction(bearing).map(|part| range * part)))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Classes on a bearing, a letter each, eight steps a letter.
    fn on(letters: &str) -> Vec<Class> {
        let class = |letter| match letter {
            'f' => Class::Floor,
            's' => Class::Stripe,
            'm' => Class::Marker,
            'o' => Class::Other,
            '?' => Class::Unknown,
            _ => Class::Unseen,
        };
        letters.chars().flat_map(|letter| [class(letter); 8]).collect()
    }

    #[test]
    fn a_wall_is_where_floor_ends_at_a_stripe() {
        for classes in ["ffffsoooo", "ffff?soooo", "   fsoooo", "ffmmsoooo", "ffffsoo?oo   "] {
            let sight = sight(&on(classes));
            assert!(sight.wall.is_some(), "{classes}");
            assert_eq!(sight.wall, Some(sight.floor), "{classes}");
        }
        assert_eq!(sight(&on("ffffsoooo")).wall, Some(range(31.5)));
    }

    #[test]
    fn a_stripe_on_which_floor_follows_is_no_wall() {
        assert_eq!(sight(&on("fffsfffsoooo")).wall, Some(range(55.5)));
        assert_eq!(sight(&on("fffsffffffff")).wall, None);
    }

    #[test]
    fn a_stripe_without_floor_before_it_is_no_wall() {
        assert_eq!(sight(&on("    soooo")).wall, None);
        assert_eq!(sight(&on("fooooosooo")).wall, None);
    }

    #[test]
    fn without_a_wall_the_floor_seen_is_told() {
        assert_eq!(sight(&on("fffffoooo")), Sight { wall: None, floor: range(39.5) });
        assert_eq!(sight(&on("         ")), Sight::default());
        assert_eq!(sight(&on("ffoofffffff")).floor, range(87.5));
    }
}
