use super::*;

fn ros1(text: &str) -> Result<Definition, String> {
    Definition::read(Dialect::Ros1, "a/A", text).map_err(|error| error.to_string())
}

fn ros2(text: &str) -> Result<Definition, String> {
    Definition::read(Dialect::Ros2, "a/msg/A", text).map_err(|error| error.to_string())
}

const LINE: &str =
    "================================================================================";

#[test]
fn a_message_of_ros_1_is_resolved_through_its_sections() {
    let text = format!(
        "# said\nHeader header # who\nB[] parts\nuint8 LEFT=1\nstring WORD= a # b \nfloat64[9] K\n\
         \n{LINE}\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n{LINE}\nMSG: a/B\nbyte x\nchar y\n"
    );
    let definition = ros1(&text).unwrap();
    let root = definition.root();
    assert_eq!(root.name, "a/A");
    let names: Vec<_> = root.fields.iter().map(|field| field.name.as_str()).collect();
    assert_eq!(names, ["header", "parts", "K"]);
    assert_eq!(root.field("K").unwrap().1.count, Count::Fixed(9));
    let FieldType::Struct(header) = root.fields[0].kind else { panic!() };
    let header = definition.get(header).unwrap();
    assert_eq!(header.fields[1].kind, FieldType::Time);
    let FieldType::Struct(part) = root.fields[1].kind else { panic!() };
    let kinds: Vec<_> =
        definition.get(part).unwrap().fields.iter().map(|field| field.kind).collect();
    assert_eq!(kinds, [FieldType::Int(1), FieldType::Unsigned(1)]);
    assert_eq!(root.least, 16 + 4 + 72);
}

#[test]
fn a_message_of_ros_2_has_bounds_and_defaults() {
    let text = format!(
        "builtin_interfaces/Time stamp\nstring<=10 name \"a b\"\nint32[<=5] few [1, 2]\nbyte b 3\n\
         geometry_msgs/msg/Point at\nwstring w\nstring<=3[2] words\nint32 MOST = 4 # four\n\
         {LINE}\nMSG: geometry_msgs/Point\nfloat64 x 1.5\n"
    );
    let definition = ros2(&text).unwrap();
    let root = definition.root();
    assert_eq!(root.fields[2].count, Count::AtMost(5));
    assert_eq!(root.fields[3].kind, FieldType::Unsigned(1));
    assert_eq!(root.fields[5].kind, FieldType::WideText);
    assert_eq!(root.fields[6].count, Count::Fixed(2));
    assert_eq!(root.fields.len(), 7);
    let FieldType::Struct(stamp) = root.fields[0].kind else { panic!() };
    assert_eq!(definition.get(stamp).unwrap().fields[1].name, "nanosec");
    // A message without fields takes a byte.
    assert_eq!(ros2("").unwrap().root().least, 1);
    assert_eq!(ros1("").unwrap().root().least, 0);
}

/// A definition, and the line and the cause of its error.
const ERRORS: &str = r"
int32 | 1: `int32` is neither a field nor a constant
int32 a\nint32 a | 2: there are two fields `a`
int32 1a | 1: `1a` is not a name
int32[x] a | 1: `int32[x] a` is neither a field nor a constant
\nB b | 2: the type `B` is not defined
B B=1 | 1: the type `B` cannot be used for a constant
A a | 1: `A` is a part of itself
B b\n===\nMSG: a/B\nA[] a | 4: `A` is a part of itself
B[] b\n===\nMSG: a/B\n | 1: a list of `B`, which has no fields
B b\n===\nMSG: c/B\nint8 x\n===\nMSG: d/B\nint8 x | 1: the type `B` is defined more than once
===\nint8 x | 2: `int8 x` is neither a field nor a constant
int8 x 1 | 1: `int8 x 1` is neither a field nor a constant";

#[test]
fn an_error_has_its_line() {
    for row in ERRORS.lines().skip(1) {
        let (text, error) = row.split_once(" | ").unwrap();
        let (line, cause) = error.split_once(": ").unwrap();
        let expected = format!("line {line} of the definition: {cause}");
        assert_eq!(ros1(&text.replace(r"\n", "\n")).unwrap_err(), expected);
    }
}

#[test]
fn a_message_is_neither_deep_nor_wide_without_end() {
    let chain = |parts: usize, field: fn(usize) -> String| {
        let sections = (0..parts).map(|nth| format!("===\nMSG: a/B{nth}\n{}", field(nth + 1)));
        format!("{}{}===\nMSG: a/B{parts}\nint8 x", field(0), sections.collect::<String>())
    };
    let one = |nth| format!("B{nth} x\n");
    assert!(ros1(&chain(MOST_DEPTH - 2, one)).is_ok());
    assert!(ros1(&chain(MOST_DEPTH - 1, one)).unwrap_err().contains("more than 32 levels deep"));
    let two = |nth| format!("B{nth} x\nB{nth} y\n");
    assert!(ros1(&chain(20, two)).unwrap_err().contains("more than 65,536 fields"));
    // The parts are deep already when they are used.
    let late = format!("B15 y\n{}", chain(MOST_DEPTH - 2, one));
    assert!(ros1(&late).is_ok());
    assert!(ros1(&"int8 x".repeat(MOST_BYTES)).unwrap_err().contains("longer than"));
}
