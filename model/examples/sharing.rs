//! temporary
use std::time::Instant;
use toposlam_model::{check::*, enumerate::Class};
fn go<E: StepExplorer + Default>(class: Class, edges: usize) {
    let t = Instant::now();
    let c = LazySweep::new(class, edges, Shard::WHOLE).unwrap().run(E::default, &());
    println!(
        "lazy {} starts mapped {} moves {} made {} max {} {:?}",
        c.tally.starts,
        c.tally.mapped,
        c.tally.moves_total,
        c.moves_made,
        c.tally.moves_max(),
        t.elapsed()
    );
}
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let class: Class = a[1].parse().unwrap();
    let edges = a[2].parse().unwrap();
    match a[3].as_str() {
        "1" => go::<Algorithm1Explorer>(class, edges),
        "f" => go::<FoldingStepExplorer>(class, edges),
        _ => go::<MovableMarkerExplorer>(class, edges),
    }
    if a.len() > 4 {
        let t = Instant::now();
        let s = Sweep::new(class, edges, Shard::WHOLE).unwrap();
        let t2 = match a[3].as_str() {
            "1" => s.run(&Algorithm1, &()),
            "f" => s.run(&Folding, &()),
            _ => s.run(&MovableMarker, &()),
        };
        println!("sweep {} {} {:?}", t2.starts, t2.moves_total, t.elapsed());
    }
}
