//! Junctions from laser scans, in plans of corridors and in logs of real buildings.

use std::{
    collections::BTreeSet,
    env,
    path::{Path, PathBuf},
    sync::Arc,
};

use nalgebra::{Isometry2, Rotation2, Vector2};
use toposlam_conform::{
    CheckedKind, EventSource, RunEvents, UndecidedCause, VisitedJunction, visit_events,
};
use toposlam_logs::{
    entries::Content,
    reader::Log,
    record::{EventKind, Frame},
    topic_map::TopicMap,
};
use toposlam_model::{
    driving::{odometry::Odometry, pose::Pose, scene::wrapped},
    percept::Door,
};
use toposlam_simulator::{Corridor, CorridorPlan, LaserScanner, ScannerParams};
use toposlam_vision::{
    geometry::{self, moved},
    laser::{
        drift::{DriftMeter, ROUNDS},
        params::LaserParams,
        scan::Scan,
        scan_log::ScanLog,
    },
    place::SeenPlace,
    visits::{Visit, VisitPercept, driven_visits, logged_visits},
};

/// A degree, and the door that was taken.
type MarkedVisit = (u64, Option<u64>);
/// A scan, and the odometry at its time.
type PlacedScan = (Arc<Scan>, Odometry);

/// Corridors, each with the ends of its middle line and its width.
fn plan(corridors: &[([f64; 2], [f64; 2], f64)]) -> CorridorPlan {
    let corridor = |&(from, to, width): &([f64; 2], [f64; 2], f64)| Corridor {
        ends: [from.into(), to.into()],
        width,
    };
    CorridorPlan { corridors: corridors.iter().map(corridor).collect(), lobbies: Vec::new() }
}

/// A scanner in corridors without anything else. It covers so many degrees, one from reading to reading.
fn scanner(degrees: u32, plan: &CorridorPlan) -> LaserScanner {
    let field_of_view = f64::from(degrees);
    let params =
        ScannerParams { field_of_view, least_range: 0.0, range: 80.0, ..ScannerParams::PLAIN };
    LaserScanner::new(plan, &params, 1)
}

/// The events of a robot that drives straight from point to point, half a metre from scan to scan, and turns
/// there; its odometry drifts by so many radians a metre.
fn events(plan: &CorridorPlan, way: &[[f64; 2]], drift: f64) -> RunEvents {
    events_of(&drive(180, plan, way, drift), &LaserParams::default())
}

fn events_of(scans: &[PlacedScan], params: &LaserParams) -> RunEvents {
    inferred(scans, params).0
}

fn inferred(scans: &[PlacedScan], params: &LaserParams) -> (RunEvents, Vec<VisitedJunction>) {
    let log = ScanLog::new(scans.iter().cloned(), *params);
    let views: Vec<_> = (0..log.len()).map(|view| log.view(view, false)).collect();
    let source = |scan| EventSource { time: scan as u64 * 1_000_000_000, ..EventSource::default() };
    let (events, junctions) = visit_events(logged_visits(&log, &views, source));
    (RunEvents { events, ..RunEvents::default() }, junctions)
}

/// The scans of that robot, and its odometry.
fn drive(degrees: u32, plan: &CorridorPlan, way: &[[f64; 2]], drift: f64) -> Vec<PlacedScan> {
    let scanner = scanner(degrees, plan);
    let mut scans = Vec::new();
    let (mut believed, mut driven) = (Vector2::from(way[0]), 0.0);
    let mut last = None;
    for leg in way.windows(2) {
        let [from, to] = [leg[0], leg[1]].map(Vector2::from);
        let (length, ahead) = ((to - from).norm(), geometry::direction(leg[0], leg[1]));
        let turn = last.map_or(0.0, |heading| wrapped(ahead - heading));
        let turns = (turn.abs() / 0.4).ceil();
        let turned = (1..=turns as u32).map(|part| (0.0, turn * (1.0 - f64::from(part) / turns)));
        let steps = (length / 0.5).ceil();
        let driving = (1..=steps as u32).map(|step| (f64::from(step) / steps, 0.0));
        for (share, to_turn) in turned.chain(driving) {
            let pose =
                Pose { position: (from + share * (to - from)).into(), heading: ahead - to_turn };
            if share > 0.0 {
                driven += length / steps;
                believed += length / steps * geometry::unit(ahead + drift * driven);
            }
            let scan = scanner.scan(pose, 1, 0.0).unwrap();
            let heading = pose.heading + drift * driven;
            scans.push((Arc::new(scan), Odometry { position: believed.into(), heading }));
        }
        last = Some(ahead);
    }
    scans
}

