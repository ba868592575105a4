//! The story of a run of Algorithm 1, round by round, for a person to read.

use std::io::{self, Write};

use toposlam_model::{
    embedded_graph::Dart,
    format::named_world::NamedWorld,
    mapping::{Event, Journey, Observer, PartialMap},
    percept::{Door, Percept, Sighting},
};

/// How much is told.
#[derive(Clone, Copy)]
pub(super) struct Detail {
    /// Every rejected hypothesis, or only the first few of each round.
    pub(super) every_hypothesis: bool,
    /// The doors taken.
    pub(super) doors: bool,
}

/// How many rejected hypotheses of a round are told one by one, where not all are wanted.
const TOLD: usize = 4;

/// Tells a run as it goes.
pub(super) struct Story<'o, W> {
    out: &'o mut W,
    detail: Detail,
    result: io::Result<()>,
    round: u64,
    doors: Vec<Door>,
    /// Rejected in this round.
    rejected: usize,
    /// Moves at the beginning of what is told next.
    moves: u64,
}

impl<'o, W: Write> Story<'o, W> {
    pub(super) fn new(out: &'o mut W, world: &NamedWorld, facing: Dart, detail: Detail) -> Self {
        let result = writeln!(
            out,
            "{}, from {} with its back to the door {}.",
            world.name,
            world.at_text(facing),
            world.facing_text(facing)
        );
        Self { out, detail, result, round: 0, doors: Vec::new(), rejected: 0, moves: 0 }
    }

    pub(super) fn finish(self) -> io::Result<()> {
        self.result
    }

    fn tell(&mut self, journey: &Journey, event: Event) -> io::Result<()> {
        let map = journey.map();
        match event {
            Event::Started { percept } => {
                writeln!(self.out, "It drops its marker at v0, where it senses {percept}.")
            }
            Event::Moved { door, .. } => {
                if self.detail.doors {
                    self.doors.push(door);
                }
                Ok(())
            }
            Event::Arrived { edge, percept, contradicted, hypotheses } => {
                self.round += 1;
                self.rejected = 0;
                let edge = dart(map, edge);
                let moves = self.count_moves(journey);
                writeln!(self.out, "\n{:>3}  behind {edge}, after {moves}: {percept}", self.round)?;
                match (contradicted, hypotheses) {
                    (0, 0) => writeln!(self.out, "     nothing else is unexplored"),
                    (_, 0) => writeln!(self.out, "     no other unexplored dart fits"),
                    (_, fit) => {
                        let others = counted(contradicted + fit, "other unexplored dart");
                        writeln!(self.out, "     {fit} of the {others} may fit")
                    }
                }
            }
            Event::Rejected { hypothesis, followed, expected, perceived } => {
                self.rejected += 1;
                let moves = self.count_moves(journey);
                if self.rejected > TOLD && !self.detail.every_hypothesis {
                    return Ok(());
                }
                writeln!(
                    self.out,
                    "     {}? no, its path fails at move {followed}: {} instead of {} ({moves})",
                    dart(map, hypothesis),
                    seen_against(perceived, expected),
                    seen_against(expected, perceived),
                )
            }
            Event::Confirmed { hypothesis, followed } => {
                self.tell_untold()?;
                let moves = self.count_moves(journey);
                let how = match followed {
                    0 => "the marker is here and points as it must".to_owned(),
                    _ => format!("its path leads to the marker, which points as it must ({moves})"),
                };
                writeln!(self.out, "     {}? yes: {how}", dart(map, hypothesis))
            }
            Event::LoopClosed { edge, other } => {
                writeln!(
                    self.out,
                    "     so {} and {} are one edge",
                    dart(map, edge),
                    dart(map, other)
                )?;
                self.tell_map(map)
            }
            Event::VertexAdded { edge, vertex } => {
                self.tell_untold()?;
                writeln!(
                    self.out,
                    "     so {} leads to a new vertex, v{}",
                    dart(map, edge),
                    vertex.0
                )?;
                self.tell_map(map)
            }
            // Algorithm 1 has none of these.
            Event::Movable(_) => Ok(()),
        }
    }

    /// The rejected hypotheses that were not told one by one.
    fn tell_untold(&mut self) -> io::Result<()> {
        if self.rejected > TOLD && !self.detail.every_hypothesis {
            let more = self.rejected - TOLD;
            writeln!(self.out, "     ... and {more} more, all rejected")?;
        }
        Ok(())
    }

    fn tell_map(&mut self, map: &PartialMap) -> io::Result<()> {
        if self.detail.doors {
            let doors: Vec<_> = self.doors.drain(..).map(|door| door.0.to_string()).collect();
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

impl<W: Write> Observer for Story<'_, W> {
    fn event(&mut self, journey: &Journey, event: Event) {
        if self.result.is_ok() {
            self.result = self.tell(journey, event);
        }
    }
}

/// A dart of the map.
fn dart(map: &PartialMap, dart: Dart) -> String {
    format!("v{}.{}", map.vertex(dart).0, map.index(dart))
}

/// A percept beside another: that there is no marker is told where it is what differs.
fn seen_against(percept: Percept, other: Percept) -> String {
    let absent = percept.sighting == Sighting::Nothing && other.sighting != Sighting::Nothing;
    format!("{percept}{}", if absent { ", no marker" } else { "" })
}

/// So many of something.
pub(super) fn counted(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

pub(super) fn vertices(number: usize) -> String {
    if number == 1 { "1 vertex".to_owned() } else { format!("{number} vertices") }
}
