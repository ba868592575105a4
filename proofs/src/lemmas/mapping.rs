//! Whole runs of Algorithm 1, with all open choices: its invariant from round to round, the cost of a
//! round, and its end. Section 2.3.
//!
//! The runs are those of [`Algorithm1Run`] itself. Each is tracked with the truth that the robot does not
//! know: its pose in the world, and the dart of the world for each dart of its map.

use std::cell::Cell;

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    isomorphism::code,
    mapping::{
        Algorithm1Run, Explorer, FACING, MapWalk, MappingAlgorithm, MappingChoice, MappingEvent,
        Observed, explore_with,
    },
    percept::Door,
    world::GraphWorld,
};

use crate::{
    choose::{CaseResult, Choose, Exhibit, Stop, claim},
    draw,
    lemma::declare,
};

const EVERY_RUN: &str = "every run on every start with up to 4 edges, with any choices";
/// With 1, 2, 3 and 4 edges, as `toposlam check --choices all` counts them by another method.
const RUNS: u64 = 3 + 45 + 1_777 + 502_371;
const LARGER_RUNS: &str = "starts with up to 20 edges, any choices";

declare! {
    the_map_embeds_in_the_world {
        "After each round the known map embeds in the world: degrees, orders and edges are kept, \
         dart for dart. The robot is where it believes it is.",
        paper "2.3; Algorithm 1, lines 18 to 23",
        exhaustive EVERY_RUN, RUNS cases:
            the_map_embeds::<_, 1, 4>;
        sampled LARGER_RUNS: the_map_embeds::<_, 1, 20>;
    }
    a_confirmed_hypothesis_is_true {
        "A confirmed hypothesis is true: the explored edge leads to the dart of the hypothesis.",
        paper "2.3; Algorithm 1, lines 16 and 17",
        exhaustive EVERY_RUN, RUNS cases:
            confirmed_is_true::<_, 1, 4>;
        sampled LARGER_RUNS: confirmed_is_true::<_, 1, 20>;
    }
    the_true_hypothesis_is_never_rejected {
        "If the explored edge leads to a known vertex, the true hypothesis is not rejected, and \
         the edge is closed there; otherwise no hypothesis is confirmed, and a vertex is added.",
        paper "2.3; Algorithm 1, lines 7 to 17",
        exhaustive EVERY_RUN, RUNS cases:
            true_is_not_rejected::<_, 1, 4>;
        sampled LARGER_RUNS: true_is_not_rejected::<_, 1, 20>;
    }
    each_round_explores_one_edge {
        "A round removes the explored dart from U. It removes one more if it closes an edge; \
         otherwise it adds the degree of the new vertex minus one. There are as many rounds as \
         edges, and then U is empty.",
        paper "2.3; Algorithm 1, lines 4 to 23",
        exhaustive EVERY_RUN, RUNS cases:
            one_edge_a_round::<_, 1, 4>;
        sampled LARGER_RUNS: one_edge_a_round::<_, 1, 20>;
    }
    a_round_costs_no_more_than_its_paths {
        "With k known vertices and u other unexplored darts, a round takes at most k + 2 u (k - 1) \
         moves; in round r, u is at most 2 m - 2 r + 1.",
        paper "2.3, cost",
        exhaustive EVERY_RUN, RUNS cases:
            a_round_costs::<_, 1, 4>;
        sampled LARGER_RUNS: a_round_costs::<_, 1, 20>;
    }
    the_rounds_together_cost_the_bound {
        "The sum of n + 2 (2 m - 2 r + 1) (n - 1) over the rounds r = 1 ... m is m n + 2 m^2 (n - \
         1).",
        paper "2.3, cost",
        exhaustive "m and n from 1 to 64", 4096 cases: the_sum::<_, 64>;
        sampled "m and n from 1 to 240": the_sum::<_, 240>;
    }
    algorithm_1_maps_the_world {
        "Algorithm 1 ends after at most m n + 2 m^2 (n - 1) moves. Its map is isomorphic to the \
         world as a start, and the robot is where it believes it is.",
        paper "2.3",
        exhaustive EVERY_RUN, RUNS cases:
            the_theorem::<_, 1, 4>;
        sampled LARGER_RUNS: the_theorem::<_, 1, 20>;
    }
}

