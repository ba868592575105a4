//! Robots with the same marker in two worlds: can they distinguish the worlds?

use std::{
    io::{self, Write},
    path::Path,
};

use serde_json::{Value, json};
use toposlam_model::{
    aid::{Aid, AidKind, Places, State},
    ambiguity::{
        Bisimulation, Comparison, PlacedRobot, Relation, StateClasses, Walk, has_more_states,
    },
    embedded_graph::Dart,
    enumerate::{Interrupted, Watch},
    format::named_world::NamedWorld,
    proof::{Claim, NotProved, Proof, WalkPair},
};

use super::{CliError, walk_page};
use crate::{
    cli::text::{counted, grouped, print_columns, print_hanging, print_paragraph},
    page::{MOST_PAIRS, WalkPage},
};

/// How many starts in B, pairs of states, and classes of states are printed.
const PRINTED_STARTS: usize = 8;
const PRINTED_PAIRS: usize = 400;
const PRINTED_CLASSES: usize = 40;

/// Robots in two worlds: one start in A, one or more in B.
pub(super) struct RobotComparison<'w> {
    worlds: [&'w NamedWorld; 2],
    marker: AidKind,
    comparison: Comparison<'w>,
    start: Dart,
    /// Each start in B, with the walk that distinguishes it from the start in A, if there is one.
    others: Vec<(Dart, Option<Walk>)>,
    /// The bisimulation from the first start in B that no walk distinguishes.
    bisimulation: Option<Bisimulation>,
}

/// The most states of the robot and the marker in a world. Each state takes some 200 bytes.
const MOST_STATES: usize = 1 << 24;

