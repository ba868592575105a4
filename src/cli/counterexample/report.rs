//! The report of a search: a table and the smallest pair, or JSON.

use std::io::Write;

use serde_json::{Value, json};
use toposlam_model::{
    ambiguity::{Findings, SizeFindings},
    enumerate::Class,
    format::{named_world::NamedWorld, world_file},
    marker::Marker,
};

use super::{
    atlas::{none, proved},
    pairs::WorldPairs,
    up_to,
};
use crate::cli::{
    CliError,
    cluster::ClusterSession,
    json::print_line,
    text::{counted, grouped, print_command, print_hanging, print_indented, print_paragraph},
};

/// Prints the result of each marker when it is there.
pub(super) struct SearchReport<'o> {
    out: &'o mut dyn Write,
    json: bool,
    class: Class,
    edges: usize,
    /// The number of markers. If there is one, the report on it is longer.
    markers: usize,
    header: bool,
    /// Printed after the table.
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

    /// Prints the result for one marker.
    pub(super) fn marker(
        &mut self,
        marker: &dyn Marker,
        findings: &Findings,
        found: &WorldPairs,
    ) -> Result<(), CliError> {
        if self.json {
            self.objects(marker, findings, found)?;
        } else if self.markers == 1 {
            self.full_report(marker, findings, found)?;
        } else {
            self.row(marker, findings, found)?;
        }
        self.out.flush()?;
        Ok(())
    }

    /// Reports how busy the threads of a cluster were.
    pub(super) fn threads(
        &mut self,
        cluster: &mut ClusterSession,
        marker: &dyn Marker,
    ) -> Result<(), CliError> {
        cluster.report(self.out, self.json, marker.name())
    }

    fn objects(
        &mut self,
        marker: &dyn Marker,
        findings: &Findings,
        found: &WorldPairs,
    ) -> Result<(), CliError> {
        for &SizeFindings { edges, placed_worlds, ambiguous } in &findings.sizes {
            let line = json!({
                "edges": edges,
                "class": self.class.name(),
                "marker": marker.name(),
                "placed_worlds": placed_worlds,
                "ambiguous": ambiguous,
            });
            print_line(self.out, "size", &line)?;
        }
        let pair = |pair: &[&NamedWorld; 2]| {
            let edges = pair[1].graph.edge_count();
            json!({ "edges": edges, "worlds": pair.map(world_file::to_json) })
        };
        let pairs = found.pairs();
        let line = json!({
            "smallest": pairs.first().map_or(Value::Null, pair),
            "searched_edges": self.edges,
            "class": self.class.name(),
            "marker": marker.name(),
        });
        print_line(self.out, "smallest", &line)?;
        if found.has_all() {
            for world in found.worlds() {
                let world = world_file::to_json(world);
                let line = json!({ "world": world, "marker": marker.name() });
                print_line(self.out, "world", &line)?;
            }
            for each in &pairs {
                let line = json!({
                        "pair": {
                        "edges": each[1].graph.edge_count(),
                        "worlds": each.map(|world| &world.name),
                    },
                    "marker": marker.name(),
                });
                print_line(self.out, "pair", &line)?;
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
    ) -> Result<(), CliError> {
        if !std::mem::replace(&mut self.header, true) {
            let (class, edges) = (self.class, up_to(self.edges));
            let head =
                format!("Pairs of worlds that no walk distinguishes: class {class}, {edges}");
            print_paragraph(self.out, &head)?;
            writeln!(self.out)?;
            writeln!(
                self.out,
                "{:<15}  {:>13}  {:>9}  smallest pair",
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
            self.sizes_of_smallest(marker, found),
        )?;
        if found.has_all() && !found.pairs().is_empty() {
            self.pairs.push(found.clone());
        }
        Ok(())
    }

    fn sizes_of_smallest(&self, marker: &dyn Marker, found: &WorldPairs) -> String {
        match found.pairs().first() {
            Some([one, other]) => sizes(one, other),
            None => none(marker, self.class, self.edges),
        }
    }

    /// The longer report on one marker.
    fn full_report(
        &mut self,
        marker: &dyn Marker,
        findings: &Findings,
        found: &WorldPairs,
    ) -> Result<(), CliError> {
        print_paragraph(self.out, &format!("{} marker: {}", marker.name(), marker.about()))?;
        writeln!(self.out, "class {}, {}\n", self.class, up_to(self.edges))?;
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
            writeln!(self.out)?;
            let none = format!(
                "no pair up to {}: a walk distinguishes any two",
                counted(self.edges, "edge")
            );
            print_paragraph(self.out, &none)?;
            if let Some(theorem) = proved(marker, self.class, true) {
                let any = format!("none in any world of the class: `{theorem}`, proved in Coq");
                print_paragraph(self.out, &any)?;
            }
            return Ok(());
        };
        writeln!(self.out)?;
        let smallest = format!(
            "The smallest pair that no walk distinguishes: {}. For each vertex, the list shows where \
             its doors lead, clockwise.",
            sizes(one, other)
        );
        print_paragraph(self.out, &smallest)?;
        writeln!(self.out)?;
        self.print_world(one)?;
        self.print_world(other)?;
        let command = format!(
            "toposlam counterexample --marker {} --class {} --max-edges {} --html walk.html",
            marker.name(),
            self.class,
            self.edges
        );
        writeln!(self.out, "\nTo walk them in a browser:")?;
        print_command(self.out, "  ", &command)?;
        if found.has_all() {
            self.print_pairs(found)?;
        }
        Ok(())
    }

    /// All pairs by name, and the worlds in them.
    fn print_pairs(&mut self, found: &WorldPairs) -> Result<(), CliError> {
        let pairs = found.pairs();
        let count = grouped(pairs.len() as u128);
        writeln!(self.out, "\nAll pairs: {count}\n")?;
        for [one, other] in &pairs {
            let pair = format!("{} ~ {}: {}", one.name, other.name, sizes(one, other));
            print_indented(self.out, "  ", 4, &pair)?;
        }
        writeln!(self.out, "\nTheir worlds:\n")?;
        for world in found.worlds() {
            self.print_world(world)?;
        }
        Ok(())
    }

    /// The start of a world, and the clockwise order at each of its vertices.
    fn print_world(&mut self, world: &NamedWorld) -> Result<(), CliError> {
        let start = world.start.map(|dart| world.start_text(dart)).unwrap_or_default();
        writeln!(self.out, "  {}, start {start}", world.name)?;
        for vertex in world.graph.vertices() {
            let doors: Vec<_> =
                world.graph.darts_of(vertex).map(|dart| world.leads_to(dart)).collect();
            let name = &world.vertex_names[vertex.at()];
            print_hanging(self.out, &format!("    {name}: "), &doors.join(" "))?;
        }
        Ok(())
    }

    /// After the table, the pairs of all its rows.
    pub(super) fn end(&mut self) -> Result<(), CliError> {
        for found in std::mem::take(&mut self.pairs) {
            self.print_pairs(&found)?;
        }
        Ok(())
    }
}

fn sizes(one: &NamedWorld, other: &NamedWorld) -> String {
    format!("{} and {} edges", one.graph.edge_count(), other.graph.edge_count())
}
