//! Every start of a class, once, and the judgement of a map of it.

use std::sync::Arc;

use pyo3::prelude::*;
use toposlam_model::{
    check::judge_map,
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Class, Each, EnumeratedGraphs, Enumeration, SearchEnd, Watch},
    folding::certificate_length,
    format::named_world::NamedWorld,
    isomorphism::{Bijection, Candidate, isomorphism},
    mapping::{ExploredMap, Flaw},
};

use crate::{
    error::{error, guarded, interrupted},
    long_work::run_watched,
    robot::Robot,
    world::{CoreWorld, graph_of},
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
    /// The start of a world, with this number.
    #[staticmethod]
    fn of(py: Python<'_>, world: &CoreWorld, facing: u32, number: u64) -> PyResult<Self> {
        let facing = world.dart(py, facing)?;
        let graph = toposlam_model::isomorphism::as_discovered(&world.0.graph, facing);
        Ok(Self { graph: Arc::new(graph), number })
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

    /// A robot at the start. Its run ends with the first action that is not possible. `marker` is a kind, or what the
    /// robot senses at each pose.
    fn robot(&self, marker: &Bound<'_, PyAny>, max_moves: usize) -> PyResult<Robot> {
        Ok(Robot::new(self.graph.clone(), FACING, marker, max_moves)?.ending_at_refusal())
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

pub(crate) fn named_class(py: Python<'_>, name: &str) -> PyResult<Class> {
    name.parse().map_err(|unknown| error(py, "UnknownClassError", unknown))
}

fn enumeration(py: Python<'_>, each: &str, class: &str, edges: usize) -> PyResult<Enumeration> {
    let class = named_class(py, class)?;
    let each = if each == "world" { Each::World } else { Each::Start };
    Enumeration::new(each, class, edges).map_err(|cause| error(py, "SizeError", cause))
}

/// The steps of a search after which signals are looked at.
const PATIENCE: u64 = 65_536;

/// The starts, or the worlds, each with its least start, of one shard, `index` of `of`. The next one is made when it is
/// asked for.
#[pyclass(module = "toposlam._core")]
pub(crate) struct Starts {
    graphs: EnumeratedGraphs,
    next: u64,
    index: u64,
    of: u64,
}

#[pymethods]
impl Starts {
    #[new]
    fn new(
        py: Python<'_>,
        each: &str,
        class_: &str,
        edges: usize,
        index: u64,
        of: u64,
    ) -> PyResult<Self> {
        if index >= of {
            return Err(error(py, "ShardError", format!("there is no shard {index} of {of}")));
        }
        let graphs = enumeration(py, each, class_, edges)?.graphs();
        Ok(Self { graphs, next: 0, index, of })
    }

    fn __iter__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __next__(&mut self, py: Python<'_>) -> PyResult<Option<Start>> {
        loop {
            match self.search(py) {
                SearchEnd::Found => {
                    let number = self.next - 1;
                    let graph = Arc::new(self.graphs.graph().clone());
                    return Ok(Some(Start { graph, number }));
                }
                SearchEnd::Paused => py.check_signals()?,
                SearchEnd::Finished => return Ok(None),
            }
        }
    }
}

impl Starts {
    /// Searches for the next one of the shard.
    fn search(&mut self, py: Python<'_>) -> SearchEnd {
        py.detach(|| {
            for _ in 0..PATIENCE {
                match self.graphs.search(PATIENCE) {
                    SearchEnd::Found => self.next += 1,
                    end => return end,
                }
                if (self.next - 1) % self.of == self.index {
                    return SearchEnd::Found;
                }
            }
            SearchEnd::Paused
        })
    }
}

/// The number of starts, or of worlds.
#[pyfunction]
pub(crate) fn count_starts(
    py: Python<'_>,
    each: &str,
    class_: &str,
    edges: usize,
) -> PyResult<u64> {
    let graphs = enumeration(py, each, class_, edges)?;
    let count = run_watched(py, None, None, |watcher| {
        let mut graphs = graphs.graphs();
        let mut count = 0;
        while !watcher.stop() {
            match graphs.search(PATIENCE) {
                SearchEnd::Found => count += 1,
                SearchEnd::Paused => {}
                SearchEnd::Finished => return Some(count),
            }
        }
        None
    })?;
    count.ok_or_else(interrupted)
}
