//! What a run may spend, and whether the robot can still return to its marker.
//!
//! The way back is the way by which the robot has come since it last saw the marker, without what it went to and
//! fro. So it does not depend on the map, and is right even if the map is not.

use std::fmt;

use nalgebra::Vector3;
use toposlam_model::percept::{Door, Percept, Sighting};

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RunBudget {
    pub moves: Option<u64>,
    /// By the robot's clock.
    pub seconds: Option<f64>,
    /// As far as the battery lasts.
    pub metres: Option<f64>,
}

/// What a run, or a part of it, has spent: moves, seconds by the robot's clock, metres by odometry.
pub type Spent = Vector3<f64>;

/// The limit of a budget that the run comes near.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BudgetLimit {
    Moves(u64),
    /// In seconds.
    Time(f64),
    /// In metres.
    Way(f64),
}

impl fmt::Display for BudgetLimit {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Moves(1) => write!(out, "1 move"),
            Self::Moves(moves) => write!(out, "{moves} moves"),
            Self::Time(seconds) => write!(out, "{:.1} minutes", seconds / 60.0),
            Self::Way(metres) => write!(out, "{metres:.0} m on one battery"),
        }
    }
}

fn exceeded(spent: Spent, budget: RunBudget) -> Option<BudgetLimit> {
    let moves = budget.moves.filter(|&most| spent.x > most as f64).map(BudgetLimit::Moves);
    let time = budget.seconds.filter(|&most| spent.y > most).map(BudgetLimit::Time);
    let way = budget.metres.filter(|&most| spent.z > most).map(BudgetLimit::Way);
    moves.or(time).or(way)
}

/// A hallway that takes this is expected at first.
const FIRST: Spent = Spent::new(1.0, 180.0, 30.0);
/// A hallway may take this many times as much as the longest so far, in time and way; the way back, as what it took
/// so far.
const MARGIN: Spent = Spent::new(1.0, 1.5, 1.5);

/// A hallway on the way from the marker.
#[derive(Clone, Copy, Debug)]
struct Leg {
    /// The door by which the robot left, counted from the one by which it first came in.
    door: u32,
    cost: Spent,
}

/// A robot's budget, and its way back to the marker.
#[derive(Clone, Debug, Default)]
pub struct Allowance {
    budget: RunBudget,
    spent: Spent,
    longest: Option<Spent>,
    legs: Vec<Leg>,
    /// The door by which the robot has come in, counted from the one by which it first came in.
    entry: u32,
    /// 0 before the first junction.
    degree: u32,
    leaving: Option<Leaving>,
    knows_way: bool,
    returns: bool,
}

#[derive(Clone, Copy, Debug)]
enum Leaving {
    /// The last one of the way, back.
    Back,
    /// Another one, by a door counted from the one by which the robot first came in.
    On(u32),
}

impl Allowance {
    pub fn new(budget: RunBudget) -> Self {
        Self { budget, ..Self::default() }
    }

    fn way_back(&self) -> Spent {
        self.legs.iter().map(|leg| leg.cost).sum::<Spent>().component_mul(&MARGIN)
    }

    fn door(&self, door: Door) -> u32 {
        (self.entry + door.0) % self.degree.max(1)
    }

    /// The limit that would not allow to take a door and to return to the marker.
    pub fn forbids(&self, door: Door, spent: Spent) -> Option<BudgetLimit> {
        if !self.legs.is_empty() && self.door(door) == 0 {
            return None;
        }
        let there = self.longest.map_or(FIRST, |longest| longest.component_mul(&MARGIN));
        exceeded(spent + 2.0 * there + self.way_back(), self.budget)
    }

    /// The limit that is exceeded, unless the robot is on its way back.
    pub fn limit_reached(&self, spent: Spent) -> Option<BudgetLimit> {
        exceeded(spent, self.budget).filter(|_| !self.returns)
    }

    /// The robot returns to its marker, whatever that takes.
    pub fn begin_return(&mut self) {
        self.returns = true;
    }

    /// The robot takes a door.
    pub fn leave(&mut self, door: Door, spent: Spent) {
        self.spent = spent;
        let door = self.door(door);
        let back = !self.legs.is_empty() && door == 0;
        self.leaving = Some(if back { Leaving::Back } else { Leaving::On(door) });
    }

    /// The robot has come to the next junction, and perceives it.
    pub fn perceive(&mut self, Percept { degree, sighting }: Percept, spent: Spent) {
        // A recovery may have made more moves.
        let mut cost = spent - self.spent;
        cost.x = 1.0;
        let leaving = self.leaving.take();
        if leaving.is_some() {
            self.longest = Some(self.longest.map_or(cost, |longest| longest.sup(&cost)));
        }
        match (leaving, self.legs.last().copied()) {
            (Some(Leaving::Back), Some(leg)) => {
                self.legs.pop();
                self.entry = leg.door;
            }
            (Some(Leaving::On(door)), _) => {
                self.legs.push(Leg { door, cost });
                self.entry = 0;
            }
            // The robot was lost, or begins.
            _ => self.knows_way = false,
        }
        self.degree = degree;
        if matches!(sighting, Sighting::Pointing(_)) {
            self.legs.clear();
            (self.entry, self.knows_way) = (0, true);
        }
    }

