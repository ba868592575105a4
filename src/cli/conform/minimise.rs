//! A shorter log that diverges in the same way, and the command that checks it.

use std::{f64::consts::PI, path::Path};

use toposlam_conform::{
    CheckedEvent, CheckedKind, CheckedLog, ConformConfig, Divergence, Evidence, ExtractConfig,
    Quirks, RunDriver, RunEvents, SensedScene, ShortenedRun, extract, infer_events, judge,
    shorten_frames, shorten_run,
};
use toposlam_logs::{
    action_message, arrival_message, door_message,
    messages::{Action, Door, Percept, ProjectMessage, Run, Scene, Stamp},
    reader::Log,
    record::Arrival,
    recorder::ODOM,
    scene_message, standard,
    topic_map::TopicMap,
    writer::{LogWriteError, LogWriter},
};
use toposlam_model::{
    aid::AidKind, driving::odometry::Odometry, enumerate::Class, marker::NoMarker,
};
use toposlam_robot::measured_hallway::direction;

use super::{CliError, ConformArguments, JudgedLog};
use crate::cli::{output, text::quoted};

/// A shorter log.
pub(super) struct Minimised {
    pub(super) events: RunEvents,
    /// The command that checks it, if it was written.
    pub(super) command: Option<String>,
}

/// The distance that a written log has between two junctions, in metres.
const DISTANCE: f64 = 2.0;

impl ConformArguments {
    /// A shorter log, written to the file of `--minimise`.
    pub(super) fn shorter(&self, judged: &JudgedLog) -> Result<Option<Minimised>, CliError> {
        let checked = &judged.checked;
        let config = checked.config.clone();
        let shorter = shorten_run(&checked.judgement, &config, &());
        let Some(path) = &self.minimise else {
            return Ok(shorter.map(|short| Minimised { events: short.events, command: None }));
        };
        let Some(divergence) = &checked.judgement.divergence else {
            not_written(path, "there is no divergence to show");
            return Ok(None);
        };
        let Some(ShortenedRun { events, event, by_itself }) = shorter else {
            not_written(path, "it does not diverge in less than all of it");
            return Ok(None);
        };
        let head = head(judged);
        let recorded = checked.judgement.events.events.get(divergence.event);
        let seen = recorded.and_then(|event| shorten_frames(&checked.extracted.seen, event));
        let (bytes, evidence, at) = match seen {
            Some(seen) => {
                // Its last event diverges.
                let last = infer_events(seen, is_marked(&config)).len().saturating_sub(1);
                (write_seen(seen, &head), Evidence::Scenes, last)
            }
            None => (write(&events, &head), Evidence::Recorded, event),
        };
        let bytes = bytes.map_err(|error| CliError::in_file(path, error))?;
        let config = if by_itself { config.by_itself() } else { config };
        let again = divergence_of(&bytes, evidence, &config);
        if again.as_ref().is_none_or(|again| again.event != at || !again.is_like(divergence)) {
            not_written(path, "a log of less than all of it does not diverge in the same way");
            return Ok(None);
        }
        output::write_whole(path, &bytes)?;
        let command = Some(self.command(path, checked, by_itself));
        Ok(Some(Minimised { events, command }))
    }

    /// The command that checks a shorter log as this one was checked.
    fn command(&self, path: &Path, checked: &CheckedLog, by_itself: bool) -> String {
        let mut words =
            vec!["toposlam".to_owned(), "conform".to_owned(), quoted(&path.display().to_string())];
        if self.class != Class::Multigraph {
            words.extend(["--class".to_owned(), self.class.to_string()]);
        }
        if by_itself {
            words.extend(["--driver", "anyone"].map(str::to_owned));
            return words.join(" ");
        }
        if let (Some(known), Some(world)) = (&checked.known, &self.world) {
            let start = known.start.map_or("any".to_owned(), |start| known.world.start_text(start));
            words.extend(["--world".to_owned(), quoted(&world.display().to_string())]);
            words.extend(["--start".to_owned(), quoted(&start)]);
        }
        if checked.config.driver == RunDriver::Anyone {
            words.extend(["--driver", "anyone"].map(str::to_owned));
        }
        if let Some(algorithm) = self.algorithm {
            words.extend(["--algorithm", algorithm.name()].map(str::to_owned));
        }
        words.join(" ")
    }
}

fn not_written(path: &Path, why: &str) {
    remark!("{}: not written: {why}", path.display());
}

fn is_marked(config: &ConformConfig) -> bool {
    config.aid != AidKind::from(NoMarker)
}

