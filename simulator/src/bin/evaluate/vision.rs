//! `evaluate vision`: compares the scenes of rendered views with the floor plan.

use std::{
    io::Write,
    path::{Path, PathBuf},
    sync::Arc,
};

use serde_json::json;

use toposlam_model::floor_plan::FloorPlan;
use toposlam_terminal::{
    CliError, Outcome, exit_codes::help_end, input, output, progress::Progress, remark,
};
use toposlam_vision::camera::Camera;

use super::{
    clutter,
    evaluation_report::{
        EvaluationReport, MeasurementEnd, ReportArguments, outcome, unlearned, unmeasured,
        verdict_on_targets,
    },
    failing, vision_report,
};
use toposlam_simulator::{
    BuildingLook, Effects, LOOKS,
    evaluation::{
        calibration::Calibration,
        failure_groups::groups,
        judge::{Judge, JudgingError},
        judged_view::{JudgedView, JudgedVisit},
        report::{TargetStatus, VisionReport},
    },
    options::appearance::{
        EffectSetting, EffectsChoice, ImageSize, camera_with, looks, read_setting, settings,
    },
    plans,
    rendered_view::WhichEffects,
    view_sampler::ViewSampler,
};

/// Measure sensing on rendered views against the floor plan
///
/// Views are random poses in given and random floor plans, in buildings of every look. They lie at
/// junctions, from 1.5 m before to 0.3 m past the turning point, or anywhere in hallways. The robot is
/// up to 0.3 m off the middle and turned by up to 25 degrees.
///
/// Within 0.5 m of a turning point the right answer is the junction, beyond 1.5 m it is the hallway.
/// In between, both the hallway and the right junction count as right. A visit is a series of images
/// on one approach to a junction. It is decided when two images agree.
#[derive(clap::Args)]
#[command(after_help = help_end(
    "\
Examples:
  evaluate vision                            takes one or two minutes
  evaluate vision --views 20000 --calibration-errors --json
  evaluate vision --plan worlds/shape-8.toml --out-dir failing
  evaluate vision --view 17 -o seventeen  one view, stage by stage
  evaluate vision --clutter               right, unknown and wrong
  evaluate vision --effect furniture=5 --out-dir failing

A target is met if the 95 % interval of the rate is within it, missed if the \
interval is beyond it, and otherwise not shown: the sample is too small. A target \
of 0 is met if nothing was seen, and the rate is at most 0.1 %.",
    &[
        (0, "all targets are met"),
        (1, "a target is missed"),
        (2, "bad usage or input"),
        (3, "a target is not shown, or not everything was measured"),
    ],
))]
pub(super) struct EvaluateVisionArguments {
    /// Number of views
    #[arg(long, default_value_t = 1000, value_name = "N")]
    views: u64,
    /// Number of visits [default: a twentieth of the views]
    #[arg(long, value_name = "N")]
    visits: Option<u64>,
    /// Random seed
    #[arg(long, default_value_t = 1, value_name = "N")]
    seed: u64,
    /// Image size in pixels [default: 1280x960 and 640x480 in turn]
    #[arg(long, value_name = "SIZE")]
    size: Option<ImageSize>,
    /// Look of the buildings (repeatable) [default: every look]
    #[arg(long, value_name = "NAME", value_parser = looks())]
    look: Vec<&'static BuildingLook>,
    /// Floor plans (repeatable) [default: those of worlds/, and random ones]
    #[arg(long, value_name = "FILE", num_args = 1..)]
    plan: Vec<PathBuf>,
    /// Effects that make images harder to read
    #[arg(long, default_value = "default", value_name = "WHICH")]
    effects: EffectsChoice,
    /// Set one effect in every view (repeatable); they are listed by `toposlam draw --help`. Colours are
    /// learned without it
    #[arg(long, value_name = "NAME=VALUE", value_parser = read_setting)]
    effect: Vec<EffectSetting>,
    /// Measure single views without clutter, with each kind of it, and with all kinds: furniture, cables, wide
    /// struts, an open laptop, a yellow cast, a cropped mirror, a dark rim
    #[arg(long, conflicts_with_all = ["visits", "effect", "calibration_errors", "view", "out_dir"])]
    clutter: bool,
    /// Measure everything again with a camera that is 5 pixels, 2 cm and 1 degree off its calibration
    #[arg(long)]
    calibration_errors: bool,
    /// Measure only the view with this number
    #[arg(long, value_name = "N", conflicts_with_all = ["views", "visits"])]
    view: Option<u64>,
    /// Folder for a picture of each processing stage of the views that fail, or of the one view
    #[arg(short, long, value_name = "DIR")]
    out_dir: Option<PathBuf>,
    #[command(flatten)]
    report: ReportArguments,
}

