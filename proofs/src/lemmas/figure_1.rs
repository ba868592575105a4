//! Figure 1: two worlds that no robot with one undirected marker can distinguish. Section 2.2.
//!
//! Two poses are related if robots there perceive the same, and perceive the same behind each of
//! their doors. The printed proof is an induction: its base is that the starts are related, its step
//! that from related poses each door leads to related poses.

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    marker::{Marker, Undirected},
    percept::Door,
};

use crate::{
    choose::{CaseResult, Choose, Exhibit, Stop, claim, given},
    definition::isomorphic,
    draw,
    lemma::declare,
};

declare! {
    the_worlds_of_figure_1_differ {
        "The two worlds of Figure 1 are not isomorphic: no dart of the second one, as its start, \
         makes it isomorphic to the first.",
        paper "2.2, Figure 1",
        exhaustive "every dart", 16 cases: differ::<_>;
    }
    the_starts_of_figure_1_are_related {
        "The base of the printed proof: the starts of the two worlds of Figure 1 are related, and \
         a robot that leaves by any door comes to a vertex with 3 doors, which lead to vertices \
         with 4, 3 and 3.",
        paper "2.2, Figure 1",
        exhaustive "every door", 4 cases: base::<_>;
        symbolic "every door": base::<_>;
    }
    related_poses_of_figure_1_stay_related {
        "The step of the printed proof: from any two related poses of the two worlds of Figure 1, \
         each door leads to related poses.",
        paper "2.2, Figure 1",
        // 4 poses of each of the four kinds in either world; 4 doors for one kind, 3 for the others.
        exhaustive "any two related poses, every door", 208 cases: step::<_>;
    }
}

/// The hub and then the rim's vertices, each with its darts as the world file lists them.
const CLOCKWISE: [u32; 16] = [1, 2, 3, 0, 5, 6, 4, 8, 9, 7, 11, 12, 10, 14, 15, 13];
/// `opposite` in Figure 1(a).
const PLANE: [u32; 16] = [5, 8, 15, 11, 9, 0, 10, 13, 1, 4, 6, 3, 14, 7, 12, 2];
/// `opposite` in Figure 1(b).
const TORUS: [u32; 16] = [5, 8, 13, 11, 12, 0, 7, 6, 1, 15, 14, 3, 4, 2, 10, 9];
/// The facing dart of both.
const FACING: Dart = Dart(0);

/// The two worlds of Figure 1.
pub(super) fn worlds(choose: &mut impl Choose) -> Result<[EmbeddedGraph; 2], Stop> {
    let worlds = [draw::world(&PLANE, &CLOCKWISE)?, draw::world(&TORUS, &CLOCKWISE)?];
    for graph in &worlds {
        choose.show(|| Exhibit::World { graph: graph.clone(), facing: FACING });
    }
    Ok(worlds)
}

/// Shows the same door taken in both worlds.
fn show_walks(choose: &mut impl Choose, poses: [Dart; 2], door: Door) {
    for (world, pose) in [(0, poses[0]), (1, poses[1])] {
        choose.show(|| Exhibit::Walk { world, marker: Undirected, pose, doors: vec![door] });
    }
}

/// The degree of the vertex behind each door; 0 if there is no such door.
fn neighbours(graph: &EmbeddedGraph, pose: Dart) -> [u32; 4] {
    let mut degrees = [0; 4];
    let mut dart = pose;
    let mut door = 0;
    while door < 4 && door < graph.degree_around(pose) {
        degrees[door as usize] = graph.degree_around(graph.opposite(dart));
        dart = graph.clockwise(dart);
        door += 1;
    }
    degrees
}

fn related([one, other]: &[EmbeddedGraph; 2], here: Dart, there: Dart) -> bool {
    let seen = |graph, pose| Undirected.sighting(graph, FACING, pose);
    one.degree_around(here) == other.degree_around(there)
        && seen(one, here) == seen(other, there)
        && neighbours(one, here) == neighbours(other, there)
}

// paper: fig1.different
fn differ<C: Choose>(choose: &mut C) -> CaseResult {
    let [one, other] = worlds(choose)?;
    let there = draw::dart(choose, &other);
    choose.show(|| Exhibit::Value { name: "dart", value: there.0.to_string() });
    claim("the starts are not isomorphic", !isomorphic((&one, FACING), (&other, there)))
}

// paper: fig1.base
fn base<C: Choose>(choose: &mut C) -> CaseResult {
    let worlds = worlds(choose)?;
    claim("the starts are related", related(&worlds, FACING, FACING))?;
    let door = draw::door(choose, &worlds[0], FACING);
    show_walks(choose, [FACING, FACING], door);
    let [here, there] = [worlds[0].after(FACING, door), worlds[1].after(FACING, door)];
    claim("the first comes there", neighbours(&worlds[0], here) == [4, 3, 3, 0])?;
    claim("the second comes there", neighbours(&worlds[1], there) == [4, 3, 3, 0])
}

// paper: fig1.step
fn step<C: Choose>(choose: &mut C) -> CaseResult {
    let worlds = worlds(choose)?;
    let (here, there) = (draw::dart(choose, &worlds[0]), draw::dart(choose, &worlds[1]));
    given(choose, related(&worlds, here, there))?;
    let door = draw::door(choose, &worlds[0], here);
    show_walks(choose, [here, there], door);
    let after = (worlds[0].after(here, door), worlds[1].after(there, door));
    claim("it leads to related poses", related(&worlds, after.0, after.1))
}

#[cfg(test)]
mod tests {
    use std::{fs, path::Path};

    use toposlam_model::format::world_file;

    use super::*;
    use crate::replay::CaseReplay;

    #[test]
    fn the_worlds_are_those_of_the_files() {
        let worlds = worlds(&mut CaseReplay::default()).unwrap();
        for (graph, name) in worlds.into_iter().zip(["figure-1a", "figure-1b"]) {
            let file = format!("{}/../worlds/{name}.toml", env!("CARGO_MANIFEST_DIR"));
            let world = world_file::read(&fs::read(Path::new(&file)).unwrap()).unwrap();
            assert_eq!((world.graph, world.start), (graph, Some(FACING)));
        }
    }
}
