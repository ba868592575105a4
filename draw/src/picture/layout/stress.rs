//! Layouts in which the distance of two vertices is the length of their shortest path ("stress";
//! Gansner, Koren, North, "Graph drawing by stress majorization", 2004).

use std::{cmp::Reverse, collections::VecDeque, f64::consts::TAU};

use toposlam_model::embedded_graph::{EmbeddedGraph, Vertex};

use super::{
    super::{
        doors::door_directions,
        geometry::{Point, crossing, wrapped},
    },
    refine::{Keep, refine},
    subdivision::Subdivision,
};

/// The most vertices for which the plain layout compares all pairs.
const ALL_PAIRS: usize = 3000;
/// Faces that are tried as the outer one.
const FRAMES: usize = 6;
/// Starting places that are tried, each also as its mirror image.
const TRIES: u32 = 24;

/// The best of several layouts: few crossings, and doors near the straight lines. `in_part`: one more
/// layout, that of a planar part of the graph.
pub(super) fn best(graph: &EmbeddedGraph, in_part: Option<Vec<Point>>) -> Vec<Point> {
    let count = graph.vertex_count();
    let distances = distances(graph);
    let web = Subdivision::without_bends(graph);
    let framed = framed(&web);
    let mut layouts = framed.clone();
    for attempt in 0..TRIES {
        let mut points = set_out(graph, attempt);
        for _ in 0..150 {
            majorize(&mut points, &distances);
        }
        layouts.push(points);
    }
    let mut best = (f64::INFINITY, Vec::new());
    let refined = layouts.clone().into_iter().map(|mut points| {
        if count > 2 {
            refine(&web, &mut points, Keep::Nothing);
        }
        points
    });
    for mut points in refined.chain(framed).chain(in_part) {
        for mirrored in [false, true] {
            if mirrored {
                for point in &mut points {
                    point.x = -point.x;
                }
            }
            let cost = cost(graph, &points);
            if cost < best.0 - 1e-6 {
                best = (cost, points.clone());
            }
        }
    }
    best.1
}

/// For each of the first longest faces: the face as a regular polygon, and every other vertex in
/// the middle of its neighbours.
fn framed(web: &Subdivision) -> Vec<Vec<Point>> {
    let mut faces = web.faces();
    faces.retain(|face| web.different_nodes(face) == face.len() && face.len() > 2);
    faces.sort_by_key(|face| Reverse(face.len()));
    faces.truncate(FRAMES);
    let darts = web.darts_of_nodes();
    let layout = |face: &Vec<usize>| {
        let radius = face.len() as f64 / TAU * 1.9;
        let mut points = vec![Point::default(); web.nodes];
        let mut inside = vec![true; web.nodes];
        for (place, &dart) in face.iter().enumerate() {
            let node = web.node[dart];
            inside[node] = false;
            points[node] = Point::polar(TAU * place as f64 / face.len() as f64, radius);
        }
        for _ in 0..300 {
            for node in (0..web.nodes).filter(|&node| inside[node]) {
                let far = darts[node].iter().map(|&dart| points[web.far(dart)]);
                let sum = far.fold(Point::default(), |sum, point| sum + point);
                points[node] = sum * (1.0 / darts[node].len() as f64);
            }
        }
        // The middle is crowded: spread it outwards.
        for node in (0..web.nodes).filter(|&node| inside[node]) {
            let share = points[node].length() / radius;
            points[node] = points[node].direction() * (radius * share.powf(0.55));
        }
        points
    };
    faces.iter().map(layout).collect()
}

/// One layout, quickly.
pub(super) fn plain(graph: &EmbeddedGraph) -> Vec<Point> {
    let mut points = set_out(graph, 0);
    if graph.vertex_count() <= ALL_PAIRS {
        let distances = distances(graph);
        let sweeps = (60_000_000 / points.len().pow(2)).clamp(12, 200);
        for _ in 0..sweeps {
            majorize(&mut points, &distances);
        }
    }
    points
}

