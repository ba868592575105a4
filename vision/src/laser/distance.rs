//! The Euclidean distance transform (Meijster, Roerdink and Hesselink, 2000).

/// For each cell the squared distance, in cells, to the nearest that is a site.
pub fn squared_distances(side: usize, is_site: impl Fn(usize) -> bool) -> Vec<u32> {
    let far = 2 * side as i64;
    // The distance to the nearest site in the same column.
    let mut column = vec![far; side * side];
    for x in 0..side {
        let mut distance = far;
        for y in 0..side {
            distance = if is_site(y * side + x) { 0 } else { (distance + 1).min(far) };
            column[y * side + x] = distance;
        }
        let mut distance = far;
        for y in (0..side).rev() {
            distance = if column[y * side + x] == 0 { 0 } else { (distance + 1).min(far) };
            let known = &mut column[y * side + x];
            *known = (*known).min(distance);
        }
    }
    // The lower envelope of the parabolas of each row.
    let mut squared = vec![0; side * side];
    let (mut hull, mut from) = (vec![0_usize; side], vec![0_i64; side]);
    for y in 0..side {
        let row = &column[y * side..(y + 1) * side];
        let value = |x: i64, site: usize| {
            let off = x - site as i64;
            off * off + row[site] * row[site]
        };
        let mut top = 0;
        (hull[0], from[0]) = (0, 0);
        for x in 1..side {
            loop {
                if value(from[top], hull[top]) > value(from[top], x) {
                    if top == 0 {
                        (hull[0], from[0]) = (x, 0);
                        break;
                    }
                    top -= 1;
                    continue;
                }
                let (one, other) = (hull[top] as i64, x as i64);
                let cut = (other * other - one * one + row[x] * row[x]
                    - row[hull[top]] * row[hull[top]])
                    .div_euclid(2 * (other - one));
                if cut + 1 < side as i64 {
                    top += 1;
                    (hull[top], from[top]) = (x, cut + 1);
                }
                break;
            }
        }
        for x in (0..side).rev() {
            squared[y * side + x] = value(x as i64, hull[top]).min(i64::from(u32::MAX)) as u32;
            if x as i64 == from[top] && top > 0 {
                top -= 1;
            }
        }
    }
    squared
}
