//! Many tolerated divergences do not need as many judgements.

use toposlam_model::{mapping::Contradiction, trace::StepPurpose};

use super::*;
use crate::judgement::JUDGED;

/// A quirk of a cause, everywhere or at one event, from 1.
fn quirk(cause: &str, event: Option<usize>) -> String {
    let event = event.map_or(String::new(), |event| format!("event = {event}\n"));
    format!("[[quirk]]\nname = \"{cause}\"\ncause = \"{cause}\"\nreason = \"known\"\n{event}")
}

/// Quirks of these causes, everywhere.
fn everywhere(causes: &[&str]) -> Quirks {
    Quirks::read(&causes.iter().map(|cause| quirk(cause, None)).collect::<String>()).unwrap()
}

/// A judgement, and how many whole runs were judged for it.
fn counted(events: &RunEvents, config: &ConformConfig, quirks: &Quirks) -> (u64, Judgement) {
    let before = JUDGED.get();
    let judgement = judge(events.clone(), config, quirks, &()).unwrap();
    (JUDGED.get() - before, judgement)
}

fn tolerated(judgement: &Judgement) -> Vec<usize> {
    judgement.tolerated.iter().map(|(found, _)| found.event).collect()
}

/// The events of a good log with wrong percepts and wrong numbers.
fn wrong(good: &RunEvents) -> RunEvents {
    let arrivals: Vec<usize> = (2..good.events.len()).step_by(2).collect();
    let mut events = with_more_doors(good, &arrivals, 7);
    for event in &mut events.events {
        if let CheckedKind::Door { number: Some(number), .. } = &mut event.kind {
            *number += 100;
        }
    }
    events
}

#[test]
fn all_quirks_of_a_log_need_two_judgements() {
    let place = place_in("building-12");
    let config = at_place(&place);
    let good = log(&place, 1).recorded();
    let events = wrong(&good);
    let (count, judgement) = counted(&events, &config, &everywhere(&["percept", "number"]));
    assert_eq!((count, judgement.verdict()), (2, ConformVerdict::Conforms));
    // Each event but the first is wrong in one way.
    assert_eq!(tolerated(&judgement), (1..good.events.len()).collect::<Vec<_>>());
    // Without quirks there is one.
    assert_eq!(counted(&good, &config, &Quirks::default()).0, 1);
    assert_eq!(counted(&events, &config, &Quirks::default()).0, 1);
}

#[test]
fn what_follows_a_divergence_is_not_tolerated() {
    let place = place_in("building-12");
    let mut events = wrong(&log(&place, 1).recorded());
    let CheckedKind::Door { door, .. } = &mut events.events[5].kind else { panic!() };
    // There is no such door, and it is not known how the run continues.
    door.0 = 9;
    let quirks = everywhere(&["percept", "number", "aside"]);
    let (_, judgement) = counted(&events, &at_place(&place), &quirks);
    let tolerated = tolerated(&judgement);
    assert_eq!(judgement.divergence.unwrap().event, 5);
    assert_eq!(tolerated[..4], [1, 2, 3, 4]);
    assert!(tolerated.iter().all(|&event| event <= 5), "{tolerated:?}");
    // The events after it are the recorded ones.
    assert_eq!(judgement.events.events[6..], events.events[6..]);
}

#[test]
fn a_percept_is_not_tolerated_if_it_is_not_known_what_was_expected() {
    let place = place_in("building-12");
    // From any start, different percepts are expected.
    let anywhere = driven(anywhere_in(&place.0), RunDriver::Anyone);
    let wrong = with_more_doors(&log(&place, 1).recorded(), &[0], 9);
    let (_, judgement) = counted(&wrong, &anywhere, &everywhere(&["percept"]));
    assert_eq!(place_of(&judgement.divergence.unwrap()), (0, "percept"));
    assert!(judgement.tolerated.is_empty());
}

