//! The definitions of the field, as plain as possible and independent of how the model decides them.
//! Section 2.1.

use std::mem;

use toposlam_model::{
    aid::{Aid, Places, State},
    ambiguity::PlacedRobot,
    embedded_graph::{Dart, EmbeddedGraph},
};

/// Whether the entry at each number's entry is that number, and the entry is another number.
pub fn is_involution_without_fixed_points(array: &[u32]) -> bool {
    let mut dart = 0;
    while dart < array.len() {
        let other = array[dart] as usize;
        if other >= array.len() || other == dart || array[other] as usize != dart {
            return false;
        }
        dart += 1;
    }
    true
}

/// Whether each number below the length is an entry exactly once.
pub fn is_permutation(array: &[u32]) -> bool {
    let mut number = 0;
    while number < array.len() {
        let mut times = 0;
        let mut place = 0;
        while place < array.len() {
            if array[place] as usize == number {
                times += 1;
            }
            place += 1;
        }
        if times != 1 {
            return false;
        }
        number += 1;
    }
    true
}

/// Whether each dart can be reached from the first by these two permutations. `reached` is scratch
/// space, all `false`, at least as long as they are, which is at least 1.
pub fn is_connected(opposite: &[u32], clockwise: &[u32], reached: &mut [bool]) -> bool {
    reached[0] = true;
    let mut round = 0;
    while round < opposite.len() {
        let mut dart = 0;
        while dart < opposite.len() {
            if reached[dart] {
                reached[opposite[dart] as usize] = true;
                reached[clockwise[dart] as usize] = true;
            }
            dart += 1;
        }
        round += 1;
    }
    let mut dart = 0;
    while dart < opposite.len() && reached[dart] {
        dart += 1;
    }
    dart == opposite.len()
}

/// Whether this is a connected embedded graph with an edge: every edge has two ends, every vertex has its
/// edge ends in a cycle, and all can be reached. Linear time.
pub fn is_world(graph: &EmbeddedGraph) -> bool {
    let darts = graph.dart_count();
    let mut listed = 0;
    let in_circles = graph.vertices().all(|vertex| {
        let degree = graph.degree(vertex) as usize;
        let around = graph.darts_of(vertex);
        let next = around.clone().cycle().skip(1);
        listed += degree;
        degree > 0
            && around.len() == degree
            && around
                .zip(next)
                .all(|(dart, next)| graph.vertex(dart) == vertex && graph.clockwise(dart) == next)
    });
    let in_pairs = graph.darts().all(|dart| {
        let other = graph.opposite(dart);
        other != dart && graph.opposite(other) == dart
    });
    let mut reached = vec![false; darts];
    let mut open = Vec::with_capacity(2 * darts + 1);
    open.push(Dart(0));
    let mut count = 0;
    while let Some(dart) = open.pop() {
        if !mem::replace(&mut reached[dart.at()], true) {
            count += 1;
            open.extend([graph.opposite(dart), graph.clockwise(dart)]);
        }
    }
    darts == 2 * graph.edge_count() && listed == darts && in_circles && in_pairs && count == darts
}

/// Whether there are no loops and no parallel edges.
pub fn is_simple(graph: &EmbeddedGraph) -> bool {
    let far = |dart| graph.vertex(graph.opposite(dart));
    let mut pairs: Vec<_> = graph.darts().map(|dart| (graph.vertex(dart), far(dart))).collect();
    pairs.sort_unstable();
    pairs.iter().all(|(here, there)| here != there) && pairs.windows(2).all(|two| two[0] != two[1])
}

/// Whether two starts are isomorphic: from the two facing darts, the opposite and the clockwise darts of
/// paired darts are paired, and this pairs the darts one to one.
pub fn isomorphic(one: (&EmbeddedGraph, Dart), other: (&EmbeddedGraph, Dart)) -> bool {
    let mut pairs = vec![(one.1, other.1)];
    let mut next = 0;
    while let Some(&(here, there)) = pairs.get(next) {
        next += 1;
        for pair in [
            (one.0.opposite(here), other.0.opposite(there)),
            (one.0.clockwise(here), other.0.clockwise(there)),
        ] {
            if !pairs.contains(&pair) {
                pairs.push(pair);
            }
        }
    }
    let is_paired_once = |dart: Dart| {
        pairs.iter().filter(|pair| pair.0 == dart).count() == 1
            && pairs.iter().filter(|pair| pair.1 == dart).count() == 1
    };
    one.0.dart_count() == other.0.dart_count() && one.0.darts().all(is_paired_once)
}

/// Whether these pairs of states are a bisimulation that contains the starts of the two worlds: the
/// states exist, and a marker that cannot be carried stays in its place; in each pair the robots perceive
/// the same and have the same actions; and each action leads to a pair.
pub fn is_bisimulation<'a>(
    pairs: &[(State<Places>, State<Places>)],
    one: &PlacedRobot<'a>,
    other: &PlacedRobot<'a>,
) -> bool {
    let exists = |world: &PlacedRobot<'a>, state: &State<Places>| {
        let is_dart = |dart: Dart| dart.at() < world.graph().dart_count();
        is_dart(state.pose) && world.aid().exists(world.graph(), &state.placed)
    };
    pairs.contains(&(one.state(), other.state()))
        && pairs.iter().all(|(here, there)| {
            if !exists(one, here) || !exists(other, there) {
                return false;
            }
            let (one, other) = (one.clone().at(here.clone()), other.clone().at(there.clone()));
            let can = one.actions();
            one.sensed() == other.sensed()
                && can == other.actions()
                && can.into_iter().all(|action| {
                    let (mut one, mut other) = (one.clone(), other.clone());
                    one.act(action).is_ok()
                        && other.act(action).is_ok()
                        && pairs.contains(&(one.state(), other.state()))
                })
        })
}
