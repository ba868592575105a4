//! The least mean number of moves of any explorer, over all starts of a class with one number of edges.
//!
//! The explorer knows the class and the number of edges, and each start is equally likely. It must be
//! right in every world, so it ends with a complete folded trail. All that it can use is the folded trail
//! of its walk and its pose in it: the starts that explain them are equally likely. A decision is which
//! open dart it takes next. The search goes through all decisions, and keeps the result for each folded
//! trail and pose. It counts totals over the starts instead of means, so that all numbers are exact.
//!
//! ```sh
//! cargo run --release -p toposlam-model --example optimum -- simple 5
//! ```

use std::{
    collections::{BTreeMap, HashMap, VecDeque},
    error::Error,
};

use petgraph::algo::dijkstra;
use toposlam_model::{
    check::{Check, RunChoices, Shard},
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Class, Each, Enumeration},
    folding::FoldedTrail,
    mapping::MappingAlgorithm,
    marker::{Directional, Marker},
    percept::{Door, Percept, Sighting},
};

/// A start that explains the walk.
#[derive(Clone, Copy)]
struct Candidate {
    start: usize,
    /// The robot's pose in it.
    pose: Dart,
    /// The edges that were traversed: a bit for the lower dart of each.
    traversed: u128,
}

/// A start, with what bounds the moves that are left in it.
struct PossibleStart {
    graph: EmbeddedGraph,
    /// The distance of each vertex from the marker.
    distance: Vec<u64>,
    /// The number of independent cycles.
    cycles: usize,
}

impl PossibleStart {
    fn new(graph: EmbeddedGraph) -> Self {
        let moves = dijkstra(&graph, graph.vertex(FACING), None, |_| 1);
        let distance = graph.vertices().map(|vertex| moves[&vertex]).collect();
        let cycles = graph.edge_count() + 1 - graph.vertex_count();
        Self { graph, distance, cycles }
    }

    fn percept(&self, pose: Dart) -> Percept {
        let sighting = Directional.sighting(&self.graph, FACING, pose);
        Percept { degree: self.graph.degree_around(pose), sighting }
    }
}

const FACING: Dart = Dart(0);

/// What the robot knows: its folded trail, and the starts that explain it.
struct Belief {
    trail: FoldedTrail,
    candidates: Vec<Candidate>,
    /// The folded trail as it is seen from the robot.
    form: Vec<u32>,
    /// No total is less.
    least: u64,
}

/// What is known about the total of a belief.
#[derive(Clone, Copy)]
enum Total {
    Exactly(u64),
    AtLeast(u64),
}

/// The search for the least total.
#[derive(Default)]
pub(crate) struct OptimumSearch {
    starts: Vec<PossibleStart>,
    known: HashMap<Vec<u32>, Total>,
}

/// A bound of the total after a decision, and what the robot may know then.
type Decision = (u64, Vec<Belief>);

impl OptimumSearch {
    /// The starts of a class with a number of edges, which is at most 64.
    ///
    /// # Errors
    /// Returns an error if they cannot be enumerated.
    pub(crate) fn new(class: Class, edges: usize) -> Result<Self, Box<dyn Error>> {
        let graphs = Enumeration::new(Each::Start, class, edges)?.graphs();
        let starts = graphs.map(PossibleStart::new).collect();
        Ok(Self { starts, known: HashMap::new() })
    }

    pub(crate) fn start_count(&self) -> usize {
        self.starts.len()
    }

    /// The number of folded trails and poses for which a result was kept.
    pub(crate) fn belief_count(&self) -> usize {
        self.known.len()
    }

    /// The least total of moves over all starts.
    ///
    /// # Errors
    /// Returns an error if a walk in a world contradicts itself, which would be a fault of the folding.
    pub(crate) fn least_total(&mut self) -> Result<u64, Box<dyn Error>> {
        let everywhere = (0..self.starts.len())
            .map(|start| Candidate { start, pose: FACING, traversed: 0 })
            .collect();
        let mut total = 0;
        for (percept, candidates) in self.by_percept(everywhere) {
            let belief = self.belief(FoldedTrail::new(percept)?, candidates);
            let mut limit = belief.least + 1;
            total += loop {
                let found = self.least(&belief, limit)?;
                if found < limit {
                    break found;
                }
                limit = found + found / 32 + 1;
            };
        }
        Ok(total)
    }

    /// The least total of a belief if it is below a limit, or else a number from the limit on that it is
    /// not below.
    fn least(&mut self, belief: &Belief, limit: u64) -> Result<u64, Box<dyn Error>> {
        match self.known.get(&belief.form) {
            Some(&Total::Exactly(total)) => return Ok(total),
            Some(&Total::AtLeast(total)) if total >= limit => return Ok(total),
            _ if belief.least >= limit || belief.trail.is_complete() => return Ok(belief.least),
            _ => {}
        }
        let mut decisions = self.decisions(belief)?;
        decisions.sort_by_key(|&(least, _)| least);
        let (mut best, mut bound) = (limit, u64::MAX);
        for (least, outcomes) in decisions {
            let mut total = least;
            for outcome in outcomes {
                if total >= best {
                    break;
                }
                let others = total - outcome.least;
                total = others + self.least(&outcome, best - others)?.max(outcome.least);
            }
            best = best.min(total);
            bound = bound.min(total);
        }
        let (total, found) = if best < limit {
            (Total::Exactly(best), best)
        } else {
            (Total::AtLeast(bound), bound)
        };
        self.known.insert(belief.form.clone(), total);
        Ok(found)
    }

