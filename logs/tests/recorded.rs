//! Bags that ROS recorded in a session of turtlesim. They are not part of the repository.

use std::{env, path::PathBuf, process::Command};

use toposlam_logs::reader::Log;

use super::recorded_logs;

fn folder() -> Option<PathBuf> {
    recorded_logs("logs", "TOPOSLAM_LOGS", "example.bag")
}

/// The counts of PyPI's `rosbags` 0.11.9.
const SESSION: [(&str, &str, u64); 9] = [
    ("/rosout", "rosgraph_msgs/Log", 10),
    ("/tf", "tf/tfMessage", 2688),
    ("/tf_static", "tf2_msgs/TFMessage", 1),
    ("/turtle1/cmd_vel", "geometry_msgs/Twist", 357),
    ("/turtle1/color_sensor", "turtlesim/Color", 1351),
    ("/turtle1/pose", "turtlesim/Pose", 1344),
    ("/turtle2/cmd_vel", "geometry_msgs/Twist", 208),
    ("/turtle2/color_sensor", "turtlesim/Color", 1344),
    ("/turtle2/pose", "turtlesim/Pose", 1344),
];

#[test]
fn a_session_is_the_same_with_any_compression() {
    let Some(folder) = folder() else { return };
    let mut all = Vec::new();
    for name in ["example.bag", "example-bz2.bag", "example-lz4.bag"] {
        let log = Log::open(&folder.join(name)).unwrap();
        assert_eq!(log.truncation(), None);
        let topics = log.topics().iter().filter(|topic| topic.messages > 0);
        let mut topics: Vec<_> =
            topics.map(|topic| (&*topic.name, &*topic.type_name, topic.messages)).collect();
        topics.sort_unstable();
        assert_eq!(topics, SESSION);
        assert_eq!(log.messages_total(), 8647);
        assert_eq!(log.start(), Some(1_396_293_887_844_783_943));
        assert_eq!(log.end(), Some(1_396_293_909_544_870_199));
        let mut last = 0;
        let messages = log.read_all().map(|message| {
            let message = message.unwrap();
            let topic = &log.topics()[message.topic];
            let value = topic.decode(&message.bytes).unwrap().unwrap();
            assert!(message.time >= last);
            last = message.time;
            format!("{} {} {value:?}", topic.name, message.time)
        });
        let messages: Vec<_> = messages.collect();
        assert_eq!(messages.len(), 8647);
        all.push(messages);
    }
    assert!(all[0] == all[1] && all[0] == all[2]);
}

#[test]
fn a_bag_whose_chunks_are_out_of_order_is_read_in_order() {
    let Some(folder) = folder() else { return };
    let log = Log::open(&folder.join("example-unsorted-chunks.bag")).unwrap();
    let times: Vec<_> = log.read_all().map(|message| message.unwrap().time).collect();
    assert_eq!(times, [1_000_000_000, 2_000_000_000, 3_000_000_000]);
    let log = Log::open(&folder.join("no-messages.bag")).unwrap();
    assert_eq!((log.messages_total(), log.start(), log.read_all().count()), (0, None, 0));
}

/// Prints time, topic and byte sum of each message.
const OTHER_READER: &str = "
import sys
from rosbags.rosbag1 import Reader
with Reader(sys.argv[1]) as reader:
    for connection, time, raw in reader.messages():
        print(time, connection.topic, sum(raw), len(raw))
";

#[test]
fn another_reader_reads_the_same() {
    let Some(folder) = folder() else { return };
    let python = env::var_os("PYTHON").unwrap_or_else(|| "python3".into());
    for name in ["example.bag", "example-bz2.bag", "example-lz4.bag", "example-unsorted-chunks.bag"]
    {
        let path = folder.join(name);
        let output = Command::new(&python).args(["-c", OTHER_READER]).arg(&path).output();
        let Some(output) = output.ok().filter(|output| output.status.success()) else {
            return eprintln!("skipped: there is no Python with rosbags");
        };
        let log = Log::open(&path).unwrap();
        let ours = log.read_all().map(|message| {
            let message = message.unwrap();
            let sum: u64 = message.bytes.iter().map(|byte| u64::from(*byte)).sum();
            let topic = &log.topics()[message.topic].name;
            format!("{} {topic} {sum} {}", message.time, message.bytes.len())
        });
        let mut ours: Vec<String> = ours.collect();
        let theirs = String::from_utf8(output.stdout).unwrap();
        let mut theirs: Vec<_> = theirs.lines().collect();
        // Readers order messages with equal times differently.
        ours.sort();
        theirs.sort_unstable();
        assert_eq!(ours, theirs);
    }
}
