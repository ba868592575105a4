//! The page of a run of an explorer: its steps, the world with the robot in it, and beside it the map that the explorer
//! returned, or another world with the same run.

use serde_json::json;

use super::{
    PAGE_SCRIPT, PAGE_STYLE,
    template::{filled, in_script},
    walk::{WalkSide, side_json},
};
use crate::{explorer_run::ExplorerRun, picture::escaped};

const PAGE: &str = include_str!("../browser/explorer.html");
const BESIDE: &str = include_str!("../browser/explorer_beside.html");
/// In the order of their dependencies; they share one scope.
const SCRIPT: [&str; 3] =
    [PAGE_SCRIPT, include_str!("../browser/panel.js"), include_str!("../browser/explorer.js")];

/// The page as an HTML document: a title, how the run ended, in a sentence, and the run. The same run gives the same
/// bytes.
pub fn explorer_page(title: &str, ending: &str, run: &ExplorerRun) -> String {
    let robots = run.robots();
    let world = WalkSide::new(run.world, &robots[0]);
    let robots_beside = run.robots_beside();
    let beside = run.beside.map(|(kind, world)| (kind, WalkSide::new(world, &robots_beside[0])));
    let steps: Vec<_> = robots
        .iter()
        .enumerate()
        .map(|(step, robot)| {
            let action = step.checked_sub(1).map(|before| run.actions[before].to_string());
            let there = robots_beside.get(step).zip(beside.as_ref());
            let there = there.map(|(robot, (_, side))| side.place(robot.state()));
            json!({
                "action": action,
                "percept": run.percept(step, robot),
                "states": [world.place(robot.state()), there],
            })
        })
        .collect();
    let sides = [Some(&world), beside.as_ref().map(|(_, side)| side)];
    let data = json!({
        "sides": sides.into_iter().flatten().map(side_json).collect::<Vec<_>>(),
        "steps": steps,
    });
    let panel = beside.as_ref().map(|(kind, side)| {
        filled(
            BESIDE,
            &[
                ("title", kind.title()),
                ("marker", &escaped(&side.marker_place())),
                ("picture", &side.picture()),
            ],
        )
    });
    let column = beside.as_ref().map(|(kind, _)| {
        let head = kind.head();
        format!("<th scope=\"col\">{head}</th>")
    });
    filled(
        PAGE,
        &[
            ("title", &escaped(title)),
            ("ending", &escaped(ending)),
            ("style", PAGE_STYLE),
            ("name", &escaped(&run.world.name)),
            ("marker", &escaped(&world.marker_place())),
            ("picture", &world.picture()),
            ("beside", &panel.unwrap_or_default()),
            ("column", &column.unwrap_or_default()),
            ("data", &in_script(&data)),
            ("script", &SCRIPT.concat()),
        ],
    )
}
