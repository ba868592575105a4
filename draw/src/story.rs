//! The story of a mapping run, round by round.

mod folding;
mod movable;
mod safeguard;

use std::{
    fmt::{self, Display, Formatter},
    io::{self, Write},
    mem,
};

use toposlam_model::{
    embedded_graph::Dart,
    format::named_world::NamedWorld,
    mapping::{MapWalk, MappingEvent, Observer, PartialMap},
    percept::{OtherRobot, Percept, Sighting, TeamView},
};

use crate::{
    moment::grouped,
    run_page_data::MappingStep,
    text::{counted, print_indented, vertices},
};

/// How many rejected candidates of a round are printed.
const PRINTED_REJECTIONS: usize = 4;

/// A line of a story, before it is wrapped.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct StoryLine {
    head: String,
    /// By how many columns the lines are indented that follow in a terminal.
    indent: usize,
    text: String,
}

impl StoryLine {
    fn hanging(head: String, text: String) -> Self {
        Self { indent: head.len(), head, text }
    }

    /// Prints it in wrapped lines.
    fn print(&self, out: &mut dyn Write) -> io::Result<()> {
        print_indented(out, &self.head, self.indent, &self.text)
    }
}

/// The whole line.
impl Display for StoryLine {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.head, self.text)
    }
}

/// Puts the events of a run into words.
#[derive(Debug)]
pub struct Story {
    /// Since they were last taken.
    lines: Vec<StoryLine>,
    round: u64,
    /// Rejected in this round. With a movable marker: in this stage of the round.
    rejected: usize,
    /// The moves for those of them that were not printed.
    moves_not_printed: u64,
    /// The robot's moves up to the last line.
    moves: u64,
    /// None before the run has started.
    aid: Option<StoryAid>,
    /// The number of the robot that was sent last.
    sent: u8,
}

/// What the robot marks places with, if that moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum StoryAid {
    Marker,
    Markers,
    String,
    /// A string that lies over one edge.
    LaidString,
    Scouts,
}

impl Story {
    /// The story of a run in a world, from its start.
    #[must_use]
    pub fn new(world: &NamedWorld, facing: Dart) -> Self {
        Self::with_head(head(world, facing))
    }

    /// The story of a run in a world that the head describes.
    #[must_use]
    pub fn with_head(head: String) -> Self {
        let lines = vec![StoryLine { text: head, ..StoryLine::default() }];
        Self { lines, round: 0, rejected: 0, moves_not_printed: 0, moves: 0, aid: None, sent: 2 }
    }

    /// The lines of a whole story, and the number of them after each number of steps.
    pub(crate) fn of_steps(mut self, steps: &[MappingStep]) -> (Vec<String>, Vec<usize>) {
        let mut counts = vec![self.lines.len()];
        for MappingStep { walk, event } in steps {
            self.add_event(walk, *event);
            counts.push(self.lines.len());
        }
        (self.lines.iter().map(StoryLine::to_string).collect(), counts)
    }

    /// An empty line and a paragraph.
    fn add_section(&mut self, text: String) {
        self.lines.push(StoryLine::default());
        self.add_paragraph(text);
    }

    fn add_paragraph(&mut self, text: String) {
        self.lines.push(StoryLine { text, ..StoryLine::default() });
    }

    fn add_event(&mut self, journey: &MapWalk, event: MappingEvent) {
        let map = journey.map();
        match event {
            MappingEvent::Started { percept } => {
                let (aid, at_start) = at_start(percept.sighting, self.aid.is_some());
                self.aid = Some(aid);
                let text = format!("{at_start}, at vertex v0 of the map. It senses {percept}.");
                self.add_paragraph(text);
            }
            MappingEvent::Moved { .. } => {}
            MappingEvent::Arrived { edge, percept, contradicted, hypotheses } => {
                self.add_round(journey, edge, "", percept);
                self.add_candidates(contradicted, hypotheses);
            }
            MappingEvent::Rejected { hypothesis, followed, expected, perceived } => {
                let why = format!(
                    "at move {} of its path: expected {}, sensed {}",
                    grouped(followed.into()),
                    percept_text(expected, perceived),
                    percept_text(perceived, expected),
                );
                self.add_rejected(journey, &dart(map, hypothesis), &why);
            }
            MappingEvent::Confirmed { hypothesis, followed } => {
                let why = match followed {
                    0 => "the marker is here and points as expected",
                    _ => "its path leads to the marker, which points as expected",
                };
                self.add_confirmed(journey, &dart(map, hypothesis), why);
            }
            MappingEvent::LoopClosed { edge, other } => {
                let (edge, other) = (dart(map, edge), dart(map, other));
                self.add_line(format!("So {edge} and {other} are the two ends of one edge."));
                self.add_map(map);
            }
            MappingEvent::VertexAdded { edge, vertex } => {
                self.add_omitted();
                let edge = dart(map, edge);
                self.add_line(format!("So {edge} leads to a new vertex, v{}.", vertex.0));
                self.add_map(map);
            }
            MappingEvent::Movable(event) => self.add_movable(journey, event),
            MappingEvent::Folding(event) => self.add_folding(journey, event),
            MappingEvent::Safeguard(event) => self.add_safeguard(journey, event),
        }
    }