/// The truth while the robot explores a world.
struct Truth<'g> {
    graph: &'g EmbeddedGraph,
    /// The dart by which the robot really came in.
    pose: Dart,
    /// The image of each dart of the map in the world. The clockwise successor of a dart, and the opposite
    /// of the explored one, are those of its image.
    image: Vec<Dart>,
    /// The doors taken.
    doors: Vec<Door>,
}

impl Truth<'_> {
    /// Follows an event.
    fn event(&mut self, journey: &MapWalk, event: MappingEvent) {
        match event {
            MappingEvent::Started { percept } => self.meet(FACING, percept.degree),
            MappingEvent::Moved { door, percept: _ } => {
                self.doors.push(door);
                self.pose = self.graph.after(self.pose, door);
            }
            MappingEvent::VertexAdded { edge, vertex } => {
                let degree = journey.map().degree(vertex);
                self.meet(self.behind(edge), degree);
            }
            _ => {}
        }
    }

    /// The images of a new vertex's darts, clockwise from that of the first.
    fn meet(&mut self, mut image: Dart, degree: u32) {
        for _ in 0..degree {
            self.image.push(image);
            image = self.graph.clockwise(image);
        }
    }

    /// The dart of the world at the other end of an edge that is known at one end.
    fn behind(&self, edge: Dart) -> Dart {
        self.graph.opposite(self.image[edge.at()])
    }

    /// The dart of the map whose image is this dart of the world, if there is one.
    fn known(&self, dart: Dart) -> Option<Dart> {
        let place = self.image.iter().position(|&image| image == dart);
        place.map(|place| Dart(place as u32))
    }
}

/// Draws a run on a start, and calls `judge` with each event of the run and the truth at that moment.
/// Returns its first error, or an error if a choice was not used; otherwise the end of the run.
fn run<'g, C: Choose>(
    choose: &mut C,
    graph: &'g EmbeddedGraph,
    mut judge: impl FnMut(&Truth, &MapWalk, MappingEvent) -> CaseResult,
) -> Result<(Algorithm1Run, Truth<'g>), Stop> {
    let latest = Cell::new(FACING);
    let heeded = |event| match event {
        MappingEvent::Arrived { edge: chosen, .. }
        | MappingEvent::Rejected { hypothesis: chosen, .. }
        | MappingEvent::Confirmed { hypothesis: chosen, .. } => {
            claim("the choice is used", latest.get() == chosen)
        }
        _ => Ok(()),
    };
    let mut truth = Truth { graph, pose: FACING, image: Vec::new(), doors: Vec::new() };
    let mut verdict = Ok(());
    // The map never needs more darts than the world has.
    let mut exploration = Algorithm1Run::new(graph.dart_count());
    let bound = exploration.move_bound(graph.edge_count(), graph.vertex_count());
    let mut watch = |_: &mut _, journey: &MapWalk, event: MappingEvent| {
        assert!(journey.moves() <= bound, "a run ends");
        truth.event(journey, event);
        if verdict.is_ok() {
            verdict = heeded(event).and_then(|()| judge(&truth, journey, event));
        }
    };
    let mut world = GraphWorld::new(graph, FACING);
    let observed = &mut Observed::new(&mut world, &mut watch);
    // Any edge at line 5, any hypothesis at line 9. The map has at most 127 edges.
    let ended = explore_with(&mut exploration, observed, |run| {
        let open = run.choices()?;
        if open.is_empty() {
            return Ok(None);
        }
        let choice = open[usize::from(choose.below(open.len() as u8))];
        latest.set(match choice {
            MappingChoice::Edge(edge) => edge,
            MappingChoice::Hypothesis(index) => run.hypotheses()[index],
        });
        Ok(Some(choice))
    });
    choose.show(|| Exhibit::walk(FACING, &truth.doors));
    verdict?;
    claim("the run ends", ended.is_ok())?;
    claim("the truth is the world's", truth.pose == world.pose())?;
    let moves = truth.doors.len() as u64;
    claim("the moves are the doors taken", exploration.moves() == moves)?;
    Ok((exploration, truth))
}

