//! A page on which a person is the robot: it shows percepts only, and judges the person's map at the end. If the walk does
//! not determine the world, the page shows the smallest other world that explains it. The person is compared with the
//! certificate and with the algorithms that map with the marker. Sections 2.1 to 2.3.

mod data;
mod games;

pub use games::{NoGame, games_of, random_games};

use toposlam_model::{aid::AidKind, embedded_graph::Dart, format::named_world::NamedWorld};

use super::{GRAPH_SCRIPT, MARKER_SCRIPT, PAGE_SCRIPT, PAGE_STYLE, template::filled};
use crate::picture::{WorldPicture, escaped, svg};

/// The most vertices of a world of a page.
pub const MOST_VERTICES: usize = 100;

const PAGE: &str = include_str!("../browser/play.html");
/// In the order of their dependencies; they share one scope.
const SCRIPT: [&str; 11] = [
    PAGE_SCRIPT,
    GRAPH_SCRIPT,
    MARKER_SCRIPT,
    include_str!("../browser/percepts.js"),
    include_str!("../browser/play_map.js"),
    include_str!("../browser/play_judge.js"),
    include_str!("../browser/play_search.js"),
    include_str!("../browser/play_layout.js"),
    include_str!("../browser/play_drawing.js"),
    include_str!("../browser/play_here.js"),
    include_str!("../browser/play.js"),
];

/// The page as an HTML document, for a robot with this marker. The first world is that of the first game. The same
/// worlds give the same bytes.
pub fn play_page(games: &[NamedWorld], marker: AidKind) -> String {
    let pictures: String = games.iter().map(|world| picture(world, marker)).collect();
    filled(
        PAGE,
        &[
            ("style", PAGE_STYLE),
            ("marker", &escaped(marker.about())),
            ("pictures", &pictures),
            ("data", &data::json(games, marker)),
            ("script", &SCRIPT.concat()),
        ],
    )
}

/// The picture of a world, with the place of its marker in words.
fn picture(world: &NamedWorld, marker: AidKind) -> String {
    let (title, caption, start) = ("", "", Some(facing_of(world)));
    let drawn = WorldPicture { start, marker, title, caption, ..WorldPicture::from(world) };
    let place = drawn.marker_place().map(|place| format!("In this picture, {}. ", escaped(&place)));
    let first = if marker.moves() { "That is how it was at first. " } else { "" };
    format!(
        "<template class=\"picture\">{}<p class=\"faint\">{}{first}The names are those of the world, not of your map. \
         Doors are numbered clockwise from the first of each place.</p></template>\n",
        svg(&drawn),
        place.unwrap_or_default(),
    )
}

/// The dart behind the robot at the start of a game.
fn facing_of(world: &NamedWorld) -> Dart {
    world.start.unwrap_or(Dart(0))
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};
    use toposlam_model::{
        aid::markers::MOVABLE,
        embedded_graph::EmbeddedGraph,
        folding,
        marker::{Directional, Undirected},
    };

    use super::*;
    use crate::page::template::checks::{NASTY, assert_escaped, data_of};

    /// An edge with a loop at its end; the start is the other end.
    fn world(name: &str) -> NamedWorld {
        let lists = [("a", vec!["e"]), ("b", vec!["e", "l", "l"])];
        let graph = EmbeddedGraph::from_edge_lists(&lists).unwrap();
        NamedWorld::numbered(name, "", graph, Some(Dart(0)))
    }

    fn names(walks: &Value) -> Vec<&str> {
        walks.as_array().unwrap().iter().map(|walk| walk["name"].as_str().unwrap()).collect()
    }

    #[test]
    fn the_data_is_the_world_and_the_walks_to_compare_with() {
        let world = world("loop");
        let game =
            &data_of(&play_page(std::slice::from_ref(&world), Directional.into()))["games"][0];
        assert_eq!(game["world"], json!([[[1, 0]], [[0, 0], [1, 2], [1, 1]]]));
        assert_eq!(game["start"], json!([0, 0]));
        let walks = &game["walks"];
        assert_eq!(names(walks), ["Certificate", "Folding explorer", "Algorithm 1"]);
        // Over the edge, around the loop, and back: the marker is seen again.
        let certificate = folding::certificate(&world.graph, Dart(0));
        assert_eq!(walks[0]["actions"].as_array().unwrap().len(), certificate.len());
        assert_eq!(walks[0]["actions"], json!(["0", "1", "1"]));
        for walk in walks.as_array().unwrap() {
            assert!(walk["actions"].as_array().unwrap().len() >= certificate.len(), "{walk}");
        }
        let games = [world.clone(), NamedWorld { start: Some(Dart(2)), ..world }];
        assert_eq!(
            data_of(&play_page(&games, Directional.into()))["games"][1]["start"],
            json!([1, 1])
        );
    }

    #[test]
    fn a_game_has_the_algorithms_of_its_marker() {
        let lists = [("a", vec!["b"]), ("b", vec!["a"])];
        let edge = EmbeddedGraph::from_neighbour_lists(&lists).unwrap();
        let games = [NamedWorld::numbered("edge", "", edge, Some(Dart(0))), world("loop")];
        let data = data_of(&play_page(&games, MOVABLE.into()));
        assert_eq!(names(&data["games"][0]["walks"]), ["Place and back-link validation"]);
        assert_eq!(data["games"][0]["walks"][0]["actions"][0], "pick-up");
        // Its marker does not suffice in a world with a loop.
        assert_eq!(data["games"][1]["walks"], json!([]));
        let data = data_of(&play_page(&games, Undirected.into()));
        assert_eq!(
            (&data["marker"], &data["games"][0]["walks"]),
            (&json!("undirected"), &json!([]))
        );
    }

    #[test]
    fn names_are_escaped_everywhere() {
        let document = play_page(&[world(NASTY)], Directional.into());
        assert_escaped(&document);
        assert_eq!(document, play_page(&[world(NASTY)], Directional.into()));
    }
}
