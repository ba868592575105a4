use std::f64::consts::{FRAC_PI_2, FRAC_PI_6};

use super::{
    PathState::{Hallway, Junction, Leaving, Unknown},
    *,
};
use crate::driving::scene::{MarkerView, Reason, Unclear};
use crate::percept::Sighting;

/// A path of one door: the robot takes it, and stops at the junction to which it leads.
const NEXT: &[Door] = &[Door(2)];
/// The doors of the six forms, as a robot sees them that looks away from the entry door.
const DEAD_END: &[f64] = &[PI];
const L_LEFT: &[f64] = &[PI, FRAC_PI_2];
const L_RIGHT: &[f64] = &[PI, -FRAC_PI_2];
const T_STEM: &[f64] = &[PI, FRAC_PI_2, -FRAC_PI_2];
const T_LEFT: &[f64] = &[PI, FRAC_PI_2, 0.0];
const T_RIGHT: &[f64] = &[PI, 0.0, -FRAC_PI_2];

/// A robot that executes commands, with perfect odometry.
struct Robot<'a> {
    path: PathExecution<'a>,
    odometry: Odometry,
}

impl<'a> Robot<'a> {
    /// At the turning point of a junction, its back to the entry door.
    fn at(doors: &[f64], queue: &'a [Door]) -> Self {
        let shape = JunctionShape::from_view(&view(doors, 0.0, 0.0)).unwrap();
        let percept = Percept { degree: shape.degree(), sighting: Sighting::Nothing };
        let from = JunctionState { shape, percept, entry: PI };
        Self { path: PathExecution::new(queue, &from), odometry: Odometry::default() }
    }

    /// Half a metre after it left a junction, straight ahead.
    fn leaving(queue: &'a [Door]) -> Self {
        let mut robot = Self::at(T_LEFT, queue);
        assert_eq!(robot.sees(&junction(T_LEFT, 0.0, 0.0)), ahead(UNIT));
        robot
    }

    /// A metre after it left a junction, in the hallway.
    fn in_hallway(queue: &'a [Door]) -> Self {
        let mut robot = Self::leaving(queue);
        assert_eq!(robot.sees(&hallway(0.0)), ahead(UNIT));
        robot
    }

    /// In front of a junction that one image has shown, half a metre before its turning point.
    fn before(doors: &[f64], queue: &'a [Door]) -> Self {
        let mut robot = Self::in_hallway(queue);
        assert_eq!(robot.sees(&junction(doors, 0.75, 0.0)), ahead(UNIT / 2.0));
        robot
    }

    /// At the turning point of the next junction, which two images have shown.
    fn come_to(doors: &[f64], queue: &'a [Door]) -> Self {
        let mut robot = Self::before(doors, queue);
        robot.sees(&junction(doors, 0.5, 0.0));
        robot.sees(&junction(doors, 0.25, 0.0));
        robot
    }

    fn round(&mut self, scene: &Scene) -> Result<Step, Lost> {
        self.path.round(scene, self.odometry)
    }

    /// Sees a scene and executes this share of the command.
    fn sees_and_does(&mut self, share: f64, scene: &Scene) -> Command {
        let step = self.round(scene);
        let Ok(Step::Go(command)) = step else { panic!("it goes on, and not: {step:?}") };
        self.odometry = self.odometry.moved(command.turn * share, command.forward * share);
        command
    }

    fn sees(&mut self, scene: &Scene) -> Command {
        self.sees_and_does(1.0, scene)
    }

    /// Sees a scene, and executes a command with this turn and this way, in this state.
    #[track_caller]
    fn goes(&mut self, scene: &Scene, turn: f64, forward: f64, state: PathState) {
        let command = self.sees(scene);
        assert_near(command.turn, turn);
        assert_near(command.forward, forward);
        assert_eq!(self.path.state(), state);
    }

    fn arrives(&mut self, scene: &Scene) -> JunctionState {
        let step = self.round(scene);
        let Ok(Step::Arrived(state)) = step else { panic!("it arrives, and not: {step:?}") };
        state
    }

    fn gives_up(&mut self, scene: &Scene) -> LostReason {
        self.round(scene).expect_err("it gives up").why
    }

