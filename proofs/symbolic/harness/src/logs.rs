//! Decoders of logs: any bytes are a value or an error.

use toposlam_logs::{
    decode::decode,
    definition::{Definition, Dialect},
    reader::Log,
};
use toposlam_proofs::input::any_byte;

use crate::{Body, ERROR, Harness, Outcome, VALUE};

pub(crate) fn all() -> [Harness; 3] {
    let decoder = |name, input, body| Harness {
        name,
        input,
        body: Body::Decoder(body),
        covers: &[VALUE, ERROR],
    };
    [
        decoder("a_message_of_ros_1_is_an_error_or_a_value", "any 16 bytes", ros1),
        decoder("a_message_in_cdr_is_an_error_or_a_value", "any 20 bytes", cdr),
        decoder("an_mcap_is_an_error_or_a_log", "any 16 bytes after the magic", mcap),
    ]
}

fn any_bytes<const LENGTH: usize>() -> [u8; LENGTH] {
    std::array::from_fn(|_| any_byte())
}

fn outcome<T, E>(result: &Result<T, E>) -> Outcome {
    if result.is_ok() { VALUE } else { ERROR }
}

/// A field of each kind that has a length of its own or an alignment.
const FIELDS: &str = "uint8 a\nstring b\nuint16[] c\nint32 d\n";

fn message(dialect: Dialect, bytes: &[u8]) -> Outcome {
    let definition = Definition::read(dialect, "a/A", FIELDS);
    outcome(&decode(&definition.expect("it is a definition"), bytes))
}

fn ros1() -> Outcome {
    message(Dialect::Ros1, &any_bytes::<16>())
}

fn cdr() -> Outcome {
    message(Dialect::Ros2, &any_bytes::<20>())
}

fn mcap() -> Outcome {
    let bytes = [&b"\x89MCAP0\r\n"[..], &any_bytes::<16>()].concat();
    outcome(&Log::of_bytes(bytes))
}
