//! What a check takes from the log, from its topic map, and from what is asked.

use std::{
    collections::BTreeSet,
    f64::consts::{FRAC_PI_2, PI},
    sync::atomic::{AtomicU64, Ordering},
};

use toposlam_logs::{
    messages::{self, Stamp},
    reader,
    recorder::{ODOM, SCAN},
    standard::{Header, LaserScanMessage, OdometryMessage, PoseMessage, PoseStamped, Twist},
    topic_map::{Role, TopicMap},
    writer::LogWriter,
};
use toposlam_model::{
    aid::{AidKind, Places, State, markers::MOVABLE},
    driving::pose::Pose,
    embedded_graph::EmbeddedGraph,
    enumerate::Watch,
    format::named_world::NamedWorld,
    marker::{MarkerKind, NoMarker, Undirected},
    trace::AlgorithmCase,
};
use toposlam_simulator::{Corridor, CorridorPlan, LaserScanner, ScannerParams};
use toposlam_vision::{geometry, laser::params::LaserParams, visits::VisitPercept};

use super::*;
use crate::{
    AddedMarker, CheckError, CheckedLog, DoorChooser, Evidence, Known, LogCheck, LogSource,
    MarkerPlaceError, RobotStart, VisitedJunction, known_world::MarkerStart,
};

/// A log, and what a check asks of it.
pub(super) struct Question<'q> {
    pub(super) log: &'q [u8],
    pub(super) head: messages::Run,
    /// Tables of a topic map, besides the topics of the log.
    pub(super) mapped: &'q str,
    pub(super) evidence: Evidence,
    pub(super) corners: bool,
    pub(super) world: Option<&'q NamedWorld>,
    pub(super) start: RobotStart<'q>,
    pub(super) aid: Option<AidKind>,
    pub(super) assumes_marker: bool,
    pub(super) doors: DoorChooser,
    /// Of the search for a world.
    pub(super) steps: u64,
}

impl<'q> Question<'q> {
    pub(super) fn new(log: &'q [u8], evidence: Evidence) -> Self {
        Self {
            log,
            head: messages::Run::default(),
            mapped: "",
            evidence,
            corners: false,
            world: None,
            start: RobotStart::Recorded,
            aid: None,
            assumes_marker: false,
            doors: DoorChooser::Algorithm(None),
            steps: 10_000,
        }
    }

    pub(super) fn checked(&self) -> Result<CheckedLog, CheckError> {
        let log = reader::Log::of_bytes(self.log.to_vec()).unwrap();
        let topics = match self.mapped {
            "" => TopicMap::unambiguous(&log),
            mapped => TopicMap::read(mapped.as_bytes()).unwrap().completed(&log),
        };
        let mut laser = LaserParams::default();
        laser.corner.corners = self.corners;
        let check = LogCheck {
            evidence: self.evidence,
            laser,
            world: self.world,
            start: self.start,
            aid: self.aid,
            assumes_marker: self.assumes_marker,
            doors: self.doors,
            search: WorldSearch { class: Class::Multigraph, max_edges: None, steps: self.steps },
            max_darts: None,
            quirks: &Quirks::default(),
        };
        let source = LogSource { log: &log, topics: &topics, head: Some(&self.head), sensor: None };
        check.run(&source, &(), || {})
    }
}

/// Lines of recorded events: the number of doors, the door by which the robot leaves, and the door along which the marker
/// points.
pub(super) fn lines(visits: &[(u32, u32, Option<u32>)]) -> Vec<u8> {
    let line = |&(degree, door, marker): &(u32, u32, Option<u32>)| {
        let marker = marker.map_or(-1, i64::from);
        format!(
            "{{\"kind\":\"event\",\"degree\":{degree},\"door\":{door},\"marker\":{marker},\"turned_back\":false}}\n"
        )
    };
    visits.iter().map(line).collect::<String>().into_bytes()
}

