//! Algorithm 2: its limits, and where it arrives. Section 4.3.
//!
//! In a [`HallwayDrive`] images and motions may surprise the robot, within a budget. Arbitrary scenes
//! come from [`SCENES`], in any order.

use std::f64::consts::{FRAC_PI_2, PI};

use toposlam_model::{
    driving::{
        algorithm2::{
            Command, IDLE, JunctionState, LEAST_FORWARD, LEAST_TURN, LEG, PathExecution, STALLS,
            Step, UNIT, UNKNOWNS,
        },
        odometry::Odometry,
        scene::{
            CentreLine, HallwayStatus, HallwayView, JunctionView, Place, Reason, Scene, Unclear,
            wrapped,
        },
        visit::JunctionShape,
    },
    percept::{Door, Percept, Sighting},
};

use crate::{
    choose::{CaseResult, Choose, Exhibit, Stop, claim},
    hallways::{Budget, HALF_WIDTH, HallwayDrive, ImageEvidence, JUNCTION_SHAPES, PathDriver},
    lemma::declare,
};

#[cfg(test)]
mod broken;

/// Algorithm 2 itself.
type Algorithm2 = PathExecution<'static>;

declare! {
    no_command_exceeds_a_unit {
        "After any scenes, a command turns the robot by an angle in (-pi, pi] and moves it ahead \
         by at most 0.5 m, and by nothing that is too small to be carried out.",
        paper "4.1, 4.2; Algorithm 2, lines 2, 12, 14, 19, 25, 29, 31",
        exhaustive "a path of 2 doors, up to 2 scenes of 8, carried out wholly, in part or not, then \
                    any of 1417 scenes", 851_617 cases:
            no_command_exceeds_a_unit::<_, Algorithm2, 2>;
        sampled "up to 20 scenes before it": no_command_exceeds_a_unit::<_, Algorithm2, 20>;
    }
    the_first_image_takes_the_first_door {
        "At a known junction, an image of it takes the first door of the path and no other, and \
         turns the robot to it, or ends a path without doors; no other image does.",
        paper "4.2; Algorithm 2, lines 20 to 26",
        exhaustive "paths of up to 2 doors at every shape, images of every shape, turned by any \
                    multiple of 15 degrees", 6048 cases:
            the_first_door::<_, Algorithm2, 24>;
    }
    doors_are_taken_in_the_order_of_the_path {
        "Each door of a path is taken once, in order, at its junction: when two images agree on \
         the junction. The robot leaves by it when an image shows the doors turned.",
        paper "4.3; Algorithm 2, lines 20 to 26",
        exhaustive "every path of two doors, over 3.2 m of hallway each; an image or a motion that \
                    goes wrong", 46_144 cases:
            doors_in_order::<_, Algorithm2, 1, 1>;
        sampled "six surprises, of which one image is a mistake":
            doors_in_order::<_, Algorithm2, 6, 1>;
    }
    driving_always_ends {
        "For any scenes, and however little is carried out: in 17 rounds in a row at least one \
         ends the path, takes a door or moves the robot ahead by 15 mm, and the robot never goes \
         farther than the bound without a door. It gives up at the seventh unknown scene in a row, \
         and after three commands in a row of which nothing is carried out.",
        paper "4.3; Algorithm 2, lines 3 to 32",
        exhaustive "up to 1 scene of 8, carried out wholly, in part or not, then up to 3 such for \
                    ever; paths of up to 2 doors, 2 m from door to door", 1_081_800 cases:
            always_ends::<_, Algorithm2, 1, 3>;
        sampled "up to 40 scenes, then up to 8 for ever": always_ends::<_, Algorithm2, 40, 8>;
    }
    driving_arrives_at_the_next_junction {
        "If no image is a mistake and every command is carried out, the robot arrives at the next \
         junction, not at the one that it left, and knows its shape, its degree and its entry \
         door.",
        paper "4.3; Algorithm 2",
        exhaustive "every door of every shape to every shape, over 3.2 and 4.1 m of hallway; three \
                    ranges of sight; two images that are unclear, unknown or of hallway or \
                    junction", 122_112 cases:
            arrives::<_, Algorithm2, 2>;
        sampled "five such images": arrives::<_, Algorithm2, 5>;
    }
    one_mistake_makes_no_false_arrival {
        "The robot arrives at the next junction with its true shape, or gives up, unless two \
         images were mistaken and agreed.",
        paper "4.3; Algorithm 2",
        exhaustive "a door of every shape to every shape, over 3.2 m of hallway; three ranges of \
                    sight; two surprises, wrong images and motions in part or not at all among \
                    them", 793_596 cases:
            no_false_arrival::<_, Algorithm2, 2, 2>;
        sampled "eight surprises, of which three images are mistakes":
            no_false_arrival::<_, Algorithm2, 8, 3>;
    }
}

