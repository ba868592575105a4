//! A page on which a reader walks two worlds at once: a robot in each, both sent through the same
//! doors, and the percepts of each. Section 2.2, Figure 1.

mod data;
mod side;

pub(super) use data::side as side_json;
pub(super) use side::WalkSide;
use toposlam_model::{
    ambiguity::Comparison, embedded_graph::Dart, format::named_world::NamedWorld,
};

use crate::{
    page::{PAGE_SCRIPT, PAGE_STYLE, template::filled},
    picture::escaped,
};

/// If the robots can be in more pairs of states, the pairs are not listed.
pub const MOST_PAIRS: usize = 100_000;

/// The content of the page.
#[derive(Clone, Copy)]
pub struct WalkPage<'a> {
    /// The heading, such as "figure-1a and figure-1b, undirected marker".
    pub title: &'a str,
    /// A sentence or two beneath it; may be empty.
    pub about: &'a str,
    pub worlds: [&'a NamedWorld; 2],
    pub comparison: &'a Comparison<'a>,
    /// The initial poses of the two robots: the darts by which they came in.
    pub poses: [Dart; 2],
}

const PAGE: &str = include_str!("../browser/walk.html");
/// In the order of their dependencies; they share one scope.
const SCRIPT: [&str; 5] = [
    PAGE_SCRIPT,
    include_str!("../browser/panel.js"),
    include_str!("../browser/percepts.js"),
    include_str!("../browser/relation.js"),
    include_str!("../browser/walk.js"),
];

/// The page as an HTML document. The same worlds give the same bytes.
pub fn page(page: &WalkPage) -> String {
    let robots = page.comparison.starts(page.poses);
    let [one, other] = [0, 1].map(|at| WalkSide::new(page.worlds[at], &robots[at]));
    filled(
        PAGE,
        &[
            ("title", &escaped(page.title)),
            ("about", &escaped(page.about)),
            ("style", PAGE_STYLE),
            ("name of A", &escaped(&page.worlds[0].name)),
            ("name of B", &escaped(&page.worlds[1].name)),
            ("marker of A", &escaped(&one.marker_place())),
            ("marker of B", &escaped(&other.marker_place())),
            ("picture of A", &one.picture()),
            ("picture of B", &other.picture()),
            ("data", &data::json(page, [&one, &other])),
            ("script", &SCRIPT.concat()),
        ],
    )
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};
    use toposlam_model::{
        embedded_graph::EmbeddedGraph,
        marker::{self, Marker},
    };

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

    fn document(marker: &'static dyn Marker, worlds: [&NamedWorld; 2], title: &str) -> String {
        let placed = worlds.map(|world| (&world.graph, Dart(0)));
        let comparison = Comparison::new(marker, placed[0], placed[1]);
        let poses = [Dart(0), Dart(0)];
        page(&WalkPage { title, about: title, worlds, comparison: &comparison, poses })
    }

    #[test]
    fn names_are_escaped_everywhere() {
        let worlds = [chain(NASTY, 1), chain("plain", 1)];
        let document = document(&marker::NoMarker, worlds.each_ref(), NASTY);
        assert_escaped(&document);
        assert_eq!(data_of(&document)["sides"][0]["name"], NASTY);
    }

    #[test]
    fn the_data_has_the_state_after_each_action_and_the_difference_of_the_worlds() {
        let worlds = [chain("one", 1), chain("two", 2)];
        let data = data_of(&document(&marker::Directional, worlds.each_ref(), ""));
        assert_eq!((&data["relation"], &data["walk"]), (&Value::Null, &json!(["0"])));
        let far = |degree: u32| {
            json!({
                "text": "v1:0",
                "dart": 1,
                "vertex": 1,
                "percept": if degree == 1 { "1 door" } else { "2 doors" },
                "actions": if degree == 1 { json!([["0", 0]]) } else { json!([["0", 0], ["1", 2]]) },
                "marker": null,
            "pointing": 0,
            })
        };
        assert_eq!(data["sides"][0]["states"][1], far(1));
        assert_eq!(data["sides"][1]["states"][1], far(2));
    }

    #[test]
    fn the_data_has_the_pairs_that_the_robots_can_reach() {
        let worlds = [chain("one", 1), chain("other", 1)];
        let data = data_of(&document(&marker::Movable, worlds.each_ref(), ""));
        assert_eq!(data["walk"], Value::Null);
        assert_eq!(data["relation"].as_array().unwrap().len(), 6);
        assert_eq!(data["relation"][0], json!([0, 0]));
        let carried = &data["sides"][0]["states"][2];
        assert_eq!(carried["text"], "v0:0+marker");
        assert_eq!(carried["marker"], "carried");
        assert_eq!(data["sides"][0]["states"][0]["marker"], 0);
        assert_eq!(carried["actions"], json!([["0", 3], ["drop", 0]]));
    }
}
