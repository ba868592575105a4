//! Numbers of edges as arguments: `6`, `1..=6`, `1..7`.

use std::{ops::RangeInclusive, str::FromStr};

/// A range of numbers of edges, none of them 0.
#[derive(Clone, Debug)]
pub(super) struct EdgeRange(RangeInclusive<usize>);

impl EdgeRange {
    pub(super) fn iter(&self) -> RangeInclusive<usize> {
        self.0.clone()
    }
}

impl FromStr for EdgeRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |number: &str| {
            number.parse::<usize>().map_err(|_| {
                format!("write a number as in 6, or several as in 1..=6, not `{text}`")
            })
        };
        let range = if let Some((first, last)) = text.split_once("..=") {
            number(first)?..=number(last)?
        } else if let Some((first, end)) = text.split_once("..") {
            let end = number(end)?.checked_sub(1).ok_or("the range is empty")?;
            number(first)?..=end
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
