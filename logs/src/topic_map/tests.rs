use super::*;

fn wrong(text: &str) -> String {
    TopicMap::read(text.as_bytes()).unwrap_err().to_string()
}

const WHOLE: &str = "\
[image]
topic = \"/camera\"

[odometry]
topic = \"/place\"
x = \"at.x\"
y = \"at.y\"
heading = \"at[0].theta\"
length = \"inches\"
angle = \"degrees\"

[percept]
topic = \"/junction\"
degree = \"exits\"
";

#[test]
fn a_mapping_is_written_as_it_was_read() {
    let mapping = TopicMap::read(WHOLE.as_bytes()).unwrap();
    let odometry = mapping.carrier(Role::Odometry).unwrap();
    assert_eq!((odometry.length, odometry.angle), (LengthUnit::Inches, AngleUnit::Degrees));
    assert_eq!(odometry.paths[&MessagePart::Heading], "at[0].theta");
    assert_eq!(mapping.to_toml(), WHOLE);
    let strange = "[run]\ntopic = \"/a\\\"\\n\\u0001'b\"\n";
    let strange = TopicMap::read(strange.as_bytes()).unwrap();
    assert_eq!(TopicMap::read(strange.to_toml().as_bytes()).unwrap().to_toml(), strange.to_toml());
}

/// A mapping file, and how its error begins.
const ERRORS: &str = r#"
 | the file is empty
# nothing | no topic is mapped
[image | line 1, column 7:
image = 1 | line 1, column 9: image: expected a table
[pictures]\ntopic = "a" | line 1, column 2: pictures: unknown key; expected one of: image, scan, odometry, motion
[image]\ntopic = 1 | line 2, column 9: image.topic: expected the name of a topic
[image] | line 1, column 2: image: the key `topic` is missing
[image]\ntopic = "a"\n  x = "b" | line 3, column 3: image.x: unknown key; expected one of: topic
[odometry]\ntopic = "a"\nlength = "feet" | line 3, column 10: odometry.length: expected "metres" or "inches"
[door]\ntopic = "a"\nlength = "metres" | line 3, column 1: door.length: unknown key; expected one of: topic, move, door
[motion]\ntopic = "a"\nturn = 3 | line 3, column 8: motion.turn: expected the path of a field
[odometry]\ntopic = "a"\nheading = "h"\nquaternion = "q" | line 4, column 14: odometry.quaternion: there are both `heading` and `quaternion`; the file needs only one of them"#;

#[test]
fn an_error_has_its_line_and_column() {
    for row in ERRORS.lines().skip(1) {
        let (text, message) = row.split_once(" | ").unwrap();
        let found = wrong(&text.replace(r"\n", "\n"));
        assert!(found.starts_with(message), "{text}: {found}");
    }
    let bytes = TopicMap::read(b"[image]\ntopic = \"\xff\"").unwrap_err();
    assert_eq!(bytes.to_string(), "line 2, column 10: this is not UTF-8 text");
}