/// The first divergence of a written log.
fn divergence_of(bytes: &[u8], evidence: Evidence, config: &ConformConfig) -> Option<Divergence> {
    let log = Log::of_bytes(bytes.to_vec()).ok()?;
    let mapping = TopicMap::unambiguous(&log);
    let extraction = ExtractConfig { marked: is_marked(config), ..ExtractConfig::new(evidence) };
    let run = extract(&log, &mapping, &extraction, &()).ok()?;
    judge(run.events, config, &Quirks::default(), &()).ok()?.divergence
}

/// A log of the events: percepts, actions and doors. It has odometry only where a hallway is measured, or an event has an angle
/// off its door or its entry.
fn write(events: &RunEvents, head: &Run) -> Result<Vec<u8>, LogWriteError> {
    let mut log = begin(head)?;
    let begun = events.events.first().map_or(0, |event| event.source.time);
    let mut at = Odometry::default();
    let mut last: Option<Arrival> = None;
    // The direction in which the robot left, by the recorded door and the angle by which it missed it.
    let mut by_door = None;
    for CheckedEvent { source, kind } in &events.events {
        let time = source.time.saturating_sub(begun);
        let stamp = Stamp::from_nanoseconds(time);
        match *kind {
            CheckedKind::Arrival { arrival, entry_off, hallway } => {
                // The robot leaves along the door, and comes in along the entry door.
                let ways = if let Some(hallway) = hallway {
                    let by_entry = arrival.entry.map(|entry| entry + entry_off.unwrap_or(0.0) + PI);
                    let ways = [by_door.or(by_entry), by_entry.or(by_door)];
                    let half = hallway.length / 2.0;
                    ways.map(|way| (way.unwrap_or_default(), half)).to_vec()
                } else {
                    // Odometry before and after the drive gives the direction of the entry door.
                    let by_entry = arrival.entry.zip(entry_off);
                    let by_entry = by_entry.map(|(entry, off)| entry + off + PI);
                    by_door.or(by_entry).map(|way| (way, DISTANCE)).into_iter().collect()
                };
                if let Some(&(heading, _)) = ways.first() {
                    let turned = Odometry { heading, ..at }.moved(0.0, 0.0);
                    let there = if hallway.is_some() { at } else { turned };
                    log.write(ODOM, time, &odometry(stamp, &there))?;
                }
                for (heading, length) in ways {
                    at = Odometry { heading, ..at }.moved(0.0, length);
                    log.write(ODOM, time, &odometry(stamp, &at))?;
                }
                log.write(Percept::TOPIC, time, &arrival_message(stamp, &arrival))?;
                (last, by_door) = (Some(arrival), None);
            }
            CheckedKind::Door { door, number, off } => {
                log.write(Door::TOPIC, time, &door_message(stamp, number, door))?;
                let entered = last.and_then(|arrival| Some((arrival.shape?, arrival.entry?)));
                let leads = entered.and_then(|(shape, entry)| direction(shape, entry, door));
                by_door = leads.zip(off).map(|(leads, off)| leads + off);
            }
            CheckedKind::Action { number, action } => {
                log.write(Action::TOPIC, time, &action_message(stamp, number, action))?;
            }
            _ => {}
        }
    }
    log.finish()
}

/// A log of the scenes and odometry.
fn write_seen(seen: &[SensedScene], head: &Run) -> Result<Vec<u8>, LogWriteError> {
    let mut log = begin(head)?;
    let begun = seen.first().map_or(0, |seen| seen.source.time);
    for SensedScene { source, scene, odometry: there } in seen {
        let time = source.time.saturating_sub(begun);
        let stamp = Stamp::from_nanoseconds(time);
        log.write(ODOM, time, &odometry(stamp, there))?;
        log.write(Scene::TOPIC, time, &scene_message(stamp, scene))?;
    }
    log.finish()
}

/// The head of a shorter log, without the calibration and colours: it has no images.
fn head(judged: &JudgedLog) -> Run {
    let run = judged.opened.run.clone().unwrap_or_default();
    let marker = judged.checked.config.aid.name().to_owned();
    Run { marker, calibration: String::new(), colours: String::new(), ..run }
}

fn begin(head: &Run) -> Result<LogWriter<Vec<u8>>, LogWriteError> {
    let mut log = LogWriter::new(Vec::new())?;
    log.write(Run::TOPIC, 0, head)?;
    Ok(log)
}

fn odometry(stamp: Stamp, at: &Odometry) -> standard::OdometryMessage {
    standard::OdometryMessage::new(stamp, at, standard::Twist::default())
}