/// The degree of each junction and the door taken, with `None` for turning back and for what is undecided.
pub(crate) fn visits(events: &RunEvents) -> Vec<(Option<u32>, Option<u32>)> {
    let mut visits: Vec<(Option<u32>, Option<u32>)> = Vec::new();
    for event in &events.events {
        match &event.kind {
            CheckedKind::Arrival { arrival, .. } => visits.push((Some(arrival.degree), None)),
            CheckedKind::Door { door: Door(door), .. } => {
                visits.last_mut().unwrap().1 = Some(*door);
            }
            _ => visits.push((None, None)),
        }
    }
    visits
}

/// Two T junctions whose stems meet a long corridor from opposite sides, 14 m apart, and a crossing.
fn comb() -> CorridorPlan {
    plan(&[
        ([0.0, 0.0], [60.0, 0.0], 2.0),
        ([14.0, 0.0], [14.0, 15.0], 2.0),
        ([28.0, -15.0], [28.0, 0.0], 2.0),
        ([44.0, -15.0], [44.0, 15.0], 2.0),
    ])
}

/// Parameters with which the bends and the dead ends of corridors are vertices.
fn with_corners() -> LaserParams {
    let mut params = LaserParams::default();
    params.corner.corners = true;
    params
}

/// Parameters with which scans are matched.
fn matched(rounds: usize) -> LaserParams {
    let mut params = LaserParams::default();
    params.matching.rounds = rounds;
    params
}

#[test]
fn each_junction_on_the_way_is_visited_once() {
    // Straight on: past the stem on the left, the one on the right, and the crossing.
    let way = [[3.0, 0.0], [57.0, 0.0]];
    let expected = [(Some(3), Some(2)), (Some(3), Some(1)), (Some(4), Some(2))];
    for drift in [0.0_f64, 5.0, -5.0] {
        let events = events(&comb(), &way, drift.to_radians() / 10.0);
        assert_eq!(visits(&events), expected, "drift of {drift} degrees in 10 m");
    }
    // Scan matching corrects more.
    for drift in [0.0_f64, 10.0, -10.0, 20.0, -20.0] {
        let scans = drive(180, &comb(), &way, drift.to_radians() / 10.0);
        let events = events_of(&scans, &matched(8));
        assert_eq!(visits(&events), expected, "matched, drift of {drift} degrees in 10 m");
    }
    // Out by the stem on the left, which is the second door clockwise from the way back.
    let events = events(&comb(), &[[3.0, 0.0], [14.0, 0.0], [14.0, 12.0]], 0.0);
    assert_eq!(visits(&events), [(Some(3), Some(1))]);
}

#[test]
fn a_robot_whose_log_begins_at_a_junction_has_its_back_to_door_0() {
    // It looks round between the corridor and a stem in the north, and leaves to the east. At first it looks to
    // the west, or to the east.
    let [west, east] = [[13.6, 0.0], [14.4, 0.0]];
    for (way, door) in [(vec![east, west, east], 0), (vec![west, east, west, east], 2)] {
        let way = [way, vec![[24.0, 0.0]]].concat();
        assert_eq!(visits(&events(&comb(), &way, 0.0)), [(Some(3), Some(door))]);
    }
}

