//! The report of a run of an explorer: JSON, text, a picture or a page.

use std::{io::Write, path::Path};

use serde::{Deserialize, Serialize};
use serde_json::Value;
use toposlam_model::{
    aid::Action,
    aid::AidKind,
    check::other_world,
    embedded_graph::{Dart, EmbeddedGraph},
    folding::SmallestWorld,
    format::{named_world::NamedWorld, world_file},
};

use super::run::{EndedRun, doors_of};
use crate::{
    cli::{
        CliError, output,
        progress::StopSignal,
        text::{capital, counted, print_indented},
        walk_page, write_drawing,
    },
    explorer_run::{Beside, ExplorerRun},
    page::explorer_page,
};

/// A run, as it is reported.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::cli) struct ReportedRun {
    /// What is wrong, in a sentence without its end; `None` if the map and the pose are right.
    pub(in crate::cli) message: Option<String>,
    actions: Vec<Action>,
    /// The map that the explorer returned, if it is an embedded graph.
    map: Option<Value>,
    /// Another world with the same run, if it is a guess.
    other_world: Option<OtherWorld>,
    /// The end of the standard error, if the process was ended.
    stderr: String,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct OtherWorld {
    world: Value,
    is_smallest: bool,
}

impl ReportedRun {
    /// The report of a run that has ended. `stderr` is the end of the standard error of a process that was ended.
    pub(in crate::cli) fn new(run: EndedRun, stderr: String) -> Self {
        let EndedRun { actions, map, result, .. } = run;
        let map = map.map(|map| {
            let (graph, about) = (map.graph.into_owned(), "The map that an explorer returned");
            world_file::to_json(&NamedWorld::numbered("map", about, graph, Some(map.facing)))
        });
        let message = result.err().map(|fault| capital(&format!("the explorer {fault}")));
        Self { message, actions, map, other_world: None, stderr }
    }

    /// What is wrong, as a clause without its subject, the explorer, and without the number of moves, which stand
    /// before it.
    pub(in crate::cli) fn clause(&self, moves: u64) -> Option<&str> {
        let message = self.message.as_deref()?;
        let it = message.strip_prefix("The explorer ").unwrap_or(message);
        Some(it.strip_suffix(&format!(" after {}", counted(moves as usize, "move"))).unwrap_or(it))
    }

    /// Searches for the smallest other world with the same run. There is one if the run is a guess.
    pub(in crate::cli) fn find_other_world(
        &mut self,
        start: (&EmbeddedGraph, Dart),
        marker: AidKind,
    ) {
        let found = other_world(start, marker, &doors_of(&self.actions), &StopSignal);
        if let Some(SmallestWorld::World { graph, limit, .. }) = found {
            let about = "A robot that takes the same doors in it perceives the same";
            let world = NamedWorld::discovered("other", about, &graph, Dart(0));
            let is_smallest = limit.is_none();
            self.other_world = Some(OtherWorld { world: world_file::to_json(&world), is_smallest });
        }
    }

    /// What is shown beside the world.
    fn beside(&self) -> Option<(Beside, NamedWorld)> {
        let (kind, world) = match &self.other_world {
            Some(other) => (Beside::OtherWorld { is_smallest: other.is_smallest }, &other.world),
            None => (Beside::ReturnedMap, self.map.as_ref()?),
        };
        Some((kind, world_file::read(world.to_string().as_bytes()).ok()?))
    }

    /// The map that the explorer returned, if it is an embedded graph.
    pub(in crate::cli) fn map(&self) -> Option<NamedWorld> {
        world_file::read(self.map.as_ref()?.to_string().as_bytes()).ok()
    }

    /// Prints the run from the start of a world, step by step.
    pub(in crate::cli) fn print(
        &self,
        world: &NamedWorld,
        marker: AidKind,
        out: &mut dyn Write,
    ) -> Result<(), CliError> {
        let beside = self.beside();
        self.shown(world, marker, beside.as_ref()).print(out)?;
        if !self.stderr.is_empty() {
            writeln!(out, "\nThe end of its standard error:")?;
            for line in self.stderr.lines() {
                let plain = line.replace(char::is_control, " ");
                print_indented(out, "    ", 4, plain.trim_end())?;
            }
        }
        Ok(())
    }

    /// Writes the run from the start of a world: a picture (.svg, .png), or a page.
    pub(in crate::cli) fn write(
        &self,
        path: &Path,
        world: &NamedWorld,
        marker: AidKind,
    ) -> Result<(), CliError> {
        let beside = self.beside();
        let run = self.shown(world, marker, beside.as_ref());
        if path.extension().is_some_and(|ending| ending == "svg" || ending == "png") {
            return write_drawing(path, &run.picture());
        }
        for world in [Some(world), beside.as_ref().map(|(_, world)| world)].into_iter().flatten() {
            walk_page::check_world(path, world, marker)?;
        }
        let ending = self.message.as_deref().unwrap_or("The map and the pose are right");
        let end = if ending.ends_with('?') { "" } else { "." };
        let page = explorer_page(&format!("{ending}{end}"), &run);
        output::write_whole(path, page.as_bytes())
    }

    fn shown<'a>(
        &'a self,
        world: &'a NamedWorld,
        marker: AidKind,
        beside: Option<&'a (Beside, NamedWorld)>,
    ) -> ExplorerRun<'a> {
        let beside = beside.map(|(kind, world)| (*kind, world));
        ExplorerRun { world, marker, actions: &self.actions, percepts: None, beside }
    }
}
