//! The check without repetition against the check of one start after the other.

use std::{
    borrow::Cow,
    collections::BTreeMap,
    sync::{
        Mutex,
        atomic::{AtomicUsize, Ordering},
    },
};

use toposlam_model::{
    aid::markers::MOVABLE,
    check::{EnumeratedStart, FinishedUnits, PartTally, Shard, SharedPrefixCheck, Tally},
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Class, Watch},
    mapping::{
        Algorithm1Run, ExploredMap, Explorer, Flaw, FoldingRun, InvalidStep, Mapped,
        MappingAlgorithm, MappingError, MovableMarkerRun, ObservedWorld,
    },
    marker::{DirectedEdge, Directional, Marker, MarkerKind, TwoIdentical},
    percept::{Door, Sighting},
};

use crate::checked;

fn lazy<E: Explorer + Default>(class: Class, edges: usize) -> Tally {
    SharedPrefixCheck::new(class, edges, Shard::WHOLE).unwrap().run(E::default, &())
}

/// All counts but the moves that were made.
fn counts(tally: Tally) -> Tally {
    Tally { moves_made: 0, ..tally }
}

#[test]
fn the_tree_has_a_leaf_for_each_start() {
    let leaves = |edges| lazy::<Algorithm1Run>(Class::Multigraph, edges).starts;
    assert_eq!([1, 2, 3, 4, 5, 6].map(leaves), [2, 10, 74, 706, 8162, 110_410]);
    // Without sharing, each start costs all its moves. How many are shared is pinned.
    let tally = lazy::<Algorithm1Run>(Class::Multigraph, 7);
    assert_eq!(tally.starts, 1_708_394);
    assert_eq!((tally.moves_total, tally.moves_made), (25_375_585, 13_166_198));
}

fn compare<E: Explorer + Default>(class: Class, edges: usize) -> Tally {
    let lazily = counts(lazy::<E>(class, edges));
    assert_eq!(lazily, checked(class, edges, E::default), "{class} {edges}");
    lazily
}

#[test]
fn both_checks_have_the_same_result() {
    for class in Class::ALL {
        for edges in 1..=8 {
            if class.is_simple() || edges <= 6 {
                compare::<Algorithm1Run>(class, edges);
            }
            if class.is_simple() || edges <= 5 {
                compare::<FoldingRun>(class, edges);
                // One movable marker does not suffice in multigraphs, and both checks find the same failures.
                let failed = compare::<MovableMarkerRun>(class, edges).failed();
                assert!(edges == 1 || (failed > 0) != class.is_simple(), "{class} {edges}");
            }
        }
    }
}

/// Walks through the door with a number at each vertex, a few times, and then returns a fixed map or fails.
#[derive(Clone)]
struct Walker<M> {
    marker: M,
    moves: u32,
    most: u32,
    map: EmbeddedGraph,
}

impl<M: Marker + Clone> Explorer for Walker<M> {
    type Aid = M;
    type Choice = ();

    fn aid(&self) -> M {
        self.marker.clone()
    }

    fn begin<W: ObservedWorld>(&mut self, _: &mut W) -> Mapped<W> {
        self.moves = 0;
        Ok(())
    }

    fn choose(&mut self) -> Result<Option<()>, InvalidStep> {
        Ok((self.moves < self.most).then_some(()))
    }

    fn step<W: ObservedWorld>(&mut self, (): (), world: &mut W) -> Mapped<W> {
        let percept = world.percept().map_err(MappingError::World)?;
        // The sighting decides, too.
        let marked = percept.sighting != Sighting::Nothing;
        let door = Door((1 + u32::from(marked)) % percept.degree);
        world.traverse(door).map_err(MappingError::World)?;
        self.moves += 1;
        if percept.degree == 5 {
            return Err(MappingError::GaveUp("five doors".to_owned()));
        }
        Ok(())
    }

    fn explored(&self) -> Result<ExploredMap<'_>, Flaw> {
        Ok(ExploredMap { graph: Cow::Borrowed(&self.map), facing: Dart(0), pose: Dart(0) })
    }
}

