//! What buildings look like, on the command line: a look, and effects.

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_robot::simulator::{BuildingLook, Effects, LOOKS};

use super::{
    Failure,
    render::{EffectsChoice, looks, read_setting},
};

/// What a building looks like, and what makes pictures of it harder to read.
#[derive(clap::Args)]
pub(super) struct Appearance {
    /// What the building looks like
    #[arg(long, value_name = "NAME", default_value = LOOKS[0].name, value_parser = looks())]
    pub(super) look: &'static BuildingLook,
    /// Which effects there are
    #[arg(long, default_value = "default", value_name = "WHICH")]
    effects: EffectsChoice,
    /// Set one effect; may be given more than once; `toposlam render --help` lists them
    #[arg(long, value_name = "NAME=VALUE", value_parser = read_setting)]
    effect: Vec<(String, f64)>,
}

impl Appearance {
    /// The arguments that say it, without those that are as usual.
    pub(super) fn told(&self) -> Vec<(&'static str, String)> {
        let look = (self.look.name != LOOKS[0].name).then(|| ("--look", self.look.name.to_owned()));
        let none =
            matches!(self.effects, EffectsChoice::None).then(|| ("--effects", "none".to_owned()));
        let set = self.effect.iter().map(|(name, value)| ("--effect", format!("{name}={value}")));
        look.into_iter().chain(none).chain(set).collect()
    }

    /// The effects of a seed.
    pub(super) fn effects(&self, seed: u64) -> Result<Effects, Failure> {
        let mut effects = match self.effects {
            EffectsChoice::Default => Effects::drawn(&mut Xoshiro256PlusPlus::seed_from_u64(seed)),
            EffectsChoice::None => Effects::plain(),
        };
        for (name, value) in &self.effect {
            effects.set(name, *value).map_err(|error| Failure::at("--effect", error))?;
        }
        Ok(effects)
    }
}
