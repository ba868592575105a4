use proptest::{collection::vec, prelude::*};

use super::*;
use crate::{
    any_graph::{Class, any_graph},
    embedded_graph::{Dart, EmbeddedGraph},
};

fn all(bytes: &[u8]) -> Result<Vec<EmbeddedGraph>, PlantriError> {
    read(bytes).collect()
}

fn path(vertices: usize) -> EmbeddedGraph {
    EmbeddedGraph::chain(vertices - 1)
}

/// The example of plantri's source: the octahedron.
const OCTAHEDRON: [u8; 31] =
    [6, 4, 3, 2, 5, 0, 3, 6, 5, 1, 0, 1, 4, 6, 2, 0, 5, 6, 3, 1, 0, 4, 1, 2, 6, 0, 4, 5, 2, 3, 0];

#[test]
fn plantri_s_own_example_is_the_octahedron_in_the_plane() {
    let bytes = [b">>planar_code<<".as_slice(), &OCTAHEDRON].concat();
    let worlds = all(&bytes).unwrap();
    assert_eq!(worlds.len(), 1);
    let graph = &worlds[0];
    assert_eq!((graph.vertex_count(), graph.edge_count()), (6, 12));
    assert_eq!(graph.genus(), 0);
    // The first neighbour of vertex 1 is vertex 4.
    assert_eq!(graph.vertex(graph.opposite(Dart(0))).0 + 1, 4);
    assert_eq!(write(&worlds, PlantriCode::Planar).unwrap(), bytes);
    assert_eq!(all(&OCTAHEDRON).unwrap(), worlds);
}

/// The output of nauty 2.8.6 for the complete graph of four vertices (`geng 4 6:6 | planarg -p`).
const NAUTY: &[u8] = b">>planar_code<<\x04\
    \x02\x04\x03\0\x03\x04\x01\0\x01\x04\x02\0\x01\x02\x03\0";

#[test]
fn nauty_s_complete_graph_lies_in_the_plane() {
    let worlds = all(NAUTY).unwrap();
    assert_eq!((worlds[0].edge_count(), worlds[0].genus()), (6, 0));
    assert_eq!(write(&worlds, PlantriCode::Planar).unwrap(), NAUTY);
}

#[test]
fn headers_may_stand_between_worlds() {
    let one = [b">>planar_code le<<".as_slice(), &OCTAHEDRON].concat();
    let other = b">>edge_code<<\x03\x00\xff\x00";
    let worlds = all(&[&one, other.as_slice(), &one, &OCTAHEDRON].concat()).unwrap();
    let edges: Vec<_> = worlds.iter().map(EmbeddedGraph::edge_count).collect();
    assert_eq!(edges, [12, 1, 12, 12]);
}

#[test]
fn two_bytes_are_read_in_the_order_of_the_header_or_the_one_that_makes_sense() {
    let numbers = |order: fn(u16) -> [u8; 2]| {
        let list = |vertex: u16| {
            let neighbours = [vertex - 1, vertex + 1];
            neighbours.into_iter().filter(|&n| (1..=300).contains(&n)).chain([0])
        };
        let numbers = [300].into_iter().chain((1..=300).flat_map(list));
        let mut bytes = vec![0];
        bytes.extend(numbers.flat_map(order));
        bytes
    };
    let (little, big) = (numbers(u16::to_le_bytes), numbers(u16::to_be_bytes));
    for (header, body) in [
        (">>planar_code le<<", &little),
        (">>planar_code be<<", &big),
        (">>planar_code<<", &little),
        (">>planar_code<<", &big),
        ("", &little),
        ("", &big),
    ] {
        let bytes = [header.as_bytes(), body].concat();
        assert_eq!(all(&bytes).unwrap(), [path(300)], "{header}");
    }
    assert!(all(&[b">>planar_code be<<".as_slice(), &little].concat()).is_err());
    for cut in [&little[..little.len() - 1], &big[..big.len() - 1]] {
        assert_eq!(
            all(cut).unwrap_err().to_string(),
            format!("byte {}, world 1: the file ends in the middle of a world", cut.len())
        );
    }
    let written = write(&[path(300)], PlantriCode::Planar).unwrap();
    assert_eq!(written, [b">>planar_code le<<".as_slice(), &little].concat());
}

