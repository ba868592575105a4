//! The decoders: whatever they are given, they answer an error or a world, and what is written of it
//! reads as the same world. Section 2.1.

use toposlam_model::{
    embedded_graph::EmbeddedGraph,
    format::{
        plantri::{self, Code},
        world_file,
    },
};

use crate::{
    choose::{Case, Choose, Exhibit, Stop, claim},
    definition::is_world,
    draw,
    lemma::declare,
};

declare! {
    planar_code_is_an_error_or_worlds {
        "Whatever bytes stand for planar_code, each world read of them is a simple one, and writing \
         the worlds gives the bytes back; else there is an error.",
        paper "2.1",
        // The powers of 4 from 0 to 10.
        exhaustive "up to 10 bytes from 0 to 3", 1_398_101 cases: planar_code::<_, 0, 10, 4>;
        kani "any 5 bytes", unwind 19: planar_code::<_, 5, 5, 0>;
    }
    wide_planar_code_is_an_error_or_worlds {
        "The same of planar_code with numbers of two bytes, but that writing may take fewer bytes: the \
         worlds written read as the same worlds.",
        paper "2.1",
        // The powers of 3 from 0 to 11.
        exhaustive "up to 11 bytes from 0 to 2, after a header that tells the order", 265_720 cases:
            wide_planar_code::<_, 11, 3>;
    }
    edge_code_is_an_error_or_worlds {
        "Whatever bytes stand for edge_code, each world read of them is one, and the worlds written \
         read as the same worlds; else there is an error.",
        paper "2.1",
        // The powers of 7 from 0 to 7.
        exhaustive "up to 7 bytes: 0 to 5, and 255", 960_800 cases: edge_code::<_, 0, 7, 6>;
        kani "any 4 bytes", unwind 19: edge_code::<_, 4, 4, 0>;
    }
    neighbour_lists_are_an_error_or_a_world {
        "Lists of neighbours are accepted exactly if each name stands for one vertex, each neighbour \
         is another vertex, stands once, and has the vertex as neighbour, and all are connected; then \
         the graph has them in this order.",
        paper "2.1",
        // 2 (1 + 85 + 85^2 + 85^3), as there are 85 lists.
        exhaustive "up to 3 lists of up to 3 of 4 names", 1_242_872 cases: neighbour_lists::<_>;
    }
    edge_lists_are_an_error_or_a_world {
        "Lists of edges are accepted exactly if each name stands for one vertex, each edge stands \
         twice, and all are connected; then the graph has them in this order.",
        paper "2.1",
        // 2 (1 + 40 + 40^2 + 40^3), as there are 40 lists.
        exhaustive "up to 3 lists of up to 3 of 3 names", 131_282 cases: edge_lists::<_>;
    }
    world_files_are_an_error_or_a_world {
        "A world file is an error or a world, and the file written of it, in TOML or in JSON, reads as \
         the same world and is written the same again.",
        paper "2.1",
        // 2 tables, 2 (1 + 13 + 13^2 + 13^3) lists, and 1 + 3 5 ways to tell a start or none.
        exhaustive "up to 3 lists of up to 2 of 3 names, of neighbours or of doors, any start or none",
            152_320 cases: world_files::<_>;
    }
}

/// Some bytes. Letters are the numbers below `LETTERS`; without letters, bytes are anything.
fn bytes<const LEAST: usize, const MOST: usize, const LETTERS: u8>(
    choose: &mut impl Choose,
    also: Option<u8>,
) -> ([u8; MOST], usize) {
    let length = LEAST + usize::from(choose.below((MOST - LEAST + 1) as u8));
    let mut bytes = [0; MOST];
    let mut place = 0;
    while place < length {
        bytes[place] = match (LETTERS, also) {
            (0, _) => draw::byte(choose),
            (letters, None) => choose.below(letters),
            (letters, Some(also)) => match choose.below(letters + 1) {
                letter if letter < letters => letter,
                _ => also,
            },
        };
        place += 1;
    }
    choose.show(|| Exhibit::Value { name: "bytes", value: format!("{:?}", &bytes[..length]) });
    (bytes, length)
}

/// The worlds read of some bytes, each of which is one; whether they were read to the end.
fn worlds(bytes: &[u8], code: Code) -> Result<(Vec<EmbeddedGraph>, bool), Stop> {
    let mut worlds = Vec::with_capacity(bytes.len());
    let mut read = plantri::read_headerless(bytes, code);
    while let Some(world) = read.next() {
        let Ok(world) = world else {
            claim("nothing is read after an error", read.next().is_none())?;
            return Ok((worlds, false));
        };
        claim("what is read is a world", is_world(&world))?;
        worlds.push(world);
    }
    claim("there is a world, or an error", !worlds.is_empty())?;
    Ok((worlds, true))
}

