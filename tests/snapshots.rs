//! What the commands print: each file in `tests/snapshots/COMMAND` is a list of calls and their output.
//!
//! `./dev snapshots` writes what is printed now. Facts (counts, verdicts, fields, files) are tests in
//! `tests/command_line`.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::{collections::BTreeSet, env, fs, path::Path, sync::LazyLock};

const REPOSITORY: &str = env!("CARGO_MANIFEST_DIR");

/// The calls run in one folder, in which they may write. It shows the inputs of the repository by their usual
/// names.
static FOLDER: LazyLock<()> = LazyLock::new(|| {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("snapshots");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    for (name, inputs) in
        [("worlds", "worlds"), ("fuzz", "fuzz"), ("files", "tests/snapshots/files")]
    {
        let inputs = Path::new(REPOSITORY).join(inputs);
        #[cfg(unix)]
        std::os::unix::fs::symlink(inputs, folder.join(name)).unwrap();
        #[cfg(windows)]
        std::os::windows::fs::symlink_dir(inputs, folder.join(name)).unwrap();
    }
    env::set_current_dir(folder).unwrap();
});

fn run(command: &str) {
    LazyLock::force(&FOLDER);
    let program = Path::new(env!("CARGO_BIN_EXE_toposlam"));
    let files = format!("{REPOSITORY}/tests/snapshots/{command}/*.trycmd");
    trycmd::TestCases::new().register_bin("toposlam", program).case(files);
}

macro_rules! snapshots {
    ($($command:ident)*) => {
        $(#[test]
        fn $command() {
            run(stringify!($command));
        })*

        #[test]
        fn each_folder_is_checked() {
            let folders = fs::read_dir(Path::new(REPOSITORY).join("tests/snapshots")).unwrap();
            let mut names: BTreeSet<_> =
                folders.map(|folder| folder.unwrap().file_name().into_string().unwrap()).collect();
            names.remove("files");
            assert_eq!(names, BTreeSet::from([$(stringify!($command).to_owned()),*]));
        }
    };
}

snapshots! { check compare conform counterexample draw explore info play proofs simulate world_files }