#[test]
fn the_arms_of_a_junction_can_have_any_angle() {
    // A corridor that forks: the arms are 120 degrees apart.
    let at =
        |metres: f64, degrees: f64| <[f64; 2]>::from(metres * geometry::unit(degrees.to_radians()));
    let arm = |degrees| ([0.0, 0.0], at(15.0, degrees), 2.0);
    let visits = |arms: &[_], degrees| {
        visits(&events(&plan(arms), &[[-12.0, 0.0], [0.0, 0.0], at(12.0, degrees)], 0.0))
    };
    let fork = [arm(180.0), arm(60.0), arm(-60.0)];
    assert_eq!(visits(&fork, 60.0), [(Some(3), Some(1))]);
    assert_eq!(visits(&fork, -60.0), [(Some(3), Some(2))]);
    // Half a circle does not show the arms that point back.
    let star = [180.0, 108.0, 36.0, -36.0, -108.0].map(arm);
    let way = [[-12.0, 0.0], [0.0, 0.0], at(12.0, 36.0)];
    let around = drive(360, &plan(&star), &way, 0.0);
    assert_eq!(self::visits(&events_of(&around, &LaserParams::default())), [(Some(5), Some(2))]);
}

/// A corridor along x, and others that leave it at the same place, at these angles to its direction.
fn branches(degrees: &[f64]) -> CorridorPlan {
    let branch = |degrees: &f64| {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        ([22.0, 0.0], [22.0 + 15.0 * cosine, 15.0 * sine], 2.0)
    };
    let corridor = ([0.0, 0.0], [44.0, 0.0], 2.0);
    plan(&std::iter::once(corridor).chain(degrees.iter().map(branch)).collect::<Vec<_>>())
}

#[test]
fn an_arm_that_the_scanner_did_not_look_into_makes_the_visit_undecided() {
    let way = [[2.0, 0.0], [42.0, 0.0]];
    let params = LaserParams::default();
    // One arm points back on the left; and another one goes off at a right angle on the right.
    for (angles, door) in [(&[120.0][..], 2), (&[120.0, -90.0], 2)] {
        let plan = branches(angles);
        let half = events(&plan, &way, 0.0);
        let causes: Vec<_> = half.events.iter().map(|event| &event.kind).collect();
        let undecided = CheckedKind::Undecided(UndecidedCause::UnseenArm);
        assert_eq!(causes, [&undecided], "{angles:?}");
        // A robot that looks all around sees it, ...
        let around = events_of(&drive(360, &plan, &way, 0.0), &params);
        let degree = Some(angles.len() as u32 + 2);
        assert_eq!(visits(&around), [(degree, Some(door))], "{angles:?}");
        // ... and one that comes the other way.
        let back: Vec<_> = way.into_iter().rev().collect();
        assert_eq!(visits(&events(&plan, &back, 0.0)).len(), 1);
        assert_eq!(visits(&events(&plan, &back, 0.0))[0].0, degree, "{angles:?}");
    }
}

#[test]
fn junctions_are_not_known_where_a_robot_drives_backwards_with_a_scanner_that_does_not_look_there()
{
    let way = [[3.0, 0.0], [57.0, 0.0]];
    let back: Vec<_> = way.into_iter().rev().collect();
    let forwards = visits(&events(&comb(), &way, 0.0));
    assert_eq!(forwards, [(Some(3), Some(2)), (Some(3), Some(1)), (Some(4), Some(2))]);
    for degrees in [90, 180, 270, 340, 350, 360] {
        // In reverse order, the scans of a robot that drives towards the first end are those of one that drives
        // away from it, backwards.
        let scans: Vec<_> = drive(degrees, &comb(), &back, 0.0).into_iter().rev().collect();
        let events = events_of(&scans, &LaserParams::default());
        let first = &events.events[0].kind;
        if degrees < 345 {
            assert_eq!(*first, CheckedKind::Undecided(UndecidedCause::UnseenWay), "{degrees}");
        } else {
            assert_eq!(visits(&events), forwards, "{degrees}");
        }
    }
}

