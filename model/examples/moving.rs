use toposlam_model::{
    check::{Check, RunChoices, Shard},
    enumerate::Class,
    mapping::MappingAlgorithm,
};
fn main() {
    let most: usize = std::env::args().nth(1).unwrap().parse().unwrap();
    let all = std::env::args().nth(2).is_some();
    for algorithm in MappingAlgorithm::all() {
        for class in [Class::Simple, Class::Multigraph] {
            if class == Class::Multigraph && algorithm.needs_simple() {
                continue;
            }
            let top = if class == Class::Simple { most } else { most - 2 };
            for edges in 1..=top {
                let choices =
                    if all { RunChoices::All { budget: 1_000_000 } } else { RunChoices::Default };
                let tally =
                    algorithm.sweep(&Check::new(class, edges, Shard::WHOLE).unwrap(), choices, &());
                if let Some(failure) = &tally.failure {
                    println!(
                        "{} {class} {edges}: {} of {}: {} {:?} {:?}",
                        algorithm.aid().name(),
                        tally.mapped,
                        tally.starts,
                        failure.flaw,
                        failure.moves,
                        failure.false_step.map(|s| s.to_string())
                    );
                    println!(
                        "  {:?}",
                        failure
                            .graph
                            .darts()
                            .map(|d| (failure.graph.vertex(d).0, failure.graph.opposite(d).0))
                            .collect::<Vec<_>>()
                    );
                    break;
                }
                if edges == top {
                    println!(
                        "{} {} {class} {edges}: starts {} moves {} max {}",
                        algorithm.name(),
                        algorithm.aid().name(),
                        tally.starts,
                        tally.moves_total,
                        tally.moves_max()
                    );
                }
            }
        }
    }
}
