//! The groups of indistinguishable worlds, from candidates that come in their order.

use std::mem;

use super::{
    AmbiguityCandidate, AmbiguousGroup, Comparison, Findings, KeptPairs, PlacedWorld, SizeFindings,
    Unfinished, findings::rank,
};
use crate::{
    aid::AnyAid,
    enumerate::{Watch, in_parts},
};

/// The number of pairs that are confirmed at once, by several threads.
const AT_ONCE: usize = 1024;

/// The groups of candidates with the same quotient. A bisimulation confirms each world with the first of its group.
pub(super) struct Grouping<'a> {
    aid: AnyAid<'a>,
    watch: &'a dyn Watch,
    kept: KeptPairs,
    sizes: Vec<SizeFindings>,
    groups: Vec<AmbiguousGroup>,
    /// The first candidate of the latest quotient, and its world if there is another one.
    first: Option<(AmbiguityCandidate, Option<PlacedWorld>)>,
    pairs: Vec<[PlacedWorld; 2]>,
}

impl<'a> Grouping<'a> {
    /// No groups yet. The ambiguous worlds of these sizes are counted.
    pub(super) fn new(
        aid: AnyAid<'a>,
        sizes: Vec<SizeFindings>,
        kept: KeptPairs,
        watch: &'a dyn Watch,
    ) -> Self {
        Self { aid, watch, kept, sizes, groups: Vec::new(), first: None, pairs: Vec::new() }
    }

    pub(super) fn add(&mut self, candidate: AmbiguityCandidate) -> Result<(), Unfinished> {
        let same = |(first, _): &&mut (AmbiguityCandidate, Option<PlacedWorld>)| {
            first.quotient() == candidate.quotient()
        };
        let Some((first, world)) = self.first.as_mut().filter(same) else {
            self.first = Some((candidate, None));
            return Ok(());
        };
        let other = candidate.world().ok_or(Unfinished::Unreadable)?;
        if let Some(one) = world.clone() {
            self.put(&other);
            self.pairs.push([one, other]);
        } else {
            let one = first.world().ok_or(Unfinished::Unreadable)?;
            *world = Some(one.clone());
            self.put_two([&one, &other]);
            self.pairs.extend([[one.clone(), one.clone()], [one, other]]);
        }
        if self.pairs.len() >= AT_ONCE { self.confirm() } else { Ok(()) }
    }

    /// The first two worlds of a group are its smallest pair.
    fn put_two(&mut self, pair: [&PlacedWorld; 2]) {
        for world in pair {
            self.count(world);
        }
        let smallest = self.groups.first().and_then(AmbiguousGroup::smallest);
        if self.kept == KeptPairs::Smallest {
            if smallest.is_some_and(|smallest| rank(smallest) < rank(pair)) {
                return;
            }
            self.groups.clear();
        }
        self.groups.push(AmbiguousGroup { worlds: pair.map(PlacedWorld::clone).into() });
    }

    fn put(&mut self, world: &PlacedWorld) {
        self.count(world);
        if self.kept == KeptPairs::All
            && let Some(group) = self.groups.last_mut()
        {
            group.worlds.push(world.clone());
        }
    }

    fn count(&mut self, world: &PlacedWorld) {
        let edges = world.graph.edge_count();
        if let Some(size) = self.sizes.iter_mut().find(|size| size.edges == edges) {
            size.ambiguous += 1;
        }
    }

    fn confirm(&mut self) -> Result<(), Unfinished> {
        let (aid, watch) = (self.aid, self.watch);
        let confirm = |pair: &[PlacedWorld; 2]| {
            if watch.stop() {
                Err(Unfinished::Interrupted)
            } else if is_confirmed(aid, pair.each_ref()) {
                Ok(())
            } else {
                Err(Unfinished::Unconfirmed(Box::new(pair.clone())))
            }
        };
        let pairs = mem::take(&mut self.pairs);
        in_parts(&pairs, &(), || Ok(()), confirm, |_| 1, Result::and)
    }

    pub(super) fn findings(mut self) -> Result<Findings, Unfinished> {
        self.confirm()?;
        let Self { sizes, mut groups, .. } = self;
        groups.sort_by(|one, other| one.smallest().map(rank).cmp(&other.smallest().map(rank)));
        Ok(Findings { sizes, groups })
    }
}

/// Whether a verified bisimulation shows that two placed worlds are indistinguishable.
fn is_confirmed(aid: AnyAid<'_>, [one, other]: [&PlacedWorld; 2]) -> bool {
    let start = PlacedWorld::FACING;
    let comparison = Comparison::new(aid, (&one.graph, start), (&other.graph, start));
    comparison.start_like(start).is_some_and(|pose| {
        let [here, there] = comparison.starts([start, pose]);
        // The classes of states are fewer than their pairs.
        let found = comparison.bisimulation([start, pose], 0, &()).ok().flatten();
        found.is_some_and(|found| found.verify(&here, &there))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        ambiguity::{AmbiguitySearch, quotient::QuotientCode},
        enumerate::Class,
        marker::named,
    };

    #[test]
    fn a_group_that_is_not_confirmed_is_an_error() {
        let marker = named("undirected").unwrap();
        let findings =
            AmbiguitySearch::new(Class::Multigraph, 4, marker).unwrap().run(&()).unwrap();
        assert!(findings.groups.len() > 1);
        let mut grouping = Grouping::new(marker.into(), Vec::new(), KeptPairs::All, &());
        // As if all of these had the same quotient.
        for world in findings.groups.iter().flat_map(|group| &group.worlds) {
            grouping.add(AmbiguityCandidate::new(&QuotientCode::new(), &world.code)).unwrap();
        }
        assert!(matches!(grouping.findings(), Err(Unfinished::Unconfirmed(_))));
    }
}