/// The log of a robot with a laser scanner that drives along these points, in corridors with these ends and widths, and sees
/// a tag at a pose once, when it is there.
fn scanned(corridors: &[([[f64; 2]; 2], f64)], way: &[[f64; 2]], tag: Option<Odometry>) -> Vec<u8> {
    let corridor =
        |&(ends, width): &([[f64; 2]; 2], f64)| Corridor { ends: ends.map(Into::into), width };
    let plan =
        CorridorPlan { corridors: corridors.iter().map(corridor).collect(), lobbies: Vec::new() };
    let scanner = LaserScanner::new(&plan, &ScannerParams::PLAIN, 1);
    let mut writer = LogWriter::new(Vec::new()).unwrap();
    let mut number = 0;
    for leg in way.windows(2) {
        let heading = geometry::direction(leg[0], leg[1]);
        let steps = (geometry::distance(leg[0], leg[1]) / 0.5).round() as u32;
        for step in 0..steps {
            number += 1;
            let along = 0.5 * f64::from(step);
            let position = [leg[0][0] + along * heading.cos(), leg[0][1] + along * heading.sin()];
            let stamp = Stamp::from_nanoseconds((5000 + number) * 1_000_000_000);
            let time = stamp.nanoseconds();
            let odometry = Odometry { position, heading };
            let message = OdometryMessage::new(stamp, &odometry, Twist::default());
            writer.write(ODOM, time, &message).unwrap();
            let scan = scanner.scan(Pose { position, heading }, number, number as f64).unwrap();
            writer.write(SCAN, time, &LaserScanMessage::new(stamp, &scan)).unwrap();
            if let Some(tag) = tag.filter(|tag| tag.distance(&odometry) < 0.3) {
                let header = Header { stamp, frame_id: "odom" };
                let pose = PoseMessage::on_floor(&tag);
                writer.write("/tag", time, &PoseStamped { header, pose }).unwrap();
            }
        }
    }
    writer.finish().unwrap()
}

/// A fork at the origin, with corridors to the west, the south and the east; the southern one bends.
const FORK: [([[f64; 2]; 2], f64); 4] = [
    ([[-14.0, 0.0], [0.0, 0.0]], 2.0),
    ([[0.0, 0.0], [14.0, 0.0]], 2.0),
    ([[0.0, 0.0], [0.0, -14.0]], 2.0),
    ([[0.0, -14.0], [14.0, -14.0]], 2.0),
];

/// The log of a robot that comes from the west and goes on to the east, past a tag at the fork that points south.
pub(super) fn past_fork() -> Vec<u8> {
    let tag = Odometry { position: [0.0, 0.2], heading: -FRAC_PI_2 };
    scanned(&FORK, &[[-10.0, 0.0], [10.0, 0.0]], Some(tag))
}

pub(super) fn fork_world() -> NamedWorld {
    let lists = [
        ("fork", vec!["west", "east", "bend"]),
        ("west", vec!["fork"]),
        ("east", vec!["fork"]),
        ("bend", vec!["fork", "end"]),
        ("end", vec!["bend"]),
    ];
    let graph = EmbeddedGraph::from_neighbour_lists(&lists).unwrap();
    NamedWorld::numbered("fork", "", graph, None)
}

#[test]
fn the_aid_and_the_algorithm_are_those_of_the_log_unless_others_are_given() {
    // Around a ring of two junctions.
    let ring = lines(&[(2, 1, Some(0)), (2, 1, None), (2, 1, Some(0))]);
    let recorded = |algorithm: &str| Question {
        head: messages::Run {
            marker: "directional".to_owned(),
            algorithm: algorithm.to_owned(),
            ..messages::Run::default()
        },
        ..Question::new(&ring, Evidence::Recorded)
    };
    let by = |question: &Question| {
        let config = question.checked().unwrap().config;
        (config.aid, config.driver.algorithm())
    };
    let directional = AidKind::from(Directional);
    let folding = RunSettings::new(FOLDING, DARTS).recorded().to_string();
    assert_eq!(by(&recorded(&folding)), (directional, Some(FOLDING)));
    assert_eq!(by(&recorded("")), (directional, Some(MappingAlgorithm::Algorithm1)));
    let given = DoorChooser::Algorithm(Some(MappingAlgorithm::Algorithm1));
    let question = Question { doors: given, ..recorded(&folding) };
    assert_eq!(by(&question), (directional, Some(MappingAlgorithm::Algorithm1)));
    let anyone = Question { doors: DoorChooser::Anyone, ..recorded(&folding) };
    assert_eq!(by(&anyone), (directional, None));
    // An aid that moves has one algorithm, whatever the log records.
    let movable = AidKind::from(MOVABLE);
    let carried = Question { aid: Some(movable), ..recorded(&folding) };
    assert_eq!(by(&carried), (movable, Some(MappingAlgorithm::MovableMarkers(MOVABLE))));
    let inferred = Question { evidence: Evidence::Scenes, ..carried };
    assert!(matches!(inferred.checked(), Err(CheckError::OnlyRecorded { aid }) if aid == movable));
}

