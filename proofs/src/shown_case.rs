//! What a lemma shows of a case, as data for a report: worlds with names, walks with what the robot perceives, and
//! other values.

use serde::Serialize;
use toposlam_model::{
    aid::{RefusedAction, State},
    format::named_world::NamedWorld,
    percept::{Door, Percept},
    world::{GraphWorld, World},
};

use crate::{Exhibit, replay::ReplayedCase};

/// An exhibit of a case.
#[derive(Clone, Debug, PartialEq)]
pub enum ShownExhibit {
    World {
        /// What the report calls it.
        label: String,
        world: NamedWorld,
    },
    Walk {
        /// What the report calls its world.
        label: String,
        walk: ShownWalk,
    },
    Value(ShownValue),
}

/// A walk as far as the robot can go.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ShownWalk {
    /// The place of its world among those of the case, from 0.
    pub world: usize,
    pub marker: &'static str,
    pub doors: Vec<Door>,
    /// Where the robot is, at the start and after each door.
    pub poses: Vec<String>,
    /// What it perceives there.
    pub percepts: Vec<Percept>,
    /// Why it could not go on.
    pub stopped: Option<String>,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ShownValue {
    pub name: &'static str,
    pub value: String,
}

impl ReplayedCase {
    /// The exhibits, in their order. The worlds are described as a case of this lemma.
    pub fn shown(self, lemma: &str) -> Vec<ShownExhibit> {
        let is_world = |exhibit: &&Exhibit| matches!(exhibit, Exhibit::World { .. });
        let is_only_one = self.exhibits.iter().filter(is_world).count() == 1;
        let mut worlds: Vec<(String, NamedWorld)> = Vec::new();
        let mut shown = Vec::new();
        for exhibit in self.exhibits {
            shown.push(match exhibit {
                Exhibit::World { graph, facing } => {
                    let number = worlds.len() + 1;
                    let (name, label) = if is_only_one {
                        ("case".to_owned(), "the world".to_owned())
                    } else {
                        (format!("case-{number}"), format!("world {number}"))
                    };
                    let about = format!("A case of {lemma}");
                    let world = NamedWorld::numbered(&name, &about, graph, Some(facing));
                    worlds.push((label.clone(), world.clone()));
                    ShownExhibit::World { label, world }
                }
                Exhibit::Walk { world, marker, pose, doors } => {
                    // A lemma shows a world before the walks in it.
                    let Some((label, named)) = worlds.get(world) else { continue };
                    let facing = named.start.unwrap_or(pose);
                    let robot = GraphWorld::with_aid(&named.graph, marker, facing);
                    let start = State { pose, ..robot.state() };
                    let mut robot = robot.at(start);
                    let (mut poses, mut percepts) = (Vec::new(), Vec::new());
                    let mut arrive = |robot: &GraphWorld<_>| {
                        poses.push(named.state_text(&marker, &robot.state()));
                        percepts.push(robot.sensed());
                    };
                    arrive(&robot);
                    let walked = doors.iter().try_for_each(|door| {
                        robot.traverse(*door)?;
                        arrive(&robot);
                        Ok(())
                    });
                    let stopped = walked.err().map(|refused: RefusedAction| refused.to_string());
                    let marker = marker.name();
                    let walk = ShownWalk { world, marker, doors, poses, percepts, stopped };
                    ShownExhibit::Walk { label: label.clone(), walk }
                }
                Exhibit::Value { name, value } => ShownExhibit::Value(ShownValue { name, value }),
            });
        }
        shown
    }
}
