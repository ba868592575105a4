//! The story of a mapping run, round by round.

mod folding;
mod movable;
mod safeguard;

use std::{
    fmt::Display,
    io::{self, Write},
    mem,
};

use toposlam_model::{
    embedded_graph::Dart,
    format::named_world::NamedWorld,
    mapping::{Journey, MappingEvent, Observer, PartialMap},
    percept::{Percept, Sighting},
    world::Action,
};

use crate::{
    moment::grouped,
    text::{counted, print_hanging, print_indented, print_paragraph, vertices},
};

/// How much a story contains.
#[derive(Clone, Copy, Debug)]
pub struct StoryDetail {
    /// Every rejected candidate, and not only the first few of each round.
    pub every_hypothesis: bool,
    /// The doors taken, and each pick-up and drop of the marker.
    pub doors: bool,
}

/// How many rejected candidates of a round are printed unless all are wanted.
const PRINTED_REJECTIONS: usize = 4;

/// Prints a run while it goes on.
#[derive(Debug)]
pub struct Story<W> {
    out: W,
    detail: StoryDetail,
    result: io::Result<()>,
    round: u64,
    actions: Vec<Action>,
    /// Rejected in this round. With a movable marker: in this stage of the round.
    rejected: usize,
    /// The moves for those of them that were not printed.
    moves_not_printed: u64,
    /// The robot's moves up to the last line.
    moves: u64,
}

impl<W: Write> Story<W> {
    /// The story of a run in a world, from its start.
    pub fn new(out: W, world: &NamedWorld, facing: Dart, detail: StoryDetail) -> Self {
        Self::with_head(out, &head(world, facing), detail)
    }

    /// The story of a run in a world that the head describes.
    pub fn with_head(mut out: W, head: &str, detail: StoryDetail) -> Self {
        let result = print_paragraph(&mut out, head);
        let (actions, rejected, moves_not_printed) = (Vec::new(), 0, 0);
        Self { out, detail, result, round: 0, actions, rejected, moves_not_printed, moves: 0 }
    }

    /// The output.
    #[must_use]
    pub fn out(&self) -> &W {
        &self.out
    }

    /// The output, after the last event.
    ///
    /// # Errors
    /// Returns the first error of the output.
    pub fn finish(self) -> io::Result<W> {
        self.result.map(|()| self.out)
    }

    fn print_event(&mut self, journey: &Journey, event: MappingEvent) -> io::Result<()> {
        let map = journey.map();
        if self.detail.doors {
            self.actions.extend(event.action());
        }
        match event {
            MappingEvent::Started { percept } => {
                let marker = match percept.sighting {
                    Sighting::Pointing(_) => "It puts its marker down here",
                    _ => "Its marker lies here",
                };
                let text = format!("{marker}, at vertex v0 of the map. It senses {percept}.");
                print_paragraph(&mut self.out, &text)
            }
            MappingEvent::Moved { .. } => Ok(()),
            MappingEvent::Arrived { edge, percept, contradicted, hypotheses } => {
                self.print_round(journey, edge, "", percept)?;
                self.print_candidates(contradicted, hypotheses)
            }
            MappingEvent::Rejected { hypothesis, followed, expected, perceived } => {
                let why = format!(
                    "at move {} of its path: expected {}, sensed {}",
                    grouped(followed.into()),
                    percept_text(expected, perceived),
                    percept_text(perceived, expected),
                );
                self.print_rejected(journey, &dart(map, hypothesis), &why)
            }
            MappingEvent::Confirmed { hypothesis, followed } => {
                let why = match followed {
                    0 => "the marker is here and points as expected",
                    _ => "its path leads to the marker, which points as expected",
                };
                self.print_confirmed(journey, &dart(map, hypothesis), why)
            }
            MappingEvent::LoopClosed { edge, other } => {
                let (edge, other) = (dart(map, edge), dart(map, other));
                self.print_line(format!("So {edge} and {other} are the two ends of one edge."))?;
                self.print_map(map)
            }
            MappingEvent::VertexAdded { edge, vertex } => {
                self.print_omitted()?;
                let edge = dart(map, edge);
                self.print_line(format!("So {edge} leads to a new vertex, v{}.", vertex.0))?;
                self.print_map(map)
            }
            MappingEvent::Movable(event) => self.print_movable(journey, event),
            MappingEvent::Folding(event) => self.print_folding(journey, event),
            MappingEvent::Safeguard(event) => self.print_safeguard(journey, event),
        }
    }

    /// A round begins: the robot has followed an unexplored dart.
    fn print_round(
        &mut self,
        journey: &Journey,
        edge: Dart,
        with: &str,
        percept: Percept,
    ) -> io::Result<()> {
        self.round += 1;
        let (round, edge) = (grouped(self.round.into()), dart(journey.map(), edge));
        let moves = self.take_moves(journey);
        writeln!(self.out)?;
        let text = format!("the robot takes {edge}{with}{moves} and senses {percept}.");
        print_hanging(&mut self.out, &format!("Round {round}: "), &text)
    }

