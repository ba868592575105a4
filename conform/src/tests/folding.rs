//! Logs of the folding explorer, compared with its doors.

use toposlam_model::trace::{AllowedStep, StepPurpose};

use super::*;

const FOLDING: MappingAlgorithm = MappingAlgorithm::Folding;

fn with_folding(question: ConformConfig) -> ConformConfig {
    ConformConfig { driver: RunDriver::from(FOLDING), ..question }
}

#[test]
fn good_logs_of_every_plan_conform() {
    for (name, plan) in plans().unwrap() {
        for (seed, facing) in starts_of(&plan).into_iter().enumerate().step_by(3) {
            let events = log_of(FOLDING, &plan, facing, seed as u64).recorded();
            for question in [question(&plan, Some(facing)), without_world()] {
                let judgement = judged(&events, &with_folding(question));
                let found = (judgement.verdict(), &judgement.divergence);
                assert_eq!(found, (ConformVerdict::Conforms, &None), "{name} from {facing:?}");
                assert_eq!(judgement.determines_world(), Some(true));
            }
        }
    }
}

#[test]
fn every_mutation_is_found_at_its_event_or_does_not_show() {
    let (_, plan) = plans().unwrap().swap_remove(2);
    let facing = starts_of(&plan)[0];
    let good = log_of(FOLDING, &plan, facing, 1);
    let question = with_folding(question(&plan, Some(facing)));
    for event in 0..good.places().len() {
        for mutation in MUTATIONS {
            let mut log = good.clone();
            let expected = match log.mutate(event, mutation, 0) {
                Shows::At(event) => Some(event),
                Shows::Never(_) => None,
                Shows::NotOne => continue,
            };
            let found = divergence_at(&log, good.moves(), &question);
            if mutation == Mutation::Form && found != expected {
                assert!(is_shape_of(&log, event, &question), "{mutation:?} of event {event}");
                continue;
            }
            assert_eq!(found, expected, "{mutation:?} of event {event}");
        }
    }
}

#[test]
fn without_a_world_a_wrong_percept_is_a_contradiction_or_changes_the_doors() {
    let (_, plan) = plans().unwrap().swap_remove(2);
    let facing = starts_of(&plan)[0];
    let good = log_of(FOLDING, &plan, facing, 1);
    for event in (2..good.places().len()).step_by(2) {
        let mut log = good.clone();
        assert_eq!(log.mutate(event, Mutation::Degree, 0), Shows::At(event));
        let mut events = log.recorded();
        for event in &mut events.events {
            if let CheckedKind::Arrival { arrival, .. } = &mut event.kind {
                arrival.form = None;
            }
        }
        let divergence = judged(&events, &with_folding(without_world())).divergence.unwrap();
        assert!(divergence.event >= event, "{divergence:?}");
    }
}

#[test]
fn a_log_of_algorithm_1_diverges_at_the_first_door_that_the_explorer_does_not_take() {
    let (_, plan) = plans().unwrap().into_iter().find(|(name, _)| name == "building-12").unwrap();
    let facing = starts_of(&plan)[0];
    let of_algorithm1 = log(&plan, facing, 1).recorded();
    let of_folding = log_of(FOLDING, &plan, facing, 1).recorded();
    let [one, other] = [&of_algorithm1, &of_folding].map(|events| bare(&events.events));
    let first = one.iter().zip(&other).position(|(one, other)| one != other).unwrap();
    let question = question(&plan, Some(facing));
    let divergence = judged(&of_algorithm1, &with_folding(question.clone())).divergence.unwrap();
    assert_eq!((divergence.event, divergence.fault), (first, FaultClass::Algorithm));
    let DivergenceCause::Algorithm(departure) = divergence.cause else { panic!() };
    let [AllowedStep { door, purpose }] = departure.allowed[..] else { panic!() };
    assert_eq!((departure.algorithm, door), (FOLDING, other[first].1));
    assert!(matches!(purpose, StepPurpose::ExploreOpen(_) | StepPurpose::Test { .. }));
    // Nor is the other run one of Algorithm 1.
    let divergence = judged(&of_folding, &question).divergence.unwrap();
    assert_eq!(divergence.fault, FaultClass::Algorithm);
    // Anyone may choose the doors.
    let anyone = ConformConfig { driver: RunDriver::Anyone, ..question };
    assert_eq!(judged(&of_algorithm1, &anyone).divergence, None);
}

#[test]
fn the_recorded_map_must_be_isomorphic_to_the_map_of_the_explorer() {
    let (_, plan) = plans().unwrap().swap_remove(2);
    let facing = starts_of(&plan)[0];
    let mut events = log_of(FOLDING, &plan, facing, 1).recorded();
    let question = with_folding(question(&plan, Some(facing)));
    let judgement = judged(&events, &question);
    let mut map = MapRecord::of(&judgement.algorithm.unwrap().run);
    events.map = Some(map.clone());
    assert_eq!(judged(&events, &question).divergence, None);
    // The last two vertices change places.
    let count = map.degrees.len();
    let [one, other] = [map.degrees[count - 2], map.degrees[count - 1]];
    let first = map.opposite.len() as u32 - one - other;
    let renumbered = |dart: Dart| match dart.0.checked_sub(first) {
        None => dart,
        Some(index) if index < one => Dart(dart.0 + other),
        Some(_) => Dart(dart.0 - one),
    };
    let mut opposite = map.opposite.clone();
    for (dart, far) in map.opposite.iter().enumerate() {
        opposite[renumbered(Dart(dart as u32)).at()] = far.map(renumbered);
    }
    map.degrees.swap(count - 2, count - 1);
    map.opposite = opposite;
    events.map = Some(map.clone());
    assert_eq!(judged(&events, &question).divergence, None);
    // A map with an unexplored edge is another one.
    let last = map.opposite.len() - 1;
    let far = map.opposite[last].take().unwrap();
    map.opposite[far.at()] = None;
    events.map = Some(map);
    let divergence = judged(&events, &question).divergence.unwrap();
    assert_eq!(divergence.cause, DivergenceCause::Map { algorithm: FOLDING });
}

#[test]
fn a_log_is_followed_up_to_the_bound_on_darts() {
    let (_, plan) = plans().unwrap().swap_remove(2);
    let facing = starts_of(&plan)[0];
    let events = log_of(FOLDING, &plan, facing, 1).recorded();
    let bounded = ConformConfig { dart_bound: 3, ..with_folding(question(&plan, Some(facing))) };
    let judgement = judged(&events, &bounded);
    assert_eq!(judgement.verdict(), ConformVerdict::Incomplete);
    let limits = judgement.limits();
    let [ReachedLimit::Darts { algorithm: FOLDING, bound: 3, .. }] = limits[..] else {
        panic!("{limits:?}")
    };
}
