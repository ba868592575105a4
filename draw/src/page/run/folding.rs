//! The folded trail after each arrival, as data that the page draws.
//!
//! Each vertex of the trail is drawn where its vertex of the last folded trail is. As long as two of them are
//! not proved to be one, the later one is drawn on a further layer, beside the first. So the trail grows as a
//! chain, and collapses when the marker is seen.

use std::collections::HashMap;

use serde_json::{Value, json};
use toposlam_model::{
    embedded_graph::Dart,
    folding::{FoldedTrail, fold},
    percept::{Door, Percept},
};

use super::rounded;
use crate::{
    picture::{OpenGraph, Point, open_layout},
    run_page_data::RunPageData,
};

/// How far a layer is to the right of the one before, and above it, in radii of a disc.
const LAYER: [f64; 2] = [1.0, 1.7];

struct TrailVertex {
    /// The dart by which the robot came in first.
    entry: Dart,
    /// The vertex that it came from, and the dart by which it left; `None` for the first.
    from: Option<(usize, Dart)>,
}

/// The folded trail after an arrival.
struct Stage {
    /// The number of trail vertices.
    count: usize,
    /// The layer of each of them.
    layers: Vec<usize>,
    /// The open darts, each with a trail vertex.
    open: Vec<(usize, Dart)>,
    /// The number of vertices that are not proved to be others.
    places: usize,
    /// The trail vertex at which the robot is.
    robot: usize,
}

/// The data; `null` if there is no arrival, or the marker moves.
pub(super) fn json(run_data: &RunPageData) -> Value {
    if run_data.aid.moves() {
        return Value::Null;
    }
    let percepts: Vec<Percept> = run_data.calls.iter().map(|call| call.percept).collect();
    let doors: Vec<Door> = run_data.calls.iter().filter_map(|call| call.door).collect();
    let moves = explained_moves(&percepts, &doors);
    let Some((vertices, stages, last)) = grown(&percepts, &doors[..moves.unwrap_or(0)]) else {
        return Value::Null;
    };
    let entries = last.first_entries(&doors);
    let graph = OpenGraph::of_trail(&last, &entries);
    let Some(layout) = open_layout(&graph) else { return Value::Null };
    let place: HashMap<usize, usize> =
        entries.iter().enumerate().map(|(place, &entry)| (last.vertex(entry), place)).collect();
    let placed = |dart: Dart| place.get(&last.vertex(dart)).copied().unwrap_or(0);
    let number = |dart: Dart| {
        let vertex = placed(dart);
        graph.dart(vertex, last.door(entries[vertex], dart)).0
    };
    let layers = stages.iter().flat_map(|stage| &stage.layers).max().copied().unwrap_or(0);
    let radius = layout.discs.iter().map(|(_, radius)| *radius).fold(0.0, f64::max);
    let aside = LAYER.map(|share| share * radius);
    let (corner, size) = (layout.extent.least, layout.extent.size());
    let [across, up] = aside.map(|aside| aside * layers as f64);
    let point = |Point { x, y }| json!([rounded(x), rounded(y)]);
    let curve = |points: &Vec<Point>| {
        // Every other point is enough; the number of points is odd.
        points.iter().copied().step_by(2).map(point).collect::<Vec<_>>()
    };
    let vertex = |vertex: &TrailVertex| {
        let from = vertex.from.map(|(from, _)| from);
        let edge = vertex.from.map(|(_, dart)| number(dart));
        json!({ "place": placed(vertex.entry), "from": from, "edge": edge })
    };
    let stage = |stage: &Stage| {
        let open = stage.open.iter().map(|&(vertex, dart)| json!([vertex, number(dart)]));
        json!({
            "count": stage.count,
            "layers": stage.layers,
            "open": open.collect::<Vec<_>>(),
            "places": stage.places,
            "robot": stage.robot,
        })
    };
    let seen = vertices.iter().position(|vertex| {
        last.marker().is_some_and(|marker| last.vertex(marker) == last.vertex(vertex.entry))
    });
    let stubs: Vec<Value> =
        layout.stubs.iter().map(|ends| Value::from(ends.map(point).to_vec())).collect();
    let corner_and_size = [corner.x, corner.y - up, size.x + across, size.y + up].map(rounded);
    json!({
        "box": corner_and_size,
        "radius": rounded(radius),
        "open": layout.open,
        "aside": [rounded(aside[0]), rounded(-aside[1])],
        "places": layout.discs.iter().map(|(at, _)| point(*at)).collect::<Vec<_>>(),
        "curves": layout.curves.iter().map(curve).collect::<Vec<_>>(),
        "stubs": stubs,
        "marker": seen.zip(last.marker().map(number)),
        "vertices": vertices.iter().map(vertex).collect::<Vec<_>>(),
        "stages": stages.iter().map(stage).collect::<Vec<_>>(),
        "contradicted": moves.is_none_or(|moves| moves < doors.len()),
    })
}

/// The number of moves that some world explains; `None` if there is not even a start.
fn explained_moves(percepts: &[Percept], doors: &[Door]) -> Option<usize> {
    let (&first, later) = percepts.split_first()?;
    let mut trail = FoldedTrail::new(first).ok()?;
    let mut steps = doors.iter().zip(later);
    let contradiction = steps.position(|(&door, &percept)| trail.step(door, percept).is_err());
    Some(contradiction.unwrap_or(doors.len()))
}

