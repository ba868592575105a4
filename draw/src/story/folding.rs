//! The story of the folding explorer: the darts that it takes, its tests, and how the trail folds.

use std::io::{self, Write};

use toposlam_model::{
    embedded_graph::Dart,
    mapping::{FoldingEvent, Journey, PartialMap},
};

use super::{Story, dart, percept_text};
use crate::{
    moment::grouped,
    text::{counted, print_hanging, vertices},
};

impl<W: Write> Story<W> {
    pub(super) fn print_folding(
        &mut self,
        journey: &Journey,
        event: FoldingEvent,
    ) -> io::Result<()> {
        let map = journey.map();
        match event {
            FoldingEvent::Explored { edge, percept } => {
                self.print_round(journey, edge, "", percept)
            }
            FoldingEvent::Testing { edge, hypothesis, cost } => {
                self.print_test(map, edge, hypothesis, cost)
            }
            FoldingEvent::Refuted { hypothesis, expected, perceived, .. } => {
                let moves = self.take_moves(journey);
                self.print_line(format!(
                    "Candidate {}: rejected on the way: expected {}, sensed {}{moves}.",
                    dart(map, hypothesis),
                    percept_text(expected, perceived),
                    percept_text(perceived, expected),
                ))
            }
            FoldingEvent::Confirmed { hypothesis, .. } => {
                let (hypothesis, moves) = (dart(map, hypothesis), self.take_moves(journey));
                self.print_line(format!(
                    "Candidate {hypothesis}: confirmed, the walk leads to the marker{moves}."
                ))
            }
            FoldingEvent::Folded { before, after } => {
                let (before, after) = (vertices(before), grouped(after as u128));
                self.print_line(format!(
                    "The marker is here: the trail folds from {before} to {after}."
                ))
            }
        }
    }

    /// A round begins with a test.
    fn print_test(
        &mut self,
        map: &PartialMap,
        edge: Dart,
        hypothesis: Dart,
        cost: usize,
    ) -> io::Result<()> {
        self.round += 1;
        let round = grouped(self.round.into());
        let (edge, hypothesis) = (dart(map, edge), dart(map, hypothesis));
        let moves = counted(cost, "move");
        writeln!(self.out)?;
        let text = format!(
            "may {edge} and {hypothesis} be the two ends of one edge? If so, a walk of {moves} leads to \
             the marker."
        );
        print_hanging(&mut self.out, &format!("Round {round}: "), &text)
    }
}
