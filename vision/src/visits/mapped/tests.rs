//! Visits by places on a local map, in views that are made up.

use std::f64::consts::FRAC_PI_2;

use toposlam_model::driving::odometry::Odometry;

use super::*;
use crate::{geometry::unit, place::ViewSector, visits::VisitPercept};

/// The visits of a robot that comes from the west to a junction at the origin and leaves in a direction, where one view
/// in `every` shows arms in these directions.
fn visits(arms: &[f64], leaves: f64, every: usize) -> Vec<Visit<usize>> {
    let come = (0..24).map(|step| Point2::new(-12.0 + 0.5 * f64::from(step), 0.0));
    let leave = (0..24).map(|step| Point2::from(0.5 * f64::from(step) * unit(leaves)));
    let place = place(Point2::origin(), 1.0, arms);
    visits_by(come.chain(leave).enumerate().map(|(at, robot)| {
        (robot, if at % every == 0 { vec![place.clone()] } else { Vec::new() }, Vec::new())
    }))
}

fn place(centre: Point2<f64>, clearance: f64, arms: &[f64]) -> SeenPlace {
    let arms = arms.iter().map(|&direction| PlaceArm::certain(direction)).collect();
    SeenPlace { centre, clearance, arms }
}

/// What a robot sees: places, and others if arms in doubt are arms.
type Seen = (Point2<f64>, Vec<SeenPlace>, Vec<SeenPlace>);

/// A robot whose odometry begins with its map, and which looks ahead and to both sides.
struct Robot {
    params: LaserParams,
    odometry_from_map: Isometry2<f64>,
    sector: ViewSector,
    /// How far it sees.
    sight: f64,
}

impl Default for Robot {
    fn default() -> Self {
        let params = LaserParams::default();
        let (odometry_from_map, sector) = (Isometry2::identity(), ViewSector::ALL_AROUND);
        Self { params, odometry_from_map, sector, sight: 0.0 }
    }
}

impl Robot {
    /// A robot for which corners and dead ends are vertices.
    fn with_corners() -> Self {
        let mut robot = Self::default();
        robot.params.corner.corners = true;
        robot
    }

    fn visits(&self, views: impl Iterator<Item = Seen>) -> Vec<Visit<usize>> {
        let (log, _) = self.statuses(views);
        log.visits
    }

    /// The visits, and where the robot is at each view.
    fn statuses(
        &self,
        views: impl Iterator<Item = Seen>,
    ) -> (VisitLog<usize>, Vec<Option<SeenPlace>>) {
        let mut rule = MappedRule::new(&self.params);
        let (mut log, mut statuses) = (VisitLog::default(), Vec::new());
        for (at, (robot, places, in_doubt)) in views.enumerate() {
            let view = PlaceView {
                robot: Odometry { position: robot.into(), heading: 0.0 },
                odometry_from_map: self.odometry_from_map,
                possible_places: places.iter().cloned().chain(in_doubt).collect(),
                facts: None,
                places,
                sector: self.sector,
                width: None,
                scene: None,
            };
            rule.add_view(&mut log, at, &view, &|_, _, limit| self.sight.min(limit));
            statuses.push(rule.status());
        }
        rule.finish(&mut log);
        (log, statuses)
    }
}

fn visits_by(views: impl Iterator<Item = Seen>) -> Vec<Visit<usize>> {
    Robot::default().visits(views)
}

/// A way along these points, in steps of half a metre, on which all of these places are seen.
fn along(points: &[[f64; 2]], places: &[SeenPlace]) -> impl Iterator<Item = Seen> + use<> {
    let mut way = vec![Point2::from(points[0])];
    for leg in points.windows(2) {
        let [from, to] = [leg[0], leg[1]].map(Point2::from);
        let steps = (distance(from, to) / 0.5).round() as u32;
        way.extend((1..=steps).map(|step| from + f64::from(step) / f64::from(steps) * (to - from)));
    }
    let places = places.to_vec();
    way.into_iter().map(move |robot| (robot, places.clone(), Vec::new()))
}

fn fork_at(x: f64) -> SeenPlace {
    place(Point2::new(x, 0.0), 1.0, &[PI, FRAC_PI_2, 0.0])
}

fn percepts(visits: &[Visit<usize>]) -> Vec<(u32, Option<u32>)> {
    visits.iter().map(|visit| (visit.percept().degree, visit.percept().door)).collect()
}

