//! Visits by the approaches of a camera, in scenes that are made up.

use toposlam_model::{
    driving::scene::{CentreLine, HallwayStatus, HallwayView, Reason},
    percept::{Door, Sighting},
};

use super::*;
use crate::visits::{VisitPercept, Visits};

type Seen = (Place, [f64; 2], f64);

/// What a robot sees that looks along x and has come along it; the junction has a door behind it and
/// one to its left.
fn junction(ahead: f64) -> Place {
    let through = [ahead, 0.0];
    let line = |direction| CentreLine { through, direction };
    let doors = vec![line(PI), line(FRAC_PI_2)];
    Place::Junction(JunctionView { doors, turning_point: through, confidence: 1.0 })
}

fn hallway(position: [f64; 2], heading: f64) -> Seen {
    let status = HallwayStatus::Clear;
    let view = HallwayView { heading: 0.0, left: 0.8, right: 0.8, status, confidence: 1.0 };
    (Place::Hallway(view), position, heading)
}

/// A robot that comes along x to a junction at the origin, and visits it.
fn visit() -> Vec<Seen> {
    let from = |x: f64| (junction(-x), [x, 0.0], 0.0);
    vec![hallway([-2.0, 0.0], 0.0), from(-0.8), from(-0.5), from(-0.2)]
}

fn visits(places: &[Seen], marked: bool) -> VisitLog<usize> {
    let mut visits = Visits::by_camera(marked);
    for (number, (place, position, heading)) in places.iter().enumerate() {
        let scene = Scene { place: place.clone(), marker: None };
        visits.add_frame(number, &scene, &Odometry { position: *position, heading: *heading });
    }
    visits.finish()
}

/// The door of each visit; `None` for what is undecided, and where the robot turned back.
fn events(places: &[Seen], marked: bool) -> (Vec<Option<u32>>, Vec<usize>) {
    let VisitLog { visits, turned_back } = visits(places, marked);
    let door = |visit: &Visit<usize>| {
        visit.percept().door.filter(|_| visit.doubt.is_none() && visit.turned_back.is_empty())
    };
    (visits.iter().map(door).collect(), turned_back)
}

#[test]
fn a_visit_is_a_percept_and_the_door_by_which_it_ends() {
    let away = hallway([0.0, 1.0], FRAC_PI_2);
    let mut places = [visit(), vec![away]].concat();
    let seen = visits(&places, false).visits;
    let [Visit { at: 3, exit: Some(VisitExit { at: 4, off: Some(off), .. }), .. }] = &seen[..]
    else {
        panic!("{seen:?}")
    };
    assert!(*off < 1e-9 && seen[0].percept().degree == 2);
    assert_eq!(seen[0].alternatives(), [Some(seen[0].percept())]);
    assert_eq!(events(&places, false), (vec![Some(1)], vec![]));
    // What cannot be recognised, and a hallway beside the turning point, change nothing.
    let unknown = (Place::Unknown(Reason::NothingFits), [0.0; 2], 0.0);
    places.splice(4..4, [unknown, hallway([0.0, 0.1], 0.0)]);
    assert_eq!(events(&places, false), (vec![Some(1)], vec![]));
    // Between the doors.
    let seen = visits(&[visit(), vec![hallway([0.7, 0.7], FRAC_PI_4)]].concat(), false).visits;
    assert!((seen[0].exit.unwrap().off.unwrap() - FRAC_PI_4).abs() < 1e-9);
}

#[test]
fn turning_back_is_noticed_in_a_hallway_and_before_a_junction() {
    let mut places = visit();
    places.push(hallway([0.0, 2.0], FRAC_PI_2));
    places.push(hallway([0.0, 1.9], -FRAC_PI_2));
    assert_eq!(events(&places, false), (vec![Some(1)], vec![5]));
    let mut places = visit()[..3].to_vec();
    places.push(hallway([-0.7, 0.0], PI));
    assert_eq!(events(&places, false), (vec![], vec![3]));
}