/// An explorer that returns its map too early: the end of its run stands for several starts, and all are
/// counted and judged. It is right in one of them if it guesses.
fn compare_walkers<M: Marker + Clone>(marker: &M) {
    for (class, edges) in Class::ALL.into_iter().flat_map(|class| (1..=4).map(move |m| (class, m)))
    {
        for most in 0..=8 {
            let (marker, map) = (marker.clone(), EmbeddedGraph::chain(edges));
            let walker = Walker { marker, moves: 0, most, map };
            let new = || walker.clone();
            let lazily = SharedPrefixCheck::new(class, edges, Shard::WHOLE).unwrap().run(new, &());
            let lazily = counts(lazily);
            assert_eq!(lazily, checked(class, edges, new), "{class} {edges} {most}");
            // At most the one start that it guesses.
            assert!(lazily.mapped <= 1 && lazily.starts > 0);
        }
    }
}

fn still(map: EmbeddedGraph) -> Walker<MarkerKind> {
    Walker { marker: Directional, moves: 0, most: 0, map }
}

#[test]
fn an_end_at_which_not_everything_is_revealed_stands_for_all_starts_that_agree() {
    compare_walkers(&Directional);
    // What these markers add depends on the edge of the facing dart, so the world is decided at once.
    compare_walkers(&DirectedEdge);
    compare_walkers(&TwoIdentical);
    let check = SharedPrefixCheck::new(Class::Multigraph, 4, Shard::WHOLE).unwrap();
    let at_once = check.run(|| still(EmbeddedGraph::chain(4)), &());
    assert_eq!((at_once.starts, at_once.mapped, at_once.moves_made), (706, 1, 0));
    assert_eq!(at_once.below_certificate, 1);
}

fn shard(text: &str) -> SharedPrefixCheck {
    SharedPrefixCheck::new(Class::Multigraph, 5, text.parse().unwrap()).unwrap()
}

#[test]
fn the_shards_are_the_whole() {
    let whole = shard("1/1").run(Algorithm1Run::default, &());
    let mut sum = Tally::default();
    for part in ["1/3", "2/3", "3/3"] {
        let found = shard(part).run(Algorithm1Run::default, &());
        assert!(found.starts < 5000 && found.worlds < 500, "{found:?}");
        sum.merge(found);
    }
    let counts = |tally: &Tally| Tally { worst: None, ..tally.clone() };
    assert_eq!((counts(&sum), sum.moves_max()), (counts(&whole), 36));
    assert_eq!((sum.starts, sum.worlds, sum.mapped), (8162, 870, 8162));
    assert_eq!((sum.moves_total, sum.certificate_total), (68_652, 55_411));
}

/// Stops after some units, and remembers them.
#[derive(Default)]
struct SomeUnits {
    known: BTreeMap<usize, PartTally>,
    new: Mutex<BTreeMap<usize, PartTally>>,
    left: AtomicUsize,
}

impl FinishedUnits for SomeUnits {
    fn finished(&self, unit: usize) -> Option<PartTally> {
        self.known.get(&unit).cloned()
    }

    fn finish(&self, unit: usize, tally: &PartTally) {
        self.new.lock().unwrap().insert(unit, tally.clone());
        self.left.fetch_sub(1, Ordering::Relaxed);
    }
}

impl Watch for SomeUnits {
    fn stop(&self) -> bool {
        self.left.load(Ordering::Relaxed) == 0
    }
}

/// As processes on several machines do them: in any order, and each with pieces of its own.
#[test]
fn the_pieces_in_any_order_are_the_whole() {
    let cases = [
        (MappingAlgorithm::Algorithm1, Class::Multigraph, 5),
        (MappingAlgorithm::Folding, Class::Planar, 6),
        (MappingAlgorithm::MovableMarkers(MOVABLE), Class::Corridor, 7),
    ];
    for (algorithm, class, edges) in cases {
        let sweep = SharedPrefixCheck::new(class, edges, Shard::WHOLE).unwrap();
        let machines = [(); 3].map(|()| algorithm.pieces(&sweep, &()));
        let mut counts = [(); 3].map(|()| PartTally::default());
        let count = machines[0].count();
        assert!(count > machines[0].unit_count() && machines[0].unit_count() > 3);
        for piece in (0..count).rev() {
            let machine = piece * piece % 3;
            counts[machine].merge(algorithm.check_piece(&machines[machine], piece, &()));
        }
        let [mut all, one, other] = counts;
        all.merge(one);
        all.merge(other);
        let whole = algorithm.lazy_sweep(&sweep, &(), &());
        assert_eq!(algorithm.finished_pieces(all), whole, "{class}");
    }
}

