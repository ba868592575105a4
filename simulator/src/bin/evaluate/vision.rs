//! `evaluate vision`: compares the scenes of rendered views with the floor plan.

use std::{io::Write, path::PathBuf};

use serde_json::{Map, Value, json};
use toposlam_model::enumerate::Watch;
use toposlam_terminal::{
    CliError, Outcome,
    exit_codes::help_end,
    output,
    progress::Progress,
    remark,
    text::{counted, grouped, print_hanging},
};
use toposlam_vision::camera::Camera;

use super::{
    failing,
    report::{
        EvaluationReport, MeasurementEnd, ReportArguments, measure, number, unlearned, unmeasured,
    },
    robots::{given_looks, read_plans},
};
use toposlam_simulator::{
    BuildingLook, EffectSettings, Effects,
    evaluation::{
        bound::upper_bound,
        judge::{Calibration, Judge, JudgingError},
        judged_view::JudgedView,
        report::TargetStatus,
        vision_report,
    },
    options::appearance::{EffectSetting, ImageSize, camera_with, looks, read_setting, settings},
    plans,
    sample_verdict::SampleTally,
    view_sampler::{ViewSampler, WhichEffects},
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
    effects: WhichEffects,
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
            _ if self.clutter => self.with_clutter(&views, sheet, out),
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
        let wanted = [self.views, self.visits.unwrap_or(self.views / 20)];
        add_source(&mut sheet, wanted, views)?;
        let mut statuses = Vec::new();
        let mut ending = MeasurementEnd::Whole;
        for &calibration in calibrations {
            let is_right = calibration == Calibration::Right;
            let (title, calibrated) = if is_right {
                ("With a right calibration", "")
            } else {
                let title = "With a camera 5 pixels, 2 cm and 1 degree off its calibration";
                (title, ", badly calibrated")
            };
            let judged = judged_views(&judge, views, self.views, calibration, calibrated)?;
            let visits = measured("visits", calibrated, wanted[1], |number, watch| {
                judge.visit(views.visit(number)?, calibration, watch)
            })?;
            if [judged.len() as u64, visits.len() as u64] != wanted {
                ending = MeasurementEnd::Interrupted;
            }
            let figures = vision_report::figures(&judged, &visits, calibration);
            writeln!(sheet.text, "\n{title}\n")?;
            let name = failing::calibration_name(calibration);
            sheet.figures(&Map::from_iter([("calibration".to_owned(), name.into())]), &figures)?;
            sheet.groups(
                "Views",
                &figures.groups,
                |group| json!({ "failed": group.tally.failed(), "of": group.tally.all() }),
            )?;
            statuses.extend(figures.statuses());
            if let Some(folder) = &self.out_dir {
                let written = failing::write(folder, &judge, &judged, &visits, calibration)?;
                remark!("{written} in {}", folder.display());
            }
        }
        let status = statuses.iter().copied().max().unwrap_or(TargetStatus::NotShown);
        let outcome = ending.outcome(status);
        let count = |is| statuses.iter().filter(|&&status| status == is).count();
        let line = json!({
            "missed": count(TargetStatus::Missed), "not_shown": count(TargetStatus::NotShown),
            "interrupted": ending == MeasurementEnd::Interrupted,
        });
        let verdict = ending.verdict_on_targets(outcome, &statuses);
        sheet.finish(out, ("verdict", line), outcome, &format!("\n{verdict}"))
    }

    /// Measures the same views with each kind of clutter.
    fn with_clutter(
        &self,
        views: &ViewSampler,
        mut sheet: EvaluationReport,
        out: &mut dyn Write,
    ) -> Result<Outcome, CliError> {
        let mut rows = Vec::new();
        let [mut all, mut all_wrong] = [0; 2];
        let mut ending = MeasurementEnd::Whole;
        let together = [("all of these", CLUTTER.map(|(_, settings)| settings).concat())];
        let kinds = CLUTTER.map(|(name, settings)| (name, settings.to_vec()));
        for (name, clutter) in [("none", Vec::new())].into_iter().chain(kinds).chain(together) {
            let settings = EffectSettings::new(clutter.iter().copied()).map_err(unmeasured)?;
            let views = ViewSampler { settings, ..views.clone() };
            let judge = judge(&views, &[Calibration::Right])?;
            let what = format!(", clutter: {name}");
            let judged = judged_views(&judge, &views, self.views, Calibration::Right, &what)?;
            let counting = judged.iter().filter(|view| view.counts());
            let tally: SampleTally = counting.map(|view| view.verdict.verdict()).collect();
            let wrong = judged.iter().filter(|view| view.verdict.is_wrong()).count();
            let markers = judged.iter().filter(|view| view.has_wrong_marker()).count();
            let effects: Map<String, Value> =
                clutter.iter().map(|&(name, value)| (name.to_owned(), value.into())).collect();
            let line = json!({
                "clutter": name, "effects": effects, "views": tally.all(), "right": tally.right,
                "unknown": tally.undecided, "all_views": judged.len(), "wrong": wrong,
                "wrong_markers": markers,
            });
            sheet.line("clutter", &line)?;
            let [right, unknown] = [tally.right, tally.undecided]
                .map(|part| format!("{:.1} %", 100.0 * part as f64 / tally.all().max(1) as f64));
            let [wrong_scenes, wrong_markers] =
                [wrong, markers].map(|count| format!("{count} of {}", judged.len()));
            rows.push([
                name.to_owned(),
                right,
                unknown,
                wrong_scenes,
                wrong_markers,
                String::new(),
            ]);
            all += judged.len();
            all_wrong += wrong + markers;
            if (judged.len() as u64) < self.views {
                ending = MeasurementEnd::Interrupted;
                break;
            }
        }
        let status = TargetStatus::from_counts(all_wrong, all, 0.0);
        let count = grouped(self.views.into());
        writeln!(sheet.text, "Sensing on {count} views with each kind of clutter\n")?;
        let heads = ["clutter", ">right", ">unknown", ">wrong scenes", ">wrong markers", ""];
        sheet.table(heads, rows)?;
        let most = 100.0 * upper_bound(all_wrong, all.max(1));
        let [wrong, views] = [all_wrong, all].map(number);
        let status_name = status.name();
        writeln!(sheet.text, "\nwrong: {wrong} of {views}, at most {most:.3} % ({status_name})")?;
        sheet.print(out, ending.outcome(status))
    }

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

    fn source(&self) -> Result<ViewSampler, CliError> {
        let given = read_plans(&self.plan)?;
        Ok(ViewSampler {
            seed: self.seed,
            random_plans: given.is_empty(),
            plans: if given.is_empty() { plans().map_err(unmeasured)? } else { given },
            looks: given_looks(&self.look),
            sizes: match self.size {
                Some(size) => vec![size.pixels()],
                None => vec![ImageSize::Large.pixels(), ImageSize::Small.pixels()],
            },
            effects: self.effects,
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

/// Judges views or visits on all threads.
fn measured<R: Send>(
    unit: &'static str,
    what: &str,
    count: u64,
    one: impl Fn(u64, &dyn Watch) -> Result<Option<R>, JudgingError> + Sync,
) -> Result<Vec<R>, CliError> {
    let work = format!("{unit}{what}");
    let judged = measure(&work, unit, 0..count, |number, watch| one(number, watch).transpose())?;
    judged.into_iter().collect::<Result<_, _>>().map_err(unmeasured)
}

fn judged_views(
    judge: &Judge,
    views: &ViewSampler,
    count: u64,
    calibration: Calibration,
    what: &str,
) -> Result<Vec<JudgedView>, CliError> {
    measured("views", what, count, |number, _| {
        Ok(Some(judge.view(views.view(number)?, calibration)?))
    })
}

/// Adds what is measured: the numbers of views and visits, and where they come from.
fn add_source(
    sheet: &mut EvaluationReport,
    [views, visits]: [u64; 2],
    source: &ViewSampler,
) -> Result<(), CliError> {
    let sizes = source.sizes.iter().map(|[width, height]| format!("{width}x{height}"));
    let sizes: Vec<_> = sizes.collect();
    let mut plans: Vec<_> = source.plans.iter().map(|(name, _)| name.as_str()).collect();
    if source.random_plans {
        plans.push("random plans");
    }
    let looks: Vec<_> = source.looks.iter().map(|look| look.name).collect();
    let effects = match source.effects {
        WhichEffects::Default => "default",
        WhichEffects::None => "none",
    };
    let seed = source.seed;
    let line = json!({
        "views": views, "visits": visits, "seed": seed,
        "sizes": sizes, "plans": plans, "looks": looks, "effects": effects,
    });
    sheet.line("source", &line)?;
    let text = &mut sheet.text;
    let [views, visits] =
        [(views, "view"), (visits, "visit")].map(|(count, noun)| counted(count as usize, noun));
    writeln!(text, "Sensing on {views} and {visits}, seed {seed}")?;
    print_hanging(text, "  floor plans  ", &plans.join(", "))?;
    print_hanging(text, "  looks        ", &looks.join(", "))?;
    writeln!(text, "  image sizes  {}", sizes.join(", "))?;
    Ok(writeln!(text, "  effects      {effects}")?)
}

/// Effects that are off by default, as a photograph of a real mirror camera shows them: a name, and the settings.
const CLUTTER: [(&str, &[(&str, f64)]); 7] = [
    ("furniture", &[("furniture", 5.0)]),
    ("cables", &[("cables", 6.0)]),
    ("wide struts", &[("strut-width", 14.0)]),
    ("open laptop", &[("laptop", 0.06)]),
    ("yellow cast", &[("cast", 0.77)]),
    ("cropped mirror", &[("zoom", 1.45), ("off-centre", -0.03)]),
    ("dark rim", &[("dark-rim", 0.65)]),
];
