//! The fuzz targets on stable Rust: every seed, and a fixed number of mutations of the seeds, always the
//! same ones: a tenth of them, or all, as in the gate, with `TOPOSLAM_MUTATIONS=all`. A failing input is shrunk.

use std::{collections::BTreeSet, env, fs, ops::Range};

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

use crate::{read, repository};

/// A fuzz target: its name, its body, and the package of the body.
type FuzzTarget = (&'static str, fn(&[u8]), &'static str);

/// Every target: worlds and choices, sensing, logs.
fn targets() -> Vec<FuzzTarget> {
    let proofs = toposlam_proofs::fuzz::TARGETS.iter();
    let proofs = proofs.map(|&(name, body)| (name, body, "toposlam_proofs"));
    let vision = toposlam_vision::fuzz::TARGETS.iter();
    let vision = vision.map(|&(name, body)| (name, body, "toposlam_vision"));
    let logs = toposlam_conform::fuzz::TARGETS.iter();
    let logs = logs.map(|&(name, body)| (name, body, "toposlam_conform"));
    proofs.chain(vision).chain(logs).collect()
}

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

/// One change of a file: bytes of it are replaced.
#[derive(Clone, Debug)]
struct Edit {
    at: Index,
    removed: usize,
    inserted: Inserted,
}

#[derive(Clone, Debug)]
enum Inserted {
    Bytes(Vec<u8>),
    /// The byte there, with one bit flipped.
    Flipped(u8),
    /// A part of a seed.
    Part(Index, Index, usize),
    /// In place of a number, if the file has one.
    Number(String),
}

impl Edit {
    fn apply(&self, file: &mut Vec<u8>, seeds: &[(String, Vec<u8>)]) {
        let at = self.at.index(file.len() + 1);
        let range = at..file.len().min(at + self.removed);
        let (range, bytes) = match &self.inserted {
            Inserted::Bytes(bytes) => (range, bytes.clone()),
            Inserted::Flipped(bit) => {
                let flipped = file[range.clone()].iter().map(|byte| byte ^ (1 << bit)).collect();
                (range, flipped)
            }
            Inserted::Part(of, from, length) => {
                let (_, other) = of.get(seeds);
                let from = from.index(other.len() + 1);
                (range, other[from..other.len().min(from + length)].to_vec())
            }
            Inserted::Number(number) => match numbers_in(file) {
                numbers if numbers.is_empty() => return,
                numbers => (self.at.get(&numbers).clone(), number.clone().into_bytes()),
            },
        };
        file.splice(range, bytes);
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
    // Small numbers, the bounds of a byte, and characters.
    let byte = || prop_oneof![0..6_u8, Just(255), Just(b'\n'), b' '..=b'~', any::<u8>()];
    let index = any::<Index>;
    let change = prop_oneof![
        // Cut off, deleted, flipped, replaced, inserted.
        Just((usize::MAX / 2, Inserted::Bytes(Vec::new()))),
        (1..9_usize).prop_map(|removed| (removed, Inserted::Bytes(Vec::new()))),
        (0..8_u8).prop_map(|bit| (1, Inserted::Flipped(bit))),
        byte().prop_map(|byte| (1, Inserted::Bytes(vec![byte]))),
        vec(byte(), 1..5).prop_map(|bytes| (0, Inserted::Bytes(bytes))),
        (index(), index(), 1..40_usize).prop_map(|(of, from, n)| (0, Inserted::Part(of, from, n))),
        any_number().prop_map(|number| (0, Inserted::Number(number))),
    ];
    (index(), change).prop_map(|(at, (removed, inserted))| Edit { at, removed, inserted })
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
    let is_all = env::var("TOPOSLAM_MUTATIONS").is_ok_and(|mutations| mutations == "all");
    let mutations = if is_all { mutations } else { mutations / 10 };
    let (_, body, _) = targets().into_iter().find(|target| target.0 == name).unwrap();
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

/// A test for each target, with its number of mutations.
macro_rules! hold {
    ($($target:ident $mutations:literal)*) => {
        const RUN: &[&str] = &[$(stringify!($target)),*];

        $(#[test]
        fn $target() {
            holds(stringify!($target), $mutations);
        })*
    };
}

hold! {
    world_file 30_000
    planar_code 100_000
    edge_code 100_000
    mapping 30_000
    image 20_000
    calibration 30_000
    colours 10_000
    bag 10_000
    mcap 10_000
    ros1_message 30_000
    cdr_message 30_000
    log_mapping 10_000
    carmen 10_000
    events 10_000
    rosbag2_metadata 20_000
    database_rows 1_000
}

#[test]
fn every_target_has_a_body_and_seeds_and_is_run() {
    let targets = targets();
    let names: BTreeSet<String> = targets.iter().map(|target| target.0.to_owned()).collect();
    assert_eq!(names.len(), targets.len());
    assert_eq!(names_in("fuzz/corpus"), names);
    assert_eq!(RUN.iter().map(|&name| name.to_owned()).collect::<BTreeSet<_>>(), names);
    let manifest: toml::Table = read("fuzz/Cargo.toml").parse().unwrap();
    let bins = manifest["bin"].as_array().unwrap().iter();
    let bins: BTreeSet<_> = bins.map(|bin| bin["name"].as_str().unwrap().to_owned()).collect();
    assert_eq!(bins, names);
    let workflow = read(".github/workflows/fuzz.yml");
    let (_, list) = workflow.split_once("target: [").expect("the workflow lists the targets");
    let list = list.split_once(']').unwrap().0.split(", ").map(str::to_owned);
    assert_eq!(list.collect::<BTreeSet<_>>(), names);
    for (name, _, package) in targets {
        let main = read(&format!("fuzz/fuzz_targets/{name}.rs"));
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
    for target in targets().into_iter().map(|target| target.0).filter(|name| *name != "mapping") {
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