#[test]
fn a_percept_is_not_tolerated_at_an_event_that_diverges_in_another_way() {
    let place = place_in("building-12");
    let good = log(&place, 1).recorded();
    let anyone = driven(at_place(&place), RunDriver::Anyone);
    for (config, cause) in [(anyone, "percept"), (without_world(), "contradiction")] {
        let quirks = everywhere(&[cause]);
        // Two events of which each alone is tolerated.
        let alone = |event: &usize| {
            let wrong = with_more_doors(&good, &[*event], 1);
            counted(&wrong, &config, &quirks).1.divergence.is_none()
        };
        let events: Vec<_> = (2..good.events.len()).step_by(2).filter(alone).take(2).collect();
        let [first, second] = events[..] else { panic!("{events:?}") };
        let mut wrong = with_more_doors(&good, &events, 1);
        arrival_at(&mut wrong, second).number = Some(99);
        let (_, judgement) = counted(&wrong, &config, &quirks);
        assert_eq!(tolerated(&judgement), [first]);
        assert_eq!(place_of(&judgement.divergence.unwrap()), (second, "number"));
    }
}

#[test]
fn all_contradictions_of_algorithm_1_need_two_judgements() {
    let good = log(&place_in("building-12"), 1).recorded();
    let config = without_world();
    let quirks = everywhere(&["contradiction"]);
    // The arrivals whose percept is known to Algorithm 1 when another one contradicts its map.
    let is_contradicted = |event: &usize| {
        let (_, judgement) = counted(&with_more_doors(&good, &[*event], 1), &config, &quirks);
        judgement.divergence.is_none() && tolerated(&judgement) == [*event]
    };
    let contradicted: Vec<usize> =
        (2..good.events.len()).step_by(2).filter(is_contradicted).collect();
    assert!(contradicted.len() > 10, "{contradicted:?}");
    let events = with_more_doors(&good, &contradicted, 1);
    let (count, judgement) = counted(&events, &config, &quirks);
    assert_eq!((count, judgement.verdict()), (2, ConformVerdict::Conforms));
    assert_eq!(tolerated(&judgement), contradicted);
    // With a quirk for one event the next one diverges.
    let one = Quirks::read(&quirk("contradiction", Some(contradicted[0] + 1))).unwrap();
    let judgement = judge(events, &config, &one, &()).unwrap();
    assert_eq!(judgement.divergence.unwrap().event, contradicted[1]);
}

#[test]
fn contradictions_of_the_folding_explorer_are_tolerated_where_the_place_is_known() {
    let good = log_of(FOLDING, &place_in("building-12"), 1).recorded();
    let config = driven(without_world(), FOLDING);
    let quirks = everywhere(&["contradiction"]);
    let (mut known, mut by_marker) = (Vec::new(), 0);
    for event in (2..good.events.len()).step_by(2) {
        let wrong = with_more_doors(&good, &[event], 1);
        let strict = judged(&wrong, &config);
        let (_, judgement) = counted(&wrong, &config, &quirks);
        let at = tolerated(&judgement);
        if judgement.divergence.is_none() && at == [event] {
            known.push(event);
        }
        // Of two visits that are one because the marker was seen, either may be false.
        if let Some(DivergenceCause::Algorithm(departure)) = strict.divergence.map(|of| of.cause)
            && let StepPurpose::Contradicted(Contradiction::Trail { expected: None, .. }) =
                departure.allowed[0].purpose
        {
            by_marker += 1;
            assert!(at.is_empty() && judgement.divergence.is_some(), "{at:?}");
        }
    }
    assert!(known.len() > 1 && by_marker > 1, "{known:?}, {by_marker} by the marker");
    let (count, judgement) = counted(&with_more_doors(&good, &known, 1), &config, &quirks);
    assert_eq!((count, judgement.verdict()), (2, ConformVerdict::Conforms));
    assert_eq!(tolerated(&judgement), known);
}
