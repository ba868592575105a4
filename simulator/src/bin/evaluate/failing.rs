//! Views on which sensing fails: a picture of each processing stage, the truth and the scene.

use std::{collections::BTreeMap, io::Write, path::Path};

use serde::Serialize;
use toposlam_model::{
    driving::scene::MarkerView,
    floor_plan::FloorPlan,
    format::{named_world::NamedWorld, world_file},
};
use toposlam_terminal::{
    CliError,
    json::print_line,
    output, picture_file,
    progress::must_stop,
    scene::{self, SceneLine},
    text::{counted, print_hanging},
};

use super::report::EvaluationReport;
use toposlam_vision::annotate;

use toposlam_simulator::{
    evaluation::{
        judge::{Calibration, Judge},
        judged_view::{JudgedView, JudgedVisit, SceneClass},
        verdict::{MarkerVerdict, PlaceVerdict},
    },
    truth::{JunctionTruth, MarkerTruth, Truth},
    view_sampler::RenderedView,
};

/// The most views, and the most visits, of which pictures are written: first the wrong ones, then the
/// unknown ones.
const MOST: usize = 40;

/// Writes the views and visits that failed to a folder. Returns their number in words.
pub(super) fn write(
    folder: &Path,
    judge: &Judge,
    views: &[JudgedView],
    visits: &[JudgedVisit],
    calibration: Calibration,
) -> Result<String, CliError> {
    let mut failed: Vec<_> = views.iter().filter(|judged| fails(judged)).collect();
    let mut lines = Vec::new();
    for judged in &failed {
        print_view(&mut lines, judged, calibration, None)?;
    }
    let failed_visits: Vec<_> =
        visits.iter().filter(|visit| visit.decided != Some((visit.form, visit.percept))).collect();
    for judged in failed_visits.iter().flat_map(|visit| &visit.views) {
        print_view(&mut lines, judged, calibration, Some(judged.view.number))?;
    }
    let name = format!("failing{}.jsonl", mark(calibration));
    output::write_whole(&folder.join(name), &lines)?;
    failed.sort_by_key(|judged| !judged.verdict.is_wrong());
    for judged in failed.iter().take(MOST).take_while(|_| !must_stop()) {
        write_view(folder, judge, judged, calibration)?;
    }
    for visit in failed_visits.iter().take(MOST).take_while(|_| !must_stop()) {
        for (nth, judged) in visit.views.iter().enumerate() {
            let name = format!("visit-{:05}{}-{nth}", judged.view.number, mark(calibration));
            write_steps(&folder.join(name), judge, judged, calibration)?;
        }
    }
    let views = counted(failed.len(), "view");
    Ok(format!("{views} and {} that failed", counted(failed_visits.len(), "visit")))
}

/// Whether a view failed: it is not right in a hallway or before a junction, or wrong anywhere.
fn fails(judged: &JudgedView) -> bool {
    judged.verdict.is_wrong()
        || judged.counts() && judged.verdict == PlaceVerdict::Unknown
        || judged.marker == MarkerVerdict::Phantom
}

pub(super) fn write_view(
    folder: &Path,
    judge: &Judge,
    judged: &JudgedView,
    calibration: Calibration,
) -> Result<(), CliError> {
    let name = format!("view-{:05}{}", judged.view.number, mark(calibration));
    write_steps(&folder.join(name), judge, judged, calibration)
}

fn write_steps(
    folder: &Path,
    judge: &Judge,
    judged: &JudgedView,
    calibration: Calibration,
) -> Result<(), CliError> {
    output::make_folder(folder)?;
    let (image, _, stages) =
        judge.stages(&judged.view, calibration).map_err(|error| CliError::at("evaluate", error))?;
    picture_file::write(&folder.join("0-image.png"), &image)?;
    for (name, picture) in &stages {
        let path = folder.join(format!("{name}.png"));
        picture_file::write_stage(&path, &annotate::legend(name), picture)?;
    }
    let plan = world_file::to_toml(&plan_of(&judged.view));
    output::write_whole(&folder.join("plan.toml"), plan.as_bytes())?;
    let mut line = Vec::new();
    print_view(&mut line, judged, calibration, None)?;
    output::write_whole(&folder.join("view.json"), &line)
}

