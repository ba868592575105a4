//! The parameters of sensing with a laser scanner, in one place.
//!
//! Lengths are in metres and angles in radians. A TOML file sets them, with one table for each struct
//! ([`params::read`]). The defaults are for buildings with corridors, and come from:
//!
//! * **geometry**: the robot, the scanner or the building gives the value;
//! * **logs**: chosen on the logs of `docs/real-logs.md`, the same for all of them;
//! * **simulated buildings**: chosen on those of `evaluate laser --seed 7`.
//!
//! When to change one for another building:
//!
//! * [`ArmParams::min_arm`], if corridors are shorter than 10 m between junctions and ends, or rooms deeper;
//! * [`LocalMapParams::min_width`], if corridors are narrower than 1.2 m, or doors of rooms wider;
//! * [`ArmParams::min_width`] and [`ArmParams::max_width`], if corridors are not about 2 m wide;
//! * [`CornerParams::corners`], if bends and dead ends are vertices of the world ([`LaserParams::HALLWAYS`], if
//!   hallways are short, too);
//! * [`MatchingParams::rounds`] (8), if the heading of odometry drifts and the log is sensed live, before its drift can
//!   be measured;
//! * [`LocalMapParams::memory`], if odometry drifts more than a cell on 18 m;
//! * [`VisitParams::views`] and [`VisitParams::agree`], if the robot passes junctions faster than it takes scans.

use std::f64::consts::PI;

use toposlam_model::driving::{odometry::Odometry, scene::wrapped};

use crate::params;

/// The walls of a corridor return rays up to this part of a scanner's range: there they meet it at a small angle.
const WALLS_REACHED: f64 = 0.95;
/// A way is known up to this part of a scanner's range.
const WAY_KNOWN: f64 = 0.8;

