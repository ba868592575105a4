//! Visits that scans or images do not decide: what fits, and that nobody is accused on a guess.

use toposlam_logs::{messages, recorder::Recorder};
use toposlam_model::{
    aid::AidKind,
    driving::scene::{JunctionView, Place as SeenPlace, Scene},
    embedded_graph::EmbeddedGraph,
    format::named_world::NamedWorld,
    mapping::MappingAlgorithm,
    marker::{Directional, NoMarker},
    proof::Claim,
    trace::anywhere,
};
use toposlam_vision::visits::{
    VisitPercept,
    network_fit::{NetworkFault, NetworkFit},
};

use super::{log_check::Question, recovery::head_of, *};
use crate::{
    DrivenVisits, PossibleVisits, UndecidedCause, Unproved, VisitFit, VisitedJunction,
    known_world::KnownWorld,
};

/// A visit: what the scans cannot exclude, and whether the robot left the way that it came.
type Seen<'s> = (&'s [Option<(u32, u32)>], bool);

/// No junction: the robot turned back in the corridor.
const TURNED_BACK: Seen = (&[None], true);

/// The events of visits, and their junctions.
fn events_of(visits: &[Seen]) -> (Vec<CheckedKind>, Vec<VisitedJunction>) {
    let mut kinds = Vec::new();
    let mut junctions = Vec::new();
    for &(seen, goes_back) in visits {
        if (seen, goes_back) == TURNED_BACK {
            kinds.push(CheckedKind::TurnedBack);
            continue;
        }
        let percept = |&(degree, door): &(u32, u32)| VisitPercept { degree, door: Some(door) };
        junctions.push(VisitedJunction {
            event: kinds.len(),
            centre: [0.0; 2],
            clearance: 1.0,
            extent: 1.0,
            doors: Vec::new(),
            alternatives: seen.iter().map(|one| one.as_ref().map(percept)).collect(),
            goes_back,
            exit: None,
        });
        match *seen {
            [Some((degree, door))] => {
                kinds.extend([bare_arrival(degree, Sighting::Nothing), bare_door(door)]);
            }
            _ => kinds.push(CheckedKind::Undecided(UndecidedCause::UnseenArm)),
        }
    }
    (kinds, junctions)
}

/// The judgement of visits, in a world without a marker, from any of its darts, or in any world.
fn judged_visits(visits: &[Seen], world: Option<&EmbeddedGraph>) -> Judgement {
    with_driven(visits, None, world)
}

/// The same where so much of the visits was driven.
fn with_driven(
    visits: &[Seen],
    driven: Option<&[Seen]>,
    world: Option<&EmbeddedGraph>,
) -> Judgement {
    let (kinds, junctions) = events_of(visits);
    // Each event is a nanosecond after the one before it.
    let timed = |kinds| {
        let mut events = bare_events(kinds);
        (0..).zip(&mut events.events).for_each(|(time, event)| event.source.time = time);
        events
    };
    let driven = driven.map(|visits| {
        let (kinds, junctions) = events_of(visits);
        DrivenVisits { events: timed(kinds).events, junctions }
    });
    let events = timed(kinds);
    let states = |graph: &EmbeddedGraph| anywhere(graph, &AidKind::from(NoMarker));
    let world = world.map(|graph| KnownWorld { graph: graph.clone(), states: states(graph) });
    let config = ConformConfig { world, aid: NoMarker.into(), ..by_anyone() };
    let possible = PossibleVisits::judge(&events, &junctions, driven.as_ref(), &config, &());
    judged(&events, &config).with_possible(possible)
}

fn verdict(judgement: &Judgement) -> (ConformVerdict, VisitFit, &[usize]) {
    let possible = judgement.possible.as_ref().unwrap();
    assert_eq!(judgement.divergence, None);
    (judgement.verdict(), possible.fit, &possible.decided_by_world)
}

/// A tail that ends at a fork, whose other two doors are joined by a hallway through a junction with two doors.
fn ring() -> EmbeddedGraph {
    let lists = [
        ("end", vec!["a"]),
        ("a", vec!["end", "b", "c"]),
        ("b", vec!["a", "c"]),
        ("c", vec!["b", "a"]),
    ];
    EmbeddedGraph::from_neighbour_lists(&lists).unwrap()
}