#[test]
fn a_junction_that_is_passed_or_seen_once_is_undecided() {
    let passed = [visit()[..2].to_vec(), vec![hallway([0.7, 0.0], 0.0)]].concat();
    assert_eq!(events(&passed, false), (vec![None], vec![]));
    let once = [(junction(0.2), [-0.2, 0.0], 0.0), hallway([0.0, 1.0], FRAC_PI_2)];
    assert_eq!(events(&once, false), (vec![None], vec![]));
    assert_eq!(visits(&once, false).visits[0].alternatives(), [], "anything is possible");
}

/// The same place, if it is only possible.
fn possible((place, position, heading): Seen) -> Seen {
    let Place::Junction(view) = place else { return (place, position, heading) };
    let view = JunctionView { confidence: 0.5, ..view };
    (Place::Junction(view), position, heading)
}

#[test]
fn what_is_only_possibly_a_junction_is_a_visit_with_no_junction_among_its_alternatives() {
    let onwards = hallway([0.7, 0.0], 0.0);
    let aside = hallway([0.0, 0.7], FRAC_PI_2);
    let back = hallway([-0.7, 0.0], PI);
    let percept = |degree, door| Some(VisitPercept { degree, door: Some(door) });
    let seen = |away: &[Seen]| {
        let come = visit().into_iter().map(possible).collect();
        let log = visits(&[come, away.to_vec()].concat(), false);
        assert_eq!((log.visits.len(), &log.turned_back[..]), (1, &[][..]));
        log.visits[0].alternatives()
    };
    let (straight, left) =
        ([percept(3, 1), percept(3, 2), percept(4, 2)], [percept(2, 1), percept(3, 1)]);
    assert_eq!(seen(&[onwards]), [&[None], &straight[..]].concat());
    // A hallway does not bend.
    assert_eq!(seen(&[aside]), [&left[..], &[percept(4, 1)]].concat()[..]);
    let dead_end_or_more = [1, 2, 3, 4].map(|degree| percept(degree, 0));
    assert_eq!(seen(&[back]), [&[None], &dead_end_or_more[..]].concat());
    // The log ends there.
    assert!(seen(&[]).contains(&None));
}

#[test]
fn what_is_passed_and_only_possibly_a_junction_is_a_visit_and_what_is_turned_away_from_is_none() {
    let before = possible((junction(0.8), [-0.8, 0.0], 0.0));
    let passed = [before.clone(), hallway([0.7, 0.0], 0.0)];
    let log = visits(&passed, false);
    assert!(log.visits[0].alternatives().contains(&None), "{log:?}");
    let turned = [before, hallway([-0.9, 0.0], PI)];
    assert_eq!(events(&turned, false), (vec![], vec![1]));
}

#[test]
fn a_possible_junction_has_its_place_and_arms_once_it_is_certain() {
    // It seems to be half a metre farther on, and turned by 20 degrees.
    let turned = 20.0_f64.to_radians();
    let seems = |x: f64| {
        let through = [0.5 - x, 0.0];
        let line = |direction| CentreLine { through, direction: wrapped(direction + turned) };
        let doors = vec![line(PI), line(FRAC_PI_2)];
        let view = JunctionView { doors, turning_point: through, confidence: 0.5 };
        (Place::Junction(view), [x, 0.0], 0.0)
    };
    let mut robot = Visits::by_camera(false);
    let mut at = 0..;
    let mut go = |(place, position, heading): Seen| {
        let scene = Scene { place, marker: None };
        robot.add_frame(at.next().unwrap(), &scene, &Odometry { position, heading });
        robot.status()
    };
    let directions = |place: &SeenPlace| {
        let direction = |arm: &PlaceArm| (arm.direction.to_degrees().round(), arm.certainty);
        place.arms.iter().map(direction).collect::<Vec<_>>()
    };
    assert_eq!(go(hallway([-2.0, 0.0], 0.0)), None);
    assert_eq!(go(seems(-0.8)), None);
    let possible = go(seems(0.3)).unwrap();
    assert!((possible.centre.x - 0.5).abs() < 1e-9, "{possible:?}");
    let certainty = [Certainty::Certain, Certainty::Possible];
    let [entry, others] = certainty;
    let expected = [(-160.0, entry), (110.0, others), (20.0, others), (-70.0, others)];
    assert_eq!(directions(&possible), expected);
    go((junction(-0.1), [0.1, 0.0], 0.0));
    let certain = go((junction(-0.2), [0.2, 0.0], 0.0)).unwrap();
    assert!(certain.centre.x.abs() < 1e-9, "{certain:?}");
    assert_eq!(directions(&certain), [(180.0, entry), (90.0, entry)]);
}

