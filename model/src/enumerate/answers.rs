//! The answers to the question what is behind a free dart, and their effect on a [`Draft`].

use std::ops::{ControlFlow, RangeInclusive};

use super::{Class, Draft, Each, SizeError, check_size, draft::new_vertex};
use crate::embedded_graph::{Dart, EmbeddedGraph};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Answer {
    Free(u8),
    /// The first dart of a new vertex of this degree.
    NewVertex(u8),
}

/// The answers that are possible. The free darts come first, then the degrees from the highest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Answers {
    free: u64,
    /// The degrees of a new vertex, as bits: bit 63 for degree 1.
    degrees: u64,
}

fn degree_bit(degree: usize) -> u64 {
    1 << (u64::BITS as usize - degree)
}

fn degree_bits(degrees: &RangeInclusive<usize>) -> u64 {
    let (fewest, most) = (*degrees.start(), *degrees.end());
    let up_to = |degree: usize| !u64::MAX.checked_shr(degree as u32).unwrap_or(0);
    if fewest > most { 0 } else { up_to(most) & !up_to(fewest - 1) }
}

impl Answers {
    #[inline]
    pub(crate) fn is_empty(self) -> bool {
        self.free | self.degrees == 0
    }

    pub(crate) fn count(self) -> u32 {
        self.free.count_ones() + self.degrees.count_ones()
    }

    pub(crate) fn take_first(&mut self) -> Option<Answer> {
        if self.free != 0 {
            let lowest = self.free.trailing_zeros() as u8;
            self.free &= self.free - 1;
            return Some(Answer::Free(lowest));
        }
        let lowest = (self.degrees != 0).then(|| self.degrees.trailing_zeros())?;
        self.degrees &= self.degrees - 1;
        Some(Answer::NewVertex((u64::BITS - lowest) as u8))
    }
}

impl Draft {
    /// A start of which nothing is decided.
    ///
    /// # Errors
    /// Returns an error if the number of edges is 0 or more than 32.
    pub(crate) fn new(class: Class, edges: usize) -> Result<Self, SizeError> {
        check_size(edges)?;
        Ok(Self::empty(Each::Start, class, edges))
    }

    /// What is decided. The other ends of the other darts are free.
    #[inline]
    pub(crate) fn graph(&self) -> &EmbeddedGraph {
        &self.graph
    }

    /// What may be behind a free dart; without a dart, the degree of the start vertex, of which nothing is
    /// decided. In the class `multigraph` each of these leads to a start; in others some may not.
    pub(crate) fn answers(&mut self, dart: Option<Dart>) -> Answers {
        let Some(dart) = dart else {
            return Answers { free: 0, degrees: degree_bits(&self.start_degrees()) };
        };
        let mut answers = Answers {
            free: if self.can_join() { self.partners(dart) } else { 0 },
            degrees: degree_bits(&self.new_degrees()),
        };
        let mut untried = if self.can_get_stuck() { answers } else { Answers::default() };
        while let Some(answer) = untried.take_first() {
            self.decide(Some(dart), answer);
            if !self.can_still_end() {
                match answer {
                    Answer::Free(other) => answers.free &= !(1 << other),
                    Answer::NewVertex(degree) => answers.degrees &= !degree_bit(degree.into()),
                }
            }
            self.undo(Some(dart), answer);
        }
        answers
    }

    /// Decides what is behind a free dart, or the degree of the start vertex.
    #[inline]
    pub(crate) fn decide(&mut self, dart: Option<Dart>, answer: Answer) {
        let (entry, word) = match answer {
            Answer::Free(other) => (Dart(other.into()), other),
            Answer::NewVertex(degree) => {
                let entry = Dart(self.graph.dart_count() as u32);
                self.add_vertex(degree.into());
                (entry, new_vertex(degree))
            }
        };
        if let Some(dart) = dart {
            self.join(dart, entry, word);
        }
    }

    #[inline]
    pub(crate) fn undo(&mut self, dart: Option<Dart>, answer: Answer) {
        if let Some(dart) = dart {
            self.unjoin(dart, self.graph.opposite(dart));
        }
        if let Answer::NewVertex(_) = answer {
            self.remove_vertex();
        }
    }

    /// Visits every start that agrees with what is decided, once, in a fixed order. Its darts keep their
    /// numbers.
    pub(crate) fn for_each_completion(
        &self,
        visit: &mut impl FnMut(&EmbeddedGraph) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        if self.edges_left() == 0 {
            return visit(self.graph());
        }
        let mut draft = self.clone();
        draft.grow_to(self.edges + self.edges_left(), &mut |grown| visit(&grown.graph))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::any_graph::starts;

    fn count(draft: &mut Draft) -> u64 {
        if draft.edges_left() == 0 {
            return 1;
        }
        let graph = draft.graph();
        let dart = graph.darts().filter(|&dart| graph.joined(dart).is_none()).last();
        let mut answers = draft.answers(dart);
        let mut found = 0;
        while let Some(answer) = answers.take_first() {
            draft.decide(dart, answer);
            found += count(draft);
            draft.undo(dart, answer);
        }
        found
    }

    /// The order in which a start is decided does not matter: each is found once.
    #[test]
    fn starts_decided_from_the_last_dart_are_as_many_as_those_enumerated() {
        for class in Class::ALL {
            for edges in 1..=6 {
                let enumerated = starts(class, edges).len() as u64;
                assert_eq!(count(&mut Draft::new(class, edges).unwrap()), enumerated, "{class}");
            }
        }
    }
}
