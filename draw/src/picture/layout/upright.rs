//! The rotation of the whole layout: edges level or upright, first vertices at the top left.

use std::f64::consts::FRAC_PI_2;

use toposlam_model::embedded_graph::EmbeddedGraph;

use super::{
    super::geometry::{Extent, Point, wrapped},
    Layout,
};

/// The most angles that are tried.
const TRIES: usize = 400;

/// Rotates the layout about the origin; if no vertex has an order to keep, it may also be reflected.
pub(super) fn turn_upright(graph: &EmbeddedGraph, layout: &mut Layout) {
    let edges: Vec<_> = graph
        .edges()
        .map(|(dart, other)| (graph.vertex(dart).at(), graph.vertex(other).at()))
        .filter(|(u, v)| u != v)
        .collect();
    let reflections: &[bool] = if graph.vertices().all(|vertex| graph.degree(vertex) < 3) {
        &[false, true]
    } else {
        &[false]
    };
    let mut best = (f64::NEG_INFINITY, layout.vertices.clone(), 0.0, false);
    for &reflected in reflections {
        let vertices: Vec<_> =
            layout.vertices.iter().map(|&point| reflect(point, reflected)).collect();
        for angle in candidates(&vertices, &edges) {
            let turned: Vec<_> = vertices.iter().map(|&point| turned(point, angle)).collect();
            let score = score(&turned, &edges);
            if score > best.0 + 1e-6 {
                best = (score, turned, angle, reflected);
            }
        }
    }
    let (_, vertices, angle, reflected) = best;
    layout.vertices = vertices;
    for point in layout.bends.iter_mut().flatten() {
        *point = turned(reflect(*point, reflected), angle);
    }
}

fn reflect(point: Point, reflected: bool) -> Point {
    if reflected { Point::new(-point.x, point.y) } else { point }
}

fn turned(point: Point, angle: f64) -> Point {
    let (sin, cos) = angle.sin_cos();
    Point::new(point.x * cos - point.y * sin, point.x * sin + point.y * cos)
}

/// The angles that make some edge level or upright, and quarter turns of the whole.
fn candidates(vertices: &[Point], edges: &[(usize, usize)]) -> Vec<f64> {
    let mut angles = vec![0.0, FRAC_PI_2, 2.0 * FRAC_PI_2, 3.0 * FRAC_PI_2];
    let stride = (4 * edges.len()).div_ceil(TRIES).max(1);
    for &(u, v) in edges.iter().step_by(stride) {
        let slope = (vertices[v] - vertices[u]).angle();
        angles.extend((0..4).map(|quarter| f64::from(quarter) * FRAC_PI_2 - slope));
    }
    angles
}

/// Level and upright edges, more width than height, the weight below, low numbers first.
fn score(vertices: &[Point], edges: &[(usize, usize)]) -> f64 {
    let mut aligned = 0.0;
    for &(u, v) in edges {
        let slope = (vertices[v] - vertices[u]).angle();
        let off = |direction: f64| wrapped(2.0 * (slope - direction)).abs() / 2.0;
        if off(0.0) < 0.02 {
            aligned += 1.0;
        } else if off(FRAC_PI_2) < 0.02 {
            aligned += 0.9;
        }
    }
    let extent = Extent::from_points(vertices.iter().copied());
    let size = extent.size();
    let scale = size.x.max(size.y).max(1e-9);
    let centre = extent.centre();
    let count = vertices.len() as f64;
    let mut below = 0.0;
    let mut reading = 0.0;
    for (number, &point) in vertices.iter().enumerate() {
        let from_middle = (point - centre) * (1.0 / scale);
        below += from_middle.y / count;
        let late = (number as f64 + 0.5) / count - 0.5;
        reading += late * (from_middle.x + 2.0 * from_middle.y) / count;
    }
    // Numbers that grow clockwise around the centre.
    let around: f64 = (0..vertices.len())
        .map(|at| {
            let next = vertices[(at + 1) % vertices.len()];
            (vertices[at] - centre).cross(next - centre)
        })
        .sum();
    let wide = (size.x - size.y) / scale;
    2.0 * aligned / (edges.len().max(1) as f64)
        + 0.5 * wide
        + 0.6 * below
        + 0.4 * reading
        + 0.1 * (around / (scale * scale)).clamp(-1.0, 1.0)
}
