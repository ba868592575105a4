//! Options and output that `evaluate control` and `evaluate runs` share.

use std::{fmt::Display, io::Write, path::PathBuf, sync::Arc};

use serde_json::json;
use toposlam_model::floor_plan::FloorPlan;
use toposlam_robot::bound::upper_bound;
use toposlam_terminal::{
    CliError,
    progress::Progress,
    text::{grouped, print_indented},
};
use toposlam_vision::camera::Camera;

use super::vision::{read_plan, unlearned, unmeasured};
use toposlam_simulator::{
    BuildingLook, LOOKS, LearnedSensors, RobotEquipment,
    options::{
        appearance::{ImageSize, looks},
        noise,
        robot_sensor::{SensorChoice, needs_camera, one_sensor},
    },
    plans,
    random_plan::{random_plan, random_plan_with},
};

/// The robots, their floor plans and their sensing.
#[derive(clap::Args)]
pub(super) struct RobotArguments {
    /// Random seed
    #[arg(long, default_value_t = 1, value_name = "N")]
    pub(super) seed: u64,
    /// Floor plans (repeatable) [default: those of worlds/, and random ones]
    #[arg(long, value_name = "FILE", num_args = 1..)]
    plan: Vec<PathBuf>,
    /// Render images and sense them; without it, scenes are drawn with the measured error rates of
    /// sensing
    #[arg(long)]
    images: bool,
    /// With --images: image size in pixels
    #[arg(long, value_name = "SIZE", default_value = "640x480", requires = "images")]
    size: ImageSize,
    /// With --images: look of the buildings (repeatable) [default: every look]
    #[arg(long, value_name = "NAME", value_parser = looks(), requires = "images")]
    look: Vec<&'static BuildingLook>,
    /// The sensor of the robots: camera or laser. A robot with a laser scanner drives by its scans
    #[arg(long, value_name = "SENSOR", default_value = "camera", value_parser = one_sensor())]
    sensor: SensorChoice,
    /// With --sensor laser: parameters of the scanner and of what makes scans harder to read, .toml
    #[arg(long, value_name = "FILE")]
    scanner: Option<PathBuf>,
    /// Multiple of the default noise of wheels and odometry, and of sensing without images
    #[arg(long, default_value_t = 1.0, value_name = "TIMES", value_parser = noise, allow_hyphen_values = true)]
    pub(super) noise: f64,
    /// Number of threads, up to 1024; the result is the same for any number [default: all processors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(super) threads: Option<u16>,
    /// Print JSON objects, one per line
    #[arg(long)]
    pub(super) json: bool,
}

/// The number of random plans in which driving is measured.
pub(super) const PLANS: u64 = 40;

/// A plan's name and the plan.
pub(super) type NamedPlan = (String, Arc<FloorPlan>);

/// Random plans.
#[derive(Clone, Copy, Debug)]
pub(super) enum RandomPlans {
    /// This many, of any size.
    Any(u64),
    /// This many, with 5 to 25 junctions in turn.
    Large(u64),
}

impl RobotArguments {
    /// The given plans; or those of `worlds/` with at most `most` junctions, and random ones.
    pub(super) fn plans(
        &self,
        random: RandomPlans,
        most: usize,
    ) -> Result<Vec<NamedPlan>, CliError> {
        if self.plan.is_empty() {
            usual_plans(self.seed, random, most)
        } else {
            self.plan.iter().map(|path| read_plan(path)).collect()
        }
    }

    /// The sensors of the robots.
    pub(super) fn equipment(&self) -> Result<RobotEquipment, CliError> {
        if let Some(scanner) = self.sensor.scanner(self.scanner.as_deref())? {
            return if self.images {
                Err(needs_camera("--images"))
            } else {
                Ok(RobotEquipment::Laser(scanner))
            };
        }
        if !self.images {
            return Ok(RobotEquipment::Scenes);
        }
        let looks = if self.look.is_empty() { LOOKS.iter().collect() } else { self.look.clone() };
        let progress = Progress::new("learning colours", "looks")?;
        let camera = Camera::superscout().sized(self.size.pixels());
        let sensors = LearnedSensors::new(&camera, &looks, &progress);
        progress.finish();
        sensors.map(RobotEquipment::Images).map_err(unlearned)
    }

    /// What the robots take at each step.
    pub(super) fn frames(&self) -> &'static str {
        match self.sensor {
            SensorChoice::Laser => "scans",
            _ if self.images => "images",
            _ => "scenes",
        }
    }

    /// How the robots sense, in words.
    pub(super) fn sensing(&self) -> String {
        if self.sensor == SensorChoice::Laser {
            "scans of a laser scanner".to_owned()
        } else if self.images {
            let [width, height] = self.size.pixels();
            format!("rendered images of {width}x{height}")
        } else {
            "scenes with the measured error rates".to_owned()
        }
    }
}

/// The plans of `worlds/` with at most `most` junctions, and random ones.
pub(super) fn usual_plans(
    seed: u64,
    random: RandomPlans,
    most: usize,
) -> Result<Vec<NamedPlan>, CliError> {
    let mut named = plans().map_err(unmeasured)?;
    named.retain(|(_, plan)| plan.junctions().len() <= most);
    let (count, size): (u64, fn(u64) -> Option<usize>) = match random {
        RandomPlans::Any(count) => (count, |_| None),
        RandomPlans::Large(count) => (count, |number| Some(5 + (number % 21) as usize)),
    };
    for number in 0..count {
        let seed = seed.wrapping_mul(1_000_003).wrapping_add(number);
        let plan = match size(number) {
            None => random_plan(seed),
            Some(junctions) => random_plan_with(seed, junctions),
        };
        named.push((format!("random-{number}"), Arc::new(plan.map_err(unmeasured)?)));
    }
    Ok(named)
}

/// A count, its rate, and the upper bound of the rate with a confidence of 95 %.
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
pub(super) fn share_json(what: &str, seen: usize, cases: usize) -> serde_json::Value {
    json!({
        "what": what, "seen": seen, "cases": cases,
        "rate": seen as f64 / cases.max(1) as f64, "upper_bound": upper_bound(seen, cases),
    })
}

/// Prints a case that failed, and why.
pub(super) fn print_failure(
    out: &mut dyn Write,
    what: impl Display,
    how: impl Display,
) -> Result<(), CliError> {
    print_indented(out, "  ", 4, &format!("{what}: {how}")).map_err(CliError::from)
}
