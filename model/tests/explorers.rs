//! Explorers from outside the crate, judged on every start.

#[path = "../examples/depth_first.rs"]
mod depth_first;
#[path = "../examples/own_marker.rs"]
mod own_marker;

use std::borrow::Cow;

use depth_first::DepthFirst;
use own_marker::Beacon;
use toposlam_model::{
    aid::RefusedAction,
    ambiguity::AmbiguitySearch,
    check::{Shard, SharedPrefixCheck, Tally},
    embedded_graph::Dart,
    enumerate::Class,
    mapping::{
        Algorithm1Run, ExploredMap, Explorer, Flaw, Mapped, MappingError, ObservedWorld, explore,
    },
    marker::{Directional, Marker, MarkerKind, named},
    percept::Door,
};

use crate::checked;

#[test]
fn a_depth_first_explorer_maps_every_start_right() {
    for (edges, starts) in [(1, 2), (2, 10), (3, 74), (4, 706), (5, 8162)] {
        let tally = checked(Class::Multigraph, edges, DepthFirst::default);
        assert_eq!(tally.failure, None);
        assert_eq!((tally.starts, tally.mapped), (starts, starts));
        let algorithm = checked(Class::Multigraph, edges, Algorithm1Run::default);
        assert_eq!(tally.worlds, algorithm.worlds);
        assert!(tally.moves_total >= algorithm.moves_total, "it is wasteful");
        // It runs in steps, so its runs share their beginnings.
        let lazy = SharedPrefixCheck::new(Class::Multigraph, edges, Shard::WHOLE).unwrap();
        let lazily = lazy.run(DepthFirst::default, &());
        assert_eq!(Tally { moves_made: 0, ..lazily.clone() }, tally);
        assert!(edges < 4 || lazily.moves_made < tally.moves_total);
    }
}

/// A map of one edge, and maps that are none.
#[test]
fn a_map_is_made_from_the_far_ends_of_its_darts() {
    let [here, there] = [Some((0, 0)), Some((1, 0))];
    let edge = ExploredMap::from_far_ends(&[vec![there], vec![here]], (1, 0)).unwrap();
    assert_eq!(edge, ExploredMap::from_permutations(&[1, 0], &[0, 1], 0, 1).unwrap());
    let of = |far: &[Vec<Option<(usize, u32)>>], pose| ExploredMap::from_far_ends(far, pose);
    assert_eq!(of(&[vec![there], vec![None]], (0, 0)), Err(Flaw::Unfinished { unexplored: 1 }));
    assert!(matches!(of(&[vec![there], vec![Some((7, 0))]], (0, 0)), Err(Flaw::NoGraph(_))));
    assert!(matches!(of(&[vec![there], vec![here]], (1, 1)), Err(Flaw::NoSuchDart { .. })));
}

/// What is wrong with an explorer.
#[derive(Clone, Copy, Debug)]
enum Broken {
    /// It mirrors its map.
    Mirrored,
    /// It believes it is at the facing dart at the end.
    WrongPose,
    /// It takes the next dart for the facing dart.
    WrongFacing,
    /// It returns the same map for every world.
    OneMap,
    /// It returns darts that do not exist.
    NoDart,
    /// It does not come to an end.
    Endless,
    /// It takes a door that does not exist.
    NoDoor,
    GivesUp,
}

/// It runs straight through: all moves are made when it begins.
#[derive(Clone)]
struct BrokenExplorer(Broken, DepthFirst);

impl Explorer for BrokenExplorer {
    type Aid = MarkerKind;
    type Choice = ();

    fn aid(&self) -> MarkerKind {
        Directional
    }

    fn begin<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        explore(&mut self.1, world)?;
        match self.0 {
            Broken::Endless => loop {
                world.traverse(Door::BACK).map_err(MappingError::World)?;
            },
            Broken::NoDoor => world.traverse(Door(u32::MAX)).map_err(MappingError::World),
            Broken::GivesUp => Err(MappingError::GaveUp("it is dark".to_owned())),
            _ => Ok(()),
        }
    }

    fn explored(&self) -> Result<ExploredMap<'_>, Flaw> {
        let mut map = self.1.explored()?;
        match self.0 {
            Broken::Mirrored => map.graph = Cow::Owned(map.graph.mirror_image()),
            Broken::WrongPose => map.pose = map.facing,
            Broken::WrongFacing => map.facing = map.graph.clockwise(map.facing),
            Broken::OneMap => {
                return ExploredMap::from_permutations(&[1, 0], &[0, 1], 0, 0);
            }
            Broken::NoDart => map.pose = Dart(map.graph.dart_count() as u32),
            Broken::Endless | Broken::NoDoor | Broken::GivesUp => {}
        }
        Ok(map)
    }

    fn move_bound(&self, _: usize, _: usize) -> u64 {
        10_000
    }
}

/// The first flaw of a broken explorer, and the number of edges.
fn first_flaw(broken: Broken) -> (usize, Flaw, Option<u64>) {
    let failed = (1..=5).find_map(|edges| {
        let new = || BrokenExplorer(broken, DepthFirst::default());
        let tally = checked(Class::Multigraph, edges, new);
        assert_eq!(tally.failed() > 0, tally.failure.is_some());
        tally.failure.map(|failed| (edges, failed.flaw, failed.moves))
    });
    failed.expect("the sweep catches it")
}

#[test]
fn the_sweep_catches_broken_explorers() {
    let refused = |refused| Flaw::Error(MappingError::World(refused));
    for (broken, smallest, flaw) in [
        (Broken::Mirrored, 2, Flaw::WrongMap),
        (Broken::OneMap, 1, Flaw::WrongMap),
        (Broken::NoDart, 1, Flaw::NoSuchDart { dart: 2 }),
        (Broken::Endless, 1, refused(RefusedAction::OutOfMoves { bound: 10_000 })),
        (Broken::GivesUp, 1, Flaw::Error(MappingError::GaveUp("it is dark".to_owned()))),
    ] {
        let (edges, found, _) = first_flaw(broken);
        assert_eq!((edges, found), (smallest, flaw), "{broken:?}");
    }
    for broken in [Broken::WrongPose, Broken::WrongFacing] {
        assert!(matches!(first_flaw(broken).1, Flaw::WrongPose { .. }), "{broken:?}");
    }
    let no_door = first_flaw(Broken::NoDoor).1;
    assert!(matches!(no_door, Flaw::Error(MappingError::World(RefusedAction::NoSuchDoor { .. }))));
    assert_eq!(first_flaw(Broken::Endless).2, Some(10_000));
}

/// The search accepts a marker that another crate defines. Receiving the beacon at a neighbouring vertex
/// distinguishes no more worlds: a robot can go and look.
#[test]
fn a_beacon_is_worth_as_much_as_an_undirected_marker() {
    let ambiguous = |marker: &dyn Marker| {
        let findings = AmbiguitySearch::new(Class::Simple, 7, marker).unwrap().run(&()).unwrap();
        findings.sizes.iter().map(|size| size.ambiguous).collect::<Vec<_>>()
    };
    assert_eq!(ambiguous(&Beacon), [0, 0, 0, 0, 0, 6, 4]);
    assert_eq!(ambiguous(&named("undirected").unwrap()), ambiguous(&Beacon));
}