#[test]
fn doors_are_compared_with_an_algorithm_only_if_the_marker_is_recorded_given_or_seen() {
    let unmarked = lines(&[(2, 1, None), (2, 1, None)]);
    let seen = lines(&[(2, 1, Some(0)), (2, 1, None)]);
    let question = |log| Question::new(log, Evidence::Recorded);
    let is_shown = |question: &Question| match question.checked() {
        Ok(_) => true,
        Err(CheckError::MarkerNotShown(_)) => false,
        Err(error) => panic!("{error}"),
    };
    assert!(!is_shown(&question(&unmarked)) && is_shown(&question(&seen)));
    let run = messages::Run { marker: "directional".to_owned(), ..messages::Run::default() };
    assert!(is_shown(&Question { head: run, ..question(&unmarked) }));
    assert!(is_shown(&Question { aid: Some(Directional.into()), ..question(&unmarked) }));
    assert!(is_shown(&Question { doors: DoorChooser::Anyone, ..question(&unmarked) }));
}

#[test]
fn a_robot_that_no_algorithm_drives_may_turn_back_between_junctions() {
    let mut turns = lines(&[(2, 1, Some(0))]);
    turns.extend(b"{\"kind\":\"event\",\"degree\":null,\"door\":null,\"turned_back\":true}\n");
    turns.extend(lines(&[(2, 0, Some(1))]));
    let cause = |doors| {
        let question = Question { doors, ..Question::new(&turns, Evidence::Recorded) };
        let divergence = question.checked().unwrap().judgement.divergence;
        divergence.map(|divergence| divergence.cause.name())
    };
    assert_eq!(cause(DoorChooser::Anyone), None);
    assert_eq!(cause(DoorChooser::Algorithm(None)), Some("turned-back"));
}

#[test]
fn the_known_world_has_bends_where_the_events_have_them() {
    let world = fork_world();
    let ring = lines(&[(3, 1, None)]);
    let scans = past_fork();
    for (log, evidence, corners, edges) in [
        (&ring, Evidence::Recorded, false, 4),
        (&scans, Evidence::Laser, false, 3),
        (&scans, Evidence::Laser, true, 4),
    ] {
        let checked = Question {
            world: Some(&world),
            corners,
            aid: Some(NoMarker.into()),
            doors: DoorChooser::Anyone,
            ..Question::new(log, evidence)
        };
        let checked = checked.checked().unwrap();
        let known = checked.known.unwrap();
        assert_eq!(known.world.graph.edge_count(), edges, "{evidence:?}, {corners}");
        assert_eq!(known.start, None);
        // What was driven is compared only where bends do not matter.
        assert_eq!(checked.extracted.driven.is_some(), evidence == Evidence::Laser && !corners);
        assert_eq!(checked.judgement.possible.is_some(), evidence == Evidence::Laser);
        assert_eq!(checked.judgement.divergence, None);
    }
    let unknown = Question { aid: Some(NoMarker.into()), ..Question::new(&scans, Evidence::Laser) };
    let unknown = Question { doors: DoorChooser::Anyone, ..unknown }.checked().unwrap();
    assert!(unknown.known.is_none() && unknown.extracted.driven.is_none());
}