/// Each shape with each of its doors.
const EXITS: [(usize, u32); 14] = [
    (0, 0),
    (1, 1),
    (2, 1),
    (3, 2),
    (4, 2),
    (5, 1),
    (1, 0),
    (2, 0),
    (3, 0),
    (3, 1),
    (4, 0),
    (4, 1),
    (5, 0),
    (5, 2),
];

/// The paths of one door and of two, by their numbers.
const ONE_DOOR: [&[Door]; 3] = [&[Door(0)], &[Door(1)], &[Door(2)]];
const TWO_DOORS: [[&[Door]; 3]; 3] = [
    [&[Door(0), Door(0)], &[Door(0), Door(1)], &[Door(0), Door(2)]],
    [&[Door(1), Door(0)], &[Door(1), Door(1)], &[Door(1), Door(2)]],
    [&[Door(2), Door(0)], &[Door(2), Door(1)], &[Door(2), Door(2)]],
];

/// The distances from which a junction is usually seen.
const SIGHTS: [f64; 3] = [1.1, 0.75, 1.6];

/// More rounds than any drive on these plans takes.
const ROUNDS: u32 = 200;

/// An image of a junction whose turning point is the given distance ahead, of a robot that then turned.
fn junction(shape: JunctionShape, ahead: f64, turned: f64) -> Place {
    Place::Junction(junction_view(shape, ahead, turned))
}

fn junction_view(shape: JunctionShape, ahead: f64, turned: f64) -> JunctionView {
    let through =
        if ahead == 0.0 { [0.0; 2] } else { [ahead * turned.cos(), -ahead * turned.sin()] };
    let mut doors = Vec::with_capacity(4);
    let mut quarter = 0;
    while quarter < 4 {
        if shape.0[quarter] {
            let direction = wrapped(PI - quarter as f64 * FRAC_PI_2 - turned);
            doors.push(CentreLine { through, direction });
        }
        quarter += 1;
    }
    JunctionView { doors, turning_point: through, confidence: 1.0 }
}

fn hallway(heading: f64, left: f64, right: f64, status: HallwayStatus) -> Place {
    Place::Hallway(HallwayView { heading, left, right, status, confidence: 1.0 })
}

/// The number of scenes of [`any_scene`].
const SCENES: u8 = 8;

/// One of a few scenes.
fn any_scene(choose: &mut impl Choose) -> Place {
    match choose.below(SCENES) {
        0 => Place::Unknown(Reason::NothingFits),
        1 => hallway(0.0, 0.8, 0.8, HallwayStatus::Clear),
        2 => hallway(0.7, 1.2, 0.4, HallwayStatus::Unclear(Unclear::SizesDiffer)),
        3 => junction(JUNCTION_SHAPES[1], 0.6, 0.0),
        4 => junction(JUNCTION_SHAPES[1], 0.0, 0.0),
        5 => junction(JUNCTION_SHAPES[1], 0.0, FRAC_PI_2),
        6 => junction(JUNCTION_SHAPES[4], -0.5, 0.0),
        _ => junction(JUNCTION_SHAPES[0], 0.04, 0.0),
    }
}

/// The part of a command that is carried out: all, or as little as just counts, or nothing.
fn any_share(choose: &mut impl Choose) -> f64 {
    [1.0, 0.5, 0.0][usize::from(choose.below(3))]
}

/// Any of many scenes.
fn wide_scene(choose: &mut impl Choose) -> Place {
    match choose.below(3) {
        0 => Place::Unknown(Reason::NothingFits),
        1 => {
            let heading = (f64::from(choose.below(12)) - 5.0) / 12.0 * PI;
            let left = [0.8, 0.2, 2.0][usize::from(choose.below(3))];
            let right = [0.8, 0.2, 2.0][usize::from(choose.below(3))];
            let statuses = [HallwayStatus::Clear, HallwayStatus::Unclear(Unclear::ClusterBehind)];
            hallway(heading, left, right, statuses[usize::from(choose.below(2))])
        }
        _ => {
            let shape = JUNCTION_SHAPES[usize::from(choose.below(6))];
            let turned = f64::from(choose.below(8)) / 4.0 * PI;
            let mut view = junction_view(shape, 0.0, turned);
            let aside = [0.0, 0.02, -0.02, 2.0, -2.0];
            for axis in 0..2 {
                view.turning_point[axis] = aside[usize::from(choose.below(5))];
            }
            Place::Junction(view)
        }
    }
}