    /// Drives on by the same scene until it gives up. Returns the number of commands and the reason.
    fn drives_on(&mut self, share: f64, scene: &Scene) -> (usize, LostReason) {
        for commands in 0..1000 {
            match self.round(scene) {
                Ok(Step::Go(Command { turn, forward })) => {
                    self.odometry = self.odometry.moved(turn * share, forward * share);
                }
                Ok(Step::Arrived(_)) => break,
                Err(Lost { why, .. }) => return (commands, why),
            }
        }
        panic!("it does not give up");
    }
}

fn ahead(forward: f64) -> Command {
    Command { turn: 0.0, forward }
}

/// A junction with its turning point this far ahead of a robot, which then turns by this angle.
fn view(doors: &[f64], distance: f64, turned: f64) -> JunctionView {
    let through = [distance * turned.cos(), -distance * turned.sin()];
    let door = |&door: &f64| CentreLine { through, direction: wrapped(door - turned) };
    let doors = doors.iter().map(door).collect();
    JunctionView { doors, turning_point: through, confidence: 1.0 }
}

fn scene(place: Place) -> Scene {
    Scene { place, marker: None }
}

fn junction(doors: &[f64], distance: f64, turned: f64) -> Scene {
    scene(Place::Junction(view(doors, distance, turned)))
}

fn hallway_of(heading: f64, [left, right]: [f64; 2], status: HallwayStatus) -> Scene {
    scene(Place::Hallway(HallwayView { heading, left, right, status, confidence: 1.0 }))
}

fn hallway(heading: f64) -> Scene {
    hallway_of(heading, [0.8, 0.8], HallwayStatus::Clear)
}

fn unknown() -> Scene {
    scene(Place::Unknown(Reason::NothingFits))
}

#[track_caller]
fn assert_near(one: f64, other: f64) {
    assert!((one - other).abs() < 1e-9, "{one} is not {other}");
}

// paper: alg2.1, drive.path
#[test]
fn a_path_begins_as_leaving_with_all_of_its_doors() {
    let queue = [Door(2), Door(1)];
    let robot = Robot::at(T_LEFT, &queue);
    assert_eq!((robot.path.state(), robot.path.queue()), (Leaving, &queue[..]));
}

// paper: alg2.2, alg2.7, alg2.8, alg2.11, alg2.12, drive.clear
// paper: alg2.13, alg2.14, drive.unclear
#[test]
fn in_a_hallway_the_robot_goes_half_a_metre_if_it_is_clear_and_else_half_as_far() {
    for (status, forward) in [
        (HallwayStatus::Clear, 0.5),
        (HallwayStatus::Unclear(Unclear::ClustersAhead), 0.25),
        (HallwayStatus::Unclear(Unclear::SizesDiffer), 0.25),
        (HallwayStatus::Unclear(Unclear::ClusterBehind), 0.25),
    ] {
        let scene = hallway_of(0.0, [0.8, 0.8], status);
        Robot::leaving(NEXT).goes(&scene, 0.0, forward, Hallway);
    }
}

// paper: alg2.9, drive.align
#[test]
fn it_turns_to_the_direction_of_the_hallway_that_leads_onwards() {
    for heading in [0.3, -0.3, 0.78, -0.78] {
        assert_near(Robot::leaving(NEXT).sees(&hallway(heading)).turn, heading);
    }
    let mut robot = Robot::leaving(NEXT);
    robot.odometry.heading = 1.8;
    let off_centre = hallway_of(PI - 1.8, [1.1, 0.5], HallwayStatus::Clear);
    // What lies to the left of a robot that looks back lies to the right onwards.
    assert_near(robot.sees(&off_centre).turn, -1.8 - PI / 8.0);
    // More than 45 degrees against odometry.
    for heading in [0.80, -0.80] {
        let why = Robot::leaving(NEXT).gives_up(&hallway(heading));
        let LostReason::Turned { degrees } = why else { panic!("{why}") };
        assert!((degrees - 45.8).abs() < 0.1, "{why}");
    }
}

// paper: alg2.10, drive.centre
#[test]
fn too_close_to_one_side_it_turns_towards_the_centre_line() {
    for (sides, turn) in [
        ([0.95, 0.65], 0.15_f64.atan2(0.5)),
        ([0.65, 0.95], -0.15_f64.atan2(0.5)),
        ([0.4, 1.2], -PI / 8.0),
        ([0.85, 0.75], 0.0),
    ] {
        let scene = hallway_of(0.1, sides, HallwayStatus::Clear);
        assert_near(Robot::leaving(NEXT).sees(&scene).turn, 0.1 + turn);
    }
}

