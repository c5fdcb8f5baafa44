#pragma once

#include <string>
#include <vector>

#include "systems/framework/time.h"
#include "systems/robot/configuration_space.h"
#include "systems/signals/drive_torque.h"
#include "systems/signals/gate_status.h"
#include "systems/signals/imu_reading.h"
#include "systems/signals/joint_motion.h"
#include "systems/signals/wrench_estimate.h"

struct sensor_msgs_msg_dds__JointState_;  // drivers/idl/ros2.idl
struct sensor_msgs_msg_dds__Imu_;
struct geometry_msgs_msg_dds__WrenchStamped_;
struct std_msgs_msg_dds__Header_;

/// Values as messages of ROS 2. The messages point into what they are made from, which must live until they
/// are sent.
namespace flinch {

/// `stamp`: since the epoch of the wall clock.
void to_ros2(Time stamp, const std::string& frame, std_msgs_msg_dds__Header_& header) noexcept;

/// `names`: of the joints, as C strings. Efforts where they are valid and as many as positions.
void to_ros2(const JointMotion& motion, const DriveTorque& torque, const std::vector<char*>& names,
             sensor_msgs_msg_dds__JointState_& message) noexcept;

/// Positions alone, of as many joints as there are names.
void to_ros2(const std::vector<double>& positions, const std::vector<char*>& names,
             sensor_msgs_msg_dds__JointState_& message) noexcept;

/// Without orientation or covariances.
void to_ros2(const ImuReading& imu, sensor_msgs_msg_dds__Imu_& message) noexcept;

/// `space`: of the robot. What a wrench does not say, such as forces across the plane, is zero in the
/// message.
void to_ros2(const WrenchEstimate& wrench, const ConfigurationSpace& space,
             geometry_msgs_msg_dds__WrenchStamped_& message) noexcept;

/// What the gate does, in words.
const char* describe(GatePhase phase) noexcept;

}  // namespace flinch
