//! Numbers of edges as arguments: exactly `6`, or each of `1..=6`.

use std::{ops::RangeInclusive, str::FromStr};

/// A range of numbers of edges, none of them 0.
#[derive(Clone, Debug)]
pub struct EdgeRange(RangeInclusive<usize>);

impl EdgeRange {
    #[expect(clippy::iter_without_into_iter, reason = "it is an argument, not a collection")]
    pub fn iter(&self) -> RangeInclusive<usize> {
        self.0.clone()
    }
}

impl FromStr for EdgeRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let refused = || format!("write a number as in 6, or several as in 1..=6, not `{text}`");
        let number = |number: &str| number.parse::<usize>().map_err(|_| refused());
        let range = if let Some((first, last)) = text.split_once("..=") {
            number(first)?..=number(last)?
        } else if let Some((first, last)) = text.split_once("..") {
            // In some languages the last number is not in such a range.
            let [first, last] = [number(first)?, number(last)?];
            return Err(format!("write {first}..={last} for all sizes from {first} to {last}"));
        } else {
            let only = number(text)?;
            only..=only
        };
        if *range.start() == 0 {
            return Err("a world has at least one edge".to_owned());
        }
        if range.is_empty() {
            return Err("the range is empty".to_owned());
        }
        Ok(Self(range))
    }
}
