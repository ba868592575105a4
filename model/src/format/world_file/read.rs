//! Reading a world file: bytes in, a [`NamedWorld`] or an error out.

use std::collections::HashMap;

use super::{WorldFileError, WorldFileErrorKind};
use crate::{
    aid::{AIDS, AidKind},
    embedded_graph::{Dart, EmbeddedGraph, ListError},
    floor_plan::{FloorPlan, FloorPlanError},
    format::{
        document::{
            Document, DocumentEntry, DocumentError, DocumentTable, DocumentValue, TextPosition,
        },
        named_world::{NamedWorld, StartError},
    },
};

/// The clockwise lists of a file: each vertex and its list, in the order of the file.
type Lists<'d> = Vec<(&'d str, Vec<&'d str>)>;

/// Reads a world file: JSON if the first character other than space is a brace, else TOML.
///
/// Vertices and darts are numbered in the order of the file. In a floor plan, junctions are numbered in
/// the order of the file, and the darts of each junction clockwise from north.
///
/// Reading takes at most 512 bytes of memory for each byte of the file, and 4096 besides.
///
/// # Errors
/// Returns an error if the bytes are not a world file. No bytes make it panic.
pub fn read(bytes: &[u8]) -> Result<NamedWorld, WorldFileError> {
    let document = Document::parse(bytes)?;
    let file = document.root().table(&[
        "name",
        "about",
        "clockwise",
        "doors",
        "floor",
        "junctions",
        "hallways",
        "positions",
        "start",
    ])?;
    let name = file.get("name").map(world_name).transpose()?.unwrap_or_default();
    let about = file.get("about").map(DocumentValue::text).transpose()?.unwrap_or_default();
    let mut world = match graph_key(&file)? {
        "clockwise" => by_neighbours(&file.need("clockwise")?.any_table()?)?,
        "doors" => by_edges(&file.need("doors")?.any_table()?)?,
        _ => by_plan(&file)?,
    };
    name.clone_into(&mut world.name);
    about.clone_into(&mut world.about);
    if let Some(value) = file.get("positions") {
        if world.plan.is_some() {
            return Err(value.position().error(WorldFileErrorKind::PositionsOfPlan));
        }
        world.positions = Some(positions(&world, &value.any_table()?)?);
    }
    if let Some(value) = file.get("start") {
        let table = value.table(&["at", "facing", "marker"])?;
        world.start = Some(start(&world, &table)?);
        world.marker = table.get("marker").map(marker).transpose()?;
    }
    Ok(world)
}

/// The one key that gives the graph; `floor` for a floor plan.
fn graph_key(file: &DocumentTable<'_>) -> Result<&'static str, WorldFileError> {
    let is_plan = ["floor", "junctions", "hallways"].iter().any(|key| file.get(key).is_some());
    let mut given = [
        (file.get("clockwise").is_some(), "clockwise"),
        (file.get("doors").is_some(), "doors"),
        (is_plan, "floor"),
    ]
    .into_iter()
    .filter_map(|(is_given, key)| is_given.then_some(key));
    match (given.next(), given.next()) {
        (None, _) => Err(file.position().error(WorldFileErrorKind::NoWorld)),
        (Some(key), None) => Ok(key),
        (Some(one), Some(other)) => {
            Err(file.position().error(WorldFileErrorKind::TwoWorlds { one, other }))
        }
    }
}

fn by_neighbours(table: &DocumentTable<'_>) -> Result<NamedWorld, WorldFileError> {
    let lists = lists(table)?;
    let graph =
        EmbeddedGraph::from_neighbour_lists(&lists).map_err(|error| in_lists(table, error))?;
    Ok(unnamed(graph, lists.iter().map(|(vertex, _)| (*vertex).to_owned()).collect()))
}

fn by_edges(table: &DocumentTable<'_>) -> Result<NamedWorld, WorldFileError> {
    let lists = lists(table)?;
    let graph = EmbeddedGraph::from_edge_lists(&lists).map_err(|error| in_lists(table, error))?;
    let vertex_names = lists.iter().map(|(vertex, _)| (*vertex).to_owned()).collect();
    let edge_names = lists.iter().flat_map(|(_, edges)| edges).map(|edge| (*edge).to_owned());
    Ok(NamedWorld { edge_names: Some(edge_names.collect()), ..unnamed(graph, vertex_names) })
}

fn lists<'d>(table: &DocumentTable<'d>) -> Result<Lists<'d>, WorldFileError> {
    let list = |entry: DocumentEntry<'d>| {
        let names = entry.value.list("a list of names")?.map(name).collect::<Result<_, _>>()?;
        Ok((key_name(&entry)?, names))
    };
    table.entries().map(list).collect()
}

