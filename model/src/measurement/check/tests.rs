use std::f64::consts::FRAC_PI_2;

use super::*;
use crate::{
    driving::visit::JunctionShape,
    measurement::{
        ContradictoryMeasurement, FALSE_ALARMS, HallwayMeasurement, ONE_DEGREE, two_degrees,
    },
    percept::Door,
};

/// Half a metre or so.
const NOISE: MeasurementNoise = MeasurementNoise {
    standing: 0.05,
    wandering: 0.01,
    scale: 0.0,
    door: 0.05,
    turning: 0.05,
    drift: 0.0,
};
const L_LEFT: JunctionShape = JunctionShape([true, true, false, false]);
const END: JunctionShape = JunctionShape([true, false, false, false]);

fn visit(darts: &[u32], shape: JunctionShape, length: Option<f64>, door: u32) -> MeasuredVisit {
    MeasuredVisit {
        darts: darts.iter().copied().map(Dart).collect(),
        shape: Some(shape),
        arrived: length.map(|length| HallwayMeasurement { length, turn: Some(0.0) }),
        left_by: Some(Door(door)),
    }
}

/// A robot that goes back and forth in one hallway.
fn to_and_fro(lengths: &[f64]) -> Vec<MeasuredVisit> {
    let length = |visit: usize| visit.checked_sub(1).map(|before| lengths[before]);
    let dart = |number: usize| number as u32 % 2;
    (0..=lengths.len()).map(|number| visit(&[dart(number)], END, length(number), 0)).collect()
}

/// A robot that goes round a rectangle whose corners are Ls, always to the left.
fn round(lengths: &[f64]) -> Vec<MeasuredVisit> {
    let length = |visit: usize| visit.checked_sub(1).map(|before| lengths[before]);
    let corner = |number: usize| {
        let first = 2 * (number as u32 % 4);
        visit(&[first, first + 1], L_LEFT, length(number), 1)
    };
    (0..=lengths.len()).map(corner).collect()
}

fn found(visits: &[MeasuredVisit]) -> Vec<(usize, usize, ContradictoryMeasurement)> {
    let check = MeasurementCheck::new(visits, &NOISE);
    let found = check.contradictions.into_iter();
    found.map(|found| (found.visit, found.earlier, found.measurement)).collect()
}

#[test]
fn the_quantiles_have_the_stated_rate() {
    // The tail of the normal distribution beyond the square root of the quantile, on both sides.
    let density = |x: f64| (-x * x / 2.0).exp() / (2.0 * std::f64::consts::PI).sqrt();
    let tail = |from: f64| {
        (0..100_000).map(|step| density(from + (f64::from(step) + 0.5) * 1e-4) * 1e-4).sum::<f64>()
    };
    assert!((2.0 * tail(ONE_DEGREE.sqrt()) / FALSE_ALARMS - 1.0).abs() < 1e-4);
    assert!((2.0 * tail(ONE_DEGREE_MEDIAN.sqrt()) / 0.5 - 1.0).abs() < 1e-4);
    // Tables of the chi-square distribution: 23.026 with 2 degrees of freedom.
    assert!((two_degrees() - 23.025_851).abs() < 1e-6);
}

#[test]
fn a_hallway_of_8_m_is_not_14_m_long() {
    assert_eq!(found(&to_and_fro(&[8.0, 8.1, 7.9, 8.0])), []);
    let [(visit, earlier, ContradictoryMeasurement::Length { before, now })] =
        found(&to_and_fro(&[8.0, 8.2, 14.0, 8.1]))[..]
    else {
        panic!()
    };
    // The measurement after it is compared with those before it.
    assert_eq!((visit, earlier, now), (3, 2, 14.0));
    assert!((before - 8.1).abs() < 0.01);
}

