//! Bounds of rates from counted cases.

/// The confidence of a bound.
const CONFIDENCE: f64 = 0.95;

/// The upper bound, with a confidence of 95 %, of the rate of an event that was seen in `seen` of
/// `of` independent cases: with any greater rate, so few would be seen in less than one of twenty
/// trials. The bound is exact (Clopper and Pearson 1934, one-sided). For none seen it is the rule
/// of three, about `3 / of`.
pub fn upper_bound(seen: usize, of: usize) -> f64 {
    if seen >= of {
        return 1.0;
    }
    // The measured rate is a lower limit of the bound.
    let (mut low, mut high) = (seen as f64 / of as f64, 1.0);
    for _ in 0..64 {
        let rate = f64::midpoint(low, high);
        if at_most(seen, of, rate) > 1.0 - CONFIDENCE {
            low = rate;
        } else {
            high = rate;
        }
    }
    high
}

/// The lower bound, with a confidence of 95 %, of the rate of an event that was seen in `seen` of `of`
/// independent cases. It is exact, as [`upper_bound`].
pub fn lower_bound(seen: usize, of: usize) -> f64 {
    if seen == 0 { 0.0 } else { 1.0 - upper_bound(of.saturating_sub(seen), of) }
}

/// The least number of cases, none of them the event, after which the upper bound of its rate is at most
/// `limit`.
#[expect(clippy::cast_sign_loss, reason = "both logarithms are negative")]
pub fn cases_needed(limit: f64) -> usize {
    ((1.0 - CONFIDENCE).ln() / (-limit).ln_1p()).ceil() as usize
}

/// The probability of at most `seen` events if the rate is `rate`, at or above `seen / of`.
fn at_most(seen: usize, of: usize, rate: f64) -> f64 {
    let binomial: f64 = (0..seen).map(|nth| ((of - nth) as f64 / (nth + 1) as f64).ln()).sum();
    let exactly = binomial + seen as f64 * rate.ln() + (of - seen) as f64 * (-rate).ln_1p();
    // From the largest term down: each term is a fraction of the one before.
    let mut part = 1.0;
    let mut sum = 0.0;
    for nth in (0..=seen).rev() {
        sum += part;
        part *= nth as f64 * (1.0 - rate) / ((of - nth + 1) as f64 * rate);
        if part < sum * f64::EPSILON {
            break;
        }
    }
    (exactly + sum.ln()).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn close(found: f64, expected: f64, relative: f64) {
        assert!((found / expected - 1.0).abs() < relative, "{found} {expected}");
    }

    #[test]
    fn the_bound_of_no_failure_is_the_rule_of_three() {
        for of in [1, 10, 100, 3000, 20_000] {
            // 1 - 0.05^(1/n), computed in another way.
            let exact = -(0.05_f64.ln() / of as f64).exp_m1();
            close(upper_bound(0, of), exact, 1e-12);
        }
        close(upper_bound(0, 30_000), 3.0 / 30_000.0, 2e-3);
    }

    #[test]
    fn bounds_equal_published_ones() {
        // By the incomplete beta function of mpmath, with 40 digits.
        for (seen, of, bound) in [
            (1, 10, 0.394_163_302_436_505),
            (1, 100, 0.046_559_811_453_538_9),
            (2, 60, 0.101_235_894_924_162),
            (5, 20, 0.455_582_404_001_749),
            (19, 20, 0.997_438_621_223_47),
            (10, 1000, 0.016_903_175_120_562_5),
            (3, 20_000, 0.000_387_636_755_786_371),
            (40, 20_000, 0.002_602_682_686_899_36),
        ] {
            close(upper_bound(seen, of), bound, 1e-9);
        }
        // For large numbers of cases, half of the chi-square quantile with 2 (seen + 1) degrees of
        // freedom: 4.7439, 6.2958, 7.7537, 16.962 (Poisson tables).
        for (seen, expected) in [(1, 4.7439), (2, 6.2958), (3, 7.7537), (10, 16.962)] {
            close(upper_bound(seen, 10_000_000) * 1e7, expected, 1e-4);
        }
    }

    #[test]
    fn an_event_and_its_absence_have_the_same_bounds() {
        // By the incomplete beta function of mpmath, as above: the bounds of 9 of 10 and of 95 of 100.
        close(lower_bound(1, 10), 0.005_116_196_891_823_7, 1e-9);
        close(lower_bound(5, 100), 0.019_905_563_662_172, 1e-9);
        let lower = [(0, 10), (0, 0), (5, 5)].map(|(seen, of)| lower_bound(seen, of));
        assert_eq!(lower, [0.0, 0.0, 1.0 - upper_bound(0, 5)]);
        assert_eq!((upper_bound(5, 5), upper_bound(0, 0)), (1.0, 1.0));
    }

    #[test]
    fn so_many_cases_without_a_failure_show_a_limit() {
        for (limit, cases) in [(0.5, 5), (0.05, 59), (0.01, 299), (0.005, 598), (0.001, 2995)] {
            assert_eq!(cases_needed(limit), cases);
            assert!(upper_bound(0, cases) <= limit && upper_bound(0, cases - 1) > limit, "{limit}");
        }
    }
}