// paper: alg2.15, alg2.16, alg2.17, alg2.18, alg2.19, drive.before
#[test]
fn before_the_turning_point_it_goes_towards_the_crossing_by_at_most_half_a_unit() {
    for (turning_point, turn, forward) in [
        ([0.6, 0.2], 0.2_f64.atan2(0.6), 0.25),
        ([0.15, 0.0], 0.0, 0.15),
        // A crossing far aside is not aimed at.
        ([0.2, 0.5], 0.0, 0.2),
    ] {
        let view = JunctionView { turning_point, ..view(L_LEFT, 0.0, 0.0) };
        Robot::in_hallway(NEXT).goes(&scene(Place::Junction(view)), turn, forward, Junction);
    }
}

#[test]
fn a_junction_that_is_only_possible_counts_once_it_is_decided() {
    let possible = |distance| {
        let view = JunctionView { confidence: 0.5, ..view(L_LEFT, distance, 0.0) };
        scene(Place::Junction(view))
    };
    // Furniture in a hallway: the robot goes on slowly, as if it saw nothing, and gives up in the end.
    let mut robot = Robot::in_hallway(NEXT);
    robot.goes(&possible(0.6), 0.0, UNIT / 3.0, Hallway);
    let (_, why) = robot.drives_on(1.0, &possible(0.0));
    assert!(matches!(why, LostReason::Unknown { .. }), "{why}");
    let state = Robot::come_to(L_LEFT, NEXT).arrives(&possible(0.0));
    assert_eq!(Some(state.shape), JunctionShape::from_view(&view(L_LEFT, 0.0, 0.0)));
}

// paper: alg2.20, alg2.21, alg2.22
#[test]
fn at_the_turning_point_with_no_door_left_the_path_is_done() {
    for (doors, degree) in
        [(DEAD_END, 1), (L_LEFT, 2), (L_RIGHT, 2), (T_STEM, 3), (T_LEFT, 3), (T_RIGHT, 3)]
    {
        for distance in [0.05, 0.0, -0.2] {
            let state = Robot::come_to(doors, NEXT).arrives(&junction(doors, distance, 0.0));
            assert_eq!(Some(state.shape), JunctionShape::from_view(&view(doors, 0.0, 0.0)));
            assert_eq!(state.percept, Percept { degree, sighting: Sighting::Nothing });
            assert_near(state.entry.abs(), PI);
        }
    }
}

// paper: alg2.23, alg2.24, alg2.25, alg2.26, drive.turn
#[test]
fn with_a_door_left_it_turns_to_it_and_goes_half_a_metre_out_of_the_junction() {
    let queue = [Door(2), Door(1), Door(0)];
    for (doors, turn) in [(L_LEFT, FRAC_PI_2), (L_RIGHT, -FRAC_PI_2), (T_STEM, FRAC_PI_2)] {
        let mut robot = Robot::come_to(doors, &queue);
        robot.goes(&junction(doors, 0.0, 0.0), turn, 0.0, Junction);
        assert_eq!(robot.path.queue(), &queue[2..], "the door is taken from the queue, once");
        robot.goes(&junction(doors, 0.0, turn), 0.0, 0.5, Leaving);
        assert_eq!(robot.path.queue(), &queue[2..]);
        // The next junction takes the next door.
        robot.goes(&hallway(0.0), 0.0, 0.5, Hallway);
        robot.sees(&junction(T_LEFT, 0.25, 0.0));
        assert_near(robot.sees(&junction(T_LEFT, 0.0, 0.0)).turn.abs(), PI);
        assert_eq!(robot.path.queue(), []);
    }
}

#[test]
fn while_it_turns_to_a_door_the_turning_point_does_not_matter() {
    let mut robot = Robot::come_to(T_STEM, &[Door(2), Door(1)]);
    robot.sees(&junction(T_STEM, 0.0, 0.0));
    let view = JunctionView { turning_point: [0.0, -0.2], ..view(T_STEM, 0.0, FRAC_PI_2) };
    assert_eq!(view.turning(), Turning::Before);
    assert_eq!(robot.sees(&scene(Place::Junction(view))), ahead(0.5));
}

