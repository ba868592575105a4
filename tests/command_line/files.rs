//! No output replaces an input or another output, of any verb.

use std::{collections::BTreeSet, fs};

use super::{Scratch, names_in, stderr};

/// All options that write files: the verb, the option, and calls whose input IN is also the output OUT, each behind
/// the name of that file. WORLD, LOG and IMAGE are other inputs; NEW is another output.
const OUTPUTS: &str = "
check --failed: w.toml check --explorer cat --from IN --failed OUT
check --worst: w.toml check --from IN --worst OUT
check --report: w.xml check --from IN --report OUT | s.xml check --add IN --report OUT | w.sarif check --from IN --report OUT
explore --proof: w.proof explore IN --proof OUT
explore --map: w.toml explore IN --map OUT | w.svg explore IN --map OUT
compare --proof: w.proof compare IN WORLD --marker none --proof OUT
compare --html: w.html compare IN WORLD --marker none --html OUT | w.html compare WORLD IN --marker none --html OUT
draw --out: w.svg draw IN --out OUT | w.png draw IN --pose start --out OUT | c.png draw WORLD --pose start --calibration IN --out OUT
draw --labels: w.png draw IN --pose start --out NEW.png --labels OUT
simulate --log: w.mcap simulate IN --by-scene --log OUT | c.mcap simulate WORLD --calibration IN --log OUT | c.mcap simulate WORLD --colours IN --log OUT
simulate --svg: w.svg simulate IN --by-scene --svg OUT
simulate --html: w.html simulate IN --by-scene --html OUT
simulate --proof: w.proof simulate IN --by-scene --proof OUT
simulate --map: w.toml simulate IN --by-scene --map OUT
camera calibrate --out: c.toml camera calibrate IMAGE --initial IN --out OUT
camera calibrate --picture: i.png camera calibrate IN --picture OUT | i.png camera calibrate IMAGE IN --picture OUT
camera calibrate --mask-out: i.png camera calibrate IN --out NEW.toml --mask-out OUT
camera train --out: c.toml camera train --images DIR --labels DIR --calibration IN --out OUT
info --write-topics: l.toml info IN --write-topics OUT
conform --html: l.html conform IN --html OUT | w.html conform LOG --world IN --html OUT | m.html conform LOG --topics IN --html OUT
conform --minimise: l.mcap conform IN --minimise OUT | w.mcap conform LOG --world IN --minimise OUT
conform --map: l.toml conform IN --map OUT | l.toml conform --rerun IN --map OUT | m.toml conform --rerun LOG --topics IN --map OUT
conform --proof: l.proof conform IN --proof OUT | w.proof conform LOG --world IN --proof OUT
conform --picture: q.svg conform LOG --quirks IN --picture OUT
conform --report: l.xml conform IN --report OUT | l.sarif conform IN --report OUT
";

/// All other options with files: those that write and read no file, those that write several files into a folder, and
/// those that read.
const OTHERS: [(&str, &str); 11] = [
    ("check", "--journal --from --hosts --proof"),
    ("counterexample", "--out-dir --html --proof --report --atlas --hosts"),
    ("proofs", "--report"),
    ("simulate", "--calibration --colours --scanner"),
    ("drive", "--log --map --proof --calibration --colours --laser-params"),
    ("draw", "--calibration"),
    ("camera calibrate", "--initial"),
    ("camera train", "--images --labels --calibration"),
    ("sense", "--stages --calibration --colours --laser-params --topics"),
    ("info", "--topics"),
    ("conform", "--world --topics --calibration --colours --quirks --laser-params"),
];

/// The rows of `OUTPUTS`: verb, option, calls.
fn outputs() -> impl Iterator<Item = (&'static str, &'static str, &'static str)> {
    OUTPUTS.lines().skip(1).map(|row| {
        let (option, calls) = row.split_once(": ").unwrap();
        let (verb, option) = option.rsplit_once(' ').unwrap();
        (verb, option, calls)
    })
}

