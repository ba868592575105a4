//! A small run, for tests: two hallways meet at an L; the robot drives through the northern one and comes
//! back.

use std::sync::Arc;

use toposlam_model::{
    driving::{
        algorithm2::{Command, PathState},
        pose::Pose,
        scene::{Place, Reason, Scene},
    },
    embedded_graph::Dart,
    floor_plan::FloorPlan,
    format::{named_world::NamedWorld, world_file},
    mapping::{Algorithm1Run, MapWalk, MappingEvent, Observed, PartialMap, explore},
    marker::Directional,
    percept::{Door, Percept, Sighting},
    world::GraphWorld,
};

use crate::run_page_data::{MappingStep, PageArrival, PageFrame, RunPageData};

/// Seven frames; the last three images are the same, and the third call is wrong.
pub(crate) fn run_page_data() -> RunPageData {
    let places = [("corner", [0.0, 0.0]), ("north", [0.0, 4.0]), ("east", [4.0, 0.0])];
    let places = places.map(|(name, place)| (name.to_owned(), place));
    let hallways = [("corner", "north"), ("corner", "east")];
    let hallways = hallways.map(|(from, to)| (from.to_owned(), to.to_owned()));
    let plan = Arc::new(FloorPlan::new(1.6, &places, &hallways).unwrap());
    let facing = Dart(0);
    let round = |(number, y): (usize, f64)| PageFrame {
        time: 2.5 * number as f64,
        pose: Pose { position: [0.0, y], heading: std::f64::consts::FRAC_PI_2 },
        moves: number.div_ceil(3) as u64,
        state: PathState::Hallway,
        scene: Some(Scene { place: Place::Unknown(Reason::NoFloor), marker: None }),
        command: Some(Command { turn: 0.0, forward: 0.5 }),
        image: (number > 0).then(|| vec![number.min(4) as u8; 3]),
        steps: 1.min(number),
        aid: None,
    };
    let ways = [0.0, 0.6, 2.0, 4.0, 3.5, 2.0, 0.1];
    let rounds: Vec<_> = ways.into_iter().enumerate().map(round).collect();
    let call = |(frames, degree): (usize, u32)| PageArrival {
        rounds: frames,
        pose: rounds[frames - 1].pose,
        door: (frames > 1).then_some(Door(0)),
        percept: Percept { degree, sighting: Sighting::Nothing },
        conforms: frames < 7,
    };
    RunPageData {
        world: NamedWorld::numbered("two hallways", "", plan.graph().clone(), Some(facing)),
        steps: steps(&plan, facing),
        calls: [(1, 2), (4, 1), (7, 3)].map(call).to_vec(),
        plan,
        facing,
        aid: Directional.into(),
        rounds,
        ending: "the robot gave up".to_owned(),
    }
}

/// A world of this repository.
pub(crate) fn world(name: &str) -> NamedWorld {
    let path = format!("{}/../worlds/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    world_file::read(&std::fs::read(path).unwrap()).unwrap()
}

/// The steps of Algorithm 1 in a plan.
pub(crate) fn steps(plan: &FloorPlan, facing: Dart) -> Vec<MappingStep> {
    let mut steps = Vec::new();
    let mut watch = |_: &mut _, journey: &MapWalk, event: MappingEvent| {
        steps.push(MappingStep { walk: journey.clone(), event });
    };
    let mut world = GraphWorld::new(plan.graph(), facing);
    let world = &mut Observed::new(&mut world, &mut watch);
    explore(&mut Algorithm1Run::new(1000), world).unwrap();
    steps
}

/// The map of a plan whenever Algorithm 1 adds to it.
pub(crate) fn maps(plan: &FloorPlan, facing: Dart) -> Vec<PartialMap> {
    let steps = steps(plan, facing).into_iter().filter(|step| step.event.grows_map());
    steps.map(|step| step.walk.map().clone()).collect()
}
