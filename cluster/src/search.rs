//! A search for worlds that a marker does not distinguish, shared by the processes of a cluster.

use std::sync::Arc;

use toposlam_model::{
    ambiguity::{AmbiguityCandidate, AmbiguitySearch, Findings, KeptPairs, SearchPart, Unfinished},
    enumerate::Watch,
};

use crate::{ClusterError, ClusterProcess, ThreadUse, dataflow::Job};

struct SearchJob {
    search: AmbiguitySearch<'static>,
    parts: Vec<SearchPart>,
    kept: KeptPairs,
}

impl Job for SearchJob {
    /// The number of placed worlds.
    type Output = u64;
    type Record = AmbiguityCandidate;
    type Group = Result<Findings, Unfinished>;

    fn work(&self, task: usize) -> (u64, Vec<AmbiguityCandidate>) {
        self.parts.get(task).map(|part| self.search.look_at_part(part)).unwrap_or_default()
    }

    /// FNV-1a, which is the same in every build.
    fn key(candidate: &AmbiguityCandidate) -> u64 {
        candidate.quotient().iter().fold(0xcbf2_9ce4_8422_2325, |hash, &byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
        })
    }

    fn group(&self, candidates: Vec<AmbiguityCandidate>) -> Result<Findings, Unfinished> {
        self.search.grouped(candidates, self.kept, &())
    }
}

impl ClusterProcess {
    /// Makes a search, as [`AmbiguitySearch::run`], and keeps all pairs or only the smallest. Process 0 alone has all
    /// findings and what each thread did; the others have the smallest pair.
    ///
    /// # Errors
    /// Returns an error if the watch stops this process.
    pub fn search(
        &self,
        search: &AmbiguitySearch<'static>,
        kept: KeptPairs,
        watch: &dyn Watch,
    ) -> Result<(Result<Findings, Unfinished>, Vec<ThreadUse>), ClusterError> {
        let job = Arc::new(SearchJob { search: search.clone(), parts: search.parts(), kept });
        let parts = &job.parts;
        watch.parts(if self.is_first() { parts.len() } else { 0 });
        let mut findings = search.grouped(Vec::new(), kept, &());
        let mut add = |task: usize, placed_worlds: u64| {
            watch.part_done(placed_worlds);
            if let (Ok(findings), Some(part)) = (&mut findings, parts.get(task)) {
                findings.count_placed(part.edges(), placed_worlds);
            }
        };
        let tasks = (0..parts.len()).collect();
        let end = self.run(Arc::clone(&job), tasks, watch, &mut add)?;
        for group in end.groups {
            findings = findings.and_then(|findings| Ok(findings.merged(group?, kept)));
        }
        let smallest = findings.clone().map(Findings::into_smallest);
        let shared = self.share(self.is_first().then_some(smallest), watch)?;
        Ok((if self.is_first() { findings } else { shared }, end.threads))
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use toposlam_model::{enumerate::Class, marker::named};

    use super::*;

    /// Equal quotients meet in one process, and different ones are spread over all.
    #[test]
    fn keys_are_those_of_quotients_and_are_spread() {
        let search = AmbiguitySearch::new(Class::Multigraph, 5, named("undirected").unwrap());
        let search = search.unwrap();
        let candidates = search.parts().into_iter().flat_map(|part| search.look_at_part(&part).1);
        let keys: BTreeSet<u64> = candidates.map(|candidate| SearchJob::key(&candidate)).collect();
        let mut of_process = [0_u64; 3];
        for key in keys {
            of_process[(key % 3) as usize] += 1;
        }
        let [least, most] = [of_process.iter().min(), of_process.iter().max()];
        assert!(most < least.map(|least| 2 * least).as_ref(), "{of_process:?}");
    }
}