/// Draws a start and a run on it, and judges each event.
fn each_event<C: Choose, const LEAST: usize, const MOST: usize>(
    choose: &mut C,
    judge: impl FnMut(&Truth, &MapWalk, MappingEvent) -> CaseResult,
) -> CaseResult {
    let graph = draw::start_of::<LEAST, MOST>(choose)?;
    run(choose, &graph, judge).map(|_| ())
}

/// Whether a round ends with this event.
fn ends_round(event: MappingEvent) -> bool {
    matches!(event, MappingEvent::LoopClosed { .. } | MappingEvent::VertexAdded { .. })
}

// paper: alg1.19, alg1.22, alg1.located
fn the_map_embeds<C: Choose, const LEAST: usize, const MOST: usize>(choose: &mut C) -> CaseResult {
    each_event::<C, LEAST, MOST>(choose, |truth, journey, event| {
        if ends_round(event) || matches!(event, MappingEvent::Started { .. }) {
            embeds(truth, journey)
        } else {
            Ok(())
        }
    })
}

fn embeds(truth: &Truth, journey: &MapWalk) -> CaseResult {
    let Truth { graph, pose, image, .. } = truth;
    let map = journey.map();
    claim("each dart of the map is one of the world", image.len() == map.dart_count())?;
    for (dart, &here) in image.iter().enumerate() {
        claim("no two darts of the map are the same", !image[..dart].contains(&here))?;
        let dart = Dart(dart as u32);
        let degree = map.degree(map.vertex(dart));
        claim("degrees are kept", degree == graph.degree_around(here))?;
        let next = map.dart(map.vertex(dart), (map.index(dart) + 1) % degree);
        let next = next.map(|next| image[next.at()]);
        claim("orders are kept", next == Some(graph.clockwise(here)))?;
        if let Some(far) = map.opposite(dart) {
            claim("edges are kept", image[far.at()] == graph.opposite(here))?;
        }
    }
    claim("the robot is where it believes it is", image[journey.robot().at()] == *pose)
}

// paper: alg1.16, alg1.validation
fn confirmed_is_true<C: Choose, const LEAST: usize, const MOST: usize>(
    choose: &mut C,
) -> CaseResult {
    let mut explored = FACING;
    each_event::<C, LEAST, MOST>(choose, |truth, journey, event| match event {
        MappingEvent::Arrived { edge, .. } => {
            explored = edge;
            Ok(())
        }
        MappingEvent::Confirmed { hypothesis, .. } => {
            let leads_to = truth.behind(explored);
            claim("the edge leads to it", truth.image[hypothesis.at()] == leads_to)?;
            let believed = truth.image[journey.robot().at()];
            claim("the robot knows its pose at the marker", believed == truth.pose)
        }
        _ => Ok(()),
    })
}

// paper: alg1.7, alg1.13, alg1.hypotheses
fn true_is_not_rejected<C: Choose, const LEAST: usize, const MOST: usize>(
    choose: &mut C,
) -> CaseResult {
    let mut truly = None;
    each_event::<C, LEAST, MOST>(choose, |truth, _, event| match event {
        MappingEvent::Arrived { edge, hypotheses, .. } => {
            truly = truth.known(truth.behind(edge));
            claim("there is a hypothesis if one is true", truly.is_none() || hypotheses > 0)
        }
        MappingEvent::Rejected { hypothesis, .. } => {
            claim("the true hypothesis is not rejected", Some(hypothesis) != truly)
        }
        MappingEvent::LoopClosed { other, .. } => {
            claim("the loop is closed there", Some(other) == truly)
        }
        MappingEvent::VertexAdded { .. } => claim("the vertex is new", truly.is_none()),
        _ => Ok(()),
    })
}

