//! Pages for a browser: a walk in two worlds at once ([`page`]), the run of a simulated robot
//! ([`run_page`]), conformance reports ([`conform_page`]), and a game in which a person is the robot
//! ([`play_page`]).
//!
//! Each is one self-contained HTML document that needs no network. Its HTML, CSS and scripts are in
//! `browser/`.

mod conform;
mod play;
mod run;
mod walk;

use serde_json::Value;

pub use conform::conform_page;
pub use play::play_page;
pub use run::run_page;
pub use walk::{MOST_PAIRS, WalkPage, page};

/// The stylesheet of all pages.
const PAGE_STYLE: &str = include_str!("browser/page.css");
/// The beginning of the scripts of all pages.
const PAGE_SCRIPT: &str = include_str!("browser/page.js");

/// The template with each `{{place}}` replaced. The inserted text is not searched for places.
fn filled(template: &str, content: impl Fn(&str) -> String) -> String {
    let mut parts = template.split("{{");
    let mut filled = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (place, rest) = part.split_once("}}").unwrap_or((part, ""));
        filled.push_str(&content(place));
        filled.push_str(rest);
    }
    filled
}

/// JSON for the inside of a `script` element: nothing in it ends the element or begins a comment.
fn in_script(data: &Value) -> String {
    data.to_string().replace('<', "\\u003c")
}
