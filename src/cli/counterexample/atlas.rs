//! The atlas: the smallest pair for each marking aid and class, as world files, pictures and a table; or the
//! theorem that there is none.

use std::path::Path;

use toposlam_model::{
    aid::{AIDS, AidKind, FEW_STATES},
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

/// The number of edges up to which the atlas searches a class with an aid. The aids with many states are searched only
/// where a theorem has a pair, which is small.
fn searched(aid: AidKind, class: Class, edges: usize) -> Option<usize> {
    if FEW_STATES.contains(&aid) {
        return Some(edges);
    }
    proved(aid, class, true).is_none().then_some(edges.min(MANY_STATES))
}

/// The number of edges up to which aids with many states are searched.
const MANY_STATES: usize = 4;

/// A marking aid, and in each class its smallest pair, if it was searched.
struct Row {
    aid: AidKind,
    found: Vec<Option<WorldPairs>>,
    /// An earlier aid with the same worlds in all its pairs: its files are those of this one, too.
    same: Option<AidKind>,
}

impl Row {
    fn pair(&self, class: usize) -> Option<[&NamedWorld; 2]> {
        self.found.get(class)?.as_ref()?.pairs().first().copied()
    }

    /// Whether it has a pair, and the same graphs and starts in each class as another row.
    fn has_pairs_of(&self, other: &Self) -> bool {
        let worlds = |row: &Self, class| {
            row.pair(class).map(|pair| pair.map(|world| (world.graph.clone(), world.start)))
        };
        let classes = 0..Class::ALL.len();
        classes.clone().any(|class| self.pair(class).is_some())
            && classes.clone().all(|class| worlds(self, class) == worlds(other, class))
    }
}

/// Writes the atlas. `edges` limits the sizes of the worlds.
pub(super) fn write(
    folder: &Path,
    edges: Option<usize>,
    limit: Option<MemoryLimit>,
) -> Result<Outcome, CliError> {
    let sizes = Class::ALL.map(|class| full_size(class).min(edges.unwrap_or(usize::MAX)));
    let mut rows: Vec<Row> = Vec::new();
    output::make_folder(folder)?;
    for aid in AIDS.into_iter().filter(|aid| aid.marks()) {
        let mut found = Vec::new();
        for (class, edges) in Class::ALL.into_iter().zip(sizes) {
            let Some(edges) = searched(aid, class, edges) else {
                found.push(None);
                continue;
            };
            let search = AmbiguitySearch::new(class, edges, aid)
                .map_err(|error| CliError::at("--max-edges", error))?;
            let work = format!("{}, {class}", aid.name());
            let progress = Progress::new(&work, "placed worlds")?;
            let findings = run_search(&search, limit, KeptPairs::Smallest, &progress)?;
            progress.finish();
            match findings {
                Ok(findings) => found.push(Some(WorldPairs::new(aid, class, &findings, false))),
                Err(unfinished) => return pairs::report_unfinished(&unfinished),
            }
        }
        let mut row = Row { aid, found, same: None };
        let mut earlier =
            rows.iter().filter(|earlier| earlier.same.is_none() && earlier.aid.moves());
        row.same = earlier.find(|earlier| row.has_pairs_of(earlier)).map(|earlier| earlier.aid);
        rows.push(row);
    }
    let own = rows.iter().filter(|row| row.same.is_none());
    for found in own.flat_map(|row| row.found.iter().flatten()) {
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
    let mut text = format!("{}\n\n", head(sizes, limit));
    let mut line = |line: &str| {
        text.push_str(line);
        text.push('\n');
    };
    line(&format!("| marking aid | {} |", Class::ALL.map(Class::name).join(" | ")));
    line(&format!("| --- |{}", " --- |".repeat(Class::ALL.len())));
    // The worlds of an aid whose files are those of another one.
    let filed = |row: &Row| {
        let aid = row.same.unwrap_or(row.aid);
        rows.iter().position(|row| row.aid == aid)
    };
    for row in rows {
        let files = filed(row).and_then(|at| rows.get(at)).unwrap_or(row);
        let cells = (0..).zip(Class::ALL).zip(sizes);
        let cells: Vec<_> =
            cells.map(|((at, class), edges)| cell(row.aid, class, files.pair(at), edges)).collect();
        line(&format!("| {} | {} |", row.aid.name(), cells.join(" | ")));
    }
    for row in rows {
        line(&format!("\n## {}\n", row.aid.name()));
        line(&format!("{}\n", sentence(row.aid.about())));
        let classes = || (0..).zip(Class::ALL);
        if let Some(same) = row.same {
            let name = same.name();
            line(&format!(
                "The pairs are those of [{name}](#{name}); `--marker {}`.",
                row.aid.name()
            ));
        } else if classes().all(|(at, _)| row.pair(at).is_none()) {
            line(&no_pair(row.aid));
        } else {
            line("| class | one world | the other |\n| --- | --- | --- |");
            for (at, class) in classes() {
                if let Some(pair) = row.pair(at) {
                    let [one, other] = pair.map(|world| format!("![{0}]({0}.svg)", world.name));
                    line(&format!("| {class} | {one} | {other} |"));
                }
            }
        }
    }
    text
}

/// What the table shows, and the command that makes it.
fn head(sizes: [usize; 4], limit: &str) -> String {
    let sizes = Class::ALL.into_iter().zip(sizes);
    let sizes: Vec<_> = sizes.map(|(class, edges)| format!("{class} {edges}")).collect();
    format!(
        "\
# Atlas of worlds that a marking aid cannot distinguish

The table shows the smallest pair for each [marking aid](../../docs/aids.md) in each class of worlds; or, if one robot
maps all worlds of the class, the theorem that proves this. A theorem after a pair proves that no robot maps all worlds
of the class, by this pair or another one. `toposlam proofs` lists the theorems; their proofs are in `proofs/coq`.

The smallest pair is the one whose larger world is smallest. For a fixed marker and `movable`, the search covers all
worlds of the class up to a number of edges ({}), with the marker at every place.
The other aids that move have so many states that the search covers up to {MANY_STATES} edges, where a theorem has a pair. A
verified bisimulation confirms each pair; this command prints it, and with `--html` writes a page on which you can walk
both worlds:

    toposlam compare worlds/atlas/undirected-simple-1.toml worlds/atlas/undirected-simple-2.toml --marker undirected

Aids with the same pairs have the same files; with `--marker KIND` the same command compares them with each of these aids.

This command makes the folder:

    toposlam counterexample --atlas worlds/atlas{limit}

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

/// The sizes of the smallest pair, with links to its files, and the theorem about the aid in this class.
fn cell(aid: AidKind, class: Class, pair: Option<[&NamedWorld; 2]>, edges: usize) -> String {
    let Some(pair) = pair else {
        return none(aid, class, edges);
    };
    let file = |world: &NamedWorld| {
        format!("[{}]({}.toml)", counted(world.graph.edge_count(), "edge"), world.name)
    };
    let theorem =
        proved(aid, class, false).map(|theorem| format!(": `{theorem}`")).unwrap_or_default();
    let [one, other] = pair.map(file);
    format!("{one} and {other}{theorem}")
}
