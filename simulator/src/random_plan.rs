//! Random floor plans.
//!
//! Hallways grow along the lines of a random grid, at most three at a junction. Then each straight
//! run of hallways is moved aside a little. The lines of the grid are far enough apart to keep
//! junctions at least two hallway widths apart, so that every plan is valid.

use std::iter;

use rand::{RngExt, SeedableRng, seq::IndexedRandom};
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_model::floor_plan::{Direction, FloorPlan, FloorPlanError};

/// Least and greatest width of hallways, in metres.
const WIDTHS: [f64; 2] = [1.4, 2.0];
/// Least and greatest number of grid lines in each direction.
const LINES: [usize; 2] = [2, 5];
/// Least and greatest spare distance between grid lines, in metres.
const SPARE: [f64; 2] = [0.0, 4.0];
/// The greatest offset of a straight run of hallways, in metres.
const ASIDE: f64 = 0.6;
/// Least and greatest number of hallway pieces. A piece joins two neighbouring grid nodes.
const PIECES: [usize; 2] = [2, 16];

type Node = [usize; 2];

/// The random floor plan of a seed. Hallways are 1.4 to 2 m wide. There are dead ends, Ls, Ts and
/// often loops.
pub fn random_plan(seed: u64) -> Result<FloorPlan, FloorPlanError> {
    drawn(seed, Pieces::grown)
}

/// The random floor plan of a seed with this number of junctions, at least 2.
pub fn random_plan_with(seed: u64, junctions: usize) -> Result<FloorPlan, FloorPlanError> {
    drawn(seed, |chance| Pieces::with_junctions(chance, junctions.max(2)))
}

/// Builds a plan from pieces of hallway on random lines.
fn drawn(
    seed: u64,
    grown: impl FnOnce(&mut Xoshiro256PlusPlus) -> Pieces,
) -> Result<FloorPlan, FloorPlanError> {
    let mut chance = Xoshiro256PlusPlus::seed_from_u64(seed);
    let width = chance.random_range(WIDTHS[0]..WIDTHS[1]);
    let aside = if chance.random() { ASIDE } else { 0.0 };
    let pieces = grown(&mut chance);
    let lines = pieces.size.map(|count| -> Vec<f64> {
        let mut at = 0.0;
        let next = |_| {
            at += 2.0 * width + 2.0 * aside + chance.random_range(SPARE[0]..SPARE[1]);
            at
        };
        (0..count).map(next).collect()
    });
    let nodes = pieces.junctions();
    // For each axis, a grid of the offsets across it. A straight run has one offset.
    let mut moved = [0, 1].map(|_| vec![None; pieces.doors.len()]);
    let mut positions = Vec::new();
    for &node in &nodes {
        let position = [0, 1].map(|axis| {
            let run = pieces.run(node, 1 - axis);
            let by = &mut moved[axis][pieces.number(run)];
            lines[axis][node[axis]]
                + *by.get_or_insert_with(|| aside * chance.random_range(-1.0..=1.0))
        });
        positions.push(position);
    }
    let name =
        |node: Node| format!("j{}", nodes.iter().position(|&other| other == node).unwrap_or(0));
    let junctions: Vec<_> = nodes.iter().map(|&node| name(node)).zip(positions).collect();
    let hallways: Vec<_> =
        pieces.hallways().into_iter().map(|[from, to]| (name(from), name(to))).collect();
    FloorPlan::new(width, &junctions, &hallways)
}

/// Pieces of hallway on a grid. Each joins neighbouring nodes.
struct Pieces {
    /// The number of lines across x and across y.
    size: [usize; 2],
    /// For each node, whether a piece leads in each direction.
    doors: Vec<[bool; 4]>,
}

impl Pieces {
    /// Connected pieces, at least one, with at most three at a node.
    fn grown(chance: &mut Xoshiro256PlusPlus) -> Self {
        let size = [0; 2].map(|_| chance.random_range(LINES[0]..=LINES[1]));
        let wanted = chance.random_range(PIECES[0]..=PIECES[1]);
        // Some tries fail: a small grid may have no more room.
        Self::grown_until(chance, size, 20 * wanted, |pieces| pieces.count() == wanted)
    }

    /// Pieces with this number of junctions, at least two.
    fn with_junctions(chance: &mut Xoshiro256PlusPlus, wanted: usize) -> Self {
        // The grid has room for twice as many.
        let lines = (2.0 * wanted as f64).sqrt().ceil() as usize + 1;
        loop {
            // A piece changes the number of junctions by at most one, or rarely by two. If it
            // passes the number, later pieces may still hit it.
            let pieces = Self::grown_until(chance, [lines; 2], 200 * wanted, |pieces| {
                pieces.junctions().len() == wanted
            });
            if pieces.junctions().len() == wanted {
                return pieces;
            }
        }
    }

    /// Adds pieces for this many tries, or until `done`.
    fn grown_until(
        chance: &mut Xoshiro256PlusPlus,
        size: [usize; 2],
        tries: usize,
        done: impl Fn(&Self) -> bool,
    ) -> Self {
        let mut pieces = Self { size, doors: vec![[false; 4]; size[0] * size[1]] };
        let mut reached = vec![size.map(|count| chance.random_range(0..count))];
        for _ in 0..tries {
            let Some(&from) = reached.choose(chance) else { break };
            let Some(&direction) = Direction::ALL.choose(chance) else { break };
            let Some(to) = pieces.neighbour(from, direction) else { continue };
            if pieces.has(from, direction) || pieces.degree(from) == 3 || pieces.degree(to) == 3 {
                continue;
            }
            for (node, direction) in [(from, direction), (to, direction.reversed())] {
                let number = pieces.number(node);
                pieces.doors[number][direction as usize] = true;
            }
            if !reached.contains(&to) {
                reached.push(to);
            }
            if done(&pieces) {
                break;
            }
        }
        pieces
    }

