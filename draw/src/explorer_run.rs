//! A run of an explorer, step by step: what it did, where the robot was, and what it perceived. Beside it stands the
//! map that the explorer returned, or another world with the same run. Section 2.1.

use std::io::{self, Write};

use toposlam_model::{
    aid::Action,
    aid::AidKind,
    embedded_graph::{Dart, EmbeddedGraph},
    format::named_world::NamedWorld,
    isomorphism::code,
    percept::Percept,
    world::GraphWorld,
};

use crate::{
    moment::grouped,
    picture::{WorldPicture, side_by_side, svg},
    text::{print_hanging, print_paragraph},
};

/// A run of an explorer from the start of a world.
#[derive(Clone, Copy)]
pub struct ExplorerRun<'a> {
    pub world: &'a NamedWorld,
    pub marker: AidKind,
    pub actions: &'a [Action],
    /// What the robot perceived, before the first action and after each, if that is not what the marker gives.
    pub percepts: Option<&'a [String]>,
    /// What is shown beside the world, with the start that is that of the run.
    pub beside: Option<(Beside, &'a NamedWorld)>,
}

/// What is shown beside the world of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beside {
    ReturnedMap,
    /// Another world in which the robot perceives the same, and whether it is the smallest.
    OtherWorld {
        is_smallest: bool,
    },
}

/// The head of the column of poses.
const CAME_IN: &str = "came in by";
/// The rows that are printed at each end of a long run.
const ROWS: usize = 20;

impl Beside {
    /// What it is, in a few words.
    pub(crate) fn title(self) -> &'static str {
        match self {
            Self::ReturnedMap => "The map that it returned",
            Self::OtherWorld { is_smallest: true } => "The smallest other world with this run",
            Self::OtherWorld { is_smallest: false } => "Another world with this run",
        }
    }

    /// The head of a column with its percepts.
    pub(crate) fn head(self) -> &'static str {
        match self {
            Self::ReturnedMap => "on its map",
            Self::OtherWorld { .. } => "in the other world",
        }
    }
}

impl<'a> ExplorerRun<'a> {
    /// The robot before the first action and after each.
    pub(crate) fn robots(&self) -> Vec<GraphWorld<'a, AidKind>> {
        self.robots_in(self.world)
    }

    /// The same in the world beside, as far as the actions are possible there.
    pub(crate) fn robots_beside(&self) -> Vec<GraphWorld<'a, AidKind>> {
        self.beside.map_or_else(Vec::new, |(_, world)| self.robots_in(world))
    }

    /// What the robot perceived at a step.
    pub(crate) fn percept(&self, step: usize, robot: &GraphWorld<'_, AidKind>) -> String {
        let own = self.percepts.and_then(|percepts| percepts.get(step)).cloned();
        own.unwrap_or_else(|| robot.sensed().to_string())
    }

    fn robots_in(&self, world: &'a NamedWorld) -> Vec<GraphWorld<'a, AidKind>> {
        let mut robot = GraphWorld::with_aid(&world.graph, self.marker, facing(world));
        let mut robots = vec![robot.clone()];
        for &action in self.actions {
            if robot.act(action).is_err() {
                break;
            }
            robots.push(robot.clone());
        }
        robots
    }

    /// The first step at which the percept in the world beside is another one, and that percept; `None` for it if
    /// the action is not possible there.
    pub(crate) fn difference(&self) -> Option<(usize, Option<Percept>)> {
        self.beside?;
        let (robots, beside) = (self.robots(), self.robots_beside());
        let sensed = |step: usize| beside.get(step).map(GraphWorld::sensed);
        let differs = |step: &usize| sensed(*step) != Some(robots[*step].sensed());
        (0..robots.len()).find(differs).map(|step| (step, sensed(step)))
    }

    /// Prints a row for each step, and the world beside.
    ///
    /// # Errors
    /// Returns the errors of the output.
    pub fn print(&self, out: &mut dyn Write) -> io::Result<()> {
        let robots = self.robots();
        let difference = self.difference();
        let places: Vec<_> = robots
            .iter()
            .map(|robot| self.world.state_text(&self.marker, &robot.state()))
            .collect();
        let width = places.iter().map(String::len).max().unwrap_or_default().max(CAME_IN.len());
        writeln!(out, "  {:>4}  {:7}  {:width$}  percept", "step", "action", CAME_IN)?;
        for (step, robot) in robots.iter().enumerate() {
            if robots.len() > 2 * ROWS && (ROWS..robots.len() - ROWS).contains(&step) {
                if step == ROWS {
                    let left_out = grouped((robots.len() - 2 * ROWS) as u128);
                    writeln!(out, "   ...  {left_out} steps are not printed")?;
                }
                continue;
            }
            let action = step.checked_sub(1).map(|before| self.actions[before].to_string());
            let action = action.unwrap_or_default();
            let (place, percept) = (&places[step], self.percept(step, robot));
            writeln!(out, "  {step:>4}  {action:7}  {place:width$}  {percept}")?;
        }
        let Some((beside, world)) = self.beside else { return Ok(()) };
        writeln!(out)?;
        print_list(out, beside.title(), world)?;
        let is_wrong = beside == Beside::ReturnedMap && !is_same_start(self.world, world);
        if is_wrong && self.percepts.is_none() {
            let text = match difference {
                None => "The map explains all percepts of the run: it is a wrong guess.".to_owned(),
                Some((step, Some(percept))) => {
                    format!(
                        "The percepts of the run contradict it: at step {step}, it has {percept}."
                    )
                }
                Some((step, None)) => format!(
                    "The run contradicts it: the action of step {step} is not possible in it."
                ),
            };
            print_paragraph(out, &text)?;
        }
        Ok(())
    }

    /// The world, and what stands beside it, as one picture in SVG.
    #[must_use]
    pub fn picture(&self) -> String {
        let drawn = |world: &NamedWorld, title: &str| {
            let marker = self.marker;
            let start = Some(facing(world));
            svg(&WorldPicture { start, marker, title, caption: "", ..WorldPicture::from(world) })
        };
        let beside = self.beside.map(|(beside, world)| drawn(world, beside.title()));
        let pictures: Vec<_> = [drawn(self.world, "The world")].into_iter().chain(beside).collect();
        side_by_side(&pictures)
    }
}

