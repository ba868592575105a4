//! The run of a robot that also measures lengths or has a compass, in a floor plan.

use std::io::Write;

use clap::ValueEnum;
use serde::Serialize;
use toposlam_model::{
    aid::AidKind,
    embedded_graph::Dart,
    floor_plan::FloorPlan,
    folding::{ArrivalSenses, LengthInterval},
    format::named_world::NamedWorld,
    isomorphism::Candidate,
    mapping::{Flaw, MappingAlgorithm, MappingError},
    percept::{CompassView, Door},
    world::{GraphWorld, SensingWorld},
};

use crate::cli::{
    CliError, Outcome,
    text::{counted, print_paragraph},
};

/// What a robot senses besides its percepts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub(super) enum ExtraSense {
    /// The lengths of the hallways that it drives through, exactly
    Lengths,
    /// The directions of the doors
    Compass,
}

/// A run with senses, or what is wrong with it.
#[derive(Debug, Serialize)]
pub(super) struct SensingRun {
    senses: Vec<ExtraSense>,
    #[serde(skip_serializing_if = "Option::is_none")]
    moves: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
    /// Whether it ended at the bound on darts.
    #[serde(skip)]
    is_at_bound: bool,
}

/// Checks that the world has what is sensed, and that the algorithm uses it.
///
/// # Errors
/// Returns an error if the world is not a floor plan, or if the algorithm uses percepts alone.
pub(super) fn check_senses(
    senses: &[ExtraSense],
    world: &NamedWorld,
    algorithm: MappingAlgorithm,
) -> Result<(), CliError> {
    let cause = if senses.is_empty() {
        return Ok(());
    } else if world.plan.is_none() {
        "this needs a floor plan: other world files have no positions of junctions".to_owned()
    } else if !algorithm.uses_senses() {
        format!("{} uses percepts alone; use --algorithm folding", algorithm.in_words())
    } else {
        return Ok(());
    };
    Err(CliError::at("--senses", cause))
}

impl SensingRun {
    /// A run in a floor plan; `None` without senses. `bound` is the most darts of the map.
    pub(super) fn new(
        senses: &[ExtraSense],
        algorithm: MappingAlgorithm,
        bound: usize,
        (world, facing): (&NamedWorld, Dart),
    ) -> Option<Self> {
        let plan = world.plan.as_ref().filter(|_| !senses.is_empty())?;
        let robot = GraphWorld::with_aid(&world.graph, algorithm.aid(), facing);
        let mut robot = SensingWorld::new(robot, |robot: &GraphWorld<'_, AidKind>| {
            sensed(senses, plan, robot.pose())
        });
        let (walk, mapped) = algorithm.map_world(&mut robot, bound, &mut ());
        let judged = mapped.map_err(Flaw::from).and_then(|()| {
            let (run, truly) = ((&walk, walk.robot()), robot.world().pose());
            let mut candidate = Candidate::default();
            algorithm.judge(run, (&world.graph, facing), truly, &mut candidate).map(|_| ())
        });
        let flaw = judged.err();
        let is_at_bound = matches!(flaw, Some(Flaw::Error(MappingError::Bound { .. })));
        let error = flaw.map(|flaw| flaw.to_string());
        let moves = error.is_none().then(|| walk.moves());
        Some(Self { senses: senses.to_vec(), moves, error, is_at_bound })
    }

    pub(super) fn outcome(&self) -> Outcome {
        match self.moves {
            Some(_) => Outcome::Holds,
            None if self.is_at_bound => Outcome::Incomplete,
            None => Outcome::Violated,
        }
    }

    pub(super) fn print(&self, out: &mut dyn Write) -> Result<(), CliError> {
        let with = match self.senses[..] {
            [ExtraSense::Lengths] => "lengths",
            [ExtraSense::Compass] => "a compass",
            _ => "lengths and a compass",
        };
        let text = match (&self.error, self.moves) {
            (Some(error), _) => format!("With {with}: {error}."),
            (None, moves) => {
                let moves = counted(moves.unwrap_or_default() as usize, "move");
                format!("With {with}, the map is complete after {moves}. It is right, too.")
            }
        };
        writeln!(out)?;
        Ok(print_paragraph(out, &text)?)
    }
}

/// What the robot senses where it came in by a dart. Lengths are in millimetres.
fn sensed(senses: &[ExtraSense], plan: &FloorPlan, pose: Dart) -> ArrivalSenses {
    let graph = plan.graph();
    let length = || {
        let [[x1, y1], [x2, y2]] =
            [pose, graph.opposite(pose)].map(|dart| plan.junction(graph.vertex(dart)).position);
        LengthInterval::exact((1e3 * (x2 - x1).hypot(y2 - y1)).round() as u32)
    };
    let compass = || {
        let doors = (0..graph.degree_around(pose)).map(Door);
        CompassView::new(doors.map(|door| plan.direction(graph.behind(pose, door))))
    };
    ArrivalSenses {
        length: senses.contains(&ExtraSense::Lengths).then(length),
        compass: senses.contains(&ExtraSense::Compass).then(compass),
    }
}