impl<'w> RobotComparison<'w> {
    /// Robots at the starts of the worlds. With `one_pose` the robot in B has one start, otherwise each
    /// pose that the marker cannot distinguish from it.
    ///
    /// # Errors
    /// Returns an error if a world has too many states, or if the watch stops.
    pub(super) fn new(
        worlds: [&'w NamedWorld; 2],
        marker: AidKind,
        one_pose: bool,
        watch: &dyn Watch,
    ) -> Result<Self, CliError> {
        let [a, b] = worlds;
        let is_too_large = |world: &&NamedWorld| {
            let start = world.start.unwrap_or(Dart(0));
            has_more_states(&world.graph, marker, start, MOST_STATES)
        };
        if let Some(world) = worlds.into_iter().find(is_too_large) {
            let most = grouped(MOST_STATES as u128);
            let cause = format!("with {} it has more than {most} states", marker.name());
            return Err(CliError::at(&world.name, cause));
        }
        let (start, other) = (a.start.unwrap_or(Dart(0)), b.start.unwrap_or(Dart(0)));
        let comparison = Comparison::new(marker, (&a.graph, start), (&b.graph, other));
        let mut poses = vec![other];
        if !one_pose {
            let starts = marker.starts(&b.graph, other);
            poses.extend(starts.into_iter().filter(|&pose| pose != other));
        }
        watch.parts(poses.len());
        if poses.len() > 1 {
            // It answers for all starts at once.
            comparison.partition(watch)?;
        }
        let with_walk = |pose| {
            watch.check_stop()?;
            let walk = comparison.walk_watched([start, pose], watch)?;
            watch.part_done(1);
            Ok((pose, walk))
        };
        let others = poses.into_iter().map(with_walk).collect::<Result<Vec<_>, Interrupted>>()?;
        let mut robots = Self { worlds, marker, comparison, start, others, bisimulation: None };
        let poses = robots.poses();
        robots.bisimulation = robots.comparison.bisimulation(poses, MOST_PAIRS, watch)?;
        robots.verify()?;
        Ok(robots)
    }

    /// Verifies the walks and the relation in the worlds, independently of the search.
    fn verify(&self) -> Result<(), CliError> {
        let walks_hold = self.others.iter().all(|(pose, walk)| {
            let [one, other] = self.comparison.starts([self.start, *pose]);
            walk.as_ref().is_none_or(|walk| walk.verify(&one, &other))
        });
        let [one, other] = self.placed_robots();
        let bisimulation = self.bisimulation.as_ref();
        let bisimulation_holds = bisimulation.is_none_or(|it| it.verify(&one, &other));
        if walks_hold && bisimulation_holds {
            Ok(())
        } else {
            Err(CliError::at(
                "compare",
                "the result is not confirmed: this is a fault of the search",
            ))
        }
    }

    pub(super) fn names(&self) -> [&'w str; 2] {
        self.worlds.map(|world| world.name.as_str())
    }

    /// The start in A, and the first start in B that no walk distinguishes from it, or else the first.
    pub(super) fn poses(&self) -> [Dart; 2] {
        let indistinguishable = self.others.iter().find(|(_, walk)| walk.is_none());
        let (pose, _) = indistinguishable.or(self.others.first()).unwrap_or(&(Dart(0), None));
        [self.start, *pose]
    }

    /// The two robots at those starts.
    pub(super) fn placed_robots(&self) -> [PlacedRobot<'w>; 2] {
        self.comparison.starts(self.poses())
    }

    /// Writes the page on which a person walks both worlds.
    pub(super) fn write_page(&self, path: &Path) -> Result<(), CliError> {
        let [start, pose] = self.poses();
        let facings = [start, self.worlds[1].start.unwrap_or(Dart(0))];
        walk_page::write(
            path,
            &WalkPage { worlds: self.worlds, facings, pose, marker: self.marker },
        )
    }

    /// These starts, as `vertex:facing`.
    pub(super) fn starts_text(&self) -> [String; 2] {
        let [pose, other] = self.poses();
        [self.worlds[0].start_text(pose), self.worlds[1].start_text(other)]
    }

    /// That no walk distinguishes the robots, or that for each start in B a walk does; and a claim about the graphs.
    ///
    /// # Errors
    /// Returns an error if the marking aid moves.
    pub(super) fn proof(&self, of_graphs: Claim) -> Result<Proof<'w>, NotProved> {
        let marker = self.marker.fixed().ok_or(NotProved::Aid(self.marker.name()))?;
        let claim = match &self.bisimulation {
            Some(_) => Claim::indistinguishable(&self.comparison, self.poses()),
            None => Claim::Distinguishable {
                walks: self
                    .others
                    .iter()
                    .filter_map(|(pose, walk)| {
                        Some(WalkPair::new([self.start, *pose], walk.as_ref()?))
                    })
                    .collect(),
            },
        };
        let [a, b] = self.worlds;
        let facing = |world: &'w NamedWorld| (&world.graph, world.start.unwrap_or(Dart(0)));
        let worlds = vec![facing(a), facing(b)];
        Ok(Proof { worlds, marker, seen: None, claims: vec![of_graphs, claim] })
    }

    /// A pair of states in words.
    fn pair_text(&self, (one, other): &(State<Places>, State<Places>)) -> [String; 2] {
        let [a, b] = self.worlds;
        [a.state_text(&self.marker, one), b.state_text(&self.marker, other)]
    }

    /// The states of each class in words: those in A, and those in B.
    fn classes_text(&self, classes: &StateClasses) -> Vec<[Vec<String>; 2]> {
        let text = |side: usize, states: &[State<Places>]| {
            let world = self.worlds[side];
            states.iter().map(|state| world.state_text(&self.marker, state)).collect()
        };
        let classes = classes.classes();
        classes.iter().map(|[one, other]| [text(0, one), text(1, other)]).collect()
    }

    /// The part of the object about robots.
    pub(super) fn json(&self) -> Value {
        let Self { worlds: [a, b], marker, start, others, bisimulation, .. } = self;
        let (pairs, classes) = match bisimulation {
            None => (None, None),
            Some(Bisimulation::Relation(relation)) => {
                let pairs = relation.0.iter().map(|pair| self.pair_text(pair));
                (Some(pairs.collect::<Vec<_>>()), None)
            }
            Some(Bisimulation::Classes(classes)) => (None, Some(self.classes_text(classes))),
        };
        let actions = others.iter().map(|(_, walk)| Some(&walk.as_ref()?.actions));
        let walks: Vec<_> = actions.collect();
        json!({
            "marker": marker.name(),
            "distinguishable": bisimulation.is_none(),
            "walk": walks.first().filter(|_| bisimulation.is_none()),
            "relation": pairs,
            "classes": classes,
            "relation_starts": bisimulation.as_ref().map(|_| self.starts_text()),
            "start": a.start_text(*start),
            "starts": others.iter().map(|(pose, _)| b.start_text(*pose)).collect::<Vec<_>>(),
            "walks": walks,
        })
    }

