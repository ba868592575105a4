//! The page of a run of an explorer: its steps, the world with the robot in it, and beside it the map that the explorer
//! returned, or another world with the same run.

use serde_json::json;

use super::{
    GRAPH_SCRIPT, MARKER_SCRIPT, PAGE_SCRIPT, PAGE_STYLE,
    template::{filled, in_script},
    walk::{WALK_STATE_SCRIPT, picture, side_json},
};
use crate::{
    explorer_run::{ExplorerRun, facing},
    picture::escaped,
};

const PAGE: &str = include_str!("../browser/explorer.html");
const BESIDE: &str = include_str!("../browser/explorer_beside.html");
/// In the order of their dependencies; they share one scope.
const SCRIPT: [&str; 6] = [
    PAGE_SCRIPT,
    GRAPH_SCRIPT,
    MARKER_SCRIPT,
    WALK_STATE_SCRIPT,
    include_str!("../browser/panel.js"),
    include_str!("../browser/explorer.js"),
];

/// The page as an HTML document: how the run ended, in a sentence, and the run. The same run gives the same bytes.
pub fn explorer_page(ending: &str, run: &ExplorerRun) -> String {
    let steps = run.robots().into_iter().enumerate().map(|(step, robot)| {
        let action = step.checked_sub(1).map(|before| run.actions[before].to_string());
        json!({ "action": action, "percept": run.percept(step, &robot) })
    });
    let worlds = [Some(run.world), run.beside.map(|(_, world)| world)].into_iter().flatten();
    let data = json!({
        "marker": run.marker.name(),
        "sides": worlds.map(|world| side_json(world, facing(world))).collect::<Vec<_>>(),
        "steps": steps.collect::<Vec<_>>(),
    });
    let beside = run.beside.map(|(kind, world)| {
        let panel = filled(BESIDE, &[("title", kind.title()), ("picture", &picture(world))]);
        (panel, format!("<th scope=\"col\">{}</th>", kind.head()))
    });
    let (panel, column) = beside.unwrap_or_default();
    filled(
        PAGE,
        &[
            ("ending", &escaped(ending)),
            ("style", PAGE_STYLE),
            ("picture", &picture(run.world)),
            ("beside", &panel),
            ("column", &column),
            ("data", &in_script(&data)),
            ("script", &SCRIPT.concat()),
        ],
    )
}

#[cfg(test)]
mod tests {
    use toposlam_model::{
        aid::Action,
        embedded_graph::{Dart, EmbeddedGraph},
        format::named_world::NamedWorld,
        marker::Directional,
        percept::Door,
    };

    use super::*;
    use crate::{
        explorer_run::Beside,
        page::template::checks::{NASTY, assert_escaped, data_of},
    };

    /// A run through a chain of two edges, beside a map with one: the percepts differ at the first step, and the
    /// second one is not possible in the map.
    #[test]
    fn the_data_has_the_steps_and_names_are_escaped() {
        let chain = |name: &str, edges| {
            NamedWorld::numbered(name, "", EmbeddedGraph::chain(edges), Some(Dart(0)))
        };
        let (world, map) = (chain(NASTY, 2), chain("map", 1));
        let actions = [Action::Take(Door(0)), Action::Take(Door(1))];
        let run = ExplorerRun {
            world: &world,
            marker: Directional.into(),
            actions: &actions,
            percepts: None,
            beside: Some((Beside::ReturnedMap, &map)),
        };
        assert_eq!(run.difference().map(|(step, _)| step), Some(1));
        let document = explorer_page(NASTY, &run);
        assert_escaped(&document);
        let data = data_of(&document);
        assert_eq!(data["steps"][2], json!({ "action": "1", "percept": "1 door" }));
        assert_eq!(data["sides"][1]["world"], json!([[[1, 0]], [[0, 0]]]));
    }
}
