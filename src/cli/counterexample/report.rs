//! The report of a search: a table and the smallest pair, or JSON.

use std::io::{self, Write};

use serde_json::json;
use toposlam_model::{
    aid::AidKind,
    ambiguity::{Findings, SizeFindings},
    enumerate::Class,
    format::{named_world::NamedWorld, world_file},
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
    /// The number of marking aids. If there is one, the report on it is longer.
    aids: usize,
    /// The length of the longest of their names.
    width: usize,
    /// Whether a page shows the pair.
    has_page: bool,
    has_head: bool,
    /// Printed after the table.
    pairs: Vec<WorldPairs>,
}

impl<'o> SearchReport<'o> {
    pub(super) fn new(
        out: &'o mut dyn Write,
        json: bool,
        class: Class,
        edges: usize,
        aids: impl Iterator<Item = AidKind>,
        has_page: bool,
    ) -> Self {
        let lengths: Vec<usize> = aids.map(|aid| aid.name().len()).collect();
        let width = lengths.iter().copied().max().unwrap_or_default();
        let (aids, pairs) = (lengths.len(), Vec::new());
        Self { out, json, class, edges, aids, width, has_page, has_head: false, pairs }
    }

    /// Prints the result for one marker.
    pub(super) fn marker(
        &mut self,
        marker: AidKind,
        findings: &Findings,
        found: WorldPairs,
    ) -> Result<(), CliError> {
        if self.json {
            self.objects(marker.name(), findings, &found)?;
        } else if self.aids == 1 {
            self.full_report(marker, findings, &found)?;
        } else {
            self.row(marker, findings, &found)?;
            if found.all && !found.pairs().is_empty() {
                self.pairs.push(found);
            }
        }
        Ok(self.out.flush()?)
    }

    /// Reports how busy the threads of a cluster were.
    pub(super) fn threads(
        &mut self,
        cluster: &mut Box<dyn ClusterSession>,
        marker: AidKind,
    ) -> Result<(), CliError> {
        cluster.report(self.out, self.json, marker.name())
    }

    fn objects(
        &mut self,
        marker: &str,
        findings: &Findings,
        found: &WorldPairs,
    ) -> Result<(), CliError> {
        let (class, edges_of) =
            (self.class.name(), |[_, larger]: [&NamedWorld; 2]| larger.graph.edge_count());
        for &SizeFindings { edges, placed_worlds, ambiguous } in &findings.sizes {
            let line = json!({
                "edges": edges, "class": class, "marker": marker, "placed_worlds": placed_worlds,
                "ambiguous": ambiguous,
            });
            print_line(self.out, "size", &line)?;
        }
        let pairs = found.pairs();
        let smallest = pairs.first().map(
            |&pair| json!({ "edges": edges_of(pair), "worlds": pair.map(world_file::to_json) }),
        );
        let line = json!({
            "smallest": smallest, "searched_edges": self.edges, "class": class, "marker": marker,
        });
        print_line(self.out, "smallest", &line)?;
        if found.all {
            for world in &found.worlds {
                let line = json!({ "world": world_file::to_json(world), "marker": marker });
                print_line(self.out, "world", &line)?;
            }
            for pair in pairs {
                let names = pair.map(|world| &world.name);
                let pair = json!({ "edges": edges_of(pair), "worlds": names });
                print_line(self.out, "pair", &json!({ "pair": pair, "marker": marker }))?;
            }
        }
        Ok(())
    }

