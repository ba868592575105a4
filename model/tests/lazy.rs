//! The check without repetition against the check of one start after the other.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use toposlam_model::{
    check::{
        Algorithm1, Algorithm1Explorer, Folding, FoldingStepExplorer, LazyCheck, LazySweep,
        MovableMarker, MovableMarkerExplorer, Shard, StepExplorer, Stepwise, Sweep, Tally,
    },
    enumerate::Class,
};

fn lazy<E: StepExplorer + Default>(class: Class, edges: usize) -> LazyCheck {
    LazySweep::new(class, edges, Shard::WHOLE).unwrap().run(E::default, &())
}

fn stepwise<E: StepExplorer + Default>(class: Class, edges: usize) -> Tally {
    let sweep = Sweep::new(class, edges, Shard::WHOLE).unwrap();
    sweep.run_explorers(|| Stepwise(E::default()), &())
}

/// A000698.
#[test]
fn the_tree_has_a_leaf_for_each_start() {
    let leaves = |edges| lazy::<Algorithm1Explorer>(Class::Multigraph, edges).tally.starts;
    assert_eq!([1, 2, 3, 4, 5, 6, 7].map(leaves), [2, 10, 74, 706, 8162, 110_410, 1_708_394]);
}

#[test]
fn both_checks_have_the_same_result() {
    for class in Class::ALL {
        let most = if class == Class::Multigraph { 6 } else { 8 };
        for edges in 1..=most {
            let sweep = Sweep::new(class, edges, Shard::WHOLE).unwrap();
            let lazily = lazy::<Algorithm1Explorer>(class, edges).tally;
            assert_eq!(lazily, sweep.run(&Algorithm1, &()), "{class} {edges}");
            if class == Class::Multigraph && edges == 6 {
                continue;
            }
            let lazily = lazy::<FoldingStepExplorer>(class, edges).tally;
            assert_eq!(lazily, sweep.run(&Folding, &()), "{class} {edges}");
            if class.is_simple() {
                let lazily = lazy::<MovableMarkerExplorer>(class, edges).tally;
                assert_eq!(lazily, sweep.run(&MovableMarker, &()), "{class} {edges}");
            }
        }
    }
}

/// One movable marker does not suffice in multigraphs, and both checks find the same failures.
#[test]
fn both_checks_find_the_same_failures() {
    for edges in 1..=5 {
        let lazily = lazy::<MovableMarkerExplorer>(Class::Multigraph, edges).tally;
        assert!(edges == 1 || lazily.failed() > 0);
        assert_eq!(lazily, stepwise::<MovableMarkerExplorer>(Class::Multigraph, edges));
    }
}
