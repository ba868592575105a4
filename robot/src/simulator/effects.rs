//! Effects that make images harder to read. Each has a name, a range and a value.

use std::ops::RangeInclusive;

use rand::{Rng, RngExt};
use thiserror::Error;

/// The scope of an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EffectScope {
    /// The building: the effect is the same in all of its images.
    Building,
    /// The robot, its camera and the single image.
    Picture,
}

/// An effect's name, meaning and range.
#[derive(Clone, Debug)]
pub struct Knob {
    /// The name on the command line.
    pub name: &'static str,
    /// Its scope.
    pub scope: EffectScope,
    /// Its meaning and unit.
    pub about: &'static str,
    /// The value without effect.
    pub plain: f64,
    /// The allowed values.
    pub allowed: RangeInclusive<f64>,
    /// The range from which [`Effects::drawn`] draws.
    pub default: RangeInclusive<f64>,
}

/// Why an effect cannot be set.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum KnobError {
    /// There is no effect with this name.
    #[error("there is no effect `{name}`; the effects are {}", names())]
    Unknown {
        /// The name.
        name: String,
    },
    /// The value is out of range.
    #[error("`{name}` is {value}; it must be from {least} to {greatest}")]
    OutOfRange {
        /// The effect.
        name: &'static str,
        /// The value.
        value: f64,
        /// The least value.
        least: f64,
        /// The greatest value.
        greatest: f64,
    },
}

fn names() -> String {
    KNOBS.iter().map(|knob| knob.name).collect::<Vec<_>>().join(", ")
}

