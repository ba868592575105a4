//! Many tolerated divergences do not need as many judgements.

use toposlam_model::{mapping::Contradiction, trace::StepPurpose};

use super::*;
use crate::judgement::JUDGED;

/// Quirks of these causes, everywhere.
fn everywhere(causes: &[&str]) -> Quirks {
    let quirk = |cause: &&str| {
        format!("[[quirk]]\nname = \"{cause}\"\ncause = \"{cause}\"\nreason = \"known\"\n")
    };
    Quirks::read(&causes.iter().map(quirk).collect::<String>()).unwrap()
}

/// The number of judgements, and the result.
fn counted(events: &RunEvents, question: &ConformConfig, quirks: &Quirks) -> (u64, Judgement) {
    let before = JUDGED.get();
    let judgement = judge(events.clone(), question, quirks, &()).unwrap();
    (JUDGED.get() - before, judgement)
}

/// The events of a good log with wrong percepts and wrong numbers.
fn wrong(good: &RunEvents) -> RunEvents {
    let mut events = good.clone();
    for event in &mut events.events {
        match &mut event.kind {
            CheckedKind::Arrival { arrival, .. } if arrival.number != Some(0) => {
                arrival.degree += 7;
                arrival.form = None;
            }
            CheckedKind::Door { number: Some(number), .. } => *number += 100,
            _ => {}
        }
    }
    events
}

#[test]
fn all_quirks_of_a_log_need_two_judgements() {
    let (_, plan) = plans().unwrap().into_iter().find(|(name, _)| name == "building-12").unwrap();
    let facing = starts_of(&plan)[0];
    let good = log(&plan, facing, 1).recorded();
    let question = question(&plan, Some(facing));
    let events = wrong(&good);
    let quirks = everywhere(&["percept", "number"]);
    let (count, judgement) = counted(&events, &question, &quirks);
    assert_eq!((count, judgement.verdict()), (2, ConformVerdict::Conforms));
    // Each event but the first is wrong in one way.
    let tolerated: Vec<_> = judgement.tolerated.iter().map(|(found, _)| found.event).collect();
    assert_eq!(tolerated, (1..good.events.len()).collect::<Vec<_>>());
    // Without quirks there is one.
    assert_eq!(counted(&good, &question, &Quirks::default()).0, 1);
    assert_eq!(counted(&events, &question, &Quirks::default()).0, 1);
}

#[test]
fn what_follows_a_divergence_is_not_tolerated() {
    let (_, plan) = plans().unwrap().into_iter().find(|(name, _)| name == "building-12").unwrap();
    let facing = starts_of(&plan)[0];
    let mut events = wrong(&log(&plan, facing, 1).recorded());
    let CheckedKind::Door { door, .. } = &mut events.events[5].kind else { panic!() };
    // There is no such door, and it is not known how the run continues.
    door.0 = 9;
    let question = question(&plan, Some(facing));
    let quirks = everywhere(&["percept", "number", "aside"]);
    let (_, judgement) = counted(&events, &question, &quirks);
    assert_eq!(judgement.divergence.unwrap().event, 5);
    let tolerated: Vec<_> = judgement.tolerated.iter().map(|(found, _)| found.event).collect();
    assert_eq!(tolerated[..4], [1, 2, 3, 4]);
    assert!(tolerated.iter().all(|&event| event <= 5), "{tolerated:?}");
    // The events after it are the recorded ones.
    assert_eq!(judgement.events.events[6..], events.events[6..]);
}

#[test]
fn a_percept_is_not_tolerated_if_it_is_not_known_what_was_expected() {
    let (_, plan) = plans().unwrap().into_iter().find(|(name, _)| name == "building-12").unwrap();
    let good = log(&plan, starts_of(&plan)[0], 1).recorded();
    // From any start, different percepts are expected.
    let anywhere = ConformConfig { driver: RunDriver::Anyone, ..question(&plan, None) };
    let mut wrong = good.clone();
    let CheckedKind::Arrival { arrival, .. } = &mut wrong.events[0].kind else { panic!() };
    (arrival.degree, arrival.form) = (9, None);
    let (_, judgement) = counted(&wrong, &anywhere, &everywhere(&["percept"]));
    let divergence = judgement.divergence.unwrap();
    assert_eq!((divergence.event, divergence.cause.name()), (0, "percept"));
    assert!(judgement.tolerated.is_empty());
}