/// The facing dart of the start.
pub(crate) fn facing(world: &NamedWorld) -> Dart {
    world.start.unwrap_or(Dart(0))
}

fn is_same_start(one: &NamedWorld, other: &NamedWorld) -> bool {
    let code_of = |world: &NamedWorld| code(&world.graph, facing(world));
    one.graph.dart_count() == other.graph.dart_count() && code_of(one) == code_of(other)
}

/// Prints for each vertex where its doors lead, clockwise.
fn print_list(out: &mut dyn Write, title: &str, world: &NamedWorld) -> io::Result<()> {
    let graph: &EmbeddedGraph = &world.graph;
    print_paragraph(out, &format!("{title}. v0:1 is door 1 of v0:"))?;
    for vertex in graph.vertices() {
        let ends = graph.darts_of(vertex).map(|dart| {
            let far = graph.opposite(dart);
            format!("{}:{}", world.at_text(far), graph.index(far))
        });
        let ends: Vec<_> = ends.collect();
        print_hanging(out, &format!("  {}  ", world.vertex_names[vertex.at()]), &ends.join(" "))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use toposlam_model::{marker::Directional, percept::Door};

    use super::*;

    fn chain(name: &str, edges: usize) -> NamedWorld {
        NamedWorld::numbered(name, "", EmbeddedGraph::chain(edges), Some(Dart(0)))
    }

    /// The text of a run in a chain of two edges, to the middle and on.
    fn printed(doors: &[u32], beside: Option<(Beside, &NamedWorld)>) -> String {
        let world = chain("chain", 2);
        let actions: Vec<_> = doors.iter().map(|&door| Action::Take(Door(door))).collect();
        let marker = Directional.into();
        let run = ExplorerRun { world: &world, marker, actions: &actions, percepts: None, beside };
        let mut out = Vec::new();
        run.print(&mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn the_first_step_that_contradicts_the_map_is_named() {
        let map = chain("map", 1);
        let text = printed(&[0, 1], Some((Beside::ReturnedMap, &map)));
        assert!(text.contains("contradict it: at step 1, it has 1 door."), "{text}");
        // After the first step, only the end that was not seen differs.
        let map = chain("map", 3);
        let text = printed(&[0], Some((Beside::ReturnedMap, &map)));
        assert!(text.contains("it is a wrong guess"), "{text}");
        let text = printed(&[0, 1, 0], Some((Beside::ReturnedMap, &chain("map", 2))));
        assert!(!text.contains("contradict") && !text.contains("wrong guess"), "{text}");
    }

    #[test]
    fn of_a_long_run_the_beginning_and_the_end_are_printed() {
        let steps = |text: &str| text.lines().filter(|line| line.contains(" door")).count();
        let whole = printed(&[0; 39], None);
        assert!(!whole.contains("not printed"), "{whole}");
        assert_eq!(steps(&whole), 40);
        let long = printed(&[0; 59], None);
        assert!(long.contains("20 steps are not printed"), "{long}");
        assert_eq!(steps(&long), 40);
        assert!(long.contains("\n    59  0 "), "{long}");
    }
}