    /// For each open dart, a bound of the total if it is taken next, and what the robot may know then.
    fn decisions(&self, belief: &Belief) -> Result<Vec<Decision>, Box<dyn Error>> {
        let Belief { trail, candidates, .. } = belief;
        let mut decisions = Vec::new();
        // The ways to all vertices of the trail, as doors.
        let mut reached = vec![false; trail.trail_vertex_count()];
        reached[trail.vertex(trail.pose())] = true;
        let mut queue = VecDeque::from([(trail.pose(), Vec::new())]);
        while let Some((pose, way)) = queue.pop_front() {
            for door in (0..trail.degree(pose)).map(Door) {
                let doors: Vec<Door> = way.iter().copied().chain([door]).collect();
                match trail.opposite(trail.behind(pose, door)) {
                    None => {
                        let moves = (doors.len() * candidates.len()) as u64;
                        let outcomes = self.outcomes(belief, &doors)?;
                        let least: u64 = outcomes.iter().map(|outcome| outcome.least).sum();
                        decisions.push((moves + least, outcomes));
                    }
                    Some(next) if !reached[trail.vertex(next)] => {
                        reached[trail.vertex(next)] = true;
                        queue.push_back((next, doors));
                    }
                    Some(_) => {}
                }
            }
        }
        Ok(decisions)
    }

    /// What the robot may know after some doors.
    fn outcomes(&self, belief: &Belief, doors: &[Door]) -> Result<Vec<Belief>, Box<dyn Error>> {
        let after = |&Candidate { start, mut pose, mut traversed }: &Candidate| {
            let graph = &self.starts[start].graph;
            for &door in doors {
                let leaving = graph.behind(pose, door);
                pose = graph.opposite(leaving);
                traversed |= 1 << leaving.0.min(pose.0);
            }
            Candidate { start, pose, traversed }
        };
        let candidates = belief.candidates.iter().map(after).collect();
        let mut outcomes = Vec::new();
        let Some(example) = belief.candidates.first() else { return Ok(outcomes) };
        let (last, way) = doors.split_last().map_or((Door::BACK, &[][..]), |(&l, way)| (l, way));
        let mut trail = belief.trail.clone();
        let start = &self.starts[example.start];
        let mut pose = example.pose;
        for &door in way {
            pose = start.graph.after(pose, door);
            trail.step(door, start.percept(pose))?;
        }
        for (percept, candidates) in self.by_percept(candidates) {
            let mut trail = trail.clone();
            trail.step(last, percept)?;
            outcomes.push(self.belief(trail, candidates));
        }
        Ok(outcomes)
    }

    fn belief(&self, trail: FoldedTrail, candidates: Vec<Candidate>) -> Belief {
        let form = trail.seen_from_robot();
        let least = match self.known.get(&form) {
            Some(&(Total::Exactly(total) | Total::AtLeast(total))) => total,
            None if trail.is_complete() => 0,
            None => candidates.iter().map(|candidate| self.moves_left(&trail, candidate)).sum(),
        };
        Belief { trail, candidates, form, least }
    }

    /// A bound of the moves that are left in a start: each edge has to be traversed, and each return to
    /// the marker closes at most one cycle of the folded trail.
    fn moves_left(&self, trail: &FoldedTrail, candidate: &Candidate) -> u64 {
        let start = &self.starts[candidate.start];
        let edges = start.graph.edge_count() as u64;
        let left = edges - u64::from(candidate.traversed.count_ones());
        let darts: usize =
            trail.vertices().map(|first| trail.degree(first) as usize).sum::<usize>();
        let trail_edges = (darts - trail.open_count()) / 2;
        let cycles = trail_edges + 1 - trail.vertex_count();
        let returns = match (start.cycles - cycles) as u64 {
            0 => 0,
            open => {
                let home = start.distance[start.graph.vertex(candidate.pose).at()];
                home.max(1) + open - 1
            }
        };
        left.max(returns).max(1)
    }

    fn by_percept(&self, candidates: Vec<Candidate>) -> Vec<(Percept, Vec<Candidate>)> {
        let mut groups: BTreeMap<(u32, Option<u32>), (Percept, Vec<Candidate>)> = BTreeMap::new();
        for candidate in candidates {
            let percept = self.starts[candidate.start].percept(candidate.pose);
            let door = match percept.sighting {
                Sighting::Pointing(Door(door)) => Some(door),
                _ => None,
            };
            let group = groups.entry((percept.degree, door));
            group.or_insert_with(|| (percept, Vec::new())).1.push(candidate);
        }
        groups.into_values().collect()
    }
}

#[allow(dead_code, reason = "a test has the search without the program")]
fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let class: Class = arguments.next().ok_or("class?")?.parse()?;
    let most: usize = arguments.next().ok_or("edges?")?.parse()?;
    println!("class {class}: the mean moves of the best explorer, and of the folding explorer");
    for edges in 1..=most {
        let mut search = OptimumSearch::new(class, edges)?;
        let best = search.least_total()?;
        let sweep = Check::new(class, edges, Shard::WHOLE)?;
        let folding = MappingAlgorithm::Folding.sweep(&sweep, RunChoices::Default, &());
        let mean = |total: u64| total as f64 / search.start_count() as f64;
        let means = [best, folding.certificate_total, folding.moves_total].map(mean);
        println!(
            "{edges} edges, {} starts: at least {:.3} ({best} in all), certificate {:.3}, folding \
             explorer {:.3}; {} beliefs",
            search.start_count(),
            means[0],
            means[1],
            means[2],
            search.belief_count(),
        );
    }
    Ok(())
}
