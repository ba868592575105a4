//! A case of a lemma: its worlds, walks and other values, as text and as JSON.

use std::{io, iter};

use serde_json::json;
use toposlam_model::format::world_file;
use toposlam_proofs::{Lemma, ShownExhibit, ShownWalk, Stop};

use super::Report;
use crate::cli::{
    CliError, Outcome,
    json::print_line,
    text::{capital, print_command, print_hanging, print_rows},
};

impl Report<'_> {
    /// Prints the case of these choices, and returns the outcome. A case that the lemma excludes is incomplete.
    pub(super) fn case(&mut self, lemma: &Lemma, choices: &[u8]) -> Result<Outcome, CliError> {
        let place = || format!("--choices: {}", lemma.name);
        let (engine, made) = lemma.replay(choices).map_err(|why| CliError::at(place(), why))?;
        let (outcome, word, verdict) = match made.case {
            Ok(()) => (Outcome::Holds, "holds", "holds: the lemma holds in"),
            Err(Stop::Fails(_)) => (Outcome::Violated, "fails", "violated: the lemma fails in"),
            Err(Stop::Excluded) => {
                (Outcome::Incomplete, "excluded", "incomplete: the lemma excludes")
            }
        };
        let claim = made.claim();
        self.statement(lemma.name, lemma.sentence)?;
        if let Some(claim) = claim {
            print_hanging(self.text, "  fails: ", &format!("it is not true that {claim}"))?;
        }
        print_command(self.text, "  again: ", &lemma.command(choices))?;
        let [mut worlds, mut walks, mut values] = [const { Vec::new() }; 3];
        for exhibit in made.shown(lemma.name) {
            writeln!(self.text)?;
            match exhibit {
                ShownExhibit::World { label, world } => {
                    let use_of_it = "as a file for `toposlam draw` and `toposlam explore`";
                    writeln!(self.text, "{}, {use_of_it}:\n", capital(&label))?;
                    write!(self.text, "{}", world_file::to_toml(&world))?;
                    worlds.push(world_file::to_json(&world));
                }
                ShownExhibit::Walk { label, walk } => {
                    writeln!(self.text, "A walk in {label}, marker {}:\n", walk.marker)?;
                    self.walk(&walk)?;
                    walks.push(json!(walk));
                }
                ShownExhibit::Value(shown) => {
                    print_hanging(self.text, &format!("{}: ", shown.name), &shown.value)?;
                    values.push(json!(shown));
                }
            }
        }
        writeln!(self.text, "\n{verdict} this case")?;
        let line = json!({
            "lemma": lemma.name, "engine": engine, "choices": choices, "verdict": word,
            "holds": outcome == Outcome::Holds, "claim": claim, "worlds": worlds, "walks": walks,
            "values": values,
        });
        print_line(self.json, "case", &line)?;
        Ok(outcome)
    }

    fn walk(&mut self, walk: &ShownWalk) -> io::Result<()> {
        let doors = walk.doors.iter().map(|door| door.0.to_string());
        let arrivals = walk.poses.iter().zip(&walk.percepts);
        let rows = iter::once("start".to_owned()).chain(doors).zip(arrivals);
        let rows = rows.map(|(door, (pose, percept))| [door, pose.clone(), percept.to_string()]);
        print_rows(self.text, ["door", "robot at", "perceives"], &rows.collect::<Vec<_>>())?;
        let stopped = walk.stopped.as_ref();
        stopped.map_or(Ok(()), |why| print_hanging(self.text, "  stopped: ", why))
    }
}