/// Initial places: a circle in breadth-first order, in the order of the numbers, and then
/// at random from a fixed seed.
fn set_out(graph: &EmbeddedGraph, attempt: u32) -> Vec<Point> {
    let count = graph.vertex_count();
    let radius = count as f64 / TAU;
    let on_circle = |place: usize| Point::polar(TAU * place as f64 / count as f64, radius);
    let mut points = vec![Point::default(); count];
    match attempt {
        0 => {
            let from_first = hops(graph, Vertex(0));
            let mut order: Vec<_> = (0..count).collect();
            order.sort_by_key(|&vertex| from_first[vertex]);
            for (place, vertex) in order.into_iter().enumerate() {
                // A spiral: the near ones inside.
                let share = (place as f64 + 0.5) / count as f64;
                points[vertex] = Point::polar(2.4 * place as f64, radius * share.sqrt());
            }
        }
        1 => (0..count).for_each(|vertex| points[vertex] = on_circle(vertex)),
        _ => {
            let mut state = u64::from(attempt).wrapping_mul(0x9E37_79B9_7F4A_7C15);
            let mut random = || {
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1_442_695_040_888_963_407);
                (state >> 40) as f64 / (1_u64 << 24) as f64 - 0.5
            };
            for point in &mut points {
                *point = Point::new(random(), random()) * (2.0 * radius);
            }
        }
    }
    points
}

/// One sweep of majorization.
fn majorize(points: &mut [Point], distances: &[Vec<u32>]) {
    for vertex in 0..points.len() {
        let here = points[vertex];
        let mut sum = Point::default();
        let mut weights = 0.0;
        for (other, &hops) in distances[vertex].iter().enumerate() {
            if other != vertex {
                let wish = f64::from(hops);
                let weight = 1.0 / (wish * wish);
                let away = match (here - points[other]).direction() {
                    // Two vertices at one place move apart in different directions.
                    none if none == Point::default() => Point::polar(2.4 * vertex as f64, 1.0),
                    direction => direction,
                };
                sum = sum + (points[other] + away * wish) * weight;
                weights += weight;
            }
        }
        if weights > 0.0 {
            points[vertex] = sum * (1.0 / weights);
        }
    }
}

fn distances(graph: &EmbeddedGraph) -> Vec<Vec<u32>> {
    graph.vertices().map(|vertex| hops(graph, vertex)).collect()
}

/// The length of the shortest path to each vertex.
pub(super) fn hops(graph: &EmbeddedGraph, from: Vertex) -> Vec<u32> {
    let mut hops = vec![u32::MAX; graph.vertex_count()];
    let mut queue = VecDeque::from([from]);
    hops[from.at()] = 0;
    while let Some(vertex) = queue.pop_front() {
        for dart in graph.darts_of(vertex) {
            let next = graph.vertex(graph.opposite(dart));
            if hops[next.at()] == u32::MAX {
                hops[next.at()] = hops[vertex.at()] + 1;
                queue.push_back(next);
            }
        }
    }
    hops
}

/// Crossings, doors away from their straight lines, and vertices on the lines of others.
fn cost(graph: &EmbeddedGraph, points: &[Point]) -> f64 {
    let lines: Vec<_> = graph
        .edges()
        .map(|(dart, other)| (graph.vertex(dart).at(), graph.vertex(other).at()))
        .filter(|(u, v)| u != v)
        .collect();
    let mut cost = 0.0;
    for (at, &(a, b)) in lines.iter().enumerate() {
        for &(c, d) in &lines[..at] {
            let apart = a != c && a != d && b != c && b != d;
            if apart && crossing(points[a], points[b], points[c], points[d]).is_some() {
                cost += 0.7;
            }
        }
        let length = points[a].distance(points[b]);
        cost += 0.25 * (length - 1.0).abs();
        for (vertex, point) in points.iter().enumerate() {
            if vertex != a && vertex != b {
                let room = point.distance_to_segment(points[a], points[b]);
                cost += 4.0 * (0.35 - room).max(0.0);
            }
        }
    }
    for vertex in graph.vertices() {
        let wanted: Vec<_> = graph
            .darts_of(vertex)
            .map(|dart| {
                let far = graph.vertex(graph.opposite(dart));
                (far != vertex).then(|| (points[far.at()] - points[vertex.at()]).angle())
            })
            .collect();
        let doors = door_directions(&wanted, 0.5);
        for (door, wanted) in doors.iter().zip(&wanted) {
            let miss = wanted.map_or(0.0, |wanted| wrapped(door - wanted));
            cost += 1.2 * miss * miss;
        }
    }
    cost
}