params! {
    /// All parameters of sensing with a laser scanner.
    LaserParams {
        /// Where scans were taken.
        matching: MatchingParams = MatchingParams::DEFAULT,
        /// The local map.
        map: LocalMapParams = LocalMapParams::DEFAULT,
        /// The arms of a junction.
        arm: ArmParams = ArmParams::DEFAULT,
        /// Corners and dead ends.
        corner: CornerParams = CornerParams::DEFAULT,
        /// Visits of junctions.
        visit: VisitParams = VisitParams::DEFAULT,
        /// Whether a building is a network of corridors.
        network: NetworkParams = NetworkParams::DEFAULT,
    }

    /// Scan matching: where a scan was taken, by odometry and by the walls of earlier scans.
    MatchingParams {
        /// Walls farther from the scanner are not matched. Geometry: there two rays are a small step of a wall apart.
        range: f64 = 15.0,
        /// A point is on a wall if its neighbours make a straight line at least this long. Geometry.
        line: f64 = 0.4,
        /// Neighbours farther apart than this do not lie on one wall. Geometry.
        max_step: f64 = 1.2,
        /// The standard deviation of the points of a straight line. Geometry: the scanner's noise.
        straight: f64 = 0.04,
        /// Points of one wall that are nearer to each other than this are one. Geometry.
        spacing: f64 = 0.2,
        /// A point is matched with one at most this far away. Geometry.
        reach: f64 = 1.0,
        /// The cosine of the angle between two pieces of the same wall. Geometry: 30 degrees.
        same_direction: f64 = 0.866,
        /// How often points are matched and the pose is improved; 8 are enough. With 0 odometry alone decides: on the
        /// logs, which do not drift, more junctions are right then. Logs.
        rounds: usize = 0 => 0.0..=100.0,
        /// If the heading of the odometry of a log drifts by more in 10 m, its scans are matched nevertheless. Geometry:
        /// with less, few scans are a cell off the walls of a local map.
        max_drift: f64 = 0.02,
        /// Matched walls are at most this far apart in the first round. Geometry: a quarter of a corridor.
        first_gate: f64 = 0.6,
        /// Matched walls are at most this far apart in the last round. Geometry.
        gate: f64 = 0.25,
        /// The standard deviation of a matched point from its wall. Geometry.
        deviation: f64 = 0.1,
        /// With fewer matches odometry alone decides. Geometry.
        min_matches: usize = 12,
        /// The standard deviation of odometry between two scans. Geometry: a robot with wheels.
        shift: f64 = 0.03,
        /// More of it, for each metre of the way. Geometry.
        shift_per_metre: f64 = 0.1,
        /// The standard deviation of the heading by odometry between two scans. Geometry.
        turn: f64 = 0.01,
        /// More of it, for each metre of the way. Geometry: 14 degrees in 10 m.
        turn_per_metre: f64 = 0.025,
        /// More of it, for each radian that the robot turns. Geometry.
        turn_per_radian: f64 = 0.1,
        /// A match so many standard deviations off odometry is wrong. Geometry.
        max_deviations: f64 = 3.0,
    }

    /// The local map: what the last scans have shown around the robot.
    LocalMapParams {
        /// The side of a cell. Geometry: an eighth of the narrowest way.
        cell: f64 = 0.15 => 0.02..=1.0,
        /// Junctions and their arms are looked for up to this far from the robot, along both axes.
        /// Geometry: more than [`ArmParams::min_arm`] from a junction a few metres away.
        reach: f64 = 16.0 => 2.0..=40.0,
        /// A scan is forgotten when the robot has driven this far since. Logs.
        memory: f64 = 18.0,
        /// A scan is used when the robot has driven this far since the last one that was, or has turned
        /// by [`Self::every_turn`]. Geometry: a few views while a junction is passed.
        every: f64 = 0.4,
        /// See [`Self::every`]. Geometry.
        every_turn: f64 = 0.3,
        /// The same length in a log: a scan is used if none is that is nearer. Geometry: half of a corridor.
        logged_every: f64 = 0.8,
        /// A cell is an obstacle if at least this part of the rays that reached it ended there. Logs.
        occupied: f64 = 0.18,
        /// Two neighbouring rays end on one wall if their ends are nearer to each other than this, and on a line with a
        /// third. Geometry: along a corridor rays meet its walls far apart.
        bridge: f64 = 3.0,
        /// Each of the two is at most this part of their distance off the line through the other one and the next reading.
        /// Geometry: door frames are deep.
        straight: f64 = 0.3,
        /// Or one of them is at most this part off: the wall ends with the other one. Simulated buildings: the far wall of an
        /// arm may lie near the line of a corridor's wall, which ends before. [`LaserParams::HALLWAYS`] allow more: more maps are right.
        continued: f64 = 0.08,
        /// Readings without a return between two others that are at most this far apart show free space up to the nearer
        /// one of these. Geometry: the walls of a corridor end at the scanner's range, at least 26 m away.
        max_silence: f64 = 0.1,
        /// Obstacles smaller than this along both axes do not divide a way. Geometry: people, chairs.
        small_obstacle: f64 = 1.0,
        /// Unless they stand in a straight row at least this long, ... Geometry: the mullions of a glass front are a wall.
        row: f64 = 4.5,
        /// ... with gaps narrower than this. Geometry: the doors of rooms are wider.
        row_gap: f64 = 0.9,
        /// A gap narrower than this is no way. Geometry: the doors of rooms.
        min_width: f64 = 1.2,
        /// The robot is at most this far from a way that is wide enough for it. Geometry: half of a corridor.
        beside_robot: f64 = 1.5,
    }

    /// The arms of a junction.
    ArmParams {
        /// An arm that is seen to end nearer than this, along the free space from the junction's centre, does not count.
        /// Geometry: rooms and entrances are less deep.
        min_arm: f64 = 10.0,
        /// A way as wide as a corridor that is not seen to end is a possible arm from this length on. Geometry: shorter
        /// ones are niches.
        min_possible: f64 = 4.0,
        /// A way counts as an arm if the robot drove it for [`Self::min_arm`], or for this part of what is known of it, if it
        /// is not seen to end. Geometry: robots cut corners.
        driven_part: f64 = 0.8,
        /// It also counts if free space is seen this far on a straight line from the junction's centre, ...
        /// Geometry: what is left to [`Self::min_arm`] are the cells at both ends.
        sight: f64 = 9.5,
        /// ... with straight walls on both sides along this part of the line, ... Logs: one sees as far through glass, or the
        /// door of a room.
        far_walls: f64 = 0.15,
        /// ... or on one side along this part. Logs.
        far_wall: f64 = 0.5,
        /// A way that reaches no farther than this behind the walls of the junction is none. Geometry.
        min_behind: f64 = 0.5,
        /// Any other way is a possible arm only if it is at least this wide, ... Geometry: the doors of rooms.
        min_width: f64 = 1.55,
        /// ... at most this wide, ... Geometry: halls.
        max_width: f64 = 2.45,
        /// ... and the gap at its end is at least this part of its width, and ... Logs.
        min_gap: f64 = 0.6,
        /// ... at most this many times its width: otherwise it is a room, seen through a door. Logs.
        max_gap: f64 = 2.1,
        /// A shorter one is a possible arm if the scanner did not look at its end: with an unobstructed view, the gap there
        /// lay this far beyond the field of view, ... Logs and simulated buildings.
        unseen_turn: f64 = 0.3,
        /// ... is this many times as wide as the arm, because the edge of the field of view cuts the arm obliquely, or as
        /// wide as the arm where that is cut at its mouth, ... Simulated buildings.
        unseen_gap: f64 = 1.3,
        /// ... (a mouth is where the middle line leads no farther than this behind the walls of the junction; logs: rooms) ...
        mouth: f64 = 0.75,
        /// ... and no wall of this width faces the junction behind the mouth, ... Logs: niches.
        niche_wall: f64 = 1.2,
        /// ... and it is at least this wide between its walls. Logs: the doors of rooms are narrower.
        unseen_width: f64 = 1.5,
        /// If the scanner did not look at its end, it is also a possible arm if one sees [`Self::min_possible`] into it, with a
        /// straight wall on one side along this part of what one sees, and no wall ahead. Simulated buildings: a scanner that
        /// looks ahead sees only one wall of a corridor beside it.
        one_wall: f64 = 0.4,
        /// An arm narrower than [`Self::min_width`] whose gap is this many times as wide is a room behind a door. Logs.
        room_gap: f64 = 3.5,
        /// A way ends where one sees a wall ahead that is this part of its width, ... Geometry: less is furniture.
        facing_wall: f64 = 0.6,
        /// ... unless straight walls along this part of it are seen on both sides: then it bends. Logs and plans.
        bend_wall: f64 = 0.2,
        /// Two ways around an obstacle are one if they are shorter together. Geometry: an obstacle 2 m long in a corridor.
        around_obstacle: f64 = 10.0,
        /// Free space that was seen to end goes on nevertheless if a stretch of its border at least this long lies
        /// around a corner, within [`Self::border_near`] of the end. Logs.
        border: f64 = 0.6,
        /// See [`Self::border`]. Logs.
        border_near: f64 = 1.8,
        /// A maximum of the distance from the robot is an end of a way if every other end is reached only
        /// over cells this much nearer to the robot. Geometry: half of a corridor.
        min_prominence: f64 = 1.0,
        /// Meet points nearer to each other than this many times their distance from the walls are one
        /// junction. Simulated buildings: corridors that cross at an angle meet in two points.
        merge: f64 = 1.3,
        /// The direction of an arm is measured this far behind the walls of the junction. Geometry.
        direction: f64 = 1.5,
        /// A robot this near to the middle line of an arm drives it; where the walls are farther away, one up to the walls.
        /// Geometry: half of a corridor.
        robot_near: f64 = 0.8,
    }

    /// Corners and dead ends.
    CornerParams {
        /// Whether the bends and the dead ends of corridors are vertices of the world.
        corners: bool = false,
        /// The directions of the arms of a bend are measured this far from it, along the middle line.
        /// Geometry: more than the width of a corridor.
        arm: f64 = 2.5,
        /// A bend by at least this angle is a corner. Geometry: between 45 and 90 degrees.
        min_turn: f64 = 1.05,
        /// A robot whose way bends by more turns back, and passes no corner. Geometry.
        max_turn: f64 = 2.2,
        /// The way is remembered for this many times [`Self::arm`]. Geometry.
        memory: f64 = 8.0,
        /// A way that ends is a dead end if it is at least this long. Geometry: more than a room.
        min_way: f64 = 5.0,
    }

    /// Visits of places.
    VisitParams {
        /// A junction is seen from up to this far behind its walls. Logs.
        range: f64 = 4.0,
        /// Junctions nearer to each other than this in two views are the same. Geometry: half of the
        /// shortest way between two.
        same: f64 = 1.5,
        /// Arms nearer to each other than this in two views are the same. Geometry: under half of the
        /// angle between two arms of a junction with eight.
        same_arm: f64 = 0.6,
        /// The ways in and out are of an arm if they are this near to it. Geometry: they are measured at the walls.
        same_way: f64 = 0.8,
        /// A robot this near to the centre of a junction is inside, and so is one up to its walls. Geometry.
        inside: f64 = 1.0,
        /// A robot this near to the end of a way visits the dead end. Geometry: robots turn before a wall.
        dead_end: f64 = 3.0,
        /// A robot farther than this behind the walls of a junction has left it. Geometry.
        leave: f64 = 0.1,
        /// A visit is decided when the robot has driven this far since it left. Logs.
        settle: f64 = 2.5,
        /// The number of views that decide: the last ones, which have seen most. Logs.
        views: usize = 8,
        /// Their number in a log, where all have seen the same. Logs.
        logged_views: usize = 40,
        /// An arm counts if it is seen in at least this part of them ... Logs.
        agree: f64 = 0.4,
        /// ... or in this part, if the robot came or left by it, ... Logs.
        traversed: f64 = 0.25,
        /// ... and it is possible if the part is as near as this to [`Self::agree`]. Logs.
        doubt: f64 = 0.2,
        /// An arm in doubt matters if it is in so many views of a junction. Logs.
        doubted_views: usize = 2,
        /// ... and in this part of them: all views of a place show nearly the same. Logs.
        doubted_part: f64 = 0.65,
        /// A junction that was not seen on this length of the way is forgotten. Geometry: odometry drifts.
        memory: f64 = 30.0,
        /// A robot this near to where it was before goes back. Geometry: less than half of a corridor.
        retraced: f64 = 0.6,
        /// A robot that left a place this far from where it came in has not gone back. Geometry: more than a corridor.
        apart: f64 = 2.5,
        /// A robot has turned back once it has gone back for half of this length. Geometry: less is manoeuvring.
        turned_back: f64 = 4.0,
        /// A robot that has not driven farther than this since the log began was always there. Geometry.
        beginning: f64 = 2.0,
        /// The direction of a robot's way is compared with the field of view over this length. Geometry.
        unseen_step: f64 = 0.5,
        /// A scanner that looks within this angle of the robot's way sees the hallway there. Geometry.
        unseen_angle: f64 = PI / 24.0,
        /// A way of this length on which the scanner does not look ahead may pass a junction. Geometry: a shorter one
        /// is manoeuvring.
        unseen_way: f64 = 2.0,
    }

    /// What is no network of corridors.
    NetworkParams {
        /// A corridor is at most this wide. Logs: those of networks are at most 3.5 m wide, but for their lobbies.
        widest: f64 = 4.0,
        /// If free space is wider on more than this part of the robot's way, the building is no network of corridors. Logs:
        /// it is on 0 to 5 % of the way in three networks, and on 39 to 79 % in a castle and two halls.
        wide_part: f64 = 0.2,
        /// Junctions of corridors have fewer doors than this. Geometry: five ways or more meet in halls.
        many_doors: usize = 5 => 3.0..=100.0,
        /// If at least so many visits are of places with more doors, ... Logs.
        many_visits: usize = 3,
        /// ... and at least this part of them, the building is no network of corridors. Logs.
        many_part: f64 = 0.34,
    }
}