// paper: alg1.4, alg1.20, alg1.23
fn one_edge_a_round<C: Choose, const LEAST: usize, const MOST: usize>(
    choose: &mut C,
) -> CaseResult {
    let graph = draw::start_of::<LEAST, MOST>(choose)?;
    let mut rounds = 0;
    let mut unexplored = 0;
    let (exploration, _) = run(choose, &graph, |_, journey, event| {
        let map = journey.map();
        match event {
            MappingEvent::Started { percept } => {
                claim("all darts of the start are in U", map.unexplored_count() == percept.degree)?;
            }
            MappingEvent::LoopClosed { edge, other } => {
                let took = map.unexplored_count() + 2 == unexplored;
                claim("a loop takes two darts from U", took)?;
                let joined = map.opposite(edge) == Some(other) && map.opposite(other) == Some(edge);
                claim("they are one edge", joined && edge != other)?;
            }
            MappingEvent::VertexAdded { vertex, .. } => {
                let added = map.unexplored_count() + 2 == unexplored + map.degree(vertex);
                claim("a vertex adds its other darts to U", added)?;
            }
            _ => return Ok(()),
        }
        rounds += usize::from(ends_round(event));
        unexplored = map.unexplored_count();
        claim("U is what it counts", map.unexplored().count() == unexplored as usize)
    })?;
    claim("there are as many rounds as edges", rounds == graph.edge_count())?;
    claim("U is empty", exploration.map().unexplored_is_empty())
}

// paper: cost.bound
fn a_round_costs<C: Choose, const LEAST: usize, const MOST: usize>(choose: &mut C) -> CaseResult {
    let mut round = 0;
    // What it was at line 4.
    let (mut moves, mut known, mut others) = (0, 0, 0);
    each_event::<C, LEAST, MOST>(choose, |truth, journey, event| {
        if ends_round(event) {
            let cost = journey.moves() - moves;
            claim("a round costs so much at most", cost <= known + 2 * others * (known - 1))?;
        } else if !matches!(event, MappingEvent::Started { .. }) {
            return Ok(());
        }
        round += 1;
        moves = journey.moves();
        known = journey.map().vertex_count() as u64;
        let m = truth.graph.edge_count() as u64;
        let unexplored = u64::from(journey.map().unexplored_count());
        others = unexplored.saturating_sub(1);
        claim("u is so high at most", unexplored == 0 || others + 2 * round <= 2 * m + 1)
    })
}

fn the_sum<C: Choose, const MOST: u8>(choose: &mut C) -> CaseResult {
    let (m, n) = (1 + u64::from(choose.below(MOST)), 1 + u64::from(choose.below(MOST)));
    choose.show(|| Exhibit::Value { name: "m, n", value: format!("{m}, {n}") });
    let mut sum = 0;
    let mut round = 1;
    while round <= m {
        sum += n + 2 * (2 * m - 2 * round + 1) * (n - 1);
        round += 1;
    }
    claim("the sum is the bound", sum == m * n + 2 * m * m * (n - 1))?;
    claim(
        "the check has this bound",
        sum == MappingAlgorithm::Algorithm1.move_bound(m as usize, n as usize),
    )
}

// paper: alg1.isomorphic, alg1.terminates, cost.bound
pub(crate) fn the_theorem<C: Choose, const LEAST: usize, const MOST: usize>(
    choose: &mut C,
) -> CaseResult {
    let graph = draw::start_of::<LEAST, MOST>(choose)?;
    let (exploration, truth) = run(choose, &graph, |_, _, _| Ok(()))?;
    let Some(map) = exploration.map().complete() else {
        return claim("the map is complete", false);
    };
    claim("the map is the world", code(map, FACING) == code(&graph, FACING))?;
    let believed = truth.image[exploration.robot().at()];
    claim("the robot is where it believes it is", believed == truth.pose)?;
    let (m, n) = (graph.edge_count(), graph.vertex_count());
    claim("the moves are within the bound", exploration.moves() <= exploration.move_bound(m, n))
}
