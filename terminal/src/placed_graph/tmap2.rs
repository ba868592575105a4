//! Topological maps in YAML (strands' `topological_navigation`): the nodes have poses, and directed edges.

use saphyr_parser::{Event, Parser};

use super::{PlacedEdge, PlacedGraph, PlacedGraphError, PlacedNode, shown};

/// A YAML value. Tags and aliases are ignored.
#[derive(Clone, Debug, PartialEq)]
enum Yaml {
    Word(String),
    List(Vec<Yaml>),
    Mapping(Vec<(String, Yaml)>),
}

/// A value that is not complete.
enum Part {
    List(Vec<Yaml>),
    Mapping(Vec<(String, Yaml)>, Option<String>),
}

/// Deeper values are an error.
const DEPTH: usize = 32;

/// Reads a map: a mapping with `nodes`, or the older list of nodes.
pub(crate) fn read(text: &str) -> Result<PlacedGraph, PlacedGraphError> {
    let root = Yaml::parse(text)?;
    let name = root.get("name").and_then(Yaml::word).unwrap_or_default().to_owned();
    let nodes = match &root {
        Yaml::Mapping(_) => root.get("nodes").map_or(&[][..], Yaml::list),
        _ => root.list(),
    };
    let mut graph = PlacedGraph { name, ..PlacedGraph::default() };
    for (number, entry) in nodes.iter().enumerate() {
        let node = entry.get("node").unwrap_or(entry);
        let Some(name) = node.get("name").and_then(Yaml::word) else {
            let message = format!("node {} has no name", number + 1);
            return Err(PlacedGraphError::Syntax { line: 1, message });
        };
        let position = node.get("pose").and_then(|pose| pose.get("position"));
        let number = |axis| {
            let word = position.and_then(|position| position.get(axis)).and_then(Yaml::word);
            word.map(|word| word.parse().unwrap_or(f64::NAN))
        };
        let position = number("x").zip(number("y")).map(|(x, y)| [x, y]);
        graph.nodes.push(PlacedNode { name: name.to_owned(), position });
        for edge in node.get("edges").map_or(&[][..], Yaml::list) {
            let Some(to) = edge.get("node").and_then(Yaml::word) else {
                let message = format!("an edge of node `{}` has no `node`", shown(name));
                return Err(PlacedGraphError::Syntax { line: 1, message });
            };
            let ends = [name.to_owned(), to.to_owned()];
            graph.edges.push(PlacedEdge { ends, is_directed: true });
        }
    }
    Ok(graph)
}

impl Yaml {
    fn parse(text: &str) -> Result<Self, PlacedGraphError> {
        let mut parts: Vec<Part> = Vec::new();
        for event in Parser::new_from_str(text) {
            let (event, span) = event.map_err(|error| PlacedGraphError::Syntax {
                line: error.marker().line(),
                message: shown(error.info()),
            })?;
            let wrong = |message: &str| PlacedGraphError::Syntax {
                line: span.start.line(),
                message: message.to_owned(),
            };
            let value = match event {
                Event::Scalar(word, ..) => Self::Word(word.into_owned()),
                Event::Alias(_) => Self::Word(String::new()),
                Event::MappingStart(..) | Event::SequenceStart(..) if parts.len() >= DEPTH => {
                    return Err(wrong("the values are too deep"));
                }
                Event::MappingStart(..) => {
                    parts.push(Part::Mapping(Vec::new(), None));
                    continue;
                }
                Event::SequenceStart(..) => {
                    parts.push(Part::List(Vec::new()));
                    continue;
                }
                Event::MappingEnd | Event::SequenceEnd => match parts.pop() {
                    Some(Part::List(list)) => Self::List(list),
                    Some(Part::Mapping(entries, _)) => Self::Mapping(entries),
                    None => continue,
                },
                _ => continue,
            };
            match parts.last_mut() {
                // Only the first document.
                None => return Ok(value),
                Some(Part::List(list)) => list.push(value),
                Some(Part::Mapping(entries, key)) => match (key.take(), value) {
                    (Some(key), value) => entries.push((key, value)),
                    (None, Self::Word(word)) => *key = Some(word),
                    (None, _) => return Err(wrong("a key should be a word")),
                },
            }
        }
        Err(PlacedGraphError::NoNodes)
    }

    fn get(&self, key: &str) -> Option<&Self> {
        let Self::Mapping(entries) = self else { return None };
        entries.iter().find(|(found, _)| found == key).map(|(_, value)| value)
    }

    fn list(&self) -> &[Self] {
        if let Self::List(list) = self { list } else { &[] }
    }

    fn word(&self) -> Option<&str> {
        if let Self::Word(word) = self { Some(word) } else { None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A node with its position and neighbours.
    fn node(name: &str, [x, y]: [f64; 2], neighbours: &[&str]) -> String {
        let edge = |to: &&str| format!("    - {{edge_id: {name}_{to}, node: {to}}}\n");
        let edges: String = neighbours.iter().map(edge).collect();
        format!(
            "- meta: {{map: hall, node: {name}}}\n  node:\n    name: {name}\n    edges:\n{edges}    \
             pose:\n      position: {{x: {x}, y: {y}, z: 0.0}}\n      orientation: {{w: 1.0}}\n"
        )
    }

    #[test]
    fn a_map_is_a_world_in_its_clockwise_order() {
        let nodes = [
            node("m", [0.0, 0.0], &["w", "n", "e"]),
            node("e", [5.0, 0.0], &["m"]),
            node("n", [0.0, 5.0], &["m"]),
            node("w", [-5.0, 0.0], &["m"]),
        ]
        .concat();
        for text in [format!("name: hall\nmetric_map: hall\nnodes:\n{nodes}"), nodes] {
            let world = read(&text).unwrap().world().unwrap().unwrap();
            let around = world.graph.darts_of(world.vertex_named("m").unwrap());
            let names = around.map(|dart| world.at_text(world.graph.opposite(dart)));
            assert_eq!(names.collect::<Vec<_>>(), ["n", "e", "w"]);
        }
    }

    #[test]
    fn what_is_no_map_is_an_error() {
        let one_way = [node("a", [0.0, 0.0], &["b"]), node("b", [1.0, 0.0], &[])].concat();
        let found = read(&one_way).unwrap().world().unwrap_err().to_string();
        assert!(found.starts_with("an edge leads from `a` to `b`, and none leads back"), "{found}");
        for (text, error) in [
            ("nodes: [", "line "),
            ("", "the graph has no nodes"),
            ("nodes:\n- node: {edges: []}", "line 1: node 1 has no name"),
            ("- node: {name: a, edges: [{edge_id: a_b}]}", "line 1: an edge of node `a`"),
            ("{[a]: b}", "line 1: a key should be a word"),
        ] {
            let found = read(text).unwrap_err().to_string();
            assert!(found.starts_with(error), "{text}: {found}");
        }
        let deep = "[".repeat(100);
        assert_eq!(read(&deep).unwrap_err().to_string(), "line 1: the values are too deep");
    }
}
