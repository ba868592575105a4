//! Figures of the folding explorer.
use toposlam_model::{
    check::{FoldingExplorer, Shard, Sweep},
    enumerate::Class,
};
fn main() {
    let sizes = [(Class::Multigraph, 1..=6), (Class::Simple, 1..=8), (Class::Corridor, 3..=10)];
    for (class, range) in sizes {
        for edges in range {
            let t = std::time::Instant::now();
            let tally = Sweep::new(class, edges, Shard::WHOLE)
                .unwrap()
                .run_explorers(FoldingExplorer::default, &());
            println!(
                "{class} {edges}: {} starts, failed {}, mean {:.3}, max {} {:.2?}",
                tally.starts,
                tally.failed(),
                tally.moves_total as f64 / tally.starts as f64,
                tally.moves_max(),
                t.elapsed()
            );
            if let Some(f) = tally.failure {
                println!("  {:?} {} facing {:?}", f.flaw, f.flaw, f.facing);
                for v in f.graph.vertices() {
                    println!(
                        "   {:?}",
                        f.graph
                            .darts_of(v)
                            .map(|d| f.graph.vertex(f.graph.opposite(d)).0)
                            .collect::<Vec<_>>()
                    );
                }
                break;
            }
        }
    }
}
