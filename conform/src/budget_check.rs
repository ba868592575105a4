//! Checks that a robot with a budget turned back in time, and went back to its marker along its own way.

use toposlam_logs::record::RunEnding;
use toposlam_model::{
    aid::Action,
    percept::{Door, WalkEvent},
    trace::{AlgorithmMatch, AllowedStep, Departure, MatchEnd, StepPurpose, Trace},
};
use toposlam_robot::budget::{Allowance, RunBudget, Spent};

use super::events::RunEvents;

/// The match of a robot with a budget. Whether it turns back in time is decided for moves alone: what it had measured of
/// time and way is not in the trace.
pub(super) fn within_budget(
    followed: AlgorithmMatch,
    trace: &Trace,
    events: &RunEvents,
    budget: RunBudget,
) -> AlgorithmMatch {
    let turned_back =
        matches!(events.end.as_ref().map(|end| &end.ending), Some(RunEnding::OutOfBudget(_)));
    let departed = match &followed.reached {
        MatchEnd::Departure(departure) => Some(departure),
        _ => None,
    };
    let moves_before = |id| WalkEvent::at(trace.index_of(id)).moves();
    let last = departed.map_or(trace.doors().len(), |it| moves_before(it.event.id));
    let moves_alone = RunBudget { moves: budget.moves, ..RunBudget::default() };
    let mut allowance = Allowance::new(moves_alone);
    for (number, &door) in trace.doors().iter().enumerate() {
        arrive(&mut allowance, trace, number);
        let spent = spent(number);
        if number < last && allowance.forbids(door, spent).is_some() {
            return departing(followed, trace, number, allowance.door_back());
        }
        if number == last && turned_back {
            let could_go_on = moves_alone == budget
                && departed.is_some_and(|departure| {
                    departure.allowed.iter().all(|allowed| match allowed.action {
                        Some(Action::Take(door)) => allowance.forbids(door, spent).is_none(),
                        _ => true,
                    })
                });
            return if could_go_on {
                followed
            } else {
                on_way_back(allowance, followed, trace, number)
            };
        }
        allowance.leave(door, spent);
    }
    followed
}

fn spent(moves: usize) -> Spent {
    Spent::new(moves as f64, 0.0, 0.0)
}

/// The robot stands where it was after some moves.
fn arrive(allowance: &mut Allowance, trace: &Trace, number: usize) {
    if trace.is_relocation(number) {
        allowance.lose_way();
    }
    if let Some(percept) = trace.percepts().get(number) {
        allowance.perceive(*percept, spent(number));
    }
}

/// The match if all doors from here on are those of the way back.
fn on_way_back(
    mut allowance: Allowance,
    followed: AlgorithmMatch,
    trace: &Trace,
    first: usize,
) -> AlgorithmMatch {
    for (number, &door) in trace.doors().iter().enumerate().skip(first) {
        if number > first {
            arrive(&mut allowance, trace, number);
        }
        let back = allowance.door_back();
        if back != Some(door) {
            // If it has not turned back, its departure from the algorithm is the fault.
            if number == first {
                return followed;
            }
            return departing(followed, trace, number, back);
        }
        allowance.leave(door, spent(number));
    }
    AlgorithmMatch { reached: MatchEnd::EndOfTrace, ..followed }
}

/// The match with another departure, at a door: the robot does not turn back by the door by which it must.
fn departing(
    followed: AlgorithmMatch,
    trace: &Trace,
    number: usize,
    door: Option<Door>,
) -> AlgorithmMatch {
    let allowed =
        vec![AllowedStep { action: door.map(Action::Take), purpose: StepPurpose::TurnBack }];
    let event = trace.door_event(number);
    let departure = Departure { algorithm: followed.algorithm, event, allowed };
    AlgorithmMatch { reached: MatchEnd::Departure(departure), ..followed }
}
