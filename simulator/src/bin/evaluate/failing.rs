//! Views on which sensing fails: a picture of each processing stage, the truth and the scene.

use std::{collections::BTreeMap, io::Write, path::Path};

use serde_json::{Value, json};
use toposlam_model::format::{named_world::NamedWorld, world_file};
use toposlam_terminal::{
    CliError,
    json::print_line,
    output, picture_file,
    progress::must_stop,
    scene::{MarkerLine, SceneLine},
    text::{counted, print_hanging},
};

use super::{failed_runs::plan_world, report::EvaluationReport};
use toposlam_vision::annotate;

use toposlam_simulator::{
    evaluation::{
        judge::{Calibration, Judge},
        judged_view::{JudgedView, JudgedVisit, SceneClass},
        verdict::{MarkerVerdict, PlaceVerdict},
    },
    truth::{JunctionTruth, Truth},
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
        visits.iter().filter(|visit| visit.decided != Some((visit.shape, visit.percept))).collect();
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
    let about = format!("The floor plan of view {}", view.number);
    plan_world(&view.plan_name, &about, &view.plan, view.marker)
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
    let line = view_line(judged, calibration, None);
    sheet.line("view", &line)?;
    let (view, out) = (&judged.view, &mut sheet.text);
    let name = calibration_name(calibration);
    writeln!(out, "view {}, calibration {name}: {}", view.number, judged.verdict)?;
    let ([width, height], [x, y]) = (view.image, view.pose.position);
    let heading = view.pose.heading.to_degrees();
    let effects = effects(view).into_iter().map(|(name, value)| format!("{name} {value:.2}"));
    let distance = distance(judged).map_or(String::new(), |distance| {
        format!(", {distance:.2} m from the turning point of a junction")
    });
    let (plan, look) = (&view.plan_name, view.look.name);
    for (label, text) in [
        ("plan", format!("{plan}, look {look}, {width} by {height} pixels")),
        ("robot", format!("at {x:.2}, {y:.2} m, heading {heading:.0} degrees{distance}")),
        ("effects", effects.collect::<Vec<_>>().join(", ")),
        ("truth", truth_name(judged)),
        ("sensed", SceneClass::from_scene(&judged.scene).to_string()),
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
    print_line(out, "view", &view_line(judged, calibration, visit))
}

/// All about a view, with the number of its visit if it is part of one.
fn view_line(judged: &JudgedView, calibration: Calibration, visit: Option<u64>) -> Value {
    let view = &judged.view;
    let mut line = json!({
        "view": view.number, "visit": visit, "calibration": calibration_name(calibration),
        "plan": view.plan_name, "hallway_width": view.plan.hallway_width(),
        "look": view.look.name, "size": view.image,
        "position": view.pose.position, "heading": view.pose.heading,
        "marker": view.marker().as_ref().map(MarkerLine::from), "effects": effects(view),
        "truth": truth_name(judged), "distance": distance(judged),
        "said": SceneClass::from_scene(&judged.scene).to_string(),
        "verdict": judged.verdict.to_string(), "answer": SceneLine::from(&judged.scene),
    });
    if let (None, Some(line)) = (visit, line.as_object_mut()) {
        line.shift_remove("visit");
    }
    line
}

fn effects(view: &RenderedView) -> BTreeMap<&'static str, f64> {
    view.effects.settings().into_iter().collect()
}

fn truth_name(judged: &JudgedView) -> String {
    match (&judged.truth, judged.class()) {
        (Truth::Between(..), _) => "between".to_owned(),
        (_, Some(class)) => class.to_string(),
        (_, None) => "turned".to_owned(),
    }
}

/// The distance to the turning point of the junction, in metres.
fn distance(judged: &JudgedView) -> Option<f64> {
    judged.truth.junctions().first().and_then(JunctionTruth::distance)
}