    fn number(&self, [x, y]: Node) -> usize {
        y * self.size[0] + x
    }

    fn count(&self) -> usize {
        self.doors.iter().flatten().filter(|&&there| there).count() / 2
    }

    fn neighbour(&self, [x, y]: Node, direction: Direction) -> Option<Node> {
        let node = match direction {
            Direction::North => [x, y + 1],
            Direction::East => [x + 1, y],
            Direction::South => [x, y.checked_sub(1)?],
            Direction::West => [x.checked_sub(1)?, y],
        };
        (node[0] < self.size[0] && node[1] < self.size[1]).then_some(node)
    }

    /// The neighbour to which a piece leads in a direction.
    fn next(&self, node: Node, direction: Direction) -> Option<Node> {
        self.neighbour(node, direction).filter(|_| self.has(node, direction))
    }

    fn has(&self, node: Node, direction: Direction) -> bool {
        self.doors[self.number(node)][direction as usize]
    }

    fn degree(&self, node: Node) -> usize {
        self.doors[self.number(node)].iter().filter(|&&door| door).count()
    }

    /// Whether hallways end at a node: there are some, and they do not just pass through it.
    fn is_junction(&self, node: Node) -> bool {
        let [north, east, south, west] = self.doors[self.number(node)];
        north != south || east != west || north && east
    }

    fn junctions(&self) -> Vec<Node> {
        let [columns, rows] = self.size;
        let nodes = (0..rows).flat_map(|y| (0..columns).map(move |x| [x, y]));
        nodes.filter(|&node| self.is_junction(node)).collect()
    }

    /// The first node of the straight run of pieces through a node along an axis. It is the node
    /// itself if no piece leads to it.
    fn run(&self, node: Node, axis: usize) -> Node {
        let back = [Direction::West, Direction::South][axis];
        iter::successors(Some(node), |&node| self.next(node, back)).last().unwrap_or(node)
    }

    /// The junctions at both ends of each hallway.
    fn hallways(&self) -> Vec<[Node; 2]> {
        let mut hallways = Vec::new();
        for from in self.junctions() {
            for onwards in [Direction::East, Direction::North] {
                let first = self.next(from, onwards);
                let mut nodes = iter::successors(first, |&node| self.next(node, onwards));
                let to = nodes.find(|&node| self.is_junction(node));
                hallways.extend(to.map(|to| [from, to]));
            }
        }
        hallways
    }
}

#[cfg(test)]
mod tests {
    use proptest::{prelude::*, test_runner::Config};
    use toposlam_model::floor_plan::JunctionKind;

    use super::*;

    proptest! {
        #![proptest_config(Config { cases: 4000, failure_persistence: None, ..Config::default() })]

        #[test]
        fn every_random_plan_is_valid(seed: u64) {
            let plan = random_plan(seed);
            prop_assert!(plan.is_ok(), "{:?}", plan);
            let width = plan.unwrap().hallway_width();
            prop_assert!((WIDTHS[0]..WIDTHS[1]).contains(&width));
        }
    }

    #[test]
    fn a_plan_has_the_requested_number_of_junctions() {
        for (seed, junctions) in (2..=25).chain([100]).enumerate() {
            let plan = random_plan_with(seed as u64, junctions).unwrap();
            assert_eq!(plan.junctions().len(), junctions);
        }
    }

    #[test]
    fn plans_have_every_kind_of_junction_and_loops() {
        let plans: Vec<_> = (0..200).map(|seed| random_plan(seed).unwrap()).collect();
        let with = |kind| {
            let has = |plan: &&FloorPlan| plan.junctions().iter().any(|found| found.kind == kind);
            plans.iter().filter(has).count()
        };
        assert!(with(JunctionKind::DeadEnd) > 100);
        assert!(with(JunctionKind::L) > 100);
        assert!(with(JunctionKind::T) > 100);
        let loops = |plan: &&FloorPlan| plan.graph().edge_count() >= plan.graph().vertex_count();
        assert!(plans.iter().filter(loops).count() > 50);
        let lengths = || {
            plans.iter().flat_map(|plan| {
                plan.hallways().iter().map(|hallway| {
                    let [one, other] =
                        [hallway.from, hallway.to].map(|end| plan.junction(end).position);
                    (one[0] - other[0]).hypot(one[1] - other[1]) / plan.hallway_width()
                })
            })
        };
        assert!(lengths().any(|length| length < 2.1), "a shortest hallway");
        assert!(lengths().any(|length| length > 8.0), "a long one");
        // Off the grid: some positions differ by less than the distance of two lines.
        let close = |plan: &&FloorPlan| {
            let junctions = plan.junctions();
            junctions.iter().any(|one| {
                junctions.iter().any(|other| {
                    let apart = (one.position[0] - other.position[0]).abs();
                    apart > 0.01 && apart < 1.2
                })
            })
        };
        assert!(plans.iter().filter(close).count() > 20);
    }
}
