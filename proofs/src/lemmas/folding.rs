//! Folded trails: the order of unions does not matter, a folded trail maps into the world, and a complete
//! one is the world.

use std::collections::HashMap;

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    folding::{ClosedTrail, FoldedTrail, fold},
    isomorphism::Bijection,
    marker::{Directional, Marker},
    percept::{Door, Percept, Sighting},
};

use crate::{
    choose::{CaseResult, Choose, Exhibit, Stop, claim},
    draw,
    lemma::declare,
};

const WALKS: &str = "every start with up to 3 edges, from every pose every walk of 4 moves";
const LARGER_WALKS: &str = "starts with up to 12 edges, any walk of 40 moves from any pose";

declare! {
    sightings_can_be_identified_in_any_order {
        "If the sightings of the marker on a walk are identified in any order, after the walk, the \
         folded trail is the same as if each is identified when it is made.",
        paper "2.3",
        exhaustive
            "every start with up to 3 edges, every walk of 4 moves from the marker, any order",
            603_324 cases: any_order_of_sightings::<_, 3, 4>;
        sampled "starts with up to 12 edges, any walk of 20 moves, any order":
            any_order_of_sightings::<_, 12, 20>;
    }
    two_unions_can_be_made_in_either_order {
        "If two pairs of darts of a folded trail are identified, the order does not matter: the \
         result is the same, or both orders contradict themselves.",
        paper "2.3",
        exhaustive
            "every start with up to 2 edges, every walk of 2 moves, any two pairs of darts",
            139_070 cases: two_unions_in_either_order::<_, 2, 2>;
        sampled "starts with up to 12 edges, any walk of 30 moves":
            two_unions_in_either_order::<_, 12, 30>;
    }
    the_folded_trail_maps_into_the_world {
        "Each dart of the folded trail has one image in the world, where it was walked: degrees, \
         orders, edges, the marker and the robot's pose are kept.",
        paper "2.3",
        exhaustive WALKS, 170_130 cases: maps_into_the_world::<_, 1, 3, 4>;
        sampled LARGER_WALKS: maps_into_the_world::<_, 1, 12, 40>;
    }
    a_walk_determines_its_world_exactly_if_its_folded_trail_is_complete {
        "A complete folded trail is isomorphic to the world as a start, and the robot's pose in it \
         is right. If a dart is open, worlds of two sizes explain the walk.",
        paper "2.3",
        exhaustive WALKS, 170_130 cases: determines_its_world::<_, 1, 3, 4>;
        sampled LARGER_WALKS: determines_its_world::<_, 1, 12, 40>;
    }
}

/// A walk in a world whose facing dart is dart 0.
struct Walk {
    graph: EmbeddedGraph,
    doors: Vec<Door>,
    /// The pose at the start, and after each door.
    poses: Vec<Dart>,
    percepts: Vec<Percept>,
}

const FACING: Dart = Dart(0);

/// What a robot perceives in each pose of a walk.
fn percepts_of(graph: &EmbeddedGraph, facing: Dart, poses: &[Dart]) -> Vec<Percept> {
    let percept = |&pose: &Dart| Percept {
        degree: graph.degree_around(pose),
        sighting: Directional.sighting(graph, facing, pose),
    };
    poses.iter().map(percept).collect()
}

/// Any walk from a pose.
fn walk(choose: &mut impl Choose, graph: EmbeddedGraph, first: Dart, moves: usize) -> Walk {
    let (mut poses, mut doors) = (vec![first], Vec::new());
    let mut pose = first;
    while doors.len() < moves {
        let door = draw::door(choose, &graph, pose);
        pose = graph.after(pose, door);
        doors.push(door);
        poses.push(pose);
    }
    choose.show(|| Exhibit::walk(first, &doors));
    let percepts = percepts_of(&graph, FACING, &poses);
    Walk { graph, doors, poses, percepts }
}

/// Any walk from any pose of a start.
fn any_walk<const LEAST: usize, const MOST: usize>(
    choose: &mut impl Choose,
    moves: usize,
) -> Result<Walk, Stop> {
    let graph = draw::start_of::<LEAST, MOST>(choose)?;
    let first = draw::dart(choose, &graph);
    Ok(walk(choose, graph, first, moves))
}

