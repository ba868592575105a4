//! A check of every start, shared by the processes of a cluster.

use std::sync::Arc;

use toposlam_model::{
    check::{CheckPieces, FinishedUnits, PartTally, SharedPrefixCheck, Tally},
    enumerate::Watch,
    mapping::MappingAlgorithm,
};

use crate::{ClusterError, ClusterProcess, ThreadUse, dataflow::Job};

struct CheckJob {
    algorithm: MappingAlgorithm,
    pieces: CheckPieces,
}

impl Job for CheckJob {
    type Output = PartTally;
    type Record = ();
    type Group = ();

    fn work(&self, task: usize) -> (PartTally, Vec<()>) {
        (self.algorithm.check_piece(&self.pieces, task, &()), Vec::new())
    }

    fn key((): &()) -> u64 {
        0
    }

    fn group(&self, _: Vec<()>) {}
}

impl ClusterProcess {
    /// Checks an algorithm, as [`SharedPrefixCheck::resume`], with the same result. In process 0, `units` has those
    /// that were finished before, and records others; process 0 alone knows what each thread did. If the watch stops
    /// process 0, its result has what is known by then.
    ///
    /// # Errors
    /// Returns an error if the watch stops another process.
    pub fn check(
        &self,
        algorithm: MappingAlgorithm,
        sweep: &SharedPrefixCheck,
        units: &dyn FinishedUnits,
        watch: &dyn Watch,
    ) -> Result<(Tally, Vec<ThreadUse>), ClusterError> {
        let pieces = algorithm.pieces(sweep, watch);
        if watch.stop() {
            // The pieces are not all.
            return self.interrupted(algorithm, PartTally::default());
        }
        let job = Arc::new(CheckJob { algorithm, pieces });
        let pieces = &job.pieces;
        let mut counts = PartTally::default();
        let mut tasks = Vec::new();
        for piece in (0..pieces.count()).filter(|_| self.is_first()) {
            let finished = Some(piece).filter(|&piece| piece < pieces.unit_count());
            match finished.and_then(|unit| units.finished(unit)) {
                Some(tally) => counts.merge(tally),
                None => tasks.push(piece),
            }
        }
        watch.parts(tasks.len());
        let mut add = |piece: usize, found: PartTally| {
            watch.part_done(found.starts);
            if piece < pieces.unit_count() {
                units.finish(piece, &found);
            }
            counts.merge(found);
        };
        let ended = self.run(Arc::clone(&job), tasks, watch, &mut add);
        let shared = ended.and_then(|end| {
            let all = self.share(self.is_first().then(|| counts.clone()), watch)?;
            Ok((all, end.threads))
        });
        match shared {
            Err(ClusterError::Interrupted) => self.interrupted(algorithm, counts),
            shared => shared.map(|(counts, threads)| (algorithm.finished_pieces(counts), threads)),
        }
    }

    /// What is known when the watch stops this process: process 0 has the counts so far.
    fn interrupted(
        &self,
        algorithm: MappingAlgorithm,
        mut counts: PartTally,
    ) -> Result<(Tally, Vec<ThreadUse>), ClusterError> {
        if !self.is_first() {
            return Err(ClusterError::Interrupted);
        }
        counts.interrupted = true;
        Ok((algorithm.finished_pieces(counts), Vec::new()))
    }
}
