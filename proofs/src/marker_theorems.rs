//! Which marking aids suffice in which classes of worlds: the theorems that are proved in Coq.

use toposlam_model::enumerate::Class;

/// A theorem about marking aids in some classes of worlds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MarkerTheorem {
    /// The names of the aids.
    pub aids: &'static [&'static str],
    /// The classes about which the theorem is.
    pub classes: &'static [Class],
    /// Whether one robot maps every world of these classes with such an aid. Otherwise the theorem
    /// has a pair of worlds, in all of these classes, of which no robot maps both.
    pub suffices: bool,
    /// The theorem's name.
    pub theorem: &'static str,
}

const EVERY: &[Class] = &Class::ALL;
const SIMPLE: &[Class] = &[Class::Simple, Class::Corridor, Class::Planar];

/// Several markers that are carried.
const MARKERS: &[&str] = &[
    "movable-2",
    "movable-3",
    "movable-4",
    "movable-2-distinct",
    "movable-3-distinct",
    "movable-4-distinct",
];
const ROUND_TEAMS: &[&str] = &["team-2-round", "team-3-round"];
/// The aids that move and have a front.
const WITH_FRONT: &[&str] = &["movable-directional", "movable+directional", "team-2", "team-3"];
/// The aids that are seen only at vertices, but for one marker.
const AT_VERTICES: &[&str] = &[
    "movable-2",
    "movable-3",
    "movable-4",
    "movable-2-distinct",
    "movable-3-distinct",
    "movable-4-distinct",
    "team-2-round",
    "team-3-round",
];

/// The theorems about marking aids, by aid.
pub const MARKER_THEOREMS: [MarkerTheorem; 17] = [
    no_robot(&["none"], EVERY, "no_marker_impossible"),
    // Both worlds have a vertex of degree 4, and one of them is not planar.
    no_robot(&["undirected"], &[Class::Multigraph, Class::Simple], "undirected_marker_impossible"),
    no_robot(&["undirected"], &[Class::Corridor], "undirected_corridor_impossible"),
    no_robot(&["undirected"], &[Class::Planar], "undirected_planar_impossible"),
    one_robot(&["directional"], EVERY, "directional_marker_suffices"),
    no_robot(&["undirected-edge"], EVERY, "undirected_edge_impossible"),
    one_robot(&["directed-edge"], EVERY, "directed_edge_suffices"),
    no_robot(&["two-identical"], EVERY, "two_identical_impossible"),
    no_robot(&["two-distinct"], &[Class::Multigraph], "two_distinct_impossible"),
    one_robot(&["two-distinct"], SIMPLE, "two_distinct_suffices_simple"),
    no_robot(&["movable"], &[Class::Multigraph], "movable_marker_impossible"),
    one_robot(&["movable"], SIMPLE, "movable_marker_correct"),
    no_robot(AT_VERTICES, &[Class::Multigraph], "aids_at_vertices_impossible"),
    one_robot(MARKERS, SIMPLE, "movable_markers_suffice_simple"),
    one_robot(ROUND_TEAMS, SIMPLE, "round_team_suffices_simple"),
    one_robot(WITH_FRONT, EVERY, "front_suffices"),
    one_robot(&["string-1", "string-2", "string-3"], EVERY, "string_suffices"),
];

const fn one_robot(
    aids: &'static [&'static str],
    classes: &'static [Class],
    theorem: &'static str,
) -> MarkerTheorem {
    MarkerTheorem { aids, classes, suffices: true, theorem }
}

const fn no_robot(
    aids: &'static [&'static str],
    classes: &'static [Class],
    theorem: &'static str,
) -> MarkerTheorem {
    MarkerTheorem { suffices: false, ..one_robot(aids, classes, theorem) }
}

