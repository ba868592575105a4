//! The parameters of a robot that explores corridors by a laser scanner.
//!
//! Lengths are in metres and angles in radians. The default values are for corridors that are about 2 m wide, and the others
//! for hallways that are 1.4 to 2 m wide, with junctions from 2.8 m apart.

use toposlam_model::driving::scene::wrapped;
use toposlam_vision::params;

params! {
    /// How the robot decides where it stands, and when it looks again.
    CorridorParams {
        /// A place is left when the robot is this far from its walls.
        left_behind: f64 = 2.5,
        /// The robot has come in by the direction of where it was when it was this far from the junction's walls.
        came_from: f64 = 1.0,
        /// A place in a view this near is the one where the robot stands.
        same_place: f64 = 3.0,
        /// Directions nearer to each other are those of one arm.
        same_arm: f64 = 0.6,
        /// The door by which the robot came in differs by less than this from the direction from which it came: it may have
        /// passed through a lobby.
        entry: f64 = 1.0,
        /// Ways that meet this near to the robot are an opening beside it.
        opening: f64 = 1.0,
        /// Where it has turned around within this distance, it need not do so again, ...
        looked: f64 = 2.0,
        /// ... unless it has driven this far since.
        look_memory: f64 = 10.0,
        /// A scanner with a larger field of view sees what is behind the robot.
        all_around: f64 = 6.0,
        /// A scanner with a range as long as this sees the walls of an arm far enough to be certain of it: those of a
        /// corridor 2.45 m wide are a tenth of a radian apart there, and what is between them counts as free. A robot with
        /// another scanner drives into each opening.
        sees_arms: f64 = 24.5,
        /// One that sees so many times as far as an arm is long sees the arms of hallways. A robot with another one drives into
        /// each direction from which nothing comes back, too.
        sees_beyond: f64 = 2.0,
        /// A robot with such a scanner notices ways that meet this near to it, ...
        near_opening: f64 = 1.5,
        /// ... takes those that meet this far beyond the clearance of their meeting point for one opening, ...
        one_opening: f64 = 0.6,
        /// ... takes ways whose directions differ by more than this for different ones, ...
        same_way: f64 = 0.35,
        /// ... looks into a way up to this far from where it stands, ...
        near_place: f64 = 3.5,
        /// ... drives on for this length to see all of it, ...
        past_opening: f64 = 2.5,
        /// ... and has left one that is no junction when it is this far from it.
        no_junction: f64 = 1.0,
        /// A robot that stands farther than this from the centre of the place where it looks around goes there, ...
        off_centre: f64 = 1.0,
        /// ... at most this often.
        centred: usize = 2,
        /// Where it is not seen how a way ends, the robot goes closer to what is ahead, if that is farther than this.
        look_closer: f64 = 1_000.0,
        /// What is this near to the centre of a place in a view is the same place.
        at_centre: f64 = 2.0,
        /// An arm is certain if it is in this part of the last views.
        certain: f64 = 0.75,
        /// The number of these views.
        views: usize = 6,
        /// How often it looks again.
        looks: usize = 8,
        /// How far it goes on to look again.
        further: f64 = 1.5,
        /// How often a robot that got lost tries to come to a junction.
        tries: usize = 6,
        /// A marker this far from a place, besides the clearance, lies there, ...
        marker_range: f64 = 2.0,
        /// ... and is remembered for this length of the way.
        marker_memory: f64 = 100.0,
        /// Nearer to the centre it shows no door.
        marker_off: f64 = 0.5,
        /// The longest step from scan to scan.
        step: f64 = 0.45,
        /// It drives towards the point of its way that is this far ahead.
        look_ahead: f64 = 0.9,
        /// A smaller turn is made while it drives.
        straight: f64 = 0.02,
        /// A scanner that does not see all round takes a scan after each turn by this, ...
        turn: f64 = 0.45,
        /// ... at most this often.
        turns: usize = 16,
        /// A robot that turns around takes this number of scans if its scanner sees all round, ...
        round_views: usize = 8,
        /// ... and this number if it does not.
        sector_views: usize = 20,
        /// A way that leaves a place in a direction differs from it by less than this, ...
        leaving: f64 = 0.6,
        /// ... over this length.
        leaving_measured: f64 = 2.5,
        /// From step to step a way bends by less than this.
        bend: f64 = 1.2,
        /// A robot that cannot go straight on looks for a bend if it has driven this far, ...
        bend_after: f64 = 3.0,
        /// ... its way to the bend is measured over this length, ...
        bend_back: f64 = 0.9,
        /// ... and its way behind the bend is measured over this length.
        bend_length: f64 = 1.5,
        /// A robot whose way leads this far aside from a straight line has turned: half of a corridor.
        turned: f64 = 1.0,
        /// A way that is known for less than this has ended.
        at_end: f64 = 0.3,
        /// Nothing comes back from ahead if a reading this near to that direction has no return.
        silent: f64 = 0.05,
        /// A robot without a way drives straight on up to this far from a wall.
        before_wall: f64 = 0.4,
        /// A robot that has driven less than this in a step was stopped.
        stuck: f64 = 0.05,
        /// A wall that it does not see stops it this near, ...
        touch: f64 = 0.5,
        /// ... and is known for this length to each side of its middle: the robot's radius.
        felt: f64 = 0.25,
        /// It feels for walls at most this often from place to place.
        feels: usize = 12,
        /// A way may go on through a gap that is at least this wide, ...
        gap: f64 = 0.4,
        /// ... and that does not lie in the direction of the way back.
        not_back: f64 = 0.5,
        /// Then it tries so many directions to each side of its way, ...
        beside: usize = 3,
        /// ... each this far from the one before.
        beside_turn: f64 = 0.35,
        /// A point is reached within this distance.
        at_point: f64 = 0.12,
        /// The room around the centre of a place to which the robot goes.
        room: f64 = 0.41,
        /// A centre nearer than this is where the robot is.
        is_there: f64 = 0.2,
        /// How far a dead end extends, or the place where a door turned out to be none.
        end_extent: f64 = 1.0,
        /// The longest way without a junction or a dead end.
        longest_search: f64 = 1_000.0 => 0.0..=100_000.0,
        /// The longest way of a run.
        longest_way: f64 = 30_000.0 => 0.0..=100_000.0,
    }
}

impl CorridorParams {
    /// Those of a robot in hallways: what belongs to a place is nearer to its centre than to the next place, and the robot
    /// stands near the centre of a place, as the directions of doors are measured from there.
    const HALLWAYS: Self = Self {
        left_behind: 1.3,
        came_from: 0.3,
        same_place: 1.5,
        looked: 1.0,
        near_place: 1.5,
        no_junction: 0.6,
        off_centre: 0.3,
        look_closer: 0.3,
        at_centre: 1.0,
        further: 0.5,
        marker_range: 0.6,
        marker_memory: 6.0,
        step: 0.3,
        look_ahead: 0.7,
        leaving_measured: 1.5,
        bend_after: 1.5,
        bend_back: 1.5,
        room: 0.3,
        ..Self::DEFAULT
    };

    /// Those of a robot in a building in which corners are vertices, or are not.
    pub(super) fn for_corners(corners: bool) -> &'static Self {
        if corners { &Self::HALLWAYS } else { &Self::DEFAULT }
    }

    /// Whether two directions are of one arm.
    pub(super) fn is_same_arm(&self, one: f64, other: f64) -> bool {
        wrapped(one - other).abs() < self.same_arm
    }
}