#[test]
fn a_known_world_decides_visits_that_scans_leave_open() {
    let end: Seen = (&[Some((1, 0))], true);
    let open: Seen = (&[Some((3, 1)), Some((4, 1)), None], false);
    let corner: Seen = (&[Some((2, 1))], false);
    let found = judged_visits(&[end, open, corner, corner], Some(&ring()));
    assert_eq!(verdict(&found), (ConformVerdict::Conforms, VisitFit::Fits, &[1][..]));
    // With half of the visits open a fit says too little.
    let found = judged_visits(&[end, open, open, corner], Some(&ring()));
    assert_eq!(verdict(&found).0, ConformVerdict::NotKnown);
    assert_eq!(verdict(&found).1, VisitFit::Fits);
}

#[test]
fn what_scans_show_accuses_nobody() {
    let end: Seen = (&[Some((1, 0))], true);
    let crossing: Seen = (&[Some((4, 1))], false);
    let found = judged_visits(&[end, crossing], Some(&ring()));
    assert_eq!(verdict(&found), (ConformVerdict::NotKnown, VisitFit::Contradiction, &[][..]));
    assert_eq!(found.contradiction.unwrap().0.event, 2);
    // A choice of what is open can contradict the world, too.
    let open: Seen = (&[Some((4, 1)), Some((5, 1))], false);
    let found = judged_visits(&[end, open], Some(&ring()));
    assert_eq!(verdict(&found).1, VisitFit::Contradiction);
}

#[test]
fn what_a_robot_drove_may_not_fit_a_known_world_either() {
    let end: Seen = (&[Some((1, 0))], true);
    let crossing: Seen = (&[Some((4, 1))], false);
    let (open, anything): (Seen, Seen) = ((&[Some((3, 1)), Some((4, 1))], false), (&[], false));
    let ring = ring();
    let contradiction = |driven: &[Seen]| {
        let found = with_driven(&[end, crossing], Some(driven), Some(&ring));
        assert_eq!(verdict(&found).0, ConformVerdict::NotKnown);
        let (divergence, why) = found.contradiction.unwrap();
        (divergence.event, divergence.cause.name(), why)
    };
    assert_eq!(contradiction(&[end, crossing]), (2, "driven", Unproved::Poses));
    assert_eq!(contradiction(&[anything, crossing]), (1, "driven", Unproved::Poses));
    for driven in [[end, open], [end, anything], [anything, open]] {
        assert_eq!(contradiction(&driven), (2, "percept", Unproved::Scans), "{driven:?}");
    }
    // It matters only if the visits themselves fit no choice, and if the building is a network of corridors.
    let found = with_driven(&[end, open], Some(&[end, crossing]), Some(&ring));
    assert!(found.contradiction.is_none());
    let found = with_driven(&[end, crossing], Some(&[end, crossing]), Some(&ring));
    let network = NetworkFit { fault: Some(NetworkFault::Wide), ..NetworkFit::default() };
    let possible = found.possible.clone().unwrap().in_building(network);
    assert_eq!(possible.refuted, None);
}

#[test]
fn an_algorithm_takes_one_of_the_doors_of_an_open_visit() {
    let ring = ring();
    let states = anywhere(&ring, &AidKind::from(Directional));
    let config = |world: Option<KnownWorld>| ConformConfig {
        world,
        driver: RunDriver::from(MappingAlgorithm::Folding),
        ..by_anyone()
    };
    let fit = |doors: &[u32], config: &ConformConfig| {
        // A dead end has no door 5.
        let seen: Vec<_> =
            doors.iter().map(|&door| Some((3, door))).chain([Some((1, 5))]).collect();
        let (kinds, junctions) = events_of(&[(&seen, false)]);
        PossibleVisits::judge(&bare_events(kinds), &junctions, None, config, &()).algorithm
    };
    for world in [None, Some(KnownWorld { graph: ring.clone(), states })] {
        let config = config(world);
        let mut fits = [0, 1, 2].map(|door| fit(&[door], &config).unwrap());
        fits.sort_by_key(|&fit| fit != VisitFit::Fits);
        // It has one run.
        assert_eq!(fits, [VisitFit::Fits, VisitFit::Contradiction, VisitFit::Contradiction]);
        let all = |config: &ConformConfig| fit(&[0, 1, 2], config);
        assert_eq!(all(&config), Some(VisitFit::Fits));
        assert_eq!(all(&ConformConfig { driver: RunDriver::Anyone, ..config }), None);
    }
}

