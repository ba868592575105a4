//! The smallest start on which a broken variant of an algorithm fails.

use toposlam_model::{
    check::{Check, FailedStart, RunChoices, Shard},
    enumerate::Class,
    isomorphism::code,
    mapping::Explorer,
};

/// The edges of a start, its code, and what went wrong there.
pub(super) type Failure = (usize, Vec<u32>, String);

/// The first start of a class with up to so many edges on which an explorer fails.
pub(super) fn smallest_failure<E: Explorer>(
    new: impl Fn() -> E + Sync,
    class: Class,
    most: usize,
) -> Failure {
    let failure = (1..=most).find_map(|edges| {
        let sweep = Check::new(class, edges, Shard::WHOLE).unwrap();
        let tally = sweep.run(&new, RunChoices::Default, &());
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