#[test]
fn edge_code_has_loops_and_parallel_edges() {
    // Two loops on the torus, then two vertices with three edges in the plane.
    let bytes = b">>edge_code<<\x04\x00\x01\x00\x01\x07\x00\x01\x02\xff\x02\x01\x00";
    let worlds = all(bytes).unwrap();
    let shapes: Vec<_> = worlds
        .iter()
        .map(|graph| (graph.vertex_count(), graph.edge_count(), graph.genus()))
        .collect();
    assert_eq!(shapes, [(1, 2, 1), (2, 3, 0)]);
    assert_eq!(write(&worlds, PlantriCode::Edge).unwrap(), bytes);
    assert_eq!(
        write(&worlds, PlantriCode::Planar).unwrap_err().to_string(),
        "world 1 has loops or parallel edges, which planar_code cannot have; use edge_code"
    );
}

#[test]
fn a_long_edge_code_gives_its_sizes() {
    // 170 edge ends and 85 separators are the longest body whose length is one byte.
    assert_eq!(write(&[path(86)], PlantriCode::Edge).unwrap()[13], 255);
    assert_eq!(write(&[path(87)], PlantriCode::Edge).unwrap()[13..15], [0, 0x21]);
    let bytes = write(&[path(100)], PlantriCode::Edge).unwrap();
    // 198 edge ends and 99 separators: 0x129 bytes; the length has two bytes, each edge one.
    assert_eq!(bytes[13..20], [0, 0x21, 0x01, 0x29, 0, 255, 0]);
    assert_eq!(all(&bytes).unwrap(), [path(100)]);
    let bytes = write(&[path(300)], PlantriCode::Edge).unwrap();
    // 598 edge ends of two bytes and 299 separators of one: 0x5d7 bytes.
    assert_eq!(bytes[13..20], [0, 0x22, 0x05, 0xd7, 0, 0, 255]);
    assert_eq!(all(&bytes).unwrap(), [path(300)]);
    // 255 edges are the most that one byte can number, because 255 is the separator.
    assert_eq!(write(&[path(256)], PlantriCode::Edge).unwrap()[14], 0x21);
    assert_eq!(write(&[path(257)], PlantriCode::Edge).unwrap()[14], 0x22);
    for vertices in [256, 257] {
        let bytes = write(&[path(vertices)], PlantriCode::Edge).unwrap();
        assert_eq!(all(&bytes).unwrap(), [path(vertices)]);
    }
}

