//! Services of the type `std_srvs/srv/Trigger`, as the two usual libraries below ROS 2 call them (OMG DDS-RPC, and not).
//!
//! A request of Fast DDS has only its fields; who called is in the header of its message, and so is in the reply which
//! request it answers. A request of Cyclone DDS begins with sixteen bytes that say who called, and its reply with the same.
//! A request of `Trigger` has no fields, but one byte in their place, so the length shows which of the two it is, and the reply
//! has the form of the request.

use rustdds::{GUID, SampleIdentity};
use serde::Serialize;

use super::messages::{EncodedBody, read, write};

pub(super) const REQUEST: &str = "std_srvs/srv/Trigger_Request";
pub(super) const RESPONSE: &str = "std_srvs/srv/Trigger_Response";

/// Who called, as Cyclone DDS writes it: a client and the number of its request.
type CallHeader = [u64; 2];

/// A request, without fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TriggerRequest {
    /// Who called is in the header of the message.
    Plain,
    Prefixed(CallHeader),
}

impl TriggerRequest {
    /// `None` if it is no such request.
    pub(super) fn read(body: &EncodedBody) -> Option<Self> {
        if let Some((client, number, _)) = read::<(u64, u64, u8)>(body) {
            return Some(Self::Prefixed([client, number]));
        }
        read::<u8>(body).map(|_| Self::Plain)
    }

    pub(super) fn reply(self, response: &TriggerResponse) -> Vec<u8> {
        match self {
            Self::Plain => write(response),
            Self::Prefixed(header) => write(&(header, response)),
        }
    }
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(super) struct TriggerResponse {
    pub(super) success: bool,
    pub(super) message: &'static str,
}

/// To whom a reply goes: a client names the reader of its replies, or is known by its writer.
pub(super) fn caller(request: SampleIdentity, related: Option<SampleIdentity>) -> SampleIdentity {
    let reader = related.map(|related| related.writer_guid);
    let known = reader.filter(|&reader| reader != GUID::GUID_UNKNOWN);
    SampleIdentity { writer_guid: known.unwrap_or(request.writer_guid), ..request }
}

#[cfg(test)]
mod tests {
    use rustdds::{RepresentationIdentifier, SequenceNumber};

    use super::*;

    fn request(bytes: &[u8], encoding: RepresentationIdentifier) -> Option<TriggerRequest> {
        TriggerRequest::read(&EncodedBody { encoding, bytes: bytes.to_vec() })
    }

    #[test]
    fn the_reply_has_the_form_of_the_request() {
        let response = TriggerResponse { success: true, message: "ok" };
        let fields = b"\x01\0\0\0\x03\0\0\0ok\0";
        let little = RepresentationIdentifier::CDR_LE;
        let plain = request(&[0, 0, 0, 0], little).unwrap();
        assert_eq!(plain.reply(&response), fields);
        let header = [1, 2, 3, 4, 5, 6, 7, 8, 9, 0, 0, 0, 0, 0, 0, 0];
        let prefixed = request(&[&header[..], &[0; 4]].concat(), little).unwrap();
        assert_eq!(prefixed.reply(&response), [&header[..], fields].concat());
        // The number of a request is a number, whichever byte comes first.
        let reversed = [8, 7, 6, 5, 4, 3, 2, 1, 0, 0, 0, 0, 0, 0, 0, 9];
        let big = RepresentationIdentifier::CDR_BE;
        assert_eq!(request(&[&reversed[..], &[0]].concat(), big), Some(prefixed));
        for length in [0, 5, 15, 16, 21, 300] {
            assert_eq!(request(&vec![0; length], little), None, "{length}");
        }
    }

    #[test]
    fn a_reply_goes_to_the_reader_of_the_client_if_that_is_known() {
        let guid = |byte| GUID::from_bytes([byte; 16]);
        let identity = |writer_guid, number: i64| SampleIdentity {
            writer_guid,
            sequence_number: SequenceNumber::from(number),
        };
        let asked = identity(guid(1), 5);
        assert_eq!(caller(asked, None), asked);
        assert_eq!(caller(asked, Some(identity(GUID::GUID_UNKNOWN, 0))), asked);
        assert_eq!(caller(asked, Some(identity(guid(2), 0))), identity(guid(2), 5));
    }
}