#[test]
fn every_option_that_writes_or_reads_a_file_is_in_the_list() {
    let scratch = Scratch::new("file_options");
    let verbs = outputs().map(|row| row.0).chain(OTHERS.map(|(verb, _)| verb));
    for verb in verbs.collect::<BTreeSet<_>>() {
        let writing = outputs().filter(|row| row.0 == verb).map(|row| row.1);
        let others = OTHERS.iter().filter(|other| other.0 == verb);
        let others = others.flat_map(|(_, options)| options.split(' '));
        let help = scratch.out(&format!("{verb} --help"), 0);
        let names = help.lines().filter_map(|line| {
            let (option, value) = line.trim_start().split_once(" <")?;
            let is_file =
                ["FILE>", "NAME|FILE>", "DIR>"].contains(&value.trim().trim_end_matches("..."));
            (is_file && option.starts_with('-')).then(|| option.rsplit(' ').next().unwrap())
        });
        let known: BTreeSet<_> = writing.chain(others).collect();
        assert_eq!(names.collect::<BTreeSet<_>>(), known, "{verb}");
    }
}

/// A folder with an input for each letter with which the names of inputs begin.
fn inputs() -> Scratch {
    let scratch = Scratch::new("no_output_replaces_an_input");
    scratch.write("w", scratch.bytes("worlds/shape-8.toml"));
    scratch.out("simulate w --by-scene --log l.mcap", 0);
    scratch.out("draw w --pose start --size 640x480 --out i.png", 0);
    scratch.out("camera calibrate i.png --out c.toml", 0);
    scratch.write("s", scratch.out("check --edges 2 --shard 1/2 --json", 0));
    for other in ["m", "q"] {
        scratch.write(other, "# a mapping\n");
    }
    fs::create_dir(scratch.path("empty")).unwrap();
    scratch
}

#[test]
fn no_output_replaces_an_input() {
    let scratch = inputs();
    let before = scratch.written();
    for call in outputs().flat_map(|row| row.2.split(" | ")) {
        let (name, call) = call.split_once(' ').unwrap();
        let case = scratch.path("case");
        fs::create_dir(&case).unwrap();
        let source = before.iter().find(|source| source.starts_with(&name[..1])).unwrap();
        let (input, content) = (case.join(name), scratch.bytes(source));
        fs::write(&input, &content).unwrap();
        let mut outputs = vec![format!("case/{name}"), format!("empty/../case/./{name}")];
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(name, case.join(format!("soft-{name}"))).unwrap();
            fs::hard_link(&input, case.join(format!("hard-{name}"))).unwrap();
            outputs.extend(["soft", "hard"].map(|link| format!("case/{link}-{name}")));
        }
        let there = names_in(&case);
        for output in outputs {
            let word = |word| match word {
                "IN" => format!("case/{name}"),
                "OUT" => output.clone(),
                "WORLD" => "w".to_owned(),
                "LOG" => "l.mcap".to_owned(),
                "IMAGE" => "i.png".to_owned(),
                "CALIBRATION" | "COLOURS" => "c.toml".to_owned(),
                "DIR" => "empty".to_owned(),
                word => word.replace("NEW", "new"),
            };
            let line = call.split(' ').map(word).collect::<Vec<_>>().join(" ");
            let result = scratch.run(&line);
            let message = stderr(&result);
            assert_eq!(result.status.code(), Some(2), "{line}: {message}");
            assert!(message.starts_with(&format!("error: {output}: this ")), "{line}: {message}");
            assert!(fs::read(&input).unwrap() == content, "{line} replaced its input");
            assert_eq!(names_in(&case), there, "{line}");
            assert!(result.stdout.is_empty(), "{line}");
        }
        fs::remove_dir_all(&case).unwrap();
    }
    assert_eq!(scratch.written(), before);
    let same = "./s.png: this is the same file as the output s.png; choose another name\n";
    facts! { scratch;
        "draw w --pose start --size 640x480 --out s.png --labels ./s.png" => 2 (same);
        "camera calibrate i.png --out new.toml --picture s.png --mask-out ./s.png" => 2 (same);
    }
    assert_eq!(scratch.written(), before);
}
