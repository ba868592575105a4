//! What worlds cost, with each algorithm and at least: the tables in `worlds/README.md` and
//! `docs/folding.md`.

use std::ops::RangeInclusive;

use toposlam_model::{
    aid::markers::MOVABLE,
    check::{Check, DEFAULT_STATE_BUDGET, RunChoices, Shard, Tally, every_way},
    embedded_graph::Dart,
    enumerate::Class,
    folding::certificate_length,
    format::named_world::NamedWorld,
    mapping::{Algorithm1Run, MappingAlgorithm},
    world::GraphWorld,
};

use crate::{text_of, world, world_names};

/// The rows of the table that stands under a heading of a page. Digits of large numbers are grouped there.
fn printed(page: &str, heading: &str) -> Vec<String> {
    let page = text_of(page);
    let (_, section) = page.split_once(&format!("\n## {heading}\n")).unwrap();
    let section = section.split("\n## ").next().unwrap();
    let rows = section.lines().filter(|line| line.starts_with('|'));
    // After its head.
    rows.skip(2).map(|row| row.replace(',', "")).collect()
}

fn moves(algorithm: MappingAlgorithm, world: &NamedWorld, facing: Dart) -> u64 {
    let mut robot = GraphWorld::with_aid(&world.graph, algorithm.aid(), facing);
    let (journey, mapped) = algorithm.map_world(&mut robot, world.graph.dart_count(), &mut ());
    mapped.unwrap();
    journey.moves()
}

/// A row for each start: its moves, the runs with free choices and the least and most moves among
/// them, and whether the paper's cost is among them.
fn rows(name: &str, paper: u64) -> Vec<String> {
    let world = world(name);
    let row = |facing| {
        let run = Algorithm1Run::default();
        let ways = every_way(run, &world.graph, facing, DEFAULT_STATE_BUDGET, &()).unwrap();
        let (least, most) = ways.costs.min().zip(ways.costs.max()).unwrap();
        let among = if ways.costs.contains(paper) { "yes" } else { "no" };
        let (start, runs) = (world.start_text(facing), ways.runs);
        let moves = moves(MappingAlgorithm::Algorithm1, &world, facing);
        format!("| {name} | {start} | {moves} | {runs} | {least} to {most} | {paper}: {among} |")
    };
    world.graph.darts().map(row).collect()
}

// paper: cost.shape-6, cost.shape-8
#[test]
fn the_table_of_costs_is_true() {
    let table: Vec<_> = [rows("shape-6", 9), rows("shape-8", 14)].concat();
    let printed = printed("worlds/README.md", "What the paper's own worlds cost");
    assert_eq!(printed, table, "\n{}", table.join("\n"));
    assert!(table.iter().any(|row| row.contains("| 9: yes |")));
    assert!(table.iter().any(|row| row.contains("| 14: yes |")));
}

/// A row for each world file without loops and parallel edges, from the file's own start.
fn own_starts() -> Vec<String> {
    let worlds = world_names().into_iter().map(|name| world(&name));
    let rows = worlds.filter(|world| world.graph.is_simple()).map(|world| {
        let facing = world.start.unwrap();
        let certificate = certificate_length(&world.graph, facing);
        let one = moves(MappingAlgorithm::Algorithm1, &world, facing);
        format!(
            "| {} | {} | {} | {} | {certificate} | {one} | {:.2} | {} |",
            world.name,
            world.start_text(facing),
            world.graph.vertex_count(),
            world.graph.edge_count(),
            one as f64 / certificate as f64,
            moves(MappingAlgorithm::MovableMarkers(MOVABLE), &world, facing),
        )
    });
    rows.collect()
}

#[test]
fn the_table_of_both_costs_is_true() {
    let table = own_starts();
    let printed = printed("worlds/README.md", "What a movable marker costs");
    assert!(table.len() >= 14);
    assert_eq!(printed, table, "\n{}", table.join("\n"));
}

