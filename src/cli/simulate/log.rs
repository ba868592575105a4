//! The log of a simulated run: where it goes, and its head.

use std::fs::File;

use toposlam_robot::{
    log::{messages, recorder, world_hash, writer::LogWriteError},
    simulator::PICTURE_TIME,
};
use toposlam_vision::{
    camera::{Camera, calibration},
    colour::ColourModel,
};

use super::{Arguments, Failure, Simulation};
use crate::cli::{output, text::quoted};

/// Writes a log to a file, as the run goes.
pub(super) type Recorder = recorder::Recorder<File>;

impl Arguments {
    /// The log, where one is wanted; its pictures are those of the camera, its colours those of
    /// the building.
    pub(super) fn recorder(
        &self,
        simulation: &Simulation,
        eyes: Option<(&Camera, &ColourModel)>,
    ) -> Result<Option<Recorder>, Failure> {
        let Some(path) = &self.log else { return Ok(None) };
        let run = messages::Run {
            stamp: messages::Stamp::default(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            world: simulation.world.name.clone(),
            world_hash: world_hash(&simulation.world.graph, simulation.facing),
            start: simulation.world.start_text(simulation.facing),
            marker: "directional".to_owned(),
            seed: self.seed,
            calibration: eyes.map(|(camera, _)| calibration::to_toml(camera)).unwrap_or_default(),
            colours: eyes.map(|(_, colours)| colours.to_toml()).unwrap_or_default(),
            command: self.command(),
        };
        let file = output::create_growing(path)?;
        let recorder = Recorder::new(file, &run, eyes.map(|(camera, _)| camera.clone()));
        recorder.map(Some).map_err(|error| self.unwritten(&error))
    }

    /// The log could not be written.
    pub(super) fn unwritten(&self, error: &LogWriteError) -> Failure {
        let path = self.log.clone().unwrap_or_default();
        Failure::in_file(&path, format!("cannot be written: {error}"))
    }

    /// The command that makes this run again: all but where its results go.
    fn command(&self) -> String {
        let mut words = vec!["toposlam".to_owned(), "simulate".to_owned()];
        words.push(self.plan.display().to_string());
        let mut say = |name: &str, value: Option<String>| {
            if let Some(value) = value {
                words.extend([name.to_owned(), value]);
            }
        };
        let path = |path: &std::path::PathBuf| path.display().to_string();
        say("--start", self.start.clone());
        say("--seed", Some(self.seed.to_string()));
        say("--calibration", self.calibration.as_ref().map(path));
        say("--size", self.size.map(|size| size.name().to_owned()));
        say("--colours", self.colours.as_ref().map(path));
        for (name, value) in self.appearance.told() {
            say(name, Some(value));
        }
        let unless =
            |value: f64, usual: f64| (value.total_cmp(&usual).is_ne()).then(|| value.to_string());
        say("--noise", unless(self.noise, 1.0));
        say("--picture-time", unless(self.picture_time, PICTURE_TIME));
        for fault in &self.fault {
            say("--fault", Some(fault.to_string()));
        }
        say("--max-darts", (self.max_darts != MAX_DARTS).then(|| self.max_darts.to_string()));
        if self.by_scene {
            words.push("--by-scene".to_owned());
        }
        words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ")
    }
}

/// So many darts are enough unless something else is said.
pub(in crate::cli) const MAX_DARTS: usize = 1000;

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        arguments: Arguments,
    }

    fn told(line: &[&str]) -> String {
        let arguments = Line::try_parse_from([&["simulate"][..], line].concat()).unwrap().arguments;
        arguments.command()
    }

    #[test]
    fn the_command_makes_the_run_again_and_does_not_tell_where_its_results_go() {
        assert_eq!(
            told(&["a b.toml", "--log", "run.mcap", "--json", "--by-scene", "--noise", "0.5"]),
            "toposlam simulate 'a b.toml' --seed 0 --noise 0.5 --by-scene"
        );
        let line = "it's.toml --start a:b --seed 7 --calibration c.toml --size 1280x960 \
                    --colours d.toml --look tiles --effects none --effect noise=0.25 \
                    --picture-time 0.5 --fault carried@40 --fault dropped@3:9 --max-darts 20";
        let words: Vec<_> = line.split_whitespace().collect();
        let command = told(&words);
        let said = format!("toposlam simulate {}", words.join(" "));
        let said = said.replace("it's.toml", r"'it'\''s.toml'").replace("@40", "@40:1");
        assert_eq!(command, said);
    }
}
