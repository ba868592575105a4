//! Shortens a trace while it keeps a property.

use super::Trace;

/// The largest number of shorter traces that are tried.
const TRIALS: usize = 20_000;

/// Removes sequences of moves from a trace while `shows` holds, from the longest to the shortest, until
/// none can be removed. The result is short, not shortest; it is the trace itself if `shows` does not
/// hold for it.
pub fn shortened(trace: &Trace, mut shows: impl FnMut(&Trace) -> bool) -> Trace {
    let mut shortest = trace.clone();
    let mut trials = 0;
    let mut length = shortest.doors.len();
    while length > 0 {
        let mut from = 0;
        let mut left_out = false;
        // The last percept, which the last door leads to, stays.
        while from + length < shortest.percepts.len() && trials < TRIALS {
            let shorter = shortest.without(from, from + length);
            trials += 1;
            if shows(&shorter) {
                shortest = shorter;
                left_out = true;
            } else {
                from += 1;
            }
        }
        length = if left_out { length.min(shortest.doors.len()) } else { length - 1 };
    }
    shortest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        embedded_graph::Dart,
        marker::Directional,
        percept::Door,
        trace::{
            poses,
            tests::{lollipop, walked},
        },
        world::GraphWorld,
    };

    #[test]
    fn a_false_percept_is_shown_by_the_shortest_walk_to_it() {
        let graph = lollipop();
        let start = [GraphWorld::new(&graph, Dart(0)).state()];
        // Round the triangle twice; the last percept is false.
        let round = [0, 1, 1, 1, 2, 1, 1].map(Door);
        let mut trace = walked(&graph, Dart(0), &round);
        trace.percepts.last_mut().unwrap().degree = 7;
        let misfit = |trace: &Trace| poses(&graph, &Directional, &start, trace).misfit;
        let why = misfit(&trace).unwrap().candidates[0].1;
        let shows = |trace: &Trace| {
            misfit(trace).is_some_and(|misfit| {
                misfit.event.id == trace.event(trace.len()).id && misfit.candidates[0].1 == why
            })
        };
        let short = shortened(&trace, shows);
        assert!(shows(&short));
        assert_eq!(short.doors, [Door(0)]);
    }

    /// What could not be left out before may be when something else is.
    #[test]
    fn a_length_is_tried_again_after_something_was_left_out() {
        let graph = lollipop();
        let trace = walked(&graph, Dart(0), &[0, 1, 1, 1].map(Door));
        // Events 4 and 5 may be left out; after that 0 and 1.
        let shows = |trace: &Trace| {
            let are_gone = |ids: &[usize]| ids.iter().all(|id| !trace.ids.contains(id));
            match trace.ids.len() {
                7 => are_gone(&[4, 5]),
                5 => are_gone(&[0, 1, 4, 5]),
                count => count == 9,
            }
        };
        assert_eq!(shortened(&trace, shows).ids, [2, 3, 6, 7, 8]);
    }

    #[test]
    fn a_long_trace_is_tried_as_often_as_the_limit_says() {
        let graph = lollipop();
        let there_and_back = [Door(0); 250];
        let trace = walked(&graph, Dart(0), &there_and_back);
        let mut trials = 0;
        let short = shortened(&trace, |_| {
            trials += 1;
            false
        });
        assert_eq!((short, trials), (trace, TRIALS));
    }
}
