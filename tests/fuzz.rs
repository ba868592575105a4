//! The fuzz targets on stable Rust: every seed, and a fixed number of mutations of the seeds, always the
//! same ones. A failing input is shrunk.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

use std::{
    collections::BTreeSet,
    fs,
    ops::Range,
    path::{Path, PathBuf},
};

use proptest::{
    collection::vec,
    prelude::*,
    sample::{Index, select},
    test_runner::{RngAlgorithm, TestCaseError, TestError, TestRng, TestRunner},
};
use toposlam_logs::{
    decode::decode,
    definition::{Definition, Dialect},
    reader::Log,
    rosbag2,
    topic_map::TopicMap,
};
use toposlam_model::format::{
    plantri::{self, PlantriCode},
    world_file,
};
use toposlam_vision::{camera::calibration, colour::ColourModel, image_file::ImageFile};

/// A fuzz target.
#[derive(Clone, Copy)]
struct FuzzTarget {
    name: &'static str,
    body: fn(&[u8]),
    /// The package of the body.
    package: &'static str,
}

/// Every target: worlds and choices, sensing, logs.
fn targets() -> Vec<FuzzTarget> {
    let proofs = toposlam_proofs::fuzz::TARGETS.iter().map(|target| FuzzTarget {
        name: target.name,
        body: target.body,
        package: "toposlam_proofs",
    });
    let vision = toposlam_vision::fuzz::TARGETS.iter();
    let vision = vision.map(|&(name, body)| FuzzTarget { name, body, package: "toposlam_vision" });
    let logs = toposlam_conform::fuzz::TARGETS.iter();
    let logs = logs.map(|&(name, body)| FuzzTarget { name, body, package: "toposlam_conform" });
    proofs.chain(vision).chain(logs).collect()
}

