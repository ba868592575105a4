//! Effects that make images harder to read. Each has a name, a range and a value.

use std::ops::RangeInclusive;

use rand::{Rng, RngExt};
use thiserror::Error;
use toposlam_vision::camera::{Camera, OpticsModel, SphericalMirror};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EffectScope {
    /// The building: the effect is the same in all of its images.
    Building,
    /// The robot, its camera and the single image.
    Image,
}

/// An effect's name, meaning and range.
#[derive(Clone, Debug, PartialEq)]
pub struct Knob {
    /// The name on the command line.
    pub name: &'static str,
    pub scope: EffectScope,
    /// Its meaning and unit.
    pub about: &'static str,
    /// The value without effect.
    pub plain: f64,
    pub allowed: RangeInclusive<f64>,
    /// The range from which [`Effects::drawn`] draws.
    pub default: RangeInclusive<f64>,
}

impl Knob {
    /// Whether [`Effects::drawn`] leaves it at its plain value.
    pub fn is_fixed(&self) -> bool {
        self.default == (self.plain..=self.plain)
    }
}

#[derive(Clone, Debug, PartialEq, Error)]
pub enum KnobError {
    #[error("there is no effect `{name}`; the effects are {}", names())]
    Unknown { name: String },
    #[error("`{name}` is {value}; it must be from {least} to {greatest}")]
    OutOfRange { name: &'static str, value: f64, least: f64, greatest: f64 },
}

fn names() -> String {
    KNOBS.iter().map(|knob| knob.name).collect::<Vec<_>>().join(", ")
}

macro_rules! knobs {
    ($($field:ident $name:literal $of:ident $plain:literal $allowed:expr, $default:expr, $about:literal;)*) => {
        #[derive(Clone, Debug, PartialEq)]
        pub struct Effects {
            $(#[doc = $about] pub $field: f64,)*
        }

        pub const KNOBS: &[Knob] = &[$(Knob {
            name: $name,
            scope: EffectScope::$of,
            about: $about,
            plain: $plain,
            allowed: $allowed,
            default: $default,
        },)*];

        impl Effects {
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
    furniture "furniture" Building 0.0 0.0..=10.0, 0.0..=0.0,
        "Cabinets, tables and chairs per 10 m of wall.";
    cables "cables" Building 0.0 0.0..=20.0, 0.0..=0.0,
        "Cables on the floor per 10 m of hallway.";
    dark_rim "dark-rim" Building 0.0 0.0..=1.0, 0.0..=0.0,
        "Share of the rim just inside of which dark furniture is seen.";
    body "body" Image 0.0 0.0..=1.0, 1.0..=1.0,
        "Whether the robot's body is visible: 0.5 or more is yes.";
    laptop "laptop" Image 0.0 0.0..=0.15, 0.0..=0.0,
        "How far an open laptop sticks out of the body, in metres; 0 is a closed one.";
    lens "lens" Image 0.0 0.0..=0.03, 0.012..=0.016,
        "Radius of the camera visible in the middle of the mirror, in metres.";
    struts "struts" Image 0.0 0.0..=20.0, 1.5..=4.0,
        "Angle hidden by each of the mirror's two struts, in degrees.";
    strut_bearing "strut-bearing" Image 90.0 0.0..=180.0, 0.0..=180.0,
        "Direction of the struts, in degrees from ahead to the left.";
    strut_width "strut-width" Image 0.0 0.0..=60.0, 0.0..=0.0,
        "Least width of each strut, in pixels of an image 1280 wide.";
    holder "holder" Image 0.03 0.0..=0.2, 0.03..=0.03,
        "Width of the dark ring around the mirror, as a share of the mirror's radius.";
    zoom "zoom" Image 1.0 0.5..=2.0, 1.0..=1.0,
        "Magnification; from 1.07 the image crops the mirror. 1.45 is a rim of 0.68 of its height.";
    off_centre "off-centre" Image 0.0 -0.2..=0.2, 0.0..=0.0,
        "How far the mirror is right of the image's middle, as a share of the image's height.";
    exposure "exposure" Image 0.0 -5.0..=5.0, -1.2..=0.3,
        "Overexposure, in stops.";
    cast "cast" Image 0.0 0.0..=1.0, 0.0..=0.7,
        "Yellow cast: missing share of blue, and a fifth of it of green. 0.77 halves blue's level.";
    tint "tint" Image 0.0 -0.5..=0.5, -0.08..=0.08,
        "Green tint, or magenta below 0: change of green, as a share.";
    vignetting "vignetting" Image 0.0 0.0..=1.0, 0.1..=0.5,
        "Share of the light missing at the mirror's rim.";
    blur "blur" Image 0.0 0.0..=4.0, 0.3..=1.1,
        "Blur: standard deviation in pixels of an image 1280 wide.";
    glare "glare" Image 0.0 0.0..=0.5, 0.0..=0.03,
        "Share of the light that a dusty mirror spreads over the image.";
    noise "noise" Image 0.0 0.0..=0.5, 0.004..=0.02,
        "Sensor noise: standard deviation at white, as a share of white.";
    jpeg_loss "jpeg-loss" Image 0.0 0.0..=99.0, 5.0..=35.0,
        "JPEG loss: 100 minus quality; 0 is no compression.";
}

impl Effects {
    /// Draws every effect from its default range.
    pub fn drawn(rng: &mut impl Rng) -> Self {
        let mut effects = Self::plain();
        for (knob, value) in KNOBS.iter().zip(effects.values()) {
            if !knob.is_fixed() {
                *value = rng.random_range(knob.default.clone());
            }
        }
        effects
    }

    /// The camera as `zoom` and `off-centre` make it; `None` if it has no mirror that they could crop.
    pub fn camera(&self, camera: &Camera) -> Option<Camera> {
        if [self.zoom - 1.0, self.off_centre].into_iter().all(|off| off.abs() < f64::EPSILON) {
            return Some(camera.clone());
        }
        let OpticsModel::SphericalMirror(mirror) = &camera.optics else { return None };
        let [width, height] = camera.image.map(f64::from);
        let middle = [(width - 1.0) / 2.0, (height - 1.0) / 2.0];
        let shift = [self.off_centre * height, 0.0];
        let zoomed = |axis: usize| {
            middle[axis] + self.zoom * (mirror.centre[axis] - middle[axis]) + shift[axis]
        };
        let optics = OpticsModel::SphericalMirror(SphericalMirror {
            centre: [zoomed(0), zoomed(1)].into(),
            focal: self.zoom * mirror.focal,
            ..*mirror
        });
        Some(Camera { optics, mask: None, ..camera.clone() })
    }

    /// The names of all effects, and their values.
    pub fn settings(&self) -> Vec<(&'static str, f64)> {
        KNOBS.iter().zip(self.clone().values()).map(|(knob, value)| (knob.name, *value)).collect()
    }

    /// Sets an effect.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), KnobError> {
        *self.values()[knob_index(name, value)?] = value;
        Ok(())
    }
}

/// The index among the [`KNOBS`] of the one that may have this value.
fn knob_index(name: &str, value: f64) -> Result<usize, KnobError> {
    let index = KNOBS.iter().position(|knob| knob.name == name);
    let index = index.ok_or_else(|| KnobError::Unknown { name: name.to_owned() })?;
    let Knob { name, allowed, .. } = &KNOBS[index];
    if allowed.contains(&value) {
        Ok(index)
    } else {
        let (&least, &greatest) = (allowed.start(), allowed.end());
        Err(KnobError::OutOfRange { name, value, least, greatest })
    }
}

/// Values of some effects, each with the index of its knob.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EffectSettings(Vec<(usize, f64)>);

impl EffectSettings {
    /// Settings by the names of effects.
    pub fn new<'n>(settings: impl IntoIterator<Item = (&'n str, f64)>) -> Result<Self, KnobError> {
        let setting = |(name, value)| Ok((knob_index(name, value)?, value));
        settings.into_iter().map(setting).collect::<Result<_, _>>().map(Self)
    }

    /// These effects with the settings.
    pub fn applied(&self, mut effects: Effects) -> Effects {
        for &(index, value) in &self.0 {
            *effects.values()[index] = value;
        }
        effects
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;

    #[test]
    fn effects_have_unique_names_and_are_drawn_from_their_ranges() {
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
        for (number, knob) in KNOBS.iter().enumerate() {
            assert!(KNOBS[..number].iter().all(|other| other.name != knob.name));
            for value in [knob.default.start(), knob.default.end(), &knob.plain] {
                assert!(knob.allowed.contains(value), "{}", knob.name);
            }
        }
        // Those that are off by default take no random numbers.
        let fixed = KNOBS.iter().filter(|knob| knob.is_fixed()).map(|knob| knob.name);
        let expected = [
            "furniture",
            "cables",
            "dark-rim",
            "laptop",
            "strut-width",
            "holder",
            "zoom",
            "off-centre",
        ];
        assert_eq!(fixed.collect::<Vec<_>>(), expected);
    }

    #[test]
    fn zoom_and_offset_place_the_rim_so_that_the_image_crops_it_on_three_sides() {
        let mut effects = Effects::plain();
        let camera = Camera::superscout();
        assert_eq!(effects.camera(&camera), Some(camera.clone()));
        effects.set("zoom", 1.45).unwrap();
        effects.set("off-centre", -0.03).unwrap();
        let cropped = effects.camera(&camera).unwrap();
        let OpticsModel::SphericalMirror(mirror) = cropped.optics else { panic!() };
        let ([u, v], rim) = (mirror.centre.into(), mirror.rim());
        assert!((rim / 960.0 - 0.68).abs() < 0.001, "{rim}");
        assert!((u - 611.4).abs() < 0.1 && (v - 480.2).abs() < 0.1, "{u} {v}");
        let sides = [u - rim < 0.0, v - rim < 0.0, u + rim > 1279.0, v + rim > 959.0];
        assert_eq!(sides, [true, true, false, true]);
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
