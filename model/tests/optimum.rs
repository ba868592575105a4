//! The least mean number of moves of any explorer on small starts: `examples/optimum.rs`.

#[path = "../examples/optimum.rs"]
mod search;

use search::OptimumSearch;
use toposlam_model::enumerate::Class;

/// The totals by another program: 3.811, 7.074 and 8.751 moves in the mean.
#[test]
fn no_explorer_has_a_smaller_mean_than_these() {
    for (class, edges, starts, total) in [
        (Class::Multigraph, 2, 10, 23),
        (Class::Multigraph, 3, 74, 282),
        (Class::Simple, 5, 108, 764),
        (Class::Corridor, 6, 309, 2704),
    ] {
        let mut search = OptimumSearch::new(class, edges).unwrap();
        assert_eq!(search.start_count(), starts, "{class} {edges}");
        assert_eq!(search.least_total().unwrap(), total, "{class} {edges}");
    }
}