#[test]
fn a_check_that_was_stopped_goes_on_and_has_the_same_result() {
    let sweep = shard("1/1");
    let whole = sweep.run(FoldingRun::default, &());
    let mut known = BTreeMap::new();
    let mut rounds = 0;
    loop {
        let some = SomeUnits { known: known.clone(), left: 200.into(), ..SomeUnits::default() };
        let found = sweep.resume(FoldingRun::default, &some, &some);
        let new = some.new.into_inner().unwrap();
        assert!(new.keys().all(|unit| !known.contains_key(unit)));
        known.extend(new);
        rounds += 1;
        if !found.interrupted {
            assert_eq!(found, whole);
            break;
        }
        assert!(rounds < 100);
    }
    assert!(rounds > 1);
    assert_eq!(known.len(), MappingAlgorithm::Folding.pieces(&sweep, &()).unit_count());
}

/// Stops when it has been asked this number of times.
struct QuestionLimit(AtomicUsize);

impl Watch for QuestionLimit {
    fn stop(&self) -> bool {
        let left = self.0.load(Ordering::Relaxed);
        self.0.store(left.saturating_sub(1), Ordering::Relaxed);
        left == 0
    }
}

/// Such a run ends in the same way in all 12 billion starts, and each of them is judged.
#[test]
fn a_check_of_an_explorer_that_does_not_move_can_be_stopped() {
    let sweep = SharedPrefixCheck::new(Class::Multigraph, 10, Shard::WHOLE).unwrap();
    let new = || still(EmbeddedGraph::chain(1));
    let found = sweep.run(new, &QuestionLimit(1000.into()));
    assert!(found.interrupted);
    assert!((1..=2000).contains(&found.starts));
    assert_eq!(found.failed(), found.starts);
}

/// All probes together, each branch once, are the whole tree.
#[test]
fn all_probes_together_are_the_whole_tree() {
    let sweep = SharedPrefixCheck::new(Class::Multigraph, 4, Shard::WHOLE).unwrap();
    let algorithm = MappingAlgorithm::Algorithm1;
    // The degree of the start vertex is drawn: 1 to 8.
    let mut found = (0, 0);
    for number in 0..8 {
        let probe = algorithm.probe(&sweep, vec![number], &());
        assert!((probe.weight - 8.0).abs() < 1e-9);
        found.0 += probe.tally.starts;
        found.1 += probe.tally.moves_total;
    }
    assert_eq!(found, (706, 4182));
    let drawn = algorithm.probe(&sweep, vec![3, 1, 4, 1, 5], &());
    assert_eq!(drawn.tally.starts, 1);
}

#[test]
fn a_start_is_restored_from_its_place_in_the_enumeration() {
    let graph = EmbeddedGraph::chain(3);
    // From the other end the chain is the same start.
    let places: Vec<_> = graph.darts().map(|facing| EnumeratedStart::new(&graph, facing)).collect();
    let mut distinct = places.clone();
    distinct.sort();
    distinct.dedup();
    assert_eq!(distinct.len(), 3);
    for place in &places {
        let (restored, facing) = place.start().unwrap();
        assert_eq!(EnumeratedStart::new(&restored, facing), *place);
        assert_eq!(restored.edge_count(), 3);
    }
    for wrong in [
        r#"{"code":[],"facing":0}"#,
        r#"{"code":[4294967294],"facing":0}"#,
        r#"{"code":[4294967294,7],"facing":0}"#,
        r#"{"code":[4294967294,4294967294],"facing":2}"#,
        r#"{"code":[4294967293,4294967294],"facing":0}"#,
        r#"{"code":[0,0],"facing":0}"#,
    ] {
        let place: EnumeratedStart = serde_json::from_str(wrong).unwrap();
        assert_eq!(place.start(), None, "{wrong}");
    }
}
