//! Options and output that `evaluate control` and `evaluate runs` share.

use std::{path::PathBuf, sync::Arc};

use toposlam_terminal::{CliError, input, progress::Progress, text::quoted};
use toposlam_vision::camera::Camera;

use super::report::{ReportArguments, unlearned, unmeasured};
use toposlam_simulator::{
    BuildingLook, LOOKS, LearnedSensors, NamedPlan, RobotEquipment,
    options::{
        appearance::{ImageSize, looks},
        noise,
        robot_sensor::{ScannerOption, SensorChoice, needs_camera, one_sensor},
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
    #[command(flatten)]
    scanner: ScannerOption,
    /// Multiple of the default noise of wheels and odometry, and of sensing without images
    #[arg(long, default_value_t = 1.0, value_name = "TIMES", value_parser = noise, allow_hyphen_values = true)]
    pub(super) noise: f64,
    #[command(flatten)]
    pub(super) report: ReportArguments,
}

/// The number of random plans in which driving is measured.
pub(super) const PLANS: u64 = 40;

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
        let plans = if self.plan.is_empty() {
            usual_plans(self.seed, random, most)?
        } else {
            read_plans(&self.plan)?
        };
        if let Some(scanner) = self.sensor.scanner(self.scanner.given.as_deref())? {
            let widths = plans.iter().map(|(_, plan)| plan.hallway_width());
            let is_enough = scanner.check_range(widths.fold(0.0, f64::max));
            is_enough.map_err(|error| CliError::at("--scanner", error))?;
        }
        Ok(plans)
    }

    /// The sensors of the robots.
    pub(super) fn equipment(&self) -> Result<RobotEquipment, CliError> {
        if let Some(scanner) = self.sensor.scanner(self.scanner.given.as_deref())? {
            return if self.images {
                Err(needs_camera("--images"))
            } else {
                Ok(RobotEquipment::Laser(scanner))
            };
        }
        if !self.images {
            return Ok(RobotEquipment::Scenes);
        }
        let looks = given_looks(&self.look);
        let progress = Progress::new("learning colours", "looks")?;
        let camera = Camera::superscout().sized(self.size.pixels());
        let sensors = LearnedSensors::new(&camera, &looks, &progress);
        progress.finish();
        sensors.map(RobotEquipment::Images).map_err(unlearned)
    }

    /// The options of `toposlam simulate` for such a robot.
    pub(super) fn sensing_options(&self, look: Option<&BuildingLook>) -> Vec<String> {
        if self.sensor == SensorChoice::Laser {
            let scanner = self.scanner.given.as_ref();
            let scanner =
                scanner.map(|given| format!("--scanner {}", quoted(&given.to_string_lossy())));
            return ["--sensor laser".to_owned()].into_iter().chain(scanner).collect();
        }
        match look {
            Some(look) => {
                let [width, height] = self.size.pixels();
                vec![format!("--look {} --size {width}x{height}", look.name)]
            }
            None => vec!["--by-scene".to_owned()],
        }
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
        let plan =
            size(number).map_or_else(|| random_plan(seed), |size| random_plan_with(seed, size));
        named.push((format!("random-{number}"), Arc::new(plan.map_err(unmeasured)?)));
    }
    Ok(named)
}

pub(super) fn given_looks(given: &[&'static BuildingLook]) -> Vec<&'static BuildingLook> {
    if given.is_empty() { LOOKS.iter().collect() } else { given.to_vec() }
}

pub(super) fn read_plans(paths: &[PathBuf]) -> Result<Vec<NamedPlan>, CliError> {
    let read = |path: &PathBuf| {
        let world = input::read_world(path)?;
        let plan = input::floor_plan(path, &world)?.clone();
        Ok((world.name, Arc::new(plan)))
    };
    paths.iter().map(read).collect()
}