/// A file or folder of the repository.
fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// The names in a folder.
fn names_in(folder: &str) -> BTreeSet<String> {
    let entries = fs::read_dir(repository(folder)).unwrap();
    entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

/// The seeds of a target with their names, without the files that cargo-fuzz added (named by a hash).
fn seeds(target: &str) -> Vec<(String, Vec<u8>)> {
    let folder = format!("fuzz/corpus/{target}");
    let is_hash = |name: &String| name.len() == 40 && name.bytes().all(|b| b.is_ascii_hexdigit());
    let names = names_in(&folder).into_iter().filter(|name| !is_hash(name));
    names.map(|name| (name.clone(), fs::read(repository(&folder).join(name)).unwrap())).collect()
}

fn target(name: &str) -> FuzzTarget {
    targets().into_iter().find(|target| target.name == name).unwrap()
}

/// One change of a file.
#[derive(Clone, Debug)]
enum Edit {
    Truncate {
        at: Index,
    },
    Delete {
        at: Index,
        bytes: usize,
    },
    Flip {
        at: Index,
        bit: u8,
    },
    Replace {
        at: Index,
        byte: u8,
    },
    Insert {
        at: Index,
        bytes: Vec<u8>,
    },
    Splice {
        at: Index,
        from: Index,
        bytes: usize,
        of: Index,
    },
    /// Replaces a number, if the file has one.
    Number {
        at: Index,
        number: String,
    },
}

impl Edit {
    fn apply(&self, file: &mut Vec<u8>, seeds: &[(String, Vec<u8>)]) {
        let place = |at: &Index| at.index(file.len() + 1);
        match self {
            Self::Truncate { at } => file.truncate(place(at)),
            Self::Delete { at, bytes } => {
                let at = place(at);
                file.drain(at..file.len().min(at + bytes));
            }
            Self::Flip { at, bit } => {
                let at = place(at);
                if let Some(byte) = file.get_mut(at) {
                    *byte ^= 1 << bit;
                }
            }
            Self::Replace { at, byte: new } => {
                let at = place(at);
                if let Some(byte) = file.get_mut(at) {
                    *byte = *new;
                }
            }
            Self::Insert { at, bytes } => {
                let at = place(at);
                file.splice(at..at, bytes.iter().copied());
            }
            Self::Splice { at, from, bytes, of } => {
                let (_, other) = of.get(seeds);
                let from = from.index(other.len() + 1);
                let part = &other[from..other.len().min(from + bytes)];
                let at = place(at);
                file.splice(at..at, part.iter().copied());
            }
            Self::Number { at, number } => {
                let numbers = numbers_in(file);
                if !numbers.is_empty() {
                    let place = numbers[at.index(numbers.len())].clone();
                    file.splice(place, number.bytes());
                }
            }
        }
    }
}

/// The ranges of the numbers in a text.
fn numbers_in(text: &[u8]) -> Vec<Range<usize>> {
    let is_part = |byte: &u8| byte.is_ascii_digit() || *byte == b'.';
    let mut numbers = Vec::new();
    let mut at = 0;
    for part in text.chunk_by(|one, other| is_part(one) == is_part(other)) {
        if is_part(&part[0]) {
            numbers.push(at..at + part.len());
        }
        at += part.len();
    }
    numbers
}

fn any_edit() -> impl Strategy<Value = Edit> {
    let at = any::<Index>;
    // Small numbers, the bounds of a byte, and characters.
    let byte = || prop_oneof![0..6_u8, Just(255), Just(b'\n'), b' '..=b'~', any::<u8>()];
    prop_oneof![
        at().prop_map(|at| Edit::Truncate { at }),
        (at(), 1..9_usize).prop_map(|(at, bytes)| Edit::Delete { at, bytes }),
        (at(), 0..8_u8).prop_map(|(at, bit)| Edit::Flip { at, bit }),
        (at(), byte()).prop_map(|(at, byte)| Edit::Replace { at, byte }),
        (at(), vec(byte(), 1..5)).prop_map(|(at, bytes)| Edit::Insert { at, bytes }),
        (at(), at(), 1..40_usize, at()).prop_map(|(at, from, bytes, of)| Edit::Splice {
            at,
            from,
            bytes,
            of
        }),
        (at(), any_number()).prop_map(|(at, number)| Edit::Number { at, number }),
    ]
}

/// Small and large numbers, with and without a fraction, and values that are not numbers.
fn any_number() -> impl Strategy<Value = String> {
    prop_oneof![
        4 => (0..40_u32).prop_map(|number| number.to_string()),
        2 => any::<i16>().prop_map(|number| number.to_string()),
        2 => (0.0..2.0_f64).prop_map(|number| number.to_string()),
        1 => any::<f64>().prop_map(|number| format!("{number:e}")),
        1 => select(vec!["nan", "inf", "-0.0", "9223372036854775808", "1e999"])
            .prop_map(str::to_owned),
    ]
}

/// Runs a target on its seeds and on a number of mutations of them.
fn holds(name: &str, mutations: u32) {
    let FuzzTarget { body, .. } = target(name);
    let seeds = seeds(name);
    for (_, seed) in &seeds {
        body(seed);
    }
    let mutated = |(seed, edits): (Index, Vec<Edit>)| {
        let (_, mut file) = seed.get(&seeds).clone();
        for edit in edits {
            edit.apply(&mut file, &seeds);
        }
        file
    };
    let config =
        ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(mutations) };
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let result = TestRunner::new_with_rng(config, rng).run(
        &(any::<Index>(), vec(any_edit(), 1..6)),
        |case| {
            body(&mutated(case));
            Ok::<(), TestCaseError>(())
        },
    );
    match result {
        Ok(()) => {}
        Err(TestError::Fail(reason, case)) => {
            panic!("{reason}\nthe bytes: b\"{}\"", mutated(case).escape_ascii())
        }
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn world_files_hold() {
    holds("world_file", 30_000);
}

#[test]
fn planar_code_holds() {
    holds("planar_code", 100_000);
}

#[test]
fn edge_code_holds() {
    holds("edge_code", 100_000);
}

#[test]
fn mapping_holds() {
    holds("mapping", 30_000);
}

#[test]
fn images_hold() {
    holds("image", 20_000);
}

#[test]
fn calibrations_hold() {
    holds("calibration", 30_000);
}

#[test]
fn colours_hold() {
    holds("colours", 10_000);
}

#[test]
fn bags_hold() {
    holds("bag", 10_000);
}

#[test]
fn mcap_files_hold() {
    holds("mcap", 10_000);
}

#[test]
fn messages_of_ros_1_hold() {
    holds("ros1_message", 30_000);
}

#[test]
fn messages_in_cdr_hold() {
    holds("cdr_message", 30_000);
}

#[test]
fn mappings_of_logs_hold() {
    holds("log_mapping", 10_000);
}

#[test]
fn carmen_logs_hold() {
    holds("carmen", 10_000);
}

#[test]
fn events_hold() {
    holds("events", 10_000);
}

#[test]
fn metadata_of_rosbag2_hold() {
    holds("rosbag2_metadata", 20_000);
}

#[test]
fn rows_of_databases_hold() {
    holds("database_rows", 1_000);
}

#[test]
fn every_target_has_a_body_and_seeds_and_is_run() {
    let targets = targets();
    let names: BTreeSet<String> = targets.iter().map(|target| target.name.to_owned()).collect();
    assert_eq!(names.len(), targets.len());
    assert_eq!(names_in("fuzz/corpus"), names);
    let manifest = fs::read_to_string(repository("fuzz/Cargo.toml")).unwrap();
    let manifest: toml::Table = manifest.parse().unwrap();
    let bins = manifest["bin"].as_array().unwrap().iter();
    let bins: BTreeSet<_> = bins.map(|bin| bin["name"].as_str().unwrap().to_owned()).collect();
    assert_eq!(bins, names);
    let workflow = fs::read_to_string(repository(".github/workflows/fuzz.yml")).unwrap();
    let (_, list) = workflow.split_once("target: [").expect("the workflow lists the targets");
    let list = list.split_once(']').unwrap().0.split(", ").map(str::to_owned);
    assert_eq!(list.collect::<BTreeSet<_>>(), names);
    for FuzzTarget { name, package, .. } in targets {
        let main = fs::read_to_string(repository(&format!("fuzz/fuzz_targets/{name}.rs"))).unwrap();
        assert!(main.contains(&format!("{package}::fuzz::{name}(bytes)")), "{name}: {main}");
        let seeds = seeds(name);
        assert!(seeds.len() >= 8, "{name} has {} seeds", seeds.len());
        for (seed, bytes) in seeds {
            assert!(bytes.len() < 2000, "{name}/{seed} is large: {} bytes", bytes.len());
        }
    }
}

/// The name of a seed starts with `error-` exactly if the seed is invalid.
#[test]
fn the_names_of_seeds_show_whether_they_are_valid() {
    let others = targets().into_iter().map(|target| target.name).filter(|name| *name != "mapping");
    for target in others {
        for (name, bytes) in seeds(target) {
            let all = |code| plantri::read_headerless(&bytes, code).all(|result| result.is_ok());
            let is_read = match target {
                "planar_code" => all(PlantriCode::Planar),
                "edge_code" => all(PlantriCode::Edge),
                "image" => ImageFile::open(&bytes)
                    .is_ok_and(|file| file.size() == [96, 72] && file.image().is_ok()),
                "calibration" => {
                    let zero = bytes.iter().position(|&byte| byte == 0);
                    let (toml, named) = bytes.split_at(zero.unwrap_or(bytes.len()));
                    let named = named.get(1..).map(<[u8]>::to_vec);
                    let missing = std::io::ErrorKind::NotFound;
                    let mut read = |_: &str| named.clone().ok_or_else(|| missing.into());
                    calibration::read(toml, &mut read).is_ok()
                }
                "colours" => ColourModel::read(&bytes).is_ok(),
                "bag" | "mcap" => is_log(&bytes),
                "carmen" | "events" => Log::of_bytes(bytes).is_ok_and(|log| {
                    let bound = TopicMap::unambiguous(&log).bind(&log).unwrap();
                    log.entries(&bound).all(|entry| entry.is_ok())
                }),
                "rosbag2_metadata" => rosbag2::file_names(&bytes).is_ok(),
                #[cfg(feature = "sqlite")]
                "database_rows" => {
                    is_log(&toposlam_conform::fuzz::database::of_rows(&bytes).unwrap())
                }
                #[cfg(not(feature = "sqlite"))]
                "database_rows" => !name.starts_with("error-"),
                "ros1_message" => is_message(Dialect::Ros1, &bytes),
                "cdr_message" => is_message(Dialect::Ros2, &bytes),
                "log_mapping" => TopicMap::read(&bytes).is_ok(),
                "world_file" => world_file::read(&bytes).is_ok(),
                _ => panic!("unknown target {target}"),
            };
            assert_eq!(is_read, !name.starts_with("error-"), "{target}/{name}");
        }
    }
}

/// Whether bytes are a log of which each message can be read.
fn is_log(bytes: &[u8]) -> bool {
    Log::of_bytes(bytes.to_vec()).is_ok_and(|log| log.read_all().all(|message| message.is_ok()))
}

/// Whether bytes are a definition, a zero byte and a message of that definition.
fn is_message(dialect: Dialect, bytes: &[u8]) -> bool {
    let zero = bytes.iter().position(|&byte| byte == 0).unwrap();
    let text = std::str::from_utf8(&bytes[..zero]).unwrap();
    Definition::read(dialect, "a/A", text)
        .is_ok_and(|definition| decode(&definition, &bytes[zero + 1..]).is_ok())
}
