//! The moves in random buildings that `worlds/README.md` publishes, of the smaller ones. Each map is judged.

#[path = "../examples/random_buildings/buildings.rs"]
mod buildings;
#[path = "../examples/random_buildings/sensed.rs"]
mod sensed;
#[path = "../examples/random_buildings/together.rs"]
mod together;
#[path = "../examples/random_buildings/totals.rs"]
mod totals;

use toposlam_model::mapping::MappingAlgorithm;

use buildings::{MORE_HALLWAYS, buildings, moves};
use sensed::{LengthError, Lengths, Senses, measured_buildings, moves_with};
use together::moves_together;
use totals::Totals;

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

/// The moves with aids that move that `docs/aids.md` publishes, of the smaller ones.
#[test]
fn the_published_moves_with_other_aids_are_those_of_right_maps() {
    for (aid, expected) in [
        ("movable", [3_392, 12_689]),
        ("movable-4-distinct", [2_045, 6_928]),
        ("movable-directional", [3_438, 12_761]),
        ("movable+directional", [1_137, 2_865]),
        ("string-1", [1_233, 3_249]),
        ("string", [706, 1_708]),
        ("team-2", [2_125, 8_830]),
        ("team-3-round", [1_019, 4_057]),
    ] {
        let algorithm = MappingAlgorithm::all().find(|known| known.aid().name() == aid).unwrap();
        let total = |junctions| -> u64 {
            buildings(junctions, MORE_HALLWAYS).iter().map(|graph| moves(algorithm, graph).0).sum()
        };
        assert_eq!([25, 50].map(total), expected, "{aid}");
    }
}

/// The moves of two robots that go together and have no radio, of the smaller buildings.
#[test]
fn the_published_moves_of_two_robots_without_radio_are_those_with_a_marker_and_of_the_second_robot()
{
    for (aid, expected) in [("movable", [3_788, 13_584]), ("movable-directional", [3_834, 13_656])]
    {
        let algorithm = MappingAlgorithm::all().find(|known| known.aid().name() == aid).unwrap();
        let total = |junctions| -> u64 {
            let buildings = buildings(junctions, MORE_HALLWAYS);
            buildings.iter().map(|graph| moves_together(algorithm, graph)).sum()
        };
        assert_eq!([25, 50].map(total), expected, "{aid}");
    }
}

/// The moves with lengths and a compass that `docs/aids.md` publishes, of the smaller buildings.
#[test]
fn the_published_moves_with_senses_are_those_of_right_maps() {
    use LengthError::{EachHallway, EachTime};
    use Lengths::{OfGrid, OfHallways};
    for (of, lengths, compass, expected) in [
        (OfHallways, Some(EachTime(0)), false, [896, 2_402]),
        (OfHallways, Some(EachTime(100)), false, [971, 2_560]),
        (OfHallways, Some(EachHallway(100)), false, [959, 2_544]),
        (OfHallways, Some(EachTime(100)), true, [896, 2_318]),
        (OfGrid, Some(EachTime(0)), false, [952, 2_504]),
        (OfGrid, None, true, [898, 2_345]),
        (OfGrid, None, false, [1_213, 3_229]),
    ] {
        let senses = Senses { lengths, compass };
        let total = |junctions| -> u64 {
            let buildings = measured_buildings(junctions, MORE_HALLWAYS, of);
            buildings.iter().map(|building| moves_with(senses, building)).sum()
        };
        assert_eq!([25, 50].map(total), expected, "{of:?} {senses:?}");
    }
}
