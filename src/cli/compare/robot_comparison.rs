//! RobotComparison in two worlds with the same marker: can they tell the worlds apart?

use std::{io::Write, path::Path};

use serde_json::{Map, Value, json};
use toposlam_model::{
    ambiguity::{Comparison, PlacedRobot, Relation, Walk, state_count},
    embedded_graph::Dart,
    format::named_world::NamedWorld,
    marker::Marker,
    world::{Action, State},
};

use super::{Failure, walk_page};
use crate::cli::{
    json::action_json,
    text::{grouped, print_columns, print_paragraph},
};

/// How many starts in B, and how many pairs of states, are told one by one.
const PRINTED_STARTS: usize = 8;
const PRINTED_PAIRS: usize = 400;

/// RobotComparison in two worlds: one start in A, one or more in B.
pub(super) struct RobotComparison<'w> {
    worlds: [&'w NamedWorld; 2],
    marker: &'static dyn Marker,
    comparison: Comparison<'w>,
    start: Dart,
    /// Each start in B, with the walk that tells it from the one in A; `None` where none does.
    others: Vec<(Dart, Option<Walk>)>,
    /// From the first start in B from which no walk tells the worlds apart: why none does.
    relation: Option<Relation>,
}

/// The most states that the robot and the marker may be in, in a world that is compared: each takes a
/// hundred bytes and more.
const MOST_STATES: usize = 1 << 26;

