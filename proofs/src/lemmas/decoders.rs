//! The decoders: any input gives an error or a world, and the world, written again, reads as the same
//! world. Section 2.1.

use toposlam_model::{
    embedded_graph::EmbeddedGraph,
    format::{
        named_world::NamedWorld,
        plantri::{self, PlantriCode, PlantriError},
        world_file,
    },
};

use crate::{
    choose::{CaseResult, Choose, Exhibit, Stop, claim},
    definition::{is_simple, is_world},
    draw,
    lemma::declare,
};

declare! {
    every_world_is_read_as_it_was_written {
        "Every world, written in any format that can represent it, reads as the same world: a \
         world file in TOML or JSON, edge_code with its edges numbered in any order, planar_code \
         with numbers of one byte or of two.",
        paper "2.1",
        // For each start with m edges 2 m facing darts: 2 2 + 10 4 2 + 74 6 6 + 706 8 24 orders.
        exhaustive "every start with up to 4 edges, facing any dart, its edges in any \
                    order", 138_300 cases:
            written_and_read::<_, 1, 4>;
        sampled "starts with up to 120 edges, edges of one byte or of two":
            written_and_read::<_, 1, 120>;
    }
    planar_code_is_an_error_or_worlds {
        "Any bytes, read as planar_code, give an error or simple worlds; written again, the worlds \
         give the same bytes.",
        paper "2.1",
        // The powers of 4 from 0 to 10.
        exhaustive "up to 10 bytes from 0 to 3", 1_398_101 cases: planar_code::<_, 10, 4>;
        sampled "any 60 bytes, read and not written": only_read::<_, 60, 0>;
        kani "any 5 bytes, read and not written", unwind 9: only_read::<_, 5, 0>;
        symbolic "any 5 bytes, read and not written": only_read::<_, 5, 0>;
    }
    wide_planar_code_is_an_error_or_worlds {
        "Any bytes, read as planar_code with numbers of two bytes, give an error or simple worlds; \
         written again, they read as the same worlds.",
        paper "2.1",
        // The powers of 3 from 0 to 11.
        exhaustive "up to 11 bytes from 0 to 2, after a header with the byte order", 265_720 cases:
            wide_planar_code::<_, 11, 3>;
    }
    edge_code_is_an_error_or_worlds {
        "Any bytes, read as edge_code, give an error or worlds; written again, they read as the \
         same worlds.",
        paper "2.1",
        // The powers of 7 from 0 to 7.
        exhaustive "up to 7 bytes: 0 to 5, and 255", 960_800 cases: edge_code::<_, 7, 6>;
        sampled "any 60 bytes, read and not written": only_read::<_, 60, 1>;
        kani "any 4 bytes, read and not written", unwind 9: only_read::<_, 4, 1>;
        symbolic "any 4 bytes, read and not written": only_read::<_, 4, 1>;
    }
    neighbour_lists_are_an_error_or_a_world {
        "Lists of neighbours are accepted exactly if each name stands for one vertex, each \
         neighbour is another vertex, appears once, and has the vertex as its neighbour, and all \
         vertices are connected; then the graph has the neighbours in this order.",
        paper "2.1",
        // 1 + 85 + 2 (85^2 + 85^3), as there are 85 lists.
        exhaustive "up to 3 lists of up to 3 of 4 names, the last perhaps with the first one's \
                    name", 1_242_786 cases:
            neighbour_lists::<_>;
    }
    edge_lists_are_an_error_or_a_world {
        "Lists of edges are accepted exactly if each name stands for one vertex, each edge appears \
         twice, and all vertices are connected; then the graph has the edges in this order.",
        paper "2.1",
        // 1 + 40 + 2 (40^2 + 40^3), as there are 40 lists.
        exhaustive "up to 3 lists of up to 3 of 3 names, the last perhaps with the first one's \
                    name", 131_241 cases:
            edge_lists::<_>;
    }
    world_files_are_an_error_or_a_world {
        "A world file gives an error or a world; written again, in TOML or in JSON, it reads as \
         the same world, and is written the same again.",
        paper "2.1",
        // 2 tables, 1 + 13 + 2 (13^2 + 13^3) lists, and 1 + 3 5 ways to give a start or none.
        exhaustive "up to 3 lists of up to 2 of 3 names, the last perhaps with the first one's \
                    name, of neighbours or of doors, any start or none", 151_872 cases:
            world_files::<_>;
    }
}