fn limits(Command { turn, forward }: Command) -> CaseResult {
    claim("it turns by an angle in (-pi, pi]", -PI < turn && turn <= PI)?;
    claim("it goes ahead by at most a unit", (0.0..=UNIT).contains(&forward) && UNIT <= 0.5)?;
    claim("no turn is too little to be done", turn == 0.0 || turn.abs() >= LEAST_TURN)?;
    claim("no way is too little to be done", forward == 0.0 || forward >= LEAST_FORWARD)
}

/// A robot at the turning point of a junction with this shape.
fn stands(shape: JunctionShape) -> JunctionState {
    let percept = Percept { degree: shape.degree(), sighting: Sighting::Nothing };
    JunctionState { shape, percept, entry: PI }
}

// paper: alg2.2, drive.clear, drive.unclear
fn no_command_exceeds_a_unit<C: Choose, D: PathDriver, const BEFORE: u8>(
    choose: &mut C,
) -> CaseResult {
    let mut driver = D::begin(TWO_DOORS[1][0], &stands(JUNCTION_SHAPES[1]), LEG);
    let mut odometry = Odometry::default();
    let before = choose.below(1 + BEFORE);
    for round in 0..=before {
        let place = if round < before { any_scene(choose) } else { wide_scene(choose) };
        choose.show(|| Exhibit::Value { name: "image", value: format!("{place:?}") });
        let Ok(Step::Go(command)) = driver.round(&Scene { place, marker: None }, odometry) else {
            return Ok(());
        };
        choose.show(|| Exhibit::Value { name: "command", value: format!("{command:?}") });
        limits(command)?;
        if round < before {
            let share = any_share(choose);
            odometry = odometry.moved(command.turn * share, command.forward * share);
        }
    }
    Ok(())
}

// paper: alg2.20, alg2.21, alg2.22, alg2.23, alg2.24
fn the_first_door<C: Choose, D: PathDriver, const TURNS: u8>(choose: &mut C) -> CaseResult {
    let shape = JUNCTION_SHAPES[usize::from(choose.below(6))];
    let door = choose.below(shape.degree() as u8);
    let queue = match choose.below(3) {
        0 => &[],
        1 => ONE_DOOR[usize::from(door)],
        _ => TWO_DOORS[usize::from(door)][0],
    };
    let seen = JUNCTION_SHAPES[usize::from(choose.below(6))];
    let turned = f64::from(choose.below(TURNS)) / f64::from(TURNS) * 2.0 * PI;
    let Place::Junction(view) = junction(seen, 0.0, turned) else { unreachable!() };
    choose.show(|| Exhibit::Value { name: "known", value: format!("{shape:?}, path {queue:?}") });
    choose.show(|| Exhibit::Value { name: "image", value: format!("{view:?}") });
    let exit = view.doors.get(usize::from(door)).map_or(0.0, |line| line.direction);
    // Odometry knows that the robot has turned.
    let odometry = Odometry { position: [0.0; 2], heading: wrapped(turned) };
    let mut driver = D::begin(queue, &stands(shape), LEG);
    let step = driver.round(&Scene { place: Place::Junction(view), marker: None }, odometry);
    let left = driver.queue().len();
    match step {
        Err(_) => claim("it does not give up", false),
        Ok(Step::Arrived(state)) => {
            claim("a path without doors is done", queue.is_empty() && seen == shape)?;
            claim("the junction is the one known", state.shape == shape)
        }
        Ok(Step::Go(command)) if seen == shape => {
            limits(command)?;
            claim("one door is taken", left + 1 == queue.len())?;
            let turn = wrapped(exit - command.turn).abs();
            claim("it turns to the door", turn < LEAST_TURN)?;
            let is_turned = exit.abs() < 11.0 / 180.0 * PI;
            claim("it leaves only if it looks there", command.forward == 0.0 || is_turned)
        }
        Ok(Step::Go(command)) => {
            limits(command)?;
            claim("another junction takes no door", left == queue.len())?;
            claim("and does not move the robot", command.forward == 0.0)
        }
    }
}

/// The end of a drive.
struct End {
    /// The robot's belief; `None` if it gave up.
    state: Option<JunctionState>,
    /// The mistaken images since the last door, by their shapes.
    mistaken: Vec<JunctionShape>,
    /// Whether an image showed the junction from where a marker would be seen.
    looked: bool,
}

