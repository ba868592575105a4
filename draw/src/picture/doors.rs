//! The directions of the doors around a disc: as near to the directions of the edges as the clockwise
//! order allows.

use std::f64::consts::TAU;

use super::geometry::{turn, wrapped};

/// The weight of an even spread of the doors of one disc.
const SPREAD: f64 = 0.3;
/// Initial directions of the search for the best rotation of the disc.
const INITIALS: usize = 72;
/// Sweeps over the doors of one disc.
const SWEEPS: usize = 80;

/// The directions of the doors of one disc, in their clockwise order, at least `apart` from each
/// other (or evenly spread, if there is no room for that). `wanted`: the best direction for each edge;
/// none for a loop.
pub(super) fn door_directions(wanted: &[Option<f64>], apart: f64) -> Vec<f64> {
    let count = wanted.len();
    let apart = apart.min(0.85 * TAU / count as f64);
    if let Some(directions) = in_order(wanted, apart) {
        return directions;
    }
    let mut best = (f64::INFINITY, Vec::new());
    for initial in 0..INITIALS {
        let offset = TAU * initial as f64 / INITIALS as f64;
        let even = |index: usize| offset + TAU * index as f64 / count as f64;
        // Modulo a full turn, the wanted direction nearest to the even spread.
        let targets: Vec<_> = wanted
            .iter()
            .enumerate()
            .map(|(index, direction)| {
                direction.map(|angle| even(index) + wrapped(angle - even(index)))
            })
            .collect();
        let mut angles: Vec<f64> = (0..count).map(even).collect();
        let cost = settle(&mut angles, &targets, apart);
        if cost < best.0 - 1e-9 {
            best = (cost, angles);
        }
    }
    best.1.into_iter().map(wrapped).collect()
}

/// The wanted directions themselves, if they are in clockwise order and far enough apart.
fn in_order(wanted: &[Option<f64>], apart: f64) -> Option<Vec<f64>> {
    let directions = wanted.iter().copied().collect::<Option<Vec<f64>>>()?;
    if directions.len() == 1 {
        return Some(directions);
    }
    let mut whole = 0.0;
    for (index, &direction) in directions.iter().enumerate() {
        let gap = turn(direction, directions[(index + 1) % directions.len()]);
        if gap < apart - 1e-9 {
            return None;
        }
        whole += gap;
    }
    (whole < 1.5 * TAU).then_some(directions)
}

/// Moves the angles to the least cost, and keeps their order and distance; returns the cost.
fn settle(angles: &mut [f64], targets: &[Option<f64>], apart: f64) -> f64 {
    let count = angles.len();
    let even = TAU / count as f64;
    let before = |angles: &[f64], index: usize| match index {
        0 => angles[count - 1] - TAU,
        _ => angles[index - 1],
    };
    let after = |angles: &[f64], index: usize| match index + 1 {
        next if next == count => angles[0] + TAU,
        next => angles[next],
    };
    if count > 1 {
        for _ in 0..SWEEPS {
            for index in 0..count {
                let (low, high) = (before(angles, index), after(angles, index));
                let (pull, weight) = targets[index].map_or((0.0, 0.0), |target| (target, 1.0));
                let free = (pull + SPREAD * (low + high)) / (weight + 2.0 * SPREAD);
                angles[index] = free.max(low + apart).min(high - apart);
            }
            // All together: a rotation of the whole disc.
            let (miss, cared) = misses(angles, targets);
            if cared > 0 {
                let step = miss / f64::from(cared);
                for angle in angles.iter_mut() {
                    *angle += step;
                }
            }
        }
    }
    (0..count)
        .map(|index| {
            let miss = targets[index].map_or(0.0, |target| angles[index] - target);
            let gap = after(angles, index) - angles[index] - even;
            miss * miss + SPREAD * gap * gap
        })
        .sum()
}

/// The sum of the differences from the targets to the angles, and the number of targets.
fn misses(angles: &[f64], targets: &[Option<f64>]) -> (f64, u32) {
    angles
        .iter()
        .zip(targets)
        .filter_map(|(angle, target)| target.map(|target| target - angle))
        .fold((0.0, 0), |(sum, count), miss| (sum + miss, count + 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_that_are_in_order_are_kept_to_the_bit() {
        let wanted = [Some(0.0), Some(1.5), Some(-2.0)];
        assert_eq!(door_directions(&wanted, 0.4), [0.0, 1.5, -2.0]);
    }

    #[test]
    fn directions_in_the_wrong_order_are_pushed_into_the_right_one() {
        let wanted = [Some(0.0), Some(-1.5), Some(1.5), None, Some(0.1)];
        let doors = door_directions(&wanted, 0.4);
        let gaps: Vec<_> = (0..5).map(|at| turn(doors[at], doors[(at + 1) % 5])).collect();
        assert!((gaps.iter().sum::<f64>() - TAU).abs() < 1e-9, "{gaps:?}");
        assert!(gaps.iter().all(|&gap| gap > 0.4 - 1e-9), "{gaps:?}");
    }

    #[test]
    fn many_doors_share_the_disc() {
        let doors = door_directions(&[Some(0.0); 100], 0.4);
        for at in 0..100 {
            assert!(turn(doors[at], doors[(at + 1) % 100]) > 0.8 * TAU / 100.0);
        }
    }
}
