//! A node of ROS 2 for blocking programs: DDS topics to which it publishes, and the last message of each topic to which it
//! subscribes.
//!
//! RustDDS connects topics by their names alone, so the type of a topic is looked up before there is an endpoint of ours, and
//! there is only one.

use std::{
    collections::BTreeSet,
    convert::Infallible,
    net::{IpAddr, Ipv4Addr},
    process,
    sync::{Mutex, PoisonError},
    thread::sleep,
    time::{Duration, Instant},
};

use futures::StreamExt;
use rustdds::{
    DomainParticipant, DomainParticipantBuilder, GUID, Publisher, QosPolicies, QosPolicyBuilder,
    RTPSEntity, RepresentationIdentifier, SampleIdentity, Subscriber, Topic, TopicKind,
    WriteOptionsBuilder,
    bytes::Bytes,
    dds::qos::policy::{DataRepresentation, DataRepresentationId},
    no_key::{
        DataReader, DataSample, DataWriter, Decode, DefaultDecoder, DeserializerAdapter,
        SerializerAdapter,
    },
    policy::{Durability, History, Reliability},
};
use tokio::runtime::{Builder, Runtime};

use super::{
    graph::{NODES, NODES_TYPE, NodeEndpoints, RosDistro},
    messages::{CLOCK, EncodedBody},
    service::{REQUEST, RESPONSE, TriggerRequest, TriggerResponse, caller},
};
use crate::{
    live::topic::{self, Subscription},
    robot::RobotError,
};

/// The number of messages that are kept.
const DEPTH: i32 = 10;
/// The time for the last messages to leave before the node is gone.
const LEAVE: Duration = Duration::from_millis(200);
/// Interval of looks at what was discovered.
const LOOK: Duration = Duration::from_millis(20);

/// Where the topics of a robot are.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RobotDomain {
    pub number: u16,
    /// The namespace of the robot's topics, as in `/robot1`; empty for none.
    pub namespace: String,
    /// Whether robots on the network are reached, and not only those on this machine.
    pub network: bool,
    /// The distribution of the robot's ROS 2, if its tools are to list this node.
    pub distro: Option<RosDistro>,
}

impl RobotDomain {
    /// The namespace without its slashes.
    fn space(&self) -> &str {
        self.namespace.trim_matches('/')
    }
}

/// The name of this program's node.
pub(super) fn node_name() -> String {
    format!("toposlam_{}", process::id())
}

pub(super) struct DdsNode {
    domain: RobotDomain,
    publisher: Publisher,
    subscriber: Subscriber,
    participant: DomainParticipant,
    /// What the tools of ROS 2 list, if they do.
    announced: Option<Announcement>,
    /// `None` once it is dropped.
    runtime: Option<Runtime>,
}

/// The endpoints of a node, and the topic that lists them.
struct Announcement {
    distro: RosDistro,
    endpoints: Mutex<NodeEndpoints>,
    writer: Writer,
}

#[expect(clippy::needless_pass_by_value, reason = "it maps errors")]
fn no_dds(cause: impl ToString) -> RobotError {
    RobotError::NoDds { cause: cause.to_string() }
}

/// What is read: any message is accepted.
fn best_effort() -> QosPolicies {
    let builder = QosPolicyBuilder::new().reliability(Reliability::BestEffort);
    builder.durability(Durability::Volatile).history(History::KeepLast { depth: DEPTH }).build()
}

/// What is written: it arrives. Late readers get that many messages if they are [`Durability::TransientLocal`].
fn reliable(durability: Durability, depth: i32) -> QosPolicies {
    let max_blocking_time = rustdds::Duration::from_millis(100);
    let builder = QosPolicyBuilder::new().reliability(Reliability::Reliable { max_blocking_time });
    builder.durability(durability).history(History::KeepLast { depth }).build()
}

/// What is written once: it arrives.
fn passing() -> QosPolicies {
    reliable(Durability::Volatile, DEPTH)
}