/// Up to `MOST` bytes: the numbers below `LETTERS`, and `also`.
fn bytes<const MOST: usize, const LETTERS: u8>(choose: &mut impl Choose, also: u8) -> Vec<u8> {
    let length = choose.below(MOST as u8 + 1);
    let letters = LETTERS + u8::from(also >= LETTERS);
    let letter = |choose: u8| if choose < LETTERS { choose } else { also };
    let bytes: Vec<_> = (0..length).map(|_| letter(choose.below(letters))).collect();
    choose.show(|| Exhibit::Value { name: "bytes", value: format!("{bytes:?}") });
    bytes
}

/// The worlds read from some bytes, each of them valid, and the error after them, if there is one.
pub(crate) fn worlds(
    bytes: &[u8],
    code: PlantriCode,
) -> Result<(Vec<EmbeddedGraph>, Option<PlantriError>), Stop> {
    let mut worlds = Vec::with_capacity(bytes.len());
    let mut read = plantri::read_headerless(bytes, code);
    while let Some(world) = read.next() {
        match world {
            Ok(world) => {
                claim("what is read is a world", is_world(&world))?;
                worlds.push(world);
            }
            Err(error) => {
                claim("the place of the error is there", error.offset <= bytes.len())?;
                claim("the world with the error is counted", error.world == worlds.len() + 1)?;
                claim("nothing is read after an error", read.next().is_none())?;
                return Ok((worlds, Some(error)));
            }
        }
    }
    claim("there is a world, or an error", !worlds.is_empty())?;
    Ok((worlds, None))
}

/// A plantri file reads as these worlds.
pub(crate) fn reads_as(file: &[u8], worlds: &[EmbeddedGraph]) -> CaseResult {
    let read: Vec<_> = plantri::read(file).collect();
    let same = read.len() == worlds.len()
        && worlds.iter().zip(&read).all(|(world, read)| read.as_ref() == Ok(world));
    claim("what is written reads as the same worlds", same)
}

/// The worlds, written, and read again.
fn again(worlds: &[EmbeddedGraph], code: PlantriCode) -> Result<Vec<u8>, Stop> {
    let Ok(written) = plantri::write(worlds, code) else {
        return Err(Stop::Fails("what was read can be written"));
    };
    reads_as(&written, worlds)?;
    Ok(written)
}

/// The world, written as TOML and as JSON, reads as the same world.
pub(crate) fn is_read_as_written(world: &NamedWorld) -> CaseResult {
    for file in [world_file::to_toml(world), world_file::to_json_text(world)] {
        let read = world_file::read(file.as_bytes());
        claim("a world file reads as the same world", read.as_ref() == Ok(world))?;
    }
    Ok(())
}

fn planar_code<C: Choose, const MOST: usize, const LETTERS: u8>(choose: &mut C) -> CaseResult {
    let bytes = bytes::<MOST, LETTERS>(choose, 0);
    let (worlds, error) = worlds(&bytes, PlantriCode::Planar)?;
    if error.is_some() {
        return Ok(());
    }
    claim("the worlds are simple", worlds.iter().all(is_simple))?;
    // A number of vertices 0 begins a world of two-byte numbers.
    if bytes[0] == 0 {
        return Ok(());
    }
    let written = again(&worlds, PlantriCode::Planar)?;
    let body = written.strip_prefix(b">>planar_code<<");
    claim("writing gives the bytes back", body == Some(bytes.as_slice()))
}

fn wide_planar_code<C: Choose, const MOST: usize, const LETTERS: u8>(choose: &mut C) -> CaseResult {
    let file = [b">>planar_code be<<", bytes::<MOST, LETTERS>(choose, 0).as_slice()].concat();
    let (worlds, error) = worlds(&file, PlantriCode::Planar)?;
    claim("the worlds are simple", worlds.iter().all(is_simple))?;
    if error.is_none() { again(&worlds, PlantriCode::Planar).map(drop) } else { Ok(()) }
}

fn edge_code<C: Choose, const MOST: usize, const LETTERS: u8>(choose: &mut C) -> CaseResult {
    let (worlds, error) = worlds(&bytes::<MOST, LETTERS>(choose, 255), PlantriCode::Edge)?;
    if error.is_none() { again(&worlds, PlantriCode::Edge).map(drop) } else { Ok(()) }
}