fn by_plan(file: &DocumentTable<'_>) -> Result<NamedWorld, WorldFileError> {
    let floor = file.need("floor")?.table(&["hallway_width"])?;
    let hallway_width = floor.need("hallway_width")?.number()?;
    let junction = |entry: DocumentEntry<'_>| {
        let [x, y] = entry.value.array("a list of two numbers, x and y")?;
        Ok((key_name(&entry)?.to_owned(), [x.number()?, y.number()?]))
    };
    let junctions = file.need("junctions")?.any_table()?.entries().map(junction);
    let junctions = junctions.collect::<Result<Vec<_>, WorldFileError>>()?;
    let hallway = |value: DocumentValue<'_>| {
        let hallway = value.table(&["from", "to"])?;
        let end = |key| Ok::<_, WorldFileError>(name(hallway.need(key)?)?.to_owned());
        Ok((end("from")?, end("to")?))
    };
    let hallways = file.need("hallways")?.list("a list of hallways")?.map(hallway);
    let hallways = hallways.collect::<Result<Vec<_>, WorldFileError>>()?;
    let plan = FloorPlan::new(hallway_width, &junctions, &hallways)
        .map_err(|error| in_plan(file, error))?;
    let (vertex_names, positions): (_, Vec<_>) = junctions.into_iter().unzip();
    Ok(NamedWorld {
        positions: Some(positions),
        plan: Some(plan.clone()),
        ..unnamed(plan.graph().clone(), vertex_names)
    })
}

fn positions(
    world: &NamedWorld,
    table: &DocumentTable<'_>,
) -> Result<Vec<[f64; 2]>, WorldFileError> {
    let mut positions = vec![None; world.vertex_names.len()];
    let numbers: HashMap<&str, usize> =
        (0..).zip(&world.vertex_names).map(|(n, name)| (&**name, n)).collect();
    for entry in table.entries() {
        let Some(&vertex) = numbers.get(entry.key) else {
            let vertex = entry.key.escape_debug().to_string();
            return Err(entry.position().error(WorldFileErrorKind::NoVertex { vertex }));
        };
        let [x, y] = entry.value.array("a list of two numbers, x and y")?;
        positions[vertex] = Some([x.number()?, y.number()?]);
    }
    let given = positions.into_iter().zip(&world.vertex_names).map(|(position, vertex)| {
        let missing = || WorldFileErrorKind::NoPosition { vertex: vertex.clone() };
        position.ok_or_else(|| table.position().error(missing()))
    });
    given.collect()
}

fn start(world: &NamedWorld, start: &DocumentTable<'_>) -> Result<Dart, WorldFileError> {
    let (at, facing) = (start.need("at")?, start.need("facing")?);
    world.start_from_names(at.text()?, facing.text()?).map_err(|error| {
        let wrong = match error {
            StartError::UnknownVertex { .. } => at,
            _ => facing,
        };
        wrong.position().error(WorldFileErrorKind::from(error))
    })
}

fn marker(name: DocumentValue<'_>) -> Result<AidKind, DocumentError> {
    name.word(&AIDS.map(|aid| (aid.name(), aid)))
}

fn unnamed(graph: EmbeddedGraph, vertex_names: Vec<String>) -> NamedWorld {
    NamedWorld { vertex_names, ..NamedWorld::numbered("", "", graph, None) }
}

fn in_lists(table: &DocumentTable<'_>, error: ListError) -> WorldFileError {
    // The vertex, and the wrong name in its list, after so many others like it.
    let (vertex, name, skip) = match &error {
        ListError::UnknownNeighbour { vertex, neighbour, .. }
        | ListError::OneSided { vertex, neighbour } => (Some(vertex.as_str()), Some(neighbour), 0),
        ListError::RepeatedNeighbour { vertex, neighbour } => {
            (Some(vertex.as_str()), Some(neighbour), 1)
        }
        ListError::OwnNeighbour { vertex } => (Some(vertex.as_str()), Some(vertex), 0),
        ListError::VertexTwice { vertex } | ListError::NotConnected { vertex, .. } => {
            (Some(vertex.as_str()), None, 0)
        }
        ListError::NotTwoEnds { edge, .. } => (None, Some(edge), 0),
        ListError::GraphError(_) => (None, None, 0),
    };
    let item = name.and_then(|name| position_in_list(table, vertex, name, skip));
    let position = item.unwrap_or_else(|| position_of_key(table, vertex));
    position.error(WorldFileErrorKind::from(error))
}

