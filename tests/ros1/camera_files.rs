//! The files by which a robot sees: its camera, and the colours of a building.

use std::{fs, path::Path, process::Command};

/// Writes `camera.toml`, a camera with images of 640 x 480, and `colours.toml`, as they are learned from a few labelled images.
pub(crate) fn write_camera_files(folder: &Path) {
    let run = |line: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_toposlam"));
        let status = command.args(line.split(' ')).current_dir(folder).status().unwrap();
        assert!(status.success(), "{line}");
    };
    for inside in ["images", "labels"] {
        fs::create_dir(folder.join(inside)).unwrap();
    }
    let camera = toposlam_vision::camera::Camera::superscout().sized([640, 480]);
    let camera = toposlam_vision::camera::calibration::to_toml(&camera);
    fs::write(folder.join("camera.toml"), camera).unwrap();
    let plan = concat!(env!("CARGO_MANIFEST_DIR"), "/worlds/shape-8.toml");
    for n in 1..=7 {
        let pose = format!("--pose 0,{n},{} --seed {n} --size 640x480", 50 * n);
        let files = format!("--out images/{n}.png --labels labels/{n}.png");
        run(&format!("draw {plan} --marker directional {pose} {files}"));
    }
    run(
        "camera train --images images --labels labels --calibration camera.toml --out colours.toml",
    );
}
