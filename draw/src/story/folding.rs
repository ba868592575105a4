//! The story of the folding explorer: the darts that it takes, its tests, and how the trail folds.

use toposlam_model::{
    embedded_graph::Dart,
    mapping::{FoldingEvent, MapWalk, PartialMap},
};

use super::{Story, StoryLine, dart, percept_text};
use crate::{
    moment::grouped,
    text::{counted, vertices},
};

impl Story {
    pub(super) fn add_folding(&mut self, journey: &MapWalk, event: FoldingEvent) {
        let map = journey.map();
        match event {
            FoldingEvent::Explored { edge, percept } => {
                self.add_round(journey, edge, "", percept);
            }
            FoldingEvent::Testing { edge, hypothesis, cost } => {
                self.add_test(map, edge, hypothesis, cost);
            }
            FoldingEvent::Refuted { hypothesis, expected, perceived, .. } => {
                let moves = self.take_moves(journey);
                self.add_line(format!(
                    "Candidate {}: rejected on the way: expected {}, sensed {}{moves}.",
                    dart(map, hypothesis),
                    percept_text(expected, perceived),
                    percept_text(perceived, expected),
                ));
            }
            FoldingEvent::Confirmed { hypothesis, .. } => {
                let (hypothesis, moves) = (dart(map, hypothesis), self.take_moves(journey));
                self.add_line(format!(
                    "Candidate {hypothesis}: confirmed, the walk leads to the marker{moves}."
                ));
            }
            FoldingEvent::Folded { before, after } => {
                let (before, after) = (vertices(before), grouped(after as u128));
                self.add_line(format!(
                    "The marker is here: the trail folds from {before} to {after}."
                ));
            }
        }
    }

    /// A round begins with a test.
    fn add_test(&mut self, map: &PartialMap, edge: Dart, hypothesis: Dart, cost: usize) {
        self.round += 1;
        let round = grouped(self.round.into());
        let (edge, hypothesis) = (dart(map, edge), dart(map, hypothesis));
        let moves = counted(cost, "move");
        self.lines.push(StoryLine::default());
        let text = format!(
            "may {edge} and {hypothesis} be the two ends of one edge? If so, a walk of {moves} leads to \
             the marker."
        );
        self.lines.push(StoryLine::hanging(format!("Round {round}: "), text));
    }
}