#[test]
fn a_divergence_of_a_robot_that_got_lost_leaves_the_verdict_open() {
    let fork = || bare_arrival(3, Sighting::Nothing);
    let events = bare_events([fork(), bare_door(5)]);
    let config = ConformConfig { aid: NoMarker.into(), ..by_anyone() };
    let found = judged(&events, &config);
    assert_eq!(found.verdict(), ConformVerdict::Diverged);
    let open = found.accusing_nobody(Unproved::Lost);
    assert_eq!((open.verdict(), open.divergence), (ConformVerdict::NotKnown, None));
}

#[test]
fn a_way_on_which_the_scanner_did_not_look_leaves_everything_open() {
    let (end, fork): (Seen, Seen) = ((&[Some((1, 0))], true), (&[Some((3, 1))], false));
    let mut found = judged_visits(&[end, fork], Some(&ring()));
    assert_eq!(verdict(&found).1, VisitFit::Fits);
    let mut events = found.events.clone();
    let kind = CheckedKind::Undecided(UndecidedCause::UnseenWay);
    events.events.push(CheckedEvent { kind, ..events.events[0].clone() });
    events.events.rotate_right(1);
    let config = ConformConfig { aid: NoMarker.into(), ..by_anyone() };
    let possible = PossibleVisits::judge(&events, &[], None, &config, &());
    assert_eq!((possible.fit, possible.certain), (VisitFit::UnseenWay, 0));
    found = judged(&events, &config).with_possible(possible);
    assert_eq!(verdict(&found).0, ConformVerdict::NotKnown);
}

#[test]
fn a_log_of_which_no_visit_is_decided_is_not_known_to_conform() {
    let open: Seen = (&[Some((3, 1)), None], false);
    let found = judged_visits(&[open, open], Some(&ring()));
    assert_eq!(verdict(&found), (ConformVerdict::NotKnown, VisitFit::Fits, &[][..]));
    assert_eq!((found.unrecognised, found.candidates()), (Some(0), 8));
}

#[test]
fn visits_that_fit_decide_nothing_if_the_search_for_a_world_ends_early() {
    let fork: Seen = (&[Some((3, 1))], false);
    let (kinds, junctions) = events_of(&[fork, (&[Some((3, 0))], true), fork]);
    let events = bare_events(kinds);
    let verdict = |max_edges| {
        let search = WorldSearch { max_edges, ..by_anyone().search };
        let config = ConformConfig { search, aid: NoMarker.into(), ..by_anyone() };
        let possible = PossibleVisits::judge(&events, &junctions, None, &config, &());
        assert_eq!(possible.fit, VisitFit::Fits);
        judged(&events, &config).with_possible(possible).verdict()
    };
    assert_eq!(verdict(None), ConformVerdict::Conforms);
    assert_eq!(verdict(Some(1)), ConformVerdict::NotKnown);
}

#[test]
fn visits_conform_if_a_choice_fits_that_the_driver_takes_and_most_of_them_are_certain() {
    let (end, fork): (Seen, Seen) = ((&[Some((1, 0))], true), (&[Some((3, 1))], false));
    let open: Seen = (&[Some((3, 1)), Some((4, 1)), None], false);
    let judged = |visits: &[Seen], driver: RunDriver| {
        let (kinds, junctions) = events_of(visits);
        let states = anywhere(&ring(), &AidKind::from(NoMarker));
        let world = Some(KnownWorld { graph: ring(), states });
        let config = ConformConfig { world, aid: NoMarker.into(), ..driven(by_anyone(), driver) };
        PossibleVisits::judge(&bare_events(kinds), &junctions, None, &config, &())
    };
    let certain = judged(&[end, fork], RunDriver::Anyone);
    assert!(certain.conform() && certain.is_certain_enough());
    // Two of three are enough, one of two is not.
    assert!(judged(&[end, fork, open], RunDriver::Anyone).conform());
    assert!(!judged(&[end, open], RunDriver::Anyone).conform());
    assert!(!PossibleVisits::default().is_certain_enough());
    let mut misfit = certain.clone();
    misfit.fit = VisitFit::Contradiction;
    assert!(!misfit.conform() && !certain.without_odometry(true).conform());
    let mut by_algorithm = judged(&[end, fork], RunDriver::from(MappingAlgorithm::Folding));
    for (fit, conforms) in
        [(None, false), (Some(VisitFit::NotKnown), false), (Some(VisitFit::Fits), true)]
    {
        by_algorithm.algorithm = fit;
        assert_eq!(by_algorithm.conform(), conforms, "{fit:?}");
    }
    // Without a marker none is seen.
    let sets = judged(&[open], RunDriver::Anyone).sets;
    assert_eq!(sets[0].alternatives().len(), 3);
}

