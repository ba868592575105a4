//! What is extracted of a log, besides its events.

use std::f64::consts::PI;

use toposlam_logs::{
    message::Message,
    messages::{self, ProjectMessage, Stamp},
    reader,
    recorder::{IMAGE, ODOM, SCAN},
    standard::{CompressedImage, LaserScanMessage, OdometryMessage, Twist},
    topic_map::TopicMap,
    writer::LogWriter,
};
use toposlam_vision::laser::scan::{Scan, ScanGeometry};

use super::*;

const SECOND: u64 = 1_000_000_000;

/// A log that is written one message a second.
struct Written {
    writer: LogWriter<Vec<u8>>,
    seconds: u64,
}

impl Written {
    fn new() -> Self {
        let mut writer = LogWriter::new(Vec::new()).unwrap();
        writer.write(messages::Run::TOPIC, 0, &messages::Run::default()).unwrap();
        Self { writer, seconds: 5000 }
    }

    fn write<M: Message>(&mut self, topic: &str, message: impl FnOnce(Stamp) -> M) {
        self.seconds += 1;
        let stamp = Stamp::from_nanoseconds(self.seconds * SECOND);
        self.writer.write(topic, stamp.nanoseconds(), &message(stamp)).unwrap();
    }

    fn odometry(&mut self) {
        self.write(ODOM, |at| OdometryMessage::new(at, &Odometry::default(), Twist::default()));
    }

    /// Odometry whose stamp is wrong.
    fn late_odometry(&mut self) {
        self.write(ODOM, |at| {
            let late = Stamp { sec: at.sec - 100, ..at };
            OdometryMessage::new(late, &Odometry::default(), Twist::default())
        });
    }

    fn scan(&mut self) {
        let geometry = ScanGeometry {
            angle_min: -PI / 2.0,
            angle_increment: PI / 4.0,
            range_min: 0.1,
            range_max: 9.0,
        };
        let scan = Scan::new(geometry, vec![1.0; 5], nalgebra::Isometry2::identity()).unwrap();
        self.write(SCAN, |stamp| LaserScanMessage::new(stamp, &scan));
    }

    fn scene(&mut self) {
        let [place, status] = ["hallway", "clear"].map(str::to_owned);
        let scene = messages::Scene { place, status, ..messages::Scene::default() };
        self.write(messages::Scene::TOPIC, |stamp| messages::Scene { stamp, ..scene });
    }

    fn image(&mut self) {
        self.write(IMAGE, |stamp| CompressedImage::new(stamp, b"no image"));
    }

    /// A robot that passes a junction, with all kinds of evidence.
    fn passing() -> Self {
        let mut log = Self::new();
        log.odometry();
        log.visit();
        log.scene();
        log.scan();
        log
    }

