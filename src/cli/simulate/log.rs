//! The log of a simulated run.

use std::fs::File;

use toposlam_logs::{messages, recorder::Recorder, world_hash, writer::LogWriteError};
use toposlam_simulator::IMAGE_TIME;
use toposlam_vision::{
    camera::{Camera, calibration},
    colour::ColourModel,
};

use super::{CliError, SimulateArguments, Simulation};
use crate::cli::{output, robot_sensor::SensorChoice, text::quoted, version};

impl SimulateArguments {
    /// Opens the log, if one is wanted. Its head has the camera and the colours.
    pub(super) fn recorder(
        &self,
        simulation: &Simulation,
        eyes: Option<(&Camera, &ColourModel)>,
    ) -> Result<Option<Recorder<File>>, CliError> {
        let Some(path) = &self.log else { return Ok(None) };
        let run = messages::Run {
            stamp: messages::Stamp::default(),
            version: version::version().to_owned(),
            world: simulation.world.name.clone(),
            world_hash: world_hash(&simulation.world.graph, simulation.facing),
            start: simulation.world.start_text(simulation.facing),
            marker: "directional".to_owned(),
            seed: self.seed,
            calibration: eyes.map(|(camera, _)| calibration::to_toml(camera)).unwrap_or_default(),
            colours: eyes.map(|(_, colours)| colours.to_toml()).unwrap_or_default(),
            command: self.command()?,
            algorithm: simulation.settings.recorded().to_string(),
        };
        let file = output::create_growing(path)?;
        let recorder = Recorder::new(file, &run, eyes.map(|(camera, _)| camera.clone()));
        recorder.map(Some).map_err(|error| self.unwritten(&error))
    }

    /// The failure if the log cannot be written.
    pub(super) fn unwritten(&self, error: &LogWriteError) -> CliError {
        let path = self.log.clone().unwrap_or_default();
        CliError::in_file(&path, format!("cannot be written: {error}"))
    }

    /// The command that repeats this run, without the options for its outputs.
    fn command(&self) -> Result<String, CliError> {
        let mut words = vec!["toposlam".to_owned(), "simulate".to_owned()];
        words.push(self.plan.display().to_string());
        let path = |path: &std::path::PathBuf| path.display().to_string();
        if let Some(start) = &self.start {
            words.extend(["--start".to_owned(), start.clone()]);
        }
        words.extend(self.options.words()?);
        let mut option = |name: &str, value: Option<String>| {
            if let Some(value) = value {
                words.extend([name.to_owned(), value]);
            }
        };
        option("--seed", Some(self.seed.to_string()));
        option("--calibration", self.calibration.as_ref().map(path));
        option("--size", self.size.map(|size| size.name().to_owned()));
        option("--colours", self.colours.as_ref().map(path));
        for (name, value) in self.appearance.arguments() {
            option(name, Some(value));
        }
        let unless =
            |value: f64, usual: f64| (value.total_cmp(&usual).is_ne()).then(|| value.to_string());
        option("--noise", unless(self.noise, 1.0));
        option("--image-time", unless(self.image_time, IMAGE_TIME));
        for fault in &self.fault {
            option("--fault", Some(fault.to_string()));
        }
        let is_camera = self.sensor == SensorChoice::Camera;
        option("--sensor", (!is_camera).then(|| self.sensor.name().to_owned()));
        option("--scanner", self.scanner.as_ref().map(path));
        if self.by_scene {
            words.push("--by-scene".to_owned());
        }
        Ok(words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" "))
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        arguments: SimulateArguments,
    }

    fn command_of(line: &[&str]) -> String {
        let arguments = Line::try_parse_from([&["simulate"][..], line].concat()).unwrap().arguments;
        arguments.command().unwrap()
    }

    #[test]
    fn the_command_repeats_the_run_without_the_options_for_its_outputs() {
        assert_eq!(
            command_of(&[
                "a b.toml",
                "--log",
                "run.mcap",
                "--json",
                "--by-scene",
                "--noise",
                "0.5"
            ]),
            "toposlam simulate 'a b.toml' --algorithm folding --seed 0 --noise 0.5 --by-scene"
        );
        assert_eq!(
            command_of(&["a.toml", "--scanner", "my scanner.toml", "--sensor", "laser"]),
            "toposlam simulate a.toml --algorithm folding --seed 0 --sensor laser --scanner 'my \
             scanner.toml'"
        );
        let line = "it's.toml --start a:b --algorithm folding --max-darts 20 --seed 7 --calibration c.toml \
                    --size 1280x960 --colours d.toml --look tiles --effects none --effect noise=0.25 \
                    --image-time 0.5 --fault carried@40 --fault dropped@3:9";
        let words: Vec<_> = line.split_whitespace().collect();
        let command = command_of(&words);
        let expected = format!("toposlam simulate {}", words.join(" "));
        let expected = expected.replace("it's.toml", r"'it'\''s.toml'").replace("@40", "@40:1");
        assert_eq!(command, expected);
    }
}