fn in_plan(file: &DocumentTable<'_>, error: FloorPlanError) -> WorldFileError {
    let table = |key| file.get(key).and_then(|value| value.any_table().ok());
    let key_in = |key, inner| table(key).map(|table| position_of_key(&table, inner));
    let position = match &error {
        FloorPlanError::HallwayWidth { .. } => key_in("floor", Some("hallway_width")),
        FloorPlanError::Position { junction, .. } | FloorPlanError::JunctionTwice { junction } => {
            key_in("junctions", Some(junction))
        }
        FloorPlanError::TooClose { .. } => key_in("junctions", None),
        FloorPlanError::UnknownJunction { number, .. } => {
            let mut list = file.get("hallways").and_then(|value| value.list("").ok());
            list.as_mut().and_then(|list| list.nth(*number)).map(DocumentValue::position)
        }
        FloorPlanError::NoLength { junction } => position_of_hallway(file, [junction; 2], 0),
        FloorPlanError::NotAlongAxis { from, to } | FloorPlanError::OnHallway { from, to, .. } => {
            position_of_hallway(file, [from, to], 0)
        }
        FloorPlanError::HallwayTwice { from, to } => position_of_hallway(file, [from, to], 1),
        FloorPlanError::SameDirection { junction, other, .. } => {
            position_of_hallway(file, [junction, other], 0)
        }
        FloorPlanError::Cross { other, .. } | FloorPlanError::FloorsMeet { other, .. } => {
            position_of_hallway(file, other.each_ref(), 0)
        }
        FloorPlanError::NotAKind { junction, .. } => key_in("junctions", Some(junction)),
        FloorPlanError::Graph(ListError::NotConnected { vertex, .. }) => {
            key_in("junctions", Some(vertex))
        }
        FloorPlanError::Graph(_) => file.get("hallways").map(DocumentValue::position),
    };
    position.unwrap_or_default().error(WorldFileErrorKind::from(Box::new(error)))
}

/// Where the hallway between two junctions is, after `skip` others between them.
fn position_of_hallway(
    file: &DocumentTable<'_>,
    ends: [&String; 2],
    skip: usize,
) -> Option<TextPosition> {
    let is_between = |hallway: &DocumentValue<'_>| {
        let table = hallway.any_table().ok()?;
        let end = |key| table.get(key)?.text().ok();
        let found = [end("from")?, end("to")?];
        let [one, other] = ends.map(String::as_str);
        Some(found == [one, other] || found == [other, one])
    };
    let list = file.get("hallways")?.list("").ok()?;
    list.filter(|item| is_between(item) == Some(true)).nth(skip).map(DocumentValue::position)
}

/// Where a name stands in the list of a vertex, or of any vertex, for the time after `skip` times.
fn position_in_list(
    table: &DocumentTable<'_>,
    vertex: Option<&str>,
    name: &str,
    skip: usize,
) -> Option<TextPosition> {
    let lists = table.entries().filter(|entry| vertex.is_none_or(|vertex| entry.key == vertex));
    let items = lists.filter_map(|entry| entry.value.list("").ok()).flatten();
    items.filter(|item| item.text() == Ok(name)).nth(skip).map(DocumentValue::position)
}

/// Where a key of a table is; where the table is, if there is no such key.
fn position_of_key(table: &DocumentTable<'_>, key: Option<&str>) -> TextPosition {
    let entry = table.entries().find(|entry| Some(entry.key) == key);
    entry.map_or_else(|| table.position(), |entry| entry.position())
}

fn world_name(value: DocumentValue<'_>) -> Result<&str, WorldFileError> {
    match value.text() {
        Ok("") => Ok(""),
        _ => name(value),
    }
}

fn name(value: DocumentValue<'_>) -> Result<&str, WorldFileError> {
    let text = value.text().map_err(|_| value.expected("a name"))?;
    if is_name(text) { Ok(text) } else { Err(value.position().error(not_a_name(text))) }
}

fn key_name<'d>(entry: &DocumentEntry<'d>) -> Result<&'d str, WorldFileError> {
    if is_name(entry.key) {
        Ok(entry.key)
    } else {
        Err(entry.position().error(not_a_name(entry.key)))
    }
}

/// Whether a text can be a name in a world file: printable characters, but no quotes, no `/` and no `\`,
/// and no space at its ends.
pub fn is_name(text: &str) -> bool {
    // All that is not printable is escaped, and so are `'`, `"` and `\`.
    let printable = text.escape_debug().eq(text.chars());
    printable && !text.is_empty() && !text.contains(['`', '/']) && text.trim() == text
}

fn not_a_name(name: &str) -> WorldFileErrorKind {
    WorldFileErrorKind::NotAName { name: name.escape_debug().to_string() }
}