/// The candidates of recorded events are the poses that fit them, and those of visits the states that fit their sets.
#[test]
fn a_junction_that_is_not_recognised_leaves_the_candidates_before_it() {
    let unclear = CheckedKind::Undecided(UndecidedCause::Unclear);
    let events = bare_events([bare_arrival(3, Sighting::Nothing), bare_door(1), unclear]);
    let ring = ring();
    let states = anywhere(&ring, &AidKind::from(NoMarker));
    let world = Some(KnownWorld { graph: ring, states });
    let found = judged(&events, &ConformConfig { world, aid: NoMarker.into(), ..by_anyone() });
    // By any of its three doors.
    assert_eq!((found.unrecognised, found.candidates()), (Some(2), 3));
}

#[test]
fn without_a_world_a_marker_and_turning_back_any_visits_would_fit() {
    let fork: Seen = (&[Some((3, 1))], false);
    let back: Seen = (&[Some((3, 0))], true);
    let found = judged_visits(&[fork, fork], None);
    assert_eq!(verdict(&found), (ConformVerdict::NotKnown, VisitFit::Anything, &[][..]));
    let found = judged_visits(&[fork, back, fork], None);
    assert_eq!(verdict(&found), (ConformVerdict::Conforms, VisitFit::Fits, &[][..]));
    // It comes back to another number of doors.
    let other: Seen = (&[Some((4, 1))], false);
    let found = judged_visits(&[fork, back, other], None);
    assert_eq!(verdict(&found).1, VisitFit::Contradiction);
    // It turns back in the corridor, and sees the same junction again, or another one.
    let found = judged_visits(&[fork, TURNED_BACK, fork], None);
    assert_eq!(found.possible.as_ref().unwrap().fit, VisitFit::Fits);
    let found = judged_visits(&[fork, TURNED_BACK, other], None);
    assert_eq!(verdict(&found).0, ConformVerdict::NotKnown);
    assert_eq!(verdict(&found).1, VisitFit::Contradiction);
    // Nothing is known of a visit: it may have been any junction, or none.
    let anything: Seen = (&[], false);
    let found = judged_visits(&[fork, back, fork, anything], None);
    assert_eq!(verdict(&found), (ConformVerdict::Conforms, VisitFit::Fits, &[][..]));
}

#[test]
fn visits_without_odometry_or_in_a_building_that_is_no_network_of_corridors_decide_nothing() {
    let (end, fork): (Seen, Seen) = ((&[Some((1, 0))], true), (&[Some((3, 1))], false));
    for world in [Some(ring()), None] {
        let found = judged_visits(&[end, fork], world.as_ref());
        assert_eq!(found.verdict(), ConformVerdict::Conforms);
        assert_eq!(found.smallest.is_some(), world.is_none());
        for fault in [NetworkFault::Wide, NetworkFault::ManyDoors] {
            let network = NetworkFit { fault: Some(fault), ..NetworkFit::default() };
            let possible = found.possible.clone().unwrap().in_building(network);
            let open = found.clone().with_possible(possible);
            assert_eq!((open.verdict(), open.smallest), (ConformVerdict::NotKnown, None));
        }
        let possible = found.possible.clone().unwrap().without_odometry(true);
        let open = found.with_possible(possible);
        assert_eq!((open.verdict(), open.smallest), (ConformVerdict::NotKnown, None));
    }
}

/// Records a run, and doubts what is seen near a point. After so many arrivals odometry is turned.
struct Doubtful<O> {
    log: O,
    near: Option<[f64; 2]>,
    turned_after: Option<usize>,
    /// Where the robot was at each arrival.
    arrivals: Vec<[f64; 2]>,
    at: [f64; 2],
}