#[test]
fn a_door_straight_ahead_takes_no_turn() {
    let mut robot = Robot::come_to(T_RIGHT, &[Door(2), Door(1)]);
    robot.goes(&junction(T_RIGHT, 0.0, 0.1), -0.1, 0.5, Leaving);
}

#[test]
fn after_a_turn_an_image_must_show_the_doors_turned_before_it_leaves() {
    let left = FRAC_PI_2;
    // A junction that is not turned, or has another shape, or is none, is ignored.
    for other in [
        junction(T_STEM, 0.0, 0.0),
        junction(L_LEFT, 0.0, left),
        hallway(0.0),
        hallway(FRAC_PI_2),
        unknown(),
    ] {
        let mut robot = Robot::come_to(T_STEM, &[Door(2), Door(1), Door(0)]);
        robot.sees(&junction(T_STEM, 0.0, 0.0));
        robot.goes(&other, FRAC_PI_6 / 3.0, 0.0, Unknown);
        let now = robot.odometry.heading;
        assert_near(robot.sees(&junction(T_STEM, 0.0, now)).forward, 0.5);
    }
    // Turned too little, it turns on.
    let mut robot = Robot::come_to(T_STEM, &[Door(2), Door(1), Door(0)]);
    robot.sees_and_does(0.6, &junction(T_STEM, 0.0, 0.0));
    robot.goes(&junction(T_STEM, 0.0, 0.6 * left), 0.4 * left, 0.0, Junction);
}

#[test]
fn the_entry_door_is_carried_by_odometry_while_the_robot_turns() {
    let mut robot = Robot::come_to(T_STEM, &[Door(2), Door(1), Door(0)]);
    robot.sees(&junction(T_STEM, 0.0, 0.0));
    // Turned to the left, the door behind is the one on the other side of the stem.
    let listed = view(T_STEM, 0.0, FRAC_PI_2).entered_from(PI);
    assert_near(listed.doors[0].direction.abs(), PI);
    assert_eq!(robot.sees(&scene(Place::Junction(listed))), ahead(0.5));
}

#[test]
fn the_entry_door_is_the_one_behind_on_arrival() {
    // By its image alone this T could have been entered by any of its doors.
    for first in 0..3 {
        let mut view = view(T_STEM, 0.05, 0.0);
        view.doors.rotate_left(first);
        let state = Robot::before(T_STEM, NEXT).arrives(&scene(Place::Junction(view)));
        assert_eq!(state.shape, JunctionShape([true, true, false, true]));
        assert_near(state.entry.abs(), PI);
    }
    // Images show its direction better than odometry.
    let state = Robot::before(T_STEM, NEXT).arrives(&junction(T_STEM, 0.05, 0.2));
    assert_near(state.entry, PI - 0.2);
}

#[test]
fn a_marker_seen_from_the_hallway_lies_at_the_next_junction() {
    let mut robot = Robot::in_hallway(NEXT);
    let marker = Some(MarkerView { position: [0.6, 0.0], axis: 0.0, door: None });
    robot.sees(&Scene { marker, ..hallway(0.0) });
    robot.sees(&junction(L_LEFT, 0.1, 0.0));
    let JunctionState { percept, .. } = robot.arrives(&junction(L_LEFT, 0.1, 0.0));
    assert_eq!(percept, Percept { degree: 2, sighting: Sighting::Pointing(Door::BACK) });
}

#[test]
fn a_junction_without_a_door_behind_is_ignored() {
    let crosswise = [FRAC_PI_2, -FRAC_PI_2];
    let command = Robot::in_hallway(NEXT).sees(&junction(&crosswise, 0.5, 0.0));
    assert_eq!(command, ahead(UNIT / 3.0));
}

#[test]
fn out_of_a_junction_it_goes_along_the_centre_line_of_the_door() {
    let mut robot = Robot::leaving(NEXT);
    for way in [0.5, 0.75, 1.0, 1.25, 1.5] {
        robot.goes(&junction(T_LEFT, -way, 0.0), 0.0, UNIT / 2.0, Leaving);
    }
    let mut aside = view(T_LEFT, -0.5, -0.1);
    for line in &mut aside.doors {
        line.through = [-0.5, 0.1];
    }
    let left = 0.1 * 0.1_f64.cos() + 0.5 * 0.1_f64.sin();
    let turn = Robot::leaving(NEXT).sees(&scene(Place::Junction(aside))).turn;
    assert_near(turn, 0.1 + left.atan2(0.5));
    // It is ignored without the door that was taken.
    Robot::leaving(NEXT).goes(&junction(T_STEM, -0.5, 0.0), 0.0, UNIT / 3.0, Leaving);
}

