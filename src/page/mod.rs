//! A page on which a reader walks two worlds at once: a robot in each, both sent through the same
//! doors, and what each of them perceives. Section 2.2, Figure 1.
//!
//! One self-contained HTML document that asks nothing of the network. It is told as plain data which
//! states there are and where they lead, and knows nothing of how they were found; what happens in
//! the browser is in `browser/`.

mod data;

use crate::{
    model::{
        embedded_graph::{Dart, Vertex},
        percept::Door,
    },
    picture::escaped,
};

/// What the page shows.
#[derive(Clone, Debug)]
pub struct WalkPage<'a> {
    /// The heading, such as "figure-1a and figure-1b, undirected marker".
    pub title: &'a str,
    /// A sentence or two beneath it; may be empty.
    pub about: &'a str,
    /// The two worlds.
    pub sides: [Side<'a>; 2],
    /// The pairs of states that the two robots can reach together, the start first; none where the
    /// worlds can be told apart.
    pub relation: Option<&'a [[usize; 2]]>,
    /// A shortest walk at whose end the percepts differ; empty if they do at the start already, none
    /// where no walk tells the worlds apart.
    pub walk: Option<&'a [Action]>,
}

/// One of the two worlds.
#[derive(Clone, Debug)]
pub struct Side<'a> {
    /// What it is called.
    pub name: &'a str,
    /// The SVG document that [`crate::picture::svg`] gives. Draw it without a start where the page
    /// is to draw the marker: see [`State::marks`].
    pub picture: &'a str,
    /// Every state that the robot can be in.
    pub states: Vec<State>,
    /// The state in which it starts, an index of `states`.
    pub start: usize,
}

/// A state of a robot and its world.
#[derive(Clone, Debug)]
pub struct State {
    /// How it is called, such as "a:1".
    pub text: String,
    /// The dart by which the robot has come in.
    pub dart: Dart,
    /// The vertex at which it is.
    pub vertex: Vertex,
    /// What it perceives, such as "4 doors, marker". Equal texts are equal percepts.
    pub percept: String,
    /// What it can do, and the state that this leads to, an index of the side's states.
    pub actions: Vec<(Action, usize)>,
    /// The markers, where they lie now. Empty if there are none or the picture shows them.
    pub marks: Vec<Mark>,
}

/// What a robot can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Leave by a door.
    Door(Door),
    /// Pick up the movable marker.
    PickUp,
    /// Drop it here.
    Drop,
}

/// Where a marker is, as the page draws it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// At a vertex.
    At(Vertex),
    /// At a vertex, and not the same kind of marker as the first.
    OtherAt(Vertex),
    /// At the vertex of this dart, and points along it.
    Along(Dart),
    /// On the edge of this dart, the same in both senses.
    On(Dart),
    /// On the edge of this dart, and points away from the dart's vertex.
    OnAwayFrom(Dart),
    /// The robot carries it.
    Carried,
}

const PAGE: &str = include_str!("browser/walk.html");
const STYLE: &str = include_str!("browser/walk.css");
/// In the order in which they build on each other; they share one scope.
const SCRIPT: [&str; 4] = [
    include_str!("browser/panel.js"),
    include_str!("browser/percepts.js"),
    include_str!("browser/relation.js"),
    include_str!("browser/walk.js"),
];

/// The page as an HTML document. The same data gives the same bytes.
#[must_use]
pub fn page(page: &WalkPage) -> String {
    let [a, b] = &page.sides;
    filled(PAGE, |place| match place {
        "title" => escaped(page.title),
        "about" => escaped(page.about),
        "style" => STYLE.to_owned(),
        "name of A" => escaped(a.name),
        "name of B" => escaped(b.name),
        "picture of A" => a.picture.to_owned(),
        "picture of B" => b.picture.to_owned(),
        "data" => data::json(page),
        "script" => SCRIPT.concat(),
        _ => String::new(),
    })
}

/// The template with each `{{place}}` filled. What is put in is not searched for places again.
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

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;

    /// A world of one edge whose two ends perceive the same.
    fn side<'a>(name: &'a str, picture: &'a str) -> Side<'a> {
        let state = |at: u32| State {
            text: format!("{name}{at}"),
            dart: Dart(at),
            vertex: Vertex(at),
            percept: "1 door".to_owned(),
            actions: vec![(Action::Door(Door(0)), 1 - at as usize)],
            marks: vec![Mark::At(Vertex(0))],
        };
        Side { name, picture, states: vec![state(0), state(1)], start: 0 }
    }

    fn data_of(document: &str) -> Value {
        let (_, from) =
            document.split_once("<script type=\"application/json\" id=\"data\">").unwrap();
        serde_json::from_str(from.split_once("</script>").unwrap().0).unwrap()
    }

    #[test]
    fn names_are_text_wherever_they_stand() {
        let nasty = "</script><!--<i>&\"{{data}}";
        let document = page(&WalkPage {
            title: nasty,
            about: nasty,
            sides: [side(nasty, "<svg/>"), side("plain", "<svg/>")],
            relation: Some(&[[0, 0], [1, 1]]),
            walk: None,
        });
        assert!(!document.contains("<i>"));
        assert!(!document.contains("</script><"));
        assert_eq!(document.matches("</script>").count(), 2);
        assert_eq!(document.matches("<!--").count(), 1, "the template's own");
        // What is put in is not searched for places.
        assert!(document.contains("{{data}}"));
        assert_eq!(data_of(&document)["sides"][0]["name"], nasty);
    }

    #[test]
    fn every_place_of_the_template_is_filled() {
        let places = std::cell::RefCell::new(Vec::new());
        filled(PAGE, |place| {
            places.borrow_mut().push(place.to_owned());
            String::new()
        });
        let mut places = places.into_inner();
        places.sort_unstable();
        places.dedup();
        assert_eq!(
            places,
            [
                "about",
                "data",
                "name of A",
                "name of B",
                "picture of A",
                "picture of B",
                "script",
                "style",
                "title"
            ]
        );
    }

    #[test]
    fn the_data_tells_all_that_the_page_was_told() {
        let walk = [Action::Door(Door(12)), Action::PickUp, Action::Drop];
        let document = page(&WalkPage {
            title: "t",
            about: "",
            sides: [side("a", "<svg/>"), side("b", "<svg/>")],
            relation: None,
            walk: Some(&walk),
        });
        let data = data_of(&document);
        assert_eq!(data["relation"], Value::Null);
        assert_eq!(data["walk"], serde_json::json!(["12", "pick up", "drop"]));
        assert_eq!(
            data["sides"][1]["states"][1],
            serde_json::json!({
                "text": "b1",
                "dart": 1,
                "vertex": 1,
                "percept": "1 door",
                "actions": [["0", 0]],
                "marks": [["at", 0]],
            })
        );
    }
}
