//! What Algorithm 2 keeps by odometry: where the hallway leads, where the entry door is, and how long
//! the robot has got nowhere. What the print leaves open, so that a path always ends.

use std::f64::consts::{FRAC_PI_4, PI};

use super::{Command, LEAST_FORWARD, LEAST_TURN, UNIT, lost::LostReason};
use crate::driving::{
    odometry::Odometry,
    scene::{CentreLine, JunctionView, undirected, wrapped},
};

/// After so many pictures in a row that tell of no place the robot gives up,
pub const UNKNOWNS: u32 = 7;
/// or after more than so many metres on which it crept,
pub const CREEP: f64 = 1.0;
/// or after so many commands in a row that were not carried out,
pub const STALLS: u32 = 3;
/// or after so many pictures in a row from the same place,
pub const IDLE: u32 = 16;
/// or after so many metres without a junction.
pub const LEG: f64 = 100.0;

/// By what the robot turns to look around: ten degrees, to one side and the other.
const LITTLE: f64 = 10.0 / 180.0 * PI;
/// What is seen may be off by so much from where odometry puts it.
const AGAINST: f64 = FRAC_PI_4;

/// What a picture told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Round {
    Known,
    Unknown,
}

/// Where the robot is on its way, as far as odometry can tell.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Stage {
    /// At a junction that it has not left.
    AtJunction,
    /// On its way to the next junction, which it may have seen.
    OnTheWay,
}

/// What is kept by odometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DeadReckoning {
    now: Odometry,
    stage: Stage,
    /// Where the entry door is, as a direction in the frame of odometry.
    entry: f64,
    /// Where the hallway leads, likewise.
    leg: f64,
    /// Where the robot looked when a picture last told of a place, and turned then.
    known: f64,
    /// What was asked for, and where the robot was then.
    asked: Option<(Command, Odometry)>,
    since_turn: f64,
    unknowns: u32,
    crept: f64,
    stalls: u32,
    idle: u32,
    leg_bound: f64,
}

impl DeadReckoning {
    pub(super) fn at_junction(entry: f64) -> Self {
        Self {
            now: Odometry::default(),
            stage: Stage::AtJunction,
            entry,
            leg: 0.0,
            known: wrapped(entry + PI),
            asked: None,
            since_turn: 0.0,
            unknowns: 0,
            crept: 0.0,
            stalls: 0,
            idle: 0,
            leg_bound: LEG,
        }
    }

    pub(super) fn bound_leg(&mut self, metres: f64) {
        self.leg_bound = metres;
    }

    /// A round begins: what was asked for has been done or not.
    pub(super) fn begin(&mut self, now: Odometry) -> Result<(), LostReason> {
        self.now = now;
        let Some((command, before)) = self.asked.take() else {
            self.known = now.heading;
            return Ok(());
        };
        let forward = now.distance(&before);
        let turned = wrapped(now.heading - before.heading).abs();
        self.since_turn += forward;
        if self.unknowns > 0 {
            self.crept += forward;
        }
        if self.since_turn > self.leg_bound {
            return Err(LostReason::TooFar { metres: self.since_turn });
        }
        let stalled = forward < command.forward / 2.0 || turned < command.turn.abs() / 2.0;
        self.stalls = if stalled { self.stalls + 1 } else { 0 };
        if self.stalls >= STALLS {
            return Err(LostReason::Stalled { times: self.stalls });
        }
        let nearer = command.forward > 0.0 && !stalled;
        self.idle = if nearer { 0 } else { self.idle + 1 };
        if self.idle >= IDLE {
            return Err(LostReason::Idle { rounds: self.idle });
        }
        Ok(())
    }

