//! The Euclidean distance transform of Meijster, Roerdink and Hesselink (2000).

use std::ops::Range;

/// For each cell of a rectangle with this many columns that is asked for, the squared distance, in cells, to
/// the nearest one of the sites. It is at least the square of the longer side if there is none. The numbers of
/// the other cells mean nothing.
#[must_use]
pub fn squared_distances<T: Copy>(
    columns: usize,
    cells: &[T],
    is_site: impl Fn(T) -> bool,
    is_asked: impl Fn(T) -> bool,
) -> Vec<u32> {
    let distances = column_distances(columns, cells, is_site);
    let mut squared = vec![0; cells.len()];
    let mut envelope = Vec::with_capacity(columns);
    let rows = distances.chunks_exact(columns).zip(cells.chunks_exact(columns));
    for ((row, cells), squared) in rows.zip(squared.chunks_exact_mut(columns)) {
        // Sites divide a row: no cell is nearer to what is behind one.
        let mut from = 0;
        while from < columns {
            let to = (from..columns).find(|&x| row[x] == 0).unwrap_or(columns);
            if cells[from..to].iter().any(|&cell| is_asked(cell)) {
                row_distances(row, from..to, &mut envelope, squared);
            }
            from = to + 1;
        }
    }
    squared
}

/// The distance to the nearest site in the same column.
fn column_distances<T: Copy>(columns: usize, cells: &[T], is_site: impl Fn(T) -> bool) -> Vec<i32> {
    let far = (columns + cells.len() / columns.max(1)) as i32;
    let mut distances: Vec<i32> =
        cells.iter().map(|&cell| if is_site(cell) { 0 } else { far }).collect();
    for at in columns..distances.len() {
        distances[at] = distances[at].min(distances[at - columns] + 1);
    }
    for at in (0..distances.len().saturating_sub(columns)).rev() {
        distances[at] = distances[at].min(distances[at + columns] + 1);
    }
    distances
}

/// The squared distances of cells of a row between two sites, or its ends: the lower envelope of the parabolas
/// of their columns and of those of the sites.
fn row_distances(
    row: &[i32],
    between: Range<usize>,
    envelope: &mut Vec<(usize, usize)>,
    squared: &mut [u32],
) {
    let value = |x: usize, site: usize| (x as i32 - site as i32).pow(2) + row[site].pow(2);
    // The columns on the envelope, each with the first place where it is the lowest.
    envelope.clear();
    for site in between.start.saturating_sub(1)..(between.end + 1).min(row.len()) {
        while let Some(&(below, from)) = envelope.last()
            && value(from, below) > value(from, site)
        {
            envelope.pop();
        }
        let from = match envelope.last() {
            None => between.start,
            Some(&(below, _)) => {
                let (one, other) = (below as i32, site as i32);
                let off = other.pow(2) - one.pow(2) + row[site].pow(2) - row[below].pow(2);
                // Most are neighbours, and a shift is faster than a division.
                let apart = other - one;
                let last = if apart == 1 { off >> 1 } else { off.div_euclid(2 * apart) };
                usize::try_from(last + 1).unwrap_or_default()
            }
        };
        if from < between.end {
            envelope.push((site, from));
        }
    }
    let mut lowest = envelope.iter().peekable();
    let mut site = between.start;
    for x in between {
        while let Some(&(next, _)) = lowest.next_if(|&&(_, from)| from <= x) {
            site = next;
        }
        squared[x] = u32::try_from(value(x, site)).unwrap_or(u32::MAX);
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
            cells in prop::collection::vec(
                prop_oneof![4 => Just(0), 4 => Just(1), 1 => Just(2)], 1..100,
            ),
        ) {
            let cells = &cells[..cells.len() / columns * columns];
            prop_assume!(cells.contains(&2));
            let squared = squared_distances(columns, cells, |cell| cell == 2, |cell| cell == 1);
            for (at, &distance) in squared.iter().enumerate().filter(|&(at, _)| cells[at] == 1) {
                let off = |site: usize| {
                    let [x, y] = [at % columns, at / columns];
                    x.abs_diff(site % columns).pow(2) + y.abs_diff(site / columns).pow(2)
                };
                let sites = (0..cells.len()).filter(|&site| cells[site] == 2);
                prop_assert_eq!(Some(distance as usize), sites.map(off).min());
            }
        }
    }

    #[test]
    fn without_a_site_everything_is_far() {
        let squared = squared_distances(5, &[(); 20], |()| false, |()| true);
        assert!(squared.into_iter().all(|squared| squared >= 25));
    }
}