/// The floor plan of a view, as a world that starts at the marker.
fn plan_of(view: &RenderedView) -> NamedWorld {
    let plan = FloorPlan::clone(&view.plan);
    let about = format!("The floor plan of view {}", view.number);
    let names = plan.junctions().iter().map(|junction| junction.name.clone()).collect();
    let world = NamedWorld::numbered(&view.plan_name, &about, plan.graph().clone(), view.marker);
    NamedWorld { vertex_names: names, plan: Some(plan), ..world }
}

pub(super) fn calibration_name(calibration: Calibration) -> &'static str {
    match calibration {
        Calibration::Right => "right",
        Calibration::Wrong => "wrong",
    }
}

fn mark(calibration: Calibration) -> &'static str {
    match calibration {
        Calibration::Right => "",
        Calibration::Wrong => "-badly-calibrated",
    }
}

/// Adds one view: its settings, its scene and the verdict.
pub(super) fn add(
    sheet: &mut EvaluationReport,
    judged: &JudgedView,
    calibration: Calibration,
) -> Result<(), CliError> {
    let line = ViewLine::new(judged, calibration, None);
    sheet.line("view", &line)?;
    let out = &mut sheet.text;
    writeln!(out, "view {}, calibration {}: {}", line.view, line.calibration, line.verdict)?;
    let ([width, height], [x, y]) = (line.size, line.position);
    let heading = line.heading.to_degrees();
    let effects: Vec<_> =
        line.effects.iter().map(|(name, value)| format!("{name} {value:.2}")).collect();
    let effects = if effects.is_empty() { "none".to_owned() } else { effects.join(", ") };
    let distance = line.distance.map_or(String::new(), |distance| {
        format!(", {distance:.2} m from the turning point of a junction")
    });
    for (label, text) in [
        ("plan", format!("{}, look {}, {width} by {height} pixels", line.plan, line.look)),
        ("robot", format!("at {x:.2}, {y:.2} m, heading {heading:.0} degrees{distance}")),
        ("effects", effects),
        ("truth", line.truth),
        ("sensed", line.said),
    ] {
        print_hanging(out, &format!("  {label:<9}"), &text)?;
    }
    Ok(())
}

fn print_view(
    out: &mut dyn Write,
    judged: &JudgedView,
    calibration: Calibration,
    visit: Option<u64>,
) -> Result<(), CliError> {
    print_line(out, "view", &ViewLine::new(judged, calibration, visit))
}

#[derive(Serialize)]
struct ViewLine<'a> {
    view: u64,
    /// The number of the visit, if the view is part of one.
    #[serde(skip_serializing_if = "Option::is_none")]
    visit: Option<u64>,
    calibration: &'static str,
    plan: &'a str,
    hallway_width: f64,
    look: &'a str,
    size: [u32; 2],
    position: [f64; 2],
    heading: f64,
    marker: Option<scene::MarkerLine>,
    effects: BTreeMap<&'static str, f64>,
    truth: String,
    /// Distance to the turning point of the junction, in metres.
    distance: Option<f64>,
    said: String,
    verdict: String,
    answer: SceneLine,
}

impl<'a> ViewLine<'a> {
    fn new(judged: &'a JudgedView, calibration: Calibration, visit: Option<u64>) -> Self {
        let view = &judged.view;
        let settings = view.effects.settings().into_iter();
        let truth = match (&judged.truth, judged.class()) {
            (Truth::Between(..), _) => "between".to_owned(),
            (_, Some(class)) => class.to_string(),
            (_, None) => "turned".to_owned(),
        };
        Self {
            view: view.number,
            visit,
            calibration: calibration_name(calibration),
            plan: &view.plan_name,
            hallway_width: view.plan.hallway_width(),
            look: view.look.name,
            size: view.image,
            position: view.pose.position,
            heading: view.pose.heading,
            marker: view.marker().map(|marker| {
                let MarkerTruth { position, axis, door, .. } = marker;
                scene::MarkerLine::from(&MarkerView { position, axis, door })
            }),
            effects: settings.map(|(knob, value)| (knob.name, value)).collect(),
            truth,
            distance: judged.truth.junctions().first().and_then(JunctionTruth::distance),
            said: SceneClass::from_scene(&judged.scene).to_string(),
            verdict: judged.verdict.to_string(),
            answer: SceneLine::from(&judged.scene),
        }
    }
}