#[test]
fn each_fault_has_its_byte() {
    use PlantriCode::{Edge, Planar};
    // Two edge ends with the longest possible number.
    let longest = [&[0, 0x1f, 30][..], &[1; 30]].concat();
    let cases: [(_, &[u8], _, _); 20] = [
        (Planar, b"", 0, "there is no world"),
        (Planar, b">>planar_code<<", 15, "there is no world"),
        (
            Planar,
            b">>sparse6<<",
            0,
            "unknown header; \
             known are planar_code, planar_code le, planar_code be and edge_code",
        ),
        (Planar, &[2, 2, 0, 3, 0], 3, "vertex 2 lists the neighbour 3; the world has 2 vertices"),
        (
            Planar,
            &[3, 2, 0, 1, 3, 0, 1, 0],
            4,
            "vertex 2 lists the neighbour 3, which does not list 2 back",
        ),
        (
            Planar,
            &[2, 2, 2, 0, 1, 1, 0],
            2,
            "vertex 1 lists 2 again or itself; \
             planar_code cannot have parallel edges and loops, edge_code can",
        ),
        (
            Planar,
            &[2, 2, 0, 1, 2, 2, 0],
            4,
            "vertex 2 lists 2 again or itself; \
             planar_code cannot have parallel edges and loops, edge_code can",
        ),
        (Planar, &[3, 2, 0, 1, 0, 0], 0, "vertex 3 has no edge"),
        (
            Planar,
            &[4, 2, 0, 1, 0, 4, 0, 3, 0],
            0,
            "the world is not connected: vertex 3 cannot be reached from 1",
        ),
        (Planar, &[1, 0], 0, "there is no edge; a world has at least one"),
        (Edge, &[3, 0, 255], 3, "the file ends in the middle of a world"),
        (Edge, &[0, 0x20, 0, 1], 1, "a length of 2 bytes and edges of 0 bytes are not possible"),
        (Edge, &[0, 0x12, 3, 0, 0, 0], 5, "the body ends in the middle of an edge"),
        (Edge, &[4, 0, 255, 0, 0], 1, "the lists have 3 edge ends; every edge has two"),
        (Edge, &[3, 0, 255, 1], 3, "vertex 2 lists edge 1; the world has 1 edge, counted from 0"),
        (
            Edge,
            &[5, 0, 0, 255, 0, 1],
            4,
            "edge 0 is listed for the third time; every edge has two ends",
        ),
        (Edge, &[4, 0, 255, 0, 255], 1, "vertex 3 has no edge"),
        (
            Edge,
            &[5, 0, 0, 255, 1, 1],
            1,
            "the world is not connected: vertex 2 cannot be reached from 1",
        ),
        (
            Edge,
            &longest,
            3,
            "vertex 1 lists edge 18446744073709551615; the world has 1 edge, counted from 0",
        ),
        (Edge, b"", 0, "there is no world"),
    ];
    for (code, bytes, byte, cause) in cases {
        let mut worlds = read_headerless(bytes, code);
        let error = worlds.find_map(Result::err).unwrap();
        assert_eq!(error.to_string(), format!("byte {byte}, world 1: {cause}"));
        assert!(worlds.next().is_none(), "nothing follows the first error");
    }
    let second = [&OCTAHEDRON[..], &OCTAHEDRON[..30]].concat();
    let error = all(&second).unwrap_err().to_string();
    assert_eq!(error, "byte 61, world 2: the file ends in the middle of a world");
}

proptest! {
    #[test]
    fn edge_code_is_read_as_it_was_written(
        worlds in vec(any_graph(Class::Multigraph, 200), 1..4)
    ) {
        let bytes = write(&worlds, PlantriCode::Edge).unwrap();
        prop_assert_eq!(all(&bytes).unwrap(), worlds);
    }

    #[test]
    fn planar_code_is_read_as_it_was_written(worlds in vec(any_graph(Class::Simple, 400), 1..4)) {
        let bytes = write(&worlds, PlantriCode::Planar).unwrap();
        prop_assert_eq!(all(&bytes).unwrap(), worlds);
    }

    #[test]
    fn a_truncated_file_is_an_error(
        graph in any_graph(Class::Simple, 20), cut in 1_usize..100, code in 0..2_usize
    ) {
        let code = [PlantriCode::Planar, PlantriCode::Edge][code];
        let bytes = write(&[graph], code).unwrap();
        let cut = cut % (bytes.len() - 1) + 1;
        prop_assert!(all(&bytes[..bytes.len() - cut]).is_err());
    }

    #[test]
    fn no_bytes_make_the_reader_panic(
        header in 0..5_usize, body in vec(prop_oneof![0..6_u8, any::<u8>()], 0..80)
    ) {
        let headers = ["", ">>planar_code<<", ">>planar_code le<<", ">>planar_code be<<", ">>edge_code<<"];
        let bytes = [headers[header].as_bytes(), &body].concat();
        for graph in read(&bytes).flatten() {
            prop_assert!(graph.edge_count() > 0);
        }
    }
}
