#include "drivers/ros2_messages.h"

#include <drivers/idl/ros2.h>

namespace flinch {
namespace {

/// Numbers that a message points to.
template <class Vector>
dds_sequence_double sequence_of(const Vector& vector) {
  const auto size = static_cast<std::uint32_t>(vector.size());
  return {
      ._maximum = size, ._length = size, ._buffer = const_cast<double*>(vector.data()), ._release = false};
}

void set_names(const std::vector<char*>& names, sensor_msgs_msg_dds__JointState_& message) {
  const auto count = static_cast<std::uint32_t>(names.size());
  message.name_ = {
      ._maximum = count, ._length = count, ._buffer = const_cast<char**>(names.data()), ._release = false};
}

geometry_msgs_msg_dds__Vector3_ vector3(double x, double y, double z) { return {.x_ = x, .y_ = y, .z_ = z}; }

geometry_msgs_msg_dds__Vector3_ vector3(const Eigen::Vector3d& v) { return vector3(v.x(), v.y(), v.z()); }

}  // namespace

void to_ros2(Time stamp, const std::string& frame, std_msgs_msg_dds__Header_& header) noexcept {
  const auto seconds = std::chrono::floor<std::chrono::seconds>(stamp);
  header.stamp_.sec_ = static_cast<std::int32_t>(seconds.count());
  header.stamp_.nanosec_ = static_cast<std::uint32_t>((stamp - seconds).count());
  header.frame_id_ = const_cast<char*>(frame.c_str());
}

void to_ros2(const JointMotion& motion, const DriveTorque& torque, const std::vector<char*>& names,
             sensor_msgs_msg_dds__JointState_& message) noexcept {
  set_names(names, message);
  message.position_ = sequence_of(motion.position);
  message.velocity_ = sequence_of(motion.velocity);
  message.effort_ = {};
  if (torque.valid && torque.torque.size() == motion.position.size())
    message.effort_ = sequence_of(torque.torque);
}

void to_ros2(const std::vector<double>& positions, const std::vector<char*>& names,
             sensor_msgs_msg_dds__JointState_& message) noexcept {
  set_names(names, message);
  message.position_ = sequence_of(positions);
  message.velocity_ = message.effort_ = {};
}

void to_ros2(const ImuReading& imu, sensor_msgs_msg_dds__Imu_& message) noexcept {
  message.orientation_ = {.x_ = 0.0, .y_ = 0.0, .z_ = 0.0, .w_ = 1.0};
  message.orientation_covariance_[0] = -1.0;  // sensor_msgs/Imu: there is no estimate
  message.angular_velocity_ = vector3(imu.angular_velocity);
  message.linear_acceleration_ = vector3(imu.specific_force);
}

void to_ros2(const WrenchEstimate& wrench, const ConfigurationSpace& space,
             geometry_msgs_msg_dds__WrenchStamped_& message) noexcept {
  const PlatformVector& w = wrench.wrench_in_base;
  if (w.size() != space.dimension()) return;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  force.head(space.translations()) = w.head(space.translations());
  moment.tail(space.rotations()) = w.tail(space.rotations());
  message.wrench_ = {.force_ = vector3(force), .torque_ = vector3(moment)};
}

const char* describe(GatePhase phase) noexcept {
  switch (phase) {
    case GatePhase::open:
      return "torque gate open";
    case GatePhase::closed:
      return "torque gate closed by a fault";
    case GatePhase::recovering:
      return "torque gate open for a recovery";
    case GatePhase::waiting:
      break;
  }
  return "torque gate waiting";
}

}  // namespace flinch
