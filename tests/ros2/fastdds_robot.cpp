// A robot by Fast DDS, another implementation of DDS than those of toposlam and of the tests in Python.
//
//     fastdds_robot SPEED    at this multiple of the real time, in the domain ROS_DOMAIN_ID
//
// It stands at the corner of a building with two hallways of 8 m, to the north and to the east, and looks west: the
// hallway behind it is the facing one. It does exactly what it is told. Messages are written and read byte by byte, as
// RTPS carries them; no code is generated.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

using Bytes = std::vector<uint8_t>;

// A type of messages that are bytes: plain CDR, the lesser byte of a number first.
class RawType : public fast::TopicDataType {
 public:
  explicit RawType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = 16384;
    m_isGetKeyDefined = false;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }

  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const Bytes& bytes = *static_cast<Bytes*>(data);
    const uint8_t header[4] = {0, 1, 0, 0};
    payload->encapsulation = CDR_LE;
    payload->length = static_cast<uint32_t>(bytes.size()) + 4;
    std::memcpy(payload->data, header, 4);
    std::memcpy(payload->data + 4, bytes.data(), bytes.size());
    return true;
  }

  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    if (payload->length < 4) return false;
    static_cast<Bytes*>(data)->assign(payload->data + 4, payload->data + payload->length);
    return true;
  }

  std::function<uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<uint32_t>(static_cast<Bytes*>(data)->size()) + 4; };
  }

  void* createData() override { return new Bytes(); }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

// Writes a message. Numbers are aligned to their size.
class Message {
 public:
  template <typename T>
  Message& add(T value) {
    while (bytes.size() % sizeof(T) != 0) bytes.push_back(0);
    const auto* begin = reinterpret_cast<const uint8_t*>(&value);
    bytes.insert(bytes.end(), begin, begin + sizeof(T));
    return *this;
  }

  Message& text(const std::string& value) {
    add(static_cast<uint32_t>(value.size() + 1));
    bytes.insert(bytes.end(), value.begin(), value.end());
    bytes.push_back(0);
    return *this;
  }

  Message& header(double time, const std::string& frame) {
    const double whole = std::floor(time);
    return add(static_cast<int32_t>(whole)).add(static_cast<uint32_t>((time - whole) * 1e9)).text(frame);
  }

  Message& pose(double x, double y, double yaw) {
    add(x).add(y).add(0.0).add(0.0).add(0.0);
    return add(std::sin(yaw / 2)).add(std::cos(yaw / 2));
  }

  Bytes bytes;
};

// Of the TwistStamped in these bytes the speed and the turn rate; false if they are too few.
bool read_twist(const Bytes& bytes, double& speed, double& turning) {
  uint32_t length = 0;
  if (bytes.size() < 12) return false;
  std::memcpy(&length, bytes.data() + 8, 4);
  const size_t begin = (12 + static_cast<size_t>(length) + 7) / 8 * 8;
  if (bytes.size() < begin + 48) return false;
  std::memcpy(&speed, bytes.data() + begin, 8);
  std::memcpy(&turning, bytes.data() + begin + 40, 8);
  return true;
}

constexpr double kHalfWidth = 1.0, kLength = 8.0, kRange = 30.0, kTick = 0.02;

bool is_floor(double x, double y) {
  const bool north = std::abs(x) < kHalfWidth && y > -kHalfWidth && y < kLength + kHalfWidth;
  return north || (std::abs(y) < kHalfWidth && x > -kHalfWidth && x < kLength + kHalfWidth);
}

float measure(double x, double y, double direction) {
  for (double far = 0.0; far < kRange; far += 0.01) {
    if (!is_floor(x + far * std::cos(direction), y + far * std::sin(direction))) return static_cast<float>(far);
  }
  return std::numeric_limits<float>::infinity();
}

std::atomic<bool> stopped{false};

class Node {
 public:
  Node() {
    fast::DomainParticipantQos qos = fast::PARTICIPANT_QOS_DEFAULT;
    auto loopback = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    loopback->interfaceWhiteList.push_back("127.0.0.1");
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(loopback);
    rtps::Locator_t peer;
    rtps::IPLocator::setIPv4(peer, 127, 0, 0, 1);
    qos.wire_protocol().builtin.initialPeersList.push_back(peer);
    const int domain = std::atoi(std::getenv("ROS_DOMAIN_ID"));
    participant_ = fast::DomainParticipantFactory::get_instance()->create_participant(domain, qos);
    if (participant_ == nullptr) {
      std::fputs("no participant\n", stderr);
      std::exit(1);
    }
    publisher_ = participant_->create_publisher(fast::PUBLISHER_QOS_DEFAULT);
    subscriber_ = participant_->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
  }