    /// A picture told of a place, or of none.
    pub(super) fn note(&mut self, round: Round) -> Result<(), LostReason> {
        if round == Round::Known {
            (self.unknowns, self.crept) = (0, 0.0);
            return Ok(());
        }
        self.unknowns += 1;
        if self.unknowns >= UNKNOWNS {
            return Err(LostReason::Unknown { pictures: self.unknowns });
        }
        if self.crept > CREEP {
            return Err(LostReason::Crept { metres: self.crept });
        }
        Ok(())
    }

    /// A round ends: what is asked for now. What is too little to be done is left out.
    pub(super) fn end(&mut self, command: Command) -> Command {
        let Command { turn, forward } = command;
        let command = Command {
            turn: if turn.abs() < LEAST_TURN { 0.0 } else { wrapped(turn) },
            forward: if forward < LEAST_FORWARD { 0.0 } else { forward.min(UNIT) },
        };
        if self.unknowns == 0 {
            self.known = self.now.whither(command.turn);
        }
        self.asked = Some((command, self.now));
        command
    }

    /// To one side and the other of the last known heading: by 10, 20, 30 degrees.
    pub(super) fn little_turn(&self) -> f64 {
        let far = f64::from(self.unknowns.div_ceil(2)) * LITTLE;
        let aside = if self.unknowns.is_multiple_of(2) { -far } else { far };
        self.now.seen(self.known + aside)
    }

    /// The robot has turned to a door, which is nearly ahead, and leaves by it.
    pub(super) fn leave(&mut self, exit: f64) {
        self.stage = Stage::OnTheWay;
        self.leg = self.now.whither(exit);
        self.since_turn = 0.0;
    }

    /// The robot has come to the junction and takes a door there.
    pub(super) fn stand(&mut self) {
        self.stage = Stage::AtJunction;
    }

    pub(super) fn is_at_junction(&self) -> bool {
        self.stage == Stage::AtJunction
    }

    pub(super) fn since_turn(&self) -> f64 {
        self.since_turn
    }

    /// Where the hallway leads, relative to the robot's heading.
    pub(super) fn ahead(&self) -> f64 {
        self.now.seen(self.leg)
    }

    /// Where the entry door is, in the frame of odometry.
    pub(super) fn entry_direction(&self) -> f64 {
        self.entry
    }

    /// A hallway is seen to run so.
    pub(super) fn hallway(&mut self, heading: f64) -> Result<(), LostReason> {
        let off = undirected(heading - self.ahead());
        if off.abs() > AGAINST {
            return Err(LostReason::Turned { degrees: off.to_degrees().abs() });
        }
        self.leg = wrapped(self.leg + off);
        Ok(())
    }

    /// The junction just left is seen; whether one of its doors is where the robot goes.
    pub(super) fn left(&mut self, junction: &JunctionView) -> bool {
        let off = nearest(junction, self.ahead()).filter(|off| off.abs() <= AGAINST);
        self.leg = wrapped(self.leg + off.unwrap_or(0.0));
        off.is_some()
    }

    /// Where a junction's entry door is, relative to the robot's heading; `None` where no door is
    /// near where it should be.
    pub(super) fn entry(&self, junction: &JunctionView) -> Option<f64> {
        let expected = match self.stage {
            Stage::OnTheWay => wrapped(self.ahead() + PI),
            Stage::AtJunction => self.now.seen(self.entry),
        };
        let off = nearest(junction, expected)?;
        (off.abs() <= AGAINST).then(|| wrapped(expected + off))
    }

    /// The robot is at a junction, whose first door is the one by which it came.
    pub(super) fn at(&mut self, junction: &JunctionView) {
        if let Some(entry) = junction.doors.first() {
            self.entry = self.now.whither(entry.direction);
            self.leg = wrapped(self.entry + PI);
        }
    }
}

/// By how much the door that is nearest to a direction is off it.
fn nearest(junction: &JunctionView, direction: f64) -> Option<f64> {
    let off = |door: &CentreLine| wrapped(door.direction - direction);
    junction.doors.iter().map(off).min_by(|one, other| one.abs().total_cmp(&other.abs()))
}
