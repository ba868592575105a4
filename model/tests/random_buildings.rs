//! The moves in random buildings that `worlds/README.md` publishes, of the smaller ones. Each map is judged.

#[path = "../examples/random_buildings/totals.rs"]
mod totals;

use totals::{MORE_HALLWAYS, Totals};

#[test]
fn the_published_moves_in_random_buildings_are_those_of_right_maps() {
    for (junctions, more_hallways, expected) in [
        (25, MORE_HALLWAYS, [300, 821, 1_213, 2_886]),
        (50, MORE_HALLWAYS, [610, 2_170, 3_229, 11_766]),
        (25, 30, [310, 903, 1_376, 3_590]),
        (50, 30, [640, 2_330, 3_767, 16_928]),
    ] {
        let Totals { edges, certificate, folding, algorithm1, .. } =
            Totals::with_size(junctions, more_hallways);
        let found = [edges as u64, certificate as u64, folding, algorithm1];
        assert_eq!(found, expected, "{junctions} junctions");
    }
}
