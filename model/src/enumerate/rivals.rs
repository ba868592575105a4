//! Whether a draft can still become the least start of its embedded graph.

use std::cmp::Ordering;

use super::draft::{DARTS, Draft, new_vertex};
use crate::{embedded_graph::Dart, percept::Door};

const UNMET: u8 = u8::MAX;

impl Draft {
    /// Whether no other dart has a lesser code than dart 0, as far as the codes are decided.
    /// Removes the rivals with a greater code. When the start is finished, the rivals that are left
    /// have the same code.
    pub(super) fn may_be_least(&mut self) -> bool {
        let mut open = self.rivals;
        while open != 0 {
            let rival = Dart(open.trailing_zeros());
            let bit = open & open.wrapping_neg();
            open ^= bit;
            match self.compare(rival) {
                Ordering::Less => return false,
                Ordering::Equal => {}
                Ordering::Greater => self.rivals ^= bit,
            }
        }
        true
    }

    /// The code of a rival against that of dart 0; equal as long as it is not decided.
    fn compare(&self, rival: Dart) -> Ordering {
        let Some(other) = self.graph.joined(rival) else {
            return Ordering::Equal;
        };
        // The first word alone decides most cases.
        let degree = self.graph.degree_around(rival);
        let word = if self.graph.vertex(other) == self.graph.vertex(rival) {
            Door::between(rival.0, other.0, degree).0 as u8
        } else {
            new_vertex(self.graph.degree_around(other) as u8)
        };
        word.cmp(&self.words[0]).then_with(|| self.compare_throughout(rival))
    }

    fn compare_throughout(&self, rival: Dart) -> Ordering {
        let mut number = [UNMET; DARTS];
        let mut order = [Dart(0); DARTS];
        let mut met = 0;
        let mut meet = |entry: Dart, number: &mut [u8; DARTS], order: &mut [Dart; DARTS]| {
            let mut dart = entry;
            let degree = self.graph.degree_around(entry);
            for _ in 0..degree {
                number[dart.at()] = met as u8;
                order[met] = dart;
                met += 1;
                dart = self.graph.clockwise(dart);
            }
            new_vertex(degree as u8)
        };
        meet(rival, &mut number, &mut order);
        let mut place = 0;
        for this in 0..self.edges * 2 {
            let Some(other) = self.graph.joined(order[this]) else {
                return Ordering::Equal;
            };
            let word = match number[other.at()] {
                UNMET => meet(other, &mut number, &mut order),
                earlier if (earlier as usize) < this => continue,
                later => later,
            };
            match word.cmp(&self.words[place]) {
                Ordering::Equal => place += 1,
                unequal => return unequal,
            }
            if place == self.edges {
                break;
            }
        }
        Ordering::Equal
    }
}
