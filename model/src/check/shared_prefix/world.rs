//! A world that is decided while the robot explores it.

use crate::{
    aid::{Action, Aid, AidAction, RefusedAction, State},
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Answer, Answers, Draft},
    mapping::{FACING, ObservedWorld},
    percept::{Door, Percept, Sighting},
    world::{AidHandler, World},
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
#[derive(Clone, Debug)]
pub(super) struct RobotState<P> {
    /// `None` until the run has begun: until the start vertex has a degree, and the aid is placed.
    state: Option<State<P>>,
    pub(super) moves: u64,
}

impl<P> RobotState<P> {
    pub(super) fn has_begun(&self) -> bool {
        self.state.is_some()
    }
}

/// A world of a class and a size that is decided while the robot explores it. It is a start with one of
/// the [aids](Aid) at it.
///
/// If the aid is [local](Aid::is_local), nothing is decided before the robot asks. Otherwise the whole
/// world is decided when the robot first looks.
#[derive(Debug)]
pub struct LazyWorld<A: Aid> {
    pub(super) draft: Draft,
    aid: A,
    robot: RobotState<A::Placed>,
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

impl<A: Aid> LazyWorld<A> {
    pub(super) fn new(draft: Draft, aid: A, bound: u64, prefix: PrefixSource) -> Self {
        Self {
            draft,
            aid,
            robot: RobotState { state: None, moves: 0 },
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

    pub(super) fn robot(&self) -> &RobotState<A::Placed> {
        &self.robot
    }

    pub(super) fn set_robot(&mut self, robot: &RobotState<A::Placed>) {
        self.robot.clone_from(robot);
    }

    #[inline]
    pub(super) fn pose(&self) -> Dart {
        self.robot.state.as_ref().map_or(FACING, |state| state.pose)
    }

    /// Whether more than one answer may be possible later.
    #[inline]
    pub(super) fn may_branch(&self) -> bool {
        self.draft.edges_left() > 1
    }

    /// Whether an answer of this step, which is the latest with a decision, is left, or may be after it is repeated.
    pub(super) fn may_go_back_to(&self, step: usize) -> bool {
        let mut decisions =
            self.decisions.iter().rev().take_while(|decision| decision.step == step);
        self.may_branch() || decisions.any(|decision| !decision.left.is_empty())
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
        let index = self.decisions.len();
        let answer = match &self.prefix {
            PrefixSource::Given(answers) if index < answers.len() => {
                left = Answers::default();
                Some(answers[index])
            }
            PrefixSource::Drawn(numbers) if index < numbers.len() && !left.is_empty() => {
                let count = left.count();
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
        if !self.aid.is_local() {
            loop {
                let graph = self.graph();
                let free = graph.darts().find(|&dart| graph.joined(dart).is_none());
                let Some(free) = free else { break };
                self.decide(Some(free))?;
            }
        }
        let placed = self.aid.placed(self.graph(), FACING);
        self.robot.state = Some(State { pose: FACING, placed });
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
}

impl<A: Aid> ObservedWorld for LazyWorld<A> {}

impl<A: Aid> World for LazyWorld<A> {
    type Error = RefusedAction;

    // As in `MapWalk::go`.
    #[expect(clippy::inline_always, reason = "see above")]
    #[inline(always)]
    fn percept(&mut self) -> Result<Percept, RefusedAction> {
        let graph = self.graph();
        let degree = graph.degree_around(self.pose());
        let sighting = match &self.robot.state {
            Some(state) => self.aid.sighting(graph, state),
            None => Sighting::Nothing,
        };
        Ok(Percept { degree, sighting })
    }

    #[expect(clippy::inline_always, reason = "see above")]
    #[inline(always)]
    fn traverse(&mut self, door: Door) -> Result<(), RefusedAction> {
        if self.robot.moves >= self.bound {
            return Err(RefusedAction::OutOfMoves { bound: self.bound });
        }
        let degree = self.graph().degree_around(self.pose());
        if door.0 >= degree {
            return Err(RefusedAction::NoSuchDoor { door, degree });
        }
        let by = self.graph().behind(self.pose(), door);
        let pose = self.reveal(by)?;
        if let Some(state) = &mut self.robot.state {
            self.aid.leave(self.draft.graph(), state, by)?;
            state.pose = pose;
        }
        self.robot.moves += 1;
        self.moves_made += 1;
        Ok(())
    }

    fn handler(&mut self) -> Option<&mut dyn AidHandler<Error = RefusedAction>> {
        Some(self)
    }
}

impl<A: Aid> AidHandler for LazyWorld<A> {
    type Error = RefusedAction;

    fn handle(&mut self, action: AidAction) -> Result<(), RefusedAction> {
        let moves = Action::Do(action).moves();
        if self.robot.moves.saturating_add(moves) > self.bound {
            return Err(RefusedAction::OutOfMoves { bound: self.bound });
        }
        if let Some(state) = &mut self.robot.state {
            self.aid.act(self.draft.graph(), state, action)?;
        }
        self.robot.moves += moves;
        self.moves_made += moves;
        Ok(())
    }
}
