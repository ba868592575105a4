//! The proofs that commands write, given to the checker that is extracted from Coq, and to a second reader in Python.
//!
//! The checker needs Coq with MathComp and OCaml, the second reader Python. A test prints a message about what is missing,
//! and is skipped if neither is there; with `TOPOSLAM_COQ=required` it then fails.

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::{Command, Output},
    slice,
    sync::LazyLock,
};

use proptest::{
    prelude::Rng as _,
    test_runner::{RngAlgorithm, TestRng},
};
use toposlam_model::{
    aid::{Action, Aid, AidKind, State, markers::MOVABLE, pointer::MovablePointer},
    embedded_graph::{Dart, EmbeddedGraph},
    mapping::{MappingAlgorithm, MappingMethod},
    marker::{Directional, NoMarker},
    percept::{Door, Percept, Sighting},
    proof::{Claim, PerceivedRun, Proof, Seen, WalkRecorder},
    trace::{Trace, TraceEventKind, poses},
    visits::{Explanation, VisitAlternative, VisitSet, VisitWay, explain},
    world::GraphWorld,
};

use crate::{
    output::{folder, names_in},
    program, repository,
};

/// The checker, built once; or why there is none.
static CHECKER: LazyLock<Result<PathBuf, String>> = LazyLock::new(|| {
    let built = Path::new(env!("CARGO_TARGET_TMPDIR")).join("proof-checker");
    let mut build = Command::new("bash");
    let build = build.arg(repository("proofs/coq/checker/build")).arg("--out").arg(&built);
    let Output { status, stderr, .. } = build.output().map_err(|error| error.to_string())?;
    match status.code() {
        Some(0) => Ok(built.join("toposlam-proof-check")),
        Some(2) => Err(String::from_utf8_lossy(&stderr).into_owned()),
        _ => panic!("{}", String::from_utf8_lossy(&stderr)),
    }
});