macro_rules! knobs {
    ($($field:ident $name:literal $of:ident $plain:literal $allowed:expr, $default:expr, $about:literal;)*) => {
        /// The values of all effects.
        #[derive(Clone, Debug, PartialEq)]
        pub struct Effects {
            $(#[doc = $about] pub $field: f64,)*
        }

        /// All effects.
        pub const KNOBS: &[Knob] = &[$(Knob {
            name: $name,
            scope: EffectScope::$of,
            about: $about,
            plain: $plain,
            allowed: $allowed,
            default: $default,
        },)*];

        impl Effects {
            /// No effects.
            #[must_use]
            pub const fn plain() -> Self {
                Self { $($field: $plain,)* }
            }

            /// All values, in the order of [`KNOBS`].
            fn values(&mut self) -> [&mut f64; KNOBS.len()] {
                [$(&mut self.$field,)*]
            }
        }
    };
}

knobs! {
    lamp_spread "lamp-spread" Building 0.0 0.0..=1.0, 0.0..=0.35,
        "Spread of the lamps' brightness, as a share.";
    lamp_falloff "lamp-falloff" Building 0.0 0.0..=1.0, 0.3..=0.8,
        "Fall of the light away from the lamps: 0 even light, 1 lamps only.";
    lamps_out "lamps-out" Building 0.0 0.0..=1.0, 0.0..=0.15,
        "Share of the lamps that are off.";
    hot_spots "hot-spots" Building 0.0 0.0..=5.0, 0.0..=0.5,
        "Additional light in hot spots on the floor, as a share.";
    shadows "shadows" Building 0.0 0.0..=1.0, 0.0..=0.45,
        "Share of the light missing in shadows.";
    texture "texture" Building 0.0 0.0..=2.0, 0.6..=1.2,
        "Contrast of joints and tufts on the floor; 1 as in the look.";
    gloss "gloss" Building 0.0 0.0..=2.0, 0.4..=1.2,
        "Gloss of the floor; 1 as in the look.";
    gaps "gaps" Building 0.0 0.0..=10.0, 0.0..=3.0,
        "Gaps in the stripe per 10 m of wall.";
    gap_length "gap-length" Building 0.25 0.0..=1.0, 0.08..=0.25,
        "Length of the longest gap in the stripe, in metres.";
    scuffs "scuffs" Building 0.0 0.0..=1.0, 0.0..=0.25,
        "Variation of the stripe's brightness, as a share.";
    doors "doors" Building 0.0 0.0..=10.0, 0.0..=2.0,
        "Doors per 10 m of wall; they interrupt a baseboard.";
    untaped_doors "untaped-doors" Building 0.0 0.0..=1.0, 0.0..=0.4,
        "Share of the doors without tape across them.";
    posters "posters" Building 0.0 0.0..=10.0, 0.0..=3.0,
        "Posters per 10 m of wall.";
    body "body" Picture 0.0 0.0..=1.0, 1.0..=1.0,
        "Whether the robot's body is visible: 0.5 or more is yes.";
    lens "lens" Picture 0.0 0.0..=0.03, 0.012..=0.016,
        "Radius of the camera visible in the middle of the mirror, in metres.";
    struts "struts" Picture 0.0 0.0..=20.0, 1.5..=4.0,
        "Angle hidden by each of the mirror's two struts, in degrees.";
    strut_bearing "strut-bearing" Picture 90.0 0.0..=180.0, 0.0..=180.0,
        "Direction of the struts, in degrees from ahead to the left.";
    exposure "exposure" Picture 0.0 -5.0..=5.0, -1.2..=0.3,
        "Overexposure, in stops.";
    cast "cast" Picture 0.0 0.0..=1.0, 0.0..=0.7,
        "Yellow cast: missing share of blue; a fifth of it is missing in green.";
    tint "tint" Picture 0.0 -0.5..=0.5, -0.08..=0.08,
        "Green tint, or magenta below 0: change of green, as a share.";
    vignetting "vignetting" Picture 0.0 0.0..=1.0, 0.1..=0.5,
        "Share of the light missing at the mirror's rim.";
    blur "blur" Picture 0.0 0.0..=4.0, 0.3..=1.1,
        "Blur: standard deviation in pixels of an image 1280 wide.";
    glare "glare" Picture 0.0 0.0..=0.5, 0.0..=0.03,
        "Share of the light that a dusty mirror spreads over the image.";
    noise "noise" Picture 0.0 0.0..=0.5, 0.004..=0.02,
        "Sensor noise: standard deviation at white, as a share of white.";
    jpeg_loss "jpeg-loss" Picture 0.0 0.0..=99.0, 5.0..=35.0,
        "JPEG loss: 100 minus quality; 0 is no compression.";
}

impl Effects {
    /// Draws every effect from its default range.
    #[must_use]
    pub fn drawn(rng: &mut impl Rng) -> Self {
        let mut effects = Self::plain();
        effects.draw(rng, |_| true);
        effects
    }

    /// Effects for another image of the same building: only the image's effects are drawn again.
    #[must_use]
    pub fn of_another_picture(&self, rng: &mut impl Rng) -> Self {
        let mut effects = self.clone();
        effects.draw(rng, |knob| knob.scope == EffectScope::Picture);
        effects
    }

    fn draw(&mut self, rng: &mut impl Rng, which: impl Fn(&Knob) -> bool) {
        for (knob, value) in KNOBS.iter().zip(self.values()) {
            // Always draw, so that the value of one effect does not depend on which others are
            // used.
            let drawn = rng.random_range(knob.default.clone());
            if which(knob) {
                *value = drawn;
            }
        }
    }

    /// All effects and their values.
    #[must_use]
    pub fn settings(&self) -> Vec<(&'static Knob, f64)> {
        KNOBS.iter().zip(self.clone().values()).map(|(knob, value)| (knob, *value)).collect()
    }

    /// Sets an effect.
    ///
    /// # Errors
    /// Returns an error if there is no such effect or the value is out of range.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), KnobError> {
        let Some((knob, place)) = KNOBS.iter().zip(self.values()).find(|(k, _)| k.name == name)
        else {
            return Err(KnobError::Unknown { name: name.to_owned() });
        };
        if !knob.allowed.contains(&value) {
            let (&least, &greatest) = (knob.allowed.start(), knob.allowed.end());
            return Err(KnobError::OutOfRange { name: knob.name, value, least, greatest });
        }
        *place = value;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;

    #[test]
    fn effects_have_unique_names_and_allowed_ranges() {
        for (number, knob) in KNOBS.iter().enumerate() {
            assert!(KNOBS[..number].iter().all(|other| other.name != knob.name));
            for value in [knob.default.start(), knob.default.end(), &knob.plain] {
                assert!(knob.allowed.contains(value), "{}", knob.name);
            }
        }
    }

    #[test]
    fn effects_are_drawn_from_their_default_ranges() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        let mut earlier = Effects::plain();
        for _ in 0..100 {
            let mut effects = Effects::drawn(&mut rng);
            for (knob, value) in KNOBS.iter().zip(effects.values()) {
                assert!(knob.default.contains(value), "{}", knob.name);
            }
            assert_ne!(effects, earlier);
            earlier = effects;
        }
    }

    #[test]
    fn another_image_has_the_same_building() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(2);
        let mut effects = Effects::drawn(&mut rng);
        let mut other = effects.of_another_picture(&mut rng);
        let values = effects.values().into_iter().zip(other.values());
        for (knob, (value, other)) in KNOBS.iter().zip(values) {
            let same = value.total_cmp(other).is_eq();
            // Whether the robot sees itself is not random.
            assert_eq!(
                same,
                knob.scope == EffectScope::Building || knob.name == "body",
                "{}",
                knob.name
            );
        }
    }

    #[test]
    fn effects_outside_their_range_are_refused() {
        let mut effects = Effects::plain();
        assert_eq!(effects.set("lamp-spread", 0.25), Ok(()));
        assert_eq!(effects, Effects { lamp_spread: 0.25, ..Effects::plain() });
        let refused = effects.set("blur", 7.0).unwrap_err().to_string();
        assert_eq!(refused, "`blur` is 7; it must be from 0 to 4");
        assert!(effects.set("blur", f64::NAN).is_err());
        let refused = effects.set("fog", 1.0).unwrap_err().to_string();
        assert!(refused.starts_with("there is no effect `fog`; the effects are lamp-spread, "));
    }
}
