//! The text of a proof.

use std::fmt::{self, Display, Formatter};

use super::{
    ChoiceLine, Claim, Passage, PerceivedRun, PerceivedWalk, Proof, Seen, UnionStep,
    WalkContradiction, WalkPair,
};
use crate::{
    aid::AidAction,
    embedded_graph::{Dart, EmbeddedGraph},
    percept::{Door, MarkerSet, Percept, Sighting},
    trace::TraceEventKind,
    visits::{ChosenAlternative, VisitAlternative, VisitSet, VisitWay},
};

/// The first line of each proof.
const HEAD: &str = "toposlam-proof 1";

/// What is seen of a fixed marker; `None` for other aids.
pub(super) fn word(sighting: Sighting) -> Option<String> {
    let these = |numbers: &[usize]| MarkerSet::from_numbers(numbers.iter().copied());
    let word = match sighting {
        Sighting::Pointing(Door(door)) => return Some(format!("pointing {door}")),
        Sighting::Nothing => "nothing",
        Sighting::Lying(1) => "lying",
        Sighting::Lying(2) => "two",
        Sighting::These(set) if Some(set) == these(&[0]) => "first",
        Sighting::These(set) if Some(set) == these(&[1]) => "second",
        Sighting::These(set) if Some(set) == these(&[0, 1]) => "both",
        Sighting::Passed => "passed",
        Sighting::PassedAlong => "along",
        Sighting::PassedAgainst => "against",
        _ => return None,
    };
    Some(word.to_owned())
}

impl Display for Proof<'_> {
    fn fmt(&self, out: &mut Formatter) -> fmt::Result {
        writeln!(out, "{HEAD}")?;
        for &(graph, facing) in &self.worlds {
            write_world(out, graph, facing)?;
        }
        if let Some(Seen::Run(run)) = &self.seen {
            write!(out, "{run}")?;
        } else {
            writeln!(out, "marker {}", self.marker.name())?;
        }
        match &self.seen {
            Some(Seen::Walk(walk)) => write!(out, "{walk}")?,
            Some(Seen::Visits(visits)) => write_visits(out, visits)?,
            Some(Seen::Run(_)) | None => {}
        }
        self.claims.iter().try_for_each(|claim| write!(out, "{claim}"))
    }
}

fn write_world(out: &mut Formatter, graph: &EmbeddedGraph, facing: Dart) -> fmt::Result {
    writeln!(out, "world")?;
    for vertex in graph.vertices() {
        write_darts(out, "vertex", graph.darts_of(vertex))?;
    }
    for (one, other) in graph.edges() {
        write_darts(out, "edge", [one, other])?;
    }
    write_darts(out, "facing", [facing])
}

/// A line with a word and the numbers of darts.
fn write_darts(
    out: &mut Formatter,
    word: &str,
    darts: impl IntoIterator<Item = Dart>,
) -> fmt::Result {
    write!(out, "{word}")?;
    darts.into_iter().try_for_each(|dart| write!(out, " {}", dart.0))?;
    writeln!(out)
}

impl Display for PerceivedWalk {
    fn fmt(&self, out: &mut Formatter) -> fmt::Result {
        writeln!(out, "walk")?;
        let mut doors = self.doors().iter();
        for &percept in self.percepts() {
            write_percept(out, percept)?;
            if let Some(door) = doors.next() {
                writeln!(out, "door {}", door.0)?;
            }
        }
        Ok(())
    }
}

fn write_percept(out: &mut Formatter, Percept { degree, sighting }: Percept) -> fmt::Result {
    writeln!(out, "see {degree} {}", word(sighting).unwrap_or_default())
}

impl Display for PerceivedRun {
    fn fmt(&self, out: &mut Formatter) -> fmt::Result {
        writeln!(out, "aid {}\nrun", self.aid().name())?;
        for &event in self.events() {
            match event {
                TraceEventKind::Percept(percept) => write_percept(out, percept)?,
                TraceEventKind::Door(door) => writeln!(out, "door {}", door.0)?,
                TraceEventKind::Action(AidAction::PickUp) => writeln!(out, "do pick-up")?,
                TraceEventKind::Action(AidAction::Drop) => writeln!(out, "do drop")?,
                TraceEventKind::Action(_) => {}
            }
        }
        Ok(())
    }
}

