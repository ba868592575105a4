//! `toposlam drive --ros2` and a robot by Fast DDS, the usual implementation of DDS in ROS 2.

use std::{env, fs, io::Write, process::Command, process::Stdio};

use super::{
    Stage,
    output::{stderr, stdout},
    process::Process,
};

/// The building of `fastdds_robot.cpp`.
const PLAN: &str = "name = \"corner\"

[floor]
hallway_width = 2.0

[junctions]
corner = [0.0, 0.0]
north = [0.0, 8.0]
east = [8.0, 0.0]

[[hallways]]
from = \"corner\"
to = \"north\"

[[hallways]]
from = \"corner\"
to = \"east\"

[start]
at = \"corner\"
facing = \"east\"
";

/// Compiles the robot; `None` where there is no compiler, or no Fast DDS.
fn compiled(stage: &Stage) -> Option<String> {
    let header = b"#include <fastdds/dds/domain/DomainParticipant.hpp>\n";
    let look = Command::new("c++")
        .args(["-E", "-x", "c++", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn();
    let has = look.is_ok_and(|mut look| {
        look.stdin.take().is_some_and(|mut input| input.write_all(header).is_ok())
            && look.wait().is_ok_and(|status| status.success())
    });
    if !has {
        assert_ne!(env::var("TOPOSLAM_ROS").as_deref(), Ok("required"), "there is no Fast DDS");
        eprintln!("skipped: it needs a C++ compiler and Debian's libfastrtps-dev");
        return None;
    }
    let source = format!("{}/tests/ros2/fastdds_robot.cpp", env!("CARGO_MANIFEST_DIR"));
    let program = stage.path("fastdds_robot");
    let output = Command::new("c++")
        .args(["-std=c++17", "-O1", "-Wall", "-Wextra", "-o", &program, &source])
        .args(["-lfastrtps", "-lfastcdr"])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    Some(program)
}

#[test]
fn a_robot_by_fast_dds_maps_its_building() {
    let stage = Stage::new("fastdds");
    let Some(program) = compiled(&stage) else { return };
    let mut robot = stage.command(&program);
    robot.arg("16").env("ROS_DOMAIN_ID", stage.domain.to_string());
    let robot = Process::start(robot.stdin(Stdio::null()).stdout(Stdio::piped()));
    let output = stage.drive(&["--patience", "10"]).ends_within(200);
    assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
    let plan = stage.path("corner.toml");
    fs::write(&plan, PLAN).unwrap();
    let compared = stage.out(&["compare", &plan, &stage.path("map.toml"), "--json"]);
    assert!(compared.contains("\"isomorphic\":true"), "{compared}");
    assert!(compared.contains("\"distinguishable\":false"), "{compared}");
    robot.signal("-INT");
    let obeyed = robot.ends_within(20);
    // It reads nothing but TwistStamped, and stands at the end.
    assert!(obeyed.status.success(), "{}", stderr(&obeyed));
    assert!(stdout(&obeyed).contains("commands, the last 0.000 0.000"), "{}", stdout(&obeyed));
}
