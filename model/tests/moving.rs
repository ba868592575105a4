//! Explorers whose marking aids move map every small world in which the aid suffices.

use toposlam_model::{
    check::{Check, RunChoices, Shard, Tally},
    enumerate::Class,
    mapping::MappingAlgorithm,
};

fn swept(algorithm: MappingAlgorithm, class: Class, edges: usize, choices: RunChoices) -> Tally {
    let tally = algorithm.sweep(&Check::new(class, edges, Shard::WHOLE).unwrap(), choices, &());
    let name = algorithm.aid().name();
    assert_eq!(
        (tally.failure.as_ref(), tally.mapped),
        (None, tally.starts),
        "{name} {class} {edges}"
    );
    tally
}

fn moving() -> impl Iterator<Item = MappingAlgorithm> {
    MappingAlgorithm::all().filter(|algorithm| algorithm.aid().moves())
}

#[test]
fn every_start_of_every_small_world_is_mapped_right() {
    for algorithm in moving() {
        for edges in 1..=7 {
            swept(algorithm, Class::Simple, edges, RunChoices::Default);
        }
        swept(algorithm, Class::Corridor, 9, RunChoices::Default);
        if !algorithm.needs_simple() {
            for edges in 1..=5 {
                swept(algorithm, Class::Multigraph, edges, RunChoices::Default);
            }
        }
    }
}

#[test]
fn every_order_of_the_edges_gives_a_right_map() {
    let budget = 1_000_000;
    for algorithm in moving() {
        for edges in 1..=4 {
            swept(algorithm, Class::Simple, edges, RunChoices::All { budget });
        }
        if !algorithm.needs_simple() {
            for edges in 1..=4 {
                swept(algorithm, Class::Multigraph, edges, RunChoices::All { budget });
            }
        }
    }
}
