//! Tutte's layout of a graph in the plane: straight segments, no crossing, every order kept.
//!
//! The largest face lies outside. Every other face is filled with triangles, so that the whole is
//! three-connected; then each node goes to the middle of its neighbours (W. T. Tutte, "How to draw
//! a graph", 1963).

use std::f64::consts::TAU;

use super::{super::geometry::Point, subdivision::Subdivision};

/// Sweeps of the relaxation; it stops earlier when nothing moves any more.
const SWEEPS: usize = 4000;
/// A sweep that moves no node further than this is the last.
const STILL: f64 = 1e-10;

/// One point a node, scaled so that the mean segment has length 1.
pub(super) fn without_crossings(web: &Subdivision) -> Vec<Point> {
    let faces = web.faces();
    let outer = largest(web, &faces);
    let mut filled = Filled::new(web);
    for (number, face) in faces.iter().enumerate() {
        if number == outer {
            filled.frame(web, face);
        } else {
            filled.fill(web, face);
        }
    }
    let mut points = filled.relax();
    points.truncate(web.nodes);
    let lengths = (0..web.node.len()).map(|dart| {
        let segment = points[web.far(dart)] - points[web.node[dart]];
        segment.length() / web.wish[dart]
    });
    let mean = lengths.sum::<f64>() / web.node.len() as f64;
    points.iter().map(|&point| point * (1.0 / mean)).collect()
}

/// The face with the most edges of the graph, then with the most different nodes, then the first.
fn largest(web: &Subdivision, faces: &[Vec<usize>]) -> usize {
    let rank = |face: &[usize]| {
        let real = face.iter().filter(|&&dart| web.node[dart] < web.vertices);
        let mut nodes: Vec<_> = face.iter().map(|&dart| web.node[dart]).collect();
        nodes.sort_unstable();
        nodes.dedup();
        (real.count(), nodes.len())
    };
    let mut best = 0;
    for number in 1..faces.len() {
        if rank(&faces[number]) > rank(&faces[best]) {
            best = number;
        }
    }
    best
}

/// The graph with its faces filled.
struct Filled {
    neighbours: Vec<Vec<usize>>,
    fixed: Vec<Option<Point>>,
}

impl Filled {
    fn new(web: &Subdivision) -> Self {
        let mut neighbours = vec![Vec::new(); web.nodes];
        for dart in 0..web.node.len() {
            neighbours[web.node[dart]].push(web.far(dart));
        }
        Self { fixed: vec![None; web.nodes], neighbours }
    }

    fn node(&mut self, fixed: Option<Point>) -> usize {
        self.neighbours.push(Vec::new());
        self.fixed.push(fixed);
        self.neighbours.len() - 1
    }

    fn join(&mut self, a: usize, b: usize) {
        self.neighbours[a].push(b);
        self.neighbours[b].push(a);
    }

    /// Surrounds the outer face by a ring of nodes, one a segment, on a circle. The face is on the
    /// left of its walk, so the walk goes clockwise around the picture.
    fn frame(&mut self, web: &Subdivision, face: &[usize]) {
        let count = face.len();
        let ring = self.ring(web, face);
        for (index, node) in ring.into_iter().enumerate() {
            let angle = TAU * index as f64 / count as f64;
            self.fixed[node] = Some(Point::polar(angle, 1.0));
        }
    }

    /// Fills an inner face with triangles.
    fn fill(&mut self, web: &Subdivision, face: &[usize]) {
        if face.len() == 3 {
            return;
        }
        let mut corners: Vec<_> = face.iter().map(|&dart| web.node[dart]).collect();
        let mut different = corners.clone();
        different.sort_unstable();
        different.dedup();
        if different.len() < corners.len() {
            corners = self.ring(web, face);
        }
        let centre = self.node(None);
        for corner in corners {
            self.join(centre, corner);
        }
    }

    /// A ring inside the face, one node a segment, triangles between it and the face.
    fn ring(&mut self, web: &Subdivision, face: &[usize]) -> Vec<usize> {
        let ring: Vec<_> = face.iter().map(|_| self.node(None)).collect();
        for (index, &dart) in face.iter().enumerate() {
            self.join(ring[index], ring[(index + 1) % ring.len()]);
            self.join(ring[index], web.node[dart]);
            self.join(ring[index], web.far(dart));
        }
        ring
    }

    fn relax(self) -> Vec<Point> {
        let mut points: Vec<_> = self.fixed.iter().map(|at| at.unwrap_or_default()).collect();
        for _ in 0..SWEEPS {
            let mut furthest = 0.0_f64;
            for node in 0..points.len() {
                if self.fixed[node].is_some() {
                    continue;
                }
                let near = &self.neighbours[node];
                let sum = near.iter().fold(Point::default(), |sum, &other| sum + points[other]);
                let middle = sum * (1.0 / near.len() as f64);
                furthest = furthest.max(middle.distance(points[node]));
                points[node] = middle;
            }
            if furthest < STILL {
                break;
            }
        }
        points
    }
}