#[test]
fn furniture_far_beside_a_junction_does_not_end_its_visit() {
    // Before the second image of the junction, without which it is not decided.
    let far = possible((junction(2.0), [-0.3, 0.0], 0.0));
    let mut places = [visit(), vec![hallway([0.0, 1.0], FRAC_PI_2)]].concat();
    places.insert(2, far);
    assert_eq!(events(&places, false), (vec![Some(1)], vec![]));
    assert_eq!(visits(&places, false).visits.len(), 1);
}

#[test]
fn furniture_beside_a_junction_does_not_change_its_visit() {
    // A false dead end before it, at it and behind it.
    let false_end = |ahead: f64, x: f64| {
        let through = [ahead, 0.0];
        let doors = vec![CentreLine { through, direction: -FRAC_PI_2 }];
        let view = JunctionView { doors, turning_point: through, confidence: 0.5 };
        (Place::Junction(view), [x, 0.0], 0.0)
    };
    let away = hallway([0.0, 1.0], FRAC_PI_2);
    let mut places = [visit(), vec![away]].concat();
    places.insert(4, false_end(1.8, -0.1));
    places.insert(2, false_end(0.1, -0.6));
    places.insert(1, false_end(0.5, -1.0));
    let seen = visits(&places, false).visits;
    assert_eq!(seen.len(), 1, "{seen:?}");
    assert_eq!(seen[0].alternatives(), [Some(seen[0].percept())]);
    assert_eq!(events(&places, false), (vec![Some(1)], vec![]));
}

/// The visits do not depend on the direction in which odometry begins.
#[test]
fn a_robot_that_begins_in_another_direction_has_the_same_visits() {
    let away = hallway([0.0, 1.0], FRAC_PI_2);
    let turned_back = hallway([-0.7, 0.0], PI);
    let back = hallway([-1.0, 0.0], PI);
    let round = [hallway([0.0, 2.0], FRAC_PI_2), hallway([0.0, 1.9], -FRAC_PI_2)];
    let maybe: Vec<_> = visit().into_iter().map(possible).collect();
    for way in [
        [visit(), vec![away.clone()]].concat(),
        [visit(), vec![back.clone()]].concat(),
        [visit()[..3].to_vec(), vec![turned_back]].concat(),
        [visit(), round.to_vec()].concat(),
        [visit()[..2].to_vec(), vec![hallway([0.7, 0.0], 0.0)]].concat(),
        [maybe.clone(), vec![away]].concat(),
        [maybe, vec![back]].concat(),
    ] {
        let seen = |turn: f64| {
            let (sine, cosine) = turn.sin_cos();
            let turned = way.iter().map(|(place, [x, y], heading)| {
                let position = [cosine * x - sine * y, sine * x + cosine * y];
                (place.clone(), position, wrapped(heading + turn))
            });
            let log = visits(&turned.collect::<Vec<_>>(), false);
            let visit = |visit: &Visit<usize>| {
                (visit.at, visit.alternatives(), visit.goes_back, visit.turned_back.clone())
            };
            (log.visits.iter().map(visit).collect::<Vec<_>>(), log.turned_back)
        };
        for turn in [0.9, 2.0, -1.2, -2.6] {
            assert_eq!(seen(turn), seen(0.0), "{turn}");
        }
    }
}