/// The folded trail of a walk, and for each of its visits the pose in the trail at the time.
fn trail_of(percepts: &[Percept], doors: &[Door]) -> Result<(FoldedTrail, Vec<Dart>), Stop> {
    let contradicts = Stop::Fails("a walk in a world does not contradict itself");
    let mut trail = FoldedTrail::new(percepts[0]).map_err(|_| contradicts)?;
    let mut poses = vec![trail.pose()];
    for (&door, &percept) in doors.iter().zip(&percepts[1..]) {
        trail.step(door, percept).map_err(|_| contradicts)?;
        poses.push(trail.pose());
    }
    Ok((trail, poses))
}

/// The other end of a dart: the number of its vertex, and the door; `None` if the dart is open.
type FarEnd = Option<(usize, u32)>;

/// A folded trail, whatever its roots are: for each vertex its degree and its darts, numbered breadth
/// first from the first pose of the walk, each with the number of the other end.
fn form(trail: &FoldedTrail) -> Vec<(u32, Vec<FarEnd>)> {
    let first = trail.root_of(Dart(0));
    let mut number = HashMap::from([(trail.vertex(first), 0)]);
    let mut entries = vec![first];
    let mut form = Vec::new();
    while let Some(&entry) = entries.get(form.len()) {
        let degree = trail.degree(entry);
        let ends = (0..degree).map(|door| {
            let far = trail.opposite(trail.behind(entry, Door(door)))?;
            let next = entries.len();
            let vertex = *number.entry(trail.vertex(far)).or_insert(next);
            if vertex == next {
                entries.push(far);
            }
            Some((vertex, trail.door(entries[vertex], far).0))
        });
        let ends = ends.collect();
        form.push((degree, ends));
    }
    form
}

fn any_order_of_sightings<C: Choose, const MOST: usize, const MOVES: usize>(
    choose: &mut C,
) -> CaseResult {
    let graph = draw::start_of::<1, MOST>(choose)?;
    let Walk { percepts, doors, .. } = walk(choose, graph, FACING, MOVES);
    let (folded, _) = trail_of(&percepts, &doors)?;
    // The same walk of a robot that does not see the marker: nothing is identified.
    let unseen =
        |&Percept { degree, .. }: &Percept| Percept { degree, sighting: Sighting::Nothing };
    let blind: Vec<Percept> = percepts.iter().map(unseen).collect();
    let (mut trail, poses) = trail_of(&blind, &doors)?;
    let mut sightings = Vec::new();
    for (pose, percept) in poses.iter().zip(&percepts) {
        if let Sighting::Pointing(door) = percept.sighting {
            sightings.push(trail.behind(*pose, door));
        }
    }
    let pairs: Vec<_> = sightings.windows(2).collect();
    let order = draw::permutation::<MOVES>(choose, pairs.len());
    for &next in &order[..pairs.len()] {
        let pair = pairs[next as usize];
        claim("no union contradicts itself", trail.unite(pair[0], pair[1]).is_ok())?;
    }
    claim("the folded trails are the same", form(&trail) == form(&folded))?;
    claim("the numbers of open darts are the same", trail.open_count() == folded.open_count())?;
    claim("the numbers of vertices are the same", trail.vertex_count() == folded.vertex_count())
}

fn two_unions_in_either_order<C: Choose, const MOST: usize, const MOVES: usize>(
    choose: &mut C,
) -> CaseResult {
    let Walk { percepts, doors, .. } = any_walk::<1, MOST>(choose, MOVES)?;
    let (trail, _) = trail_of(&percepts, &doors)?;
    let darts: Vec<Dart> =
        trail.vertices().flat_map(|first| trail.darts_around(first)).take(255).collect();
    let mut dart = || darts[usize::from(choose.below(darts.len() as u8))];
    let pairs = [[dart(), dart()], [dart(), dart()]];
    let united = [[0, 1], [1, 0]].map(|order| {
        let mut trail = trail.clone();
        for pair in order {
            let [one, other] = pairs[pair];
            trail.unite(one, other).ok()?;
        }
        Some((form(&trail), trail.open_count(), trail.vertex_count()))
    });
    claim("both orders have one result", united[0] == united[1])
}