/// Any bytes are read without a panic, as no more worlds than bytes.
fn only_read<C: Choose, const LENGTH: usize, const EDGE_CODE: u8>(choose: &mut C) -> CaseResult {
    let mut bytes = [0; LENGTH];
    let mut place = 0;
    while place < LENGTH {
        bytes[place] = draw::byte(choose);
        place += 1;
    }
    let code = if EDGE_CODE == 1 { PlantriCode::Edge } else { PlantriCode::Planar };
    let mut read = plantri::read_headerless(&bytes, code);
    let mut count = 0;
    while count <= LENGTH {
        match read.next() {
            Some(Ok(world)) => claim("a world has an edge", world.edge_count() > 0)?,
            Some(Err(_)) => return Ok(()),
            None => return claim("there is a world, or an error", count > 0),
        }
        count += 1;
    }
    claim("a world takes a byte", false)
}

// paper: world.embedding
fn written_and_read<C: Choose, const LEAST: usize, const MOST: usize>(
    choose: &mut C,
) -> CaseResult {
    let graph = draw::start_of::<LEAST, MOST>(choose)?;
    let world = NamedWorld::numbered("case", "", graph, None);
    let world = NamedWorld { start: Some(draw::dart(choose, &world.graph)), ..world };
    is_read_as_written(&world)?;
    let graph = &world.graph;
    let reads = |file: &[u8], code| {
        let read: Vec<_> = plantri::read_headerless(file, code).collect();
        read.len() == 1 && read[0].as_ref() == Ok(graph)
    };
    let file = plantri::write(std::slice::from_ref(graph), PlantriCode::Edge);
    let is_read = file.is_ok_and(|file| reads(&file, PlantriCode::Edge));
    claim("edge_code as it is written reads as the same world", is_read)?;
    // By hand, the edges in any order, each of one byte if they fit, otherwise of two.
    let order = draw::permutation::<MOST>(choose, graph.edge_count());
    let mut edge_of = vec![0; graph.dart_count()];
    for ((dart, other), &edge) in graph.edges().zip(&order) {
        (edge_of[dart.at()], edge_of[other.at()]) = (edge, edge);
    }
    for size in [1, 2] {
        let mut body = Vec::new();
        for vertex in graph.vertices() {
            if vertex.0 > 0 {
                body.push(255);
            }
            for dart in graph.darts_of(vertex) {
                body.extend(&edge_of[dart.at()].to_be_bytes()[4 - size..]);
            }
        }
        let length = (body.len() as u16).to_be_bytes();
        let head = match size {
            1 if body.len() < 256 => vec![length[1]],
            size => vec![0, 0x20 | size as u8, length[0], length[1]],
        };
        let file = [head, body].concat();
        claim("edge_code by hand reads as the same world", reads(&file, PlantriCode::Edge))?;
    }
    let file = plantri::write(std::slice::from_ref(graph), PlantriCode::Planar);
    claim("planar_code represents simple worlds", file.is_ok() == is_simple(graph))?;
    let Ok(file) = file else { return Ok(()) };
    claim("planar_code reads as the same world", reads(&file, PlantriCode::Planar))?;
    let mut numbers = vec![0, graph.vertex_count() as u16];
    for vertex in graph.vertices() {
        let far =
            graph.darts_of(vertex).map(|dart| graph.vertex(graph.opposite(dart)).0 as u16 + 1);
        numbers.extend(far.chain([0]));
    }
    let after_first_byte = |bytes: Vec<u8>| bytes[1..].to_vec();
    let big = after_first_byte(numbers.iter().flat_map(|number| number.to_be_bytes()).collect());
    let little = after_first_byte(numbers.iter().flat_map(|number| number.to_le_bytes()).collect());
    for (header, wide) in [(&b">>planar_code be<<"[..], big), (b">>planar_code le<<", little)] {
        let is_read = reads(&[header, &wide].concat(), PlantriCode::Planar);
        claim("planar_code of two-byte numbers reads as the same world", is_read)?;
    }
    Ok(())
}

/// Names of vertices and edges.
const NAMES: [&str; 4] = ["a", "b", "c", "d"];

/// Named lists of names.
type Lists = Vec<(&'static str, Vec<&'static str>)>;

/// Up to `MOST` vertices, each with a list of up to `LONGEST` of the first `names` names. The last
/// vertex may bear the name of the first.
fn lists<const MOST: u8, const LONGEST: u8>(choose: &mut impl Choose, names: u8) -> Lists {
    let vertices = choose.below(MOST + 1);
    let repeated = vertices > 1 && choose.below(2) == 1;
    let mut lists = Lists::new();
    for vertex in 0..vertices {
        let name = if repeated && vertex + 1 == vertices { 0 } else { vertex.into() };
        let length = choose.below(LONGEST + 1);
        let list = (0..length).map(|_| NAMES[usize::from(choose.below(names))]).collect();
        lists.push((NAMES[name], list));
    }
    choose.show(|| Exhibit::Value { name: "lists", value: format!("{lists:?}") });
    lists
}