#[test]
fn alcoves_rooms_and_bends_are_no_junctions() {
    let corridor = ([0.0, 0.0], [50.0, 0.0], 2.0);
    // A niche, a room behind a door of 0.9 m, an alcove that ends after 8 m.
    let niche = ([12.0, 0.0], [12.0, 2.0], 1.6);
    let room = [([22.0, 0.0], [22.0, 2.0], 0.9), ([18.0, 4.5], [26.0, 4.5], 6.0)];
    let alcove = ([36.0, 0.0], [36.0, 7.0], 2.0);
    let rooms = plan(&[corridor, niche, room[0], room[1], alcove]);
    assert_eq!(visits(&events(&rooms, &[[3.0, 0.0], [47.0, 0.0]], 0.0)), []);
    // A corridor that turns by 45 degrees, and by 90.
    let bends = plan(&[
        ([0.0, 0.0], [15.0, 0.0], 2.0),
        ([15.0, 0.0], [25.0, 10.0], 2.0),
        ([25.0, 10.0], [15.0, 20.0], 2.0),
    ]);
    let way = [[2.0, 0.0], [15.0, 0.0], [25.0, 10.0], [17.0, 18.0]];
    assert_eq!(visits(&events(&bends, &way, 0.0)), []);
}

#[test]
fn a_robot_that_turns_back_between_junctions_enters_the_same_one_again() {
    // Into the stem, back, and on along the corridor.
    let way = [[3.0, 0.0], [14.0, 0.0], [14.0, 8.0], [14.0, 0.0], [24.0, 0.0]];
    let events = events(&comb(), &way, 0.0);
    let back = (None, None);
    assert_eq!(visits(&events), [(Some(3), Some(1)), back, (Some(3), Some(1))]);
    // It stood at one junction, and took the door straight on in the end.
    assert_eq!(visits(&events.without_excursions()), [(Some(3), Some(2))]);
}

#[test]
fn a_robot_that_turns_back_at_the_end_of_a_corridor_was_at_a_dead_end() {
    let plan = plan(&[([0.0, 0.0], [30.0, 0.0], 2.0), ([14.0, -14.0], [14.0, 0.0], 2.0)]);
    // Past the stem on the right to the end of the corridor, and back into the stem.
    let way = [[2.0, 0.0], [28.0, 0.0], [14.0, 0.0], [14.0, -10.0]];
    let events = events_of(&drive(180, &plan, &way, 0.0), &with_corners());
    assert_eq!(visits(&events), [(Some(3), Some(1)), (Some(1), Some(0)), (Some(3), Some(1))]);
}

#[test]
fn sharp_bends_are_vertices_if_corners_are() {
    // Two right angles, then a bend by 45 degrees.
    let plan = plan(&[
        ([0.0, 0.0], [20.0, 0.0], 2.0),
        ([20.0, 0.0], [20.0, 16.0], 2.0),
        ([20.0, 16.0], [36.0, 16.0], 2.0),
        ([36.0, 16.0], [50.0, 30.0], 2.0),
    ]);
    let scans = drive(
        180,
        &plan,
        &[[2.0, 0.0], [20.0, 0.0], [20.0, 16.0], [36.0, 16.0], [46.0, 26.0]],
        0.0,
    );
    let corner = (Some(2), Some(1));
    assert_eq!(visits(&events_of(&scans, &with_corners())), [corner, corner]);
    assert_eq!(visits(&events_of(&scans, &LaserParams::default())), []);
}

/// The folder of CARMEN logs, if it exists; `TOPOSLAM_CARMEN_LOGS` names it.
fn carmen_folder() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/carmen");
    let folder = env::var_os("TOPOSLAM_CARMEN_LOGS").map_or(beside, PathBuf::from);
    let found = folder.join("aces.log.gz").is_file();
    if !found {
        eprintln!("skipped: there are no CARMEN logs in {}", folder.display());
    }
    found.then_some(folder)
}

