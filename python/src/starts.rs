//! Every start of a class, once, and the judgement of a map of it.

use std::{ops::ControlFlow, sync::Arc};

use pyo3::prelude::*;
use toposlam_model::{
    check::judge_map,
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Class, Each, Enumeration, Watch},
    folding::certificate_length,
    format::named_world::NamedWorld,
    isomorphism::{Bijection, Candidate, isomorphism},
    mapping::{ExploredMap, Flaw},
};

use crate::{
    error::{error, guarded, interrupted},
    long_work::run_watched,
    robot::Robot,
    world::{CoreWorld, graph_of, named_marker},
};

/// A start: a world, and the robot's facing dart in it, which is dart 0.
#[pyclass(frozen, module = "toposlam._core")]
pub(crate) struct Start {
    graph: Arc<EmbeddedGraph>,
    /// Its number among the starts with as many edges, from 0.
    #[pyo3(get)]
    number: u64,
}

const FACING: Dart = Dart(0);

#[pymethods]
impl Start {
    /// The start of a world.
    #[staticmethod]
    fn of(py: Python<'_>, world: &CoreWorld, facing: u32) -> PyResult<Self> {
        let facing = world.dart(py, facing)?;
        let graph = toposlam_model::isomorphism::as_discovered(&world.0.graph, facing);
        Ok(Self { graph: Arc::new(graph), number: 0 })
    }

    #[getter]
    fn edges(&self) -> usize {
        self.graph.edge_count()
    }

    /// The length of its certificate.
    #[getter]
    fn certificate(&self) -> usize {
        certificate_length(&self.graph, FACING)
    }

    /// The start as a world.
    fn world(&self, name: &str) -> CoreWorld {
        CoreWorld(NamedWorld::discovered(name, "", &self.graph, FACING))
    }

    /// A robot at the start. Its run ends with the first action that is not possible.
    fn robot(&self, py: Python<'_>, marker: &str, max_moves: usize) -> PyResult<Robot> {
        let marker = named_marker(py, marker)?;
        Ok(Robot::new(self.graph.clone(), marker, FACING, max_moves).ending_at_refusal())
    }

    /// Judges a map: doors, the facing dart and the robot's pose in it. Returns None if it is right and the
    /// walk determines the world; or else what is wrong: "wrong-map", "wrong-pose" or "guessed", in words, and
    /// the pose that is right if only the pose is wrong.
    fn judge(
        &self,
        py: Python<'_>,
        robot: &Robot,
        doors: (Vec<u32>, Vec<u32>),
        facing: u32,
        pose: u32,
    ) -> PyResult<Option<Wrong>> {
        guarded(py, || self.judged(py, robot, doors, (facing, pose)))
    }
}

/// What is wrong: its name, in words, and the pose that is right if only the pose is wrong.
type Wrong = (&'static str, String, Option<u32>);

impl Start {
    fn judged(
        &self,
        py: Python<'_>,
        robot: &Robot,
        doors: (Vec<u32>, Vec<u32>),
        (facing, pose): (u32, u32),
    ) -> PyResult<Option<Wrong>> {
        let failed = |text: &dyn std::fmt::Display| error(py, "AnswerError", text);
        let map = graph_of(&doors.0, &doors.1).map_err(|fault| failed(&fault))?;
        let explored = ExploredMap {
            graph: std::borrow::Cow::Borrowed(&map),
            facing: Dart(facing),
            pose: Dart(pose),
        };
        let mut candidate = Candidate::default();
        let truly = robot.pose();
        match judge_map(&explored, (&self.graph, FACING), truly, &mut candidate) {
            Ok(_) if robot.determines_world() == Some(false) => {
                let text = "it guessed: the map is right, but there is another world in which it makes the \
                            same walk, and returns the same map";
                Ok(Some(("guessed", text.to_owned(), None)))
            }
            Ok(_) => Ok(None),
            Err(flaw @ Flaw::WrongPose { .. }) => {
                let bijection = Bijection::of_starts((&map, Dart(facing)), (&self.graph, FACING));
                let right = map.darts().find(|&dart| bijection.image(dart) == Some(truly));
                Ok(Some(("wrong-pose", flaw.to_string(), right.map(|dart| dart.0))))
            }
            Err(Flaw::WrongMap) => {
                let text = match isomorphism(&map, &self.graph) {
                    Ok(_) => {
                        "the map is that of the world, but its start is at another place".to_owned()
                    }
                    Err(difference) => format!("the map is not the world: {difference}"),
                };
                Ok(Some(("wrong-map", text, None)))
            }
            Err(flaw) => Err(failed(&flaw)),
        }
    }
}

fn starts(py: Python<'_>, class: &str, edges: usize) -> PyResult<Enumeration> {
    let class: Class = class.parse().map_err(|unknown| error(py, "UnknownClassError", unknown))?;
    Enumeration::new(Each::Start, class, edges).map_err(|cause| error(py, "SizeError", cause))
}

/// Calls `visit` with each start of one shard, `index` of `of`, in order.
#[pyfunction]
pub(crate) fn visit_starts(
    py: Python<'_>,
    class_: &str,
    edges: usize,
    index: u64,
    of: u64,
    visit: &Bound<'_, PyAny>,
) -> PyResult<()> {
    if index >= of {
        return Err(error(py, "ShardError", format!("there is no shard {index} of {of}")));
    }
    let mut number = 0;
    let mut failed = None;
    let _ = starts(py, class_, edges)?.for_each(&mut |found| {
        let mine = number % of == index;
        let visited = if mine {
            let start = Start { graph: Arc::new(found.graph.clone()), number };
            visit.call1((start,)).map(drop)
        } else if number % 65_536 == 0 {
            py.check_signals()
        } else {
            Ok(())
        };
        number += 1;
        match visited {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => {
                failed = Some(error);
                ControlFlow::Break(())
            }
        }
    });
    failed.map_or(Ok(()), Err)
}

/// The number of starts.
#[pyfunction]
pub(crate) fn count_starts(py: Python<'_>, class_: &str, edges: usize) -> PyResult<u64> {
    let starts = starts(py, class_, edges)?;
    let count = run_watched(py, None, None, |watcher| {
        let mut count = 0;
        let end = starts.for_each(&mut |_| {
            count += 1;
            if watcher.stop() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        end.is_continue().then_some(count)
    })?;
    count.ok_or_else(interrupted)
}