#[test]
fn moves_that_were_measured_and_compared_are_counted() {
    let mut visits = to_and_fro(&[8.0, 8.1, 7.9, 8.0]);
    visits[2].arrived = None;
    let check = MeasurementCheck::new(&visits, &NOISE);
    assert_eq!((check.measured, check.compared), (3, 2));
    // Without places nothing is compared.
    for visit in &mut visits {
        visit.darts.clear();
    }
    let check = MeasurementCheck::new(&visits, &NOISE);
    assert_eq!((check.measured, check.compared), (3, 0));
    assert_eq!(MeasurementCheck::new(&[], &NOISE), MeasurementCheck::default());
}

#[test]
fn a_straight_hallway_does_not_turn() {
    let mut visits = to_and_fro(&[8.0, 8.0, 8.0]);
    visits[3].arrived = Some(HallwayMeasurement { length: 8.0, turn: Some(FRAC_PI_2) });
    let turned = ContradictoryMeasurement::Turn { before: 0.0, now: FRAC_PI_2 };
    assert_eq!(found(&visits), [(3, 1, turned)]);
}

#[test]
fn the_displacements_of_a_rectangle_add_up() {
    assert_eq!(found(&round(&[4.0, 6.0, 4.1, 5.9])), []);
    let [(4, 0, ContradictoryMeasurement::ClosedWalk { off, way })] =
        found(&round(&[4.0, 6.0, 4.0, 9.0]))[..]
    else {
        panic!()
    };
    assert!((off - 3.0).abs() < 1e-12 && (way - 23.0).abs() < 1e-12);
    // The walk goes on from where the corner is; each hallway is then compared with itself.
    let twice = [4.0, 6.0, 4.0, 9.0, 4.0, 6.0, 4.0, 9.0];
    assert_eq!(found(&round(&twice)).iter().map(|found| found.0).collect::<Vec<_>>(), [4, 8]);
}

#[test]
fn a_rectangle_has_four_left_turns() {
    let mut visits = round(&[4.0; 4]);
    // The robot is carried past a corner: the fourth visit is that of the first corner.
    visits[3].darts = visits[0].darts.clone();
    visits.truncate(4);
    let [(3, 0, ContradictoryMeasurement::ClosedTurns { quarters })] = found(&visits)[..] else {
        panic!("{:?}", found(&visits))
    };
    assert_eq!(quarters, 3);
}

#[test]
fn a_junction_keeps_its_shape() {
    let mut visits = round(&[4.0; 5]);
    visits[4].shape = Some(JunctionShape([true, false, true, false]));
    // It cannot be a left turn at the first visit, and straight on at the next.
    assert_eq!(found(&visits), [(4, 0, ContradictoryMeasurement::Shape)]);
    visits[4].shape = None;
    assert_eq!(found(&visits), []);
    // Seen from the other door, the corner is to the right.
    let right = JunctionShape([true, false, false, true]);
    let there_and_back = [
        visit(&[0, 1], L_LEFT, None, 1),
        visit(&[2], END, Some(4.0), 0),
        visit(&[1, 0], right, Some(4.0), 0),
    ];
    assert_eq!(found(&there_and_back), []);
}

#[test]
fn a_hallway_that_was_not_measured_closes_no_walk() {
    let mut visits = round(&[4.0, 6.0, 4.0, 9.0]);
    visits[2].arrived = None;
    assert_eq!(found(&visits), []);
}

#[test]
fn noise_that_is_larger_than_calibrated_is_estimated() {
    // Errors of half a metre, ten times the calibrated ones, and one slip by 6 m.
    let wild = |length: f64| {
        let errors = [0.5, -0.4, 0.3, -0.5, 0.4, -0.3, 0.5, -0.5, 0.4, -0.4, 0.5];
        errors.iter().map(|error| length + error).collect::<Vec<_>>()
    };
    assert_eq!(found(&to_and_fro(&wild(8.0))), []);
    let mut slipped = wild(8.0);
    slipped[7] = 14.0;
    let found = found(&to_and_fro(&slipped));
    assert_eq!(found.iter().map(|found| found.0).collect::<Vec<_>>(), [8]);
}