/// A way from the west to the east through the origin, in steps of half a metre.
fn eastwards() -> impl Iterator<Item = Point2<f64>> {
    (-24..24).map(|step| Point2::new(0.5 * f64::from(step), 0.0))
}

/// The views of the way to it show that it may be a junction, and some or all of the later ones that it is one.
#[test]
fn a_junction_that_is_certain_only_once_the_robot_has_left_it_is_a_possible_visit() {
    let fork = place(Point2::origin(), 1.0, &[PI, FRAC_PI_2, 0.0]);
    for every in 1..4 {
        let views = eastwards().enumerate().map(|(number, robot)| {
            let is_certain = robot.x > 1.6 && number % every == 0;
            let (certain, possible) = if is_certain { (1, 0) } else { (0, 1) };
            (robot, vec![fork.clone(); certain], vec![fork.clone(); possible])
        });
        let visits = visits_by(views);
        let [visit] = &visits[..] else { panic!("{every}: {visits:?}") };
        let straight_on = Some(VisitPercept { degree: 3, door: Some(2) });
        assert_eq!(visit.alternatives(), [None, straight_on], "{every}");
    }
}

#[test]
fn an_arm_in_some_of_the_views_is_possible() {
    let fork = [PI, FRAC_PI_2, 0.0];
    let seen = |every| {
        let visits = visits(&fork, 0.0, every);
        visits.iter().map(Visit::alternatives).collect::<Vec<_>>()
    };
    // Clockwise from the west, the north is door 1.
    let straight_on = Some(VisitPercept { degree: 3, door: Some(2) });
    assert_eq!(seen(1), [vec![straight_on]]);
    assert_eq!(seen(3), [vec![None, straight_on]], "in a third of the views");
    assert!(seen(100).is_empty());
}

#[test]
fn arms_in_doubt_are_possible_beside_one_that_is_in_some_of_the_views() {
    let fork = place(Point2::origin(), 1.0, &[PI, FRAC_PI_2, 0.0]);
    let cross = place(Point2::origin(), 1.0, &[PI, FRAC_PI_2, 0.0, -FRAC_PI_2]);
    let views = eastwards().enumerate().map(|(at, robot)| {
        let seen = usize::from(at % 3 == 0);
        (robot, vec![fork.clone(); seen], vec![cross.clone(); 1 - seen])
    });
    let visits = visits_by(views);
    let [visit] = &visits[..] else { panic!("{visits:?}") };
    let percept = |degree, door| Some(VisitPercept { degree, door: Some(door) });
    // Clockwise from the west, the north is door 1, and the south is the last one.
    assert_eq!(visit.alternatives(), [None, percept(3, 1), percept(3, 2), percept(4, 2)]);
}

#[test]
fn a_junction_that_earlier_views_show_beside_its_place_is_visited_where_the_last_ones_do() {
    let arms = [PI, FRAC_PI_2, 0.0, -FRAC_PI_2];
    let [astray, cross] =
        [[-0.9, -0.9], [0.5, 0.6]].map(|[x, y]| place(Point2::new(x, y), 1.5, &arms));
    // The robot turns to the right. It comes into the former first, which is seen up to here, and leaves it last.
    let visits = |seen_until: f64, rounds: usize| {
        let way = along(&[[-12.0, 0.0], [0.0, 0.0], [0.0, -12.0]], &[]);
        let views = way.map(|(robot, ..)| {
            let seen = if (-5.0..seen_until).contains(&robot.x) { &astray } else { &cross };
            (robot, vec![seen.clone()], Vec::new())
        });
        let mut robot = Robot::default();
        robot.params.visit.views = 40;
        robot.params.matching.rounds = rounds;
        robot.visits(views)
    };
    let [visit] = &visits(-4.0, 0)[..] else { panic!() };
    assert_eq!(visit.alternatives(), [Some(VisitPercept { degree: 4, door: Some(3) })]);
    assert!(distance(visit.centre, cross.centre) < 1e-9, "{}", visit.centre);
    // Where scans are matched, a place stays where it is.
    for (rounds, centre) in [(0, cross.centre), (8, astray.centre)] {
        let first = visits(-2.0, rounds)[0].centre;
        assert!(distance(first, centre) < 1e-9, "{rounds} {first}");
    }
}

