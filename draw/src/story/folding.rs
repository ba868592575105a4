//! The story of the folding explorer: the darts that it takes, its tests, and how the trail folds.

use toposlam_model::mapping::{FoldingEvent, MapWalk};

use super::{Story, dart, percept_text};
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
                let (edge, hypothesis) = (dart(map, edge), dart(map, hypothesis));
                let moves = counted(cost, "move");
                self.begin_round(format!(
                    "may {edge} and {hypothesis} be the two ends of one edge? If so, a walk of \
                     {moves} leads to the marker."
                ));
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
}