    /// An arrival, and the door by which the robot leaves.
    fn visit(&mut self) {
        let form = [true, false, true, false];
        let percept = messages::Percept { degree: 2, form, ..messages::Percept::default() };
        self.write(messages::Percept::TOPIC, |stamp| messages::Percept { stamp, ..percept });
        self.write(messages::Door::TOPIC, |stamp| messages::Door { stamp, r#move: 1, door: 1 });
    }

    fn end(&mut self) {
        self.write(messages::Map::TOPIC, |_| messages::Map::default());
        let ending = "mapped".to_owned();
        self.write(messages::End::TOPIC, |_| messages::End { ending, ..messages::End::default() });
    }

    fn open(self) -> (reader::Log, TopicMap) {
        opened(self.writer.finish().unwrap())
    }

    fn extract(self, evidence: Evidence) -> Result<ExtractedRun, ExtractError> {
        let (log, mapping) = self.open();
        extract(&log, &mapping, &ExtractConfig::new(evidence), &())
    }
}

fn opened(bytes: Vec<u8>) -> (reader::Log, TopicMap) {
    let log = reader::Log::of_bytes(bytes).unwrap();
    let mapping = TopicMap::unambiguous(&log);
    (log, mapping)
}

#[test]
fn the_first_source_of_events_that_is_complete_is_chosen() {
    const ALL: [fn(&mut Written); 4] =
        [Written::scan, Written::image, Written::scene, Written::visit];
    for (kinds, has_odometry, source) in [
        (4, true, Some(Evidence::Recorded)),
        (3, true, Some(Evidence::Scenes)),
        (2, true, Some(Evidence::Images)),
        (1, true, Some(Evidence::Laser)),
        (1, false, Some(Evidence::Laser)),
        (0, true, None),
    ] {
        let mut log = Written::new();
        ALL.iter().take(kinds).for_each(|write| write(&mut log));
        if has_odometry {
            log.odometry();
        }
        assert_eq!(Evidence::from_topics(&log.open().1), source);
    }
    let sources = [Evidence::Recorded, Evidence::Scenes, Evidence::Images, Evidence::Laser];
    assert_eq!(sources.map(Evidence::option), ["recorded", "scenes", "images", "laser"]);
    assert_eq!(sources.map(Evidence::name), ["recorded", "scenes", "pictures", "laser"]);
}

#[test]
fn the_end_of_a_run_is_left_out_where_corners_are_no_junctions() {
    let run = |evidence| {
        let mut log = Written::passing();
        log.end();
        log.extract(evidence).unwrap()
    };
    for evidence in [Evidence::Recorded, Evidence::Scenes] {
        let RunEvents { has_head, end, map, .. } = run(evidence).events;
        assert!(has_head && end.is_some() && map.is_some(), "{evidence:?}");
    }
    let by_laser = run(Evidence::Laser);
    let RunEvents { has_head, end, map, .. } = by_laser.events;
    assert!(!has_head && end.is_none() && map.is_none());
    assert_eq!((by_laser.scans, by_laser.seen.len()), (1, 0));
    // 180 degrees.
    assert!((by_laser.field_of_view - PI).abs() < 1e-6, "{}", by_laser.field_of_view);
    // A log without an end keeps its head.
    let mut log = Written::new();
    log.odometry();
    log.scan();
    assert!(log.extract(Evidence::Laser).unwrap().events.has_head);
    let recorded = run(Evidence::Recorded);
    assert_eq!((recorded.events.events.len(), recorded.scans, recorded.seen.len()), (2, 0, 0));
    assert_eq!(run(Evidence::Scenes).seen.len(), 1);
}

#[test]
fn scans_long_before_the_first_odometry_and_off_the_clock_are_counted() {
    let mut log = Written::new();
    (0..53).for_each(|_| log.scan());
    log.odometry();
    (0..20).for_each(|_| log.scan());
    log.seconds += 3601;
    log.scan();
    let run = log.extract(Evidence::Laser).unwrap();
    // Fifty scans wait for their odometry.
    let skipped = SkippedMessages { off_clock: 1, scans_without_odometry: 3 };
    assert_eq!((run.scans, run.skipped), (70, skipped));
    let nowhere = |write: fn(&mut Written)| {
        let mut log = Written::new();
        write(&mut log);
        log.extract(Evidence::Laser)
    };
    let by_scans = nowhere(Written::scan).unwrap();
    assert_eq!(
        (by_scans.scans, by_scans.matched_scans),
        (1, Some(MatchedScans { placed: 0, unmatched: 1 }))
    );
    let unmatched = nowhere(|log| (0..10).for_each(|_| log.scan())).unwrap_err();
    assert!(matches!(
        unmatched,
        ExtractError::Unmatched(UnmatchedScan { message: EventId(2), time: 5_001_000_000_000 })
    ));
    let by_scenes = nowhere(Written::scene).unwrap();
    assert_eq!((by_scenes.scans, by_scenes.matched_scans), (0, None));
}

/// Recorded events and scans are compared with odometry in the order of the log.
#[test]
fn stamps_of_odometry_matter_only_to_scenes() {
    let run = |evidence| {
        let mut log = Written::passing();
        log.late_odometry();
        log.extract(evidence)
    };
    assert_eq!(run(Evidence::Recorded).unwrap().events.events.len(), 2);
    assert_eq!(run(Evidence::Laser).unwrap().scans, 1);
    let by_scenes = run(Evidence::Scenes).unwrap_err();
    assert!(matches!(by_scenes, ExtractError::SceneClock(SceneClockError::Back { .. })));
}

/// Where the robot recovered is all that recorded events show beside scenes: neither their order nor their stamps matter.
#[test]
fn recorded_events_have_an_order_and_a_fixed_marker_where_they_are_the_evidence() {
    let run = |change: fn(&mut Written), evidence| {
        let mut log = Written::passing();
        change(&mut log);
        log.extract(evidence).map(|run| run.events.events.len())
    };
    let earlier = |log: &mut Written| {
        log.write(messages::Percept::TOPIC, |at| {
            let stamp = Stamp { sec: at.sec - 100, ..at };
            messages::Percept { stamp, degree: 2, ..messages::Percept::default() }
        });
    };
    let order = run(earlier, Evidence::Recorded).unwrap_err();
    assert!(matches!(order, ExtractError::OutOfOrder { message: 7, .. }), "{order}");
    assert!(run(earlier, Evidence::Scenes).is_ok());
    let action = |log: &mut Written| {
        let action = "drop".to_owned();
        log.write(messages::Action::TOPIC, |stamp| messages::Action { stamp, r#move: 1, action });
    };
    assert_eq!(run(action, Evidence::Recorded).unwrap(), 3);
    let moves = run(action, Evidence::Scenes).unwrap_err();
    assert!(matches!(moves, ExtractError::Action { message: 7, .. }), "{moves}");
}

#[test]
fn a_scene_off_the_clock_is_counted() {
    let mut log = Written::passing();
    log.scene();
    log.seconds += 3601;
    log.scene();
    let run = log.extract(Evidence::Scenes).unwrap();
    assert_eq!((run.seen.len(), run.skipped.off_clock), (2, 1));
}

#[test]
fn images_need_a_sensor() {
    let mut log = Written::new();
    log.odometry();
    log.image();
    assert!(matches!(log.extract(Evidence::Images), Err(ExtractError::NoSensor)));
}

#[test]
fn a_robot_that_turned_back_is_not_one_at_a_junction_that_was_not_recognised() {
    let kinds = |line: &str| {
        let (log, mapping) = opened(line.as_bytes().to_vec());
        let run = extract(&log, &mapping, &ExtractConfig::new(Evidence::Recorded), &()).unwrap();
        run.events.events.into_iter().map(|event| event.kind).collect::<Vec<_>>()
    };
    let unclear = CheckedKind::Undecided(UndecidedCause::Unclear);
    let turned = "{\"kind\":\"event\",\"degree\":null,\"door\":null,\"turned_back\":true}\n";
    assert_eq!(kinds(turned), [CheckedKind::TurnedBack, unclear.clone()]);
    assert_eq!(kinds("{\"kind\":\"event\",\"degree\":null,\"door\":null}\n"), [unclear]);
}