impl<O: RunObserver> RunObserver for Doubtful<O> {
    fn event(&mut self, event: &Event) {
        let mut event = event.clone();
        let is_turned = self.turned_after.is_some_and(|arrivals| self.arrivals.len() > arrivals);
        match &mut event.kind {
            EventKind::Frame(Frame { scene: Some(Scene { place, .. }), odometry, .. }) => {
                self.at = odometry.position;
                let is_near = |near: [f64; 2]| {
                    let near = Odometry { position: near, ..Odometry::default() };
                    near.distance(odometry) < 1.5
                };
                if let SeenPlace::Junction(JunctionView { confidence, .. }) = place
                    && self.near.is_some_and(is_near)
                {
                    *confidence = 0.5;
                }
                if is_turned {
                    odometry.heading = odometry.whither(0.7);
                }
            }
            EventKind::Odometry(odometry) if is_turned => odometry.heading = odometry.whither(0.7),
            EventKind::Arrival(_) => self.arrivals.push(self.at),
            _ => {}
        }
        self.log.event(&event);
    }
}

/// The log of a run of the folding explorer in shape 8, and its head. The scenes near one of its visits are in doubt, and
/// after another one odometry is turned.
fn doubtful_log(visit: usize, turned_after: Option<usize>) -> (Vec<u8>, messages::Run) {
    let (plan, facing) = place_in("shape-8");
    let settings = RunSettings::new(MappingAlgorithm::Folding, DARTS);
    let head = head_of(&settings);
    let record = |near| {
        let mut bytes = Vec::new();
        let robot = SimulationConfig::at_start(plan.clone(), facing, 1);
        let robot = SimulationConfig { keeps_track: true, ..robot }.by_scene();
        let arrivals = {
            let log = Recorder::new(&mut bytes, &head, None).unwrap();
            let mut observer =
                Doubtful { log, near, turned_after, arrivals: Vec::new(), at: [0.0; 2] };
            run(&plan, facing, robot, RobotSensor::Scenes, &mut observer, &settings);
            observer.log.finish().unwrap();
            observer.arrivals
        };
        (bytes, arrivals)
    };
    let arrivals = record(None).1;
    (record(Some(arrivals[visit])).0, head)
}

#[test]
fn scenes_that_do_not_decide_a_visit_are_judged_as_sets() {
    let world_of = |name| {
        let (plan, facing) = place_in(name);
        NamedWorld::numbered(name, "", plan.graph().clone(), Some(facing))
    };
    let (own, other) = (world_of("shape-8"), world_of("shape-6"));
    for visit in 1..8 {
        let (log, head) = doubtful_log(visit, None);
        let judged = |world, doors| {
            let scenes = Question::new(&log, Evidence::Scenes);
            let checked =
                Question { head: head.clone(), world, doors, ..scenes }.checked().unwrap();
            let possible = checked.judgement.possible.as_ref();
            let proofs = checked.proofs().unwrap();
            let is_fit =
                proofs.iter().all(|proof| matches!(proof.claims[..], [Claim::Fits { .. }]));
            let fits = possible.is_some_and(|sets| sets.fit == VisitFit::Fits);
            assert_eq!(is_fit, fits, "{visit}");
            (checked.judgement.verdict(), possible.map(|sets| (sets.fit, sets.algorithm)))
        };
        let fits = VisitFit::Fits;
        for world in [Some(&own), None] {
            let by_anyone = judged(world, DoorChooser::Anyone);
            assert_eq!(by_anyone, (ConformVerdict::Conforms, Some((fits, None))), "{visit}");
        }
        // The map that the log records is compared with that of certain percepts alone.
        let by_algorithm = judged(Some(&own), DoorChooser::Algorithm(None));
        let not_known = (ConformVerdict::NotKnown, Some((fits, Some(fits))));
        assert_eq!(by_algorithm, not_known, "{visit}");
        let elsewhere = judged(Some(&other), DoorChooser::Anyone);
        assert_ne!(elsewhere.0, ConformVerdict::Conforms, "{visit}");
    }
}

/// Its scenes show that it left beside a door, but the door that it took before may have been another one.
#[test]
fn scenes_of_a_robot_that_strayed_are_not_judged_as_sets() {
    let (log, _) = doubtful_log(3, Some(6));
    let doors = DoorChooser::Anyone;
    let checked = Question { doors, ..Question::new(&log, Evidence::Scenes) }.checked().unwrap();
    let strayed = |event: &CheckedEvent| matches!(event.kind, CheckedKind::LeftBetweenDoors { .. });
    assert!(checked.extracted.events.events.iter().any(strayed));
    let judgement = checked.judgement;
    assert_eq!((judgement.verdict(), judgement.possible), (ConformVerdict::NotKnown, None));
}
