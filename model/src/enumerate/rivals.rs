//! Whether a draft can still become the least start of its embedded graph.

use std::cmp::Ordering;

use super::draft::{DARTS, Draft, FREE, new_vertex};

const UNMET: u8 = u8::MAX;

impl Draft {
    /// Whether no other dart has a lesser code than dart 0, as far as the codes are decided.
    /// Removes the rivals with a greater code. When the start is finished, the rivals that are left
    /// have the same code.
    pub(super) fn may_be_least(&mut self) -> bool {
        let mut open = self.rivals;
        while open != 0 {
            let rival = open.trailing_zeros() as usize;
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
    fn compare(&self, rival: usize) -> Ordering {
        let other = self.opposite[rival];
        if other == FREE {
            return Ordering::Equal;
        }
        // The first word alone decides most cases.
        let vertex = self.vertex[rival] as usize;
        let far = self.vertex[other as usize] as usize;
        let word = if far == vertex {
            let degree = self.degree[vertex];
            let rival = rival as u8;
            if other > rival { other - rival } else { other + degree - rival }
        } else {
            new_vertex(self.degree[far])
        };
        word.cmp(&self.words[0]).then_with(|| self.compare_throughout(rival))
    }

    fn compare_throughout(&self, rival: usize) -> Ordering {
        let mut number = [UNMET; DARTS];
        let mut order = [0; DARTS];
        let mut met = 0;
        let mut meet = |entry: usize, number: &mut [u8; DARTS], order: &mut [u8; DARTS]| {
            let mut dart = entry;
            let degree = self.degree[self.vertex[entry] as usize];
            for _ in 0..degree {
                number[dart] = met as u8;
                order[met] = dart as u8;
                met += 1;
                dart = self.clockwise(dart);
            }
            new_vertex(degree)
        };
        meet(rival, &mut number, &mut order);
        let mut place = 0;
        for this in 0..self.edges * 2 {
            let other = self.opposite[order[this] as usize];
            if other == FREE {
                return Ordering::Equal;
            }
            let word = match number[other as usize] {
                UNMET => meet(other as usize, &mut number, &mut order),
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
