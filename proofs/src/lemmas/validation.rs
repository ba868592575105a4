//! A confirmed hypothesis is true, because taking a door is injective on poses. Section 2.3; Algorithm 1,
//! lines 10 to 17.

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    marker::{Directional, Marker},
    percept::{Door, Sighting},
};

use crate::{
    choose::{CaseResult, Choose, Exhibit, claim, given},
    draw,
    lemma::declare,
};

declare! {
    a_door_is_injective {
        "The same door, taken from two poses at which it exists, leads to the same pose only if \
         these are the same.",
        paper "2.1",
        exhaustive "every start with up to 4 edges, any two poses, every door", 201_988 cases:
            a_door_is_injective::<_, 1, 4>;
        sampled "starts with up to 40 edges": a_door_is_injective::<_, 1, 40>;
    }
    validation_is_sound {
        "If the same doors can be taken from two poses of one world, and lead to the directional \
         marker with the same sighting, then the poses are the same.",
        paper "2.3; Algorithm 1, lines 10 to 17",
        exhaustive "every start with up to 3 edges, any two poses, every path of up to 4 \
                    moves", 188_115 cases:
            validation_is_sound::<_, 1, 3, 4>;
        sampled "starts with up to 4 edges, paths of up to 6 moves":
            validation_is_sound::<_, 1, 4, 6>;
    }
}

/// A door that exists in both poses.
fn common_door(choose: &mut impl Choose, graph: &EmbeddedGraph, one: Dart, other: Dart) -> Door {
    let degree = graph.degree_around(one).min(graph.degree_around(other));
    Door(u32::from(choose.below(degree as u8)))
}

// paper: motion.door
fn a_door_is_injective<C: Choose, const LEAST: usize, const MOST: usize>(
    choose: &mut C,
) -> CaseResult {
    let graph = draw::start_of::<LEAST, MOST>(choose)?;
    let (one, other) = (draw::dart(choose, &graph), draw::dart(choose, &graph));
    let door = common_door(choose, &graph, one, other);
    choose.show(|| Exhibit::walk(one, &[door]));
    choose.show(|| Exhibit::walk(other, &[door]));
    claim(
        "it leads to the same pose exactly from the same pose",
        (graph.after(one, door) == graph.after(other, door)) == (one == other),
    )
}

// paper: alg1.validation
fn validation_is_sound<C: Choose, const LEAST: usize, const MOST: usize, const MOVES: usize>(
    choose: &mut C,
) -> CaseResult {
    let graph = draw::start_of::<LEAST, MOST>(choose)?;
    let (one, other) = (draw::dart(choose, &graph), draw::dart(choose, &graph));
    let moves = usize::from(choose.below(MOVES as u8 + 1));
    let mut doors = [Door::BACK; MOVES];
    let (mut here, mut there) = (one, other);
    let mut made = 0;
    while made < moves {
        let door = common_door(choose, &graph, here, there);
        doors[made] = door;
        (here, there) = (graph.after(here, door), graph.after(there, door));
        made += 1;
    }
    choose.show(|| Exhibit::walk(one, &doors[..moves]));
    choose.show(|| Exhibit::walk(other, &doors[..moves]));
    let seen = |pose| Directional.sighting(&graph, Dart(0), pose);
    given(choose, seen(here) == seen(there) && seen(here) != Sighting::Nothing)?;
    claim("they began in the same pose", one == other)
}