/// The vertices of the trail, the stages after each arrival, and the last folded trail.
fn grown(
    percepts: &[Percept],
    doors: &[Door],
) -> Option<(Vec<TrailVertex>, Vec<Stage>, FoldedTrail)> {
    let (&first, later) = percepts.split_first()?;
    let last = fold(percepts.get(..=doors.len())?, doors).ok()?;
    let mut trail = FoldedTrail::new(first).ok()?;
    let mut vertices = vec![TrailVertex { entry: trail.pose(), from: None }];
    let mut stages = vec![Stage::new(&trail, &vertices, &last)];
    for (&door, &percept) in doors.iter().zip(later) {
        let leaving = trail.behind(trail.pose(), door);
        let from = trail.vertex(leaving);
        let entry = Dart(trail.dart_count() as u32);
        trail.step(door, percept).ok()?;
        if trail.trail_vertex_count() > vertices.len() {
            vertices.push(TrailVertex { entry, from: Some((from, leaving)) });
        }
        stages.push(Stage::new(&trail, &vertices, &last));
    }
    Some((vertices, stages, last))
}

impl Stage {
    fn new(trail: &FoldedTrail, vertices: &[TrailVertex], last: &FoldedTrail) -> Self {
        // The layer of each vertex of the folded trail, and the number of layers of each last vertex.
        let mut layer: HashMap<usize, usize> = HashMap::new();
        let mut heights: HashMap<usize, usize> = HashMap::new();
        let layers = vertices.iter().map(|vertex| {
            *layer.entry(trail.vertex(vertex.entry)).or_insert_with(|| {
                let height = heights.entry(last.vertex(vertex.entry)).or_default();
                *height += 1;
                *height - 1
            })
        });
        Self {
            count: vertices.len(),
            layers: layers.collect(),
            open: trail.open_darts().map(|dart| (trail.vertex(dart), dart)).collect(),
            places: trail.vertex_count(),
            robot: trail.vertex(trail.pose()),
        }
    }
}

#[cfg(test)]
mod tests {
    use toposlam_model::mapping::MappingEvent;

    use super::*;
    use crate::picture::example;

    /// The percepts and doors of a run of Algorithm 1 in a world of this repository.
    fn run(world: &str) -> (Vec<Percept>, Vec<Door>) {
        let world = example::world(world);
        let (mut percepts, mut doors) = (Vec::new(), Vec::new());
        for step in example::steps(&world.plan.unwrap(), world.start.unwrap()) {
            match step.event {
                MappingEvent::Started { percept } => percepts.push(percept),
                MappingEvent::Moved { door, percept } => {
                    doors.push(door);
                    percepts.push(percept);
                }
                _ => {}
            }
        }
        (percepts, doors)
    }

    #[test]
    fn the_trail_of_a_run_grows_by_a_place_a_move_and_collapses_into_the_map() {
        for world in ["shape-6", "shape-8", "building-12", "building-25"] {
            let (percepts, doors) = run(world);
            assert_eq!(explained_moves(&percepts, &doors), Some(doors.len()));
            let (vertices, stages, last) = grown(&percepts, &doors).unwrap();
            assert_eq!(stages.len(), percepts.len(), "{world}");
            for stages in stages.windows(2) {
                assert!(stages[1].places <= stages[0].places + 1);
                assert!(stages[1].count <= stages[0].count + 1);
            }
            assert!(stages.iter().any(|stage| stage.layers.iter().any(|&layer| layer > 0)));
            let end = stages.last().unwrap();
            assert_eq!((end.count, end.open.len()), (vertices.len(), 0), "{world}");
            assert!(end.layers.iter().all(|&layer| layer == 0));
            assert!(last.is_complete());
        }
    }

    #[test]
    fn a_contradiction_ends_the_trail() {
        let data = json(&example::run_page_data());
        // The robot comes back to the corner, and perceives a door more.
        assert_eq!(data["stages"].as_array().unwrap().len(), 2);
        assert_eq!(data["contradicted"], true);
        let mut run_data = example::run_page_data();
        run_data.calls.pop();
        assert_eq!(json(&run_data)["contradicted"], false);
        run_data.calls.clear();
        assert_eq!(json(&run_data), Value::Null);
    }

    #[test]
    fn each_number_of_the_data_is_one_of_its_parts() {
        let data = json(&example::run_page_data());
        let count = |key: &str| data[key].as_array().unwrap().len();
        let [places, darts, vertices] = ["places", "curves", "vertices"].map(count);
        assert_eq!((places, darts, vertices, count("stubs")), (2, 3, 2, 3));
        for vertex in data["vertices"].as_array().unwrap() {
            assert!((vertex["place"].as_u64().unwrap() as usize) < places);
            assert!(vertex["edge"].as_u64().is_none_or(|edge| (edge as usize) < darts));
        }
        // At the start, two doors are open; then one of them was taken.
        assert_eq!(data["stages"][0]["open"], json!([[0, 0], [0, 1]]));
        assert_eq!(data["stages"][1]["open"], json!([[0, 1]]));
        assert_eq!(data["stages"][1]["robot"], 1);
    }
}