impl LaserParams {
    /// For buildings in which corners are vertices, with hallways that are 1.4 to 2 m wide and places from 2.8 m apart. A robot
    /// there stands at a place before it goes on, so it needs no more of the building than what is around it; its odometry may
    /// drift, and walls are near enough to be matched. Simulated buildings, those of `evaluate runs --seed 1`.
    pub const HALLWAYS: Self = Self {
        matching: MatchingParams { rounds: 8, ..MatchingParams::DEFAULT },
        map: LocalMapParams {
            cell: 0.08,
            occupied: IN_MATCHED_SCANS,
            continued: 0.3,
            reach: 8.0,
            memory: 6.0,
            every: 0.3,
            min_width: 1.0,
            ..LocalMapParams::DEFAULT
        },
        arm: ArmParams {
            min_arm: 3.0,
            min_possible: 2.0,
            sight: 3.0,
            min_width: 0.95,
            around_obstacle: 5.0,
            border_near: 0.9,
            ..ArmParams::DEFAULT
        },
        corner: CornerParams { corners: true, arm: 1.5, min_way: 2.0, ..CornerParams::DEFAULT },
        visit: VisitParams { range: 2.5, same: 1.0, inside: 0.5, ..VisitParams::DEFAULT },
        ..Self::DEFAULT
    };

