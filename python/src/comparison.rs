//! Are two worlds isomorphic? Can a robot distinguish them?

use pyo3::{IntoPyObjectExt, prelude::*};
use toposlam_model::{
    aid::{Action, Aid, AnyAid, Places, State},
    ambiguity::{Bisimulation, Comparison, Walk, has_more_states},
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Interrupted,
    isomorphism::{isomorphism, mirror_isomorphism},
    marker::NoMarker,
};

use crate::{
    error::{error, interrupted},
    long_work::{Watcher, run_watched},
    own_marker::OwnMarker,
    percept::Percept,
    world::{CoreWorld, check_seen, named_aid},
};

/// A robot's state: its pose, and the darts that place its marking aid, none for what it carries.
type StateNumbers = (u32, Vec<Option<u32>>);

/// The result of a comparison.
#[derive(IntoPyObject)]
pub(crate) struct Compared {
    /// The image of each dart, if the worlds are isomorphic.
    bijection: Option<Vec<u32>>,
    /// The first difference, if they are not.
    difference: Option<String>,
    mirror: bool,
    /// The start in the second world that is indistinguishable from that in the first.
    start_like: Option<u32>,
    relation: Option<Vec<(StateNumbers, StateNumbers)>>,
    /// The shortest walk that distinguishes them: what both robots do.
    walk: Option<Vec<Py<PyAny>>>,
    percepts: Option<(Percept, Percept)>,
}

/// The most pairs of a relation.
const MOST_PAIRS: usize = 1 << 22;

/// The most states of a world: they are numbered, and take memory accordingly.
const MOST_STATES: usize = 1 << 24;

/// What the robots can find out.
struct Answer {
    start_like: Option<Dart>,
    relation: Option<Vec<(StateNumbers, StateNumbers)>>,
    /// Whether the relation, or the walk, is what it should be.
    verified: bool,
    walk: Option<Walk>,
}

/// Compares two worlds with their starts. `marker` is the name of a kind, or a function from doors to a
/// table of sightings.
#[pyfunction]
pub(crate) fn compare(
    py: Python<'_>,
    one: &CoreWorld,
    facing: u32,
    other: &CoreWorld,
    other_facing: u32,
    marker: &Bound<'_, PyAny>,
) -> PyResult<Compared> {
    let facings = [one.dart(py, facing)?, other.dart(py, other_facing)?];
    let graphs = [&one.0.graph, &other.0.graph];
    let sides = [(graphs[0], facings[0]), (graphs[1], facings[1])];
    let own;
    let aid: AnyAid<'_> = if let Ok(name) = marker.extract::<String>() {
        own = None;
        named_aid(py, &name)?.into()
    } else {
        own = Some(OwnMarker::new(marker.clone().unbind()));
        own.as_ref().map_or(NoMarker.into(), |own| AnyAid::Own(own))
    };
    for graph in graphs {
        check_seen(py, aid, graph)?;
    }
    if sides.iter().any(|&(graph, facing)| has_more_states(graph, aid, facing, MOST_STATES)) {
        let text = format!("a world has more than {MOST_STATES} states of robot and marker");
        return Err(error(py, "SizeError", text));
    }
    let on_signal = own.as_ref().map(OwnMarker::stopper);
    let answer = run_watched(py, None, on_signal, |watcher| answer(aid, sides, watcher))?;
    if let Some(failure) = own.as_ref().and_then(OwnMarker::failure) {
        return Err(failure);
    }
    let answer = answer.map_err(|Interrupted| interrupted())?;
    let relation_is_missing = answer.start_like.is_some() && answer.relation.is_none();
    if relation_is_missing {
        let text = format!("the relation has more than {MOST_PAIRS} pairs");
        return Err(error(py, "SizeError", text));
    }
    if !answer.verified {
        return Err(error(py, "InternalError", "the relation or the walk is not verified"));
    }
    let same = isomorphism(graphs[0], graphs[1]);
    Ok(Compared {
        difference: same.as_ref().err().map(ToString::to_string),
        bijection: same.ok().map(|same| same.images().iter().map(|dart| dart.0).collect()),
        mirror: mirror_isomorphism(graphs[0], graphs[1]).is_some(),
        start_like: answer.start_like.map(|start| start.0),
        relation: answer.relation,
        percepts: answer.walk.as_ref().map(|walk| {
            let [here, there] = walk.percepts;
            (Percept(here), Percept(there))
        }),
        walk: answer.walk.map(|walk| actions(py, &walk.actions)).transpose()?,
    })
}

fn answer(
    aid: AnyAid<'_>,
    sides: [(&EmbeddedGraph, Dart); 2],
    watcher: &Watcher,
) -> Result<Answer, Interrupted> {
    let numbers = |state: State<Places>| {
        (state.pose.0, state.placed.iter().map(|place| place.map(|dart| dart.0)).collect())
    };
    let [(_, facing), (graph, other_facing)] = sides;
    let facings = [facing, other_facing];
    // The robot in the second world may begin in any pose that places the aid alike.
    let mut starts = Aid::starts(&aid, graph, other_facing);
    let comparison = Comparison::new(aid, sides[0], sides[1]);
    starts.sort_by_key(|&start| start != other_facing);
    for start in starts {
        let poses = [facings[0], start];
        if let Some(found) = comparison.bisimulation(poses, MOST_PAIRS, watcher)? {
            let [here, there] = comparison.starts(poses);
            let verified = found.verify(&here, &there);
            let relation = match found {
                Bisimulation::Relation(relation) => {
                    let pairs = relation.0.into_iter();
                    Some(pairs.map(|(here, there)| (numbers(here), numbers(there))).collect())
                }
                Bisimulation::Classes(_) => None,
            };
            return Ok(Answer { start_like: Some(start), relation, verified, walk: None });
        }
    }
    let walk = comparison.walk_watched(facings, watcher)?;
    let [here, there] = comparison.starts(facings);
    let verified = walk.as_ref().is_some_and(|walk| walk.verify(&here, &there));
    Ok(Answer { start_like: None, relation: None, verified, walk })
}

/// Actions for Python: doors as numbers, "pick-up" and "drop".
pub(crate) fn actions(py: Python<'_>, actions: &[Action]) -> PyResult<Vec<Py<PyAny>>> {
    let action = |action: &Action| match action {
        Action::Take(door) => door.0.into_py_any(py),
        Action::Do(action) => action.to_string().into_py_any(py),
    };
    actions.iter().map(action).collect()
}