#[test]
fn arrival_takes_a_hallway_in_between_or_a_metre_and_20() {
    // The turning point seems to be ahead still: it is that of the junction just left.
    let mut robot = Robot::leaving(NEXT);
    for _ in 0..3 {
        robot.sees(&junction(T_LEFT, 0.2, 0.0));
        assert_eq!(robot.path.state(), Leaving);
    }
    assert_near(robot.odometry.position[0], 1.25);
    robot.sees(&junction(T_LEFT, 0.2, 0.0));
    assert_eq!(robot.path.state(), Junction, "after more than 1.2 m");

    let mut robot = Robot::leaving(NEXT);
    robot.sees(&hallway_of(0.0, [0.8, 0.8], HallwayStatus::Unclear(Unclear::ClustersAhead)));
    robot.sees(&junction(T_LEFT, 0.2, 0.0));
    assert_eq!(robot.path.state(), Junction, "after a hallway");
}

#[test]
fn the_junction_just_left_is_no_arrival() {
    // Though a hallway was seen.
    let mut robot = Robot::in_hallway(NEXT);
    robot.sees(&junction(T_LEFT, -1.0, 0.0));
    assert_eq!(robot.path.state(), Leaving);
    // Nor if one image has shown a junction ahead where there is none.
    let mut robot = Robot::in_hallway(NEXT);
    robot.sees(&junction(L_LEFT, 0.05, 0.0));
    for _ in 0..4 {
        let way = robot.odometry.position[0];
        robot.goes(&junction(T_LEFT, -way, 0.0), 0.0, UNIT / 2.0, Leaving);
    }
    // Nor if the robot could not leave it, and an image is mistaken for one of a hallway.
    let mut robot = Robot::at(T_LEFT, NEXT);
    robot.sees_and_does(0.0, &junction(T_LEFT, 0.0, 0.0));
    robot.sees_and_does(0.0, &hallway(0.0));
    robot.goes(&junction(T_LEFT, 0.0, 0.0), 0.0, UNIT / 2.0, Leaving);
}

#[test]
fn a_junction_that_was_passed_is_not_the_one_just_left() {
    let mut robot = Robot::in_hallway(NEXT);
    for _ in 0..4 {
        robot.sees(&hallway(0.0));
    }
    // It is the next one, 3.3 m after the last, and the robot is 3 m after it: another image.
    robot.goes(&junction(L_LEFT, -0.3, 0.0), 0.0, 0.0, Junction);
}

#[test]
fn a_junction_is_decided_by_two_images() {
    let here = junction(T_STEM, 0.0, 0.0);
    let mut robot = Robot::in_hallway(NEXT);
    assert_eq!(robot.sees(&here), Command::default(), "another image from the same place");
    assert_eq!(robot.arrives(&here).shape, JunctionShape([true, true, false, true]));

    let mut robot = Robot::in_hallway(&[Door(2), Door(1)]);
    assert_eq!(robot.sees(&here), Command::default());
    assert_eq!(robot.path.queue(), [Door(1)], "no door is taken at one that is not decided");
    assert_near(robot.sees(&here).turn, FRAC_PI_2);
    assert_eq!(robot.path.queue(), []);

    // After the last one was left, it takes two again.
    let mut robot = Robot::come_to(T_RIGHT, &[Door(2), Door(1)]);
    robot.sees(&junction(T_RIGHT, 0.0, 0.0));
    robot.sees(&hallway(0.0));
    assert_eq!(robot.sees(&junction(T_RIGHT, 0.0, 0.0)), Command::default());
    robot.arrives(&junction(T_RIGHT, 0.0, 0.0));
}

