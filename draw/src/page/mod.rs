//! Pages for a browser: a walk in two worlds at once ([`page`]), the run of a simulated robot
//! ([`run_page`]), the run of an explorer ([`explorer_page`]), conformance reports ([`conform_page`]), and a game in
//! which a person is the robot ([`play_page`]).
//!
//! Each is one self-contained HTML document that needs no network. Its HTML, CSS and scripts are in
//! `browser/`.

mod conform;
mod explorer;
mod graph_json;
mod play;
mod run;
mod template;
mod walk;

pub use conform::{ReportOrigin, conform_page};
pub use explorer::explorer_page;
pub use play::{MOST_VERTICES, NoGame, games_of, play_page, random_games};
pub use run::run_page;
pub use walk::{MOST_PAIRS, WalkPage, page};

/// The stylesheet of all pages.
const PAGE_STYLE: &str = include_str!("browser/page.css");
/// The beginning of the scripts of all pages.
const PAGE_SCRIPT: &str = include_str!("browser/page.js");
/// Embedded graphs, and the kinds of markers, in the scripts of pages.
const GRAPH_SCRIPT: &str = include_str!("browser/graph.js");
const MARKER_SCRIPT: &str = include_str!("browser/marker.js");
