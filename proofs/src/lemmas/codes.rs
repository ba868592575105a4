//! Codes of starts: the same for two starts exactly when they are isomorphic. Section 2.1.

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    isomorphism::{Bijection, as_discovered, code},
};

use crate::{
    choose::{CaseResult, Choose, Exhibit, Stop, claim},
    definition::isomorphic,
    draw,
    lemma::declare,
};

declare! {
    isomorphic_starts_have_the_same_code {
        "A start and any relabelled copy of it have the same code, and become equal when their \
         darts are numbered in the order in which a robot meets them.",
        paper "2.1",
        // 2 2! + 10 4! + 74 6!
        exhaustive "every start with up to 3 edges, every relabelling", 53_524 cases:
            relabelled::<_, 1, 3, 6>;
        sampled "starts with up to 20 edges": relabelled::<_, 1, 20, 40>;
    }
    starts_with_the_same_code_are_isomorphic {
        "Two starts have the same code exactly if there is a bijection of their darts that keeps \
         facing, opposite and clockwise; and then the verifier accepts that bijection.",
        paper "2.1",
        // (2 2 + 10 4 + 74 6) squared
        exhaustive "any two starts with up to 3 edges, facing any dart", 238_144 cases:
            same_code::<_, 1, 3>;
        sampled "starts with up to 20 edges, half of them relabelled copies":
            copy_or_other::<_, 1, 20, 40>;
    }
}

/// A copy of the graph with other numbers, and where dart 0 went.
fn copy_of<const DARTS: usize>(
    choose: &mut impl Choose,
    graph: &EmbeddedGraph,
) -> Result<(EmbeddedGraph, Dart), Stop> {
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
    match EmbeddedGraph::from_permutations(&opposite[..darts], &clockwise[..darts]) {
        Ok((copy, numbers)) => Ok((copy, numbers[image[0] as usize])),
        Err(_) => Err(Stop::Fails("a relabelled copy is a graph")),
    }
}

// paper: world.unlabelled
fn relabelled<C: Choose, const LEAST: usize, const MOST: usize, const DARTS: usize>(
    choose: &mut C,
) -> CaseResult {
    let graph = draw::start_of::<LEAST, MOST>(choose)?;
    let (copy, facing) = copy_of::<DARTS>(choose, &graph)?;
    let (one, other) = (code(&graph, Dart(0)), code(&copy, facing));
    claim("the codes are the same", one.words() == other.words())?;
    claim("as it was drawn, it is as discovered", as_discovered(&graph, Dart(0)) == graph)?;
    claim("the copy becomes equal to it", as_discovered(&copy, facing) == graph)
}

fn same_code<C: Choose, const LEAST: usize, const MOST: usize>(choose: &mut C) -> CaseResult {
    let one = draw::start_of::<LEAST, MOST>(choose)?;
    let here = draw::dart(choose, &one);
    let other = draw::start_of::<LEAST, MOST>(choose)?;
    let there = draw::dart(choose, &other);
    compare(choose, (&one, here), (&other, there))
}

/// The same, but the other start is as likely to be a copy.
fn copy_or_other<C: Choose, const LEAST: usize, const MOST: usize, const DARTS: usize>(
    choose: &mut C,
) -> CaseResult {
    let one = draw::start_of::<LEAST, MOST>(choose)?;
    let (other, there) = if choose.below(2) == 0 {
        copy_of::<DARTS>(choose, &one)?
    } else {
        (draw::start_of::<LEAST, MOST>(choose)?, Dart(0))
    };
    // From another dart a copy is usually another start.
    let here = if choose.below(2) == 0 { Dart(0) } else { draw::dart(choose, &one) };
    compare(choose, (&one, here), (&other, there))
}

// paper: world.isomorphic
fn compare(
    choose: &mut impl Choose,
    (one, here): (&EmbeddedGraph, Dart),
    (other, there): (&EmbeddedGraph, Dart),
) -> CaseResult {
    choose.show(|| Exhibit::Value {
        name: "facing",
        value: format!("dart {} of the first, dart {} of the second", here.0, there.0),
    });
    let isomorphic = isomorphic((one, here), (other, there));
    claim("the codes decide it", (code(one, here) == code(other, there)) == isomorphic)?;
    let bijection = Bijection::of_starts((one, here), (other, there));
    claim("the verifier finds it", bijection.verify(one, other) == isomorphic)
}
