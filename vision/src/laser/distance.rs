//! The Euclidean distance transform of Meijster, Roerdink and Hesselink (2000).

/// For each cell of a rectangle with this many columns the squared distance, in cells, to the nearest one of
/// a kind. It is at least the square of the longer side if there is none.
#[must_use]
pub fn squared_distances<T: Copy + PartialEq>(columns: usize, cells: &[T], kind: T) -> Vec<u32> {
    let distances = column_distances(columns, cells, kind);
    let mut squared = Vec::with_capacity(cells.len());
    let mut envelope = Vec::with_capacity(columns);
    for row in distances.chunks_exact(columns) {
        row_distances(row, &mut envelope, &mut squared);
    }
    squared
}

/// The distance to the nearest cell of a kind in the same column.
fn column_distances<T: Copy + PartialEq>(columns: usize, cells: &[T], kind: T) -> Vec<i32> {
    let far = (columns + cells.len() / columns.max(1)) as i32;
    let mut distances: Vec<i32> =
        cells.iter().map(|&cell| if cell == kind { 0 } else { far }).collect();
    for at in columns..distances.len() {
        distances[at] = distances[at].min(distances[at - columns] + 1);
    }
    for at in (0..distances.len().saturating_sub(columns)).rev() {
        distances[at] = distances[at].min(distances[at + columns] + 1);
    }
    distances
}

/// The squared distances of a row: the lower envelope of the parabolas of its columns.
fn row_distances(row: &[i32], envelope: &mut Vec<(usize, usize)>, squared: &mut Vec<u32>) {
    let columns = row.len();
    let value = |x: usize, site: usize| (x as i32 - site as i32).pow(2) + row[site].pow(2);
    // The sites on the envelope, each with the first place where it is the lowest.
    envelope.clear();
    for site in 0..columns {
        while let Some(&(below, from)) = envelope.last()
            && value(from, below) > value(from, site)
        {
            envelope.pop();
        }
        let from = match envelope.last() {
            None => 0,
            Some(&(below, _)) => {
                let (one, other) = (below as i32, site as i32);
                let off = other.pow(2) - one.pow(2) + row[site].pow(2) - row[below].pow(2);
                off.div_euclid(2 * (other - one)) + 1
            }
        };
        if let Ok(from) = usize::try_from(from)
            && from < columns
        {
            envelope.push((site, from));
        }
    }
    let mut lowest = envelope.iter().peekable();
    let mut site = 0;
    for x in 0..columns {
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
            columns in 1_usize..12,
            cells in prop::collection::vec(prop::bool::weighted(0.1), 1..100),
        ) {
            let cells = &cells[..cells.len() / columns * columns];
            prop_assume!(cells.contains(&true));
            let squared = squared_distances(columns, cells, true);
            for (at, &distance) in squared.iter().enumerate() {
                let off = |site: usize| {
                    let [x, y] = [at % columns, at / columns];
                    x.abs_diff(site % columns).pow(2) + y.abs_diff(site / columns).pow(2)
                };
                let sites = (0..cells.len()).filter(|&site| cells[site]);
                prop_assert_eq!(Some(distance as usize), sites.map(off).min());
            }
        }
    }

    #[test]
    fn without_a_site_everything_is_far() {
        let squared = squared_distances(5, &[false; 20], true);
        assert!(squared.into_iter().all(|squared| squared >= 25));
    }
}