impl DdsNode {
    pub(super) fn new(domain: &RobotDomain) -> Result<Self, RobotError> {
        let builder = DomainParticipantBuilder::new(domain.number);
        let builder = if domain.network {
            builder
        } else {
            builder.with_only_networks([IpAddr::V4(Ipv4Addr::LOCALHOST)])
        };
        let participant = builder.build().map_err(no_dds)?;
        let publisher = participant.create_publisher(&passing()).map_err(no_dds)?;
        let subscriber = participant.create_subscriber(&best_effort()).map_err(no_dds)?;
        let runtime = Builder::new_multi_thread().worker_threads(1).build().map_err(no_dds)?;
        let mut node = Self {
            domain: domain.clone(),
            publisher,
            subscriber,
            participant,
            announced: None,
            runtime: Some(runtime),
        };
        if let Some(distro) = domain.distro {
            let qos = reliable(Durability::TransientLocal, 1);
            let writer = node.writer(NODES.to_owned(), NODES_TYPE, qos)?;
            let space = domain.space();
            let participant = node.participant.guid().to_bytes();
            let endpoints = NodeEndpoints::new(participant, space, &node_name());
            let endpoints = Mutex::new(endpoints);
            node.announced = Some(Announcement { distro, endpoints, writer });
            node.announce(|_| {})?;
        }
        Ok(node)
    }

    /// Lists the endpoints of this node again, after a change.
    fn announce(&self, change: impl FnOnce(&mut NodeEndpoints)) -> Result<(), RobotError> {
        let Some(Announcement { distro, endpoints, writer }) = &self.announced else {
            return Ok(());
        };
        let mut endpoints = endpoints.lock().unwrap_or_else(PoisonError::into_inner);
        change(&mut endpoints);
        writer.publish(endpoints.body(*distro))
    }

    /// The name in DDS of a topic of the robot. All robots have the same clock.
    fn dds_name(&self, topic: &str) -> String {
        let space = if topic == CLOCK { "" } else { self.domain.space() };
        dds_name("rt", space, topic)
    }

    fn topic(
        &self,
        dds_name: String,
        type_name: &str,
        qos: &QosPolicies,
    ) -> Result<Topic, RobotError> {
        let type_name = dds_type(type_name);
        self.participant.create_topic(dds_name, type_name, qos, TopicKind::NoKey).map_err(no_dds)
    }

    fn writer(
        &self,
        dds_name: String,
        type_name: &str,
        qos: QosPolicies,
    ) -> Result<Writer, RobotError> {
        let of = self.topic(dds_name.clone(), type_name, &qos)?;
        let writer = self.publisher.create_datawriter_no_key::<Vec<u8>, AsItIs>(&of, Some(qos));
        let writer = writer.map_err(no_dds)?;
        self.announce(|endpoints| endpoints.add_writer(writer.guid().to_bytes()))?;
        Ok(Writer { writer, topic: dds_name })
    }

    fn reader(
        &self,
        dds_name: String,
        type_name: &str,
        qos: QosPolicies,
    ) -> Result<DataReader<EncodedBody, AsItIs>, RobotError> {
        let of = self.topic(dds_name, type_name, &qos)?;
        let reader = self.subscriber.create_datareader_no_key(&of, Some(qos));
        let reader: DataReader<EncodedBody, AsItIs> = reader.map_err(no_dds)?;
        self.announce(|endpoints| endpoints.add_reader(reader.guid().to_bytes()))?;
        Ok(reader)
    }

    fn spawn(&self, task: impl Future<Output = ()> + Send + 'static) {
        if let Some(runtime) = &self.runtime {
            runtime.spawn(task);
        }
    }

    pub(super) fn advertise(&self, topic: &str, type_name: &str) -> Result<Writer, RobotError> {
        let writer = self.writer(self.dds_name(topic), type_name, passing())?;
        Ok(Writer { topic: topic.to_owned(), ..writer })
    }

    /// Calls a function with each message of a topic. Transforms that stay are sent again to those who come later.
    pub(super) fn listen(
        &self,
        topic: &str,
        type_name: &str,
        stays: bool,
        mut received: impl FnMut(Option<EncodedBody>) + Send + 'static,
    ) -> Result<(), RobotError> {
        let qos = if stays { reliable(Durability::TransientLocal, DEPTH) } else { best_effort() };
        self.listen_to_writers(topic, type_name, qos, move |_, message| received(message))
    }