/// Drives a path to its end, and checks that its doors are taken as required.
fn driven<C: Choose, D: PathDriver>(
    choose: &mut C,
    drive: &mut HallwayDrive,
    queue: &'static [Door],
) -> Result<End, Stop> {
    choose.show(|| Exhibit::Value { name: "path", value: format!("{queue:?} {drive:?}") });
    let mut driver = D::begin(queue, &drive.junction(0).junction_state(), LEG);
    // The number of doors by which the robot has left, and whether it has taken one more.
    let (mut left_by, mut takes) = (0, false);
    // The shapes that images showed since then, and the mistaken ones.
    let (mut seen_shapes, mut mistaken) = (vec![drive.junction(0).shape; 2], Vec::new());
    let mut looked = true;
    for _ in 0..ROUNDS {
        let (scene, evidence) = drive.image(choose);
        // The next junction, or the one at which the robot stands.
        let here = *drive.junction(left_by);
        match (evidence, &scene.place) {
            (ImageEvidence::Mistake(shape), _) => {
                seen_shapes.push(shape);
                mistaken.push(shape);
            }
            (ImageEvidence::Truth, Place::Junction(view))
                if here.distance(&drive.robot) < HALFWAY =>
            {
                seen_shapes.push(here.shape);
                looked |= (0.2..=0.8).contains(&view.distance());
            }
            _ => {}
        }
        let open = driver.queue().len();
        let step = driver.round(&scene, drive.robot);
        claim("the doors left are the last", queue.ends_with(driver.queue()))?;
        let due = queue.len() - left_by - usize::from(takes);
        claim("a door stays taken", open == due)?;
        if driver.queue().len() < open {
            claim("one door is taken at a time", driver.queue().len() + 1 == open && !takes)?;
            claim(
                "two images agree",
                JUNCTION_SHAPES.into_iter().any(|shape| agreeing(&seen_shapes, shape) > 1),
            )?;
            takes = true;
        }
        let command = match step {
            Err(_) => return Ok(End { state: None, mistaken, looked }),
            Ok(Step::Arrived(state)) => {
                claim("every door was taken", left_by == queue.len() && !takes)?;
                claim("two images agree", agreeing(&seen_shapes, state.shape) > 1)?;
                return Ok(End { state: Some(state), mistaken, looked });
            }
            Ok(Step::Go(command)) => command,
        };
        limits(command)?;
        if takes && command.forward > 0.0 && mistaken.len() < 2 {
            let direction = here.direction(queue[left_by]);
            let aside = drive.robot.seen(direction).abs();
            claim("it leaves when it looks to the door", aside < 11.0 / 180.0 * PI)?;
            claim("it leaves where the door is", here.distance(&drive.robot) < HALFWAY)?;
        }
        if takes && command.forward > 0.0 {
            (left_by, takes) = (left_by + 1, false);
            (seen_shapes, mistaken, looked) = (Vec::new(), Vec::new(), false);
        }
        drive.carry_out(choose, command);
    }
    Err(Stop::Fails("it ends"))
}

/// The number of these with this shape.
fn agreeing(shapes: &[JunctionShape], shape: JunctionShape) -> usize {
    shapes.iter().filter(|&&other| other == shape).count()
}

/// A robot nearer than this to a junction is not at another one, in metres.
const HALFWAY: f64 = 1.6;

// paper: alg2.23, alg2.25, drive.turn, drive.path
fn doors_in_order<C: Choose, D: PathDriver, const SURPRISES: u8, const MISTAKES: u8>(
    choose: &mut C,
) -> CaseResult {
    let (first, door) = EXITS[usize::from(choose.below(14))];
    let (second, then) = EXITS[usize::from(choose.below(14))];
    let legs = [(Door(door), 3.2, JUNCTION_SHAPES[second]), (Door(then), 3.2, JUNCTION_SHAPES[3])];
    let budget = Budget { surprises: SURPRISES, mistakes: MISTAKES, failures: SURPRISES };
    let mut drive = HallwayDrive::new(JUNCTION_SHAPES[first], &legs, SIGHTS[0], budget);
    let queue = TWO_DOORS[door as usize][then as usize];
    driven::<_, D>(choose, &mut drive, queue).map(|_| ())
}

