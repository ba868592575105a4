//! The numbers of the moves through each hallway, on the right of the robot's path.

use std::fmt::Write;

use toposlam_model::embedded_graph::Dart;

use super::{
    super::{
        svg::{FAINT, Page, short},
        text,
    },
    ground::{Ground, along},
};
use crate::run_page_data::PageFrame;

/// The font size of the numbers, and the height of a line.
const SIZE: f64 = 9.5;
const LINE: f64 = 11.5;
/// The margin to the walls and to the middle of the hallway.
const CLEAR: f64 = 6.0;

/// Draws the numbers of all moves.
pub(super) fn write(page: &mut Page, ground: &Ground, rounds: &[PageFrame]) {
    let graph = ground.plan.graph();
    let mut through = vec![Vec::new(); graph.dart_count()];
    for of_move in rounds.chunk_by(|one, other| one.moves == other.moves) {
        if let Some(dart) = passed(ground, of_move) {
            through[dart.at()].push(of_move[0].moves);
        }
    }
    page.line(&format!("<g fill=\"{FAINT}\" font-size=\"{SIZE}\" text-anchor=\"middle\">"));
    for (dart, moves) in graph.darts().zip(&through) {
        write_numbers(page, ground, dart, moves);
    }
    page.line("</g>");
}

/// The dart by which the robot left, if it reached the other end of the hallway.
fn passed(ground: &Ground, rounds: &[PageFrame]) -> Option<Dart> {
    let graph = ground.plan.graph();
    let near = |round: &PageFrame, dart: Dart| {
        let at = ground.at(round.pose.position);
        at.distance(ground.turning_point(graph.vertex(dart))) < ground.half()
    };
    let [first, last] = [rounds.first()?, rounds.last()?];
    let between = |dart: &Dart| near(first, *dart) && near(last, graph.opposite(*dart));
    graph.darts().find(between)
}

/// Draws the numbers of the moves that left by a dart: in lines, at the middle of the hallway.
fn write_numbers(page: &mut Page, ground: &Ground, dart: Dart, moves: &[u64]) {
    if moves.is_empty() {
        return;
    }
    let graph = ground.plan.graph();
    let [from, to] =
        [dart, graph.opposite(dart)].map(|end| ground.turning_point(graph.vertex(end)));
    let ahead = along(ground.plan.direction(dart));
    let right = ahead.quarter_turn();
    let long = from.distance(to) - 2.0 * ground.half();
    let wide = ground.half() - 1.5 * CLEAR;
    let [room, high] = if ahead.x == 0.0 { [wide, long] } else { [long, wide] };
    let numbers: Vec<_> = moves.iter().map(u64::to_string).collect();
    // A number is not broken.
    let widest = numbers.iter().map(|number| text::width(number, SIZE)).fold(room, f64::max);
    let mut lines = text::lines(&numbers.join(" "), SIZE, widest);
    let fit = ((high / LINE) as usize).max(1);
    if lines.len() > fit {
        lines.truncate(fit);
        if let Some(last) = lines.last_mut() {
            let kept = last.rsplit_once(' ').map_or("", |(kept, _)| kept);
            *last = format!("{kept} \u{2026}");
        }
    }
    let half = (from.distance(to) / 2.0, ground.half() / 2.0 + 0.25 * CLEAR);
    let middle = page.at(from + ahead * half.0 + right * half.1);
    let first = middle.y + SIZE * 0.36 - LINE * (lines.len() as f64 - 1.0) / 2.0;
    for (number, line) in lines.iter().enumerate() {
        let baseline = first + LINE * number as f64;
        let mut spans = String::new();
        for (place, word) in line.split(' ').enumerate() {
            let space = if place > 0 { " " } else { "" };
            // Writing to a string does not fail.
            let _ = match word.parse::<u64>() {
                Ok(moves) => write!(spans, "{space}<tspan data-moves=\"{moves}\">{word}</tspan>"),
                Err(_) => write!(spans, "{space}{word}"),
            };
        }
        page.line(&format!(
            "<text class=\"passes\" x=\"{}\" y=\"{}\">{spans}</text>",
            short(middle.x),
            short(baseline)
        ));
    }
}