/// The image in the world of each dart of the trail, by its number.
fn images(walk: &Walk, trail: &FoldedTrail, poses: &[Dart]) -> Result<Vec<Option<Dart>>, Stop> {
    let mut images = vec![None; trail.dart_count()];
    for (&pose, &truly) in poses.iter().zip(&walk.poses) {
        let degree = trail.degree(pose);
        claim("degrees are kept", degree == walk.graph.degree_around(truly))?;
        for door in 0..degree {
            let image = walk.graph.behind(truly, Door(door));
            let dart = trail.behind(pose, Door(door));
            let before = images[dart.at()].replace(image);
            claim("each dart has one image", before.is_none_or(|before| before == image))?;
        }
    }
    Ok(images)
}

fn maps_into_the_world<C: Choose, const LEAST: usize, const MOST: usize, const MOVES: usize>(
    choose: &mut C,
) -> CaseResult {
    let walk = any_walk::<LEAST, MOST>(choose, MOVES)?;
    let (trail, poses) = trail_of(&walk.percepts, &walk.doors)?;
    let images = images(&walk, &trail, &poses)?;
    for dart in trail.vertices().flat_map(|first| trail.darts_around(first)) {
        let Some(image) = images[dart.at()] else {
            return Err(Stop::Fails("each dart has an image"));
        };
        if let Some(other) = trail.opposite(dart) {
            let opposite = Some(walk.graph.opposite(image));
            claim("edges are kept", images[other.at()] == opposite)?;
            claim("an edge has two ends", trail.opposite(other) == Some(dart))?;
        }
    }
    let image_of = |dart: Dart| images[dart.at()];
    let marker = trail.marker().map(image_of);
    claim("the marker's image is the facing dart", marker.is_none_or(|dart| dart == Some(FACING)))?;
    claim("the robot is there", image_of(trail.pose()) == walk.poses.last().copied())
}

fn determines_its_world<C: Choose, const LEAST: usize, const MOST: usize, const MOVES: usize>(
    choose: &mut C,
) -> CaseResult {
    let Walk { graph, doors, poses, percepts } = any_walk::<LEAST, MOST>(choose, MOVES)?;
    let trail = fold(&percepts, &doors)
        .map_err(|_| Stop::Fails("a walk in a world does not contradict itself"))?;
    let Some(ClosedTrail { graph: closed, marker, pose, .. }) = trail.closed() else {
        return Err(Stop::Fails("a trail is not empty"));
    };
    if let (true, Some(marker)) = (trail.is_complete(), marker) {
        let bijection = Bijection::of_starts((&closed, marker), (&graph, FACING));
        claim("it is isomorphic", bijection.verify(&closed, &graph))?;
        return claim("the pose is right", bijection.image(pose) == poses.last().copied());
    }
    claim("a dart is open", trail.open_count() > 0)?;
    for world in [&closed, &prolonged(&closed)?] {
        let explained = explains(world, marker, pose, &percepts, &doors);
        claim("worlds with dead ends behind the open darts explain the walk", explained)?;
    }
    Ok(())
}

/// A folded trail that is closed by dead ends, with an edge more at the last of them.
fn prolonged(closed: &EmbeddedGraph) -> Result<EmbeddedGraph, Stop> {
    let darts = closed.dart_count() as u32;
    let last = darts - 1;
    let mut opposite: Vec<u32> = closed.darts().map(|dart| closed.opposite(dart).0).collect();
    let mut clockwise: Vec<u32> = closed.darts().map(|dart| closed.clockwise(dart).0).collect();
    clockwise[last as usize] = darts;
    clockwise.extend([last, darts + 1]);
    opposite.extend([darts + 1, darts]);
    draw::world(&opposite, &clockwise)
}

/// Whether a walk that ends in a pose has these percepts, with the marker along a dart or nowhere.
fn explains(
    graph: &EmbeddedGraph,
    marker: Option<Dart>,
    last: Dart,
    percepts: &[Percept],
    doors: &[Door],
) -> bool {
    // Back over each edge, and to the dart by which the robot came in.
    let mut poses = vec![last];
    let mut pose = last;
    for &Door(door) in doors.iter().rev() {
        let left = graph.opposite(pose);
        let degree = graph.degree_around(left);
        if door >= degree {
            return false;
        }
        pose = graph.behind(left, Door((degree - door) % degree));
        poses.push(pose);
    }
    poses.reverse();
    let perceived = if let Some(facing) = marker {
        percepts_of(graph, facing, &poses)
    } else {
        let degrees = poses.iter().map(|&pose| graph.degree_around(pose));
        degrees.map(|degree| Percept { degree, sighting: Sighting::Nothing }).collect()
    };
    perceived == percepts
}