#[test]
fn doors_are_not_counted_in_an_image_of_another_junction() {
    let mut robot = Robot::come_to(L_RIGHT, &[Door(2), Door(1)]);
    // Door 1 would be straight ahead.
    assert_eq!(robot.sees(&junction(T_RIGHT, 0.0, 0.0)), Command::default());
    assert_eq!(robot.path.queue(), [Door(1)]);
    assert_near(robot.sees(&junction(L_RIGHT, 0.0, 0.0)).turn, -FRAC_PI_2);

    // A junction that is known is not decided again.
    let mut robot = Robot::at(L_LEFT, &[Door(1)]);
    for _ in 0..3 {
        robot.sees(&junction(T_LEFT, 0.0, robot.odometry.heading));
        assert_eq!(robot.path.state(), Unknown);
    }
    assert_eq!(robot.path.queue(), [Door(1)]);
    assert_near(robot.sees(&junction(L_LEFT, 0.0, robot.odometry.heading)).forward, 0.0);
    assert_eq!(robot.path.queue(), []);
}

#[test]
fn at_a_dead_end_it_turns_around_only_on_command() {
    let here = junction(DEAD_END, 0.0, 0.0);
    assert_eq!(Robot::come_to(DEAD_END, NEXT).arrives(&here).percept.degree, 1);

    let mut robot = Robot::come_to(DEAD_END, &[Door(2), Door(0)]);
    assert_eq!(robot.sees(&here), Command { turn: PI, forward: 0.0 });
    assert_eq!(robot.sees(&junction(DEAD_END, 0.0, PI)), ahead(0.5));

    let why = Robot::come_to(DEAD_END, &[Door(2), Door(1)]).gives_up(&here);
    assert_eq!(why, LostReason::NoSuchDoor { door: Door(1), degree: 1 });
}

#[test]
fn at_the_start_the_robot_gets_to_know_its_junction_with_its_back_to_the_marker() {
    let odometry = Odometry { position: [3.0, 1.0], heading: 2.0 };
    let mut robot = Robot { path: PathExecution::at_start(&odometry), odometry };
    let here = junction(L_LEFT, 0.0, 0.0);
    assert_eq!(robot.sees(&here), Command::default(), "it takes two images there too");
    let JunctionState { percept, entry, .. } = robot.arrives(&here);
    assert_eq!(percept, Percept { degree: 2, sighting: Sighting::Pointing(Door::BACK) });
    assert_near(entry, 2.0 - PI);
}

// paper: alg2.27, alg2.28, alg2.29
#[test]
fn unknown_in_a_hallway_or_leaving_it_goes_a_third_with_care() {
    // The last printed line is not for it.
    Robot::leaving(NEXT).goes(&unknown(), 0.0, 0.5 / 3.0, Leaving);
    Robot::in_hallway(NEXT).goes(&unknown(), 0.0, 0.5 / 3.0, Hallway);
}

// paper: alg2.30, alg2.31, alg2.32
#[test]
fn unknown_at_a_junction_it_turns_by_10_20_30_degrees_to_either_side() {
    let mut robot = Robot::before(L_LEFT, NEXT);
    for degrees in [10.0, -10.0, 20.0, -20.0, 30.0, -30.0_f64] {
        assert_near(robot.sees(&unknown()).forward, 0.0);
        assert_near(robot.odometry.heading, degrees.to_radians());
        assert_eq!(robot.path.state(), Unknown);
    }

    // It turns about where it looked when it last knew.
    let mut robot = Robot::come_to(T_STEM, &[Door(2), Door(1)]);
    robot.sees(&junction(T_STEM, 0.0, 0.0));
    robot.sees(&unknown());
    assert_near(robot.odometry.heading, FRAC_PI_2 + 10.0_f64.to_radians());

    // At the beginning of a path that is where it looks.
    let mut robot = Robot::at(L_LEFT, &[Door(1)]);
    robot.odometry.heading = 0.2;
    robot.sees(&unknown());
    assert_near(robot.odometry.heading, 0.2 + 10.0_f64.to_radians());
}

