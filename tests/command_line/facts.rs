//! Each file in `tests/facts` is a list of commands, which run in one folder: a command, then its exit code and what
//! [`Scratch::fact`] checks. A block that begins with `> FILE` writes a file. One that begins with `!` is for the shell,
//! in which each command must succeed; the program is `$TOPOSLAM`.

use std::process::Command;

use serde_json::Value;

use super::{Scratch, names_in};
use crate::printed;

fn check_file(name: &str) {
    let scratch = Scratch::new(&format!("facts-{name}"));
    let text = scratch.text(&format!("tests/facts/{name}.txt"));
    for block in text.trim_end().split("\n\n") {
        let mut lines = block.lines().skip_while(|line| line.starts_with("# "));
        let first = lines.next().unwrap_or_else(|| panic!("{name}: {block}"));
        let rest = lines.collect::<Vec<_>>().join("\n");
        if let Some(file) = first.strip_prefix("> ") {
            scratch.write(file, rest + "\n");
            continue;
        }
        if let Some(script) = first.strip_prefix("! ") {
            let script = format!("{script}\n{rest}");
            let mut shell = Command::new("bash");
            let shell = shell.args(["-euo", "pipefail", "-c", &script]).current_dir(&scratch.0);
            printed(shell.env("TOPOSLAM", env!("CARGO_BIN_EXE_toposlam")));
            continue;
        }
        let line = first.strip_prefix("$ ").unwrap_or_else(|| panic!("{name}: {block}"));
        let (code, expected) = rest.split_once(' ').unwrap_or((&rest, "null"));
        let expected: Value = match code {
            "2" => expected.into(),
            _ => serde_json::from_str(expected).expect(block),
        };
        scratch.fact(line, code.parse().expect(block), &expected);
    }
}

macro_rules! files {
    ($($name:ident)*) => {
        $(#[test]
        fn $name() {
            check_file(stringify!($name));
        })*

        #[test]
        fn each_file_is_checked() {
            let files = names_in(&crate::repository("tests/facts"));
            assert_eq!(files, [$(concat!(stringify!($name), ".txt")),*]);
        }
    };
}

files! {
    calibrate check compare conform draw explore explorer info input laser lines names options page rerun safeguards shards simulate
    train walks worlds
}
