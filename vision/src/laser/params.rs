//! The parameters of sensing with a laser scanner.

params! {
    /// All parameters. Lengths are in metres.
    LaserParams {
        /// The side of a cell of the local map.
        cell: f64 = 0.15,
        /// The local map reaches this far from the robot in each direction.
        reach: f64 = 16.0,
        /// Scans stay in the local map while the robot drives this far.
        memory: f64 = 18.0,
        /// A scan is used when the robot has driven this far since the last one, or has turned by
        /// [`Self::every_turn`].
        every: f64 = 0.4,
        /// See [`Self::every`]; in radians.
        every_turn: f64 = 0.3,
        /// Ends of neighbouring rays on one line are ends on one wall if they are nearer than this.
        bridge: f64 = 3.0,
        /// A gap narrower than this is no way for the robot: doors of rooms are.
        min_width: f64 = 1.2,
        /// An arm of a junction that ends nearer than this, along the free space from the junction's
        /// centre, is an alcove or a room.
        min_arm: f64 = 10.0,
        /// An arm of which the end was not seen counts if it is known to go on for this far behind the
        /// walls of the junction.
        min_open_arm: f64 = 0.5,
        /// Obstacles that are smaller than this in both directions do not divide a way: furniture, people.
        small_obstacle: f64 = 1.0,
        /// A cell is occupied if at least this part of the rays that reached it ended there.
        occupied: f64 = 0.2,
        /// Meet points are one junction if they are nearer than this part of their clearance.
        merge: f64 = 1.0,
        /// The direction of an arm is measured at this distance behind the walls of the junction.
        arm_direction: f64 = 1.5,
        /// A bend of a corridor is a corner if the directions at this distance on both sides of it differ
        /// by [`Self::corner`] from straight on.
        corner_leg: f64 = 2.5,
        /// See [`Self::corner_leg`]; in radians.
        corner: f64 = 1.05,
        min_far: f64 = 3.6,
        max_opening: f64 = 2.1,
        max_corridor: f64 = 2.6,
        min_corridor: f64 = 1.55,
        frontier_near: u32 = 4,
        gap: f64 = 0.6,
        gap_near: f64 = 1.2,
        min_opening: f64 = 0.6,
        min_frontier: usize = 1,
        vote: f64 = 0.5,
        view_range: f64 = 4.0,
        same: f64 = 1.5,
        same_arm: f64 = 0.6,
        leave: f64 = 0.1,
        settle: f64 = 2.5,
        last_views: usize = 8,
    }
}