/// The theorem about this marking aid in this class of worlds, if there is one.
pub fn about(aid: &str, class: Class) -> Option<&'static MarkerTheorem> {
    MARKER_THEOREMS
        .iter()
        .find(|theorem| theorem.aids.contains(&aid) && theorem.classes.contains(&class))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use toposlam_model::{
        aid::{AIDS, AidKind, FEW_STATES},
        format::world_file,
    };

    use super::*;
    use crate::theorems;

    /// Theorems about markers that are not kinds: at a dead end, and two that are not adjacent.
    const OTHERS: [&str; 2] = ["undirected_dead_end_suffices", "two_distant_impossible"];

    #[test]
    fn each_theorem_on_markers_is_in_the_table_once() {
        let mut stated: Vec<_> = theorems::all().map(|theorem| theorem.name).collect();
        stated.retain(|name| {
            ["_suffice", "_impossible", "movable_marker_correct"]
                .iter()
                .any(|part| name.contains(part))
        });
        let mut listed: Vec<_> =
            MARKER_THEOREMS.iter().map(|row| row.theorem).chain(OTHERS).collect();
        stated.sort_unstable();
        listed.sort_unstable();
        assert_eq!(listed, stated);
    }

    /// So no theorem contradicts another.
    #[test]
    fn one_theorem_decides_about_each_aid_and_class() {
        for aid in AIDS.into_iter().filter(|aid| aid.marks()) {
            for class in Class::ALL {
                let is_about = |row: &&MarkerTheorem| {
                    row.aids.contains(&aid.name()) && row.classes.contains(&class)
                };
                let rows = MARKER_THEOREMS.iter().filter(is_about);
                assert_eq!(rows.count(), 1, "{aid:?} {class}");
            }
        }
        let known = AIDS.map(AidKind::name);
        let mut named = MARKER_THEOREMS.iter().flat_map(|row| row.aids);
        assert!(named.all(|name| known.contains(name)));
    }

    /// The pairs of `Figures.v`, as world files. The other pairs are of multigraphs.
    #[test]
    fn the_pairs_are_in_the_classes() {
        let edge = ["atlas/undirected-edge-corridor-1", "atlas/undirected-edge-corridor-2"];
        for (theorem, pair) in [
            ("no_marker_impossible", ["cycle-3", "cycle-4"]),
            (
                "undirected_marker_impossible",
                ["atlas/undirected-simple-1", "atlas/undirected-simple-2"],
            ),
            (
                "undirected_corridor_impossible",
                ["atlas/undirected-corridor-1", "atlas/undirected-corridor-2"],
            ),
            (
                "undirected_planar_impossible",
                ["atlas/undirected-planar-1", "atlas/undirected-planar-2"],
            ),
            ("undirected_edge_impossible", edge),
            ("two_identical_impossible", edge),
        ] {
            let row = MARKER_THEOREMS.iter().find(|row| row.theorem == theorem).unwrap();
            let graphs = pair.map(|name| {
                let file = format!("../worlds/{name}.toml");
                let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
                world_file::read(&std::fs::read(path).unwrap()).unwrap().graph
            });
            let holds = |class: Class| {
                graphs.iter().all(|graph| {
                    let degrees = graph.darts().map(|dart| graph.degree_around(dart));
                    (!class.is_simple() || graph.is_simple())
                        && degrees.max() <= Some(class.max_degree())
                        && (class != Class::Planar || graph.genus() == 0)
                })
            };
            let classes: Vec<_> = Class::ALL.into_iter().filter(|&class| holds(class)).collect();
            // A class may have a theorem of its own.
            let decided: Vec<_> = classes
                .into_iter()
                .filter(|&class| about(row.aids[0], class).unwrap().theorem == theorem)
                .collect();
            assert_eq!(row.classes, decided, "{theorem}");
        }
    }

    #[test]
    fn the_table_of_the_readme_is_this_one() {
        const README: &str = include_str!("../coq/README.md");
        for marker in FEW_STATES {
            let cells = [Class::Multigraph, Class::Simple].map(|class| {
                about(marker.name(), class).map_or_else(
                    || "not known".to_owned(),
                    |row| format!("{}: `{}`", if row.suffices { "yes" } else { "no" }, row.theorem),
                )
            });
            let (start, end) =
                (format!("| `{}` | ", marker.name()), format!(" | {} |", cells.join(" | ")));
            let rows =
                README.lines().filter(|line| line.starts_with(&start) && line.ends_with(&end));
            assert_eq!(rows.count(), 1, "{start} ... {end}");
        }
    }
}
