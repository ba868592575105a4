//! Options of every verb: `--version`, `-` for a file of colours, and Ctrl-C. Other facts are in
//! `tests/facts/options.txt` and `tests/facts/input.txt`.

use std::{
    fs,
    process::Stdio,
    thread,
    time::{Duration, Instant},
};

use toposlam_logs::{entries::Content, reader::Log, topic_map::TopicMap};

use super::{Scratch, names_in, stderr, stdout};
use crate::process;

/// The standard output of a successful run with a file as its standard input.
fn printed(scratch: &Scratch, line: &str, file: &str) -> String {
    let file = fs::File::open(scratch.path(file)).unwrap();
    let output = scratch.command(line).stdin(file).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{line}: {}", stderr(&output));
    stdout(&output)
}

#[test]
fn the_version_is_that_of_the_package_with_the_revision_of_the_build() {
    let scratch = Scratch::new("version");
    let version = scratch.out("--version", 0);
    let package = version.trim_end().split('+').next().unwrap();
    assert_eq!(package, concat!("toposlam ", env!("CARGO_PKG_VERSION")));
    assert_eq!(version, scratch.out("-V", 0));
}

#[test]
fn colours_and_their_images_can_come_from_standard_input() {
    let scratch = Scratch::new("image_from_standard_input");
    let world = "worlds/shape-6.toml";
    scratch.out(&format!("draw {world} --pose start --size 640x480 -o v.png"), 0);
    scratch.write("c.toml", scratch.out("camera calibrate v.png", 0));
    // The colours are those in the log of a short run.
    scratch.out(&format!("simulate {world} --budget 3darts --log run.mcap"), 3);
    let log = Log::open(&scratch.path("run.mcap")).unwrap();
    let bound = TopicMap::unambiguous(&log).bind(&log).unwrap();
    let run = log.entries(&bound).find_map(|entry| match entry.unwrap().content {
        Content::Run(run) => Some(run),
        _ => None,
    });
    scratch.write("colours.toml", run.unwrap().colours);
    let sense = "sense v.png --calibration c.toml --colours colours.toml";
    let expected = scratch.out(sense, 0);
    for input in ["v.png", "c.toml", "colours.toml"] {
        let read = printed(&scratch, &sense.replace(input, "-"), input);
        assert_eq!(read.replace("-\n", "v.png\n"), expected, "{input}");
    }
    printed(&scratch, &format!("{} --stages steps", sense.replace("v.png", "-")), "v.png");
    let names = names_in(&scratch.path("steps"));
    assert!(names.iter().all(|name| name.starts_with("stdin-")), "{names:?}");
}

/// Ctrl-C, and any other signal to terminate, ends each verb with 3, also while it reads.
#[cfg(unix)]
#[test]
fn a_verb_that_is_interrupted_ends_at_once_with_3() {
    for (number, line) in [
        "draw -",
        "explore -",
        "play -",
        "compare - worlds/figure-1a.toml",
        "check --from -",
        "simulate -",
        "conform -",
        "conform --rerun -",
        "info -",
        "info --verify -",
        "camera calibrate -",
        "sense x.png --calibration - --colours x.toml",
    ]
    .into_iter()
    .enumerate()
    {
        let signal = ["-INT", "-TERM", "-HUP"][number % 3];
        let begun = Instant::now();
        let output = super::interrupted_by(signal, line);
        assert_eq!(output.status.code(), Some(3), "{line} {}", stderr(&output));
        assert_eq!(stderr(&output), "interrupted\n", "{line}");
        assert!(output.stdout.is_empty() && begun.elapsed() < Duration::from_secs(5), "{line}");
    }
}

/// The signal comes while all starts are counted, or while one of them is chosen.
#[cfg(unix)]
#[test]
fn an_interrupted_game_is_not_written() {
    let scratch = Scratch::new("play-interrupted");
    for (signal, milliseconds) in [("-INT", 300), ("-TERM", 1_500)] {
        let mut play = scratch.command("play --class multigraph --edges 8 --out page.html");
        let play = play.stderr(Stdio::piped()).spawn().unwrap();
        thread::sleep(Duration::from_millis(milliseconds));
        process::signal(&play, signal);
        let begun = Instant::now();
        let output = play.wait_with_output().unwrap();
        assert!(begun.elapsed() < Duration::from_secs(3), "{:?}", begun.elapsed());
        assert_eq!((output.status.code(), &*stderr(&output)), (Some(3), "interrupted\n"));
        assert_eq!(scratch.written(), [""; 0]);
    }
}
