//! What a sighting of the marker says about the entry dart. Sections 2.2, 2.3.

use toposlam_model::{
    embedded_graph::Dart,
    marker::{Directional, Marker, Undirected},
    percept::{Percept, Sighting},
};

use crate::{
    choose::{CaseResult, Choose, Exhibit, claim, given},
    draw,
    lemma::declare,
};

declare! {
    a_directional_sighting_determines_the_entry_dart {
        "At the marked vertex, a directional marker is seen along a door, and along different \
         doors from different entry darts; at no other vertex is it seen.",
        paper "2.3",
        // Each start with m edges, its facing dart, and 2 m times 2 m poses.
        exhaustive "every start with up to 4 edges, any two poses", 48_016 cases:
            directional::<_, 1, 4>;
        sampled "starts with up to 40 edges": directional::<_, 1, 40>;
    }
    a_turned_robot_perceives_the_turned_percept {
        "What a robot perceives that has come in by the dart behind a door is what it perceives in \
         its pose, with doors counted from that door.",
        paper "2.1; Algorithm 1, line 15",
        // The squares of the degrees of all vertices.
        exhaustive "every start with up to 4 edges, every pose, every door", 28_788 cases:
            turned::<_, 1, 4>;
        sampled "starts with up to 40 edges": turned::<_, 1, 40>;
    }
    an_undirected_sighting_does_not_determine_the_entry_dart {
        "There are worlds where an undirected marker gives the same sighting, at the marked \
         vertex, for two entry darts.",
        paper "2.2",
        exhaustive "witnesses among the starts with up to 3 edges, any two poses", 1046 cases:
            undirected::<_, 1, 3>;
    }
}

// paper: marker.directional-sufficient
fn directional<C: Choose, const LEAST: usize, const MOST: usize>(choose: &mut C) -> CaseResult {
    let graph = draw::start_of::<LEAST, MOST>(choose)?;
    let facing = Dart(0);
    let (one, other) = (draw::dart(choose, &graph), draw::dart(choose, &graph));
    choose.show(|| Exhibit::walk(one, &[]));
    choose.show(|| Exhibit::walk(other, &[]));
    let seen = |pose| Directional.sighting(&graph, facing, pose);
    let is_here = |pose| graph.vertex(pose) == graph.vertex(facing);
    match seen(one) {
        Sighting::Pointing(door) => {
            claim("it is seen at the marked vertex", is_here(one))?;
            claim("the door exists", door.0 < graph.degree_around(one))?;
            claim("it points along the facing dart", graph.behind(one, door) == facing)?;
        }
        sighting => {
            claim("it is seen or not", sighting == Sighting::Nothing)?;
            claim("it is not seen elsewhere", !is_here(one))?;
        }
    }
    claim(
        "the same sighting at the marked vertex means the same entry dart",
        !(is_here(one) && is_here(other) && seen(one) == seen(other) && one != other),
    )
}

// paper: alg1.15
fn turned<C: Choose, const LEAST: usize, const MOST: usize>(choose: &mut C) -> CaseResult {
    let graph = draw::start_of::<LEAST, MOST>(choose)?;
    let pose = draw::dart(choose, &graph);
    let door = draw::door(choose, &graph, pose);
    choose.show(|| Exhibit::walk(pose, &[door]));
    let perceived = |pose| Percept {
        degree: graph.degree_around(pose),
        sighting: Directional.sighting(&graph, Dart(0), pose),
    };
    let turned = perceived(graph.behind(pose, door));
    claim("it is the percept, turned", turned == perceived(pose).seen_from(door))
}

// paper: marker.undirected-insufficient
fn undirected<C: Choose, const LEAST: usize, const MOST: usize>(choose: &mut C) -> CaseResult {
    let graph = draw::start_of::<LEAST, MOST>(choose)?;
    let (one, other) = (draw::dart(choose, &graph), draw::dart(choose, &graph));
    for pose in [one, other] {
        choose.show(|| Exhibit::Walk { world: 0, marker: Undirected, pose, doors: Vec::new() });
    }
    let seen = |pose| Undirected.sighting(&graph, Dart(0), pose);
    given(choose, one != other && seen(one) == seen(other) && seen(one) != Sighting::Nothing)?;
    claim("a robot there sees a marker, and no door of it", seen(one) == Sighting::Lying(1))
}