#[test]
fn a_robot_that_leaves_by_an_arm_beside_its_own_has_not_turned_back() {
    let beside = PI - 0.75;
    let went_back = |leaves| {
        let visits = visits(&[PI, beside, 0.0], leaves, 1);
        visits.iter().map(|visit| visit.goes_back).collect::<Vec<_>>()
    };
    assert_eq!(went_back(PI), [true]);
    assert_eq!(went_back(beside), [false]);
    assert_eq!(went_back(0.0), [false]);
}

#[test]
fn a_robot_that_passes_beside_the_centre_of_a_place_has_not_gone_back() {
    // Seen from the centre it came from the south and left to the south, 3 m farther on.
    let lobby = place(Point2::new(0.0, 5.0), 5.15, &[-FRAC_PI_2, FRAC_PI_2, 0.0]);
    let visits = visits_by(eastwards().map(|robot| (robot, vec![lobby.clone()], Vec::new())));
    let [visit] = &visits[..] else { panic!("{visits:?}") };
    assert!(!visit.goes_back);
    assert_eq!(visit.alternatives(), [], "by which doors it went is not known");
}

#[test]
fn a_possible_junction_that_is_noticed_late_was_entered_where_the_robot_came_from() {
    let fork = place(Point2::origin(), 1.0, &[PI, FRAC_PI_2, 0.0, -FRAC_PI_2]);
    let late = |robot: Point2<f64>| {
        let is_noticed = robot.x > 3.0;
        (robot, Vec::new(), if is_noticed { vec![fork.clone()] } else { Vec::new() })
    };
    let visits = visits_by(eastwards().map(late));
    let [visit] = &visits[..] else { panic!("{visits:?}") };
    assert!(!visit.goes_back);
    // It drove two of the arms.
    assert_eq!(visit.doors(), [PI, 0.0]);
    let percept = |degree, door| Some(VisitPercept { degree, door: Some(door) });
    assert_eq!(visit.alternatives(), [None, percept(3, 1), percept(3, 2), percept(4, 2)]);
}

#[test]
fn a_visit_is_in_the_frame_of_odometry() {
    let odometry_from_map = Isometry2::new(nalgebra::Vector2::new(3.0, -2.0), 0.7);
    let robot = Robot { odometry_from_map, ..Robot::default() };
    let visits = robot.visits(along(&[[-12.0, 0.0], [12.0, 0.0]], &[fork_at(0.0)]));
    let [visit] = &visits[..] else { panic!("{visits:?}") };
    assert!(distance(visit.centre, [3.0, -2.0]) < 1e-9, "{visit:?}");
    let directions = [PI, FRAC_PI_2, 0.0].map(|direction| wrapped(direction + 0.7));
    let seen = visit.doors().into_iter().chain(visit.came).chain([visit.exit.unwrap().direction]);
    for (seen, expected) in seen.zip(directions.into_iter().chain([directions[0], directions[2]])) {
        assert!(wrapped(seen - expected).abs() < 1e-9, "{visit:?}");
    }
    assert_eq!(percepts(&visits), [(3, Some(2))]);
}

#[test]
fn a_robot_that_goes_back_to_a_junction_has_turned_back_unless_it_turned_twice() {
    let turned = |way: &[f64]| {
        let way: Vec<_> = way.iter().map(|&x| [x, 0.0]).collect();
        let visits = visits_by(along(&way, &[fork_at(0.0), fork_at(20.0)]));
        visits.iter().map(|visit| (visit.centre.x, visit.turned_back.len())).collect::<Vec<_>>()
    };
    assert_eq!(turned(&[-12.0, 32.0]), [(0.0, 0), (20.0, 0)]);
    assert_eq!(turned(&[-12.0, 8.0, -12.0]), [(0.0, 0), (0.0, 1)]);
    assert_eq!(turned(&[-12.0, 10.0, 5.0, 32.0]), [(0.0, 0), (20.0, 0)]);
    assert_eq!(turned(&[-12.0, 10.0, 5.0, 12.0, -12.0]), [(0.0, 0), (0.0, 1)]);
    // Manoeuvring is no turning back.
    assert_eq!(turned(&[-12.0, 8.0, 7.0, 32.0]), [(0.0, 0), (20.0, 0)]);
}

