//! Which robots of a team are together, by what the explorer perceives.

use crate::percept::{Door, OtherRobot, Percept, Sighting, TeamView};

/// A robot that may be where a scout is.
#[derive(Clone, Copy)]
pub(super) enum TeamMember {
    Explorer,
    /// The scout with this number, from 0.
    Scout(usize),
}

/// Whether a scout is where another robot is.
#[derive(Clone, Copy)]
pub(super) enum Meeting {
    Apart,
    Together,
    /// The scout's entry dart is so many doors clockwise of the other's, and then so many counterclockwise.
    Turned(Door, Door),
}

impl Meeting {
    pub(super) fn of(scout: usize, other: TeamMember, percept: Percept) -> Self {
        use OtherRobot::{Here, HereAlong, WithSecond, WithSecondAlong};
        let Sighting::Team(TeamView(seen)) = percept.sighting else { return Self::Apart };
        let shown = |at: usize| seen.get(at).copied().unwrap_or_default();
        match (other, shown(scout)) {
            (TeamMember::Explorer, Here) => Self::Together,
            (TeamMember::Explorer, HereAlong(door)) => Self::Turned(door, Door::BACK),
            (TeamMember::Explorer, _) => Self::Apart,
            (TeamMember::Scout(other), one) => match (one, shown(other), shown(1)) {
                (Here, Here, _) | (_, _, WithSecond) => Self::Together,
                (HereAlong(one), HereAlong(other), _) => Self::Turned(one, other),
                (_, _, WithSecondAlong(door)) if scout == 1 => Self::Turned(door, Door::BACK),
                (_, _, WithSecondAlong(door)) => Self::Turned(Door::BACK, door),
                _ => Self::Apart,
            },
        }
    }

    pub(super) fn is_apart(self) -> bool {
        matches!(self, Self::Apart)
    }
}