    /// A row of a table of markers.
    fn row(&mut self, marker: AidKind, findings: &Findings, found: &WorldPairs) -> io::Result<()> {
        let width = self.width;
        if !std::mem::replace(&mut self.has_head, true) {
            let (class, edges) = (self.class, up_to(self.edges));
            let head = "Pairs of worlds that no walk distinguishes";
            print_paragraph(self.out, &format!("{head}: class {class}, {edges}"))?;
            let (marker, placed, ambiguous) = ("marker", "placed worlds", "ambiguous");
            writeln!(self.out, "\n{marker:<width$}  {placed:>13}  {ambiguous:>9}  smallest pair")?;
        }
        let sum = |count: fn(&SizeFindings) -> u64| {
            grouped(findings.sizes.iter().map(|size| u128::from(count(size))).sum())
        };
        let (name, placed) = (marker.name(), sum(|size| size.placed_worlds));
        let ambiguous = sum(|size| size.ambiguous);
        let smallest = match found.pairs().first() {
            Some(&pair) => sizes(pair),
            None => none(marker, self.class, self.edges),
        };
        writeln!(self.out, "{name:<width$}  {placed:>13}  {ambiguous:>9}  {smallest}")
    }

    /// The longer report on one marker.
    fn full_report(
        &mut self,
        marker: AidKind,
        findings: &Findings,
        found: &WorldPairs,
    ) -> io::Result<()> {
        print_paragraph(self.out, &format!("{}: {}", marker.name(), marker.about()))?;
        writeln!(self.out, "class {}, {}\n", self.class, up_to(self.edges))?;
        writeln!(self.out, "{:>5}  {:>13}  {:>9}", "edges", "placed worlds", "ambiguous")?;
        for &SizeFindings { edges, placed_worlds, ambiguous } in &findings.sizes {
            let [placed, ambiguous] = [placed_worlds, ambiguous].map(|n| grouped(n.into()));
            writeln!(self.out, "{edges:>5}  {placed:>13}  {ambiguous:>9}")?;
        }
        writeln!(self.out)?;
        let Some(&pair) = found.pairs().first() else {
            let size = counted(self.edges, "edge");
            print_paragraph(
                self.out,
                &format!("no pair up to {size}: a walk distinguishes any two"),
            )?;
            if let Some(theorem) = proved(marker, self.class, true) {
                let any = format!("none in any world of the class: `{theorem}`, proved in Coq");
                print_paragraph(self.out, &any)?;
            }
            return Ok(());
        };
        let smallest = format!(
            "The smallest pair that no walk distinguishes: {}. For each vertex, the list shows where \
             its doors lead, clockwise.",
            sizes(pair)
        );
        print_paragraph(self.out, &smallest)?;
        writeln!(self.out)?;
        pair.into_iter().try_for_each(|world| self.print_world(world))?;
        if !self.has_page {
            let command = format!(
                "toposlam counterexample --marker {} --class {} --max-edges {} --html walk.html",
                marker.name(),
                self.class,
                self.edges
            );
            writeln!(self.out, "\nTo walk them in a browser:")?;
            print_command(self.out, "  ", &command)?;
        }
        if found.all { self.print_pairs(found) } else { Ok(()) }
    }

    /// All pairs by name, and the worlds in them.
    fn print_pairs(&mut self, found: &WorldPairs) -> io::Result<()> {
        let pairs = found.pairs();
        let count = grouped(pairs.len() as u128);
        writeln!(self.out, "\nAll pairs: {count}\n")?;
        for pair @ [one, other] in pairs {
            let pair = format!("{} ~ {}: {}", one.name, other.name, sizes(pair));
            print_indented(self.out, "  ", 4, &pair)?;
        }
        writeln!(self.out, "\nTheir worlds:\n")?;
        found.worlds.iter().try_for_each(|world| self.print_world(world))
    }

    /// The start of a world, and the clockwise order at each of its vertices.
    fn print_world(&mut self, world: &NamedWorld) -> io::Result<()> {
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
    pub(super) fn end(&mut self) -> io::Result<()> {
        std::mem::take(&mut self.pairs).iter().try_for_each(|found| self.print_pairs(found))
    }
}

fn sizes([one, other]: [&NamedWorld; 2]) -> String {
    format!("{} and {} edges", one.graph.edge_count(), other.graph.edge_count())
}