// paper: alg2.3
fn always_ends<C: Choose, D: PathDriver, const BEFORE: u8, const PERIOD: u8>(
    choose: &mut C,
) -> CaseResult {
    const FAR: f64 = 2.0;
    let queue: &'static [Door] = [&[], ONE_DOOR[2], TWO_DOORS[1][0]][usize::from(choose.below(3))];
    let shape = JUNCTION_SHAPES[if queue.len() == 1 { 4 } else { 1 }];
    let mut driver = D::begin(queue, &stands(shape), FAR);
    let before = usize::from(choose.below(1 + BEFORE));
    let period = 1 + usize::from(choose.below(PERIOD));
    let mut moments = Vec::with_capacity(before + period);
    for _ in 0..before + period {
        moments.push((Scene { place: any_scene(choose), marker: None }, any_share(choose)));
    }
    choose.show(|| Exhibit::Value { name: "for ever", value: format!("{:?}", &moments[before..]) });
    let mut odometry = Odometry::default();
    // Rounds in a row without progress, and metres in a row without a door.
    let (mut idle, mut way) = (0, 0.0);
    // Unknown images in a row, and commands in a row of which nothing was carried out.
    let (mut unknowns, mut stalls) = (0, 0);
    let mut round = 0;
    loop {
        let at = if round < before { round } else { before + (round - before) % period };
        let (scene, share) = &moments[at];
        let open = driver.queue().len();
        let Ok(Step::Go(command)) = driver.round(scene, odometry) else { return Ok(()) };
        limits(command)?;
        let forward = command.forward * share;
        odometry = odometry.moved(command.turn * share, forward);
        let takes = driver.queue().len() < open;
        way = if takes { 0.0 } else { way + forward };
        idle = if takes || forward >= LEAST_FORWARD / 2.0 { 0 } else { idle + 1 };
        unknowns = if matches!(scene.place, Place::Unknown(_)) { unknowns + 1 } else { 0 };
        claim("it gives up at the seventh unknown", unknowns < UNKNOWNS)?;
        let stalled = *share == 0.0 && command != Command::default();
        stalls = if stalled { stalls + 1 } else { 0 };
        claim("it gives up when nothing is carried out", stalls <= STALLS)?;
        claim("it makes progress", idle <= IDLE)?;
        claim("it does not go too far", way <= FAR + 2.0 * UNIT)?;
        round += 1;
    }
}

// paper: alg2.7, alg2.15, alg2.22, drive.path
fn arrives<C: Choose, D: PathDriver, const SURPRISES: u8>(choose: &mut C) -> CaseResult {
    let (first, door) = EXITS[usize::from(choose.below(14))];
    let shape = JUNCTION_SHAPES[usize::from(choose.below(6))];
    let length = [3.2, 4.1][usize::from(choose.below(2))];
    let sight = SIGHTS[usize::from(choose.below(3))];
    let budget = Budget { surprises: SURPRISES, mistakes: 0, failures: 0 };
    let mut drive =
        HallwayDrive::new(JUNCTION_SHAPES[first], &[(Door(door), length, shape)], sight, budget);
    let End { state, looked, .. } = driven::<_, D>(choose, &mut drive, ONE_DOOR[door as usize])?;
    let Some(state) = state else {
        return claim("it gives up only if it could not see a marker", shape.is_l() && !looked);
    };
    let there = drive.junction(1);
    claim("it is in the next junction", there.distance(&drive.robot) < HALF_WIDTH)?;
    let expected = there.junction_state();
    claim("it knows its shape", state.shape == shape && state.percept == expected.percept)?;
    let off = wrapped(state.entry - expected.entry).abs();
    claim("it knows its entry door", off < 1e-6)
}

// paper: alg2.15, alg2.27, drive.path
fn no_false_arrival<C: Choose, D: PathDriver, const SURPRISES: u8, const MISTAKES: u8>(
    choose: &mut C,
) -> CaseResult {
    let (first, door) = EXITS[usize::from(choose.below(6))];
    let shape = JUNCTION_SHAPES[usize::from(choose.below(6))];
    let sight = SIGHTS[usize::from(choose.below(3))];
    let budget = Budget { surprises: SURPRISES, mistakes: MISTAKES, failures: SURPRISES };
    let mut drive =
        HallwayDrive::new(JUNCTION_SHAPES[first], &[(Door(door), 3.2, shape)], sight, budget);
    let End { state, mistaken, .. } = driven::<_, D>(choose, &mut drive, ONE_DOOR[door as usize])?;
    let Some(state) = state else { return Ok(()) };
    if agreeing(&mistaken, state.shape) < 2 {
        let there = drive.junction(1);
        claim("its shape is the true one", state.shape == shape)?;
        claim("it is at the next junction", there.distance(&drive.robot) < HALFWAY)?;
        let off = wrapped(state.entry - there.junction_state().entry).abs();
        claim("it knows its entry door", off < PI / 4.0)?;
    }
    Ok(())
}