#[test]
fn a_path_without_progress_is_given_up() {
    let unknowns = (6, LostReason::Unknown { images: 7 });
    let stalled = (3, LostReason::Stalled { times: 3 });
    let here = |doors| junction(doors, 0.0, 0.0);
    for (mut robot, share, scene, expected) in [
        (Robot::at(L_LEFT, &[Door(1)]), 1.0, unknown(), unknowns),
        (Robot::leaving(NEXT), 1.0, unknown(), unknowns),
        (Robot::before(L_LEFT, NEXT), 1.0, unknown(), unknowns),
        (Robot::leaving(NEXT), 0.0, hallway(0.0), stalled),
        (Robot::leaving(NEXT), 0.4, hallway(0.0), stalled),
        (Robot::come_to(L_LEFT, &[Door(2), Door(1)]), 0.0, here(L_LEFT), stalled),
        // Beside its turning point the robot hides whether the marker lies at an L.
        (Robot::in_hallway(NEXT), 1.0, here(L_LEFT), (16, LostReason::Idle { rounds: 16 })),
        (Robot::leaving(NEXT), 1.0, hallway(0.0), (200, LostReason::TooFar { metres: 100.5 })),
    ] {
        assert_eq!(robot.drives_on(share, &scene), expected);
    }
    let mut robot = Robot::leaving(NEXT);
    robot.path = robot.path.with_leg_bound(2.0);
    assert_eq!(robot.drives_on(1.0, &hallway(0.0)), (4, LostReason::TooFar { metres: 2.5 }));

    // Its wheels carry it farther than it asks for.
    let (commands, why) = Robot::leaving(NEXT).drives_on(1.5, &unknown());
    assert!(matches!(why, LostReason::Crept { metres } if (metres - 1.25).abs() < 1e-9), "{why}");
    assert_eq!(commands, 5);
}

#[test]
fn only_what_happens_in_a_row_is_counted() {
    let mut robot = Robot::leaving(NEXT);
    for _ in 0..6 {
        robot.sees(&unknown());
    }
    robot.sees(&hallway(0.0));
    assert_eq!(robot.drives_on(1.0, &unknown()), (6, LostReason::Unknown { images: 7 }));

    let mut robot = Robot::leaving(NEXT);
    for _ in 0..4 {
        robot.sees_and_does(1.5, &unknown());
    }
    robot.sees(&hallway(0.0));
    assert_eq!(robot.drives_on(1.5, &unknown()).0, 5, "a known place resets the count");

    let mut robot = Robot::leaving(NEXT);
    for share in [0.0, 0.0, 0.6, 0.0, 0.0] {
        robot.sees_and_does(share, &hallway(0.0));
    }
    assert_near(robot.sees(&hallway(0.0)).forward, 0.5);
}

#[test]
fn commands_are_neither_too_little_nor_too_large() {
    assert_near(Robot::leaving(NEXT).sees(&hallway(0.034)).turn, 0.0);
    assert_near(Robot::leaving(NEXT).sees(&hallway(0.036)).turn, 0.036);
    let around = Command { turn: 4.0, forward: 0.0 };
    for (asked, done) in [
        (ahead(0.029), Command::default()),
        (ahead(0.031), ahead(0.031)),
        (ahead(0.6), ahead(0.5)),
        (around, Command { turn: wrapped(4.0), ..around }),
        (Command { turn: -PI, ..around }, Command { turn: PI, ..around }),
    ] {
        let mut reckoning = PathExecution::at_start(&Odometry::default()).reckoning;
        assert_eq!(reckoning.end(asked), done);
    }
}

#[test]
fn a_junction_to_which_the_robot_could_not_come_is_not_the_next_one() {
    let with_its_back_to_it = |path| Robot { path, odometry: Odometry::default() };
    // An obstacle stopped it 0.4 m before the turning point, and it has turned round.
    let behind = junction(T_LEFT, -0.4, 0.0);
    let mut robot = with_its_back_to_it(PathExecution::onwards_from_junction(0.0, 0.4));
    robot.goes(&behind, 0.0, UNIT / 2.0, Leaving);
    assert_near(robot.path.way_back(), PI);
    robot.goes(&hallway(0.0), 0.0, UNIT, Hallway);
    // Otherwise it would be the one to which it has come.
    let mut robot = with_its_back_to_it(PathExecution::onwards_to_junction(0.0));
    robot.sees(&behind);
    assert_eq!(robot.path.state(), Junction);
    // The next one is.
    let mut robot = with_its_back_to_it(PathExecution::onwards_from_junction(0.0, 0.4));
    for _ in 0..5 {
        robot.sees(&hallway(0.0));
    }
    robot.sees(&junction(T_LEFT, 0.75, 0.0));
    assert_eq!(robot.path.state(), Junction);
}