fn named_once(lists: &Lists) -> bool {
    let is_first = |(place, (name, _)): (usize, &(&str, _))| {
        lists.iter().position(|(other, _)| other == name) == Some(place)
    };
    lists.iter().enumerate().all(is_first)
}

/// Whether all vertices can be reached from the first; `joined` says whether two are neighbours.
fn all_reached(lists: &Lists, joined: impl Fn(usize, usize) -> bool) -> bool {
    let mut reached = vec![0];
    let mut next = 0;
    while let Some(&vertex) = reached.get(next) {
        next += 1;
        for other in 0..lists.len() {
            if joined(vertex, other) && !reached.contains(&other) {
                reached.push(other);
            }
        }
    }
    reached.len() == lists.len()
}

fn neighbour_lists<C: Choose>(choose: &mut C) -> CaseResult {
    let lists = lists::<3, 3>(choose, 4);
    let list_of = |name: &str| lists.iter().find(|(vertex, _)| *vertex == name);
    let are_mutual = lists.iter().all(|(vertex, list)| {
        list.iter().enumerate().all(|(place, neighbour)| {
            neighbour != vertex
                && !list[..place].contains(neighbour)
                && list_of(neighbour).is_some_and(|(_, theirs)| theirs.contains(vertex))
        })
    });
    let joined = |one: usize, other: usize| lists[one].1.contains(&lists[other].0);
    let is_one = !lists.is_empty()
        && lists.iter().any(|(_, list)| !list.is_empty())
        && named_once(&lists)
        && are_mutual
        && all_reached(&lists, joined);
    match EmbeddedGraph::from_neighbour_lists(&lists) {
        Err(_) => claim("what is refused is none", !is_one),
        Ok(graph) => {
            claim("what is accepted is one", is_one && is_world(&graph))?;
            let found = graph.vertices().map(|vertex| {
                let far = graph.darts_of(vertex).map(|dart| graph.vertex(graph.opposite(dart)));
                (lists[vertex.at()].0, far.map(|far| lists[far.at()].0).collect())
            });
            claim("the graph has them in this order", found.collect::<Lists>() == lists)
        }
    }
}

fn edge_lists<C: Choose>(choose: &mut C) -> CaseResult {
    let lists = lists::<3, 3>(choose, 3);
    let ends: Vec<&str> = lists.iter().flat_map(|(_, list)| list.iter().copied()).collect();
    let is_twice = |edge: &&str| ends.iter().filter(|end| *end == edge).count() == 2;
    let joined =
        |one: usize, other: usize| lists[one].1.iter().any(|edge| lists[other].1.contains(edge));
    let is_one = !ends.is_empty()
        && ends.iter().all(is_twice)
        && named_once(&lists)
        && all_reached(&lists, joined);
    match EmbeddedGraph::from_edge_lists(&lists) {
        Err(_) => claim("what is refused is none", !is_one),
        Ok(graph) => {
            claim("what is accepted is one", is_one && is_world(&graph))?;
            let degrees = graph.vertices().map(|vertex| graph.degree(vertex) as usize);
            let have = degrees.eq(lists.iter().map(|(_, list)| list.len()))
                && graph.edges().all(|(dart, other)| ends[dart.at()] == ends[other.at()]);
            claim("the graph has them in this order", have)
        }
    }
}

fn world_files<C: Choose>(choose: &mut C) -> CaseResult {
    let table = ["clockwise", "doors"][usize::from(choose.below(2))];
    let lists = lists::<3, 2>(choose, 3);
    let mut text = format!("[{table}]\n");
    text.extend(lists.iter().map(|(vertex, list)| format!("{vertex} = {list:?}\n")));
    let names: [&str; 5] = ["a", "b", "c", "a:1", "b:2"];
    if choose.below(2) == 1 {
        let at = names[usize::from(choose.below(3))];
        let facing = names[usize::from(choose.below(5))];
        text.extend([format!("[start]\nat = {at:?}\nfacing = {facing:?}\n")]);
    }
    choose.show(|| Exhibit::Value { name: "file", value: text.clone() });
    let Ok(world) = world_file::read(text.as_bytes()) else { return Ok(()) };
    claim("what is read is a world", is_world(&world.graph))?;
    is_read_as_written(&world)?;
    let again = world_file::read(world_file::to_json_text(&world).as_bytes());
    let same = again.is_ok_and(|again| world_file::to_toml(&again) == world_file::to_toml(&world));
    claim("it is written the same again", same)
}