impl EvaluateVisionArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        let sheet = self.report.begin()?;
        if let Some(folder) = &self.out_dir {
            output::make_folder(folder)?;
        }
        let views = self.source()?;
        match self.view {
            _ if self.clutter => clutter::measure(judge, &views, self.views, sheet, out),
            Some(number) => self.one(&views, number, sheet, out),
            None => self.all(&views, sheet, out),
        }
    }

    fn all(
        &self,
        views: &ViewSampler,
        mut sheet: EvaluationReport,
        out: &mut dyn Write,
    ) -> Result<Outcome, CliError> {
        let calibrations = self.calibrations();
        let judge = judge(views, calibrations)?;
        let visits = self.visits.unwrap_or(self.views / 20);
        vision_report::add_source(&mut sheet, [self.views, visits], views)?;
        let mut statuses = Vec::new();
        let mut ending = MeasurementEnd::Whole;
        for &calibration in calibrations {
            let (judged, judged_visits) = self.measure(&judge, views, visits, calibration)?;
            if (judged.len() as u64) < self.views || (judged_visits.len() as u64) < visits {
                ending = MeasurementEnd::Interrupted;
            }
            let report = VisionReport::of(&judged, &judged_visits, calibration);
            vision_report::add(&mut sheet, &report)?;
            if calibration == Calibration::Right {
                vision_report::add_groups(&mut sheet, &groups(&judged))?;
            }
            statuses.extend(report.statuses());
            if let Some(folder) = &self.out_dir {
                let written = failing::write(folder, &judge, &judged, &judged_visits, calibration)?;
                remark!("{written} in {}", folder.display());
            }
        }
        let status = statuses.iter().copied().max().unwrap_or(TargetStatus::NotShown);
        let outcome = outcome(status, ending);
        let count = |is| statuses.iter().filter(|&&status| status == is).count();
        let line = json!({
            "missed": count(TargetStatus::Missed), "not_shown": count(TargetStatus::NotShown),
            "interrupted": matches!(ending, MeasurementEnd::Interrupted),
        });
        let verdict = verdict_on_targets(outcome, ending, statuses);
        sheet.finish(out, ("verdict", &line), outcome, &format!("\n{verdict}"))
    }

    fn measure(
        &self,
        judge: &Judge,
        views: &ViewSampler,
        visits: u64,
        calibration: Calibration,
    ) -> Result<(Vec<JudgedView>, Vec<JudgedVisit>), CliError> {
        let calibrated = match calibration {
            Calibration::Right => "",
            Calibration::Wrong => ", badly calibrated",
        };
        let progress = Progress::new(&format!("views{calibrated}"), "views")?;
        let judged =
            judge.views(views, 0..self.views, calibration, &progress).map_err(unmeasured)?;
        progress.finish();
        let progress = Progress::new(&format!("visits{calibrated}"), "visits")?;
        let visits = judge.visits(views, 0..visits, calibration, &progress).map_err(unmeasured)?;
        progress.finish();
        Ok((judged, visits))
    }

    /// Measures one view.
    fn one(
        &self,
        views: &ViewSampler,
        number: u64,
        mut sheet: EvaluationReport,
        out: &mut dyn Write,
    ) -> Result<Outcome, CliError> {
        let view = views.view(number).map_err(unmeasured)?;
        // Learn only the colours that this view needs.
        let views =
            ViewSampler { sizes: vec![view.image], looks: vec![view.look], ..views.clone() };
        let calibrations = self.calibrations();
        let judge = judge(&views, calibrations)?;
        let mut outcome = Outcome::Holds;
        for &calibration in calibrations {
            let judged = judge.view(view.clone(), calibration).map_err(unmeasured)?;
            failing::add(&mut sheet, &judged, calibration)?;
            if judged.verdict.is_wrong() {
                outcome = Outcome::Violated;
            }
            if let Some(folder) = &self.out_dir {
                failing::write_view(folder, &judge, &judged, calibration)?;
            }
        }
        sheet.print(out, outcome)
    }

    fn calibrations(&self) -> &'static [Calibration] {
        if self.calibration_errors {
            &[Calibration::Right, Calibration::Wrong]
        } else {
            &[Calibration::Right]
        }
    }

    /// The sampler of the views.
    fn source(&self) -> Result<ViewSampler, CliError> {
        let given = self.plan.iter().map(|path| read_plan(path)).collect::<Result<Vec<_>, _>>()?;
        Ok(ViewSampler {
            seed: self.seed,
            random_plans: given.is_empty(),
            plans: if given.is_empty() { plans().map_err(unmeasured)? } else { given },
            looks: if self.look.is_empty() { LOOKS.iter().collect() } else { self.look.clone() },
            sizes: match self.size {
                Some(size) => vec![size.pixels()],
                None => vec![ImageSize::Large.pixels(), ImageSize::Small.pixels()],
            },
            effects: match self.effects {
                EffectsChoice::Default => WhichEffects::Default,
                EffectsChoice::None => WhichEffects::None,
            },
            settings: settings(&self.effect)?,
        })
    }
}

/// The judge of views, with the camera as their effects make it.
fn judge(views: &ViewSampler, calibrations: &[Calibration]) -> Result<Judge, CliError> {
    let effects = views.settings.applied(Effects::plain());
    let camera = camera_with(&effects, &Camera::superscout())?;
    let progress = Progress::new("learning colours", "looks")?;
    let judge = Judge::new(&camera, views, calibrations, &progress);
    progress.finish();
    judge.map_err(|error| match error {
        JudgingError::Learning(error) => unlearned(error),
        error => unmeasured(error),
    })
}

pub(super) fn read_plan(path: &Path) -> Result<(String, Arc<FloorPlan>), CliError> {
    let world = input::read_world(path)?;
    let plan = input::floor_plan(path, &world)?.clone();
    Ok((world.name, Arc::new(plan)))
}
