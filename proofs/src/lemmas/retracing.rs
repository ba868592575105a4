//! The way back. Section 2.1; Algorithm 1, line 15.

use toposlam_model::percept::{Door, retrace};

use crate::{
    choose::{CaseResult, Choose, Exhibit, claim},
    draw,
    lemma::declare,
};

declare! {
    the_way_back_retraces_the_path {
        "After doors d1 ... dk from a pose, the doors 0, -dk, ..., -d2 lead to the vertex where \
         the path began, with entry dart d1 places clockwise from the pose; one more door, -d1, \
         leads over the edge of the pose.",
        paper "2.1; Algorithm 1, line 15",
        exhaustive "every start with up to 3 edges, every pose, every path of up to 4 \
                    moves", 213_132 cases:
            the_way_back::<_, 1, 3, 4>;
        sampled "starts with up to 20 edges, paths of up to 40 moves": the_way_back::<_, 1, 20, 40>;
    }
}

// paper: alg1.15, motion.path
fn the_way_back<C: Choose, const LEAST: usize, const MOST: usize, const MOVES: usize>(
    choose: &mut C,
) -> CaseResult {
    let graph = draw::start_of::<LEAST, MOST>(choose)?;
    let pose = draw::dart(choose, &graph);
    let moves = 1 + usize::from(choose.below(MOVES as u8));
    // Each door with the degree of the vertex where it was taken.
    let mut path = [(Door::BACK, 1); MOVES];
    let mut at = pose;
    let mut made = 0;
    while made < moves {
        let door = draw::door(choose, &graph, at);
        path[made] = (door, graph.degree_around(at));
        at = graph.after(at, door);
        made += 1;
    }
    let path = &path[..moves];
    choose.show(|| {
        let doors: Vec<_> = path.iter().map(|&(door, _)| door).collect();
        Exhibit::walk(pose, &doors)
    });
    for door in retrace(path.iter().copied()) {
        claim("a door of the way back exists", door.0 < graph.degree_around(at))?;
        at = graph.after(at, door);
    }
    let (first, degree) = path[0];
    claim("the way back ends by the first dart of the path", at == graph.behind(pose, first))?;
    let over = graph.after(at, first.inverse(degree));
    claim("one more door leads over the edge of the pose", over == graph.opposite(pose))
}
