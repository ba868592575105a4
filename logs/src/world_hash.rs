//! The hash that identifies a world in a log, independent of its names.

use std::fmt::Write;

use sha2::{Digest, Sha256};
use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    isomorphism::code,
};

/// SHA-256, in hexadecimal, of the code of a start, each word of it in four bytes, the least first.
/// Isomorphic starts have the same.
pub fn world_hash(graph: &EmbeddedGraph, facing: Dart) -> String {
    let mut digest = Sha256::new();
    for word in code(graph, facing).words() {
        digest.update(word.to_le_bytes());
    }
    hexadecimal(&digest.finalize())
}

/// Bytes in hexadecimal, two digits each.
pub fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        // Writing to a string cannot fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}

#[cfg(test)]
mod tests {
    use toposlam_model::{format::world_file, isomorphism::as_discovered};

    use super::*;

    #[test]
    fn isomorphic_starts_have_the_same_and_others_another() {
        let file = include_bytes!("../../worlds/shape-6.toml");
        let plan = world_file::read(file).unwrap().plan.unwrap();
        let graph = plan.graph();
        for facing in graph.darts() {
            let hash = world_hash(graph, facing);
            assert_eq!(world_hash(&as_discovered(graph, facing), Dart(0)), hash);
            let same = graph.darts().filter(|&dart| world_hash(graph, dart) == hash);
            let isomorphic = graph.darts().filter(|&dart| code(graph, dart) == code(graph, facing));
            assert!(same.eq(isomorphic));
        }
    }

    /// By Python: `hashlib.sha256(struct.pack("<2I", 2**32 - 2, 2**32 - 2)).hexdigest()`.
    #[test]
    fn one_edge_has_the_hash_of_its_two_words() {
        let edge = EmbeddedGraph::from_edge_lists(&[("a", vec!["e"]), ("b", vec!["e"])]).unwrap();
        assert_eq!(
            world_hash(&edge, Dart(0)),
            "d68892270a4358c723fefd6c3df811000689d276a7b15205c65037a41a989cce"
        );
    }
}
