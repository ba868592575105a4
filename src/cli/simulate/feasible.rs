//! Checks before a run that the robot can drive in the plan and see the marker.

use std::{collections::VecDeque, path::Path};

use toposlam_model::{
    driving::{pose::Pose, scene::Scene},
    embedded_graph::Dart,
    floor_plan::{FloorPlan, JunctionKind},
    format::named_world::NamedWorld,
    percept::Door,
};
use toposlam_robot::superscout::{CLEARANCE, RADIUS};
use toposlam_simulator::{
    Building, BuildingLook, Effects, LearnedSensors, render, starts_of, truth::angle,
};

use super::CliError;
use crate::cli::text::quoted;

/// The free width that the robot needs in a hallway besides its clearance, in metres.
const ROOM: f64 = 0.40;
/// The widest hallway in which sensing sees both walls, in metres.
const WIDEST: f64 = 2.3;
/// The marker must be visible from this distance to the centre of its junction, in metres.
const BEFORE: f64 = 0.5;

/// The L nearest to the plan's own start, entered on the way from there: a marker cannot be seen at a
/// dead end or at a T. `None` if the start is an L, or if the plan has none.
pub(super) fn nearest_start(plan: &FloorPlan, facing: Dart) -> Option<Dart> {
    let graph = plan.graph();
    let is_l = |dart: Dart| plan.junction(graph.vertex(dart)).kind == JunctionKind::L;
    if is_l(facing) {
        return None;
    }
    let mut known = vec![false; graph.vertex_count()];
    known[graph.vertex(facing).at()] = true;
    let mut reached = VecDeque::from([facing]);
    while let Some(entry) = reached.pop_front() {
        for dart in graph.darts_of(graph.vertex(entry)) {
            let next = graph.opposite(dart);
            if std::mem::replace(&mut known[graph.vertex(next).at()], true) {
                continue;
            }
            if is_l(next) {
                return Some(next);
            }
            reached.push_back(next);
        }
    }
    None
}

/// Rejects a plan in which the robot cannot drive, and a start that is not an L.
pub(super) fn check(
    path: &Path,
    world: &NamedWorld,
    plan: &FloorPlan,
    facing: Dart,
) -> Result<(), CliError> {
    let width = plan.hallway_width();
    let least = 2.0 * (RADIUS + CLEARANCE) + ROOM;
    if width < least {
        let cause = format!(
            "its hallways are {width} m wide; a robot {:.2} m across needs {least:.2} m",
            2.0 * RADIUS
        );
        return Err(CliError::in_file(path, cause));
    }
    if width > WIDEST {
        let cause = format!("its hallways are {width} m wide; sensing sees up to {WIDEST} m");
        return Err(CliError::in_file(path, cause));
    }
    let junction = plan.junction(plan.graph().vertex(facing));
    let kind = match junction.kind {
        JunctionKind::L => return Ok(()),
        JunctionKind::DeadEnd => "a dead end",
        JunctionKind::T => "a T",
    };
    let instead = match starts_of(plan).first() {
        Some(&start) => {
            format!("as in --start {}", quoted(&world.start_text(start)))
        }
        None => "and this plan has none".to_owned(),
    };
    let cause = format!("the start, {}, is {kind}; a run starts at an L, {instead}", junction.name);
    Err(CliError::in_file(path, cause))
}

/// Rejects a camera and colours with which the marker is not seen from the other door of its junction.
pub(super) fn check_marker(
    plan: &FloorPlan,
    facing: Dart,
    sensors: &LearnedSensors,
    look: &'static BuildingLook,
) -> Result<(), CliError> {
    let effects = Effects { body: 1.0, ..Effects::plain() };
    let building = Building::new(plan, look, Some(facing), &effects, 0);
    let onto = plan.direction(plan.graph().behind(facing, Door(1)));
    let [x, y] = plan.junction(plan.graph().vertex(facing)).position;
    let [east, north] = onto.vector();
    let position = [x + BEFORE * east, y + BEFORE * north];
    let pose = Pose { position, heading: angle(onto.reversed()) };
    let image = render(sensors.rig(), &building, pose, &effects, 0);
    match sensors.sensor(look).sense(&image) {
        Ok(Scene { marker: Some(_), .. }) => Ok(()),
        Ok(_) => {
            let cause =
                format!("with this camera and these colours, it is not seen from {BEFORE} m away");
            Err(CliError::at("the marker", cause))
        }
        Err(error) => Err(CliError::at("the camera", error)),
    }
}
