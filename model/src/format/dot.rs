//! DOT, for Graphviz: a world as an undirected graph with its doors. Section 2.1.

use super::named_world::NamedWorld;
use crate::embedded_graph::Dart;

/// Points of 1/72 inch for a metre: a quarter inch.
const POINTS: f64 = 18.0;

/// The world in DOT.
///
/// Each end of an edge has its door, counted clockwise from the vertex's first dart. The vertex of the
/// start has a double border, and its facing edge is bold, with an arrow away from it. The vertices of
/// a floor plan are pinned to their positions (`neato -n`).
pub fn write(world: &NamedWorld) -> String {
    let mut text = format!("graph {} {{\n", quoted(&world.name));
    if !world.about.is_empty() {
        line(&mut text, &format!("label={}", quoted(&world.about)));
    }
    line(&mut text, "node [shape=circle]");
    let graph = &world.graph;
    let start_vertex = world.start.map(|start| graph.vertex(start));
    for (vertex, name) in graph.vertices().zip(&world.vertex_names) {
        let mut attributes = Vec::new();
        if Some(vertex) == start_vertex {
            attributes.push("shape=doublecircle".to_owned());
        }
        if let Some([x, y]) = world.positions.as_ref().map(|at| at[vertex.at()]) {
            attributes.push(format!("pos=\"{},{}\"", POINTS * x, POINTS * y));
        }
        let attributes = bracketed(&attributes);
        line(&mut text, &format!("{}{attributes}", quoted(name)));
    }
    for (dart, other) in graph.edges() {
        let mut attributes = vec![
            format!("taillabel={}", graph.index(dart)),
            format!("headlabel={}", graph.index(other)),
        ];
        if let Some(names) = &world.edge_names {
            attributes.push(format!("label={}", quoted(&names[dart.at()])));
        }
        attributes.extend(facing(world.start, dart, other));
        let ends = [dart, other].map(|end| quoted(world.at_text(end)));
        let attributes = bracketed(&attributes);
        line(&mut text, &format!("{} -- {}{attributes}", ends[0], ends[1]));
    }
    text.push_str("}\n");
    text
}

/// The attributes of the edge of two darts, if one of them is the facing one.
fn facing(start: Option<Dart>, tail: Dart, head: Dart) -> Option<String> {
    let direction = match start? {
        dart if dart == tail => "forward",
        dart if dart == head => "back",
        _ => return None,
    };
    Some(format!("style=bold, dir={direction}"))
}

fn bracketed(attributes: &[String]) -> String {
    if attributes.is_empty() { String::new() } else { format!(" [{}]", attributes.join(", ")) }
}

fn line(text: &mut String, statement: &str) {
    text.push_str("  ");
    text.push_str(statement);
    text.push_str(";\n");
}

/// A text as a quoted string without escapes of Graphviz.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for character in text.chars() {
        match character {
            '"' => quoted.push_str("\\\""),
            '\\' => quoted.push_str("\\\\"),
            '\n' => quoted.push_str("\\n"),
            other if other.is_control() => quoted.push(' '),
            // Labels can have character entities, so an ampersand is written as one.
            '&' => quoted.push_str("&amp;"),
            other => quoted.push(other),
        }
    }
    quoted.push('"');
    quoted
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        embedded_graph::EmbeddedGraph,
        format::{named_world::NamedWorld, world_file},
    };

    #[test]
    fn doors_and_start_are_marked() {
        let world = "name = \"loop-and-tail\"\n[doors]\nu = [\"a\", \"b\", \"a\"]\nv = [\"b\"]\n\
                     [start]\nat = \"v\"\nfacing = \"b\"";
        let world = world_file::read(world.as_bytes()).unwrap();
        assert_eq!(
            write(&world),
            r#"graph "loop-and-tail" {
  node [shape=circle];
  "u";
  "v" [shape=doublecircle];
  "u" -- "u" [taillabel=0, headlabel=2, label="a"];
  "u" -- "v" [taillabel=1, headlabel=0, label="b", style=bold, dir=back];
}
"#
        );
    }

    #[test]
    fn a_floor_plan_pins_its_junctions() {
        let plan = "[floor]\nhallway_width = 1\n[junctions]\na = [0, 0]\nb = [-4, 0]\n\
                    [[hallways]]\nfrom = \"a\"\nto = \"b\"\n[start]\nat = \"a\"\nfacing = \"b\"";
        let text = write(&world_file::read(plan.as_bytes()).unwrap());
        assert!(text.contains(r#""a" [shape=doublecircle, pos="0,0"];"#), "{text}");
        assert!(text.contains(r#""b" [pos="-72,0"];"#), "{text}");
        assert!(text.contains("style=bold, dir=forward"), "{text}");
    }

    #[test]
    fn names_cannot_break_out_of_their_quotes() {
        let graph = EmbeddedGraph::chain(1);
        let world = NamedWorld::numbered("q\"; x", "1\\N\n2\r&", graph, None);
        let text = write(&world);
        assert!(text.starts_with(r#"graph "q\"; x" {"#), "{text}");
        assert!(text.contains(r#"label="1\\N\n2 &amp;";"#), "{text}");
    }
}