/// The visits of vertices in a log of a real building, as they were marked by hand, and the scans of the log,
/// each with its odometry.
fn recorded(name: &str) -> Option<(Vec<MarkedVisit>, Vec<PlacedScan>)> {
    let folder = carmen_folder()?;
    let text = std::fs::read_to_string(folder.join(format!("{name}-visits.jsonl"))).unwrap();
    let marked = text.lines().map(|line| {
        let visit: serde_json::Value = serde_json::from_str(line).unwrap();
        (visit["degree"].as_u64().unwrap(), visit["door"].as_u64())
    });
    Some((marked.collect(), scans_of(name)?))
}

/// The scans of a log of a real building, each with its odometry.
fn scans_of(name: &str) -> Option<Vec<PlacedScan>> {
    let log = Log::open(&carmen_folder()?.join(name).with_extension("log.gz")).unwrap();
    let bound = TopicMap::from_log(&log).unwrap().bind(&log).unwrap();
    let scans = log.entries(&bound).filter_map(|entry| match entry.unwrap().content {
        Content::Event(EventKind::Frame(Frame { scan: Some(scan), odometry, .. })) => {
            Some((scan, odometry))
        }
        _ => None,
    });
    Some(scans.collect())
}

/// The visits in a recorded log are those that were marked by hand: so many are certain, and where nothing was marked
/// there may be no junction.
fn are_as_marked(name: &str, marked: &[MarkedVisit], certain: usize, visited: &[VisitedJunction]) {
    // The numbers of marked visits that those so far can be.
    let mut counts = BTreeSet::from([0]);
    for visit in visited {
        let next = |&count: &usize| {
            let (degree, door) = *marked.get(count)?;
            // The door of the first visit is not marked if the log begins there.
            let is_it = |seen: &VisitPercept| {
                let left = seen.door.map(u64::from);
                u64::from(seen.degree) == degree && (door.is_none() || left == door)
            };
            visit.alternatives.iter().flatten().any(is_it).then_some(count + 1)
        };
        let mut after: BTreeSet<_> = counts.iter().filter_map(next).collect();
        if visit.alternatives.contains(&None) {
            after.append(&mut counts);
        }
        counts = after;
    }
    assert!(counts.contains(&marked.len()), "{name}: {visited:?}");
    let decided = visited.iter().filter(|visit| visit.alternatives.len() == 1).count();
    assert!(decided >= certain, "{name}: {visited:?}");
}

#[test]
fn the_vertices_of_two_real_buildings_are_visited_as_they_were_marked_by_hand() {
    for (name, junctions, corners, certain) in [("aces", 12, 16, 16), ("seattle", 3, 12, 10)] {
        let Some((mut marked, scans)) = recorded(name) else { return };
        assert_eq!(marked.len(), corners);
        let mut at_junctions = marked.clone();
        at_junctions.retain(|visit| visit.0 >= 3);
        assert_eq!(at_junctions.len(), junctions);
        are_as_marked(name, &at_junctions, junctions, &inferred(&scans, &LaserParams::default()).1);
        if name == "seattle" {
            // The log begins in a dead end, and ends before the robot has passed the last corner.
            marked.remove(0);
            marked.pop();
        }
        are_as_marked(name, &marked, certain, &inferred(&scans, &with_corners()).1);
    }
}

/// Odometry whose heading drifts by so many degrees in 10 m.
fn drifted(scans: &[PlacedScan], drift: f64) -> Vec<PlacedScan> {
    let drift = drift.to_radians() / 10.0;
    let mut last: Option<[Vector2<f64>; 2]> = None;
    let mut turned = 0.0;
    let moved = |(scan, odometry): &PlacedScan| {
        let position = Vector2::from(odometry.position);
        let [before, moved] = last.unwrap_or([position; 2]);
        let length = (position - before).norm();
        let turn = Rotation2::new(turned + drift * length / 2.0);
        turned += drift * length;
        let moved = moved + turn * (position - before);
        last = Some([position, moved]);
        (scan.clone(), Odometry { position: moved.into(), heading: odometry.heading + turned })
    };
    scans.iter().map(moved).collect()
}

