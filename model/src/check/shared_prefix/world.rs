//! A world that is decided while the robot explores it.

use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Answer, Answers, Draft},
    mapping::{FACING, ObservedWorld},
    marker::Marker,
    percept::{Door, Percept, Sighting},
    world::{MarkerCarrier, RefusedAction, State, World},
};

/// An answer of the world, and those that were not given yet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Decision {
    /// The free dart; `None` for the degree of the start vertex.
    dart: Option<Dart>,
    answer: Answer,
    left: Answers,
    pub(super) step: usize,
}

/// How the first decisions are made.
#[derive(Clone, Debug, Default)]
pub(super) enum PrefixSource {
    /// As all others: every answer is given.
    #[default]
    Open,
    Given(Vec<Answer>),
    Drawn(Vec<u64>),
}

/// The robot in its world, between two moves.
#[derive(Clone, Copy, Debug)]
pub(super) struct RobotState {
    state: State,
    pub(super) moves: u64,
    /// Whether the run has begun: the start vertex has a degree, and the marker is placed.
    pub(super) has_begun: bool,
}

/// A world of a class and a size that is decided while the robot explores it. It is a start with one of
/// the [markers](Marker) at it.
///
/// If the marker is [local](Marker::is_local), nothing is decided before the robot asks. Otherwise the whole
/// world is decided when the robot first looks.
#[derive(Debug)]
pub struct LazyWorld<M> {
    pub(super) draft: Draft,
    marker: M,
    robot: RobotState,
    bound: u64,
    pub(super) decisions: Vec<Decision>,
    prefix: PrefixSource,
    pub(super) step: usize,
    /// Whether no answer was left. The run then goes back.
    pub(super) dead_end: bool,
    pub(super) moves_made: u64,
    /// The product of the numbers of answers from which some were drawn.
    pub(super) weight: f64,
}

impl<M: Marker> LazyWorld<M> {
    pub(super) fn new(draft: Draft, marker: M, bound: u64, prefix: PrefixSource) -> Self {
        let state = State { pose: FACING, placed: None };
        Self {
            draft,
            marker,
            robot: RobotState { state, moves: 0, has_begun: false },
            bound,
            decisions: Vec::new(),
            prefix,
            step: 0,
            dead_end: false,
            moves_made: 0,
            weight: 1.0,
        }
    }

    /// The record: what has been revealed.
    pub(super) fn graph(&self) -> &EmbeddedGraph {
        self.draft.graph()
    }

    pub(super) fn robot(&self) -> RobotState {
        self.robot
    }

    pub(super) fn set_robot(&mut self, robot: RobotState) {
        self.robot = robot;
    }

    pub(super) fn pose(&self) -> Dart {
        self.robot.state.pose
    }

    /// Whether more than one answer may be possible later.
    #[inline]
    pub(super) fn may_branch(&self) -> bool {
        self.draft.edges_left() > 1
    }

    pub(super) fn answers(&self) -> Vec<Answer> {
        self.decisions.iter().map(|decision| decision.answer).collect()
    }

    /// Gives the next answer at the latest decision that has one left, and returns the step of that decision;
    /// `None` if there is none.
    pub(super) fn go_back(&mut self) -> Option<usize> {
        self.dead_end = false;
        while let Some(decision) = self.decisions.last_mut() {
            self.draft.undo(decision.dart, decision.answer);
            if let Some(next) = decision.left.take_first() {
                decision.answer = next;
                self.draft.decide(decision.dart, next);
                return Some(decision.step);
            }
            self.decisions.pop();
        }
        None
    }

    /// Decides what is behind a free dart, or the degree of the start vertex.
    #[inline(never)]
    fn decide(&mut self, dart: Option<Dart>) -> Result<(), RefusedAction> {
        let mut left = self.draft.answers(dart);
        let count = left.count();
        let index = self.decisions.len();
        let answer = match &self.prefix {
            PrefixSource::Given(answers) if index < answers.len() => {
                left = Answers::default();
                Some(answers[index])
            }
            PrefixSource::Drawn(numbers) if index < numbers.len() && count > 0 => {
                for _ in 0..numbers[index] % u64::from(count) {
                    left.take_first();
                }
                self.weight *= f64::from(count);
                let drawn = left.take_first();
                left = Answers::default();
                drawn
            }
            _ => left.take_first(),
        };
        let Some(answer) = answer else {
            self.dead_end = true;
            return Err(RefusedAction::NoWorldLeft);
        };
        self.draft.decide(dart, answer);
        self.decisions.push(Decision { dart, answer, left, step: self.step });
        Ok(())
    }

    /// Decides the degree of the start vertex, places the marker, and puts the robot there.
    pub(super) fn open_start(&mut self) -> Result<(), RefusedAction> {
        if self.graph().vertex_count() == 0 {
            self.decide(None)?;
        }
        if !self.marker.is_local() {
            loop {
                let graph = self.graph();
                let free = graph.darts().find(|&dart| graph.joined(dart).is_none());
                let Some(free) = free else { break };
                self.decide(Some(free))?;
            }
        }
        let placed = self.marker.first_alike(self.graph(), FACING);
        self.robot.state = State { pose: FACING, placed: Some(placed) };
        self.robot.has_begun = true;
        Ok(())
    }

    /// The other end of a dart's edge. If it is free, that is decided now.
    #[inline]
    fn reveal(&mut self, dart: Dart) -> Result<Dart, RefusedAction> {
        if let Some(far) = self.graph().joined(dart) {
            return Ok(far);
        }
        self.decide(Some(dart))?;
        Ok(self.graph().opposite(dart))
    }

    #[inline]
    fn sighting(&self) -> Sighting {
        let State { pose, placed } = self.robot.state;
        match placed {
            Some(placed) => self.marker.sighting(self.graph(), placed, pose),
            None => Sighting::Nothing,
        }
    }
}

impl<M: Marker> ObservedWorld for LazyWorld<M> {}

impl<M: Marker> World for LazyWorld<M> {
    type Error = RefusedAction;

    #[inline]
    fn percept(&mut self) -> Result<Percept, RefusedAction> {
        let degree = self.graph().degree_around(self.pose());
        Ok(Percept { degree, sighting: self.sighting() })
    }

    #[inline]
    fn traverse(&mut self, door: Door) -> Result<(), RefusedAction> {
        if self.robot.moves >= self.bound {
            return Err(RefusedAction::OutOfMoves { bound: self.bound });
        }
        let degree = self.graph().degree_around(self.pose());
        if door.0 >= degree {
            return Err(RefusedAction::NoSuchDoor { door, degree });
        }
        self.robot.state.pose = self.reveal(self.graph().behind(self.pose(), door))?;
        self.robot.moves += 1;
        self.moves_made += 1;
        Ok(())
    }

    fn carrier(&mut self) -> Option<&mut dyn MarkerCarrier<Error = RefusedAction>> {
        Some(self)
    }
}

impl<M: Marker> MarkerCarrier for LazyWorld<M> {
    type Error = RefusedAction;

    fn pick_up(&mut self) -> Result<(), RefusedAction> {
        if !self.marker.is_movable() || self.sighting() == Sighting::Nothing {
            return Err(RefusedAction::NothingToPickUp);
        }
        self.robot.state.placed = None;
        Ok(())
    }

    fn drop(&mut self) -> Result<(), RefusedAction> {
        if !self.marker.is_movable() || self.robot.state.placed.is_some() {
            return Err(RefusedAction::NothingToDrop);
        }
        let placed = self.marker.first_alike(self.graph(), self.pose());
        self.robot.state.placed = Some(placed);
        Ok(())
    }
}
