//! Tutte's layout of a planar graph: straight segments, no crossing, every order kept.
//!
//! The largest face lies outside. Every other face is filled with triangles, so that the whole is
//! three-connected; then each node goes to the middle of its neighbours (W. T. Tutte, "How to draw
//! a graph", 1963). That crowds the inside of a large graph. As every positive weight of the
//! segments gives a layout without crossings, longer segments then get more weight, round by round.

use std::f64::consts::TAU;

use super::{super::geometry::Point, subdivision::Subdivision};

/// The most sweeps of the relaxation; it stops earlier if no node moves.
const SWEEPS: usize = 4000;
/// A sweep that moves no node farther than this is the last.
const STILL: f64 = 1e-10;

/// Enough rounds for the segments of a large graph to become even.
pub(super) const EVENING: usize = 12;
/// Sweeps of each round.
const ROUND_SWEEPS: usize = 250;

/// One point a node, scaled so that the mean segment has length 1. In each round, longer segments get more weight.
pub(super) fn without_crossings(web: &Subdivision, rounds: usize) -> Vec<Point> {
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
    let mut points = filled.relax(rounds);
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
        (real.count(), web.different_nodes(face))
    };
    let last_first = (0..faces.len()).rev();
    last_first.max_by_key(|&number| rank(&faces[number])).unwrap_or(0)
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
        let corners = if web.different_nodes(face) < face.len() {
            self.ring(web, face)
        } else {
            face.iter().map(|&dart| web.node[dart]).collect()
        };
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

    fn relax(self, rounds: usize) -> Vec<Point> {
        let mut points: Vec<_> = self.fixed.iter().map(|at| at.unwrap_or_default()).collect();
        let mut pulls: Vec<Vec<f64>> =
            self.neighbours.iter().map(|near| vec![1.0; near.len()]).collect();
        self.settle(&mut points, &pulls, SWEEPS);
        for _ in 0..rounds {
            for (node, near) in self.neighbours.iter().enumerate() {
                for (pull, &other) in pulls[node].iter_mut().zip(near) {
                    *pull *= points[node].distance(points[other]).max(1e-9).sqrt();
                }
            }
            self.settle(&mut points, &pulls, ROUND_SWEEPS);
        }
        points
    }

    /// Moves each node to the middle of its neighbours, weighed by their pulls, until all are there.
    fn settle(&self, points: &mut [Point], pulls: &[Vec<f64>], sweeps: usize) {
        for _ in 0..sweeps {
            let mut furthest = 0.0_f64;
            for node in 0..points.len() {
                if self.fixed[node].is_some() {
                    continue;
                }
                let near = self.neighbours[node].iter().zip(&pulls[node]);
                let (sum, weight) = near
                    .fold((Point::default(), 0.0), |(sum, weight), (&other, &pull)| {
                        (sum + points[other] * pull, weight + pull)
                    });
                let middle = sum * (1.0 / weight);
                furthest = furthest.max(middle.distance(points[node]));
                points[node] = middle;
            }
            if furthest < STILL {
                break;
            }
        }
    }
}