fn write_visits(out: &mut Formatter, visits: &[VisitSet]) -> fmt::Result {
    writeln!(out, "visits")?;
    for visit in visits {
        let way = match visit.way() {
            VisitWay::Through => "through",
            VisitWay::Back => "back",
        };
        writeln!(out, "visit {way}")?;
        for alternative in visit.alternatives() {
            let Some(VisitAlternative { percept, door }) = alternative else {
                writeln!(out, "none")?;
                continue;
            };
            let door = door.map_or_else(|| "any".to_owned(), |door| door.0.to_string());
            let sighting = word(percept.sighting).unwrap_or_default();
            writeln!(out, "junction {} {door} {sighting}", percept.degree)?;
        }
    }
    Ok(())
}

impl Display for Claim {
    fn fmt(&self, out: &mut Formatter) -> fmt::Result {
        writeln!(out, "claim {}", self.name())?;
        match self {
            Self::Determined { from, steps } => {
                write_darts(out, "from", [*from])?;
                write_steps(out, steps)?;
            }
            Self::Unexplained { steps, contradiction } => {
                write_steps(out, steps)?;
                writeln!(out, "contradiction {contradiction}")?;
            }
            Self::Conforms { from } => write_darts(out, "from", [*from])?,
            Self::Fits { from, choice } => {
                write_darts(out, "from", [*from])?;
                choice.iter().try_for_each(|chosen| writeln!(out, "{}", chosen_text(chosen)))?;
            }
            Self::Impossible { lines } => {
                lines.iter().try_for_each(|line| writeln!(out, "{line}"))?;
            }
            Self::Diverges { from: Some(from) } | Self::Misfits { from: Some(from) } => {
                write_darts(out, "from", from.iter().copied())?;
            }
            Self::Diverges { from: None } | Self::Misfits { from: None } => {
                writeln!(out, "from any")?;
            }
            Self::Indistinguishable { pairs } => {
                for pair in pairs {
                    write_darts(out, "pair", *pair)?;
                }
            }
            Self::Distinguishable { walks } | Self::NotIsomorphic { walks } => {
                for WalkPair { from, doors } in walks {
                    write_darts(out, "from", *from)?;
                    doors.iter().try_for_each(|door| writeln!(out, "door {}", door.0))?;
                }
            }
            Self::Isomorphic { images } => {
                for (dart, image) in (0..).map(Dart).zip(images) {
                    write_darts(out, "image", [dart, *image])?;
                }
            }
        }
        writeln!(out, "end")
    }
}

fn write_steps(out: &mut Formatter, steps: &[UnionStep]) -> fmt::Result {
    steps.iter().try_for_each(|step| writeln!(out, "{step}"))
}

fn chosen_text(ChosenAlternative { number, door }: &ChosenAlternative) -> String {
    let door = door.map_or_else(String::new, |door| format!(" {}", door.0));
    format!("choose {number}{door}")
}

impl Display for ChoiceLine {
    fn fmt(&self, out: &mut Formatter) -> fmt::Result {
        match self {
            Self::Choose(chosen) => out.write_str(&chosen_text(chosen)),
            Self::Step(step) => write!(out, "{step}"),
            Self::Contradiction(contradiction) => write!(out, "contradiction {contradiction}"),
            Self::BackElsewhere => out.write_str("contradiction back"),
        }
    }
}

impl Display for UnionStep {
    fn fmt(&self, out: &mut Formatter) -> fmt::Result {
        match self {
            Self::Mark(visits) => write!(out, "mark {} {}", visits[0], visits[1]),
            Self::Beyond(passages) => write!(out, "beyond {} {}", passages[0], passages[1]),
        }
    }
}

impl Display for Passage {
    fn fmt(&self, out: &mut Formatter) -> fmt::Result {
        write!(out, "{}{}", if self.is_onward { '+' } else { '-' }, self.number)
    }
}

impl Display for WalkContradiction {
    fn fmt(&self, out: &mut Formatter) -> fmt::Result {
        match self {
            Self::Step(step) => write!(out, "{step}"),
            Self::Sightings([one, other]) => write!(out, "sightings {one} {other}"),
            Self::Edge(passage) => write!(out, "edge {passage}"),
            Self::Percept(visit) => write!(out, "percept {visit}"),
            Self::Door(visit) => write!(out, "door {visit}"),
            Self::Unmarked => write!(out, "unmarked"),
        }
    }
}
