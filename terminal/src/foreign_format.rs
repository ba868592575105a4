//! Files of other programs, by their beginnings: what they are, and what to write instead.

use toposlam_model::format::named_world::NamedWorld;

use super::placed_graph::{PlacedGraph, PlacedGraphError, read_graphml, read_tmap2};

/// Reads a graph.
type Read = fn(&str) -> Result<PlacedGraph, PlacedGraphError>;

/// The world of a file of another program, which has the positions of its nodes; `None` if the file is not of another
/// program.
///
/// # Errors
/// Returns what the file is and why it is no world.
pub(crate) fn world_of_other(bytes: &[u8]) -> Option<Result<NamedWorld, String>> {
    let text = beginning(bytes);
    let start = text.trim_start_matches(['\u{feff}', ' ', '\t', '\r', '\n']);
    let first = start.split(|letter: char| !letter.is_alphanumeric()).next().unwrap_or_default();
    let has = |part: &str| text.contains(part);
    let (what, read): (_, Option<Read>) = match first.to_ascii_lowercase().as_str() {
        "graph" | "digraph" | "strict" => ("a graph in DOT (Graphviz), which `draw` writes", None),
        _ if start.starts_with("/*") || start.starts_with("//") => {
            ("a graph in DOT (Graphviz)", None)
        }
        _ if has("<graphml") => ("a graph in GraphML", Some(read_graphml)),
        _ if has("<gexf") => ("a graph in GEXF", None),
        _ if start.starts_with('<') => ("XML", None),
        // The older maps are lists of nodes.
        _ if (has("nodes:") || has("node:") && start.starts_with('-'))
            && (has("edge_id:") || has("metric_map:") || has("pointset:")) =>
        {
            ("a topological map (tmap2 YAML)", Some(read_tmap2))
        }
        _ => return None,
    };
    let world = match read {
        Some(read) => {
            let text = String::from_utf8_lossy(bytes);
            read(text.trim_start_matches('\u{feff}')).and_then(|graph| graph.world())
        }
        None => Ok(None),
    };
    Some(match world {
        Ok(Some(world)) => Ok(world),
        Err(error) => Err(format!("this is {what}: {error}")),
        Ok(None) => Err(format!(
            "this is {what}. It does not state the clockwise order of the edges around each vertex, which a world \
             needs; worlds are read from TOML and JSON (docs: worlds/README.md), plantri's planar_code and edge_code, \
             and from GraphML and tmap2 YAML whose nodes have positions"
        )),
    })
}

/// The text at the beginning of a file.
fn beginning(bytes: &[u8]) -> String {
    const HEAD: usize = 1 << 16;
    String::from_utf8_lossy(bytes.get(..HEAD).unwrap_or(bytes)).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_other_programs_are_named() {
        for (text, what) in [
            ("graph G { a -- b }", "this is a graph in DOT"),
            ("// by hand\ndigraph { a -> b }", "this is a graph in DOT"),
            ("<graphml><graph><node id='a'/></graph></graphml>", "this is a graph in GraphML"),
            (
                "nodes:\n- node: {name: A, edges: [{edge_id: A_B, node: B}]}",
                "this is a topological map",
            ),
            ("<gexf/>", "this is a graph in GEXF"),
        ] {
            let found = world_of_other(text.as_bytes()).unwrap().unwrap_err();
            assert!(found.starts_with(what) && found.contains("TOML and JSON"), "{found}");
        }
        for text in ["name = \"x\"\n", "", "\u{1}\u{2}", "[floor]\ngraph = 1"] {
            assert_eq!(world_of_other(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn a_file_with_positions_is_a_world_or_says_why_it_is_none() {
        let two = "<graphml><key id='x' attr.name='x'/><key id='y' attr.name='y'/><graph edgedefault='undirected'>\
                   <node id='a'><data key='x'>0</data><data key='y'>0</data></node>\
                   <node id='b'><data key='x'>1</data><data key='y'>0</data></node>\
                   <edge source='a' target='b'/></graph></graphml>";
        assert_eq!(world_of_other(two.as_bytes()).unwrap().unwrap().graph.edge_count(), 1);
        let one_way = two.replace("undirected", "directed");
        let found = world_of_other(one_way.as_bytes()).unwrap().unwrap_err();
        assert!(found.starts_with("this is a graph in GraphML: an edge leads from"), "{found}");
        let broken = "<graphml>\n</graph>";
        let found = world_of_other(broken.as_bytes()).unwrap().unwrap_err();
        assert!(found.starts_with("this is a graph in GraphML: line 2: "), "{found}");
    }
}
