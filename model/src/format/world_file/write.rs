//! Writing a world file: one line per vertex, in the order of the world. Reading it gives the same
//! world.

use serde_json::{Map, Value, json};

use crate::{embedded_graph::Dart, floor_plan::FloorPlan, format::named_world::NamedWorld};

/// The world as a JSON value of the shape of a world file, for printing or reports.
pub fn to_json(world: &NamedWorld) -> Value {
    let mut file = Map::new();
    for (key, text) in [("name", &world.name), ("about", &world.about)] {
        if !text.is_empty() {
            file.insert(key.to_owned(), json!(text));
        }
    }
    match (&world.plan, &world.edge_names) {
        (Some(plan), _) => file.append(&mut plan_tables(plan)),
        (None, Some(_)) => drop(file.insert("doors".to_owned(), lists(world))),
        (None, None) => drop(file.insert("clockwise".to_owned(), lists(world))),
    }
    if let (Some(positions), None) = (&world.positions, &world.plan) {
        let positions = world.vertex_names.iter().zip(positions);
        let positions = positions.map(|(name, position)| (name.clone(), json!(position)));
        file.insert("positions".to_owned(), Value::Object(positions.collect()));
    }
    if let Some(dart) = world.start {
        file.insert("start".to_owned(), start(world, dart));
    }
    Value::Object(file)
}

pub fn to_toml(world: &NamedWorld) -> String {
    let mut first = String::new();
    let mut tables = Vec::new();
    for (key, value) in object(&to_json(world)) {
        match value {
            Value::Object(_) => tables.push(format!("[{key}]\n{}", toml_entries(value))),
            Value::Array(items) => {
                let items = items.iter();
                tables.extend(items.map(|item| format!("[[{key}]]\n{}", toml_entries(item))));
            }
            text => first.push_str(&toml_entry(key, text)),
        }
    }
    let parts = Some(first).filter(|first| !first.is_empty()).into_iter();
    parts.chain(tables).collect::<Vec<_>>().join("\n")
}

fn toml_entries(table: &Value) -> String {
    let entries = object(table);
    entries.map(|(key, value)| toml_entry(key, value)).collect()
}

/// One line. JSON allows the character DEL in a text, TOML does not; everything else that JSON writes in
/// a list, a text or a number means the same in TOML. A key with other characters than these is quoted.
fn toml_entry(key: &str, value: &Value) -> String {
    let is_bare = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_' || byte == b'-';
    let key = if key.bytes().all(is_bare) { key.to_owned() } else { json!(key).to_string() };
    format!("{key} = {}\n", inline(value).replace('\x7f', "\\u007f"))
}

pub fn to_json_text(world: &NamedWorld) -> String {
    let file = to_json(world);
    let entries: Vec<String> = object(&file)
        .map(|(key, value)| match value {
            Value::Object(table) => {
                let lines =
                    table.iter().map(|(key, value)| format!("{}: {}", json!(key), inline(value)));
                block(key, '{', lines, '}')
            }
            Value::Array(tables) => block(key, '[', tables.iter().map(inline), ']'),
            scalar => format!("  {}: {}", json!(key), inline(scalar)),
        })
        .collect();
    format!("{{\n{}\n}}\n", entries.join(",\n"))
}

/// A key with a value, one line for each part of the value.
fn block(key: &str, open: char, lines: impl Iterator<Item = String>, close: char) -> String {
    let lines: Vec<String> = lines.map(|line| format!("    {line}")).collect();
    let key = json!(key);
    format!("  {key}: {open}\n{}\n  {close}", lines.join(",\n"))
}

/// A value in one line, with a space after each comma and colon. It is the same in JSON and TOML,
/// except for tables, which are only in JSON.
fn inline(value: &Value) -> String {
    match value {
        Value::Array(items) => {
            let items: Vec<String> = items.iter().map(inline).collect();
            format!("[{}]", items.join(", "))
        }
        Value::Object(table) => {
            let entries =
                table.iter().map(|(key, value)| format!("{}: {}", json!(key), inline(value)));
            format!("{{{}}}", entries.collect::<Vec<_>>().join(", "))
        }
        scalar => scalar.to_string(),
    }
}

fn object(value: &Value) -> impl Iterator<Item = (&String, &Value)> {
    value.as_object().into_iter().flatten()
}

fn start(world: &NamedWorld, dart: Dart) -> Value {
    let mut start = json!({ "at": world.at_text(dart), "facing": world.facing_text(dart) });
    if let Some(marker) = world.marker {
        start["marker"] = json!(marker.name());
    }
    start
}

fn lists(world: &NamedWorld) -> Value {
    let lists = world.graph.vertices().zip(&world.vertex_names);
    let lists = lists.map(|(vertex, name)| {
        let darts = world.graph.darts_of(vertex);
        (name.clone(), darts.map(|dart| json!(world.leads_to(dart))).collect())
    });
    Value::Object(lists.collect())
}

fn plan_tables(plan: &FloorPlan) -> Map<String, Value> {
    let name = |vertex| plan.junction(vertex).name.as_str();
    let junctions: Map<_, _> = plan
        .junctions()
        .iter()
        .map(|junction| (junction.name.clone(), json!(junction.position)))
        .collect();
    let hallways: Vec<_> = plan
        .hallways()
        .iter()
        .map(|hallway| json!({ "from": name(hallway.from), "to": name(hallway.to) }))
        .collect();
    let floor = json!({ "hallway_width": plan.hallway_width() });
    let tables = [
        ("floor", floor),
        ("junctions", Value::Object(junctions)),
        ("hallways", Value::Array(hallways)),
    ];
    tables.map(|(key, table)| (key.to_owned(), table)).into_iter().collect()
}
