//! Algorithm 1 with all choices as a model of stateright, and as `toposlam check --choices all`, on the same starts and
//! on one thread: `cargo bench -p toposlam-model --bench stateright`. The items are states at line 4, each visited once
//! by both.

#![allow(clippy::unwrap_used, reason = "a benchmark may panic")]

use std::{
    hash::{Hash, Hasher},
    ops::ControlFlow,
};

use divan::{Bencher, counter::ItemsCount};
use stateright::{Checker, Model, Property};
use toposlam_model::{
    aid,
    check::{Check, DEFAULT_STATE_BUDGET, RunChoices, Shard, judge_map},
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Class, Each, Enumeration},
    isomorphism::Candidate,
    mapping::{Algorithm1Run, Explorer, FACING, MappingChoice},
    marker::DirectionalMarker,
    world::GraphWorld,
};

/// Numbers of edges, and of states. A test takes the smaller one.
const SIZES: &[(usize, u64)] =
    if cfg!(debug_assertions) { &[(4, 16_471)] } else { &[(4, 16_471), (5, 468_929)] };

fn main() {
    divan::main();
}

#[divan::bench(args = SIZES, sample_count = 3)]
fn toposlam(bencher: Bencher, (edges, states): (usize, u64)) {
    let check = Check::new(Class::Multigraph, edges, Shard::WHOLE).unwrap();
    let all = RunChoices::All { budget: DEFAULT_STATE_BUDGET };
    bencher.counter(ItemsCount::new(states)).bench(|| {
        let tally = check.run(Algorithm1Run::default, all, &());
        assert_eq!((tally.failed(), tally.states), (0, states));
    });
}

#[divan::bench(args = SIZES, sample_count = 3)]
fn stateright(bencher: Bencher, (edges, states): (usize, u64)) {
    bencher.counter(ItemsCount::new(states)).bench(|| {
        let checker = AllChoices::new(edges).checker().threads(1).spawn_dfs().join();
        checker.assert_properties();
        // Those at line 8, too.
        assert!(checker.unique_state_count() as u64 > states);
    });
}

/// Algorithm 1 on every start with so many edges.
struct AllChoices {
    starts: Vec<EmbeddedGraph>,
}

/// A run that waits for a choice, and the robot's pose in its world.
#[derive(Clone, Debug)]
struct Waiting {
    start: usize,
    run: Algorithm1Run,
    pose: Dart,
}

impl AllChoices {
    fn new(edges: usize) -> Self {
        let mut starts = Vec::new();
        let all = Enumeration::new(Each::Start, Class::Multigraph, edges).unwrap();
        let _ = all.for_each(&mut |start| {
            starts.push(start.graph.clone());
            ControlFlow::Continue(())
        });
        Self { starts }
    }

    fn world(&self, start: usize, pose: Dart) -> GraphWorld<'_, DirectionalMarker> {
        let state = aid::State { pose, placed: FACING };
        GraphWorld::in_state(&self.starts[start], DirectionalMarker, state)
    }

    fn is_right(&self, waiting: &Waiting) -> bool {
        let start = (&self.starts[waiting.start], FACING);
        let map = waiting.run.explored().unwrap();
        judge_map(&map, start, waiting.pose, &mut Candidate::default()).is_ok()
    }
}

impl Waiting {
    /// What distinguishes it from others, as in `check`: at line 4 the map and the robot's vertex, and at line 8 the
    /// place and the hypotheses that are left.
    fn key(&self) -> impl Hash + PartialEq + '_ {
        let Self { start, run, pose } = self;
        let vertex = run.map().vertex(run.robot());
        let place = if run.hypotheses().is_empty() { vertex.0 } else { pose.0 };
        (start, run.map(), run.hypotheses(), place)
    }
}

impl Hash for Waiting {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.key().hash(state);
    }
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.key() == other.key()
    }
}

impl Model for AllChoices {
    type State = Waiting;
    type Action = MappingChoice;

    fn init_states(&self) -> Vec<Waiting> {
        let begun = |start: usize| {
            let mut run = Algorithm1Run::default();
            run.begin(&mut self.world(start, FACING)).unwrap();
            Waiting { start, run, pose: FACING }
        };
        (0..self.starts.len()).map(begun).collect()
    }

    fn actions(&self, waiting: &Waiting, actions: &mut Vec<MappingChoice>) {
        waiting.run.clone().add_choices(actions).unwrap();
    }

    fn next_state(&self, waiting: &Waiting, choice: MappingChoice) -> Option<Waiting> {
        let mut next = waiting.clone();
        let mut world = self.world(next.start, next.pose);
        next.run.step(choice, &mut world).ok()?;
        next.pose = world.pose();
        Some(next)
    }

    fn properties(&self) -> Vec<Property<Self>> {
        vec![Property::always("the map is the world", |model: &Self, waiting: &Waiting| {
            !waiting.run.map().unexplored_is_empty() || model.is_right(waiting)
        })]
    }
}
