#include "drivers/topics.h"

#include <drivers/idl/flinch.h>
#include <drivers/idl/ros2.h>

#include <array>

namespace flinch {

const Topic joints_topic{"flinch/joints", &flinch_JointSample_desc, TopicKind::sensor, BusRole::robot};
const Topic drives_topic{"flinch/drives", &flinch_DriveSample_desc, TopicKind::sensor, BusRole::robot};
const Topic imu_topic{"flinch/imu", &flinch_ImuSample_desc, TopicKind::sensor, BusRole::robot};
const Topic force_torque_topic{"flinch/force_torque", &flinch_ForceTorqueSample_desc, TopicKind::sensor,
                               BusRole::robot};
const Topic status_topic{"flinch/status", &flinch_StatusSample_desc, TopicKind::sensor, BusRole::robot};
const Topic torque_command_topic{"flinch/torque_command", &flinch_TorqueSample_desc, TopicKind::command,
                                 BusRole::controller};
const Topic drive_request_topic{"flinch/drive_request", &flinch_DriveRequest_desc, TopicKind::request,
                                BusRole::controller};
const Topic contact_event_topic{"flinch/contact_event", &flinch_ContactEvent_desc, TopicKind::event,
                                BusRole::controller};
const Topic diagnostics_topic{"flinch/diagnostics", &flinch_Diagnostics_desc, TopicKind::event,
                              BusRole::controller};

const Topic ros2_joint_states_topic{"rt/joint_states", &sensor_msgs_msg_dds__JointState__desc,
                                    TopicKind::event, BusRole::controller};
const Topic ros2_imu_topic{"rt/imu/data", &sensor_msgs_msg_dds__Imu__desc, TopicKind::event,
                           BusRole::controller};
const Topic ros2_contact_wrench_topic{"rt/contact/wrench", &geometry_msgs_msg_dds__WrenchStamped__desc,
                                      TopicKind::event, BusRole::controller};
const Topic ros2_diagnostics_topic{"rt/diagnostics", &diagnostic_msgs_msg_dds__DiagnosticArray__desc,
                                   TopicKind::event, BusRole::controller};

std::span<const Topic* const> all_topics() {
  static constexpr std::array topics = {&joints_topic,
                                        &drives_topic,
                                        &imu_topic,
                                        &force_torque_topic,
                                        &status_topic,
                                        &torque_command_topic,
                                        &drive_request_topic,
                                        &contact_event_topic,
                                        &diagnostics_topic,
                                        &ros2_joint_states_topic,
                                        &ros2_imu_topic,
                                        &ros2_contact_wrench_topic,
                                        &ros2_diagnostics_topic};
  return topics;
}

// The rule of the sizes: what a controller sends is no larger than what it receives, and none above 136
// bytes.
static_assert(sizeof(flinch_Header) == 40);
static_assert(sizeof(flinch_JointSample) == 136 && sizeof(flinch_DriveSample) == 136);
static_assert(sizeof(flinch_ImuSample) == 136 && sizeof(flinch_ForceTorqueSample) == 136);
static_assert(sizeof(flinch_StatusSample) == 136 && sizeof(flinch_TorqueSample) == 136);

}  // namespace flinch
