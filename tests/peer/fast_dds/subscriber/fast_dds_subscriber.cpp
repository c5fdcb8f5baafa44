// Listens to flinch's topics for ROS 2 by Fast DDS and prints each message as a line: the topic's name, then
// its MessageText. Ends with its standard input.
//
//   fast_dds_subscriber DOMAIN reliable|best_effort
#include <fastcdr/Cdr.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>

#include <iostream>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "tests/peer/fast_dds/message_text.h"

namespace {

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastrtps::types::ReturnCode_t;
using flinch::test::MessageText;
using Cdr = eprosima::fastcdr::Cdr;

// ---------------------------------------------------------------- messages, field by field

template <class T>
T read(Cdr& cdr, MessageText& text) {
  T value{};
  cdr >> value;
  text.add(value);
  return value;
}

template <class T>
void read_many(Cdr& cdr, MessageText& text, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) read<T>(cdr, text);
}

template <class T>
void read_sequence(Cdr& cdr, MessageText& text) {
  read_many<T>(cdr, text, read<std::uint32_t>(cdr, text));
}

void read_header(Cdr& cdr, MessageText& text) {
  read<std::int32_t>(cdr, text);
  read<std::uint32_t>(cdr, text);
  read<std::string>(cdr, text);
}

void read_joint_state(Cdr& cdr, MessageText& text) {
  read_header(cdr, text);
  read_sequence<std::string>(cdr, text);
  for (int i = 0; i < 3; ++i) read_sequence<double>(cdr, text);
}

void read_imu(Cdr& cdr, MessageText& text) {
  read_header(cdr, text);
  read_many<double>(cdr, text, 4 + 9 + 3 + 9 + 3 + 9);
}

void read_wrench(Cdr& cdr, MessageText& text) {
  read_header(cdr, text);
  read_many<double>(cdr, text, 6);
}

void read_diagnostics(Cdr& cdr, MessageText& text) {
  read_header(cdr, text);
  const auto statuses = read<std::uint32_t>(cdr, text);
  for (std::uint32_t i = 0; i < statuses; ++i) {
    read<std::uint8_t>(cdr, text);
    read_many<std::string>(cdr, text, 3);
    const auto values = read<std::uint32_t>(cdr, text);
    read_many<std::string>(cdr, text, 2 * values);
  }
}

struct MessageKind {
  const char* topic;
  const char* type;
  void (*read)(Cdr& cdr, MessageText& text);
};

constexpr MessageKind kinds[] = {
    {"rt/joint_states", "sensor_msgs::msg::dds_::JointState_", &read_joint_state},
    {"rt/imu/data", "sensor_msgs::msg::dds_::Imu_", &read_imu},
    {"rt/contact/wrench", "geometry_msgs::msg::dds_::WrenchStamped_", &read_wrench},
    {"rt/diagnostics", "diagnostic_msgs::msg::dds_::DiagnosticArray_", &read_diagnostics},
};

/// Tells Fast DDS how to receive a kind of message, as a line of text.
class MessageType final : public fast::TopicDataType {
 public:
  explicit MessageType(const MessageKind& kind) : read_(kind.read) {
    setName(kind.type);
    m_typeSize = 4096;
    m_isGetKeyDefined = false;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }

  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    const bool plain_little_endian = payload->length >= 4 && payload->data[0] == 0 && payload->data[1] == 1;
    if (!plain_little_endian) return complain("is not encoded as 0001");
    eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(payload->data), payload->length);
    Cdr cdr(buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
    MessageText text;
    try {
      cdr.read_encapsulation();
      read_(cdr, text);
    } catch (const std::exception& error) {
      return complain(error.what());
    }
    if (payload->length - cdr.getSerializedDataLength() > 3) return complain("is longer than its type");
    *static_cast<std::string*>(data) = text.line();
    return true;
  }

  bool serialize(void*, rtps::SerializedPayload_t*) override { return false; }
  std::function<std::uint32_t()> getSerializedSizeProvider(void*) override {
    return [] { return 0U; };
  }
  void* createData() override { return new std::string; }
  void deleteData(void* data) override { delete static_cast<std::string*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }

 private:
  bool complain(const char* what) const {
    std::cerr << "a message of type " << getName() << ' ' << what << std::endl;
    return false;
  }

  void (*read_)(Cdr& cdr, MessageText& text);
};

/// Prints what arrives.
class Printer final : public fast::DataReaderListener {
 public:
  void on_data_available(fast::DataReader* reader) override {
    const std::lock_guard lock(mutex_);
    std::string line;
    fast::SampleInfo info;
    while (reader->take_next_sample(&line, &info) == ReturnCode_t::RETCODE_OK) {
      if (info.valid_data) std::cout << reader->get_topicdescription()->get_name() << line << std::endl;
    }
  }

 private:
  std::mutex mutex_;
};

// ---------------------------------------------------------------- the bus, on this machine only

constexpr std::uint32_t own_index = 5;  // of this participant; those of the others count from 0

/// Where a participant of the domain is found. DDSI-RTPS, 9.6.1.1.
rtps::Locator_t discovery_address(std::uint32_t domain, std::uint32_t participant) {
  rtps::Locator_t address;
  rtps::IPLocator::setIPv4(address, "127.0.0.1");
  address.port = 7400 + 250 * domain + 10 + 2 * participant;
  return address;
}

fast::DomainParticipantQos loopback(std::uint32_t domain) {
  const auto transport = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  transport->interfaceWhiteList.emplace_back("127.0.0.1");
  fast::DomainParticipantQos qos;
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(transport);
  qos.wire_protocol().participant_id = own_index;
  auto& discovery = qos.wire_protocol().builtin;
  discovery.metatrafficUnicastLocatorList.push_back(discovery_address(domain, own_index));
  for (std::uint32_t other = 0; other < 2; ++other) {
    discovery.initialPeersList.push_back(discovery_address(domain, other));
  }
  return qos;
}

fast::DataReaderQos reader_qos(bool reliable) {
  fast::DataReaderQos qos;
  qos.reliability().kind = reliable ? fast::RELIABLE_RELIABILITY_QOS : fast::BEST_EFFORT_RELIABILITY_QOS;
  qos.history().kind = fast::KEEP_ALL_HISTORY_QOS;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  return qos;
}

template <class T>
T* made(T* entity) {
  if (entity == nullptr) throw std::runtime_error("Fast DDS refuses");
  return entity;
}

void listen(std::uint32_t domain, bool reliable) {
  Printer printer;
  auto* factory = fast::DomainParticipantFactory::get_instance();
  auto* participant = made(factory->create_participant(domain, loopback(domain)));
  auto* subscriber = made(participant->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT));
  for (const MessageKind& kind : kinds) {
    participant->register_type(fast::TypeSupport(new MessageType(kind)));
    auto* topic = made(participant->create_topic(kind.topic, kind.type, fast::TOPIC_QOS_DEFAULT));
    made(subscriber->create_datareader(topic, reader_qos(reliable), &printer));
  }
  while (std::cin.get() != std::istream::traits_type::eof()) {
  }
  participant->delete_contained_entities();
  factory->delete_participant(participant);
}

}  // namespace

int main(int count, char** words) try {
  const std::vector<std::string> arguments(words + 1, words + count);
  listen(static_cast<std::uint32_t>(std::stoul(arguments.at(0))), arguments.at(1) == "reliable");
} catch (const std::exception& error) {
  std::cerr << "fast_dds_subscriber: " << error.what() << std::endl;
  return 1;
}
