//! The smallest start on which a broken variant of an algorithm fails.

use toposlam_model::{
    check::{Algorithm, Explorer, FailedStart, Shard, Sweep, Tally},
    enumerate::Class,
    isomorphism::code,
};

/// The edges of a start, its code, and what went wrong there.
pub(super) type Failure = (usize, Vec<u32>, String);

/// The first start of a class with up to so many edges on which an algorithm fails.
pub(super) fn of_algorithm(algorithm: &impl Algorithm, class: Class, most: usize) -> Failure {
    first(class, most, |sweep| sweep.run(algorithm, &()))
}

/// The first start of a class with up to so many edges on which an explorer fails.
pub(super) fn of_explorer<E: Explorer>(
    new: impl Fn() -> E + Sync,
    class: Class,
    most: usize,
) -> Failure {
    first(class, most, |sweep| sweep.run_explorers(&new, &()))
}

fn first(class: Class, most: usize, check: impl Fn(Sweep) -> Tally) -> Failure {
    let failure = (1..=most).find_map(|edges| {
        let tally = check(Sweep::new(class, edges, Shard::WHOLE).unwrap());
        assert_eq!(tally.failed() > 0, tally.failure.is_some());
        let FailedStart { graph, facing, flaw, moves, false_step } = tally.failure?;
        let words = code(&graph, facing).words().to_vec();
        let step = false_step
            .map_or_else(|| format!("after {} moves", moves.unwrap()), |step| step.to_string());
        Some((edges, words, format!("{step}: {flaw}")))
    });
    failure.expect("the check catches it")
}

/// The word of a code for a new vertex. The word for an edge to a known vertex is the number of a dart.
pub(super) fn new(degree: u32) -> u32 {
    u32::MAX - degree
}

/// That a map became larger than the world.
pub(super) fn more_darts_than(darts: u32) -> String {
    format!("more than {darts} darts (edge ends) are known, and the map is not complete")
}
