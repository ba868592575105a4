//! No bytes make a parser take more memory than the multiple of them that it states.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

#[path = "../../tests/memory/peak.rs"]
mod peak;

use std::iter;

use proptest::{
    collection::vec,
    prelude::*,
    sample::select,
    test_runner::{RngAlgorithm, TestCaseError, TestRng, TestRunner},
};
use toposlam_model::format::{
    plantri::{self, PlantriCode},
    world_file,
};

use peak::{Documented, keep};

const WORLD_FILE: Documented =
    Documented::new("world_file", |bytes| keep(world_file::read(bytes)), [512, 4096]);
const PLANAR_CODE: Documented = Documented::new(
    "planar_code",
    |bytes| plantri::read_headerless(bytes, PlantriCode::Planar).for_each(keep),
    [128, 0],
);
const EDGE_CODE: Documented = Documented::new(
    "edge_code",
    |bytes| plantri::read_headerless(bytes, PlantriCode::Edge).for_each(keep),
    [128, 0],
);

/// The same part again and again, to about so many bytes.
fn again(part: &str, bytes: usize) -> String {
    part.repeat(bytes / part.len() + 1)
}

/// A part for each number, to about so many bytes.
fn numbered(part: impl Fn(usize) -> String, bytes: usize) -> String {
    let each = part(0xfff).len();
    first(bytes / each + 1, part)
}

/// A part for each of the first numbers.
fn first(count: usize, part: impl Fn(usize) -> String) -> String {
    (0..count).map(part).collect()
}

/// World files of about so many bytes that make the most of them, right and wrong ones.
fn world_files(bytes: usize) -> Vec<String> {
    let mut files = Vec::new();
    for part in ["\n", ",", "[", "{", "=", "\"", "a.", "#\n", "[[a]]\n", "[[a.b]]\n", "'", "\x7f"] {
        files.push(again(part, bytes));
    }
    for item in ["1", "''", "[]", "{}", "{a=1}", "1979-05-27", "true", "{a=[1]}"] {
        let items = again(&format!("{item},"), bytes);
        files.push(format!("a=[{items}]"));
        files.push(format!("a=[{items}"));
    }
    for item in ["1", "\"\"", "[]", "{}", "{\"\":1}", "[{}]", "null"] {
        let items = again(&format!("{item},"), bytes);
        files.push(format!("{{\"a\":[{items}1]}}"));
    }
    // As deep as is read.
    for depth in [2, 8, 32, 64, 78] {
        let (open, close, dots) = ("[".repeat(depth), "]".repeat(depth), "a.".repeat(depth));
        let (tables, ends) = ("{\"\":".repeat(depth), "}".repeat(depth));
        files.push(format!("a=[{}]", again(&format!("{open}1{close},"), bytes)));
        files.push(format!("a=[{}]", again(&format!("{{{dots}a=1}},"), bytes)));
        files.push(numbered(|number| format!("[{dots}{number:x}]\n"), bytes));
        files.push(numbered(|number| format!("[{number:x}.{dots}a]\n"), bytes));
        files.push(numbered(|number| format!("{number:x}.{dots}a=1\n"), bytes));
        files.push(format!("{{\"a\":[{}1]}}", again(&format!("{open}{close},"), bytes)));
        files.push(format!("{{\"a\":[{}1]}}", again(&format!("{tables}1{ends},"), bytes)));
    }
    files.push(numbered(|number| format!("{number:x}=1\n"), bytes));
    files.push(numbered(|number| format!("[{number:x}]\n"), bytes));
    let lists = numbered(|number| format!("{number:x}=[]\n"), bytes);
    files.extend(["clockwise", "doors", "junctions"].map(|table| format!("[{table}]\n{lists}")));
    let lists = numbered(|number| format!("\"{number:x}\":[],"), bytes);
    files.push(format!("{{\"doors\":{{{lists}\"x\":[]}}}}"));
    // A vertex with loops, a path, a star; and an edge that stands too often, at a long name.
    let loops = numbered(|number| format!("'{number:x}','{number:x}',"), bytes);
    files.push(format!("[doors]\nv=[{loops}]"));
    let path = numbered(|number| format!("{number:x}=['{number:x}','{:x}']\n", number + 1), bytes);
    files.push(format!("[doors]\nfirst=['0']\n{path}"));
    let leaves = numbered(|number| format!("'{number:x}',"), bytes / 2);
    let count = leaves.matches(',').count();
    let leaf_lists = first(count, |number| format!("{number:x}=['hub']\n"));
    files.push(format!("[clockwise]\nhub=[{leaves}]\n{leaf_lists}"));
    let ends = again("'e',", bytes / 2);
    files.push(format!("[doors]\n{}=[{ends}]", again("v", bytes / 2)));
    // Long texts, each character of which is shown by six.
    let dels = again("\x7f", bytes);
    files.push(format!("{{\"{dels}\":1}}"));
    files.push(format!("{{\"name\":\"{dels}\"}}"));
    let world = "\"doors\":{\"a\":[\"e\",\"e\"]}";
    files.push(format!("{{{world},\"start\":{{\"at\":\"{dels}\",\"facing\":\"\"}}}}"));
    files.push(format!("{{{world},\"start\":{{\"at\":\"a\",\"facing\":\"{dels}\"}}}}"));
    files.push(format!(
        "{{{world},\"about\":\"{dels}\",\"start\":{{\"at\":\"a\",\"facing\":\"e:1\"}}}}"
    ));
    // A floor plan with a row of junctions; many hallways.
    let plan = "[floor]\nhallway_width=0.1\n[junctions]\n";
    let junctions = numbered(|number| format!("{number:x}=[{number},0]\n"), bytes / 4);
    let count = junctions.matches('\n').count();
    let hallway = |number| format!("[[hallways]]\nfrom='{number:x}'\nto='{:x}'\n", number + 1);
    let row = first(count - 1, hallway);
    files.push(format!("{plan}{junctions}{row}"));
    let hallways = again("[[hallways]]\nfrom='a'\nto='b'\n", bytes);
    files.push(format!("{plan}a=[0,0]\nb=[1,0]\n{hallways}"));
    files
}