fn tally(class: Class, edges: usize, algorithm: MappingAlgorithm) -> Tally {
    let check = Check::new(class, edges, Shard::WHOLE).unwrap();
    let tally = algorithm.sweep(&check, RunChoices::Default, &());
    assert_eq!(tally.failure, None);
    assert_eq!((tally.mapped, tally.below_certificate), (tally.starts, 0));
    tally
}

/// The mean over the starts, and the largest value, as two cells.
fn cells(tally: &Tally, total: u64, most: u64) -> String {
    format!("{:.1} | {most}", total as f64 / tally.starts as f64)
}

/// A row for each number of edges: the mean and the most moves of a certificate and of both algorithms.
fn every_start(class: Class, up_to: usize) -> Vec<String> {
    let rows = (1..=up_to).map(|edges| {
        let one = tally(class, edges, MappingAlgorithm::Algorithm1);
        let other = tally(class, edges, MappingAlgorithm::MovableMarkers(MOVABLE));
        let certificate = cells(&one, one.certificate_total, one.certificate_max);
        let starts = one.starts;
        let ratio = one.moves_total as f64 / one.certificate_total as f64;
        let [one, other] =
            [one, other].map(|tally| cells(&tally, tally.moves_total, tally.moves_max()));
        format!("| {class} | {edges} | {starts} | {certificate} | {one} | {ratio:.2} | {other} |")
    });
    rows.collect()
}

#[test]
fn the_table_of_every_small_start_is_true() {
    let classes = [(Class::Simple, 8), (Class::Corridor, 10), (Class::Planar, 8)];
    let table = classes.map(|(class, up_to)| every_start(class, up_to)).concat();
    let printed = printed("worlds/README.md", "What every small start costs");
    assert_eq!(printed, table, "\n{}", table.join("\n"));
}

/// The sizes of each class in the table on folding: the first, the last that is checked at once, and the
/// last.
const FOLDED: [(Class, [usize; 3]); 4] = [
    (Class::Multigraph, [3, 6, 7]),
    (Class::Simple, [3, 8, 9]),
    (Class::Corridor, [3, 10, 11]),
    (Class::Planar, [3, 8, 9]),
];

/// A row of the table on folding. A start that is mapped wrongly, in more moves than the bound or in fewer
/// than its certificate has is an error.
fn folded(class: Class, edges: usize) -> String {
    let folding = tally(class, edges, MappingAlgorithm::Folding);
    let algorithm1 = tally(class, edges, MappingAlgorithm::Algorithm1);
    let two_places =
        |total: u64, most: u64| format!("{:.2} / {most}", total as f64 / folding.starts as f64);
    let ratio = |total: u64| total as f64 / folding.certificate_total as f64;
    format!(
        "| {class} | {edges} | {} | {} | {} | {:.2} | {} | {:.2} |",
        folding.starts,
        two_places(folding.certificate_total, folding.certificate_max),
        two_places(folding.moves_total, folding.moves_max()),
        ratio(folding.moves_total),
        two_places(algorithm1.moves_total, algorithm1.moves_max()),
        ratio(algorithm1.moves_total),
    )
}

/// The rows of the table on folding for these sizes are printed as they are computed.
fn check_folded(sizes: impl Fn([usize; 3]) -> RangeInclusive<usize>) {
    let printed = printed("docs/folding.md", "What every small start costs");
    let count: usize = FOLDED.iter().map(|(_, [first, _, last])| last + 1 - first).sum();
    assert_eq!(printed.len(), count);
    let rows = FOLDED
        .iter()
        .flat_map(|&(class, bounds)| sizes(bounds).map(move |edges| folded(class, edges)));
    let wrong: Vec<String> = rows.filter(|row| !printed.contains(row)).collect();
    assert!(wrong.is_empty(), "these rows are right:\n{}", wrong.join("\n"));
}

#[test]
fn the_table_on_folding_is_true() {
    check_folded(|[first, middle, _]| first..=middle);
}

/// `docs/folding.md` has the command that runs it.
#[test]
#[ignore = "it takes a minute"]
fn the_largest_sizes_in_the_table_on_folding_are_true() {
    check_folded(|[_, middle, last]| middle + 1..=last);
}