    /// Calls a function with each message of a topic, and the writer of those that came whole.
    fn listen_to_writers(
        &self,
        topic: &str,
        type_name: &str,
        qos: QosPolicies,
        mut received: impl FnMut(Option<GUID>, Option<EncodedBody>) + Send + 'static,
    ) -> Result<(), RobotError> {
        let reader = self.reader(self.dds_name(topic), type_name, qos)?;
        self.spawn(async move {
            let mut messages = reader.async_sample_stream();
            while let Some(message) = messages.next().await {
                let message = message.ok();
                let writer = message.as_ref().map(|sample| sample.sample_info().writer_guid());
                received(writer, message.map(DataSample::into_value));
            }
        });
        Ok(())
    }

    /// Subscribes to a topic of one other node. Messages that cannot be read are counted and skipped.
    pub(super) fn subscribe<T: Send + 'static>(
        &self,
        topic: &str,
        type_name: &str,
        read: impl Fn(&EncodedBody) -> Option<T> + Send + 'static,
    ) -> Result<Subscription<T>, RobotError> {
        let (inbox, subscription) = topic::subscription(topic);
        let mut sources = MessageSources::default();
        self.listen_to_writers(topic, type_name, best_effort(), move |writer, message| {
            if writer.is_some_and(|writer| sources.are_two(writer)) {
                inbox.record_two_sources();
            }
            inbox.add(message.and_then(|body| read(&body)));
        })?;
        Ok(subscription)
    }

    /// Publishes to a topic whose last message late readers get, too.
    pub(super) fn advertise_last(
        &self,
        topic: &str,
        type_name: &str,
    ) -> Result<Writer, RobotError> {
        self.writer(self.dds_name(topic), type_name, reliable(Durability::TransientLocal, 1))
    }

    /// Answers the requests of a service of the type `Trigger`.
    pub(super) fn serve(
        &self,
        service: &str,
        mut answer: impl FnMut() -> TriggerResponse + Send + 'static,
    ) -> Result<(), RobotError> {
        let name = |prefix, half| dds_name(prefix, self.domain.space(), service) + half;
        let reader = self.reader(name("rq", "Request"), REQUEST, passing())?;
        let writer = self.writer(name("rr", "Reply"), RESPONSE, passing())?;
        self.spawn(async move {
            let mut requests = reader.async_sample_stream();
            while let Some(sample) = requests.next().await {
                let Ok(sample) = sample else { continue };
                let Some(request) = TriggerRequest::read(sample.value()) else { continue };
                let info = sample.sample_info();
                let to = caller(info.sample_identity(), info.related_sample_identity());
                // A client that is gone needs no reply.
                let _ = writer.reply(request.reply(&answer()), to);
            }
        });
        Ok(())
    }

    /// The type of a topic that somebody else publishes, or reads: one of these types of ROS.
    ///
    /// # Errors
    /// Returns an error if there is nobody, or if the topic has another type, or another encoding than plain CDR.
    pub(super) fn type_of(
        &self,
        topic: &str,
        side: OtherSide,
        known: &[&'static str],
        patience: Duration,
        stop: fn() -> bool,
    ) -> Result<&'static str, RobotError> {
        let name = self.dds_name(topic);
        let until = Instant::now() + patience;
        let ours = || known.join(" or ");
        loop {
            if stop() {
                return Err(RobotError::Stopped);
            }
            let endpoints = self.endpoints(&name, side);
            let other = |theirs: String| {
                Err(RobotError::OtherType { topic: topic.to_owned(), theirs, ours: ours() })
            };
            let types: BTreeSet<_> = endpoints.iter().map(|(kind, _)| ros_type(kind)).collect();
            let types: Vec<_> = types.iter().map(String::as_str).collect();
            match types[..] {
                [] if Instant::now() > until => {
                    let (does, seconds) = (side.verb(), patience.as_secs_f64());
                    let (topic, domain) = (topic.to_owned(), self.domain.number);
                    return Err(RobotError::Nobody { does, topic, domain, seconds });
                }
                [] => {}
                // Another robot, or one that ended a moment ago.
                [_] if side == OtherSide::Publishes && endpoints.len() > 1 => {
                    if Instant::now() > until {
                        let ours = "one: --namespace or --topic names those of a robot".to_owned();
                        let theirs = format!("published by {} nodes", endpoints.len());
                        return Err(RobotError::OtherType {
                            topic: topic.to_owned(),
                            theirs,
                            ours,
                        });
                    }
                }
                [only] => {
                    let Some(kind) = known.iter().find(|kind| **kind == only) else {
                        return other(only.to_owned());
                    };
                    return match endpoints.into_iter().find_map(|(_, obstacle)| obstacle) {
                        Some(obstacle) => other(format!("{kind} {obstacle}")),
                        None => Ok(kind),
                    };
                }
                _ => return other(types.join(" and ")),
            }
            sleep(LOOK);
        }
    }

    /// The types of a topic that others publish, each with why it cannot be read, if so.
    pub(super) fn published_types(&self, topic: &str) -> BTreeSet<String> {
        let endpoints = self.endpoints(&self.dds_name(topic), OtherSide::Publishes);
        let described = endpoints.into_iter().map(|(kind, obstacle)| match obstacle {
            Some(obstacle) => format!("{} {obstacle}", ros_type(&kind)),
            None => ros_type(&kind),
        });
        described.collect()
    }

    /// The type of each endpoint of a topic that others have, and why no message would pass between it and ours, if none
    /// would.
    fn endpoints(&self, name: &str, side: OtherSide) -> Vec<(String, Option<String>)> {
        match side {
            OtherSide::Publishes => {
                let all = self.participant.discovered_writers().into_iter();
                let of_topic = all.map(|writer| writer.publication_topic_data);
                let described = of_topic.filter(|found| found.topic_name == name).map(|found| {
                    let written = found.data_representation.as_ref();
                    let is_plain = DataRepresentation::offered_representation(written) == PLAIN;
                    (found.type_name, (!is_plain).then(|| "in the encoding XCDR2".to_owned()))
                });
                described.collect()
            }
            OtherSide::Reads => {
                let all = self.participant.discovered_readers().into_iter();
                let of_topic = all.map(|reader| reader.subscription_topic_data);
                let described = of_topic.filter(|found| *found.topic_name() == name).map(|found| {
                    let misfit = passing().compliance_failure_wrt(&found.qos());
                    let obstacle = misfit.map(|policy| format!("with another {policy:?}"));
                    (found.type_name().clone(), obstacle)
                });
                described.collect()
            }
        }
    }
}

