//! Figures of the folding explorer.
use toposlam_model::{
    check::*, embedded_graph::*, enumerate::Class, folding::certificate_length, mapping::*,
    world::GraphWorld,
};

struct Lcg(u64);
impl Lcg {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 33) as usize % n
    }
}

fn building(n: usize, rng: &mut Lcg) -> EmbeddedGraph {
    let w = (n as f64).sqrt().ceil() as usize;
    let at = |x: usize, y: usize| y * w + x;
    let exists = |v: usize| v < n;
    let mut edges = vec![];
    for y in 0..w + 1 {
        for x in 0..w {
            let v = at(x, y);
            if x + 1 < w && exists(v) && exists(v + 1) {
                edges.push((v, v + 1));
            }
            if exists(v) && exists(v + w) {
                edges.push((v, v + w));
            }
        }
    }
    for i in (1..edges.len()).rev() {
        let j = rng.below(i + 1);
        edges.swap(i, j);
    }
    let mut parent: Vec<usize> = (0..n).collect();
    fn find(p: &mut Vec<usize>, v: usize) -> usize {
        if p[v] != v {
            let r = find(p, p[v]);
            p[v] = r;
        }
        p[v]
    }
    let mut deg = vec![0; n];
    let mut chosen = vec![];
    let mut rest = vec![];
    for (a, b) in edges {
        let (ra, rb) = (find(&mut parent, a), find(&mut parent, b));
        if ra != rb && deg[a] < 3 && deg[b] < 3 {
            parent[ra] = rb;
            deg[a] += 1;
            deg[b] += 1;
            chosen.push((a, b));
        } else {
            rest.push((a, b));
        }
    }
    let extra = n / 4;
    let mut k = 0;
    for &(a, b) in &rest {
        if k < extra && deg[a] < 3 && deg[b] < 3 {
            deg[a] += 1;
            deg[b] += 1;
            chosen.push((a, b));
            k += 1;
        }
    }
    let root = find(&mut parent, 0);
    let mine: Vec<usize> = (0..n).filter(|&v| find(&mut parent, v) == root).collect();
    let lists: Vec<(String, Vec<String>)> = mine
        .iter()
        .map(|&v| {
            let mut nb: Vec<(usize, usize)> = chosen
                .iter()
                .filter_map(|&(a, b)| {
                    if a == v {
                        Some(b)
                    } else if b == v {
                        Some(a)
                    } else {
                        None
                    }
                })
                .map(|u| {
                    (
                        if u + w == v {
                            0
                        } else if u == v + 1 {
                            1
                        } else if u == v + w {
                            2
                        } else {
                            3
                        },
                        u,
                    )
                })
                .collect();
            nb.sort();
            (v.to_string(), nb.into_iter().map(|(_, u)| u.to_string()).collect())
        })
        .collect();
    let l: Vec<(&str, Vec<&str>)> =
        lists.iter().map(|(a, b)| (a.as_str(), b.iter().map(String::as_str).collect())).collect();
    EmbeddedGraph::from_neighbour_lists(&l).unwrap()
}

fn main() {
    for n in [25, 50, 100, 200] {
        let (mut fold, mut cert, mut one, mut vs, mut es) = (0, 0, 0, 0, 0);
        let mut rng = Lcg(7);
        let mut time = std::time::Duration::ZERO;
        for _ in 0..10 {
            let g = building(n, &mut rng);
            vs += g.vertex_count();
            es += g.edge_count();
            let mut w = GraphWorld::new(&g, Dart(0));
            let mut e = FoldingExploration::default();
            let t = std::time::Instant::now();
            map_by_folding(&mut w, &mut e).unwrap();
            time += t.elapsed();
            fold += e.trail().moves();
            cert += certificate_length(&g, Dart(0));
            let mut w = GraphWorld::new(&g, Dart(0));
            let mut e = Exploration::new(100_000);
            map_world(&mut w, &mut Nearest, &mut e, &mut ()).unwrap();
            one += e.moves();
        }
        println!(
            "{n}: n {} m {} folding {} certificate {} algorithm1 {}; ratio {:.2}, {:.1} time each {:?}",
            vs / 10,
            es / 10,
            fold / 10,
            cert / 10,
            one / 10,
            fold as f64 / cert as f64,
            one as f64 / fold as f64,
            time / 10
        );
    }
    for edges in 5..=6 {
        let tally = Sweep::new(Class::Multigraph, edges, Shard::WHOLE)
            .unwrap()
            .run_explorers(FoldingExplorer::default, &());
        println!("{edges}: {} {}", tally.starts, tally.moves_total);
    }
}
