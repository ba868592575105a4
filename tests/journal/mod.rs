//! The journal of a run: a simulated robot, which is told scenes instead of seeing pictures, maps a
//! floor plan.

use std::{cell::RefCell, fs, path::Path, rc::Rc, sync::Arc};

use toposlam::journal::{Call, Journal, Round};
use toposlam_model::{
    driving::{
        algorithm2::{Standing, Step},
        scene::Place,
    },
    embedded_graph::Dart,
    floor_plan::JunctionKind,
    format::world_file,
    mapping::{DEFAULT_DART_BOUND, Journey, MappingEvent},
    percept::Door,
};
use toposlam_robot::{
    explorer::{self, Observer, Told},
    run::run,
    simulator::{SimulatedCamera, SimulatedRobot, SimulationConfig},
};

/// Keeps what a robot does.
struct Keeper {
    journal: Rc<RefCell<Journal>>,
    /// A few pictures, which come in turns: each stands for as many rounds as there are of them, and
    /// then a round has none.
    pictures: Vec<Vec<u8>>,
}

impl<C: SimulatedCamera> Observer<SimulatedRobot<C>> for Keeper {
    fn round(&mut self, robot: &SimulatedRobot<C>, round: &explorer::Round<C::View>) {
        let mut journal = self.journal.borrow_mut();
        let number = journal.rounds.len();
        let turn = number / self.pictures.len().max(1) % (self.pictures.len() + 1);
        let kept = Round {
            time: robot.time(),
            pose: robot.pose(),
            moves: round.moves,
            state: round.state,
            scene: in_words(&round.scene.place),
            command: match round.step {
                Ok(Step::Go(command)) => Some(*command),
                _ => None,
            },
            picture: self.pictures.get(turn).cloned(),
            story: journal.story.len(),
            maps: journal.maps.len(),
        };
        journal.rounds.push(kept);
    }

    fn arrived(&mut self, robot: &SimulatedRobot<C>, _: Option<Door>, at: &Standing) {
        let mut journal = self.journal.borrow_mut();
        let call = Call {
            rounds: journal.rounds.len(),
            pose: robot.pose(),
            percept: at.percept,
            conforms: true,
        };
        journal.calls.push(call);
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

/// The journal of a run in one of the worlds of this repository, with these pictures.
pub(crate) fn journal(world: &str, pictures: Vec<Vec<u8>>) -> Journal {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("worlds").join(format!("{world}.toml"));
    let world = world_file::read(&fs::read(path).unwrap()).unwrap();
    let plan = Arc::new(world.plan.unwrap());
    let is_l = |dart: &Dart| plan.junction(plan.graph().vertex(*dart)).kind == JunctionKind::L;
    let facing = world.start.filter(is_l).or_else(|| plan.graph().darts().find(is_l)).unwrap();
    let journal = Rc::new(RefCell::new(Journal {
        name: world.name,
        plan: plan.clone(),
        facing,
        rounds: Vec::new(),
        calls: Vec::new(),
        story: Vec::new(),
        maps: Vec::new(),
        ending: String::new(),
    }));
    let robot = SimulationConfig::at_start(plan.clone(), facing, 1).by_scene();
    let mut story = |_: &mut _, journey: &Journey, event: MappingEvent| {
        let mut journal = journal.borrow_mut();
        journal.story.push(format!("{event:?}"));
        match event {
            MappingEvent::Started { .. }
            | MappingEvent::LoopClosed { .. }
            | MappingEvent::VertexAdded { .. } => {
                journal.maps.push(journey.map().clone());
            }
            _ => {}
        }
    };
    let keeper = Keeper { journal: journal.clone(), pictures };
    let (run, ..) = run(&plan, facing, robot, Told, keeper, &mut story, DEFAULT_DART_BOUND);
    let mut journal = journal.borrow().clone();
    journal.ending = run.ending().to_string();
    for (call, arrival) in journal.calls.iter_mut().zip(run.specification.arrivals()) {
        call.conforms = arrival.conforms();
    }
    journal
}
