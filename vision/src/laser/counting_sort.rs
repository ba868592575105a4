//! Sorts cells by small numbers.

/// The members of a list in the order of a key, those with the same key in their order in the list.
pub(super) fn sorted_by_key(list: &[usize], key: impl Fn(usize) -> u32) -> Vec<usize> {
    let highest = list.iter().map(|&member| key(member)).max().unwrap_or_default();
    // Where the next member with a key is put.
    let mut place = vec![0_u32; highest as usize + 2];
    for &member in list {
        place[key(member) as usize + 1] += 1;
    }
    for at in 1..place.len() {
        place[at] += place[at - 1];
    }
    let mut sorted = vec![0; list.len()];
    for &member in list {
        let place = &mut place[key(member) as usize];
        sorted[*place as usize] = member;
        *place += 1;
    }
    sorted
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn the_order_is_that_of_a_stable_sort(keys in prop::collection::vec(0_u32..9, 0..40)) {
            let list: Vec<usize> = (0..keys.len()).rev().collect();
            let mut expected = list.clone();
            expected.sort_by_key(|&member| keys[member]);
            prop_assert_eq!(sorted_by_key(&list, |member| keys[member]), expected);
        }
    }
}
