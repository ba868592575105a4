//! The odometry of Algorithm 2: the direction of the hallway, of the entry door, and the counters
//! that end a path on which the robot makes no progress. The print leaves this open.

use std::f64::consts::{FRAC_PI_4, PI};

use super::{Command, LEAST_FORWARD, LEAST_TURN, UNIT, lost::LostReason};
use crate::driving::{
    odometry::Odometry,
    scene::{CentreLine, JunctionView, undirected, wrapped},
};

/// The robot gives up after this number of images in a row without a known place,
pub const UNKNOWNS: u32 = 7;
/// or after creeping farther than this, in metres,
pub const CREEP: f64 = 1.0;
/// or after this number of commands in a row that were not executed,
pub const STALLS: u32 = 3;
/// or after this number of images in a row from the same place,
pub const IDLE: u32 = 16;
/// or after this distance without a junction, in metres.
pub const LEG: f64 = 100.0;

/// A robot that does not know how far it is from the last junction supposes this distance, in metres. So a
/// junction where it stands is not the one that it has left.
pub(super) const ON_THE_WAY: f64 = 1.2;
/// The step by which the robot turns to look around, to one side and the other: ten degrees.
const LITTLE: f64 = 10.0 / 180.0 * PI;
/// The largest difference between a view and odometry.
const AGAINST: f64 = FRAC_PI_4;

/// Whether an image shows a known place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Round {
    Known,
    Unknown,
}

/// Where the robot is on its path, by odometry.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Stage {
    /// At a junction that it has not left.
    #[default]
    AtJunction,
    /// On its way to the next junction, which it may have seen.
    OnTheWay,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct DeadReckoning {
    now: Odometry,
    stage: Stage,
    /// The direction of the entry door, in the frame of odometry.
    pub(super) entry: f64,
    /// The direction of the hallway, likewise.
    leg: f64,
    /// The heading after the turn at the last image of a known place.
    known: f64,
    /// The last command, and the odometry then.
    asked: Option<(Command, Odometry)>,
    pub(super) since_turn: f64,
    unknowns: u32,
    crept: f64,
    stalls: u32,
    idle: u32,
    pub(super) leg_bound: f64,
}

impl DeadReckoning {
    pub(super) fn at_junction(entry: f64) -> Self {
        Self { entry, known: wrapped(entry + PI), leg_bound: LEG, ..Self::default() }
    }

    /// On the way in a direction of the frame of odometry, from a junction that lies this far behind.
    pub(super) fn on_the_way(direction: f64, behind: f64) -> Self {
        let known = wrapped(direction);
        Self { stage: Stage::OnTheWay, leg: known, since_turn: behind, ..Self::at_junction(known) }
    }

    /// A round begins: the last command was executed or not.
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

    /// Counts an image of a known place, or of none.
    pub(super) fn note(&mut self, round: Round) -> Result<(), LostReason> {
        if round == Round::Known {
            (self.unknowns, self.crept) = (0, 0.0);
            return Ok(());
        }
        self.unknowns += 1;
        if self.unknowns >= UNKNOWNS {
            return Err(LostReason::Unknown { images: self.unknowns });
        }
        if self.crept > CREEP {
            return Err(LostReason::Crept { metres: self.crept });
        }
        Ok(())
    }

    /// A round ends with a command. Motions that are too small are left out.
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
    pub(super) fn stop_at_junction(&mut self) {
        self.stage = Stage::AtJunction;
    }

    pub(super) fn is_at_junction(&self) -> bool {
        self.stage == Stage::AtJunction
    }

    pub(super) fn way_back(&self) -> f64 {
        match self.stage {
            Stage::OnTheWay => wrapped(self.leg + PI),
            Stage::AtJunction => self.entry,
        }
    }

    /// The direction of the hallway, relative to the robot's heading.
    pub(super) fn ahead(&self) -> f64 {
        self.now.seen(self.leg)
    }

    /// A hallway with this heading is seen.
    pub(super) fn hallway(&mut self, heading: f64) -> Result<(), LostReason> {
        let off = undirected(heading - self.ahead());
        if off.abs() > AGAINST {
            return Err(LostReason::Turned { degrees: off.to_degrees().abs() });
        }
        self.leg = wrapped(self.leg + off);
        Ok(())
    }

    /// The junction just left is seen. Returns whether one of its doors is where the robot goes.
    pub(super) fn left(&mut self, junction: &JunctionView) -> bool {
        let off = nearest(junction, self.ahead()).filter(|off| off.abs() <= AGAINST);
        self.leg = wrapped(self.leg + off.unwrap_or(0.0));
        off.is_some()
    }

    /// The direction of a junction's entry door, relative to the robot's heading; `None` if no door is
    /// near the expected direction.
    pub(super) fn entry(&self, junction: &JunctionView) -> Option<f64> {
        let expected = match self.stage {
            Stage::OnTheWay => wrapped(self.ahead() + PI),
            Stage::AtJunction => self.now.seen(self.entry),
        };
        let off = nearest(junction, expected)?;
        (off.abs() <= AGAINST).then(|| wrapped(expected + off))
    }

    /// The robot is at a junction. The first door is its entry door.
    pub(super) fn at(&mut self, junction: &JunctionView) {
        if let Some(entry) = junction.doors.first() {
            self.entry = self.now.whither(entry.direction);
            self.leg = wrapped(self.entry + PI);
        }
    }
}

fn nearest(junction: &JunctionView, direction: f64) -> Option<f64> {
    let off = |door: &CentreLine| wrapped(door.direction - direction);
    junction.doors.iter().map(off).min_by(|one, other| one.abs().total_cmp(&other.abs()))
}