    /// A round begins: the robot has followed an unexplored dart.
    fn add_round(&mut self, journey: &MapWalk, edge: Dart, with: &str, percept: Percept) {
        let (edge, moves) = (dart(journey.map(), edge), self.take_moves(journey));
        self.begin_round(format!("the robot takes {edge}{with}{moves} and senses {percept}."));
    }

    fn begin_round(&mut self, text: String) {
        self.round += 1;
        self.lines.push(StoryLine::default());
        let head = format!("Round {}: ", grouped(self.round.into()));
        self.lines.push(StoryLine::hanging(head, text));
    }

    /// How many unexplored darts may be the other end of the edge that was just taken.
    fn add_candidates(&mut self, contradicted: usize, left: usize) {
        if contradicted + left == 0 {
            return self.add_line("No other dart is unexplored.");
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
        self.add_line(format!(
            "Possible other ends: {darts}. The percept rules out {ruled_out}: {left} left."
        ));
    }

    fn add_rejected(&mut self, journey: &MapWalk, what: &str, why: &str) {
        self.rejected += 1;
        if self.rejected > PRINTED_REJECTIONS {
            self.moves_not_printed += journey.moves() - self.moves;
            self.moves = journey.moves();
            return;
        }
        let moves = self.take_moves(journey);
        self.add_line(format!("Candidate {what}: rejected {why}{moves}."));
    }

    fn add_confirmed(&mut self, journey: &MapWalk, what: &str, why: &str) {
        self.add_omitted();
        let moves = self.take_moves(journey);
        self.add_line(format!("Candidate {what}: confirmed, {why}{moves}."));
    }

    /// How many rejected candidates were not printed.
    fn add_omitted(&mut self) {
        let (rejected, moves) =
            (mem::take(&mut self.rejected), mem::take(&mut self.moves_not_printed));
        if rejected > PRINTED_REJECTIONS {
            let more = grouped((rejected - PRINTED_REJECTIONS) as u128);
            self.add_line(format!("... and {more} more, all rejected{}.", in_moves(moves)));
        }
    }

    fn add_map(&mut self, map: &PartialMap) {
        let unexplored = map.unexplored_count() as usize;
        let edges = counted((map.dart_count() - unexplored) / 2, "edge");
        let (vertices, unexplored) = (vertices(map.vertex_count()), counted(unexplored, "dart"));
        self.add_line(format!("Known: {vertices}, {edges}. Unexplored: {unexplored}."));
    }

    fn add_line(&mut self, text: impl Display) {
        self.lines.push(StoryLine { head: "  ".to_owned(), indent: 4, text: text.to_string() });
    }

    /// The moves since the last line, in parentheses.
    fn take_moves(&mut self, journey: &MapWalk) -> String {
        in_moves(journey.moves() - mem::replace(&mut self.moves, journey.moves()))
    }
}

/// A story that is printed while the run goes on, if there is an output.
#[derive(Debug)]
pub struct PrintedStory<W> {
    story: Story,
    out: Option<W>,
    result: io::Result<()>,
}

impl<W: Write> PrintedStory<W> {
    /// A story without events.
    pub fn new(story: Story, out: Option<W>) -> Self {
        Self { story, out, result: Ok(()) }
    }

    /// Prints the lines since the last call.
    pub fn print(&mut self) {
        let lines = mem::take(&mut self.story.lines);
        if let (Ok(()), Some(out)) = (&self.result, &mut self.out) {
            self.result = lines.iter().try_for_each(|line| line.print(out));
        }
    }

    /// Puts an event into words and prints them.
    pub fn add(&mut self, journey: &MapWalk, event: MappingEvent) {
        self.story.add_event(journey, event);
        self.print();
    }

    /// The output, after the last event.
    ///
    /// # Errors
    /// Returns the first error of the output.
    pub fn finish(mut self) -> io::Result<Option<W>> {
        self.print();
        self.result.map(|()| self.out)
    }
}

impl<W: ?Sized, O: Write> Observer<W> for PrintedStory<O> {
    fn event(&mut self, _: &mut W, journey: &MapWalk, event: MappingEvent) {
        self.add(journey, event);
    }
}

/// The world and the start of a run.
pub fn head(world: &NamedWorld, facing: Dart) -> String {
    let NamedWorld { name, edge_names, .. } = world;
    let (at, behind) = (world.at_text(facing), world.facing_text(facing));
    let behind = match edge_names {
        None => format!("the door to {behind}"),
        Some(_) => format!("the door of edge {behind}"),
    };
    format!("World {name}. The robot starts at {at}, with its back to {behind}.")
}

/// What the robot has at its start, and where that is, in words.
fn at_start(sighting: Sighting, string_is_laid: bool) -> (StoryAid, &'static str) {
    match sighting {
        Sighting::Pointing(_) if string_is_laid => {
            (StoryAid::LaidString, "The fixed end of its string is here, as a marker")
        }
        Sighting::Pointing(_) => (StoryAid::Marker, "It puts its marker down here"),
        Sighting::Lying(2..) | Sighting::These(_) | Sighting::TwoMarkers(_) => {
            (StoryAid::Markers, "Its markers lie here")
        }
        Sighting::String(_) => (StoryAid::String, "The fixed end of its string is here"),
        Sighting::Team(TeamView([_, OtherRobot::Absent])) => {
            (StoryAid::Scouts, "The other robot is here")
        }
        Sighting::Team(_) => (StoryAid::Scouts, "The other robots are here"),
        _ => (StoryAid::Marker, "Its marker lies here"),
    }
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
