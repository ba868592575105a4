//! Roots of functions, to the last bits.

/// The root of a function with a slope that is not positive at the lower end and positive at the upper:
/// Newton's steps, or halves of the bracket if a step would leave it.
pub(super) fn root(
    function: impl Fn(f64) -> (f64, f64),
    [mut low, mut high]: [f64; 2],
    guess: f64,
) -> f64 {
    let mut at = if guess > low && guess < high { guess } else { f64::midpoint(low, high) };
    let mut last = high - low;
    // Newton's steps double the digits and halves add one: no function takes more steps.
    for _ in 0..200 {
        let (value, slope) = function(at);
        if value > 0.0 {
            high = at;
        } else {
            low = at;
        }
        let newton = at - value / slope;
        let step = (newton - at).abs();
        // A step more than half as long as the last is no better than a half of the bracket.
        if newton >= low && newton <= high && step <= 0.5 * last {
            (at, last) = (newton, step);
            // The remaining error is about the square of the step.
            if step <= 1e-10 * at.abs() {
                break;
            }
        } else {
            let middle = f64::midpoint(low, high);
            (at, last) = (middle, (middle - at).abs());
            if high - low <= 2.0 * f64::EPSILON * at.abs() {
                break;
            }
        }
    }
    at
}

/// The value and the slope of a polynomial; the constant coefficient is the first.
#[inline]
pub(super) fn polynomial(coefficients: &[f64], at: f64) -> (f64, f64) {
    coefficients.iter().rev().fold((0.0, 0.0), |(value, slope), coefficient| {
        (value * at + coefficient, slope * at + value)
    })
}

/// The first place between two numbers at which a polynomial changes its sign.
pub(super) fn first_change(coefficients: &[f64], bracket: [f64; 2]) -> Option<f64> {
    changes(coefficients, bracket).first().copied()
}

/// The points at which a polynomial changes its sign: at most one between two sign changes of its slope.
fn changes(coefficients: &[f64], [low, high]: [f64; 2]) -> Vec<f64> {
    if coefficients.len() < 2 {
        return Vec::new();
    }
    let slope: Vec<f64> =
        coefficients.iter().zip(0_u32..).skip(1).map(|(c, power)| c * f64::from(power)).collect();
    let mut ends = vec![low];
    ends.extend(changes(&slope, [low, high]));
    ends.push(high);
    let piece = |ends: &[f64]| {
        let sign = if polynomial(coefficients, ends[1]).0 > 0.0 { 1.0 } else { -1.0 };
        let signed = |at: f64| {
            let (value, slope) = polynomial(coefficients, at);
            (sign * value, sign * slope)
        };
        (signed(ends[0]).0 < 0.0 && signed(ends[1]).0 > 0.0)
            .then(|| root(signed, [ends[0], ends[1]], f64::midpoint(ends[0], ends[1])))
    };
    ends.windows(2).filter_map(piece).collect()
}

#[cfg(test)]
mod tests {
    use super::{changes, polynomial, root};

    #[test]
    fn the_root_of_two_is_found_from_anywhere() {
        for guess in [0.0, 1e-300, 0.1, 1.4, 2.0, 1e3, f64::NAN] {
            let found = root(|at| (at * at - 2.0, 2.0 * at), [0.0, 1e3], guess);
            assert!((found - 2.0_f64.sqrt()).abs() < 1e-15, "{guess} leads to {found}");
        }
    }

    #[test]
    fn if_the_slope_does_not_help_the_bracket_is_halved() {
        let flat = |at: f64| ((at - 0.3).cbrt(), 0.0);
        assert!((root(flat, [0.0, 1.0], 0.9) - 0.3).abs() < 1e-15);
    }

    #[test]
    fn a_polynomial_and_its_slope() {
        assert_eq!(polynomial(&[5.0, -3.0, 0.0, 2.0], 2.0), (15.0, 21.0));
    }

    #[test]
    fn a_polynomial_changes_its_sign_at_its_simple_roots() {
        // (x - 1) (x - 3) (x - 7), within [0, 5].
        let found = changes(&[-21.0, 31.0, -11.0, 1.0], [0.0, 5.0]);
        assert!((found[0] - 1.0).abs() < 1e-14 && (found[1] - 3.0).abs() < 1e-14, "{found:?}");
        assert_eq!(found.len(), 2);
        assert!(changes(&[0.0, 0.0, f64::NAN, f64::INFINITY], [0.0, 5.0]).is_empty());
    }
}
