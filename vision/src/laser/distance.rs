//! The Euclidean distance transform of Meijster, Roerdink and Hesselink (2000).

/// For each cell of a square the squared distance, in cells, to the nearest one that is a site. It is at
/// least the square of the side if there is no site.
#[must_use]
pub fn squared_distances(side: usize, is_site: impl Fn(usize) -> bool) -> Vec<u32> {
    let column = column_distances(side, is_site);
    let mut squared = Vec::with_capacity(side * side);
    for row in column.chunks_exact(side) {
        row_distances(row, &mut squared);
    }
    squared
}

/// The distance to the nearest site in the same column.
fn column_distances(side: usize, is_site: impl Fn(usize) -> bool) -> Vec<i64> {
    let far = 2 * side as i64;
    let mut distances = vec![far; side * side];
    for x in 0..side {
        let mut distance = far;
        for y in 0..side {
            distance = if is_site(y * side + x) { 0 } else { (distance + 1).min(far) };
            distances[y * side + x] = distance;
        }
        for y in (0..side).rev() {
            let known = &mut distances[y * side + x];
            distance = (*known).min(distance + 1);
            *known = distance;
        }
    }
    distances
}

/// The squared distances of a row: the lower envelope of the parabolas of its columns.
fn row_distances(row: &[i64], squared: &mut Vec<u32>) {
    let side = row.len();
    let value = |x: usize, site: usize| (x as i64 - site as i64).pow(2) + row[site].pow(2);
    // The sites on the envelope, each with the first place where it is the lowest.
    let mut envelope: Vec<(usize, usize)> = Vec::with_capacity(side);
    for site in 0..side {
        while let Some(&(below, from)) = envelope.last()
            && value(from, below) > value(from, site)
        {
            envelope.pop();
        }
        let from = match envelope.last() {
            None => 0,
            Some(&(below, _)) => {
                let (one, other) = (below as i64, site as i64);
                let off = other.pow(2) - one.pow(2) + row[site].pow(2) - row[below].pow(2);
                off.div_euclid(2 * (other - one)) + 1
            }
        };
        if let Ok(from) = usize::try_from(from)
            && from < side
        {
            envelope.push((site, from));
        }
    }
    let mut lowest = envelope.iter().peekable();
    let mut site = 0;
    for x in 0..side {
        while let Some(&(next, _)) = lowest.next_if(|&&(_, from)| from <= x) {
            site = next;
        }
        squared.push(u32::try_from(value(x, site)).unwrap_or(u32::MAX));
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn distances_are_those_to_the_nearest_site(
            side in 1_usize..12,
            sites in prop::collection::vec(0_usize..144, 1..8),
        ) {
            let sites: Vec<usize> = sites.into_iter().map(|site| site % (side * side)).collect();
            let squared = squared_distances(side, |at| sites.contains(&at));
            for (at, &distance) in squared.iter().enumerate() {
                let off = |site: &usize| {
                    let [x, y] = [at % side, at / side];
                    x.abs_diff(site % side).pow(2) + y.abs_diff(site / side).pow(2)
                };
                prop_assert_eq!(Some(distance as usize), sites.iter().map(off).min());
            }
        }
    }

    #[test]
    fn without_a_site_everything_is_far() {
        assert!(squared_distances(5, |_| false).into_iter().all(|squared| squared >= 25));
    }
}