    /// The same where scans are placed by the walls that they show. What a user has set stays.
    #[must_use]
    pub fn for_matched_scans(mut self) -> Self {
        if self.map.occupied.to_bits() == LocalMapParams::DEFAULT.occupied.to_bits() {
            self.map.occupied = IN_MATCHED_SCANS;
        }
        self
    }

    /// The same for a scanner of this range, in metres. In a corridor the readings between the farthest points of its walls that
    /// a scanner reaches have no return: they show that nothing is nearer. And a way is known no farther than its range. What
    /// a user has set stays.
    #[must_use]
    pub fn for_range(mut self, range: f64) -> Self {
        let Self { map, arm, .. } = &mut self;
        let (usual_map, usual_arm) = (LocalMapParams::DEFAULT, ArmParams::DEFAULT);
        if map.max_silence.to_bits() == usual_map.max_silence.to_bits() {
            let reached = WALLS_REACHED * range;
            let silent = 2.0 * (arm.max_width / 2.0 / reached.max(arm.max_width)).asin();
            map.max_silence = map.max_silence.max(silent);
        }
        if arm.min_possible.to_bits() == usual_arm.min_possible.to_bits() {
            arm.min_possible = arm.min_possible.min(WAY_KNOWN * range);
        }
        self
    }
}

