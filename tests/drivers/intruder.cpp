#include "tests/drivers/intruder.h"

#include <dds/dds.h>
#include <drivers/idl/flinch.h>
#include <stdlib.h>
#include <unistd.h>

#include "drivers/dds_qos.h"
#include "drivers/sample_sender.h"
#include "systems/framework/monotonic_clock.h"
#include "tests/drivers/link_ends.h"

namespace flinch::test {
namespace {

dds_entity_t join(const BusSettings& settings, const std::string& access_control) {
  dds_create_domain(settings.domain, cyclone_configuration(settings).c_str());
  const DdsQos qos(dds_create_qos());
  if (settings.security) {
    for (const auto& [property, value] : participant_properties(*settings.security)) {
      const bool is_patched = property == "dds.sec.access.library.path" && !access_control.empty();
      if (is_patched) ::setenv("REAL_ACCESS_CONTROL", value.c_str(), 1);
      dds_qset_prop(qos.get(), property.c_str(), is_patched ? access_control.c_str() : value.c_str());
    }
  }
  return dds_create_participant(settings.domain, qos.get(), nullptr);
}

dds_entity_t topic_of(dds_entity_t participant, const Topic& topic) {
  return dds_create_topic(participant, topic.type, topic.name, nullptr, nullptr);
}

dds_entity_t reader_of(dds_entity_t participant, const Topic& topic) {
  return dds_create_reader(participant, topic_of(participant, topic), qos_of(topic.kind).get(), nullptr);
}

template <class Sample>
bool take(dds_entity_t reader, Sample& sample) {
  void* place = &sample;
  dds_sample_info_t info{};
  return reader > 0 && dds_take(reader, &place, &info, 1, 1) == 1 && info.valid_data;
}

flinch_TorqueSample command(std::uint32_t number, std::uint64_t robot_id) {
  flinch_TorqueSample sample{};
  stamp(sample.header, {.session = 666, .robot = link_robot, .robot_id = robot_id}, number);
  sample.header.acquired_ns = sample.header.sent_ns;
  sample.header.count = 3;
  sample.header.flags = number % 64 < 4 ? 0 : flag_valid;  // begins anew should the robot not have heard it
  sample.torque[0] = intruders_torque;
  return sample;
}

}  // namespace

void intrude(const BusSettings& settings, const std::string& access_control, Intrusion& intrusion) {
  const dds_entity_t participant = join(settings, access_control);
  intrusion.is_on_bus = participant > 0;
  const dds_entity_t joints = reader_of(participant, joints_topic);
  const dds_entity_t commands = reader_of(participant, torque_command_topic);
  const dds_entity_t writer = dds_create_writer(participant, topic_of(participant, torque_command_topic),
                                                qos_of(TopicKind::command).get(), nullptr);
  intrusion.has_writer = writer > 0;
  for (std::uint32_t number = 1;; ++number) {
    const flinch_TorqueSample sample = command(number, intrusion.robot_id);
    if (writer > 0 && dds_write(writer, &sample) == 0) ++intrusion.sent;
    dds_publication_matched_status_t matched{};
    if (writer > 0 && dds_get_publication_matched_status(writer, &matched) == 0) {
      // Its own reader of commands is one.
      if (matched.total_count > (commands > 0 ? 1u : 0u)) intrusion.is_heard = true;
    }
    flinch_JointSample joint_sample{};
    while (take(joints, joint_sample)) ++intrusion.readings_seen;
    flinch_TorqueSample seen{};
    while (take(commands, seen)) intrusion.commands_seen += seen.header.session == 666 ? 0 : 1;
    MonotonicClock::sleep_until(MonotonicClock::now() + 1ms);
  }
}

}  // namespace flinch::test
