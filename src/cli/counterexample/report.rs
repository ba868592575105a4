//! What a search prints: a table and the smallest pair, or JSON.

use std::io::Write;

use serde_json::{Value, json};
use toposlam_model::{
    ambiguity::{Findings, SizeFindings},
    enumerate::Class,
    format::{named_world::NamedWorld, world_file},
    marker::Marker,
};

use super::pairs::WorldPairs;
use crate::cli::{Failure, text::grouped};

/// Prints as it goes.
pub(super) struct SearchReport<'o> {
    out: &'o mut dyn Write,
    json: bool,
    class: Class,
    edges: usize,
    /// How many markers there will be; the only one is told at length.
    markers: usize,
    header: bool,
    /// What is told after the table.
    pairs: Vec<WorldPairs>,
}

impl<'o> SearchReport<'o> {
    pub(super) fn new(
        out: &'o mut dyn Write,
        json: bool,
        class: Class,
        edges: usize,
        markers: usize,
    ) -> Self {
        Self { out, json, class, edges, markers, header: false, pairs: Vec::new() }
    }

    /// What was found for one marker.
    pub(super) fn marker(
        &mut self,
        marker: &dyn Marker,
        findings: &Findings,
        found: &WorldPairs,
    ) -> Result<(), Failure> {
        if self.json {
            self.objects(marker, findings, found)?;
        } else if self.markers == 1 {
            self.at_length(marker, findings, found)?;
        } else {
            self.row(marker, findings, found)?;
        }
        self.out.flush()?;
        Ok(())
    }

    fn objects(
        &mut self,
        marker: &dyn Marker,
        findings: &Findings,
        found: &WorldPairs,
    ) -> Result<(), Failure> {
        for &SizeFindings { edges, placed_worlds, ambiguous } in &findings.sizes {
            let line = json!({
                "schema": 1,
                "edges": edges,
                "class": self.class.name(),
                "marker": marker.name(),
                "placed_worlds": placed_worlds,
                "ambiguous": ambiguous,
            });
            writeln!(self.out, "{line}")?;
        }
        let pair = |pair: &[&NamedWorld; 2]| json!({ "edges": pair[1].graph.edge_count(), "worlds": pair.map(world_file::to_json) });
        let pairs = found.pairs();
        let line = json!({
            "schema": 1,
            "smallest": pairs.first().map_or(Value::Null, pair),
            "searched_edges": self.edges,
            "class": self.class.name(),
            "marker": marker.name(),
        });
        writeln!(self.out, "{line}")?;
        if found.has_all() {
            for world in found.worlds() {
                let world = world_file::to_json(world);
                let line = json!({ "schema": 1, "world": world, "marker": marker.name() });
                writeln!(self.out, "{line}")?;
            }
            for each in &pairs {
                let line = json!({
                    "schema": 1,
                    "pair": {
                        "edges": each[1].graph.edge_count(),
                        "worlds": each.map(|world| &world.name),
                    },
                    "marker": marker.name(),
                });
                writeln!(self.out, "{line}")?;
            }
        }
        Ok(())
    }

    /// A row of a table of markers.
    fn row(
        &mut self,
        marker: &dyn Marker,
        findings: &Findings,
        found: &WorldPairs,
    ) -> Result<(), Failure> {
        if !std::mem::replace(&mut self.header, true) {
            let (class, edges) = (self.class, self.edges);
            writeln!(self.out, "class {class}, 1 to {edges} edges\n")?;
            writeln!(
                self.out,
                "{:<15}  {:>13}  {:>9}  smallest pair that no walk tells apart",
                "marker", "placed worlds", "ambiguous"
            )?;
        }
        let sum = |count: fn(&SizeFindings) -> u64| {
            grouped(findings.sizes.iter().map(|size| u128::from(count(size))).sum())
        };
        writeln!(
            self.out,
            "{:<15}  {:>13}  {:>9}  {}",
            marker.name(),
            sum(|size| size.placed_worlds),
            sum(|size| size.ambiguous),
            self.sizes_of_smallest(found),
        )?;
        if found.has_all() && !found.pairs().is_empty() {
            self.pairs.push(found.clone());
        }
        Ok(())
    }

    fn sizes_of_smallest(&self, found: &WorldPairs) -> String {
        match found.pairs().first() {
            Some([one, other]) => sizes(one, other),
            None => format!("none up to {} edges", self.edges),
        }
    }

    /// Everything about one marker.
    fn at_length(
        &mut self,
        marker: &dyn Marker,
        findings: &Findings,
        found: &WorldPairs,
    ) -> Result<(), Failure> {
        writeln!(self.out, "{} marker: {}", marker.name(), marker.about())?;
        writeln!(self.out, "class {}, 1 to {} edges\n", self.class, self.edges)?;
        writeln!(self.out, "{:>5}  {:>13}  {:>9}", "edges", "placed worlds", "ambiguous")?;
        for &SizeFindings { edges, placed_worlds, ambiguous } in &findings.sizes {
            writeln!(
                self.out,
                "{edges:>5}  {:>13}  {:>9}",
                grouped(placed_worlds.into()),
                grouped(ambiguous.into())
            )?;
        }
        let Some([one, other]) = found.pairs().first().copied() else {
            writeln!(self.out, "\nno pair up to {} edges: a walk tells any two apart", self.edges)?;
            return Ok(());
        };
        writeln!(
            self.out,
            "\nthe smallest pair that no walk tells apart: {}; what is behind each vertex's \
             doors, clockwise:\n",
            sizes(one, other)
        )?;
        self.tell_world(one)?;
        self.tell_world(other)?;
        writeln!(
            self.out,
            "\nto walk them: toposlam counterexample --marker {} --class {} --edges {} --html walk.html",
            marker.name(),
            self.class,
            self.edges
        )?;
        if found.has_all() {
            self.tell_pairs(found)?;
        }
        Ok(())
    }

    /// All pairs by name, and the worlds in them.
    fn tell_pairs(&mut self, found: &WorldPairs) -> Result<(), Failure> {
        let pairs = found.pairs();
        let count = grouped(pairs.len() as u128);
        writeln!(self.out, "\nall pairs: {count}\n")?;
        for [one, other] in &pairs {
            writeln!(self.out, "  {} ~ {}: {}", one.name, other.name, sizes(one, other))?;
        }
        writeln!(self.out, "\nthe worlds in them:\n")?;
        for world in found.worlds() {
            self.tell_world(world)?;
        }
        Ok(())
    }

    /// A world in a line or two: its start and its orders.
    fn tell_world(&mut self, world: &NamedWorld) -> Result<(), Failure> {
        let start = world.start.map(|dart| world.start_text(dart)).unwrap_or_default();
        writeln!(self.out, "  {}, start {start}", world.name)?;
        for vertex in world.graph.vertices() {
            let listed: Vec<_> =
                world.graph.darts_of(vertex).map(|dart| world.leads_to(dart)).collect();
            writeln!(self.out, "    {}: {}", world.vertex_names[vertex.at()], listed.join(" "))?;
        }
        Ok(())
    }

    /// After the table, the pairs of all its rows.
    pub(super) fn end(&mut self) -> Result<(), Failure> {
        for found in std::mem::take(&mut self.pairs) {
            self.tell_pairs(&found)?;
        }
        Ok(())
    }
}

fn sizes(one: &NamedWorld, other: &NamedWorld) -> String {
    format!("{} and {} edges", one.graph.edge_count(), other.graph.edge_count())
}