impl<'w> RobotComparison<'w> {
    /// RobotComparison at the starts of the worlds; the one in B in every way that the marker cannot tell
    /// from its start, unless `one_pose` is wanted.
    pub(super) fn new(
        worlds: [&'w NamedWorld; 2],
        marker: &'static dyn Marker,
        one_pose: bool,
    ) -> Result<Self, Failure> {
        let [a, b] = worlds;
        if let Some(world) =
            worlds.into_iter().find(|world| state_count(&world.graph, marker) > MOST_STATES)
        {
            let cause = format!(
                "with the {} marker there are {} states, which are too many to compare",
                marker.name(),
                grouped(state_count(&world.graph, marker) as u128),
            );
            return Err(Failure::at(&world.name, cause));
        }
        let (start, other) = (a.start.unwrap_or(Dart(0)), b.start.unwrap_or(Dart(0)));
        let comparison = Comparison::new(marker, (&a.graph, start), (&b.graph, other));
        let mut poses = vec![other];
        if !one_pose {
            let starts = marker.starts(&b.graph, other);
            poses.extend(starts.into_iter().filter(|&pose| pose != other));
        }
        let told_apart = |pose| (pose, comparison.walk([start, pose]));
        let others: Vec<_> = poses.into_iter().map(told_apart).collect();
        let mut robots = Self { worlds, marker, comparison, start, others, relation: None };
        robots.relation = robots.comparison.relation(robots.poses());
        robots.verify()?;
        Ok(robots)
    }

    /// Holds what was found against the worlds, without regard to how it was found.
    fn verify(&self) -> Result<(), Failure> {
        let walks_hold = self.others.iter().all(|(pose, walk)| {
            let [one, other] = self.comparison.starts([self.start, *pose]);
            walk.as_ref().is_none_or(|walk| walk.verify(&one, &other))
        });
        let [one, other] = self.begun();
        let relation_holds =
            self.relation.as_ref().is_none_or(|relation| relation.verify(&one, &other));
        if walks_hold && relation_holds {
            Ok(())
        } else {
            Err(Failure::at("compare", "what was found is not confirmed: the search is at fault"))
        }
    }

    /// The names of the worlds.
    pub(super) fn names(&self) -> [&'w str; 2] {
        self.worlds.map(|world| world.name.as_str())
    }

    /// The first start in B from which the worlds cannot be told apart, or else the first of all.
    pub(super) fn poses(&self) -> [Dart; 2] {
        let same = self.others.iter().find(|(_, walk)| walk.is_none());
        let (pose, _) = same.or(self.others.first()).unwrap_or(&(Dart(0), None));
        [self.start, *pose]
    }

    /// The two robots at those starts.
    pub(super) fn begun(&self) -> [PlacedRobot<'w>; 2] {
        self.comparison.starts(self.poses())
    }

    /// Writes the page on which a person walks with them.
    pub(super) fn write_page(&self, path: &Path) -> Result<(), Failure> {
        walk_page::write(path, self.worlds, self.marker, &self.comparison, self.poses())
    }

    /// These starts, as `vertex:facing`.
    pub(super) fn starts_text(&self) -> [String; 2] {
        let [pose, other] = self.poses();
        [self.worlds[0].start_text(pose), self.worlds[1].start_text(other)]
    }

    /// A pair of states in words.
    fn pair_text(&self, &(one, other): &(State, State)) -> [String; 2] {
        let [a, b] = self.worlds;
        [a.state_text(&self.marker, one), b.state_text(&self.marker, other)]
    }

    pub(super) fn json(&self) -> Map<String, Value> {
        let [a, b] = self.worlds;
        let relation = self.relation.as_ref();
        let pairs = relation
            .as_ref()
            .map(|relation| relation.0.iter().map(|pair| self.pair_text(pair)).collect::<Vec<_>>());
        let walk = |walk: &Option<Walk>| walk.as_ref().map(|walk| actions_json(&walk.actions));
        let first = self.others.first().filter(|_| relation.is_none());
        let line = json!({
            "marker": self.marker.name(),
            "distinguishable": relation.is_none(),
            "walk": first.and_then(|(_, first)| walk(first)),
            "relation": pairs,
            "relation_starts": relation.map(|_| self.starts_text()),
            "start": a.start_text(self.start),
            "starts": self.others.iter().map(|(pose, _)| b.start_text(*pose)).collect::<Vec<_>>(),
            "walks": self.others.iter().map(|(_, told)| walk(told)).collect::<Vec<_>>(),
        });
        line.as_object().cloned().unwrap_or_default()
    }

    pub(super) fn tell(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let [a, b] = self.worlds;
        let start = a.start_text(self.start);
        writeln!(out, "\n{} marker: {}", self.marker.name(), self.marker.about())?;
        if let Some(relation) = &self.relation {
            let [_, other] = self.starts_text();
            let pairs = grouped(relation.0.len() as u128);
            let verdict = format!(
                "No walk distinguishes the worlds from {start} in A and {other} in B. \
                 The robots can be in {pairs} pairs of states:"
            );
            print_paragraph(out, &verdict)?;
            let printed = relation.0.iter().take(PRINTED_PAIRS);
            let pairs: Vec<_> = printed.map(|pair| self.pair_text(pair).join("~")).collect();
            print_columns(out, &pairs)?;
            if let Some(more) = relation.0.len().checked_sub(PRINTED_PAIRS + 1) {
                writeln!(out, "  and {} more, which --json tells", more + 1)?;
            }
            return Ok(());
        }
        for (pose, walk) in self.others.iter().take(PRINTED_STARTS) {
            if let Some(Walk { actions, percepts: [one, other] }) = walk {
                let actions: Vec<_> = actions.iter().map(ToString::to_string).collect();
                let how = match actions.as_slice() {
                    [] => "the first percepts tell".to_owned(),
                    actions => format!("the walk {} tells", actions.join(",")),
                };
                writeln!(
                    out,
                    "from {start} in A and {} in B {how} the worlds apart:\n  A: {one}\n  B: {other}",
                    b.start_text(*pose),
                )?;
            }
        }
        match self.others.len().saturating_sub(PRINTED_STARTS) {
            0 => {}
            more => writeln!(
                out,
                "from {more} more starts in B, too, a walk tells them apart; --json tells each"
            )?,
        }
        Ok(())
    }
}

/// What is said of robots where there are none.
pub(super) fn unknown() -> Map<String, Value> {
    let keys = ["marker", "distinguishable", "walk", "relation"];
    keys.into_iter().map(|key| (key.to_owned(), Value::Null)).collect()
}

/// Doors as numbers, other actions as words.
pub(super) fn actions_json(actions: &[Action]) -> Value {
    actions.iter().copied().map(action_json).collect()
}
