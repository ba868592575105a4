//! Other robots as markers: Bender and Slonim, "The power of team exploration: two robots can learn unlabeled directed
//! graphs" (1994). Here the graphs are undirected and embedded, and the robots sense more.
//!
//! All robots begin at the start vertex, with their backs to the facing door. The explorer moves, or sends another robot
//! through a door, and knows at once what that one perceives, as by radio. Without radio, each can go back the way it came
//! and talk where they meet: they know the same, only later. Robots at one vertex see each other, and, if they show
//! it, along which door each stands, with its back to it.

use super::{Aid, AidAction, PlaceNames, Places, RefusedAction, State, are_in};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    marker::MarkerPart,
    percept::{Door, OtherRobot, Sighting, TeamView},
};

/// Two or three robots. Places are the poses of those beside the explorer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Team {
    /// Their number, from 2 to 3.
    robots: u8,
    shows_heading: bool,
}

/// Two robots, each of which shows the other along which dart it stands.
pub const PAIR: Team = Team::of(2, true);

impl Team {
    pub(crate) const fn of(robots: u8, shows_heading: bool) -> Self {
        Self { robots, shows_heading }
    }

    pub fn robots(self) -> u8 {
        self.robots
    }

    pub fn shows_heading(self) -> bool {
        self.shows_heading
    }

    /// Whether so many robots can be seen so.
    pub(super) fn shows(self, view: TeamView) -> bool {
        let others = view.0.iter().take_while(|other| **other != OtherRobot::Absent).count();
        let is_shown = |other: &OtherRobot| match other {
            OtherRobot::Absent | OtherRobot::Elsewhere { .. } => true,
            OtherRobot::Here | OtherRobot::WithSecond => !self.shows_heading,
            OtherRobot::HereAlong(_) | OtherRobot::WithSecondAlong(_) => self.shows_heading,
        };
        others + 1 == usize::from(self.robots) && view.0.iter().all(is_shown)
    }

    /// The door along which a robot stands, as another one at its vertex counts, if that is shown.
    fn along(self, graph: &EmbeddedGraph, from: Dart, other: Dart) -> Option<Door> {
        let (from, to) = (graph.index(from), graph.index(other));
        self.shows_heading.then(|| Door::between(from, to, graph.degree_around(other)))
    }

    fn others(placed: &Places) -> impl Iterator<Item = Dart> {
        placed.iter().filter_map(|pose| *pose)
    }
}

impl Aid for Team {
    type Placed = Places;

    fn name(&self) -> &'static str {
        match (self.robots, self.shows_heading) {
            (2, true) => "team-2",
            (2, false) => "team-2-round",
            (_, true) => "team-3",
            (_, false) => "team-3-round",
        }
    }

    fn about(&self) -> &'static str {
        match (self.robots, self.shows_heading) {
            (2, true) => {
                "another robot, at the start vertex at first, that can be sent through doors: is it here, and along which \
                 door does it stand?"
            }
            (2, false) => {
                "another robot without a front, at the start vertex at first, that can be sent through doors: is it here?"
            }
            (_, true) => {
                "two other robots, at the start vertex at first, that can be sent through doors: which of them are here, \
                 and along which doors do they stand?"
            }
            (_, false) => {
                "two other robots without a front, at the start vertex at first, that can be sent through doors: which \
                 of them are here?"
            }
        }
    }

    fn placed(&self, _graph: &EmbeddedGraph, facing: Dart) -> Places {
        Places::from_elem(Some(facing), usize::from(self.robots) - 1)
    }

    fn exists(&self, graph: &EmbeddedGraph, placed: &Places) -> bool {
        let parts = usize::from(self.robots) - 1;
        are_in(placed, graph, parts..=parts)
    }

    fn sighting(&self, graph: &EmbeddedGraph, state: &State<Places>) -> Sighting {
        let mut view = TeamView::default();
        let mut second = None;
        for (shown, other) in view.0.iter_mut().zip(Self::others(&state.placed)) {
            let is_with = |robot: &Dart| graph.vertex(*robot) == graph.vertex(other);
            *shown = if is_with(&state.pose) {
                let along = self.along(graph, state.pose, other);
                along.map_or(OtherRobot::Here, OtherRobot::HereAlong)
            } else if let Some(second) = second.filter(is_with) {
                let along = self.along(graph, second, other);
                along.map_or(OtherRobot::WithSecond, OtherRobot::WithSecondAlong)
            } else {
                OtherRobot::Elsewhere { degree: graph.degree_around(other) }
            };
            second = Some(other);
        }
        Sighting::Team(view)
    }

    fn first_alike(&self, _graph: &EmbeddedGraph, facing: Dart) -> Dart {
        facing
    }

    fn starts(&self, _graph: &EmbeddedGraph, facing: Dart) -> Vec<Dart> {
        vec![facing]
    }

    fn parts(&self, _graph: &EmbeddedGraph, facing: Dart) -> Vec<MarkerPart> {
        vec![MarkerPart::Robot { pose: facing, shows_heading: self.shows_heading }]
    }

    /// `&2@vertex:door` for each other robot.
    fn placed_text(&self, placed: &Places, names: &dyn PlaceNames) -> String {
        let robots = (2..).zip(Self::others(placed));
        let texts: Vec<_> =
            robots.map(|(robot, pose)| format!("&{robot}@{}", names.dart(pose))).collect();
        texts.concat()
    }

    fn moves(&self) -> bool {
        true
    }

    fn actions(&self, graph: &EmbeddedGraph, state: &State<Places>) -> Vec<AidAction> {
        let robots = (2..).zip(Self::others(&state.placed));
        let doors = |(robot, pose): (u8, Dart)| {
            let doors = (0..graph.degree_around(pose)).map(Door);
            doors.map(move |door| AidAction::Send { robot, door })
        };
        robots.flat_map(doors).collect()
    }

    fn act(
        &self,
        graph: &EmbeddedGraph,
        state: &mut State<Places>,
        action: AidAction,
    ) -> Result<(), RefusedAction> {
        let AidAction::Send { robot, door } = action else {
            return Err(action.refused());
        };
        let other = usize::from(robot).checked_sub(2).and_then(|at| state.placed.get_mut(at));
        let Some(Some(pose)) = other else { return Err(action.refused()) };
        let degree = graph.degree_around(*pose);
        if door.0 >= degree {
            return Err(RefusedAction::NoSuchDoor { door, degree });
        }
        *pose = graph.after(*pose, door);
        Ok(())
    }
}