/// The worlds, written and read again.
fn again(worlds: &[EmbeddedGraph], code: Code) -> Result<Vec<u8>, Stop> {
    let Ok(written) = plantri::write(worlds, code) else {
        return Err(Stop::Fails("what was read can be written"));
    };
    let read: Vec<_> = plantri::read(&written).collect();
    let same = read.len() == worlds.len()
        && worlds.iter().zip(&read).all(|(world, read)| read.as_ref() == Ok(world));
    claim("what is written reads as the same worlds", same)?;
    Ok(written)
}

fn planar_code<C: Choose, const LEAST: usize, const MOST: usize, const LETTERS: u8>(
    choose: &mut C,
) -> Case {
    let (bytes, length) = bytes::<LEAST, MOST, LETTERS>(choose, None);
    let bytes = &bytes[..length];
    let (worlds, is_whole) = worlds(bytes, Code::Planar)?;
    if !is_whole {
        return Ok(());
    }
    claim("the worlds are simple", worlds.iter().all(EmbeddedGraph::is_simple))?;
    // A number of vertices 0 begins a world of two-byte numbers.
    if bytes[0] == 0 {
        return Ok(());
    }
    let written = again(&worlds, Code::Planar)?;
    claim("writing gives the bytes back", written.strip_prefix(b">>planar_code<<") == Some(bytes))
}

fn wide_planar_code<C: Choose, const MOST: usize, const LETTERS: u8>(choose: &mut C) -> Case {
    let (bytes, length) = bytes::<0, MOST, LETTERS>(choose, None);
    let file = [b">>planar_code be<<", &bytes[..length]].concat();
    let (worlds, is_whole) = worlds(&file, Code::Planar)?;
    claim("the worlds are simple", worlds.iter().all(EmbeddedGraph::is_simple))?;
    if is_whole { again(&worlds, Code::Planar).map(drop) } else { Ok(()) }
}

fn edge_code<C: Choose, const LEAST: usize, const MOST: usize, const LETTERS: u8>(
    choose: &mut C,
) -> Case {
    let (bytes, length) = bytes::<LEAST, MOST, LETTERS>(choose, Some(255));
    let (worlds, is_whole) = worlds(&bytes[..length], Code::Edge)?;
    if is_whole { again(&worlds, Code::Edge).map(drop) } else { Ok(()) }
}

/// Names of vertices and edges.
const NAMES: [&str; 4] = ["a", "b", "c", "d"];

/// Named lists of names.
type Lists = Vec<(&'static str, Vec<&'static str>)>;

/// Up to `MOST` vertices, each with a list of up to `LONGEST` of the first `names` names. The last
/// vertex may bear the name of the first.
fn lists<const MOST: u8, const LONGEST: u8>(choose: &mut impl Choose, names: u8) -> Lists {
    let vertices = choose.below(MOST + 1);
    let repeated = choose.below(2) == 1;
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

/// Whether all vertices can be reached from the first, of which `joined` tells whether two are
/// neighbours.
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

fn neighbour_lists<C: Choose>(choose: &mut C) -> Case {
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
            let told = graph.vertices().map(|vertex| {
                let far = graph.darts_of(vertex).map(|dart| graph.vertex(graph.opposite(dart)));
                (lists[vertex.at()].0, far.map(|far| lists[far.at()].0).collect())
            });
            claim("the graph has them in this order", told.collect::<Lists>() == lists)
        }
    }
}

fn edge_lists<C: Choose>(choose: &mut C) -> Case {
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

fn world_files<C: Choose>(choose: &mut C) -> Case {
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
    for written in [world_file::to_toml(&world), world_file::to_json_text(&world)] {
        let read = world_file::read(written.as_bytes());
        claim(
            "what is written reads as the same world",
            read.as_ref().is_ok_and(|read| *read == world),
        )?;
    }
    let again = world_file::read(world_file::to_json_text(&world).as_bytes());
    let same = again.is_ok_and(|again| world_file::to_toml(&again) == world_file::to_toml(&world));
    claim("it is written the same again", same)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is said of all that is read would hold if nothing were.
    #[test]
    fn worlds_are_spelled_within_the_bounds() {
        let triangle = [3, 2, 3, 0, 1, 3, 0, 1, 2, 0];
        assert_eq!(worlds(&triangle, Code::Planar).map(|(worlds, _)| worlds.len()), Ok(1));
        let wide_edge = b">>planar_code be<<\0\0\x02\0\x02\0\0\0\x01\0\0";
        assert_eq!(worlds(wide_edge, Code::Planar).map(|(worlds, _)| worlds.len()), Ok(1));
        let two_parallel_edges = [5, 0, 1, 255, 0, 1];
        assert_eq!(worlds(&two_parallel_edges, Code::Edge).map(|(worlds, _)| worlds.len()), Ok(1));
        let path = vec![("a", vec!["b"]), ("b", vec!["a", "c"]), ("c", vec!["b"])];
        assert!(EmbeddedGraph::from_neighbour_lists(&path).is_ok());
        assert!(
            EmbeddedGraph::from_edge_lists(&[("a", vec!["a", "b", "a"]), ("b", vec!["b"])]).is_ok()
        );
    }
}
