//! Reading a world file: bytes in, a [`NamedWorld`] out, or the one thing that is wrong.

use super::{
    error::{Cause, WorldFileError},
    tree::Tree,
};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph, ListError},
    floor_plan::{FloorPlan, FloorPlanError},
    format::named_world::{NamedWorld, StartError},
};

/// The clockwise lists of a file: each vertex and what it lists, in the order of the file.
type Lists = Vec<(String, Vec<String>)>;

/// Reads a world file: JSON where the first character that is no space is a brace, else TOML.
///
/// Vertices and darts are numbered in the order of the file; those of a floor plan in the order of
/// its junctions, and at each junction clockwise from north.
///
/// Reading takes at most 512 bytes of memory for each byte of the file, and 4096 besides.
///
/// # Errors
/// The first thing that is wrong, with its place. No bytes make it panic.
pub fn read(bytes: &[u8]) -> Result<NamedWorld, WorldFileError> {
    const KEYS: [&str; 8] =
        ["name", "about", "clockwise", "doors", "floor", "junctions", "hallways", "start"];
    let mut file = Table::new("", Tree::parse(bytes)?, &KEYS)?;
    let name = match file.take("name") {
        Some(tree) => world_name("name", tree)?,
        None => String::new(),
    };
    let about = match file.take("about") {
        Some(tree) => text("about", tree)?,
        None => String::new(),
    };
    let mut world = match file.told_by()? {
        "clockwise" => by_neighbours(file.take_lists("clockwise")?)?,
        "doors" => by_edges(file.take_lists("doors")?)?,
        _ => by_plan(&mut file)?,
    };
    world.name = name;
    world.about = about;
    if let Some(tree) = file.take("start") {
        world.start = Some(start(&world, tree)?);
    }
    Ok(world)
}

fn by_neighbours(lists: Lists) -> Result<NamedWorld, WorldFileError> {
    let graph = EmbeddedGraph::from_neighbour_lists(&lists)
        .map_err(|error| in_lists("clockwise", error))?;
    let vertex_names = lists.into_iter().map(|(vertex, _)| vertex).collect();
    Ok(unnamed(graph, vertex_names))
}

fn by_edges(lists: Lists) -> Result<NamedWorld, WorldFileError> {
    let graph = EmbeddedGraph::from_edge_lists(&lists).map_err(|error| in_lists("doors", error))?;
    let (vertex_names, edge_names): (_, Vec<_>) = lists.into_iter().unzip();
    Ok(NamedWorld { edge_names: Some(edge_names.concat()), ..unnamed(graph, vertex_names) })
}

fn by_plan(file: &mut Table) -> Result<NamedWorld, WorldFileError> {
    let mut floor = Table::new("floor", file.need("floor")?, &["hallway_width"])?;
    let hallway_width = number("floor.hallway_width", &floor.need("hallway_width")?)?;
    let junctions = entries("junctions", file.need("junctions")?)?
        .into_iter()
        .map(|(name, tree)| {
            let path = format!("junctions.{name}");
            Ok((name, position(&path, tree)?))
        })
        .collect::<Result<Vec<_>, _>>()?;
    let hallways = list("hallways", file.need("hallways")?, "a list of hallways")?
        .into_iter()
        .enumerate()
        .map(|(number, tree)| {
            let path = format!("hallways[{number}]");
            let mut hallway = Table::new(&path, tree, &["from", "to"])?;
            Ok((hallway.need_name("from")?, hallway.need_name("to")?))
        })
        .collect::<Result<Vec<_>, _>>()?;
    let plan = FloorPlan::new(hallway_width, &junctions, &hallways).map_err(in_plan)?;
    let (vertex_names, positions): (_, Vec<_>) = junctions.into_iter().unzip();
    Ok(NamedWorld {
        positions: Some(positions),
        plan: Some(plan.clone()),
        ..unnamed(plan.graph().clone(), vertex_names)
    })
}

/// The dart that `[start]` tells.
fn start(world: &NamedWorld, tree: Tree) -> Result<Dart, WorldFileError> {
    let mut start = Table::new("start", tree, &["at", "facing"])?;
    let at = text("start.at", start.need("at")?)?;
    let facing = text("start.facing", start.need("facing")?)?;
    world.start_from_names(&at, &facing).map_err(|error| match error {
        StartError::UnknownVertex { .. } => Cause::from(error).at("start.at"),
        _ => Cause::from(error).at("start.facing"),
    })
}

fn unnamed(graph: EmbeddedGraph, vertex_names: Vec<String>) -> NamedWorld {
    NamedWorld {
        name: String::new(),
        about: String::new(),
        graph,
        start: None,
        vertex_names,
        edge_names: None,
        positions: None,
        plan: None,
    }
}

/// The place of what is wrong with the lists of a table.
fn in_lists(table: &str, error: ListError) -> WorldFileError {
    let path = match &error {
        ListError::VertexTwice { vertex }
        | ListError::UnknownNeighbour { vertex, .. }
        | ListError::OneSided { vertex, .. }
        | ListError::RepeatedNeighbour { vertex, .. }
        | ListError::OwnNeighbour { vertex } => format!("{table}.{vertex}"),
        ListError::NotTwoEnds { .. }
        | ListError::NotConnected { .. }
        | ListError::GraphError(_) => table.to_owned(),
    };
    Cause::from(error).at(path)
}

/// The place of what is wrong with a floor plan.
fn in_plan(error: FloorPlanError) -> WorldFileError {
    let path = match &error {
        FloorPlanError::HallwayWidth { .. } => "floor.hallway_width".to_owned(),
        FloorPlanError::Position { junction, .. } | FloorPlanError::JunctionTwice { junction } => {
            format!("junctions.{junction}")
        }
        FloorPlanError::TooClose { .. } => "junctions".to_owned(),
        FloorPlanError::UnknownJunction { number, .. } => format!("hallways[{number}]"),
        _ => "hallways".to_owned(),
    };
    Cause::from(Box::new(error)).at(path)
}