    pub(super) fn print(&self, out: &mut dyn Write) -> io::Result<()> {
        let [a, b] = self.worlds;
        let start = a.start_text(self.start);
        writeln!(out)?;
        print_paragraph(out, &format!("{}: {}", self.marker.name(), self.marker.about()))?;
        match &self.bisimulation {
            Some(Bisimulation::Relation(relation)) => return self.print_relation(relation, out),
            Some(Bisimulation::Classes(classes)) => return self.print_classes(classes, out),
            None => {}
        }
        for (pose, walk) in self.others.iter().take(PRINTED_STARTS) {
            if let Some(Walk { actions, percepts: [one, other] }) = walk {
                let actions: Vec<_> = actions.iter().map(ToString::to_string).collect();
                let how = match actions.as_slice() {
                    [] => "the first percepts distinguish".to_owned(),
                    actions => format!("the walk {} distinguishes", actions.join(",")),
                };
                let pose = b.start_text(*pose);
                let text = format!("From {start} in A and {pose} in B {how} the worlds:");
                print_paragraph(out, &text)?;
                print_hanging(out, "  A: ", &one.to_string())?;
                print_hanging(out, "  B: ", &other.to_string())?;
            }
        }
        let more = self.others.len().saturating_sub(PRINTED_STARTS);
        if more > 0 {
            let more = counted(more, "more start");
            let text = format!("A walk also distinguishes them from {more} in B (see --json).");
            print_paragraph(out, &text)?;
        }
        Ok(())
    }

    /// Why no walk distinguishes the worlds.
    fn print_relation(&self, relation: &Relation, out: &mut dyn Write) -> io::Result<()> {
        let [start, other] = self.starts_text();
        let count = grouped(relation.0.len() as u128);
        let verdict = format!(
            "No walk distinguishes the worlds from {start} in A and {other} in B. The robots can be \
             in {count} pairs of states:"
        );
        print_paragraph(out, &verdict)?;
        let printed = relation.0.iter().take(PRINTED_PAIRS);
        let pairs: Vec<_> = printed.map(|pair| self.pair_text(pair).join("~")).collect();
        print_columns(out, &pairs)?;
        print_rest(out, relation.0.len().saturating_sub(PRINTED_PAIRS))
    }

    /// Why no walk distinguishes the worlds, if there are many pairs of states.
    fn print_classes(&self, classes: &StateClasses, out: &mut dyn Write) -> io::Result<()> {
        let [start, other] = self.starts_text();
        let number = match classes.count() {
            1 => "is 1 class".to_owned(),
            count => format!("are {} classes", grouped(count as u128)),
        };
        let verdict = format!(
            "No walk distinguishes the worlds from {start} in A and {other} in B. The robots can be \
             in more than {} pairs of states. Two states of one class are indistinguishable, and each \
             action leads from them to states of one class. There {number}:",
            grouped(MOST_PAIRS as u128),
        );
        print_paragraph(out, &verdict)?;
        for (number, states) in (1..=PRINTED_CLASSES).zip(classes.classes()) {
            let [one, other] = states.each_ref().map(|states| counted(states.len(), "state"));
            let [here, there] = [0, 1].map(|side| {
                let first = states[side].first();
                first.map_or_else(String::new, |state| {
                    format!(" ({}, ...)", self.worlds[side].state_text(&self.marker, state))
                })
            });
            let text = format!("{one} of A{here} and {other} of B{there}");
            print_hanging(out, &format!("  {number:>3}  "), &text)?;
        }
        print_rest(out, classes.count().saturating_sub(PRINTED_CLASSES))
    }
}

fn print_rest(out: &mut dyn Write, more: usize) -> io::Result<()> {
    match more {
        0 => Ok(()),
        more => writeln!(out, "  and {} more (see --json)", grouped(more as u128)),
    }
}
