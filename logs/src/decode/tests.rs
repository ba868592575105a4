use super::*;
use crate::{definition::Dialect, messages::Stamp};

const TEXT: &str = "Header header\nuint8 a\nfloat64 b\nbool[4] form\nint32[] doors\nstring name\n\
    P[] parts\nuint8[] raw\n===\nMSG: std_msgs/Header\ntime stamp\nstring frame_id\n\
    ===\nMSG: a/P\nint16 x\nstring s";

fn definition(dialect: Dialect, text: &str) -> Definition {
    Definition::read(dialect, "a/A", text).unwrap()
}

fn ros1() -> Vec<u8> {
    let mut bytes = Vec::new();
    bytes.extend([7, 0, 0, 0, 9, 0, 0, 0, 1, 0, 0, 0, b'f', 250]);
    bytes.extend(1.5_f64.to_le_bytes());
    bytes.extend([1, 0, 1, 0, 2, 0, 0, 0]);
    bytes.extend([3_i32, -4].map(i32::to_le_bytes).concat());
    bytes.extend([2, 0, 0, 0, b'h', b'i', 1, 0, 0, 0, 254, 255, 1, 0, 0, 0, b's']);
    bytes.extend([3, 0, 0, 0, 1, 2, 3]);
    bytes
}

fn cdr(order: ByteOrder) -> Vec<u8> {
    let ordered = |little: &[u8]| match order {
        ByteOrder::Little => little.to_vec(),
        ByteOrder::Big => little.iter().rev().copied().collect(),
    };
    let four = |number: i32| ordered(&number.to_le_bytes());
    let mut bytes = vec![0, u8::from(order == ByteOrder::Little), 0, 0];
    bytes.extend([7, 9, 2].map(four).concat());
    // At 12: a text of two bytes, a number, and on to 16.
    bytes.extend([b'f', 0, 250, 0]);
    bytes.extend(ordered(&1.5_f64.to_le_bytes()));
    bytes.extend([1, 0, 1, 0]);
    bytes.extend([2, 3, -4, 3].map(four).concat());
    // At 44, and on to 48.
    bytes.extend([b'h', b'i', 0, 0]);
    bytes.extend([four(1), ordered(&[254, 255]), vec![0, 0], four(2)].concat());
    bytes.extend([b's', 0, 0, 0]);
    bytes.extend(four(3));
    bytes.extend([1, 2, 3]);
    bytes
}

#[test]
fn a_message_says_the_same_in_ros_1_and_in_either_order_of_cdr() {
    let little = cdr(ByteOrder::Little);
    let big = cdr(ByteOrder::Big);
    for (dialect, bytes) in
        [(Dialect::Ros1, &ros1()), (Dialect::Ros2, &little), (Dialect::Ros2, &big)]
    {
        let definition = definition(dialect, TEXT);
        let value = decode(&definition, bytes).unwrap();
        let at = |path| value.at(path).unwrap_or_else(|| panic!("{path}"));
        assert_eq!(at("header.stamp").stamp(), Some(Stamp { sec: 7, nanosec: 9 }));
        assert_eq!(at("header.stamp.nanosec").u64(), Some(9));
        assert_eq!(at("header.frame_id").text().unwrap(), "f");
        let whole = (at("a").u64(), at("a").i64(), at("a").f64());
        assert_eq!(whole, (Some(250), Some(250), Some(250.0)));
        assert_eq!(at("b").f64(), Some(1.5));
        assert_eq!((at("form[2]").bool(), at("form[3]").bool()), (Some(true), Some(false)));
        assert_eq!((at("doors[1]").i64(), at("doors[1]").u64()), (Some(-4), None));
        assert_eq!(at("doors").elements().unwrap(), [Value::Int(3), Value::Int(-4)]);
        assert_eq!(at("parts[0].x").i64(), Some(-2));
        assert_eq!(at("parts[0].s").text().unwrap(), "s");
        assert_eq!(at("raw").bytes(), Some(&[1, 2, 3][..]));
        for nowhere in
            ["c", "a.b", "doors[2]", "doors[x]", "parts[1].x", "header.stamp.x", "a[0]", "."]
        {
            assert_eq!(value.at(nowhere), None, "{nowhere}");
        }
    }
}

#[test]
fn a_message_that_is_cut_is_short_wherever_that_is() {
    for (dialect, bytes) in [(Dialect::Ros1, ros1()), (Dialect::Ros2, cdr(ByteOrder::Little))] {
        let definition = definition(dialect, TEXT);
        for length in 0..bytes.len() {
            let error = decode(&definition, &bytes[..length]).unwrap_err();
            assert!(matches!(error.cause, DecodeErrorKind::Short { .. }), "{length}: {error}");
            assert!(error.offset <= length);
        }
        let longer = [&bytes[..], &[0; 8]].concat();
        assert_eq!(decode(&definition, &longer).unwrap_err().cause, DecodeErrorKind::LeftOver(8));
    }
}

#[test]
fn an_error_has_its_byte() {
    let encapsulation = "byte 0 of the message: the encapsulation 0x0007 is not known; known are 0x0000 and 0x0001, plain CDR";
    let wide =
        "byte 4 of the message, `a`: wstring is not supported: writers encode it differently";
    for (dialect, text, bytes, message) in [
        (
            Dialect::Ros1,
            "uint8 a\nfloat64[] b",
            &[1, 0, 0, 0, 64, 9][..],
            "byte 5 of the message, `b`: 8589934592 more bytes are needed, and 1 are left",
        ),
        (
            Dialect::Ros1,
            "string s",
            &[255; 4],
            "byte 4 of the message, `s`: 4294967295 more bytes are needed, and 0 are left",
        ),
        (Dialect::Ros2, "uint8 a", &[0, 7, 0, 0, 1], encapsulation),
        (
            Dialect::Ros2,
            "uint8[<=2] a",
            &[0, 1, 0, 0, 3, 0, 0, 0, 1, 2, 3],
            "byte 4 of the message, `a`: a list of 3, which may have 2",
        ),
        (Dialect::Ros2, "wstring a", &[0, 1, 0, 0, 0], wide),
    ] {
        assert_eq!(decode(&definition(dialect, text), bytes).unwrap_err().to_string(), message);
    }
}