/// The writers of the messages of a topic.
#[derive(Default)]
struct MessageSources {
    last: Option<GUID>,
    /// Those before it, the last of them at the end.
    earlier: Vec<GUID>,
}

/// The number of earlier writers that are kept.
const EARLIER: usize = 16;

impl MessageSources {
    /// Whether the writer of a message sends by turns with another one. A robot that starts again has a new writer, and the
    /// old one sends nothing more.
    fn are_two(&mut self, writer: GUID) -> bool {
        if self.last == Some(writer) {
            return false;
        }
        self.earlier.extend(self.last.replace(writer));
        let kept = self.earlier.len().saturating_sub(EARLIER);
        self.earlier.drain(..kept);
        self.earlier.contains(&writer)
    }
}

/// Plain CDR, in lists of encodings (DDS-XTypes 7.6.3.1.1).
const PLAIN: DataRepresentationId = 0;

/// Who has the other end of a topic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum OtherSide {
    Publishes,
    Reads,
}

impl OtherSide {
    fn verb(self) -> &'static str {
        match self {
            Self::Publishes => "publishes",
            Self::Reads => "reads",
        }
    }
}

/// The name in DDS of a topic, or of a half of a service, in a namespace.
fn dds_name(prefix: &str, space: &str, name: &str) -> String {
    let name = name.trim_start_matches('/');
    if space.is_empty() { format!("{prefix}/{name}") } else { format!("{prefix}/{space}/{name}") }
}

/// The name of a type of ROS in DDS.
fn dds_type(ros: &str) -> String {
    match ros.rsplit_once('/') {
        Some((package, name)) => format!("{}::dds_::{name}_", package.replace('/', "::")),
        None => ros.to_owned(),
    }
}

