//! Options for rendered images: their size, the look of the building, and effects.

use crate::{BuildingLook, EffectSettings, Effects, LOOKS, view_sampler::WhichEffects};
use clap::{
    ValueEnum,
    builder::{PossibleValue, PossibleValuesParser, TypedValueParser},
};
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_vision::camera::Camera;

use toposlam_terminal::CliError;

/// Width and height of images.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ImageSize {
    #[value(name = "640x480")]
    Small,
    #[value(name = "1280x960")]
    Large,
}

impl ImageSize {
    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Small => "640x480",
            Self::Large => "1280x960",
        }
    }

    /// Width and height.
    pub fn pixels(self) -> [u32; 2] {
        match self {
            Self::Small => [640, 480],
            Self::Large => [1280, 960],
        }
    }
}

/// The look of a building, and the effects that make its images harder to read.
#[derive(clap::Args)]
pub struct Appearance {
    /// Look of the building
    #[arg(long, value_name = "NAME", default_value = LOOKS[0].name, value_parser = looks())]
    pub look: &'static BuildingLook,
    /// Effects that make images harder to read
    #[arg(long, default_value = "default", value_name = "WHICH")]
    effects: WhichEffects,
    /// Set one effect (repeatable); they are listed by `toposlam draw --help`
    #[arg(long, value_name = "NAME=VALUE", value_parser = read_setting)]
    effect: Vec<EffectSetting>,
}

pub type EffectSetting = (String, f64);

impl Appearance {
    /// The options that differ from the defaults.
    pub fn arguments(&self) -> Vec<(&'static str, String)> {
        let look = (self.look.name != LOOKS[0].name).then(|| ("--look", self.look.name.to_owned()));
        let none =
            matches!(self.effects, WhichEffects::None).then(|| ("--effects", "none".to_owned()));
        let set = self.effect.iter().map(|(name, value)| ("--effect", format!("{name}={value}")));
        look.into_iter().chain(none).chain(set).collect()
    }

    /// The effects drawn from a seed.
    pub fn effects(&self, seed: u64) -> Result<Effects, CliError> {
        let effects = match self.effects {
            WhichEffects::Default => Effects::drawn(&mut Xoshiro256PlusPlus::seed_from_u64(seed)),
            WhichEffects::None => Effects::plain(),
        };
        Ok(settings(&self.effect)?.applied(effects))
    }
}

/// Settings of effects by name.
pub fn settings(given: &[EffectSetting]) -> Result<EffectSettings, CliError> {
    for (index, (name, _)) in given.iter().enumerate() {
        if given[..index].iter().any(|(earlier, _)| earlier == name) {
            return Err(CliError::at("--effect", format!("{name} is given twice")));
        }
    }
    let given = given.iter().map(|(name, value)| (name.as_str(), *value));
    EffectSettings::new(given).map_err(|error| CliError::at("--effect", error))
}

/// The camera as effects make it.
pub fn camera_with(effects: &Effects, camera: &Camera) -> Result<Camera, CliError> {
    effects.camera(camera).ok_or_else(|| {
        CliError::at("--effect", "zoom and off-centre need a camera with a spherical mirror")
    })
}

pub fn looks() -> impl TypedValueParser<Value = &'static BuildingLook> {
    let looks = LOOKS.each_ref().map(|look| PossibleValue::new(look.name).help(look.about));
    PossibleValuesParser::new(looks).try_map(|name| {
        BuildingLook::named(&name).ok_or_else(|| format!("there is no look `{name}`"))
    })
}

/// Parses the setting of an effect.
pub fn read_setting(text: &str) -> Result<EffectSetting, String> {
    let setting = text
        .split_once('=')
        .and_then(|(name, value)| Some((name.trim().to_owned(), value.trim().parse().ok()?)));
    setting.ok_or_else(|| "write NAME=VALUE, as in blur=1.5".to_owned())
}