/// A false dead end seems to open to the right.
#[test]
fn a_robot_enters_a_possible_junction_by_the_door_behind_it_whatever_seems_to_be_a_door() {
    for (turn, opens) in [(0.0, -FRAC_PI_2), (0.0, FRAC_PI_2), (0.0, 0.0), (2.0, -FRAC_PI_2)] {
        let through = [0.1, 0.0];
        let doors = vec![CentreLine { through, direction: opens }];
        let view = JunctionView { doors, turning_point: through, confidence: 0.5 };
        let mut robot = Visits::by_camera(false);
        let scene = Scene { place: Place::Junction(view), marker: None };
        robot.add_frame(0, &scene, &Odometry { position: [0.0; 2], heading: turn });
        let arms = robot.status().unwrap().arms;
        assert!(wrapped(arms[0].direction - turn - PI).abs() < 1e-9, "{turn} {opens}: {arms:?}");
        assert!(arms[0].is_certain() && !arms[1].is_certain());
    }
}

#[test]
fn a_junction_that_is_seen_from_another_one_ends_the_visit_of_that() {
    // The next one is 4 m to the left, and no image shows the hallway between them.
    let next = [1.0, 3.2, 3.5, 3.8].map(|y| (junction(4.0 - y), [0.0, y], FRAC_PI_2));
    let places = [visit(), next.to_vec()].concat();
    assert_eq!(events(&places, false), (vec![Some(1), None], vec![]));
    // The same place half a metre off is no other one.
    let near = (junction(0.7), [-0.2, 0.0], 0.0);
    let away = hallway([0.0, 1.0], FRAC_PI_2);
    assert_eq!(visits(&[visit(), vec![near, away]].concat(), false).visits.len(), 1);
}

#[test]
fn a_junction_is_visited_where_its_last_image_has_it_and_has_arms_once_two_images_agree() {
    let status = |places: &[Seen]| {
        let mut robot = Visits::by_camera(false);
        for (number, (place, position, heading)) in places.iter().enumerate() {
            let scene = Scene { place: place.clone(), marker: None };
            robot.add_frame(number, &scene, &Odometry { position: *position, heading: *heading });
        }
        robot.status().map(|place| place.arms.len())
    };
    let at = |ahead: f64, x: f64| (junction(ahead), [x, 0.0], 0.0);
    assert_eq!(status(&[at(0.8, -0.8), at(0.2, -0.2)]), Some(2));
    // It is 40 cm farther on than it seemed.
    assert_eq!(status(&[at(0.8, -0.8), at(0.6, -0.2)]), None);
    assert_eq!(status(&[at(0.2, -0.2)]), Some(0));
}

/// A junction that is still ahead looks like a hallway, in which its marker is visible.
#[test]
fn the_marker_of_a_junction_ahead_is_seen_from_the_hallway_before_it() {
    let sighting = |is_before: bool| {
        let mut robot = Visits::by_camera(false);
        let marker = Some(MarkerView { position: [0.4, 0.3], axis: FRAC_PI_2, door: None });
        let ahead = (hallway([-0.6, 0.0], 0.0), marker);
        let beside = (hallway([-0.1, 0.0], 0.0), marker);
        let mut seen: Vec<_> = visit().into_iter().map(|seen| (seen, None)).collect();
        seen.insert(if is_before { 2 } else { 4 }, if is_before { ahead } else { beside });
        seen.push((hallway([0.0, 1.0], FRAC_PI_2), None));
        for (number, ((place, position, heading), marker)) in seen.into_iter().enumerate() {
            let scene = Scene { place, marker };
            robot.add_frame(number, &scene, &Odometry { position, heading });
        }
        robot.finish().visits[0].sighting
    };
    assert_eq!(sighting(true), Some(Sighting::Pointing(Door(1))));
    assert_eq!(sighting(false), Some(Sighting::Nothing));
}

#[test]
fn a_robot_that_begins_with_a_marker_has_it_along_its_entry() {
    let here = (junction(0.0), [0.0; 2], 0.0);
    let places = [here.clone(), here, hallway([-1.0, 0.0], PI)];
    assert_eq!(events(&places, true), (vec![Some(0)], vec![]));
    // Without a marker it would have to be looked at from farther off.
    assert_eq!(events(&places, false), (vec![None], vec![]));
}