/// The readers of proofs that can be called here, each with its name and the words with which it is called.
struct Readers(Vec<(&'static str, Vec<PathBuf>)>);

impl Readers {
    /// `None`, with a message, if there is none.
    fn new() -> Option<Self> {
        let required = env::var("TOPOSLAM_COQ").is_ok_and(|value| value == "required");
        let missing = |reader: &str, why: &str| {
            assert!(!required, "{why}");
            eprintln!("skipped, {reader} reads no proof: {}", why.trim_end());
        };
        let mut readers = Vec::new();
        match &*CHECKER {
            Ok(checker) => readers.push(("the checker", vec![checker.clone()])),
            Err(why) => missing("the checker", why),
        }
        if Command::new("python3").arg("--version").output().is_ok() {
            let program = repository("tests/oracle/verdict_proofs.py");
            readers.push(("the second reader", vec!["python3".into(), "-B".into(), program]));
        } else {
            missing("the second reader", "there is no python3");
        }
        (!readers.is_empty()).then_some(Self(readers))
    }

    /// All readers say that each claim in these files is proved.
    #[track_caller]
    fn prove(&self, folder: &Path, files: &[String]) {
        assert!(!files.is_empty());
        for (name, reader) in &self.0 {
            let said = call(reader).current_dir(folder).args(files).output().unwrap();
            let text = String::from_utf8_lossy(&said.stdout);
            let wrong = text.lines().find(|line| line.contains(": not proved: "));
            assert!(said.status.success(), "{name}: {wrong:?}");
        }
    }

    /// Which of these files all accept.
    #[track_caller]
    fn accepted(&self, folder: &Path, files: &[String]) -> Vec<String> {
        let mut verdicts = self.0.iter().map(|(_, reader)| {
            let said =
                call(reader).current_dir(folder).arg("--verdicts").args(files).output().unwrap();
            let text = String::from_utf8(said.stdout).unwrap();
            text.lines().map(str::to_owned).collect::<Vec<_>>()
        });
        let first = verdicts.next().unwrap();
        assert_eq!(first.len(), files.len());
        for other in verdicts {
            let difference = first.iter().zip(&other).find(|(one, other)| one != other);
            assert_eq!((difference, other.len()), (None, files.len()));
        }
        first.iter().filter_map(|line| line.strip_prefix("accepted ")).map(str::to_owned).collect()
    }
}

/// Calls a reader.
fn call(words: &[PathBuf]) -> Command {
    let mut command = Command::new(&words[0]);
    command.args(&words[1..]);
    command
}

/// The names of the files in a folder with this ending.
fn files_in(folder: &Path, ending: &str) -> Vec<String> {
    let has_ending = |name: &String| Path::new(name).extension().is_some_and(|it| it == ending);
    names_in(folder).into_iter().filter(has_ending).collect()
}

/// Runs commands that write proofs in a folder, and checks these.
fn assert_proved(name: &str, commands: &[&str], files: &[&str]) {
    let Some(readers) = Readers::new() else { return };
    let folder = folder(name);
    for line in commands {
        run(&folder, line);
    }
    readers.prove(&folder, &files.iter().map(|&file| file.to_owned()).collect::<Vec<_>>());
}

/// Runs a command of the program in a folder, whatever its verdict. `worlds/` is that of the repository.
fn run(folder: &Path, line: &str) {
    let worlds = repository("worlds").display().to_string();
    let line = line.replace("worlds/", &format!("{worlds}/"));
    let said = program().current_dir(folder).args(line.split(' ')).output().unwrap();
    let code = said.status.code().unwrap();
    assert!([0, 1, 3].contains(&code), "{line}: {}", String::from_utf8_lossy(&said.stderr));
}

/// 8,954 starts (A000698).
#[test]
fn the_map_of_every_small_start_is_proved() {
    assert_proved(
        "proofs_of_all_starts",
        &[
            "check --edges 1..=5 --proof algorithm1.proof",
            "check --edges 1..=5 --algorithm folding --proof folding.proof",
            "check --edges 6 --class planar --proof planar.proof",
        ],
        &["algorithm1.proof", "folding.proof", "planar.proof"],
    );
}

#[test]
fn the_map_of_each_world_of_the_repository_is_proved() {
    let Some(readers) = Readers::new() else { return };
    let folder = folder("proofs_of_maps");
    let mut files = Vec::new();
    for world in files_in(&repository("worlds"), "toml") {
        for how in ["--algorithm algorithm1", "--algorithm folding --audit"] {
            let file = format!("{}.proof", files.len());
            run(&folder, &format!("explore worlds/{world} {how} --proof {file}"));
            files.push(file);
        }
    }
    readers.prove(&folder, &files);
}

/// A start with so many edges and doors from 2 to 5 at a vertex, at random.
fn random_start(edges: usize, random: &mut TestRng) -> EmbeddedGraph {
    let mut below = |most: usize| random.next_u64() as usize % most;
    loop {
        let mut clockwise: Vec<u32> = Vec::new();
        while clockwise.len() < 2 * edges {
            let first = clockwise.len() as u32;
            let degree = (2 + below(4)).min(2 * edges - clockwise.len()) as u32;
            clockwise.extend((0..degree).map(|door| first + (door + 1) % degree));
        }
        let mut darts: Vec<u32> = (0..2 * edges as u32).collect();
        for last in (1..darts.len()).rev() {
            darts.swap(last, below(last + 1));
        }
        let mut opposite = vec![0; darts.len()];
        for edge in darts.chunks_exact(2) {
            opposite[edge[0] as usize] = edge[1];
            opposite[edge[1] as usize] = edge[0];
        }
        // It may not be connected.
        if let Ok((graph, _)) = EmbeddedGraph::from_permutations(&opposite, &clockwise) {
            return graph;
        }
    }
}

/// The proof of the map that an algorithm makes in a start.
fn proof_of_run(graph: &EmbeddedGraph, algorithm: MappingAlgorithm) -> String {
    let mut recorder = WalkRecorder::default();
    let mut world = GraphWorld::new(graph, Dart(0));
    let method = MappingMethod::from(algorithm);
    let (journey, _) = method.map_world(&mut world, graph.dart_count(), &[], &mut recorder);
    let map = journey.map().complete().unwrap();
    Proof::of_map(map, Dart(0), recorder.walk().unwrap()).unwrap().to_string()
}

#[test]
fn maps_of_larger_starts_are_proved() {
    let Some(readers) = Readers::new() else { return };
    let folder = folder("proofs_of_larger_maps");
    let mut random = TestRng::from_seed(RngAlgorithm::ChaCha, &[1; 32]);
    let mut proofs = String::new();
    for edges in (10..=200).step_by(5) {
        let start = random_start(edges, &mut random);
        for algorithm in MappingAlgorithm::with_fixed_marker() {
            proofs += &proof_of_run(&start, algorithm);
        }
    }
    fs::write(folder.join("larger.proof"), proofs).unwrap();
    readers.prove(&folder, &["larger.proof".to_owned()]);
}

#[test]
fn pairs_that_a_marker_does_not_distinguish_are_proved_and_other_comparisons() {
    assert_proved(
        "proofs_of_comparisons",
        &[
            "counterexample --class multigraph --max-edges 5 --all --proof multigraph.proof",
            "counterexample --class simple --max-edges 7 --all --proof simple.proof",
            "counterexample --class corridor --max-edges 9 --proof corridor.proof",
            "counterexample --class planar --max-edges 8 --proof planar.proof",
            "compare worlds/figure-1a.toml worlds/figure-1b.toml --marker undirected --proof alike.proof",
            "compare worlds/figure-1a.toml worlds/figure-1b.toml --proof different.proof",
            "compare worlds/cycle-12.toml worlds/cycle-12.toml --marker two-identical --proof same.proof",
            "compare worlds/theta-plane.toml worlds/theta-torus.toml --marker none --proof theta.proof",
        ],
        &[
            "multigraph.proof",
            "simple.proof",
            "corridor.proof",
            "planar.proof",
            "alike.proof",
            "different.proof",
            "same.proof",
            "theta.proof",
        ],
    );
}

/// A run, its events with a wrong percept, and what its scans show.
#[test]
fn verdicts_about_logs_are_proved() {
    let Some(readers) = Readers::new() else { return };
    let folder = folder("proofs_of_logs");
    // A ring of 3 junctions, of which one is taken for another: with three doors, or with the marker.
    let event = |degree, door, marker| format!("{degree},{door},{marker}\n");
    let ring = [event(2, "1", "0"), event(2, "1", "-1"), event(2, "1", "-1"), event(2, "", "0")];
    let logs = [
        ("right", ring.to_vec()),
        ("open", ring[..3].to_vec()),
        (
            "degree",
            vec![event(2, "1", "0"), event(3, "0", "-1"), event(2, "1", "0"), event(2, "", "-1")],
        ),
        ("marker", vec![event(2, "1", "0"), event(2, "0", "-1"), event(2, "", "-1")]),
    ];
    for (name, events) in logs {
        fs::write(
            folder.join(format!("{name}.csv")),
            format!("degree,door,marker\n{}", events.concat()),
        )
        .unwrap();
    }
    let mut files = Vec::new();
    let mut prove = |line: &str| {
        let file = format!("{}.proof", files.len());
        run(&folder, &format!("{line} --proof {file}"));
        assert!(folder.join(&file).exists(), "{line}");
        files.push(file);
    };
    for log in ["right", "open", "degree", "marker"] {
        let conform = format!("conform {log}.csv --driver anyone");
        prove(&conform);
        for start in ["", " --start any"] {
            prove(&format!("{conform} --world worlds/cycle-3.toml{start}"));
        }
        prove(&format!("{conform} --world worlds/cycle-4.toml"));
    }
    prove("simulate worlds/shape-6.toml --by-scene --log run.mcap");
    prove("conform run.mcap");
    prove("conform run.mcap --world worlds/shape-6.toml");
    prove("conform run.mcap --world worlds/shape-8.toml");
    prove("simulate worlds/shape-6.toml --sensor laser --log scans.mcap");
    prove("simulate worlds/shape-8.toml --sensor laser --log more.mcap");
    let known = "--marker none --start any --world worlds/shape-6.toml";
    // Assumed where none was, a marker contradicts what is seen when the robot comes back.
    for how in [known, "--marker none --corners yes", "--assume-marker --corners yes"] {
        for log in ["scans", "more"] {
            prove(&format!("conform {log}.mcap --events laser --driver anyone {how}"));
        }
    }
    // A marker that the robot carries.
    run(&folder, "simulate worlds/shape-6.toml --aid movable --by-scene --log carried.mcap");
    prove("conform carried.mcap --world worlds/shape-6.toml");
    prove("conform carried.mcap --world worlds/shape-8.toml");
    readers.prove(&folder, &files);
    let claims: String =
        files.iter().map(|file| fs::read_to_string(folder.join(file)).unwrap()).collect();
    for claim in
        ["determined", "unexplained", "conforms", "diverges", "fits", "misfits", "impossible"]
    {
        assert!(claims.contains(&format!("claim {claim}\n")), "{claim}");
    }
}

/// Visits of which several percepts are possible, at random: up to three of up to three doors.
fn random_visits(is_marked: bool, random: &mut TestRng) -> Vec<VisitSet> {
    let mut below = |most: u32| random.next_u32() % most;
    let mut visits = Vec::new();
    for _ in 0..2 + below(6) {
        let mut alternatives = Vec::new();
        for _ in 0..=below(3) {
            let degree = 1 + below(3);
            let sighting = match below(4) {
                0 if is_marked => Sighting::Pointing(Door(below(degree))),
                _ => Sighting::Nothing,
            };
            let door = (below(3) > 0).then(|| Door(below(degree)));
            let vertex = VisitAlternative { percept: Percept { degree, sighting }, door };
            alternatives.push((below(4) > 0).then_some(vertex));
        }
        let way = if below(2) == 0 { VisitWay::Through } else { VisitWay::Back };
        visits.push(VisitSet::new(alternatives, way));
    }
    visits
}

/// 4,000 sets of visits: that some choice fits a world, or that none does.
#[test]
fn whether_some_world_explains_visits_is_proved() {
    let Some(readers) = Readers::new() else { return };
    let folder = folder("proofs_of_visits");
    let mut random = TestRng::from_seed(RngAlgorithm::ChaCha, &[3; 32]);
    let (mut proofs, mut longest) = (String::new(), 0);
    let mut counts = [0; 2];
    for number in 0..4_000 {
        let marker = if number % 4 == 0 { NoMarker } else { Directional };
        let visits = random_visits(marker == Directional, &mut random);
        let found = explain(&visits, marker == Directional, 1_000_000, &());
        let proof = match &found {
            (Explanation::Explained(_), Some(world)) => {
                counts[0] += 1;
                Proof::of_visits_in_world(world, marker, &visits).unwrap().to_string()
            }
            (Explanation::Explained(_), None) => continue,
            &(Explanation::Impossible { visit }, _) => {
                counts[1] += 1;
                Proof::of_impossible_visits(&visits, visit, marker).unwrap().to_string()
            }
            (Explanation::NotKnown, _) => panic!("there are few choices"),
        };
        longest = longest.max(proof.lines().count());
        proofs += &proof;
    }
    fs::write(folder.join("visits.proof"), proofs).unwrap();
    readers.prove(&folder, &["visits.proof".to_owned()]);
    assert!(counts.iter().all(|&count| count > 300) && longest > 300, "{counts:?}, {longest}");
}

/// A random run in a world with a marker that is carried, of which one percept may be false.
fn random_run(graph: &EmbeddedGraph, aid: AidKind, random: &mut TestRng) -> Trace {
    let mut world = GraphWorld::with_aid(graph, aid, Dart(0));
    let mut below = |most: usize| random.next_u64() as usize % most;
    let mut events = vec![TraceEventKind::Percept(world.sensed())];
    let deeds = below(20);
    for _ in 0..deeds {
        let actions = world.actions();
        let handling = actions.iter().copied().find(|action| action.door().is_none());
        let action = handling.filter(|_| below(2) == 0);
        let action = action.unwrap_or_else(|| actions[below(actions.len())]);
        world.act(action).unwrap();
        let (event, is_seen) = match action {
            Action::Take(door) => (TraceEventKind::Door(door), true),
            Action::Do(action) => (TraceEventKind::Action(action), below(2) == 0),
        };
        events.push(event);
        events.extend(is_seen.then(|| TraceEventKind::Percept(world.sensed())));
    }
    let at = below(2 * events.len());
    if let Some(TraceEventKind::Percept(percept)) = events.get_mut(at) {
        percept.sighting = match percept.sighting {
            Sighting::Nothing => Sighting::Pointing(Door(below(percept.degree as usize) as u32)),
            _ => Sighting::Nothing,
        };
    }
    Trace::new(events).unwrap()
}

/// 1,000 runs with a marker that is carried, in random worlds.
#[test]
fn runs_with_a_marker_that_is_carried_are_proved() {
    let Some(readers) = Readers::new() else { return };
    let folder = folder("proofs_of_runs");
    let mut random = TestRng::from_seed(RngAlgorithm::ChaCha, &[4; 32]);
    let mut proofs = String::new();
    let mut conforming = 0;
    for number in 0..1_000 {
        let graph = random_start(4, &mut random);
        let aid = if number % 2 == 0 { MOVABLE.into() } else { AidKind::Pointer(MovablePointer) };
        let trace = random_run(&graph, aid, &mut random);
        let placed = aid.placed(&graph, Dart(0));
        let states = graph.darts().map(|pose| State { pose, placed: placed.clone() });
        let (fit, misfit): (Vec<_>, Vec<_>) = states
            .map(|state| {
                let fits = poses(&graph, &aid, slice::from_ref(&state), &trace).misfit.is_none();
                (state.pose, fits)
            })
            .partition(|&(_, fits)| fits);
        conforming += usize::from(!fit.is_empty());
        let conform = fit.into_iter().map(|(from, _)| Claim::Conforms { from });
        let misfit: Vec<Dart> = misfit.into_iter().map(|(pose, _)| pose).collect();
        let diverge = (!misfit.is_empty()).then_some(Claim::Diverges { from: Some(misfit) });
        let seen = Some(Seen::Run(PerceivedRun::new(aid, &trace).unwrap()));
        let claims = conform.chain(diverge).collect();
        let proof = Proof { worlds: vec![(&graph, Dart(0))], marker: NoMarker, seen, claims };
        proofs += &proof.to_string();
    }
    fs::write(folder.join("runs.proof"), proofs).unwrap();
    readers.prove(&folder, &["runs.proof".to_owned()]);
    assert!((300..900).contains(&conforming), "{conforming}");
}

/// Examples of every kind, and what is wrong in one thing.
#[test]
fn the_readers_agree_on_the_examples() {
    let Some(readers) = Readers::new() else { return };
    let examples = repository("proofs/coq/checker/examples");
    readers.prove(&examples, &files_in(&examples, "proof"));
    let refused = examples.join("refused");
    let accepted = readers.accepted(&refused, &files_in(&refused, "proof"));
    assert_eq!(accepted, Vec::<String>::new());
}

/// Changes one thing in the lines of a proof.
fn mutated(proof: &[&str], other: &[&str], random: &mut TestRng) -> String {
    let mut below = |most: usize| random.next_u64() as usize % most;
    let mut lines: Vec<String> = proof.iter().map(|&line| line.to_owned()).collect();
    let at = below(lines.len());
    match below(6) {
        0 => drop(lines.remove(at)),
        1 => lines.insert(at, lines[at].clone()),
        2 => {
            let with = below(lines.len());
            lines.swap(at, with);
        }
        3 => other[below(other.len())].clone_into(&mut lines[at]),
        // One word of the line, for another of the proof or for another number.
        kind => {
            let all: Vec<String> =
                lines.iter().flat_map(|line| line.split(' ')).map(str::to_owned).collect();
            let mut words: Vec<String> = lines[at].split(' ').map(str::to_owned).collect();
            let word = below(words.len());
            words[word] =
                if kind == 4 { all[below(all.len())].clone() } else { below(6).to_string() };
            lines[at] = words.join(" ");
        }
    }
    lines.join("\n") + "\n"
}

/// 10,000 proofs that were changed in one thing, of which some are still proofs.
#[test]
fn the_readers_agree_on_changed_proofs() {
    let Some(readers) = Readers::new() else { return };
    let folder = folder("changed_proofs");
    for line in [
        "check --edges 1..=3 --proof maps.proof",
        "counterexample --class multigraph --max-edges 3 --all --proof pairs.proof",
        "compare worlds/figure-1a.toml worlds/figure-1b.toml --proof different.proof",
    ] {
        run(&folder, line);
    }
    let examples = repository("proofs/coq/checker/examples");
    let examples = fs::read_dir(examples).unwrap().map(|entry| entry.unwrap().path());
    let ours = ["maps.proof", "pairs.proof", "different.proof"].map(|file| folder.join(file));
    let mut sources: Vec<_> = examples.filter(|path| path.is_file()).chain(ours).collect();
    sources.sort();
    let text: String = sources.iter().map(|path| fs::read_to_string(path).unwrap()).collect();
    let head = "toposlam-proof 1\n";
    let proofs: Vec<Vec<&str>> = text
        .split(head)
        .skip(1)
        .map(|rest| rest.lines().filter(|line| !line.starts_with('#')).collect())
        .collect();
    let mut random = TestRng::from_seed(RngAlgorithm::ChaCha, &[2; 32]);
    let files: Vec<String> = (0..10_000).map(|number| number.to_string()).collect();
    for file in &files {
        let mut any = || &proofs[random.next_u64() as usize % proofs.len()];
        let (one, other) = (any(), any());
        fs::write(folder.join(file), head.to_owned() + &mutated(one, other, &mut random)).unwrap();
    }
    let accepted = readers.accepted(&folder, &files).len();
    assert!((100..5_000).contains(&accepted), "{accepted}");
}
