//! Files of other programs, by their beginnings: what they are, and what to write instead.

/// What a file that is not a world is, if it is one of another program.
pub(crate) fn world_of_other(bytes: &[u8]) -> Option<String> {
    let text = beginning(bytes);
    let start = text.trim_start_matches(['\u{feff}', ' ', '\t', '\r', '\n']);
    let first = start.split(|letter: char| !letter.is_alphanumeric()).next().unwrap_or_default();
    let has = |part: &str| text.contains(part);
    let what = match first.to_ascii_lowercase().as_str() {
        "graph" | "digraph" | "strict" => "a graph in DOT (Graphviz), which `draw` writes, too",
        _ if start.starts_with("/*") || start.starts_with("//") => "a graph in DOT (Graphviz)",
        _ if has("<graphml") => "a graph in GraphML",
        _ if has("<gexf") => "a graph in GEXF",
        _ if start.starts_with('<') => "XML",
        _ if has("nodes:") && (has("edge_id:") || has("metric_map:") || has("pointset:")) => {
            "a topological map (tmap2 YAML)"
        }
        _ => return None,
    };
    Some(format!(
        "this is {what}. It does not state the clockwise order of the edges around each vertex, which a world needs; \
         worlds are read from TOML and JSON (docs: worlds/README.md) and plantri's planar_code and edge_code"
    ))
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
            ("<?xml version=\"1.0\"?><graphml/>", "this is a graph in GraphML"),
            ("name: hall\nnodes:\n- node: {edges: [{edge_id: A_B}]}", "this is a topological map"),
        ] {
            let found = world_of_other(text.as_bytes()).unwrap();
            assert!(found.starts_with(what) && found.contains("TOML and JSON"), "{found}");
        }
        for text in ["name = \"x\"\n", "", "\u{1}\u{2}", "[floor]\ngraph = 1"] {
            assert_eq!(world_of_other(text.as_bytes()), None, "{text}");
        }
    }
}
