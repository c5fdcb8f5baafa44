#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/dds_bus.h"
#include "systems/framework/context.h"
#include "systems/framework/exchange.h"
#include "systems/robot/configuration_space.h"
#include "systems/signals/drive_torque.h"
#include "systems/signals/gate_status.h"
#include "systems/signals/imu_reading.h"
#include "systems/signals/joint_motion.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

/// What to show to ROS 2; what is not there is not published.
struct Ros2Sources {
  std::optional<OutputPort<JointMotion>> joint_motion;  ///< rt/joint_states, one joint a drive
  std::optional<OutputPort<PlatformMotion>> motion{};   ///< rt/joint_states, all joints of a model
  std::optional<OutputPort<DriveTorque>> drive_torque;  ///< the effort there
  std::optional<OutputPort<ImuReading>> imu;            ///< rt/imu/data
  std::optional<OutputPort<WrenchEstimate>> wrench;     ///< rt/contact/wrench, about the platform origin
  std::optional<OutputPort<GateStatus>> gate;           ///< rt/diagnostics, ten times a second
};

/// The joints of a model of the robot that viewers show.
struct ModelJoints {
  std::vector<std::string> names{};
  /// Sets their positions where the platform is at a pose; false where it cannot be there. It is called on
  /// the thread that sends.
  std::function<bool(const Configuration& pose, std::vector<double>& positions)> find{};
};

struct Ros2Settings {
  std::vector<std::string> joint_names;  ///< one a drive
  ModelJoints model{};                   ///< without names: there is none
  ConfigurationSpace space;              ///< of the robot: what the entries of a wrench mean
  std::string base_frame = "base";
  std::string imu_frame = "imu";
  int ticks_between_messages = 1;  ///< 1: every tick
};

/// Shows a running diagram to the tools of ROS 2, without ROS 2: the topics carry the names, types and
/// encoding that its DDS layer uses. Only valid values are published. Sending happens on another thread; a
/// message that is overtaken by the next is dropped. Message stamps are wall-clock times, as ROS 2 wants
/// them; nothing reads them back. The joints of drives and those of a model are messages of one topic, as
/// from two nodes: tools go by the names.
class Ros2Publisher final : public Exchange {
 public:
  /// Throws SetupError, also for fewer than 1 tick between messages.
  Ros2Publisher(const DdsBus& bus, const Diagram& diagram, const Ros2Sources& sources,
                const Ros2Settings& settings);
  ~Ros2Publisher() override;

  void set_inputs(Context& context) override;
  void take_outputs(const Context& context) override;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace flinch
