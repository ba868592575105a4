//! A page on which a reader follows the run of a simulated robot, picture by picture: where it was, what
//! its camera saw, its map as it grew, and the story of Algorithm 1. Section 6, Figure 11.

mod data;
mod words;

use super::{PAGE_SCRIPT, PAGE_STYLE, filled};
use crate::{
    journal::Journal,
    picture::{escaped, growth, run_drawing},
};

const PAGE: &str = include_str!("../browser/run.html");
const STYLE: [&str; 2] = [PAGE_STYLE, include_str!("../browser/run.css")];
/// In the order in which they build on each other; they share one scope.
const SCRIPT: [&str; 3] =
    [PAGE_SCRIPT, include_str!("../browser/floor.js"), include_str!("../browser/run.js")];

/// The page of a run as an HTML document. The same run gives the same bytes.
#[must_use]
pub fn run_page(journal: &Journal) -> String {
    let drawn = run_drawing(journal);
    filled(PAGE, |place| match place {
        "title" => escaped(&journal.name),
        "about" => escaped(&words::about(journal)),
        "style" => STYLE.concat(),
        "plan" => drawn.svg.clone(),
        "maps" => maps(journal),
        "data" => data::json(journal, &drawn),
        "script" => SCRIPT.concat(),
        _ => String::new(),
    })
}

/// Every map, each in an element of its own; the page shows one of them.
fn maps(journal: &Journal) -> String {
    let of = |svg: &String| format!("<div class=\"stage\" hidden>\n{svg}</div>\n");
    growth(&journal.maps).iter().map(of).collect()
}