/// The name in ROS of a type in DDS.
fn ros_type(dds: &str) -> String {
    dds.replace("dds_::", "").trim_end_matches('_').replace("::", "/")
}

impl Drop for DdsNode {
    fn drop(&mut self) {
        sleep(LEAVE);
        if let Some(runtime) = self.runtime.take() {
            runtime.shutdown_timeout(LEAVE);
        }
    }
}

/// A topic to which a node publishes.
pub(super) struct Writer {
    writer: DataWriter<Vec<u8>, AsItIs>,
    topic: String,
}

impl Writer {
    /// Publishes the body of a message.
    pub(super) fn publish(&self, body: Vec<u8>) -> Result<(), RobotError> {
        let closed = |_| RobotError::Closed { topic: self.topic.clone() };
        self.writer.write(body, None).map_err(closed)
    }

    /// Publishes the body of a reply.
    fn reply(&self, body: Vec<u8>, to: SampleIdentity) -> Result<(), RobotError> {
        let options = WriteOptionsBuilder::new().related_sample_identity(to).build();
        let closed = |_| RobotError::Closed { topic: self.topic.clone() };
        self.writer.write_with_options(body, options).map(drop).map_err(closed)
    }
}

/// Messages are read and written as they are; [`messages`](super::messages) knows their encoding.
struct AsItIs;

impl DeserializerAdapter<EncodedBody> for AsItIs {
    type Error = Infallible;
    type Decoded = EncodedBody;

    fn supported_encodings() -> &'static [RepresentationIdentifier] {
        &[RepresentationIdentifier::CDR_LE, RepresentationIdentifier::CDR_BE]
    }

    fn transform_decoded(body: EncodedBody) -> EncodedBody {
        body
    }
}

impl DefaultDecoder<EncodedBody> for AsItIs {
    type Decoder = Copied;

    const DECODER: Copied = Copied;
}

#[derive(Clone)]
struct Copied;

impl Decode<'_, EncodedBody> for Copied {
    type Error = Infallible;

    fn decode_bytes(
        self,
        bytes: &[u8],
        encoding: RepresentationIdentifier,
    ) -> Result<EncodedBody, Infallible> {
        Ok(EncodedBody { encoding, bytes: bytes.to_owned() })
    }
}

impl SerializerAdapter<Vec<u8>> for AsItIs {
    type Error = Infallible;

    fn output_encoding() -> RepresentationIdentifier {
        RepresentationIdentifier::CDR_LE
    }

    fn to_bytes(body: &Vec<u8>) -> Result<Bytes, Infallible> {
        Ok(Bytes::copy_from_slice(body))
    }
}

#[cfg(test)]
mod tests {
    use std::net::TcpListener;

    use super::*;

    /// A domain that no other test uses, of this process or another one: it holds a port, which DDS does not use.
    struct OwnDomain {
        number: u16,
        _port: TcpListener,
    }

    impl OwnDomain {
        fn new() -> Self {
            let free = (101..=200).find_map(|number| {
                let port = TcpListener::bind((Ipv4Addr::LOCALHOST, 7400 + 250 * number)).ok()?;
                Some(Self { number, _port: port })
            });
            free.unwrap()
        }

        fn robot(&self, namespace: &str) -> RobotDomain {
            let namespace = namespace.to_owned();
            RobotDomain { number: self.number, namespace, ..RobotDomain::default() }
        }
    }

    #[test]
    fn tests_at_a_time_have_different_domains() {
        let (one, other) = (OwnDomain::new(), OwnDomain::new());
        assert_ne!(one.number, other.number);
    }

    const ODOMETRY: &str = "nav_msgs/msg/Odometry";

    /// Publishes odometry until a subscription to it has had this message.
    fn send(
        writer: &Writer,
        subscription: &Subscription<u8>,
        message: u8,
    ) -> Result<(), RobotError> {
        let until = Instant::now() + Duration::from_secs(20);
        loop {
            writer.publish(vec![message; 4])?;
            let is_it = |found| (found == message).then_some(());
            match subscription.wait(LOOK, || false, is_it) {
                Err(RobotError::Silent { .. }) if Instant::now() < until => {}
                found => return found,
            }
        }
    }

