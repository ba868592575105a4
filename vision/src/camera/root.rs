//! The root of a function, to the last bits.

/// Where a function is zero that is not positive at the lower end and positive at the upper, given
/// with its slope: Newton's steps, and halves of the bracket where they would leave it.
pub(super) fn root(
    function: impl Fn(f64) -> (f64, f64),
    [mut low, mut high]: [f64; 2],
    guess: f64,
) -> f64 {
    let mut at = if guess > low && guess < high { guess } else { f64::midpoint(low, high) };
    let mut last = high - low;
    // Newton's steps double the digits, halves add one each: no function takes more than these.
    for _ in 0..200 {
        let (value, slope) = function(at);
        if value > 0.0 {
            high = at;
        } else {
            low = at;
        }
        let newton = at - value / slope;
        // A step that is not at most half as long as the last gets no nearer than a half would.
        let next = if newton >= low && newton <= high && (newton - at).abs() <= 0.5 * last {
            newton
        } else {
            f64::midpoint(low, high)
        };
        last = (next - at).abs();
        at = next;
        if last <= 2.0 * f64::EPSILON * at.abs() {
            break;
        }
    }
    at
}

#[cfg(test)]
mod tests {
    use super::root;

    #[test]
    fn the_root_of_two_is_found_from_anywhere() {
        for guess in [0.0, 1e-300, 0.1, 1.4, 2.0, 1e3, f64::NAN] {
            let found = root(|at| (at * at - 2.0, 2.0 * at), [0.0, 1e3], guess);
            assert!((found - 2.0_f64.sqrt()).abs() < 1e-15, "{guess} leads to {found}");
        }
    }

    #[test]
    fn where_the_slope_is_of_no_help_the_bracket_is_halved() {
        let flat = |at: f64| ((at - 0.3).cbrt(), 0.0);
        assert!((root(flat, [0.0, 1.0], 0.9) - 0.3).abs() < 1e-15);
    }
}