#[test]
fn a_robot_starts_where_the_log_the_question_or_the_world_has_it() {
    let fork = lines(&[(3, 1, None)]);
    let world = fork_world();
    let west = world.start_from_text("v0:v1").ok();
    let world = NamedWorld { start: west, ..world };
    let start = |run: &messages::Run, start| {
        let question = Question {
            head: run.clone(),
            world: Some(&world),
            start,
            aid: Some(Directional.into()),
            ..Question::new(&fork, Evidence::Recorded)
        };
        let known = question.checked().unwrap().known.unwrap();
        (known.start.map(|start| world.start_text(start)), known.is_recorded)
    };
    let text = |text: &str| Some(text.to_owned());
    let nowhere = messages::Run::default();
    assert_eq!(start(&nowhere, RobotStart::Recorded), (text("v0:v1"), None));
    assert_eq!(start(&nowhere, RobotStart::Anywhere), (None, None));
    assert_eq!(start(&nowhere, RobotStart::At("v0:v2")), (text("v0:v2"), None));
    let bend = world.start_from_text("v0:v3").unwrap();
    let here = messages::Run {
        start: "v0:v3".to_owned(),
        world_hash: toposlam_logs::world_hash(&world.graph, bend),
        ..messages::Run::default()
    };
    assert_eq!(start(&here, RobotStart::Recorded), (text("v0:v3"), Some(true)));
    let elsewhere = messages::Run { world_hash: "0".to_owned(), ..here };
    assert_eq!(start(&elsewhere, RobotStart::Recorded), (text("v0:v1"), Some(false)));
}

/// What a complete run from the start has in the known world.
#[test]
fn a_known_world_expects_the_cases_and_shapes_of_a_run_in_it() {
    let known = |world: &NamedWorld| {
        let (aid, algorithm) = (Directional.into(), MappingAlgorithm::Algorithm1);
        Known::new(world.clone(), world.start, (aid, MarkerStart::Robot), algorithm).unwrap().0
    };
    // One hallway: no hypothesis is raised, and none tested.
    let line = NamedWorld::numbered("line", "", EmbeddedGraph::chain(1), Some(Dart(0)));
    let ring = NamedWorld::numbered("ring", "", EmbeddedGraph::cycle(2), Some(Dart(0)));
    let expected = [&line, &ring].map(|world| {
        let known = known(world);
        AlgorithmCase::ALL.map(|case| known.expects(case)).iter().filter(|&&is| is).count()
    });
    assert!(expected[0] > 0 && expected[0] < expected[1], "{expected:?}");
    assert_eq!(known(&line).has_shape(JunctionShape([true; 4])), None);
    assert!(!known(&line).expects_shape(JunctionShape([true; 4])));
    let (plan, facing) = place_in("shape-6");
    let world = NamedWorld::numbered("shape-6", "", plan.graph().clone(), Some(facing));
    let with_plan = known(&NamedWorld { plan: Some((*plan).clone()), ..world });
    let shapes: BTreeSet<_> = plan.graph().darts().map(|entry| plan.shape(entry)).collect();
    for shape in
        (0..16).map(|bits| JunctionShape([0, 1, 2, 3].map(|quarter| bits >> quarter & 1 == 1)))
    {
        assert_eq!(with_plan.has_shape(shape), Some(shapes.contains(&shape)), "{shape:?}");
        // A run goes through each junction, and not by each entry.
        assert!(!with_plan.expects_shape(shape) || shapes.contains(&shape));
    }
    assert!(with_plan.expects_shape(plan.shape(facing)));
}

#[test]
fn a_map_is_the_known_world_if_it_is_that_of_one_of_its_starts() {
    let ring = EmbeddedGraph::cycle(3);
    let states = vec![GraphWorld::new(&ring, Dart(2)).state()];
    let states = states
        .into_iter()
        .map(|State { pose, placed }| State { pose, placed: Places::from_elem(Some(placed), 1) });
    let known = KnownWorld { graph: ring.clone(), states: states.collect() };
    for aid in [AidKind::from(Directional), AidKind::from(MOVABLE)] {
        assert!(known.has(&ring, aid));
        assert!(!known.has(&EmbeddedGraph::cycle(4), aid));
        assert!(!known.has(&EmbeddedGraph::chain(3), aid));
    }
}

