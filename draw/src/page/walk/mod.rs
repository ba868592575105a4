//! A page on which a reader walks two worlds at once: a robot in each, both sent through the same doors, and the percepts of
//! each. The page compares the worlds with the marker that the reader chooses. Section 2.2, Figure 1.

mod data;

pub(super) use data::side as side_json;
use toposlam_model::{
    aid::AidKind, embedded_graph::Dart, format::named_world::NamedWorld, marker::NoMarker,
};

use super::{GRAPH_SCRIPT, MARKER_SCRIPT, PAGE_SCRIPT, PAGE_STYLE, template::filled};
use crate::picture::{WorldPicture, escaped, svg};

/// If the robots can be in more pairs of states, the pairs are not listed.
pub const MOST_PAIRS: usize = 100_000;

/// The content of the page.
#[derive(Clone, Copy)]
pub struct WalkPage<'a> {
    pub worlds: [&'a NamedWorld; 2],
    /// The darts that place the marker. The robot of the first world begins with that dart behind it.
    pub facings: [Dart; 2],
    /// The dart behind the robot of the second world at the start.
    pub pose: Dart,
    /// The kind of marker at first.
    pub marker: AidKind,
}

const PAGE: &str = include_str!("../browser/walk.html");
pub(super) const WALK_STATE_SCRIPT: &str = include_str!("../browser/walk_state.js");
/// In the order of their dependencies; they share one scope.
const SCRIPT: [&str; 9] = [
    PAGE_SCRIPT,
    GRAPH_SCRIPT,
    MARKER_SCRIPT,
    WALK_STATE_SCRIPT,
    include_str!("../browser/comparison.js"),
    include_str!("../browser/panel.js"),
    include_str!("../browser/percepts.js"),
    include_str!("../browser/relation.js"),
    include_str!("../browser/walk.js"),
];

/// The page as an HTML document. The same worlds give the same bytes.
pub fn page(page: &WalkPage) -> String {
    let [one, other] = page.worlds;
    filled(
        PAGE,
        &[
            ("title", &escaped(&format!("{} and {}", one.name, other.name))),
            ("style", PAGE_STYLE),
            ("name of A", &escaped(&one.name)),
            ("name of B", &escaped(&other.name)),
            ("picture of A", &picture(one)),
            ("picture of B", &picture(other)),
            ("data", &data::json(page)),
            ("script", &SCRIPT.concat()),
        ],
    )
}

/// The drawing of a world, without texts and without a marker, which the page draws.
pub(super) fn picture(world: &NamedWorld) -> String {
    let (title, caption, marker) = ("", "", NoMarker.into());
    svg(&WorldPicture { start: None, marker, title, caption, ..WorldPicture::from(world) })
}

#[cfg(test)]
mod tests {
    use serde_json::json;
    use toposlam_model::{aid::AIDS, embedded_graph::EmbeddedGraph, marker::Undirected};

    use super::*;
    use crate::page::template::checks::{NASTY, assert_escaped, data_of};

    /// A chain with this number of edges; the start is one end.
    fn chain(name: &str, edges: usize) -> NamedWorld {
        let vertex = |n: usize| {
            let neighbours = [n.checked_sub(1), Some(n + 1).filter(|&next| next <= edges)];
            (n.to_string(), neighbours.into_iter().flatten().map(|n| n.to_string()).collect())
        };
        let lists: Vec<(String, Vec<String>)> = (0..=edges).map(vertex).collect();
        let graph = EmbeddedGraph::from_neighbour_lists(&lists).unwrap();
        NamedWorld::numbered(name, "", graph, Some(Dart(0)))
    }

    fn document(marker: AidKind, worlds: [&NamedWorld; 2]) -> String {
        page(&WalkPage { worlds, facings: [Dart(0), Dart(1)], pose: Dart(2), marker })
    }

    #[test]
    fn names_are_escaped_everywhere() {
        let worlds = [chain(NASTY, 1), chain("plain", 2)];
        let document = document(NoMarker.into(), worlds.each_ref());
        assert_escaped(&document);
        assert_eq!(data_of(&document)["sides"][0]["name"], NASTY);
    }

    #[test]
    fn the_data_has_the_worlds_and_where_the_robots_and_the_markers_are() {
        let worlds = [chain("one", 1), chain("two", 2)];
        let data = data_of(&document(Undirected.into(), worlds.each_ref()));
        assert_eq!(data["marker"], "undirected");
        assert_eq!(data["markers"].as_array().unwrap().len(), AIDS.len());
        let [one, two] = [&data["sides"][0], &data["sides"][1]];
        assert_eq!(one["world"], json!([[[1, 0]], [[0, 0]]]));
        assert_eq!(one["facing"], json!([0, 0]));
        assert_eq!(two["world"], json!([[[1, 0]], [[0, 0], [2, 0]], [[1, 1]]]));
        assert_eq!((&two["facing"], &data["pose"]), (&json!([1, 0]), &json!([1, 1])));
        assert_eq!(two["facings"], json!(["v1", "v0", "v2", "v1"]));
    }
}