/// A world of so many vertices in `planar_code`, with numbers of one byte or two.
fn planar(vertices: u16, neighbours: impl Fn(u16) -> Vec<u16>) -> Vec<u8> {
    let lists = (1..=vertices).flat_map(|vertex| [neighbours(vertex), vec![0]].concat());
    let numbers = iter::once(vertices).chain(lists);
    if vertices < 256 {
        numbers.map(|number| number as u8).collect()
    } else {
        iter::once(0).chain(numbers.flat_map(u16::to_le_bytes)).collect()
    }
}

/// Bytes of about this number that make the most of them in either code.
fn codes(bytes: usize) -> Vec<Vec<u8>> {
    let mut files = Vec::new();
    for byte in [0, 1, 2, 16, 254, 255] {
        let fill = vec![byte; bytes];
        // Bare; with as many vertices as can be; and as bodies that promise much, or what there is.
        files.push([&[255], &fill[..]].concat());
        files.push([&[0, 255, 255], &fill[..]].concat());
        files.push([&[0, 0x81, 255, 255, 255, 255, 255, 255, 255, 255], &fill[..]].concat());
        for edge_bytes in [1, 2, 15] {
            let length = (bytes as u32).to_be_bytes();
            files.push([&[0, 0x40 | edge_bytes], &length[..], &fill].concat());
        }
        files.push(fill);
    }
    // A star and a complete graph.
    let leaves = (bytes / 6).clamp(1, 65_000) as u16;
    let star = |vertex| if vertex == 1 { (2..=leaves + 1).collect() } else { vec![1] };
    files.push(planar(leaves + 1, star));
    let corners = (1..=300_u16).take_while(|&n| usize::from(n).pow(2) <= bytes).last().unwrap_or(1);
    let others = |vertex| (1..=corners).filter(|&other| other != vertex).collect();
    files.push(planar(corners, others));
    // Many tiny worlds.
    files.push([2, 2, 0, 1, 0].repeat(bytes / 5 + 1));
    files.push([3, 0, 255, 0].repeat(bytes / 4 + 1));
    // Loops, first at one vertex, then at one each.
    for end in [&[][..], &[255]] {
        let edges = (bytes / 4).clamp(1, 65_000) as u16;
        let body: Vec<u8> = (0..edges)
            .flat_map(|edge| [&edge.to_be_bytes()[..], &edge.to_be_bytes(), end].concat())
            .collect();
        files.push([&[0, 0x42], &(body.len() as u32).to_be_bytes()[..], &body].concat());
    }
    files
}

fn sampled<S: Strategy>(strategy: &S, holds: impl Fn(S::Value)) {
    let config = ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) };
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let run = TestRunner::new_with_rng(config, rng).run(strategy, |value| {
        holds(value);
        Ok::<(), TestCaseError>(())
    });
    run.unwrap_or_else(|error| panic!("{error}"));
}

fn main() {
    peak::run("reading_takes_no_more_memory_than_stated", reading_takes_no_more_memory_than_stated);
}

fn reading_takes_no_more_memory_than_stated() {
    // Growing vectors are largest just after a power of two.
    let lengths = (1..70).chain([127, 260, 1000, 1030, 4000, 4100, 16_400, 33_000, 100_000]);
    let mut most = [0, 0, 0];
    for length in lengths {
        for file in world_files(length) {
            most[0] = most[0].max(WORLD_FILE.holds(file.as_bytes()));
        }
        for file in codes(length) {
            most[1] = most[1].max(PLANAR_CODE.holds(&file));
            most[2] = most[2].max(EDGE_CODE.holds(&file));
        }
    }
    println!("the most for each byte: {most:?}");

    let byte = prop_oneof![0..6_u8, Just(255), any::<u8>()];
    sampled(&vec(byte, 1..400), |bytes| {
        for stated in [WORLD_FILE, PLANAR_CODE, EDGE_CODE] {
            stated.holds(&bytes);
        }
    });
    let words = [
        "[clockwise]\n",
        "[doors]\n",
        "[floor]\n",
        "[junctions]\n",
        "[[hallways]]\n",
        "[start]\n",
        "a",
        "b",
        "a.",
        "=",
        "[",
        "]",
        "{",
        "}",
        ",",
        "\"",
        "\"a\"",
        "1",
        "\n",
        ":",
        "#",
        "{\"a\":",
    ];
    sampled(&vec(select(words.to_vec()), 1..200), |words| {
        WORLD_FILE.holds(words.concat().as_bytes());
    });
}