#[test]
fn a_percept_is_not_tolerated_at_an_event_that_diverges_in_another_way() {
    let (_, plan) = plans().unwrap().into_iter().find(|(name, _)| name == "building-12").unwrap();
    let facing = starts_of(&plan)[0];
    let good = log(&plan, facing, 1).recorded();
    let anyone = ConformConfig { driver: RunDriver::Anyone, ..question(&plan, Some(facing)) };
    for (question, cause) in [(anyone, "percept"), (without_world(), "contradiction")] {
        let quirks = everywhere(&[cause]);
        // Two events of which each alone is tolerated.
        let alone = |event: &usize| {
            let (_, judgement) = counted(&with_wrong_degrees(&good, &[*event]), &question, &quirks);
            judgement.divergence.is_none()
        };
        let events: Vec<_> = (2..good.events.len()).step_by(2).filter(alone).take(2).collect();
        let [first, second] = events[..] else { panic!("{events:?}") };
        let mut wrong = with_wrong_degrees(&good, &events);
        let CheckedKind::Arrival { arrival, .. } = &mut wrong.events[second].kind else { panic!() };
        arrival.number = Some(99);
        let (_, judgement) = counted(&wrong, &question, &quirks);
        let divergence = judgement.divergence.unwrap();
        assert_eq!((divergence.event, divergence.cause.name()), (second, "number"));
        let at: Vec<_> = judgement.tolerated.iter().map(|(found, _)| found.event).collect();
        assert_eq!(at, [first]);
    }
}

/// The events of a log, with one more door at each of these arrivals.
fn with_wrong_degrees(good: &RunEvents, at: &[usize]) -> RunEvents {
    let mut events = good.clone();
    for &event in at {
        let CheckedKind::Arrival { arrival, .. } = &mut events.events[event].kind else { panic!() };
        arrival.degree += 1;
        arrival.form = None;
    }
    events
}

#[test]
fn all_contradictions_of_algorithm_1_need_two_judgements() {
    let (_, plan) = plans().unwrap().into_iter().find(|(name, _)| name == "building-12").unwrap();
    let good = log(&plan, starts_of(&plan)[0], 1).recorded();
    let question = without_world();
    let quirks = everywhere(&["contradiction"]);
    // The arrivals whose percept is known to Algorithm 1 when another one contradicts its map.
    let contradicted: Vec<usize> = (2..good.events.len())
        .step_by(2)
        .filter(|&event| {
            let wrong = with_wrong_degrees(&good, &[event]);
            let (_, judgement) = counted(&wrong, &question, &quirks);
            let at: Vec<_> = judgement.tolerated.iter().map(|(found, _)| found.event).collect();
            judgement.divergence.is_none() && at == [event]
        })
        .collect();
    assert!(contradicted.len() > 10, "{contradicted:?}");
    let events = with_wrong_degrees(&good, &contradicted);
    let (count, judgement) = counted(&events, &question, &quirks);
    assert_eq!((count, judgement.verdict()), (2, ConformVerdict::Conforms));
    let tolerated: Vec<_> = judgement.tolerated.iter().map(|(found, _)| found.event).collect();
    assert_eq!(tolerated, contradicted);
    // With a quirk for one event the next one diverges.
    let one = format!(
        "[[quirk]]\nname = \"one\"\ncause = \"contradiction\"\nreason = \"known\"\nevent = {}",
        contradicted[0] + 1
    );
    let judgement = judge(events, &question, &Quirks::read(&one).unwrap(), &()).unwrap();
    assert_eq!(judgement.divergence.unwrap().event, contradicted[1]);
}

#[test]
fn contradictions_of_the_folding_explorer_are_tolerated_where_the_place_is_known() {
    let (_, plan) = plans().unwrap().into_iter().find(|(name, _)| name == "building-12").unwrap();
    let folding = MappingAlgorithm::Folding;
    let good = log_of(folding, &plan, starts_of(&plan)[0], 1).recorded();
    let question = ConformConfig { driver: RunDriver::from(folding), ..without_world() };
    let quirks = everywhere(&["contradiction"]);
    let (mut known, mut by_marker) = (Vec::new(), 0);
    for event in (2..good.events.len()).step_by(2) {
        let wrong = with_wrong_degrees(&good, &[event]);
        let (_, strict) = counted(&wrong, &question, &Quirks::default());
        let (_, judgement) = counted(&wrong, &question, &quirks);
        let at: Vec<_> = judgement.tolerated.iter().map(|(found, _)| found.event).collect();
        if judgement.divergence.is_none() && at == [event] {
            known.push(event);
        }
        // Of two visits that are one because the marker was seen, either may be false.
        if let Some(DivergenceCause::Algorithm(departure)) = strict.divergence.map(|of| of.cause)
            && let StepPurpose::Contradicted(Contradiction::Trail { expected: None, .. }) =
                departure.allowed[0].purpose
        {
            by_marker += 1;
            assert!(at.is_empty(), "{at:?}");
            assert!(judgement.divergence.is_some());
        }
    }
    assert!(known.len() > 1 && by_marker > 1, "{known:?}, {by_marker} by the marker");
    let wrong = with_wrong_degrees(&good, &known);
    let (count, judgement) = counted(&wrong, &question, &quirks);
    assert_eq!((count, judgement.verdict()), (2, ConformVerdict::Conforms));
    let tolerated: Vec<_> = judgement.tolerated.iter().map(|(found, _)| found.event).collect();
    assert_eq!(tolerated, known);
}
