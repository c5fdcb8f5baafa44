#pragma once

#include <cstdint>
#include <span>

#include "drivers/bus_role.h"

struct dds_topic_descriptor;

namespace flinch {

/// What a topic is for, which decides its quality of service.
enum class TopicKind : std::uint8_t {
  sensor,  ///< the last value counts, a lost one is not sent again; due every 5 ms at least
  /// As sensor; also: gone after 5 ms, and the writer must show within 20 ms that it lives. Not OWNERSHIP
  /// EXCLUSIVE: it would let a stronger writer silence the one who is in command; SampleAdmission decides who
  /// is.
  command,
  request,  ///< the last value counts and arrives, also at who comes later
  event,    ///< each arrives at who listens by then, up to 100 waiting for one that is slow
};

/// A topic: its name on the bus and the type of its samples.
struct Topic {
  const char* name;
  const dds_topic_descriptor* type;
  TopicKind kind;
  BusRole sender;  ///< the only one who may send on a secured bus
};

/// Every topic below.
std::span<const Topic* const> all_topics();

extern const Topic joints_topic;          ///< flinch_JointSample
extern const Topic drives_topic;          ///< flinch_DriveSample
extern const Topic imu_topic;             ///< flinch_ImuSample
extern const Topic force_torque_topic;    ///< flinch_ForceTorqueSample
extern const Topic status_topic;          ///< flinch_StatusSample
extern const Topic torque_command_topic;  ///< flinch_TorqueSample
extern const Topic drive_request_topic;   ///< flinch_DriveRequest
extern const Topic contact_event_topic;   ///< flinch_ContactEvent
extern const Topic diagnostics_topic;     ///< flinch_Diagnostics

// Topics of ROS 2, under the names by which its tools find them.
extern const Topic ros2_joint_states_topic;    ///< sensor_msgs_msg_dds__JointState_
extern const Topic ros2_imu_topic;             ///< sensor_msgs_msg_dds__Imu_
extern const Topic ros2_contact_wrench_topic;  ///< geometry_msgs_msg_dds__WrenchStamped_
extern const Topic ros2_diagnostics_topic;     ///< diagnostic_msgs_msg_dds__DiagnosticArray_

}  // namespace flinch
