//! What evaluations of driving have in common: the plans, the robots, how they see.

use std::{fmt::Display, io::Write, path::PathBuf, sync::Arc};

use serde_json::json;
use toposlam_model::floor_plan::FloorPlan;
use toposlam_robot::{
    evaluation::{
        LearnedSensors,
        bound::upper_bound,
        plans,
        random_plan::{random_plan, random_plan_with},
    },
    simulator::{BuildingLook, LOOKS},
};
use toposlam_vision::camera::Camera;

use super::vision::{read_plan, unmeasured};
use crate::cli::{
    Failure,
    appearance::{ImageSize, looks},
    noise,
    progress::Progress,
    text::grouped,
};

/// Which robots, and where.
#[derive(clap::Args)]
pub(super) struct RobotArguments {
    /// From which everything follows that is left to chance
    #[arg(long, default_value_t = 1, value_name = "N")]
    pub(super) seed: u64,
    /// Floor plans; may be given more than once [default: those of worlds/, and random ones]
    #[arg(long, value_name = "FILE", num_args = 1..)]
    plan: Vec<PathBuf>,
    /// With rendered pictures, which sensing reads; without, scenes are told as often right and as
    /// exactly as sensing was measured to be
    #[arg(long)]
    images: bool,
    /// With --images: width and height of the pictures
    #[arg(long, value_name = "SIZE", default_value = "640x480")]
    size: ImageSize,
    /// With --images: what the buildings look like; may be given more than once [default: every look]
    #[arg(long, value_name = "NAME", value_parser = looks())]
    look: Vec<&'static BuildingLook>,
    /// How inexact wheels and odometry are, and without images sensing: 0 not at all, 1 as by default
    #[arg(long, default_value_t = 1.0, value_name = "TIMES", value_parser = noise)]
    pub(super) noise: f64,
    /// Threads, up to 1024; the result does not depend on them [default: all processors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(super) threads: Option<u16>,
    /// Print JSON objects, one a line
    #[arg(long)]
    pub(super) json: bool,
}

/// A plan with its name.
pub(super) type NamedPlan = (String, Arc<FloorPlan>);

/// Which plans nobody drew.
#[derive(Clone, Copy, Debug)]
pub(super) enum RandomPlans {
    /// Any, so many.
    Any(u64),
    /// So many, with from 5 to 25 junctions in turn.
    Large(u64),
}

impl RobotArguments {
    /// The plans: those given, or those of `worlds/` with at most so many junctions, and random ones.
    pub(super) fn plans(
        &self,
        random: RandomPlans,
        most: usize,
    ) -> Result<Vec<NamedPlan>, Failure> {
        if !self.plan.is_empty() {
            return self.plan.iter().map(|path| read_plan(path)).collect();
        }
        let mut named = plans().map_err(unmeasured)?;
        named.retain(|(_, plan)| plan.junctions().len() <= most);
        let (count, size): (u64, fn(u64) -> Option<usize>) = match random {
            RandomPlans::Any(count) => (count, |_| None),
            RandomPlans::Large(count) => (count, |number| Some(5 + (number % 21) as usize)),
        };
        for number in 0..count {
            let seed = self.seed.wrapping_mul(1_000_003).wrapping_add(number);
            let plan = match size(number) {
                None => random_plan(seed),
                Some(junctions) => random_plan_with(seed, junctions),
            };
            named.push((format!("random-{number}"), Arc::new(plan.map_err(unmeasured)?)));
        }
        Ok(named)
    }

    /// Cameras and sensing, where there are pictures.
    pub(super) fn eyes(&self) -> Result<Option<LearnedSensors>, Failure> {
        if !self.images {
            return Ok(None);
        }
        let looks = if self.look.is_empty() { LOOKS.iter().collect() } else { self.look.clone() };
        let progress = Progress::new("learning colours", "looks")?;
        let camera = Camera::superscout().sized(self.size.pixels());
        let eyes = LearnedSensors::new(&camera, &looks, &progress);
        progress.finish();
        eyes.map(Some).map_err(unmeasured)
    }

    /// How the robots see, in words.
    pub(super) fn sight(&self) -> String {
        if self.images {
            let [width, height] = self.size.pixels();
            format!("pictures of {width}x{height}")
        } else {
            "scenes told as sensing was measured to tell them".to_owned()
        }
    }
}

/// How often something happened, in words: with what it may be at most, in 95 of 100 such trials.
pub(super) fn share(seen: usize, cases: usize) -> String {
    let percent = |part: f64| 100.0 * part;
    format!(
        "{} of {} ({:.2} %, at most {:.2} %)",
        grouped(seen as u128),
        grouped(cases as u128),
        percent(seen as f64 / cases.max(1) as f64),
        percent(upper_bound(seen, cases)),
    )
}

/// The same as JSON.
pub(super) fn share_json(kind: &str, seen: usize, cases: usize) -> serde_json::Value {
    json!({
        "schema": 1, "kind": "rate", "what": kind, "seen": seen, "cases": cases,
        "rate": seen as f64 / cases.max(1) as f64, "upper_bound": upper_bound(seen, cases),
    })
}

/// Prints a line that stands out.
pub(super) fn failed(
    out: &mut dyn Write,
    what: impl Display,
    how: impl Display,
) -> Result<(), Failure> {
    writeln!(out, "  {what}: {how}").map_err(Failure::from)
}
