//! `toposlam simulate`.

use std::fs;

use super::{folder, names_in, objects, read_world, run, stderr, stdout, stdout_of};

const SHAPE_6: &str = "worlds/shape-6.toml";
const SHAPE_8: &str = "worlds/shape-8.toml";

// paper: exp.simulated
// paper: exp.maps
#[test]
fn a_robot_that_sees_only_its_images_maps_shape_6() {
    let folder = folder("simulate");
    let [map, svg, html, frames] =
        ["map.toml", "run.svg", "run.html", "frames"].map(|name| folder.join(name));
    let output = run([
        "simulate".as_ref(),
        SHAPE_6.as_ref(),
        "--seed".as_ref(),
        "3".as_ref(),
        "--map".as_ref(),
        map.as_os_str(),
        "--svg".as_ref(),
        svg.as_os_str(),
        "--html".as_ref(),
        html.as_os_str(),
        "--frames".as_ref(),
        frames.as_os_str(),
    ]);
    let text = stdout(&output);
    assert_eq!(output.status.code(), Some(0), "{text}{}", stderr(&output));
    for part in [
        "World shape-6. The robot starts at corner, with its back to the door to tee.",
        "It puts its marker down here, at vertex v0 of the map. It senses 2 doors, marker\nalong door 0.",
        "So v1.2 and v4.1 are the two ends of one edge.",
        "The map is right, after 7 moves, all as specified.",
        "  moves             7 (7 in the plan's embedded graph)",
        "  certificate       7 moves; the run took 1.00 times as many\n",
        "  edges             6",
        " s off-line, ",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
    let (world, map) = (read_world(SHAPE_6.as_ref()), read_world(&map));
    assert_eq!(map.graph.edge_count(), world.graph.edge_count());
    let page = fs::read_to_string(&html).unwrap();
    assert!(page.contains("data:image/jpeg;base64,") && page.contains("So v1.2 and v4.1"));
    assert!(fs::read_to_string(&svg).unwrap().starts_with("<svg"));
    let names = names_in(&frames);
    assert!(names.len() > 60 && names[0] == "00001.jpg", "{names:?}");
    fs::remove_dir_all(folder).unwrap();
}

// paper: exp.multiplicative
#[test]
fn the_result_of_a_run_is_one_object_and_always_the_same() {
    for (plan, seed, moves, edges) in [(SHAPE_6, "0", 7, 6), (SHAPE_8, "1", 10, 7)] {
        let report = || {
            let text = stdout_of(["simulate", plan, "--by-scene", "--seed", seed, "--json"]);
            let mut object = objects(&text).remove(0);
            // The one thing that is a wall time.
            assert!(object["compute_seconds"].as_f64().unwrap() > 0.0);
            object["compute_seconds"] = serde_json::Value::Null;
            object
        };
        let object = report();
        assert_eq!(object, report());
        assert_eq!(object["schema"], 1);
        assert_eq!((&object["moves"], &object["explore_moves"]), (&moves.into(), &moves.into()));
        assert_eq!(object["edges"], edges);
        assert_eq!(object["algorithm"], "folding");
        assert_eq!(object["certificate"], serde_json::json!({ "moves": moves, "ratio": 1.0 }));
        for holds in ["isomorphic", "pose_true", "conforms"] {
            assert_eq!(object[holds], true, "{object}");
        }
        for nothing in ["divergence", "error"] {
            assert!(object[nothing].is_null(), "{object}");
        }
        assert!(object["frames"].as_u64().unwrap() > 60);
        assert!(object["simulated_seconds"].as_f64().unwrap() > 180.0);
    }
}

#[test]
fn a_robot_that_gives_up_reports_where_and_why() {
    for (fault, why) in [
        (
            "blocked@20",
            "on move 2, by door 1: 3 commands in a row were not carried out; in a hallway",
        ),
        ("lights-out@20", "7 images in a row do not show where the robot is"),
        ("dropped@20:50", "6 unusable images in a row: the camera gives no image"),
    ] {
        let output = run(["simulate", SHAPE_6, "--by-scene", "--fault", fault]);
        let text = stdout(&output);
        assert_eq!(output.status.code(), Some(1), "{text}");
        let flowing = text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(flowing.contains("The robot gave up: on move ") && flowing.contains(why), "{text}");
        assert!(text.contains("  map               "), "{text}");
    }
}

#[test]
fn a_fault_that_does_not_happen_is_not_survived() {
    let run_with = |more: &[&str]| {
        run([&["simulate", SHAPE_6, "--by-scene", "--fault", "carried@99999"], more].concat())
    };
    let output = run_with(&[]);
    let text = stdout(&output);
    assert_eq!(output.status.code(), Some(3), "{text}");
    let expected = "The fault carried@99999:1 did not happen: the run ended after ";
    assert!(text.contains(expected) && text.contains("The map is right"), "{text}");
    let output = run_with(&["--json", "--fault", "late@20"]);
    assert_eq!(output.status.code(), Some(3));
    let line = objects(&stdout(&output)).remove(0);
    assert_eq!(line["faults_missed"], serde_json::json!(["carried@99999:1"]));
    // A violation is worse.
    assert_eq!(run_with(&["--fault", "lights-out@20"]).status.code(), Some(1));
}

#[test]
fn a_robot_with_too_few_darts_is_incomplete() {
    let output = run(["simulate", SHAPE_8, "--by-scene", "--max-darts", "6"]);
    assert_eq!(output.status.code(), Some(3), "{}", stdout(&output));
    assert!(stdout(&output).contains("more than 6"), "{}", stdout(&output));
}

#[test]
fn bad_arguments_are_reported_before_the_run() {
    let folder = folder("simulate_bad");
    let write = |name: &str, text: &str| {
        let file = folder.join(name);
        fs::write(&file, text).unwrap();
        file.to_str().unwrap().to_owned()
    };
    let shape = fs::read_to_string(SHAPE_6).unwrap();
    let of_width = |name, width| write(name, &shape.replace("hallway_width = 1.6", width));
    let narrow = of_width("narrow.toml", "hallway_width = 0.9");
    let wide = write(
        "wide.toml",
        "[floor]\nhallway_width = 2.6\n[junctions]\na = [0.0, 0.0]\nb = [9.0, 0.0]\nc = [9.0, 9.0]\n\
         [[hallways]]\nfrom = \"a\"\nto = \"b\"\n[[hallways]]\nfrom = \"b\"\nto = \"c\"\n\
         [start]\nat = \"b\"\nfacing = \"a\"\n",
    );
    // Four metres apart: closer than two widths of 2.1 m.
    let close = of_width("close.toml", "hallway_width = 2.1");
    let camera = write(
        "camera.toml",
        "[camera]\nkind = \"spherical-mirror\"\nimage = [640, 480]\ncentre = [320.0, 240.0]\n\
         focal = 636.4\nmirror_radius = 0.05\nmirror_distance = 0.15\ncamera_height = 0.9\n\
         ahead = 90.0\nseen_from = \"below\"\nmask = \"dark.png\"\n",
    );
    image::GrayImage::new(640, 480).save(folder.join("dark.png")).unwrap();
    let cases: [(&[&str], &str); 11] = [
        (&[&narrow], "its hallways are 0.9 m wide; a robot 0.41 m across needs 1.21 m"),
        (&[&wide], "its hallways are 2.6 m wide; sensing sees up to 2.3 m"),
        (&[&close], "are 4.00 m apart; it must be two hallway widths, 4.20 m"),
        (
            &["worlds/building-12.toml", "--start", "courtyard:west"],
            "the start, courtyard, is a dead end; a run starts at an L",
        ),
        (&[SHAPE_6, "--start", "tee:sw"], "the start, tee, is a T; a run starts at an L"),
        (&["worlds/petersen.toml"], "this world is not a floor plan"),
        (&[SHAPE_6, "--calibration", "missing.toml"], "missing.toml: cannot be read"),
        (&[SHAPE_6, "--calibration", &camera], "error: "),
        (
            &[SHAPE_6, "--noise", "9"],
            "with more than 5 times the default noise a robot cannot navigate",
        ),
        // A number, and not an option.
        (&[SHAPE_6, "--noise", "-1"], "for '--noise <TIMES>': write a number from 0 to 5"),
        (&[SHAPE_6, "--fault", "fog@3"], "the faults are dropped, late, frozen"),
    ];
    for (arguments, cause) in cases {
        let output = run([&["simulate"][..], arguments].concat());
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
        assert!(message.starts_with("error: ") && message.contains(cause), "{message}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
    }
    fs::remove_dir_all(folder).unwrap();
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_reports_its_results_and_is_incomplete() {
    use std::{
        io::{BufRead, BufReader, Read},
        process::{Command, Stdio},
    };

    let mut robot = super::toposlam();
    // Far too long to end by itself.
    robot.args(["simulate", "worlds/building-25.toml", "--start", "north-west:west-upper"]);
    let mut robot = robot.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut out = BufReader::new(robot.stdout.take().unwrap());
    // Its first line shows that it is at work.
    let mut text = String::new();
    out.read_line(&mut text).unwrap();
    let killed = Command::new("kill").args(["-INT", &robot.id().to_string()]).status().unwrap();
    assert!(killed.success());
    out.read_to_string(&mut text).unwrap();
    let output = robot.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(3), "{text}{}", stderr(&output));
    assert!(text.contains("The robot gave up: the run was ended on move "), "{text}");
    assert!(text.contains("  map               "), "{text}");
}

#[test]
fn a_run_starts_at_the_l_nearest_to_a_start_that_is_none() {
    for (plan, start) in
        [("worlds/building-12.toml", "courtyard"), ("worlds/building-25.toml", "east-door")]
    {
        let output = run(["simulate", plan, "--by-scene", "--json"]);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(0), "{message}");
        let note = format!("the start of the plan, {start}, is not an L, where a marker can lie\n");
        assert!(message.starts_with("the run starts at ") && message.contains(&note), "{message}");
        // A start that is asked for is not replaced.
        let facing = if start == "courtyard" { "west" } else { "south-east" };
        let given = format!("{start}:{facing}");
        let output = run(["simulate", plan, "--by-scene", "--start", &given]);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains("is a dead end; a run starts at an L"));
    }
}
