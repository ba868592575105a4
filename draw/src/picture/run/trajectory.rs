//! The robot's path: a line through the positions of all frames, from light to dark.

use std::fmt::Write;

use super::{
    super::svg::{Page, short},
    ground::Ground,
};
use crate::run_page_data::PageFrame;

/// The most colours of the line.
const COLOURS: usize = 40;
/// Red, green and blue at the start, half-way and at the end.
const RAMP: [[f64; 3]; 3] = [[126.0, 187.0, 234.0], [44.0, 116.0, 186.0], [9.0, 32.0, 66.0]];

/// Draws the line: one piece for each colour, each from the end of the last.
pub(super) fn write(page: &mut Page, ground: &Ground, rounds: &[PageFrame]) {
    page.line(
        "<g fill=\"none\" stroke-width=\"1.7\" stroke-linejoin=\"round\" stroke-linecap=\"round\">",
    );
    for (first, last, share) in pieces(rounds.len()) {
        let mut points = String::new();
        for round in &rounds[first..=last] {
            let at = page.at(ground.at(round.pose.position));
            // Writing to a string does not fail.
            let _ = write!(points, "{},{} ", short(at.x), short(at.y));
        }
        page.line(&format!(
            "<polyline class=\"trajectory\" data-rounds=\"{first} {last}\" points=\"{}\" \
             stroke=\"{}\"/>",
            points.trim_end(),
            ramp(share)
        ));
    }
    page.line("</g>");
}

/// The first and the last point of each piece of a line through a number of points, and its share of the
/// time.
pub(in crate::picture) fn pieces(points: usize) -> impl Iterator<Item = (usize, usize, f64)> {
    let steps = points.saturating_sub(1);
    let count = steps.min(COLOURS);
    (0..count).map(move |piece| {
        let end = |piece: usize| piece * steps / count;
        (end(piece), end(piece + 1), piece as f64 / (count - 1).max(1) as f64)
    })
}

/// The colour at a share of the time.
pub(in crate::picture) fn ramp(share: f64) -> String {
    let (from, to, share) = if share < 0.5 {
        (RAMP[0], RAMP[1], 2.0 * share)
    } else {
        (RAMP[1], RAMP[2], 2.0 * share - 1.0)
    };
    let mix = |part: usize| (from[part] + (to[part] - from[part]) * share).round() as u8;
    format!("#{:02x}{:02x}{:02x}", mix(0), mix(1), mix(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pieces_join_up() {
        for points in [0, 1, 2, 3, 40, 41, 42, 1000] {
            let pieces: Vec<_> = pieces(points).collect();
            let steps: usize = pieces.iter().map(|(first, last, _)| last - first).sum();
            assert_eq!(steps, points.saturating_sub(1));
            assert!(pieces.windows(2).all(|two| two[0].1 == two[1].0 && two[0].2 < two[1].2));
        }
    }

    #[test]
    fn the_line_grows_darker() {
        assert_eq!([0.0, 0.5, 1.0].map(ramp), ["#7ebbea", "#2c74ba", "#092042"]);
    }
}