fn measured_drift(scans: &[PlacedScan]) -> f64 {
    let mut meter = DriftMeter::new(LaserParams::default());
    for (scan, odometry) in scans {
        meter.add_scan(scan, odometry);
    }
    meter.finish().unwrap().to_degrees()
}

#[test]
fn the_drift_of_the_heading_is_measured_by_the_walls() {
    let way = [[3.0, 0.0], [14.0, 0.0], [14.0, 8.0], [14.0, 0.0], [26.0, 0.0]];
    for degrees in [0.0, 2.0, -2.0, 5.0, -5.0_f64] {
        let measured = measured_drift(&drive(180, &comb(), &way, degrees.to_radians() / 10.0));
        assert!((measured - degrees.abs()).abs() < 0.5, "{measured} for {degrees}");
    }
}

#[test]
#[ignore = "a long sweep, for `.ci/run --all`"]
fn the_junctions_of_two_real_buildings_are_visited_alike_if_the_heading_drifts() {
    let limit = LaserParams::default().matching.max_drift.to_degrees();
    // With 5 degrees to the right one visit in Seattle is missed.
    for (name, drifts) in
        [("aces", &[0.0, 2.0, -2.0, 5.0, -5.0][..]), ("seattle", &[0.0, 2.0, -2.0, 5.0])]
    {
        let Some((mut marked, scans)) = recorded(name) else { return };
        marked.retain(|visit| visit.0 >= 3);
        for &drift in drifts {
            let scans = drifted(&scans, drift);
            let measured = measured_drift(&scans);
            assert_eq!(measured > limit, drift != 0.0, "{name}: {measured} for {drift}");
            if drift != 0.0 {
                are_as_marked(
                    &format!("{name}, {drift}"),
                    &marked,
                    0,
                    &inferred(&scans, &matched(ROUNDS)).1,
                );
            }
        }
    }
}

#[test]
#[ignore = "a long sweep, for `.ci/run --all`"]
fn the_frame_of_odometry_does_not_matter() {
    for name in ["aces", "seattle"] {
        let Some((_, scans)) = recorded(name) else { return };
        for params in [LaserParams::default(), matched(ROUNDS)] {
            let visits_from = |turn: f64, shift| {
                let motion = Isometry2::new(Vector2::from(shift), turn.to_radians());
                let placed = scans.iter().map(|(scan, at)| (scan.clone(), moved(&motion, at)));
                visits(&events_of(&placed.collect::<Vec<_>>(), &params))
            };
            let expected = visits_from(0.0, [0.0; 2]);
            for (turn, shift) in [(33.0, [0.03, 0.07]), (-120.0, [1000.0, -50.0])] {
                assert_eq!(
                    visits_from(turn, shift),
                    expected,
                    "{name}, {} rounds, turned by {turn}",
                    params.matching.rounds
                );
            }
        }
    }
}

/// The visits of places that are farther than this from all scans without which a log begins, in metres, do not change:
/// what one sees there comes from scans that were taken within 18 m of the robot's way, or within 16 m, while the robot
/// is within 6 m of the place.
const UNTOUCHED: f64 = 24.0;

/// The percepts and the ways of the visits that are far from the first scans.
fn far_from_first(scans: &[PlacedScan], first: &[PlacedScan]) -> Vec<String> {
    let (_, junctions) = inferred(scans, &LaserParams::default());
    let is_far = |junction: &&VisitedJunction| {
        first.iter().all(|(_, at)| geometry::distance(at.position, junction.centre) > UNTOUCHED)
    };
    let far = junctions.iter().filter(is_far);
    far.map(|it| format!("{:?} {:?} {}", it.centre, it.alternatives, it.goes_back)).collect()
}

