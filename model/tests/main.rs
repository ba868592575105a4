//! Tests of the specification through its public interface.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

/// The items of an [`Explorer`](toposlam_model::mapping::Explorer) that are those of its field `run`.
macro_rules! delegate_to_run {
    ($choice:ty) => {
        type Marker = MarkerKind;
        type Choice = $choice;

        fn marker(&self) -> MarkerKind {
            self.run.marker()
        }

        fn limit_darts(&mut self, max_darts: usize) {
            self.run.limit_darts(max_darts);
        }

        fn begin<W: World>(
            &mut self,
            world: &mut W,
            observer: &mut impl Observer<W>,
        ) -> Result<(), MappingError<W::Error>> {
            self.run.begin(world, observer)
        }

        fn choose(&mut self) -> Result<Option<$choice>, InvalidStep> {
            self.run.choose()
        }

        fn map_walk(&self) -> Option<&MapWalk> {
            self.run.map_walk()
        }

        fn state_key(&self) -> Option<StateKey> {
            self.run.state_key()
        }
    };
}

mod ambiguity;
mod broken;
mod broken_movable;
mod check;
mod contradictions;
mod contradictions_movable;
mod costs;
mod counts;
mod explorers;
mod false_each_time;
mod figure_1;
mod folding;
mod folding_explorer;
mod lazy;
mod markers;
mod movable;
mod optimum;
mod perception;
mod random_buildings;
mod scripted_world;
mod smallest_failure;
mod verdicts;
mod worlds;
