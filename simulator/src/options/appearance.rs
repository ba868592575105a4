//! Options for rendered images: their size, the look of the building, and effects.

use crate::{BuildingLook, EffectSettings, Effects, LOOKS};
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
    /// Set one effect that makes images harder to read; none sets all others to nothing (repeatable). They are
    /// listed by `toposlam draw --help`
    #[arg(long, value_name = "NAME=VALUE", value_parser = read_effect)]
    effect: Vec<EffectOption>,
}

/// An effect on the command line.
#[derive(Clone, Debug, PartialEq)]
pub enum EffectOption {
    /// Effects that are not set are off. Without this, they are drawn from the seed.
    None,
    Set(EffectSetting),
}

pub type EffectSetting = (String, f64);

impl Appearance {
    /// The effects that are set; the others are drawn from a seed, or off.
    pub fn effects(&self, seed: u64) -> Result<Effects, CliError> {
        let effects = if self.effect.contains(&EffectOption::None) {
            Effects::plain()
        } else {
            Effects::drawn(&mut Xoshiro256PlusPlus::seed_from_u64(seed))
        };
        let set = self.effect.iter().filter_map(|effect| match effect {
            EffectOption::None => None,
            EffectOption::Set(setting) => Some(setting.clone()),
        });
        Ok(settings(&set.collect::<Vec<_>>())?.applied(effects))
    }
}

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

fn read_effect(text: &str) -> Result<EffectOption, String> {
    match text {
        "none" => Ok(EffectOption::None),
        setting => read_setting(setting).map(EffectOption::Set),
    }
}

/// Parses the setting of an effect.
pub fn read_setting(text: &str) -> Result<EffectSetting, String> {
    let setting = text
        .split_once('=')
        .and_then(|(name, value)| Some((name.trim().to_owned(), value.trim().parse().ok()?)));
    setting.ok_or_else(|| "write NAME=VALUE, as in blur=1.5".to_owned())
}