/// A table of which only known keys are taken, each once.
struct Table {
    path: String,
    entries: Vec<(String, Option<Tree>)>,
}

impl Table {
    fn new(path: &str, tree: Tree, known: &[&str]) -> Result<Self, WorldFileError> {
        let table = table(path, tree)?;
        for (key, _) in &table {
            if !known.contains(&key.as_str()) {
                let known = known.join(", ");
                return Err(Cause::UnknownKey { known }.at(join(path, key)));
            }
        }
        Ok(Self {
            path: path.to_owned(),
            entries: table.into_iter().map(|(k, v)| (k, Some(v))).collect(),
        })
    }

    fn has(&self, key: &str) -> bool {
        self.entries.iter().any(|(known, _)| known == key)
    }

    fn take(&mut self, key: &str) -> Option<Tree> {
        let (_, tree) = self.entries.iter_mut().find(|(known, _)| known == key)?;
        tree.take()
    }

    fn need(&mut self, key: &'static str) -> Result<Tree, WorldFileError> {
        self.take(key).ok_or_else(|| {
            let cause = Cause::MissingKey { key };
            if self.path.is_empty() { cause.in_file() } else { cause.at(&self.path) }
        })
    }

    fn need_name(&mut self, key: &'static str) -> Result<String, WorldFileError> {
        let tree = self.need(key)?;
        name(&join(&self.path, key), tree)
    }

    /// The one table that tells the graph; `floor` for a floor plan.
    fn told_by(&self) -> Result<&'static str, WorldFileError> {
        let is_plan = ["floor", "junctions", "hallways"].iter().any(|key| self.has(key));
        let mut told = [
            (self.has("clockwise"), "clockwise"),
            (self.has("doors"), "doors"),
            (is_plan, "floor"),
        ]
        .into_iter()
        .filter_map(|(stands, kind)| stands.then_some(kind));
        match (told.next(), told.next()) {
            (None, _) => Err(Cause::NoWorld.in_file()),
            (Some(kind), None) => Ok(kind),
            (Some(one), Some(other)) => Err(Cause::TwoWorlds { one, other }.in_file()),
        }
    }

    fn take_lists(&mut self, key: &'static str) -> Result<Lists, WorldFileError> {
        entries(key, self.need(key)?)?
            .into_iter()
            .map(|(vertex, tree)| {
                let path = join(key, &vertex);
                let names = list(&path, tree, "a list of names")?
                    .into_iter()
                    .map(|tree| name(&path, tree))
                    .collect::<Result<_, _>>()?;
                Ok((vertex, names))
            })
            .collect()
    }
}

fn wrong_kind(path: &str, expected: &'static str, tree: &Tree) -> WorldFileError {
    let found = tree.kind();
    Cause::WrongKind { expected, found }.at(path)
}

fn table(path: &str, tree: Tree) -> Result<Vec<(String, Tree)>, WorldFileError> {
    match tree {
        Tree::Table(entries) => Ok(entries),
        other => Err(wrong_kind(path, "a table", &other)),
    }
}

/// The entries of a table whose keys are names.
fn entries(path: &str, tree: Tree) -> Result<Vec<(String, Tree)>, WorldFileError> {
    let entries = table(path, tree)?;
    match entries.iter().find(|(key, _)| !is_name(key)) {
        Some((key, _)) => Err(not_a_name(path, key)),
        None => Ok(entries),
    }
}

fn list(path: &str, tree: Tree, expected: &'static str) -> Result<Vec<Tree>, WorldFileError> {
    match tree {
        Tree::List(items) => Ok(items),
        other => Err(wrong_kind(path, expected, &other)),
    }
}

fn text(path: &str, tree: Tree) -> Result<String, WorldFileError> {
    match tree {
        Tree::Text(text) => Ok(text),
        other => Err(wrong_kind(path, "a text", &other)),
    }
}

fn name(path: &str, tree: Tree) -> Result<String, WorldFileError> {
    match tree {
        Tree::Text(name) if is_name(&name) => Ok(name),
        Tree::Text(name) => Err(not_a_name(path, &name)),
        other => Err(wrong_kind(path, "a name", &other)),
    }
}

/// A world may be without a name; then the name is empty.
fn world_name(path: &str, tree: Tree) -> Result<String, WorldFileError> {
    match tree {
        Tree::Text(empty) if empty.is_empty() => Ok(empty),
        other => name(path, other),
    }
}

fn number(path: &str, tree: &Tree) -> Result<f64, WorldFileError> {
    match tree {
        Tree::Number(number) => Ok(*number),
        other => Err(wrong_kind(path, "a number", other)),
    }
}

fn position(path: &str, tree: Tree) -> Result<[f64; 2], WorldFileError> {
    const EXPECTED: &str = "a list of two numbers, x and y";
    match list(path, tree, EXPECTED)?.as_slice() {
        [x, y] => Ok([number(path, x)?, number(path, y)?]),
        _ => {
            Err(Cause::WrongKind { expected: EXPECTED, found: "a list of another length" }.at(path))
        }
    }
}

fn is_name(text: &str) -> bool {
    let fits = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_' || byte == b'-';
    !text.is_empty() && text.bytes().all(fits)
}

fn not_a_name(path: &str, name: &str) -> WorldFileError {
    let name = name.escape_debug().to_string();
    Cause::NotAName { name }.at(path)
}

fn join(path: &str, key: &str) -> String {
    let key = key.escape_debug();
    if path.is_empty() { key.to_string() } else { format!("{path}.{key}") }
}
