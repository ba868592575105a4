//! Folds the trail of a trace: does any world, of any size, explain it? Section 2.1.
//!
//! The trail is a chain of vertices, one for each percept. All vertices with the marker are one vertex, and
//! equal poses have equal neighbours. If this identifies vertices that look different, or two ends of one
//! vertex, no world explains the trace. Otherwise the folded trail becomes a world: each end that is left
//! over leads to a dead end.

use thiserror::Error;
use toposlam_model::{percept::Sighting, trace::Trace};

/// The first event that no world of any size explains.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FoldContradiction {
    /// Its index in the trace.
    pub event: usize,
    /// Why.
    pub reason: ContradictionReason,
}

/// Why no world explains an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum ContradictionReason {
    /// There is no such door.
    #[error("there is no such door")]
    Door,
    /// The percept contradicts the earlier ones.
    #[error("the percept contradicts the earlier ones")]
    Percept,
}

/// Folds a trail.
///
/// # Errors
/// Returns the first event that no world of any size explains together with all before it.
pub fn fold(trace: &Trace) -> Result<(), FoldContradiction> {
    // A prefix of what can be explained can be explained.
    let (mut good, mut bad) = (0, trace.len() + 1);
    while bad - good > 1 {
        let middle = good.midpoint(bad);
        if Trail::new(&trace.up_to(middle - 1)).is_some_and(|mut trail| trail.fold()) {
            good = middle;
        } else {
            bad = middle;
        }
    }
    if good == trace.len() {
        return Ok(());
    }
    let reason = if good.is_multiple_of(2) {
        ContradictionReason::Percept
    } else {
        ContradictionReason::Door
    };
    Err(FoldContradiction { event: good, reason })
}

/// The darts of a chain of vertices. A dart is the first of its vertex plus its index from the entry.
struct Trail {
    /// Of each vertex: its first dart, its degree, and the index of the dart along which the marker lies.
    vertices: Vec<(usize, usize, Option<usize>)>,
    /// Of each dart: its vertex, another dart that it is, and its other end if that is known.
    vertex: Vec<usize>,
    same: Vec<usize>,
    opposite: Vec<Option<usize>>,
    /// Pairs of darts that are one.
    pairs: Vec<(usize, usize)>,
}

impl Trail {
    /// `None` if a vertex or a door is impossible by itself.
    fn new(trace: &Trace) -> Option<Self> {
        let mut trail = Self {
            vertices: Vec::new(),
            vertex: Vec::new(),
            same: Vec::new(),
            opposite: Vec::new(),
            pairs: Vec::new(),
        };
        for (moves, percept) in trace.percepts().iter().enumerate() {
            let (first, degree) = (trail.vertex.len(), percept.degree as usize);
            let marked = match percept.sighting {
                Sighting::Nothing => None,
                Sighting::Pointing(door) => Some(door.0 as usize),
                _ => return None,
            };
            // No world in reach has a vertex of so many doors.
            if degree == 0 || degree > MOST || marked.is_some_and(|door| door >= degree) {
                return None;
            }
            trail.vertex.extend(vec![moves; degree]);
            trail.same.extend(first..first + degree);
            trail.opposite.extend(vec![None; degree]);
            trail.vertices.push((first, degree, marked));
            if let Some(door) = moves.checked_sub(1).map(|before| trace.doors()[before].0 as usize)
            {
                let (before, doors, _) = trail.vertices[moves - 1];
                if door >= doors {
                    return None;
                }
                trail.join(before + door, first);
                trail.join(first, before + door);
            }
        }
        let (_, degree, _) = trail.vertices.last().copied()?;
        let last_door = trace.doors().get(trace.percepts().len() - 1);
        if last_door.is_some_and(|door| door.0 as usize >= degree) {
            return None;
        }
        Some(trail)
    }

    fn find(&self, mut dart: usize) -> usize {
        while self.same[dart] != dart {
            dart = self.same[dart];
        }
        dart
    }

    /// The other end of a dart is known.
    fn join(&mut self, dart: usize, other: usize) {
        let dart = self.find(dart);
        match self.opposite[dart] {
            Some(known) => self.pairs.push((known, other)),
            None => self.opposite[dart] = Some(other),
        }
    }

    fn clockwise(&self, dart: usize) -> usize {
        let (first, degree, _) = self.vertices[self.vertex[dart]];
        first + (dart - first + 1) % degree
    }

    /// Identifies what must be the same; `false` if that is not possible.
    fn fold(&mut self) -> bool {
        let marked = |(first, _, marked): &(usize, usize, Option<usize>)| Some(first + (*marked)?);
        let markers: Vec<_> = self.vertices.iter().filter_map(marked).collect();
        self.pairs.extend(markers.windows(2).map(|two| (two[0], two[1])));
        while let Some((one, other)) = self.pairs.pop() {
            let (one, other) = (self.find(one), self.find(other));
            if one == other {
                continue;
            }
            if self.vertices[self.vertex[one]].1 != self.vertices[self.vertex[other]].1 {
                return false;
            }
            self.same[other] = one;
            self.pairs.push((self.clockwise(one), self.clockwise(other)));
            if let Some(end) = self.opposite[other] {
                self.join(one, end);
            }
        }
        let marker = markers.first().map(|&dart| self.find(dart));
        self.vertices.iter().all(|&(first, degree, marked)| {
            let mut darts: Vec<_> = (first..first + degree).map(|dart| self.find(dart)).collect();
            let looks = marked.is_some() || !darts.iter().any(|&dart| Some(dart) == marker);
            let ends = darts.iter().all(|&dart| {
                self.opposite[dart].is_none_or(|opposite| self.find(opposite) != dart)
            });
            darts.sort_unstable();
            darts.dedup();
            looks && ends && darts.len() == degree
        })
    }
}

/// A vertex of more doors is not folded.
const MOST: usize = 10_000;
