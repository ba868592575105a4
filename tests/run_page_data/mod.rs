//! What the page of a run shows: a simulated robot maps a floor plan from simulated scenes, without images.

use std::{fs, path::Path, sync::Arc};

use toposlam_draw::run_page_data::{MappingStep, PageArrival, PageFrame, RunPageData};
use toposlam_logs::record::{Event, EventKind, NoSensor, RunObserver};
use toposlam_model::{
    driving::algorithm2::PathState,
    embedded_graph::Dart,
    floor_plan::JunctionKind,
    format::world_file,
    mapping::{DEFAULT_DART_BOUND, MapWalk, MappingAlgorithm, MappingEvent},
    percept::Door,
};
use toposlam_robot::run_settings::RunSettings;
use toposlam_simulator::{SimulationConfig, run::run};

/// Records a run.
struct Keeper {
    run_data: RunPageData,
    moves: u64,
    door: Option<Door>,
    /// A few images. Each is used for as many rounds as there are images, then a round has none.
    images: Vec<Vec<u8>>,
}

impl RunObserver for Keeper {
    fn event(&mut self, event: &Event) {
        let run_data = &mut self.run_data;
        let rounds = run_data.rounds.len();
        let pose = event.truth.unwrap();
        match &event.kind {
            EventKind::Frame(frame) => {
                let turn = rounds / self.images.len().max(1) % (self.images.len() + 1);
                run_data.rounds.push(PageFrame {
                    time: event.time as f64 / 1e9,
                    pose,
                    moves: self.moves,
                    state: PathState::Unknown,
                    scene: frame.scene.clone(),
                    command: None,
                    image: self.images.get(turn).cloned(),
                    steps: run_data.steps.len(),
                });
            }
            EventKind::Command { state, command } => {
                let last = run_data.rounds.last_mut().unwrap();
                (last.state, last.command) = (*state, *command);
            }
            EventKind::Door { door, .. } => {
                self.moves += 1;
                self.door = Some(*door);
            }
            EventKind::Arrival(arrival) => {
                let percept = arrival.percept().unwrap();
                let door = self.door;
                run_data.calls.push(PageArrival { rounds, pose, door, percept, conforms: true });
            }
            _ => {}
        }
    }

    fn mapping(&mut self, journey: &MapWalk, event: MappingEvent) {
        self.run_data.steps.push(MappingStep { walk: journey.clone(), event });
    }
}

/// What the page of a run shows, of a run in one of the worlds of this repository, with these images.
pub(crate) fn run_page_data(world: &str, images: Vec<Vec<u8>>) -> RunPageData {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("worlds").join(format!("{world}.toml"));
    let world = world_file::read(&fs::read(path).unwrap()).unwrap();
    let plan = Arc::new(world.plan.clone().unwrap());
    let is_l = |dart: &Dart| plan.junction(plan.graph().vertex(*dart)).kind == JunctionKind::L;
    let facing = world.start.filter(is_l).or_else(|| plan.graph().darts().find(is_l)).unwrap();
    let run_data = RunPageData {
        world,
        plan: plan.clone(),
        facing,
        rounds: Vec::new(),
        calls: Vec::new(),
        steps: Vec::new(),
        ending: String::new(),
    };
    let robot = SimulationConfig::at_start(plan.clone(), facing, 1).by_scene();
    let mut keeper = Keeper { run_data, moves: 0, door: None, images };
    let algorithm = MappingAlgorithm::Algorithm1;
    let settings = RunSettings::new(algorithm, DEFAULT_DART_BOUND);
    let run = run(&plan, facing, robot, NoSensor, &mut keeper, &settings);
    let mut run_data = keeper.run_data;
    run_data.ending = run.outcome().to_string();
    for (call, arrival) in run_data.calls.iter_mut().zip(run.monitor.arrivals()) {
        call.conforms = arrival.conforms();
    }
    run_data
}