/// Where the robot and its marker may both be anywhere, a large world has too many states.
#[test]
fn a_large_world_in_which_the_marker_may_be_anywhere_is_not_followed() {
    let ring = NamedWorld::numbered("ring", "", EmbeddedGraph::cycle(513), None);
    let lies = (AidKind::from(Directional), MarkerStart::Anywhere);
    assert!(Known::new(ring, None, lies, MappingAlgorithm::Algorithm1).is_none());
}

/// The marker of a laser log: assumed at a place or at the first junction, or a tag that was seen.
#[test]
fn a_laser_log_has_its_marker_from_the_question_or_from_sightings_of_a_tag() {
    let scans = past_fork();
    let world = fork_world();
    let question = |mapped, assumes_marker, aid: MarkerKind| Question {
        mapped,
        assumes_marker,
        aid: Some(aid.into()),
        doors: DoorChooser::Anyone,
        world: Some(&world),
        start: RobotStart::At("v0:v1"),
        ..Question::new(&scans, Evidence::Laser)
    };
    // The marker, what the robot saw at the fork, and the number of states in which it may have begun.
    let added = |mapped, assumes_marker, aid| {
        let checked = question(mapped, assumes_marker, aid).checked().unwrap();
        let arrival = checked.judgement.events.events.iter().find_map(CheckedEvent::arrival);
        let states = checked.config.world.unwrap().states.len();
        (checked.added, arrival.unwrap().sighting.unwrap(), states)
    };
    let (tag, here) = ("[marker]\ntopic = \"/tag\"", "[marker]\nat = [0.0, 0.2, 3.0]");
    let assumed = |heading| Some(AddedMarker::Assumed { position: [0.0, 0.2], heading, seen: 1 });
    let (west, south) = (Sighting::Pointing(Door(0)), Sighting::Pointing(Door(2)));
    // In a known world the marker may lie along any of its six darts.
    assert_eq!(added(here, true, Directional), (assumed(Some(3.0)), west, 6));
    assert_eq!(added(here, true, Undirected).0, assumed(None));
    assert_eq!(added(here, true, Undirected).1, Sighting::Lying(1));
    let fiducial = Some(AddedMarker::Fiducial { sightings: 1, elsewhere: 0 });
    assert_eq!(added(tag, false, Directional), (fiducial, south, 6));
    // At the start the robot has it behind itself.
    let (first, sighting, states) = added("", true, Directional);
    let Some(AddedMarker::Assumed { position, heading: Some(heading), seen: 1 }) = first else {
        panic!("{first:?}")
    };
    let is_west = (heading.abs() - PI).abs() < 0.3;
    assert!(geometry::distance(position, [0.0; 2]) < 0.5 && is_west, "{position:?}, {heading}");
    assert_eq!((sighting, states), (west, 1));
    assert_eq!(added("", false, NoMarker), (None, Sighting::Nothing, 1));
    let error = question(tag, false, NoMarker).checked().unwrap_err();
    let expected = MarkerPlaceError::SightingsWithoutMarker;
    assert!(matches!(error, CheckError::MarkerPlace(found) if found == expected), "{error}");
}

#[test]
fn a_marker_that_is_assumed_or_seen_is_that_of_a_laser_log_and_there_is_one() {
    let scans = scanned(&FORK, &[[-3.0, 0.0], [-1.0, 0.0]], None);
    let (tag, here) = ("[marker]\ntopic = \"/scan\"", "[marker]\nat = [0.0, 0.0, 3.0]");
    for (evidence, mapped, assumes_marker, expected) in [
        (Evidence::Laser, tag, true, MarkerPlaceError::AssumedBesideSightings),
        (Evidence::Laser, here, false, MarkerPlaceError::PlaceNotAssumed),
        (Evidence::Recorded, "", true, MarkerPlaceError::AssumedWithoutLaser),
        (Evidence::Recorded, here, true, MarkerPlaceError::AssumedWithoutLaser),
        (Evidence::Recorded, here, false, MarkerPlaceError::MappedWithoutLaser),
        (Evidence::Scenes, tag, false, MarkerPlaceError::MappedWithoutLaser),
    ] {
        let question = Question { mapped, assumes_marker, ..Question::new(&scans, evidence) };
        let error = question.checked().unwrap_err();
        assert!(matches!(error, CheckError::MarkerPlace(found) if found == expected), "{error}");
    }
}