#[test]
fn a_robot_that_begins_at_a_junction_has_its_back_to_where_it_came_from() {
    let fork = [fork_at(0.0)];
    let north = visits_by(along(&[[0.0, 0.0], [0.0, 12.0]], &fork));
    assert_eq!(percepts(&north), [(3, Some(1))]);
    let east = visits_by(along(&[[0.0, 0.0], [12.0, 0.0]], &fork));
    assert_eq!(percepts(&east), [(3, Some(2))]);
    // Its log ends at the second junction, which is visited once.
    let both = [fork_at(0.0), fork_at(20.0)];
    let visits = visits_by(along(&[[0.0, 0.0], [20.0, 0.0]], &both));
    assert_eq!(percepts(&visits), [(3, Some(2)), (3, None)]);
}

#[test]
fn a_dead_end_is_visited_by_a_robot_that_turns_back_there() {
    let end = place(Point2::new(10.0, 0.0), 1.0, &[PI]);
    let places = [fork_at(0.0), end];
    let there = along(&[[-12.0, 0.0], [8.5, 0.0], [-12.0, 0.0]], &places);
    let visits = Robot::with_corners().visits(there);
    assert_eq!(percepts(&visits), [(3, Some(2)), (1, Some(0)), (3, Some(1))], "{visits:?}");
    assert!(visits.iter().all(|visit| visit.turned_back.is_empty()));
    assert!(visits[1].goes_back && !visits[0].goes_back && !visits[2].goes_back);
    // Farther away it turns back in the corridor.
    let before = along(&[[-12.0, 0.0], [6.0, 0.0], [-12.0, 0.0]], &places);
    let visits = Robot::with_corners().visits(before);
    assert_eq!(percepts(&visits), [(3, Some(2)), (3, Some(1))]);
    assert_eq!(visits[1].turned_back.len(), 1);
}

#[test]
fn a_robot_that_turns_in_a_corner_visits_it_and_a_corridor_may_go_straight_on_there() {
    let corner = [[-12.0, 0.0], [0.0, 0.0], [0.0, 12.0]];
    let visits = Robot::with_corners().visits(along(&corner, &[]));
    assert_eq!(percepts(&visits), [(2, Some(1))]);
    assert!(distance(visits[0].centre, [0.0; 2]) < 0.6 && visits[0].doubt.is_none());
    // Where it sees far, from the west to the east and from the north to the south.
    let seen = Robot { sight: f64::INFINITY, ..Robot::with_corners() };
    let visits = seen.visits(along(&corner, &[]));
    let percept = |degree, door| Some(VisitPercept { degree, door: Some(door) });
    let all = [percept(2, 1), percept(3, 1), percept(4, 1)];
    assert_eq!(visits[0].alternatives(), all);
    let arms = visits[0].arms.iter().map(|arm| arm.direction.to_degrees().round().abs());
    assert_eq!(arms.collect::<Vec<_>>(), [180.0, 90.0, 0.0, 90.0]);
    assert_eq!(visits[0].doubt, Some(UndecidedCause::Unclear));
    // Bends are no vertices, or the way to it is too short.
    assert!(visits_by(along(&corner, &[])).is_empty());
    let short = [[-3.0, 0.0], [0.0, 0.0], [0.0, 12.0]];
    assert!(Robot::with_corners().visits(along(&short, &[])).is_empty());
    // At a junction it is that of the junction.
    let visits = Robot::with_corners().visits(along(&corner, &[fork_at(0.0)]));
    assert_eq!(percepts(&visits), [(3, Some(1))]);
}

#[test]
fn where_the_scanner_does_not_look_a_way_is_undecided() {
    let sector = ViewSector { first: -FRAC_PI_2, angle: PI };
    let robot = Robot { sector, ..Robot::default() };
    let visits = robot.visits(along(&[[0.0, 0.0], [-5.0, 0.0]], &[]));
    let [visit] = &visits[..] else { panic!("{visits:?}") };
    assert_eq!(visit.doubt, Some(UndecidedCause::UnseenWay));
    assert!(visit.alternatives().is_empty());
    assert!(robot.visits(along(&[[0.0, 0.0], [5.0, 0.0]], &[])).is_empty());
}

#[test]
fn a_robot_is_at_a_junction_from_its_walls_on() {
    let views = along(&[[-6.0, 0.0], [6.0, 0.0]], &[fork_at(0.0)]);
    let (_, statuses) = Robot::default().statuses(views);
    let at: Vec<f64> = (-12..)
        .map(|step| 0.5 * f64::from(step))
        .zip(&statuses)
        .filter(|(_, status)| status.is_some())
        .map(|(x, _)| x)
        .collect();
    assert_eq!((at[0], at[at.len() - 1]), (-0.5, 1.0), "{at:?}");
    let here = statuses.iter().flatten().last().unwrap();
    assert_eq!((here.centre, here.arms.len()), (Point2::origin(), 3));
}

