//! What the tools of ROS 2 know of a node: the message of `ros_discovery_info`, from which `ros2 node list` makes its list.
//!
//! Its type is `rmw_dds_common/msg/ParticipantEntitiesInfo`. In Humble, the identity of an endpoint has 24 bytes; since Iron
//! it has 16. The two are published under the same name, and a reader of one form misreads the other.

use serde::Serialize;

use super::messages::write;

/// The distribution of a robot's ROS 2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RosDistro {
    Humble,
    /// Iron, Jazzy, Kilted, Rolling.
    IronOrLater,
}

/// The topic that lists nodes. It is none of ROS 2: its name has no prefix.
pub(super) const NODES: &str = "ros_discovery_info";
/// Its type, in both forms.
pub(super) const NODES_TYPE: &str = "rmw_dds_common/msg/ParticipantEntitiesInfo";

/// The identity of an endpoint, or of a participant, in DDS.
type Guid = [u8; 16];

/// The endpoints of a node.
#[derive(Clone, Debug)]
pub(super) struct NodeEndpoints {
    participant: Guid,
    namespace: String,
    name: String,
    readers: Vec<Guid>,
    writers: Vec<Guid>,
}

impl NodeEndpoints {
    /// Those of a node in a namespace without slashes; there are none yet.
    pub(super) fn new(participant: Guid, space: &str, name: &str) -> Self {
        let (namespace, name) = (format!("/{space}"), name.to_owned());
        Self { participant, namespace, name, readers: Vec::new(), writers: Vec::new() }
    }

    pub(super) fn add_reader(&mut self, reader: Guid) {
        self.readers.push(reader);
    }

    pub(super) fn add_writer(&mut self, writer: Guid) {
        self.writers.push(writer);
    }

    /// The message, as a distribution reads it.
    pub(super) fn body(&self, distro: RosDistro) -> Vec<u8> {
        match distro {
            RosDistro::Humble => write(&self.entities(|guid| {
                let mut padded = [0; 24];
                padded[..guid.len()].copy_from_slice(guid);
                padded
            })),
            RosDistro::IronOrLater => write(&self.entities(|guid| *guid)),
        }
    }

    fn entities<G>(&self, gid: impl Fn(&Guid) -> G) -> ParticipantEntities<'_, G> {
        ParticipantEntities {
            gid: gid(&self.participant),
            nodes: [NodeEntities {
                namespace: &self.namespace,
                name: &self.name,
                readers: self.readers.iter().map(&gid).collect(),
                writers: self.writers.iter().map(&gid).collect(),
            }]
            .into(),
        }
    }
}

#[derive(Serialize)]
struct ParticipantEntities<'n, G> {
    gid: G,
    nodes: Vec<NodeEntities<'n, G>>,
}

#[derive(Serialize)]
struct NodeEntities<'n, G> {
    namespace: &'n str,
    name: &'n str,
    readers: Vec<G>,
    writers: Vec<G>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identities_have_24_bytes_in_humble_and_16_in_later_distributions() {
        let mut node = NodeEndpoints::new([7; 16], "", "toposlam_1");
        node.add_writer([9; 16]);
        for (distro, length) in [(RosDistro::Humble, 24), (RosDistro::IronOrLater, 16)] {
            let mut expected = vec![7; 16];
            expected.resize(length, 0);
            // One node; namespace and name with their lengths and a zero at the end, to multiples of four bytes.
            expected
                .extend(b"\x01\0\0\0\x02\0\0\0/\0\0\0\x0b\0\0\0toposlam_1\0\0\0\0\0\0\x01\0\0\0");
            expected.extend([9; 16]);
            expected.resize(expected.len() + length - 16, 0);
            assert_eq!(node.body(distro), expected, "{distro:?}");
        }
    }
}
