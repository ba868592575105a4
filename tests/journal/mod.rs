//! The journal of a run: a simulated robot maps a floor plan from simulated scenes, without images.

use std::{fs, path::Path, sync::Arc};

use toposlam::journal::{FrameEntry, Journal, JunctionCall};
use toposlam_model::{
    driving::{algorithm2::PathState, scene::Place},
    embedded_graph::Dart,
    floor_plan::JunctionKind,
    format::world_file,
    mapping::{DEFAULT_DART_BOUND, DirectionalAlgorithm, Journey, MappingEvent},
    percept::Door,
};
use toposlam_robot::{
    record::{Event, EventKind, NoSensor, RunObserver},
    run::run,
    run_settings::RunSettings,
    simulator::SimulationConfig,
};

/// Records a run.
struct Keeper {
    journal: Journal,
    moves: u64,
    door: Option<Door>,
    /// A few images. Each is used for as many rounds as there are images, then a round has none.
    images: Vec<Vec<u8>>,
}

impl RunObserver for Keeper {
    fn event(&mut self, event: &Event) {
        let journal = &mut self.journal;
        let rounds = journal.rounds.len();
        let pose = event.truth.unwrap();
        match &event.kind {
            EventKind::Frame(frame) => {
                let turn = rounds / self.images.len().max(1) % (self.images.len() + 1);
                journal.rounds.push(FrameEntry {
                    time: event.time as f64 / 1e9,
                    pose,
                    moves: self.moves,
                    state: PathState::Unknown,
                    scene: in_words(&frame.scene.as_ref().unwrap().place),
                    command: None,
                    image: self.images.get(turn).cloned(),
                    story: journal.story.len(),
                    maps: journal.maps.len(),
                });
            }
            EventKind::Command { state, command } => {
                let last = journal.rounds.last_mut().unwrap();
                (last.state, last.command) = (*state, *command);
            }
            EventKind::Door { door, .. } => {
                self.moves += 1;
                self.door = Some(*door);
            }
            EventKind::Arrival(arrival) => {
                let percept = arrival.percept().unwrap();
                let door = self.door;
                journal.calls.push(JunctionCall { rounds, pose, door, percept, conforms: true });
            }
            _ => {}
        }
    }

    fn mapping(&mut self, journey: &Journey, event: MappingEvent) {
        self.journal.story.push(format!("{event:?}"));
        if event.grows_map() {
            self.journal.maps.push(journey.map().clone());
        }
    }
}

fn in_words(place: &Place) -> String {
    match place {
        Place::Hallway(hallway) => {
            format!(
                "a hallway, {:.2} m to the left, {:.2} m to the right",
                hallway.left, hallway.right
            )
        }
        Place::Junction(junction) => {
            format!(
                "a junction with {} doors, {:.2} m ahead",
                junction.doors.len(),
                junction.distance()
            )
        }
        Place::Unknown(reason) => format!("nothing that can be made out: {reason}"),
    }
}

/// The journal of a run in one of the worlds of this repository, with these images.
pub(crate) fn journal(world: &str, images: Vec<Vec<u8>>) -> Journal {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("worlds").join(format!("{world}.toml"));
    let world = world_file::read(&fs::read(path).unwrap()).unwrap();
    let plan = Arc::new(world.plan.unwrap());
    let is_l = |dart: &Dart| plan.junction(plan.graph().vertex(*dart)).kind == JunctionKind::L;
    let facing = world.start.filter(is_l).or_else(|| plan.graph().darts().find(is_l)).unwrap();
    let journal = Journal {
        name: world.name,
        plan: plan.clone(),
        facing,
        rounds: Vec::new(),
        calls: Vec::new(),
        story: Vec::new(),
        maps: Vec::new(),
        ending: String::new(),
    };
    let robot = SimulationConfig::at_start(plan.clone(), facing, 1).by_scene();
    let mut keeper = Keeper { journal, moves: 0, door: None, images };
    let algorithm = DirectionalAlgorithm::Algorithm1;
    let settings = RunSettings::new(algorithm, DEFAULT_DART_BOUND);
    let run = run(&plan, facing, robot, NoSensor, &mut keeper, &settings);
    let mut journal = keeper.journal;
    journal.ending = run.outcome().to_string();
    for (call, arrival) in journal.calls.iter_mut().zip(run.monitor.arrivals()) {
        call.conforms = arrival.conforms();
    }
    journal
}