    /// A driver that starts again has another writer.
    #[test]
    fn two_nodes_that_send_by_turns_are_an_error_and_one_that_starts_again_is_not() {
        let own = OwnDomain::new();
        let node = || DdsNode::new(&own.robot("")).unwrap();
        let (driver, robot, again) = (node(), node(), node());
        let read = |body: &EncodedBody| body.bytes.first().copied();
        let subscription = driver.subscribe("/odom", ODOMETRY, read).unwrap();
        let [first, second] =
            [&robot, &again].map(|node| node.advertise("/odom", ODOMETRY).unwrap());
        for (writer, message) in [(&first, 1), (&second, 2)] {
            send(writer, &subscription, message).unwrap();
        }
        let two = RobotError::TwoSources { topic: "/odom".to_owned() };
        assert_eq!(send(&first, &subscription, 3), Err(two.clone()));
        assert_eq!(subscription.check_source(), Err(two));
    }

    #[test]
    fn the_types_of_a_topic_are_those_of_all_its_writers() {
        let own = OwnDomain::new();
        let node = || DdsNode::new(&own.robot("")).unwrap();
        let (watch, robot) = (node(), node());
        assert!(watch.published_types("/hazard_detection").is_empty());
        let _writers = ["std_msgs/msg/String", ODOMETRY]
            .map(|kind| robot.advertise("/hazard_detection", kind).unwrap());
        let until = Instant::now() + Duration::from_secs(20);
        while watch.published_types("/hazard_detection").len() < 2 && Instant::now() < until {
            sleep(LOOK);
        }
        let types: Vec<_> = watch.published_types("/hazard_detection").into_iter().collect();
        assert_eq!(types, [ODOMETRY, "std_msgs/msg/String"]);
    }

    /// A client as Fast DDS makes it: it says in the header of its request by which reader it reads replies, and takes those
    /// that name this reader and the number of its request.
    #[test]
    fn a_client_that_says_who_it_is_in_the_header_gets_its_reply() {
        let own = OwnDomain::new();
        let domain = own.robot("robot1");
        let (server, client) = (DdsNode::new(&domain).unwrap(), DdsNode::new(&domain).unwrap());
        let mut calls = 0;
        let answer = move || {
            calls += 1;
            TriggerResponse { success: calls == 1, message: "done" }
        };
        server.serve("/toposlam/abort", answer).unwrap();
        let requests =
            client.writer("rq/robot1/toposlam/abortRequest".to_owned(), REQUEST, passing());
        let requests = requests.unwrap();
        let replies =
            client.reader("rr/robot1/toposlam/abortReply".to_owned(), RESPONSE, passing());
        let mut replies = replies.unwrap();
        let until = Instant::now() + Duration::from_secs(20);
        let is_known = |name: &str, side| !client.endpoints(name, side).is_empty();
        while !is_known("rq/robot1/toposlam/abortRequest", OtherSide::Reads)
            || !is_known("rr/robot1/toposlam/abortReply", OtherSide::Publishes)
        {
            assert!(Instant::now() < until, "no service");
            sleep(LOOK);
        }
        let writer_guid = replies.guid();
        let me = SampleIdentity { writer_guid, ..SampleIdentity::default() };
        let options = WriteOptionsBuilder::new().related_sample_identity(me).build();
        let asked = requests.writer.write_with_options(vec![0; 4], options).unwrap();
        let reply = loop {
            assert!(Instant::now() < until, "no reply");
            match replies.take_next_sample().unwrap() {
                Some(reply) => break reply,
                None => sleep(LOOK),
            }
        };
        let related = reply.sample_info().related_sample_identity().unwrap();
        assert_eq!(related, SampleIdentity { writer_guid, ..asked });
        assert!(reply.value().bytes.starts_with(b"\x01\0\0\0\x05\0\0\0done\0"));
    }

    #[test]
    fn types_have_the_names_of_ros_2() {
        let (ros, dds) =
            ("geometry_msgs/msg/TwistStamped", "geometry_msgs::msg::dds_::TwistStamped_");
        assert_eq!((dds_type(ros).as_str(), ros_type(dds).as_str()), (dds, ros));
    }
}
