//! GraphML, as yEd, networkx, osmnx and others write it. A node has its position in two numbers, x and y, or in the
//! geometry of yEd.

use std::collections::BTreeMap;

use roxmltree::{Document, Node};

use super::{PlacedEdge, PlacedGraph, PlacedGraphError, PlacedNode, shown};

/// The names of the data of a node that are its position, in lower case: longitudes and latitudes keep the clockwise order.
const X: [&str; 5] = ["x", "pos_x", "lon", "lng", "longitude"];
const Y: [&str; 4] = ["y", "pos_y", "lat", "latitude"];

/// The first graph of a file.
pub(crate) fn read(text: &str) -> Result<PlacedGraph, PlacedGraphError> {
    let document = Document::parse(text).map_err(|error| PlacedGraphError::Syntax {
        line: error.pos().row as usize,
        message: shown(error.to_string()),
    })?;
    let named = |name: &'static str| {
        document.descendants().filter(move |node| node.tag_name().name() == name)
    };
    let keys: BTreeMap<&str, String> = named("key")
        .filter_map(|key| Some((key.attribute("id")?, key.attribute("attr.name")?.to_lowercase())))
        .collect();
    let Some(graph) = named("graph").next() else { return Err(PlacedGraphError::NoNodes) };
    let inside =
        |name: &'static str| graph.descendants().filter(move |node| node.tag_name().name() == name);
    let line = |node: Node<'_, '_>| document.text_pos_at(node.range().start).row as usize;
    let need = |node: Node<'_, '_>, name: &str| {
        let message = format!("<{}> has no attribute `{name}`", shown(node.tag_name().name()));
        let missing = PlacedGraphError::Syntax { line: line(node), message };
        node.attribute(name).map(str::to_owned).ok_or(missing)
    };
    if let Some(hyperedge) = inside("hyperedge").next() {
        let message = "a hyperedge is no edge between two nodes".to_owned();
        return Err(PlacedGraphError::Syntax { line: line(hyperedge), message });
    }
    let nodes = inside("node")
        .map(|node| Ok(PlacedNode { name: need(node, "id")?, position: position(node, &keys) }));
    let nodes = nodes.collect::<Result<_, PlacedGraphError>>()?;
    let is_directed = |edge: Node<'_, '_>| match edge.attribute("directed") {
        Some(directed) => directed == "true",
        None => graph.attribute("edgedefault") == Some("directed"),
    };
    let edges = inside("edge").map(|edge| {
        let ends = [need(edge, "source")?, need(edge, "target")?];
        Ok(PlacedEdge { ends, is_directed: is_directed(edge) })
    });
    let edges = edges.collect::<Result<_, PlacedGraphError>>()?;
    let name = graph.attribute("id").unwrap_or_default().to_owned();
    Ok(PlacedGraph { name, nodes, edges })
}

fn position(node: Node<'_, '_>, keys: &BTreeMap<&str, String>) -> Option<[f64; 2]> {
    let data = |names: &[&str]| {
        let mut data = node.children().filter(|child| child.tag_name().name() == "data");
        let named = data.find(|data| {
            let key = data.attribute("key").unwrap_or_default();
            names.contains(&keys.get(key).map_or(key, String::as_str))
        });
        // What is there and is no number is reported.
        Some(number(named?.text().unwrap_or_default()))
    };
    if let (Some(x), Some(y)) = (data(&X), data(&Y)) {
        return Some([x, y]);
    }
    // In yEd y points down, and the position is a corner of the node.
    let geometry = node.descendants().find(|node| node.tag_name().name() == "Geometry")?;
    let [x, y, width, height] = ["x", "y", "width", "height"].map(|name| geometry.attribute(name));
    let half = |size: Option<&str>| size.map_or(0.0, number) / 2.0;
    Some([number(x?) + half(width), -(number(y?) + half(height))])
}

fn number(text: &str) -> f64 {
    text.trim().parse().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clockwise(text: &str) -> Vec<String> {
        let world = read(text).unwrap().world().unwrap().unwrap();
        let darts = |vertex| world.graph.darts_of(vertex).map(|dart| world.graph.opposite(dart));
        let names = |vertex| {
            let far = darts(vertex).map(|dart| &*world.vertex_names[world.graph.vertex(dart).at()]);
            far.collect::<Vec<_>>().join(" ")
        };
        world.graph.vertices().map(names).collect()
    }

    #[test]
    fn nodes_of_networkx_and_yed_have_positions() {
        let networkx = "<graphml xmlns='http://graphml.graphdrawing.org/xmlns'>
            <key id='d0' for='node' attr.name='x' attr.type='double'/>
            <key id='d1' for='node' attr.name='y' attr.type='double'/>
            <graph edgedefault='undirected'>
            <node id='m'><data key='d0'>0</data><data key='d1'> 0.0 </data></node>
            <node id='e'><data key='d0'>1</data><data key='d1'>0</data></node>
            <node id='n'><data key='d0'>0</data><data key='d1'>1</data></node>
            <node id='w'><data key='d0'>-1</data><data key='d1'>0</data></node>
            <edge source='m' target='w'/><edge source='m' target='n'/><edge source='m' target='e'/>
            </graph></graphml>";
        assert_eq!(clockwise(networkx), ["n e w", "m", "m", "m"]);
        // Down the page is south.
        let node = |id: &str, x: i32, y: i32| {
            format!(
                "<node id='{id}'><data key='d6'><y:ShapeNode><y:Geometry height='30' width='30' \
                 x='{x}' y='{y}'/></y:ShapeNode></data></node>"
            )
        };
        let nodes = [("m", 0, 0), ("e", 90, 0), ("n", 0, -90), ("w", -90, 0)];
        let nodes: String = nodes.iter().map(|&(id, x, y)| node(id, x, y)).collect();
        let edge =
            |to: &str| format!("<edge source='m' target='{to}'/><edge source='{to}' target='m'/>");
        let edges: String = ["w", "n", "e"].map(edge).concat();
        let yed = format!(
            "<graphml xmlns='g' xmlns:y='y'><key for='node' id='d6' yfiles.type='nodegraphics'/>\
             <graph edgedefault='directed' id='G'>{nodes}{edges}</graph></graphml>"
        );
        assert_eq!(clockwise(&yed), ["n e w", "m", "m", "m"]);
    }

    #[test]
    fn what_is_no_graph_is_an_error_with_its_line() {
        for (text, error) in [
            ("<graphml>\n</graph>", "line 2: "),
            ("<graphml/>", "the graph has no nodes"),
            ("<graphml><graph><node/></graph></graphml>", "line 1: <node> has no attribute `id`"),
            ("<graphml><graph>\n<hyperedge/></graph></graphml>", "line 2: a hyperedge"),
        ] {
            let found = read(text).unwrap_err().to_string();
            assert!(found.starts_with(error), "{found}");
        }
        let word = "<graphml><graph><node id='a'><data key='x'>left</data><data key='y'>0</data></node>\
                    </graph></graphml>";
        let found = read(word).unwrap().world().unwrap_err().to_string();
        assert_eq!(found, "the position of node `a` is not a number");
    }
}