/// [`LocalMapParams::occupied`] where scans are placed by the walls that they show: these are off by a cell more often than by
/// good odometry. Logs, with a heading that drifts.
const IN_MATCHED_SCANS: f64 = 0.25;

impl LocalMapParams {
    /// The number of cells of a side of a local map; the robot is in the one in the middle.
    pub(super) fn window(&self) -> usize {
        2 * (self.reach / self.cell).ceil() as usize + 1
    }

    /// How far the robot has driven since the last scan that was used, in metres; `None` if this one is not used, because the
    /// robot has hardly moved.
    pub(super) fn driven(&self, last: &mut Option<Odometry>, odometry: &Odometry) -> Option<f64> {
        let driven = last.map_or(0.0, |last| last.distance(odometry));
        let turned = last.map_or(0.0, |last| wrapped(odometry.heading - last.heading).abs());
        let is_used = last.is_none() || driven >= self.every || turned >= self.every_turn;
        is_used.then(|| {
            *last = Some(*odometry);
            driven
        })
    }
}

impl CornerParams {
    /// The angle by which a way bends that comes from one direction and goes in another.
    pub fn bend([one, other]: [f64; 2]) -> f64 {
        PI - wrapped(one - other).abs()
    }

    /// Whether a bend by this angle is that of a corner, and not of a robot that turns back.
    pub fn is_bend(&self, angle: f64) -> bool {
        (self.min_turn..self.max_turn).contains(&angle)
    }

    /// Whether a place with ways in these directions is a vertex.
    pub fn is_corner(&self, ways: [f64; 2]) -> bool {
        self.corners && self.is_bend(Self::bend(ways))
    }
}

