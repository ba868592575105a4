//! The walk page in a browser. Section 2.2, Figure 1: a random walk in its two worlds shows the same
//! percepts in both as long as the marker does not point; with a directional marker a walk tells
//! them apart.
//!
//! Needs Node, a Chromium and playwright-core; without them the test says so and is skipped, unless
//! `TOPOSLAM_BROWSER=required`.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::{
    collections::HashMap,
    env, fs,
    path::{Path, PathBuf},
    process::Command,
};

use toposlam::{
    model::{
        embedded_graph::{Dart, EmbeddedGraph, Vertex},
        format::{named_world::NamedWorld, world_file},
        percept::Door,
    },
    page::{Action, Mark, Side, State, WalkPage, page},
    picture::{Picture, svg},
};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// A marker, where it is at the start: at the vertex of the start, along its facing dart.
#[derive(Clone, Copy, PartialEq)]
enum Marker {
    Undirected,
    Directional,
    Movable,
}

/// The robot's pose, and where the marker lies unless the robot carries it.
type Place = (Dart, Option<Vertex>);

fn world(name: &str) -> NamedWorld {
    let text = fs::read_to_string(Path::new(ROOT).join(format!("worlds/{name}.toml"))).unwrap();
    world_file::read(text.as_bytes()).unwrap()
}

/// All that can be done in a place, and the place after it.
fn actions(graph: &EmbeddedGraph, marker: Marker, (dart, lies): Place) -> Vec<(Action, Place)> {
    let here = graph.vertex(dart);
    let doors = (0..graph.degree(here)).map(Door);
    let mut actions: Vec<_> =
        doors.map(|door| (Action::Door(door), (graph.after(dart, door), lies))).collect();
    if marker == Marker::Movable && lies.is_none() {
        actions.push((Action::Drop, (dart, Some(here))));
    } else if marker == Marker::Movable && lies == Some(here) {
        actions.push((Action::PickUp, (dart, None)));
    }
    actions
}

/// The world as the page is told it, every place that can be reached.
fn side<'a>(world: &'a NamedWorld, picture: &'a str, marker: Marker) -> Side<'a> {
    let graph = &world.graph;
    let facing = world.start.unwrap();
    let start = (facing, Some(graph.vertex(facing)));
    let mut places = vec![start];
    let mut known = HashMap::from([(start, 0)]);
    let mut states = Vec::new();
    while let Some(&(dart, lies)) = places.get(states.len()) {
        let vertex = graph.vertex(dart);
        let lies_here = lies == Some(vertex);
        let (degree, index) = (graph.degree(vertex), graph.index(dart));
        let sighting = match marker {
            Marker::Directional if lies_here => {
                let door = Door::between(index, graph.index(facing), degree);
                format!(", marker along door {}", door.0)
            }
            _ if lies_here => ", marker".to_owned(),
            _ if lies.is_none() => ", marker in hand".to_owned(),
            _ => String::new(),
        };
        let actions = actions(graph, marker, (dart, lies)).into_iter().map(|(action, place)| {
            let at = *known.entry(place).or_insert_with(|| {
                places.push(place);
                places.len() - 1
            });
            (action, at)
        });
        let mark = match (marker, lies) {
            (Marker::Directional, _) => Mark::Along(facing),
            (_, Some(vertex)) => Mark::At(vertex),
            (_, None) => Mark::Carried,
        };
        states.push(State {
            text: format!("{}:{index}", world.vertex_names[vertex.at()]),
            dart,
            vertex,
            percept: format!("{degree} doors{sighting}"),
            actions: actions.collect(),
            marks: vec![mark],
        });
    }
    Side { name: &world.name, picture, states, start: 0 }
}

/// The pairs that can be reached together, breadth-first; or the shortest walk to different percepts.
fn compared(a: &Side, b: &Side) -> Result<Vec<[usize; 2]>, Vec<Action>> {
    let mut pairs = vec![([a.start, b.start], Vec::new())];
    let mut next = 0;
    while let Some(([one, other], walk)) = pairs.get(next).cloned() {
        if a.states[one].percept != b.states[other].percept {
            return Err(walk);
        }
        for (&(action, one), &(same, other)) in
            a.states[one].actions.iter().zip(&b.states[other].actions)
        {
            assert_eq!(action, same);
            if pairs.iter().all(|(known, _)| *known != [one, other]) {
                pairs.push(([one, other], [&walk[..], &[action]].concat()));
            }
        }
        next += 1;
    }
    Ok(pairs.into_iter().map(|(pair, _)| pair).collect())
}

/// Writes the page of Figure 1 with this marker; answers whether a walk tells its worlds apart.
fn write_page(marker: Marker, called: &str) -> (bool, PathBuf) {
    let worlds = ["figure-1a", "figure-1b"].map(world);
    let pictures = worlds
        .each_ref()
        .map(|world| svg(&Picture { start: None, title: "", caption: "", ..Picture::from(world) }));
    let [a, b] = [0, 1].map(|at| side(&worlds[at], &pictures[at], marker));
    let found = compared(&a, &b);
    for states in [&a.states, &b.states] {
        assert!(states.iter().flat_map(|state| &state.actions).all(|(_, to)| *to < states.len()));
    }
    let document = page(&WalkPage {
        title: &format!("figure-1a and figure-1b, {called} marker"),
        about: "Whatever door both robots take, what do they perceive?",
        sides: [a, b],
        relation: found.as_deref().ok(),
        walk: found.as_ref().err().map(Vec::as_slice),
    });
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("figure-1-{called}.html"));
    fs::write(&file, document).unwrap();
    (found.is_err(), file)
}

/// The first of these programs that there is.
fn program(names: &[&str]) -> Option<PathBuf> {
    let folders: Vec<_> = env::split_paths(&env::var_os("PATH")?).collect();
    let places = names.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name)));
    places.into_iter().find(|place| place.is_file())
}

/// Node and a Chromium; or what is missing and how to install it.
fn browser() -> Result<(PathBuf, PathBuf), String> {
    let node = program(&["node", "nodejs"])
        .ok_or("there is no node; on Debian: apt-get install nodejs npm")?;
    let chromium = program(&["chromium", "chromium-browser", "google-chrome"])
        .ok_or("there is no Chromium; on Debian: apt-get install chromium")?;
    let client = Path::new(ROOT).join("tests/browser/node_modules/playwright-core");
    if !client.is_dir() {
        return Err("there is no playwright-core; run: npm install --prefix tests/browser".into());
    }
    Ok((node, chromium))
}

#[test]
fn the_percepts_of_figure_1_stay_equal_until_the_marker_points() {
    let pages = [
        (Marker::Undirected, "undirected", false),
        (Marker::Directional, "directional", true),
        (Marker::Movable, "movable", true),
    ]
    .map(|(marker, called, told_apart)| {
        let (apart, file) = write_page(marker, called);
        assert_eq!(apart, told_apart, "{called}");
        format!("{}={}", if apart { "apart" } else { "alike" }, file.display())
    });
    let (node, chromium) = match browser() {
        Ok(found) => found,
        Err(missing) => {
            let required = env::var("TOPOSLAM_BROWSER").is_ok_and(|wish| wish == "required");
            assert!(!required, "{missing}");
            eprintln!("skipped, the walk page was not opened in a browser: {missing}");
            return;
        }
    };
    let output = Command::new(node)
        .arg(Path::new(ROOT).join("tests/browser/walk_page.mjs"))
        .arg(chromium)
        .args(pages)
        .output()
        .unwrap();
    let said = [output.stdout, output.stderr].concat();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&said));
}
