//! Logs of the folding explorer, compared with its doors.

use toposlam_model::{
    aid::Action,
    trace::{AllowedStep, StepPurpose},
};

use super::*;

fn good_log(place: &Place) -> Log {
    log_of(FOLDING, place, 1)
}

#[test]
fn without_a_world_a_wrong_percept_is_a_contradiction_or_changes_the_doors() {
    let good = good_log(&place());
    for event in (2..good.places().len()).step_by(2) {
        let mut log = good.clone();
        assert_eq!(log.mutate(event, Mutation::Degree, 0), Shows::At(event));
        let mut events = log.recorded();
        events.arrivals_mut().for_each(|arrival| arrival.shape = None);
        let found = divergence(&events, &driven(without_world(), FOLDING));
        assert!(found.event >= event, "{found:?}");
    }
}

#[test]
fn a_log_of_algorithm_1_diverges_at_the_first_door_that_the_explorer_does_not_take() {
    let place = place_in("building-12");
    let [of_algorithm1, of_folding] = [log(&place, 1), good_log(&place)].map(|log| log.recorded());
    let [one, other] = [&of_algorithm1, &of_folding].map(|events| bare(&events.events));
    let first = one.iter().zip(&other).position(|(one, other)| one != other).unwrap();
    let config = at_place(&place);
    let found = divergence(&of_algorithm1, &driven(config.clone(), FOLDING));
    assert_eq!((found.event, found.fault), (first, FaultClass::Algorithm));
    let DivergenceCause::Algorithm(departure) = found.cause else { panic!() };
    let [AllowedStep { action, purpose }] = departure.allowed[..] else { panic!() };
    assert_eq!((departure.algorithm, action), (FOLDING, other[first].1.map(Action::Take)));
    assert!(matches!(purpose, StepPurpose::ExploreOpen(_) | StepPurpose::Test { .. }));
    // Nor is the other run one of Algorithm 1.
    assert_eq!(divergence(&of_folding, &config).fault, FaultClass::Algorithm);
    let anyone = driven(config, RunDriver::Anyone);
    assert_eq!(judged(&of_algorithm1, &anyone).divergence, None);
}

#[test]
fn the_recorded_map_must_be_isomorphic_to_the_map_of_the_explorer() {
    let place = place();
    let mut events = good_log(&place).recorded();
    let config = driven(at_place(&place), FOLDING);
    let mut map = MapRecord::from_walk(&judged(&events, &config).algorithm.unwrap().run);
    events.map = Some(map.clone());
    assert_eq!(judged(&events, &config).divergence, None);
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
    assert_eq!(judged(&events, &config).divergence, None);
    // A map with an unexplored edge is another one.
    let far = map.opposite.last_mut().unwrap().take().unwrap();
    map.opposite[far.at()] = None;
    events.map = Some(map);
    let found = divergence(&events, &config);
    assert_eq!(found.cause, DivergenceCause::Map { algorithm: FOLDING });
}