/// Checks that a log without some of its first scans has the same visits where these do not show, at least so many.
fn assert_begins_anywhere(name: &str, scans: &[PlacedScan], least: usize, all_dropped: &[usize]) {
    for &dropped in all_dropped {
        let first = &scans[..dropped];
        let whole = far_from_first(scans, first);
        assert!(whole.len() >= least, "{name}: {whole:?}");
        assert_eq!(far_from_first(&scans[dropped..], first), whole, "{name} without {dropped}");
    }
}

#[test]
fn where_a_log_begins_does_not_matter_for_places_that_the_first_scans_do_not_show() {
    let comb = drive(180, &comb(), &[[3.0, 0.0], [57.0, 0.0]], 0.0);
    assert_begins_anywhere("comb", &comb, 1, &[1, 2, 3, 5, 7, 8, 13, 20]);
}

#[test]
#[ignore = "a long sweep, for `.ci/run --all`"]
fn where_the_log_of_a_real_building_begins_does_not_matter_either() {
    let some: &[usize] = &[5, 7, 8, 13, 20];
    for (name, least, dropped) in
        [("aces", 6, some), ("seattle", 1, some), ("infinite-corridor", 40, &[5])]
    {
        let Some(scans) = scans_of(name) else { return };
        assert_begins_anywhere(name, &scans, least, dropped);
    }
}

/// A corridor of 60 m, and a way off it at 14 m that bends after 6 m.
fn bent_stem() -> CorridorPlan {
    plan(&[
        ([0.0, 0.0], [60.0, 0.0], 2.0),
        ([14.0, 0.0], [14.0, 6.0], 2.0),
        ([14.0, 6.0], [32.0, 6.0], 2.0),
    ])
}

/// The scans of a robot that passes the way off, turns 40 m behind it, comes back and drives into it; on its way back
/// odometry is so many metres too far along the corridor.
fn pass_and_come_back(off: f64) -> Vec<PlacedScan> {
    let way = [[3.0, 0.0], [57.0, 0.0], [14.0, 0.0], [14.0, 6.0], [28.0, 6.0]];
    let mut scans = drive(360, &bent_stem(), &way, 0.0);
    let turned = scans.iter().position(|(_, at)| at.position[0] > 56.0).unwrap();
    for (_, odometry) in &mut scans[turned..] {
        odometry.position[0] += off;
    }
    scans
}

#[test]
fn an_arm_that_was_driven_on_a_later_pass_is_certain_if_the_passes_agree() {
    let first = |off: f64| {
        let (_, junctions) = inferred(&pass_and_come_back(off), &LaserParams::default());
        junctions[0].alternatives.clone()
    };
    let straight_on = Some(VisitPercept { degree: 3, door: Some(2) });
    assert_eq!(first(0.0), [straight_on]);
    assert_eq!(first(0.2), [straight_on], "the walls are blurred");
    assert_eq!(first(3.0), [None, straight_on], "the way off is elsewhere then");
}

#[test]
fn a_pass_that_lies_elsewhere_along_a_corridor_hides_no_junction() {
    let long = plan(&[
        ([0.0, 0.0], [90.0, 0.0], 2.0),
        ([14.0, 0.0], [14.0, 15.0], 2.0),
        ([28.0, -15.0], [28.0, 0.0], 2.0),
        ([44.0, -15.0], [44.0, 15.0], 2.0),
    ]);
    let scans = drive(180, &long, &[[3.0, 0.0], [87.0, 0.0], [3.0, 0.0]], 0.0);
    let turned = scans.iter().position(|(_, at)| at.position[0] > 86.0).unwrap();
    let percepts = |off: f64| {
        let mut off_along = scans.clone();
        for (_, odometry) in &mut off_along[turned..] {
            odometry.position[0] += off;
        }
        let (_, junctions) = inferred(&off_along, &LaserParams::default());
        junctions.into_iter().map(|it| it.alternatives).collect::<Vec<_>>()
    };
    let known = percepts(0.0);
    assert_eq!(known.len(), 6);
    assert!(known.iter().all(|alternatives| alternatives.len() == 1));
    for off in [-4.5, -3.5, -2.6, -1.9, -1.3, -0.7, 0.7, 1.3, 1.9, 2.6, 3.5, 4.5] {
        // Each of them is among the visits that are possible, in their order; without alternatives nothing is known.
        let possible = percepts(off);
        let mut possible_visits = possible.iter();
        for known in &known {
            let is_it = |it: &Vec<_>| it.is_empty() || it.contains(&known[0]);
            assert!(possible_visits.any(is_it), "{off} m off: {possible:?}");
        }
    }
}

