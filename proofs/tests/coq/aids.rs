//! The aids of `Aids.v`, extracted, against those of toposlam: along random walks a robot perceives the same with both, and
//! the same actions are possible.

use std::{fs, process::Command};

use toposlam_model::{
    aid::{AIDS, Action, Aid, AidAction, AidKind},
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Class,
    percept::{Door, OtherRobot, Percept, Sighting},
    world::GraphWorld,
};

use super::{comparison::listed, folder, printed, run_extracted, source, starts};

/// What the aid adds to a percept, as `compare/aids.ml` writes it.
fn shown(aid: AidKind, sighting: Sighting) -> Vec<String> {
    let door = |name: &str, door: Door| [name.to_owned(), door.0.to_string()];
    match sighting {
        Sighting::Nothing => match aid {
            AidKind::Markers(markers) if markers.are_alike() => vec!["0".to_owned()],
            _ => Vec::new(),
        },
        Sighting::Pointing(along) => door("along", along).into(),
        Sighting::Lying(count) => vec![count.to_string()],
        Sighting::TwoMarkers(view) => {
            let along = view.along.into_iter().flat_map(|along| door("along", along));
            along.chain(view.movable.then(|| "movable".to_owned())).collect()
        }
        Sighting::These(markers) => markers.numbers().map(|at| (at + 1).to_string()).collect(),
        Sighting::String(view) => {
            let ends = [("fixed", view.fixed_end), ("free", view.free_end)];
            let ends = ends.into_iter().filter(|(_, is_here)| *is_here);
            let doors = view.doors.doors().map(|door| door.0.to_string());
            let hand = view.hand.into_iter().flat_map(|hand| door("hand", hand));
            doors.chain(ends.map(|(end, _)| end.to_owned())).chain(hand).collect()
        }
        Sighting::Team(view) => view
            .0
            .into_iter()
            .flat_map(|robot| match robot {
                OtherRobot::Absent => Vec::new(),
                OtherRobot::Elsewhere { degree } => {
                    vec!["elsewhere".to_owned(), degree.to_string()]
                }
                OtherRobot::Here => vec!["here".to_owned()],
                OtherRobot::HereAlong(along) => door("here", along).into(),
                OtherRobot::WithSecond => vec!["with".to_owned(), "2".to_owned()],
                OtherRobot::WithSecondAlong(along) => {
                    [vec!["with".to_owned(), "2".to_owned()], door("along", along).into()].concat()
                }
            })
            .collect(),
        Sighting::Passed
        | Sighting::PassedAlong
        | Sighting::PassedAgainst
        | Sighting::Ball(_)
        | Sighting::Compass(_) => panic!("no aid that moves shows {sighting}"),
    }
}

/// Every action that may be possible somewhere in a graph, and some that never are.
fn candidates(aid: AidKind, graph: &EmbeddedGraph) -> Vec<Action> {
    let doors = || (0..=graph.dart_count() as u32).map(Door);
    let own: Vec<AidAction> = match aid {
        AidKind::Fixed(_) | AidKind::Binoculars(_) => Vec::new(),
        AidKind::Markers(markers) if !markers.are_alike() => (1..=markers.count())
            .flat_map(|one| [AidAction::PickUpMarker(one), AidAction::DropMarker(one)])
            .collect(),
        AidKind::Markers(_)
        | AidKind::Pointer(_)
        | AidKind::String(_)
        | AidKind::DirectionalAndMovable(_) => vec![AidAction::PickUp, AidAction::Drop],
        AidKind::Team(team) => (2..=team.robots())
            .flat_map(|robot| doors().map(move |door| AidAction::Send { robot, door }))
            .collect(),
    };
    doors().map(Action::Take).chain(own.into_iter().map(Action::Do)).collect()
}

/// A walk of so many random actions: the line that `compare/aids.ml` reads, and what it is to print.
fn walk(aid: AidKind, graph: &EmbeddedGraph, length: usize, seed: &mut u32) -> [String; 2] {
    let candidates = candidates(aid, graph);
    let mut world = GraphWorld::with_aid(graph, aid, Dart(0));
    let (mut did, mut situations) = (Vec::new(), Vec::new());
    loop {
        let possible = world.actions();
        let Percept { degree, sighting } = world.sensed();
        let seen = listed(&format!("{degree},"), shown(aid, sighting).into_iter());
        let can: Vec<_> = candidates.iter().filter(|action| possible.contains(action)).collect();
        assert_eq!(can.len(), possible.len(), "every action is a candidate");
        let can: Vec<_> = can.into_iter().map(Action::to_string).collect();
        situations.push(format!("{seen}: {}", can.join(" ")));
        if did.len() == length {
            break;
        }
        *seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let action = possible[(*seed >> 16) as usize % possible.len()];
        world.act(action).unwrap();
        did.push(action);
    }
    let darts =
        |name, end: &dyn Fn(Dart) -> Dart| listed(name, graph.darts().map(|dart| end(dart).0));
    let parts = [
        aid.name().to_owned(),
        darts("opposite", &|dart| graph.opposite(dart)),
        darts("clockwise", &|dart| graph.clockwise(dart)),
        listed("listed", candidates.into_iter()),
        listed("did", did.into_iter()),
    ];
    [parts.join("; "), situations.join("; ")]
}

/// In each of the 86 starts with up to 3 edges, and in 55 of the 706 with 4.
#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn the_aids_of_coq_show_and_allow_what_those_of_toposlam_do() {
    let folder = folder("aids");
    let sources = ["Spec.v", "Aids.v", "AidExtraction.v"];
    for file in ["_CoqProject"].into_iter().chain(sources) {
        fs::copy(source(file), folder.join(file)).unwrap();
    }
    let mut makefile = Command::new("coq_makefile");
    makefile.args(["-f", "_CoqProject"]).args(sources).args(["-o", "Makefile"]);
    printed(makefile.current_dir(&folder));

    let some = starts(Class::Multigraph, 4..=4).into_iter().step_by(13);
    let (mut seed, mut walks) = (11, Vec::new());
    for graph in starts(Class::Multigraph, 1..=3).into_iter().chain(some) {
        for aid in AIDS.into_iter().filter(Aid::moves) {
            walks.push(walk(aid, &graph, 30, &mut seed));
        }
    }
    let mut lines = walks.iter().map(|[line, _]| line.as_str()).collect::<Vec<_>>().join("\n");
    lines.push('\n');
    let extraction = ["AidExtraction.vo", "aids", "compare/aids.ml"];
    let proved = run_extracted(&folder, extraction, &lines);
    assert_eq!(proved.lines().count(), walks.len());
    for ([line, running], proved) in walks.iter().zip(proved.lines()) {
        assert_eq!(proved, running, "{line}");
    }
    let moving = AIDS.into_iter().filter(Aid::moves).count();
    assert_eq!(walks.len(), moving * (86 + 55));
}