    /// How many unexplored darts may be the other end of the edge that was just taken.
    fn print_candidates(&mut self, contradicted: usize, left: usize) -> io::Result<()> {
        if contradicted + left == 0 {
            return self.print_line("No other dart is unexplored.");
        }
        let darts = counted(contradicted + left, "dart");
        let ruled_out = match contradicted {
            0 => "none".to_owned(),
            some => grouped(some as u128),
        };
        let left = match left {
            0 => "no candidate".to_owned(),
            some => counted(some, "candidate"),
        };
        self.print_line(format!(
            "Possible other ends: {darts}. The percept rules out {ruled_out}: {left} left."
        ))
    }

    /// A candidate is rejected.
    fn print_rejected(&mut self, journey: &Journey, what: &str, why: &str) -> io::Result<()> {
        self.rejected += 1;
        if self.rejected > PRINTED_REJECTIONS && !self.detail.every_hypothesis {
            self.moves_not_printed += journey.moves() - self.moves;
            self.moves = journey.moves();
            return Ok(());
        }
        let moves = self.take_moves(journey);
        self.print_line(format!("Candidate {what}: rejected {why}{moves}."))
    }

    /// A candidate is confirmed.
    fn print_confirmed(&mut self, journey: &Journey, what: &str, why: &str) -> io::Result<()> {
        self.print_omitted()?;
        let moves = self.take_moves(journey);
        self.print_line(format!("Candidate {what}: confirmed, {why}{moves}."))
    }

    /// How many rejected candidates were not printed.
    fn print_omitted(&mut self) -> io::Result<()> {
        let (rejected, moves) =
            (mem::take(&mut self.rejected), mem::take(&mut self.moves_not_printed));
        if rejected > PRINTED_REJECTIONS && !self.detail.every_hypothesis {
            let more = grouped((rejected - PRINTED_REJECTIONS) as u128);
            self.print_line(format!("... and {more} more, all rejected{}.", in_moves(moves)))?;
        }
        Ok(())
    }

    /// The doors since they were last printed, if they are wanted.
    fn print_doors(&mut self) -> io::Result<()> {
        if !self.detail.doors {
            return Ok(());
        }
        let doors: Vec<_> = self.actions.drain(..).map(|action| action.to_string()).collect();
        print_hanging(&mut self.out, "  Doors: ", &doors.join(" "))
    }

    fn print_map(&mut self, map: &PartialMap) -> io::Result<()> {
        self.print_doors()?;
        let unexplored = map.unexplored_count() as usize;
        let edges = counted((map.dart_count() - unexplored) / 2, "edge");
        let (vertices, unexplored) = (vertices(map.vertex_count()), counted(unexplored, "dart"));
        self.print_line(format!("Known: {vertices}, {edges}. Unexplored: {unexplored}."))
    }

    /// A line of a round.
    fn print_line(&mut self, text: impl Display) -> io::Result<()> {
        print_indented(&mut self.out, "  ", 4, &text.to_string())
    }

    /// The moves since the last line, in parentheses.
    fn take_moves(&mut self, journey: &Journey) -> String {
        in_moves(journey.moves() - mem::replace(&mut self.moves, journey.moves()))
    }
}

impl<W: ?Sized, O: Write> Observer<W> for Story<O> {
    fn event(&mut self, _: &mut W, journey: &Journey, event: MappingEvent) {
        if self.result.is_ok() {
            self.result = self.print_event(journey, event);
        }
    }
}

/// The world and the start of a run.
#[must_use]
pub fn head(world: &NamedWorld, facing: Dart) -> String {
    let NamedWorld { name, edge_names, .. } = world;
    let (at, behind) = (world.at_text(facing), world.facing_text(facing));
    let behind = match edge_names {
        None => format!("the door to {behind}"),
        Some(_) => format!("the door of edge {behind}"),
    };
    format!("World {name}. The robot starts at {at}, with its back to {behind}.")
}

/// A number of moves in parentheses, unless it is zero.
fn in_moves(moves: u64) -> String {
    match moves {
        0 => String::new(),
        moves => format!(" ({})", counted(moves as usize, "move")),
    }
}

/// The name of a dart of the map: its vertex and its index there.
fn dart(map: &PartialMap, dart: Dart) -> String {
    format!("v{}.{}", map.vertex(dart).0, map.index(dart))
}

/// A percept that differs from another one: says "no marker" if the other one has a marker.
fn percept_text(percept: Percept, other: Percept) -> String {
    let absent = percept.sighting == Sighting::Nothing && other.sighting != Sighting::Nothing;
    format!("{percept}{}", if absent { ", no marker" } else { "" })
}