#[test]
fn a_log_shows_a_place_before_the_robot_comes_to_it() {
    let scans = drive(180, &comb(), &[[3.0, 0.0], [57.0, 0.0]], 0.0);
    let log = ScanLog::new(scans, LaserParams::default());
    let mut views = (0..log.len()).map(|view| log.view(view, false));
    let view = views.find(|view| view.robot.position[0] > 7.0).unwrap();
    let is_first = |place: &SeenPlace| geometry::distance(place.centre, [14.0, 0.0]) < 1.0;
    let place = view.places.iter().find(|place| is_first(place)).unwrap();
    assert_eq!(place.directions().count(), 3);
}

/// What is possible of each visit by what was driven and what is seen to end.
fn driven(scans: &[PlacedScan]) -> Vec<Vec<Option<VisitPercept>>> {
    let log = ScanLog::new(scans.iter().cloned(), LaserParams::default());
    let views: Vec<_> = (0..log.len()).map(|view| log.view(view, true)).collect();
    let visits = driven_visits(&log, &views, |scan| scan).unwrap().visits;
    visits.iter().map(Visit::alternatives).collect()
}

#[test]
fn arms_that_were_driven_are_certain_and_those_that_are_not_seen_to_end_are_possible() {
    let percept = |degree, door| Some(VisitPercept { degree, door: Some(door) });
    // Past three junctions to the end of the corridor, back past two of them, and into the stem of the first.
    let way = [[3.0, 0.0], [57.0, 0.0], [14.0, 0.0], [14.0, 13.0]];
    let crossing = || vec![None, percept(3, 1), percept(3, 2), percept(4, 2)];
    let expected = [
        vec![percept(3, 2)],
        vec![None, percept(3, 1)],
        crossing(),
        crossing(),
        vec![None, percept(3, 2)],
        vec![percept(3, 2)],
    ];
    let scans = drive(360, &comb(), &way, 0.0);
    assert_eq!(driven(&scans), expected);
    // The odometry of the way back is off. Matched scans show that it is of the same place, unless it is off by more.
    let turned = scans.iter().position(|(_, at)| at.position[0] > 56.0).unwrap();
    for (along, expected) in [(0.6, vec![percept(3, 2)]), (2.5, vec![None, percept(3, 2)])] {
        let mut off = scans.clone();
        for (_, odometry) in &mut off[turned..] {
            odometry.position[0] += along;
        }
        assert_eq!(driven(&off)[0], expected, "{along} m off");
        assert_eq!(inferred(&off, &LaserParams::default()).1[0].alternatives, [percept(3, 2)]);
    }
    // Where a log begins nothing is known of where the robot came from.
    let begins = drive(360, &comb(), &[[14.0, 0.5], [40.0, 0.0]], 0.0);
    assert_eq!(driven(&begins), [vec![], vec![None, percept(3, 1)]]);
    // Where scans are matched it is not known which passes are of one place.
    let log = ScanLog::new(scans, matched(ROUNDS));
    let views: Vec<_> = (0..log.len()).map(|view| log.view(view, true)).collect();
    assert!(driven_visits(&log, &views, |scan| scan).is_none());
}