#[test]
fn a_junction_far_along_a_bent_way_is_entered_from_where_the_robot_came() {
    let north = place(Point2::new(0.0, 20.0), 1.0, &[-FRAC_PI_2, FRAC_PI_2, 0.0]);
    let way = along(&[[-12.0, 0.0], [0.0, 0.0], [0.0, 32.0]], &[fork_at(0.0), north]);
    let visits = visits_by(way);
    assert_eq!(percepts(&visits), [(3, Some(1)), (3, Some(1))]);
    assert_eq!(visits[1].entry(), Some(-FRAC_PI_2));
}

#[test]
fn an_arm_that_shows_only_behind_a_junction_is_one_of_its_arms() {
    let straight = place(Point2::origin(), 1.0, &[PI, 0.0]);
    let views = eastwards().map(|robot| {
        let seen = if robot.x < 1.6 { straight.clone() } else { fork_at(0.0) };
        (robot, vec![seen], Vec::new())
    });
    let visits = visits_by(views);
    assert_eq!(percepts(&visits), [(3, Some(2))]);
    assert_eq!(visits[0].doubt, None);
}

#[test]
fn a_way_that_goes_straight_on_is_no_vertex_and_turning_back_there_is_turning_back() {
    let straight = place(Point2::new(10.0, 0.0), 1.0, &[PI, 0.0]);
    let alone = along(&[[-2.0, 0.0], [22.0, 0.0]], std::slice::from_ref(&straight));
    assert!(visits_by(alone).is_empty());
    let places = [fork_at(0.0), straight];
    // Within it, behind it, and so near to the fork that it is noticed only there.
    for turn in [10.0, 16.0, 2.0] {
        let way = along(&[[-12.0, 0.0], [turn, 0.0], [-12.0, 0.0]], &places);
        let visits = visits_by(way);
        let turned: Vec<_> =
            visits.iter().map(|visit| (visit.centre.x, visit.turned_back.len())).collect();
        assert_eq!(turned, [(0.0, 0), (0.0, 1)], "{turn}");
    }
    // Twice, once within it.
    let way = [[-12.0, 0.0], [16.0, 0.0], [10.0, 0.0], [32.0, 0.0]];
    let visits = visits_by(along(&way, &[places[0].clone(), places[1].clone(), fork_at(24.0)]));
    assert_eq!(percepts(&visits), [(3, Some(2)), (3, Some(2))]);
    assert!(visits[1].turned_back.is_empty());
}

#[test]
fn a_corner_is_visited_where_a_log_ends_in_it_or_the_robot_turns_back() {
    let corner = place(Point2::new(10.0, 0.0), 1.0, &[PI, FRAC_PI_2]);
    let straight = place(Point2::new(10.0, 0.0), 1.0, &[PI, 0.0]);
    let visits = |way: &[[f64; 2]], place: &SeenPlace| {
        percepts(&Robot::with_corners().visits(along(way, std::slice::from_ref(place))))
    };
    let [begin, middle, end] = [[-2.0, 0.0], [10.0, 0.0], [10.0, 12.0]];
    assert_eq!(visits(&[begin, middle], &corner), [(2, None)]);
    assert_eq!(visits(&[begin, middle], &straight), []);
    assert_eq!(visits(&[begin, middle, begin], &corner), [(2, Some(0))]);
    // What it passes is visited once.
    assert_eq!(visits(&[begin, middle, end], &corner), [(2, Some(1))]);
    assert!(visits_by(along(&[begin, middle], &[corner])).is_empty());
}

#[test]
fn a_bend_within_a_junction_is_that_of_the_junction_and_one_far_from_it_is_a_corner() {
    let lobby = place(Point2::origin(), 5.0, &[PI, FRAC_PI_2, 0.0]);
    let robot = Robot::with_corners();
    let within = robot.visits(along(&[[-16.0, 0.0], [0.0, 0.0], [0.0, 16.0]], &[lobby]));
    assert_eq!(percepts(&within), [(3, Some(1))]);
    let after = [[-12.0, 0.0], [12.0, 0.0], [12.0, 12.0]];
    let visits = robot.visits(along(&after, &[fork_at(0.0)]));
    assert_eq!(percepts(&visits), [(3, Some(2)), (2, Some(1))]);
}
