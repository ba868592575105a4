//! The atlas: the smallest pair for each marker and class, as world files, pictures and a table; or the
//! theorem that there is none.

use std::path::Path;

use toposlam_model::{
    aid::{AidKind, FEW_STATES},
    ambiguity::{AmbiguitySearch, KeptPairs},
    enumerate::Class,
    format::named_world::NamedWorld,
};
use toposlam_proofs::marker_theorems;

use super::{
    memory::MemoryLimit,
    pairs::{self, WorldPairs},
    run_search,
};
use crate::{
    cli::{
        CliError, Outcome, output,
        progress::Progress,
        text::{counted, sentence},
    },
    picture::{WorldPicture, svg},
};

/// The number of edges up to which the atlas searches a class. All searches take about a minute.
fn full_size(class: Class) -> usize {
    match class {
        Class::Multigraph => 7,
        Class::Simple | Class::Planar => 10,
        Class::Corridor => 12,
    }
}

/// A marker, and its smallest pair in each class.
type Row = (AidKind, Vec<WorldPairs>);

/// Writes the atlas. `edges` limits the sizes of the worlds.
pub(super) fn write(
    folder: &Path,
    edges: Option<usize>,
    limit: Option<MemoryLimit>,
) -> Result<Outcome, CliError> {
    let sizes = Class::ALL.map(|class| full_size(class).min(edges.unwrap_or(usize::MAX)));
    let mut rows = Vec::new();
    output::make_folder(folder)?;
    for &marker in FEW_STATES {
        let mut found = Vec::new();
        for (class, edges) in Class::ALL.into_iter().zip(sizes) {
            let search = AmbiguitySearch::new(class, edges, marker)
                .map_err(|error| CliError::at("--max-edges", error))?;
            let work = format!("{}, {class}", marker.name());
            let progress = Progress::new(&work, "placed worlds")?;
            let findings = run_search(&search, limit, KeptPairs::Smallest, &progress)?;
            progress.finish();
            match findings {
                Ok(findings) => found.push(WorldPairs::new(marker, class, &findings, false)),
                Err(unfinished) => return pairs::report_unfinished(&unfinished),
            }
        }
        rows.push((marker, found));
    }
    for found in rows.iter().flat_map(|(_, found)| found) {
        found.write(folder)?;
        for world in &found.worlds {
            let path = folder.join(format!("{}.svg", world.name));
            output::write_whole(&path, svg(&WorldPicture::from(world)).as_bytes())?;
        }
    }
    let limit = edges.map(|edges| format!(" --max-edges {edges}")).unwrap_or_default();
    output::write_whole(&folder.join("README.md"), readme(&rows, sizes, &limit).as_bytes())?;
    Ok(Outcome::Holds)
}

/// The table, and the pictures of each pair.
fn readme(rows: &[Row], sizes: [usize; 4], limit: &str) -> String {
    let mut text = format!("{}{limit}\n\n", head(sizes));
    let mut line = |line: &str| {
        text.push_str(line);
        text.push('\n');
    };
    line(&format!("| marker | {} |", Class::ALL.map(Class::name).join(" | ")));
    line(&format!("| --- |{}", " --- |".repeat(Class::ALL.len())));
    for (marker, found) in rows {
        let cells = Class::ALL.into_iter().zip(found).zip(sizes);
        let cells: Vec<_> =
            cells.map(|((class, found), edges)| cell(*marker, class, found, edges)).collect();
        line(&format!("| {} | {} |", marker.name(), cells.join(" | ")));
    }
    for (marker, found) in rows {
        line(&format!("\n## {}\n", marker.name()));
        line(&format!("{}\n", sentence(marker.about())));
        if found.iter().all(|found| found.pairs().is_empty()) {
            line(&no_pair(*marker));
            continue;
        }
        line("| class | one world | the other |\n| --- | --- | --- |");
        for (found, class) in found.iter().zip(Class::ALL) {
            if let Some(pair) = found.pairs().first() {
                let [one, other] = pair.map(|world| format!("![{0}]({0}.svg)", world.name));
                line(&format!("| {class} | {one} | {other} |"));
            }
        }
    }
    text
}

/// What the table shows, and the command that makes it.
fn head(sizes: [usize; 4]) -> String {
    let sizes = Class::ALL.into_iter().zip(sizes);
    let sizes: Vec<_> = sizes.map(|(class, edges)| format!("{class} {edges}")).collect();
    format!(
        "\
# Atlas of worlds that a marker cannot distinguish

The table shows the smallest pair for each kind of marker in each class of worlds; or, if one robot maps all
worlds of the class, the theorem that proves this. A theorem after a pair proves that no robot maps all worlds of
the class, by this pair or another one. `toposlam proofs` lists the theorems; their proofs are in `proofs/coq`.

The smallest pair is the one whose larger world is smallest. The search covers all worlds of the class up to a number
of edges ({}), with the marker at every place. A verified bisimulation confirms each
pair; this command prints it, and with `--html` writes a page on which you can walk both worlds:

    toposlam compare worlds/atlas/undirected-simple-1.toml worlds/atlas/undirected-simple-2.toml --marker undirected

This command makes the folder:

    toposlam counterexample --atlas worlds/atlas

Larger searches, one size further, and checks of every start with up to 9 edges are in `docs/checks.md`, with their
commands.",
        sizes.join(", ")
    )
}

/// That there is no pair in any class, and why.
fn no_pair(marker: AidKind) -> String {
    let theorem = |class| proved(marker, class, true);
    let mut theorems: Vec<_> = Class::ALL.into_iter().map(theorem).collect();
    theorems.dedup();
    match theorems.as_slice() {
        // It is about all classes.
        [Some(theorem)] => format!("No pair: `{theorem}`."),
        _ => "No pair: see the table.".to_owned(),
    }
}

/// The theorem that the marker suffices in this class of worlds, or that it does not.
pub(super) fn proved(marker: AidKind, class: Class, suffices: bool) -> Option<&'static str> {
    let theorem = marker_theorems::about(marker.name(), class)?;
    (theorem.suffices == suffices).then_some(theorem.theorem)
}

/// That the search up to this number of edges found no pair; or, if it is proved, that there is none.
pub(super) fn none(marker: AidKind, class: Class, edges: usize) -> String {
    match proved(marker, class, true) {
        Some(theorem) => format!("none: `{theorem}`"),
        None => format!("none up to {}", counted(edges, "edge")),
    }
}

/// The sizes of the smallest pair, with links to its files, and the theorem about the marker in this class.
fn cell(marker: AidKind, class: Class, found: &WorldPairs, edges: usize) -> String {
    let pairs = found.pairs();
    let Some(pair) = pairs.first() else {
        return none(marker, class, edges);
    };
    let file = |world: &NamedWorld| {
        format!("[{}]({}.toml)", counted(world.graph.edge_count(), "edge"), world.name)
    };
    let theorem =
        proved(marker, class, false).map(|theorem| format!(": `{theorem}`")).unwrap_or_default();
    format!("{} and {}{theorem}", file(pair[0]), file(pair[1]))
}
