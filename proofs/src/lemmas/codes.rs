//! Codes of starts: the same for two starts exactly when they are isomorphic. Section 2.1.

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    isomorphism::{Bijection, as_discovered, code},
};

use crate::{
    choose::{Case, Choose, Exhibit, claim},
    definition::isomorphic,
    draw,
    lemma::declare,
};

declare! {
    isomorphic_starts_have_the_same_code {
        "A start and any relabelled copy of it have the same code, and become equal when their darts \
         are numbered as a robot meets them.",
        paper "2.1",
        // 2 2! + 10 4! + 74 6!
        exhaustive "every start with up to 3 edges, every relabelling", 53_524 cases: relabelled::<_, 1, 3, 6>;
        sampled "starts with up to 20 edges": relabelled::<_, 1, 20, 40>;
        kani "every start with 2 edges, every relabelling", unwind 13: relabelled::<_, 2, 2, 4>;
    }
    starts_with_the_same_code_are_isomorphic {
        "Two starts have the same code exactly if going on from facing to facing, opposite to opposite \
         and clockwise to clockwise, pairs their darts one to one; and exactly then the verifier \
         accepts that bijection.",
        paper "2.1",
        // (2 2 + 10 4 + 74 6) squared
        exhaustive "any two starts with up to 3 edges, facing any dart", 238_144 cases: same_code::<_, 1, 3>;
        sampled "starts with up to 4 edges": same_code::<_, 1, 4>;
    }
}

// paper: world.unlabelled
fn relabelled<C: Choose, const LEAST: usize, const MOST: usize, const DARTS: usize>(
    choose: &mut C,
) -> Case {
    let graph = draw::start_of::<LEAST, MOST>(choose)?;
    let darts = graph.dart_count();
    let image = draw::permutation::<DARTS>(choose, darts);
    choose.show(|| Exhibit::Value { name: "new numbers", value: format!("{:?}", &image[..darts]) });
    let (mut opposite, mut clockwise) = ([0; DARTS], [0; DARTS]);
    let mut dart = 0;
    while dart < darts {
        let this = Dart(dart as u32);
        opposite[image[dart] as usize] = image[graph.opposite(this).at()];
        clockwise[image[dart] as usize] = image[graph.clockwise(this).at()];
        dart += 1;
    }
    let copy = EmbeddedGraph::from_permutations(&opposite[..darts], &clockwise[..darts]);
    let Ok((copy, numbers)) = copy else {
        return claim("a relabelled copy is a graph", false);
    };
    let facing = numbers[image[0] as usize];
    claim("the codes are the same", code(&graph, Dart(0)) == code(&copy, facing))?;
    // It was drawn in the order in which a robot meets it.
    claim("as a robot meets it, a start stays as it is", as_discovered(&graph, Dart(0)) == graph)?;
    claim("they become equal", as_discovered(&copy, facing) == graph)
}

// paper: world.isomorphic
fn same_code<C: Choose, const LEAST: usize, const MOST: usize>(choose: &mut C) -> Case {
    let one = draw::start_of::<LEAST, MOST>(choose)?;
    let here = draw::dart(choose, &one);
    let other = draw::start_of::<LEAST, MOST>(choose)?;
    let there = draw::dart(choose, &other);
    choose.show(|| Exhibit::Value {
        name: "facing",
        value: format!("dart {} of the first, dart {} of the second", here.0, there.0),
    });
    let isomorphic = isomorphic((&one, here), (&other, there));
    claim("the codes tell it", (code(&one, here) == code(&other, there)) == isomorphic)?;
    let bijection = Bijection::of_starts((&one, here), (&other, there));
    claim("the verifier tells it", bijection.verify(&one, &other) == isomorphic)
}