impl VisitParams {
    /// A robot this near to the centre of a junction is inside, in metres.
    pub(crate) fn radius(&self, clearance: f64) -> f64 {
        clearance.max(self.inside)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::{read, read_over};

    #[test]
    fn a_file_changes_what_is_in_it_and_nothing_else() {
        let params: LaserParams = read("[arm]\nmin_arm = 6.5\n[corner]\ncorners = true").unwrap();
        let mut expected = LaserParams::default();
        expected.arm.min_arm = 6.5;
        expected.corner.corners = true;
        assert_eq!(params, expected);
        assert_eq!(read(""), Ok(LaserParams::default()));
        assert_eq!(read(&toml::to_string(&params).unwrap()), Ok(params));
        // A whole number is as good as any other.
        let params: LaserParams = read("[arm]\nmin_gap = 0").unwrap();
        assert!(params.arm.min_gap.abs() < 1e-12);
    }

    #[test]
    fn a_file_changes_other_parameters_than_the_default_in_the_same_way() {
        let text = "[arm]\nmin_arm = 4\n[corner]\ncorners = false";
        let mut expected = LaserParams::HALLWAYS;
        expected.arm.min_arm = 4.0;
        expected.corner.corners = false;
        assert_eq!(read_over(&LaserParams::HALLWAYS, text), Ok(expected));
        assert_eq!(read_over(&LaserParams::HALLWAYS, ""), Ok(LaserParams::HALLWAYS));
        assert_eq!(
            read_over(&LaserParams::HALLWAYS, "[arm]\nmin = 2.0").unwrap_err(),
            read::<LaserParams>("[arm]\nmin = 2.0").unwrap_err()
        );
    }

    /// With 30 m nothing changes; with 3.5 m a corridor 2 m wide shows walls up to 17 degrees from its axis.
    #[test]
    fn a_scanner_of_a_short_range_shows_that_nothing_is_near_where_nothing_returns() {
        let seen_to = |range| LaserParams::default().for_range(range);
        assert_eq!(seen_to(30.0), LaserParams::default());
        let short = seen_to(3.5);
        assert!(short.map.max_silence > 2.0 * 17_f64.to_radians(), "{short:?}");
        assert!((short.arm.min_possible - 2.8).abs() < 1e-9);
        assert!(seen_to(0.1).map.max_silence <= PI);
        let given: LaserParams =
            read("[map]\nmax_silence = 0.05\n[arm]\nmin_possible = 3.0").unwrap();
        assert_eq!(given.for_range(3.5), given, "what a file sets");
    }

    #[test]
    fn where_scans_are_matched_more_rays_must_end_at_a_wall() {
        let usual = LaserParams::default();
        let matched = usual.for_matched_scans();
        assert!(matched.map.occupied > usual.map.occupied, "{matched:?}");
        assert_eq!(LaserParams { map: usual.map, ..matched }, usual);
        let given: LaserParams = read("[map]\noccupied = 0.1").unwrap();
        assert_eq!(given.for_matched_scans(), given, "what a file sets");
    }

    const ERRORS: &str = r#"
[arm]\nmin = 2.0 | line 2, column 1: arm.min: unknown key; expected one of: min_arm,
min_arm = 2.0 | line 1, column 1: min_arm: unknown key; expected one of: matching, map, arm, corner, visit, network
[arm]\nmin_arm = "far" | line 2, column 11: arm.min_arm: expected a number, found a text
[arm]\nmin_arm = -1.0 | line 2, column 11: arm.min_arm: -1 is out of range; this parameter lies between 0 and 1000
[arm]\nmin_arm = nan | line 2, column 11: arm.min_arm: NaN is out of range; this parameter lies between 0 and 1000
[map]\ncell = 0.0001 | line 2, column 8: map.cell: 0.0001 is out of range; this parameter lies between 0.02 and 1
[map]\nreach = inf | line 2, column 9: map.reach: inf is out of range; this parameter lies between 2 and 40
[visit]\nviews = 0 | line 2, column 9: visit.views: 0 is out of range; this parameter lies between 1 and 1000
[arm | line
[corner]\ncorners = yes | line"#;

    #[test]
    fn unknown_keys_and_impossible_numbers_are_errors() {
        for row in ERRORS.lines().skip(1) {
            let (text, error) = row.split_once(" | ").unwrap();
            let message = read::<LaserParams>(&text.replace(r"\n", "\n")).unwrap_err().to_string();
            assert!(message.starts_with(error) && !message.contains('\n'), "{message}");
        }
    }
}
