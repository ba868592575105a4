//! The story of a run, round by round, for a person to read.

mod movable;

use std::io::{self, Write};

use toposlam_model::{
    embedded_graph::Dart,
    format::named_world::NamedWorld,
    mapping::{Journey, MappingEvent, Observer, PartialMap},
    percept::{Percept, Sighting},
    world::Action,
};

use crate::cli::text::{counted, vertices};

/// How much is told.
#[derive(Clone, Copy)]
pub(crate) struct StoryDetail {
    /// Everything that was rejected, or only the first few of each round.
    pub(crate) every_hypothesis: bool,
    /// The doors taken, and what was done with the marker.
    pub(crate) doors: bool,
}

/// How many of those rejected in a round are told one by one, where not all are wanted.
const TOLD: usize = 4;

/// Tells a run as it goes.
pub(crate) struct Story<W> {
    out: W,
    detail: StoryDetail,
    result: io::Result<()>,
    round: u64,
    actions: Vec<Action>,
    /// Rejected in this round; with a movable marker, at this stage of it.
    rejected: usize,
    /// Moves at the beginning of what is told next.
    moves: u64,
}

impl<W: Write> Story<W> {
    pub(crate) fn new(out: W, world: &NamedWorld, facing: Dart, detail: StoryDetail) -> Self {
        let (at, back) = (world.at_text(facing), world.facing_text(facing));
        let head = format!("{}, from {at} with its back to the door {back}.", world.name);
        Self::under(out, &head, detail)
    }

    /// The story of a run, under a head that says where it is.
    pub(crate) fn under(mut out: W, head: &str, detail: StoryDetail) -> Self {
        let result = writeln!(out, "{head}");
        Self { out, detail, result, round: 0, actions: Vec::new(), rejected: 0, moves: 0 }
    }

    /// Where it is written.
    pub(crate) fn out(&self) -> &W {
        &self.out
    }

    pub(crate) fn finish(self) -> io::Result<W> {
        self.result.map(|()| self.out)
    }

    fn tell(&mut self, journey: &Journey, event: MappingEvent) -> io::Result<()> {
        let map = journey.map();
        if self.detail.doors {
            self.actions.extend(event.action());
        }
        match event {
            MappingEvent::Started { percept } => {
                let marker = match percept.sighting {
                    Sighting::Pointing(_) => "It drops its marker",
                    _ => "Its marker lies",
                };
                writeln!(self.out, "{marker} at v0, where it senses {percept}.")
            }
            MappingEvent::Moved { .. } => Ok(()),
            MappingEvent::Arrived { edge, percept, contradicted, hypotheses } => {
                self.tell_round(journey, edge, "", percept)?;
                match (contradicted, hypotheses) {
                    (0, 0) => writeln!(self.out, "     nothing else is unexplored"),
                    (_, 0) => writeln!(self.out, "     no other unexplored dart fits"),
                    (_, fit) => {
                        let others = counted(contradicted + fit, "other unexplored dart");
                        writeln!(self.out, "     {fit} of the {others} may fit")
                    }
                }
            }
            MappingEvent::Rejected { hypothesis, followed, expected, perceived } => {
                let why = format!(
                    "no, its path fails at move {followed}: {} instead of {}",
                    seen_against(perceived, expected),
                    seen_against(expected, perceived),
                );
                self.tell_rejected(journey, &dart(map, hypothesis), &why)
            }
            MappingEvent::Confirmed { hypothesis, followed } => {
                self.tell_untold()?;
                let moves = self.count_moves(journey);
                let how = match followed {
                    0 => "the marker is here and points as it must".to_owned(),
                    _ => format!("its path leads to the marker, which points as it must ({moves})"),
                };
                writeln!(self.out, "     {}? yes: {how}", dart(map, hypothesis))
            }
            MappingEvent::LoopClosed { edge, other } => {
                writeln!(
                    self.out,
                    "     so {} and {} are one edge",
                    dart(map, edge),
                    dart(map, other)
                )?;
                self.tell_map(map)
            }
            MappingEvent::VertexAdded { edge, vertex } => {
                self.tell_untold()?;
                writeln!(
                    self.out,
                    "     so {} leads to a new vertex, v{}",
                    dart(map, edge),
                    vertex.0
                )?;
                self.tell_map(map)
            }
            MappingEvent::Movable(event) => self.tell_movable(journey, event),
        }
    }

    /// A round begins: what there is behind an unexplored dart.
    fn tell_round(
        &mut self,
        journey: &Journey,
        edge: Dart,
        with: &str,
        percept: Percept,
    ) -> io::Result<()> {
        self.round += 1;
        self.rejected = 0;
        let edge = dart(journey.map(), edge);
        let moves = self.count_moves(journey);
        writeln!(self.out, "\n{:>3}  behind {edge}, after {moves}{with}: {percept}", self.round)
    }

    /// One of those that may be it is not, and why.
    fn tell_rejected(&mut self, journey: &Journey, what: &str, why: &str) -> io::Result<()> {
        self.rejected += 1;
        let moves = self.count_moves(journey);
        if self.rejected > TOLD && !self.detail.every_hypothesis {
            return Ok(());
        }
        writeln!(self.out, "     {what}? {why} ({moves})")
    }

    /// The rejected ones that were not told one by one.
    fn tell_untold(&mut self) -> io::Result<()> {
        let rejected = std::mem::take(&mut self.rejected);
        if rejected > TOLD && !self.detail.every_hypothesis {
            let more = rejected - TOLD;
            writeln!(self.out, "     ... and {more} more, all rejected")?;
        }
        Ok(())
    }

    fn tell_map(&mut self, map: &PartialMap) -> io::Result<()> {
        if self.detail.doors {
            let doors: Vec<_> = self.actions.drain(..).map(|action| action.to_string()).collect();
            writeln!(self.out, "     doors: {}", doors.join(" "))?;
        }
        let unexplored = map.unexplored_count();
        let edges = (map.dart_count() - unexplored as usize) / 2;
        writeln!(
            self.out,
            "     known: {}, {}; unexplored: {}",
            vertices(map.vertex_count()),
            counted(edges, "edge"),
            counted(unexplored as usize, "dart"),
        )
    }

    fn count_moves(&mut self, journey: &Journey) -> String {
        let moves = journey.moves() - std::mem::replace(&mut self.moves, journey.moves());
        counted(moves as usize, "move")
    }
}

impl<W: ?Sized, O: Write> Observer<W> for Story<O> {
    fn event(&mut self, _: &mut W, journey: &Journey, event: MappingEvent) {
        if self.result.is_ok() {
            self.result = self.tell(journey, event);
        }
    }
}

/// The name of a dart of the map: its vertex and its index there.
fn dart(map: &PartialMap, dart: Dart) -> String {
    format!("v{}.{}", map.vertex(dart).0, map.index(dart))
}

/// A percept that differs from another one. It says "no marker" if the other one has a marker.
fn seen_against(percept: Percept, other: Percept) -> String {
    let absent = percept.sighting == Sighting::Nothing && other.sighting != Sighting::Nothing;
    format!("{percept}{}", if absent { ", no marker" } else { "" })
}