  fast::Topic* topic(const std::string& name, const std::string& type) {
    fast::TypeSupport(new RawType(type)).register_type(participant_);
    return participant_->create_topic("rt" + name, type, fast::TOPIC_QOS_DEFAULT);
  }

  fast::DataWriter* writer(const std::string& name, const std::string& type) {
    fast::DataWriterQos qos = fast::DATAWRITER_QOS_DEFAULT;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    qos.data_sharing().off();
    return publisher_->create_datawriter(topic(name, type), qos);
  }

  fast::DataReader* reader(const std::string& name, const std::string& type) {
    fast::DataReaderQos qos = fast::DATAREADER_QOS_DEFAULT;
    qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
    qos.history().depth = 10;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    qos.data_sharing().off();
    return subscriber_->create_datareader(topic(name, type), qos);
  }

  ~Node() {
    participant_->delete_contained_entities();
    fast::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }

 private:
  fast::DomainParticipant* participant_;
  fast::Publisher* publisher_;
  fast::Subscriber* subscriber_;
};

int main(int count, char** arguments) {
  const double speed_up = count > 1 ? std::atof(arguments[1]) : 1.0;
  for (int which : {SIGINT, SIGTERM}) std::signal(which, [](int) { stopped = true; });
  Node node;
  auto* odometry = node.writer("/odom", "nav_msgs::msg::dds_::Odometry_");
  auto* scans = node.writer("/scan", "sensor_msgs::msg::dds_::LaserScan_");
  auto* markers = node.writer("/marker", "geometry_msgs::msg::dds_::PoseStamped_");
  auto* wheels = node.reader("/cmd_vel", "geometry_msgs::msg::dds_::TwistStamped_");
  double time = 500.0, x = 0.0, y = 0.0, heading = M_PI, speed = 0.0, turning = 0.0;
  uint64_t commands = 0;
  auto due = std::chrono::steady_clock::now();
  const auto tick = std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(kTick / speed_up));
  for (uint64_t number = 0; !stopped; ++number) {
    Bytes command;
    fast::SampleInfo info;
    while (wheels->take_next_sample(&command, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      if (!read_twist(command, speed, turning)) {
        std::fputs("a command that is no TwistStamped\n", stderr);
        return 1;
      }
      ++commands;
    }
    time += kTick;
    heading += turning * kTick;
    x += speed * kTick * std::cos(heading);
    y += speed * kTick * std::sin(heading);
    Message reckoning;
    reckoning.header(time, "odom").text("base_link").pose(x, y, heading);
    for (int i = 0; i < 36; ++i) reckoning.add(0.0);
    reckoning.add(speed).add(0.0).add(0.0).add(0.0).add(0.0).add(turning);
    for (int i = 0; i < 36; ++i) reckoning.add(0.0);
    odometry->write(&reckoning.bytes);
    if (number % 10 == 0) {
      const double far = std::hypot(x, y), cosine = std::cos(heading), sine = std::sin(heading);
      if (far >= 0.2 && far < 1.5) {
        Message marker;
        marker.header(time, "base_link").pose(-cosine * x - sine * y, sine * x - cosine * y, -heading);
        markers->write(&marker.bytes);
      }
      const auto step = static_cast<float>(2 * M_PI / 360);
      Message sweep;
      sweep.header(time, "base_link");
      for (float value : {static_cast<float>(-M_PI), static_cast<float>(M_PI) - step, step, 0.0f, 0.2f, 0.1f, 30.0f})
        sweep.add(value);
      sweep.add(uint32_t{360});
      for (int i = 0; i < 360; ++i) sweep.add(measure(x, y, heading - M_PI + i * static_cast<double>(step)));
      sweep.add(uint32_t{0});
      scans->write(&sweep.bytes);
    }
    // Lost time is not made up for.
    due = std::max(due + tick, std::chrono::steady_clock::now());
    std::this_thread::sleep_until(due);
  }
  std::printf("%llu commands, the last %.3f %.3f\n", static_cast<unsigned long long>(commands), speed, turning);
  return 0;
}