/// Counts the scans that are done.
#[derive(Default)]
struct Done(AtomicU64);

impl Watch for Done {
    fn part_done(&self, cases: u64) {
        self.0.fetch_add(cases, Ordering::Relaxed);
    }
}

#[test]
fn each_scan_is_done_once_and_a_hall_is_where_free_space_is_wider_than_a_corridor() {
    let hall = [([[-14.0, 0.0], [0.0, 0.0]], 2.0), ([[4.0, 0.0], [14.0, 0.0]], 9.0)];
    let way = [-10.0, 12.0, -10.0, 12.0, -10.0].map(|x| [x, 0.0]);
    let log = reader::Log::of_bytes(scanned(&hall, &way, None)).unwrap();
    let topics = TopicMap::unambiguous(&log);
    let done = Done::default();
    let run = extract(&log, &topics, &ExtractConfig::new(Evidence::Laser), &done).unwrap();
    // Up to the last scan that is a view.
    assert_eq!((run.scans, done.0.into_inner()), (176, 175));
    let in_hall = run.wide.iter().filter(|place| place.x > 1.0).count();
    assert!(in_hall > 30 && in_hall == run.wide.len(), "{:?}", run.wide);
}

/// Where a tag was seen, and which scan is where, without odometry.
#[test]
fn without_odometry_each_scan_has_a_place_by_the_walls() {
    let log = reader::Log::of_bytes(scanned(&FORK, &[[-4.0, 0.0], [4.0, 0.0]], None)).unwrap();
    let topics = TopicMap::unambiguous(&log).only(&[Role::Scan]);
    let run = extract(&log, &topics, &ExtractConfig::new(Evidence::Laser), &()).unwrap();
    assert_eq!(run.matched_scans, Some(MatchedScans { placed: 16, unmatched: 0 }));
    assert!(run.poses.keys().eq(&run.scan_messages));
    let ends = [0, 15].map(|scan| run.poses[&run.scan_messages[scan]]);
    assert!((ends[0].distance(&ends[1]) - 7.5).abs() < 0.3, "{ends:?}");
}

/// By what was driven or is seen to end: an arm that the robot only saw may be none.
#[test]
fn an_arm_is_certain_where_it_was_driven_and_possible_where_it_was_seen() {
    let driven = |way: &[[f64; 2]], rounds: usize| {
        let log = reader::Log::of_bytes(scanned(&FORK, way, None)).unwrap();
        let topics = TopicMap::unambiguous(&log);
        let mut config = ExtractConfig { driven: true, ..ExtractConfig::new(Evidence::Laser) };
        config.laser.matching.rounds = rounds;
        let driven = extract(&log, &topics, &config, &()).unwrap().driven?;
        let alternatives = |seen: VisitedJunction| {
            let percept = |one: VisitPercept| (one.degree, one.door);
            seen.alternatives.into_iter().map(|one| one.map(percept)).collect::<Vec<_>>()
        };
        Some(driven.junctions.into_iter().map(alternatives).collect::<Vec<_>>())
    };
    let past = [[-10.0, 0.0], [10.0, 0.0]];
    assert_eq!(driven(&past, 0), Some(vec![vec![None, Some((3, Some(1)))]]));
    // From the west into the southern corridor, back, and on to the east.
    let all = [[-10.0, 0.0], [0.0, 0.0], [0.0, -10.0], [0.0, 0.0], [10.0, 0.0]];
    assert_eq!(driven(&all, 0), Some(vec![vec![Some((3, Some(2)))]; 2]));
    // Where a log begins shows nothing of where the robot came from.
    assert_eq!(driven(&[[-2.0, 0.0], [10.0, 0.0]], 0), Some(vec![vec![]]));
    // Where odometry drifts, it is not known which passes are of one place.
    assert_eq!(driven(&past, 1), None);
}