    pub fn lose_way(&mut self) {
        self.knows_way = false;
        self.leaving = None;
        self.legs.clear();
        self.entry = 0;
    }

    /// The door of the way back; `None` at the marker, or if the way is not known.
    pub fn door_back(&self) -> Option<Door> {
        let is_away = self.knows_way && !self.legs.is_empty();
        is_away.then(|| Door(self.entry).inverse(self.degree.max(1)))
    }

    pub fn is_at_marker(&self) -> bool {
        self.knows_way && self.legs.is_empty() && self.leaving.is_none()
    }
}

#[cfg(test)]
mod tests {
    use toposlam_model::{
        embedded_graph::{Dart, EmbeddedGraph},
        percept::Sighting,
        world::{GraphWorld, World},
    };

    use super::*;

    /// A triangle whose vertices each have a dead end.
    fn triangle() -> EmbeddedGraph {
        let lists =
            [("a", "b c x"), ("b", "c a y"), ("c", "a b z"), ("x", "a"), ("y", "b"), ("z", "c")];
        let lists = lists.map(|(name, others)| {
            (name.to_owned(), others.split(' ').map(str::to_owned).collect::<Vec<_>>())
        });
        EmbeddedGraph::from_neighbour_lists(&lists).unwrap()
    }

    /// A walk by some doors, as far as the budget allows, and the way back.
    fn moves(doors: &[u32], budget: RunBudget) -> (u64, Option<BudgetLimit>, bool) {
        let graph = triangle();
        let mut world = GraphWorld::new(&graph, Dart(0));
        let mut allowance = Allowance::new(budget);
        // Each move takes 10 s and 5 m.
        let spent = |world: &GraphWorld| world.moves() as f64 * Spent::new(1.0, 10.0, 5.0);
        allowance.perceive(world.sensed(), spent(&world));
        let go = |world: &mut GraphWorld, door: Door, allowance: &mut Allowance| {
            allowance.leave(door, spent(world));
            world.traverse(door).unwrap();
            allowance.perceive(world.sensed(), spent(world));
        };
        let mut limit = None;
        for &door in doors {
            let door = Door(door % world.sensed().degree);
            limit = allowance.forbids(door, spent(&world));
            if limit.is_some() {
                break;
            }
            go(&mut world, door, &mut allowance);
        }
        while let Some(door) = allowance.door_back() {
            assert_eq!(allowance.forbids(door, spent(&world)), None);
            go(&mut world, door, &mut allowance);
        }
        assert!(allowance.is_at_marker());
        (world.moves(), limit, matches!(world.sensed().sighting, Sighting::Pointing(_)))
    }

    #[test]
    fn the_robot_is_back_at_the_marker_before_its_moves_are_over() {
        let mut doors = [0_u32; 12];
        // Other doors each time.
        for seed in 0..400_u32 {
            for (at, door) in doors.iter_mut().enumerate() {
                *door = (seed.wrapping_mul(2_654_435_761) >> (2 * at)) & 3;
            }
            for most in 2..=14 {
                let budget = RunBudget { moves: Some(most), ..RunBudget::default() };
                let (moves, limit, is_at_marker) = moves(&doors, budget);
                assert!(moves <= most && is_at_marker, "{doors:?} {most}: {moves}");
                // A walk that was stopped could have gone on for less than two moves.
                assert!(limit.is_none() || moves + 2 > most, "{doors:?} {most}: {moves}");
            }
        }
    }

    #[test]
    fn time_and_way_have_margins() {
        let doors = [1, 1, 1, 1, 1, 1, 1, 1];
        let limited = |budget| moves(&doors, budget).1;
        let none = RunBudget::default();
        assert_eq!(limited(none), None);
        let seconds = |most| limited(RunBudget { seconds: Some(most), ..none });
        assert_eq!((seconds(400.0), seconds(359.0)), (None, Some(BudgetLimit::Time(359.0))));
        let metres = |most| limited(RunBudget { metres: Some(most), ..none });
        assert_eq!((metres(90.0), metres(59.0)), (None, Some(BudgetLimit::Way(59.0))));
    }

    /// Far from the marker, with 10 s for each hallway: the way back may take half as much again.
    #[test]
    fn the_way_back_has_a_margin() {
        let at = |legs: u32| f64::from(legs) * Spent::new(1.0, 10.0, 0.0);
        let mut allowance =
            Allowance::new(RunBudget { seconds: Some(380.0), ..RunBudget::default() });
        let mut legs = 0;
        let sees = |sighting| Percept { degree: 2, sighting };
        allowance.perceive(sees(Sighting::Pointing(Door(0))), at(0));
        while allowance.forbids(Door(1), at(legs)).is_none() {
            allowance.leave(Door(1), at(legs));
            legs += 1;
            allowance.perceive(sees(Sighting::Nothing), at(legs));
        }
        // 10 s for each hallway so far, 15 s for each on the way back, and 30 s for the next one, twice.
        assert_eq!(legs, (1..100).find(|legs| 25 * legs + 30 > 380).unwrap());
    }
}
