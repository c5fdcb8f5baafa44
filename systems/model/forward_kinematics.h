#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "systems/framework/system.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/joint_motion.h"
#include "systems/signals/joint_reading.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/sampling.h"

namespace flinch {

/// Where the iteration starts by preference; when that is not there, from the other.
enum class ForwardKinematicsStart : std::uint8_t {
  previous_pose,   ///< [RAL25]
  passive_angles,  ///< [ICRA23] (3)
};

struct ForwardKinematicsSettings {
  ForwardKinematicsStart start = ForwardKinematicsStart::previous_pose;
  /// Where to start with neither a previous pose nor passive angles. None: at home for a robot that has no
  /// passive encoders; for any other there is then no pose.
  std::optional<Configuration> initial_pose;
  double largest_closure_error = 0.01;  ///< between active and passive encoders [m]. [PAR]
  Sampling sampling;
};

/// The last valid pose, while it is recent enough to start from.
struct ForwardKinematicsMemory {
  bool valid = false;
  Time arrived{};  ///< tick of its last use
  Configuration pose;
};

/// Pose of the platform from the drive angles, by iteration, and its velocity dx = J_x,qa dq_a, elbows as in
/// the home working mode. The passive angles start the iteration and are the check of its result: chains that
/// do not close, because of an encoder or because an elbow has changed sides, are `implausible`. So is a pose
/// to which the platform would have had to jump, from where the iteration started to another branch. Passive
/// angles count only where they were acquired together with the active ones; without them the result stands
/// unchecked but for jumps.
///
/// Where the status is not `valid` the velocity is zero, and so is the pose for `no_data` and
/// `not_converged`.
class ForwardKinematics final : public System {
  State<ForwardKinematicsMemory> previous_ = state<ForwardKinematicsMemory>("previous");

 public:
  /// Throws SetupError for an initial pose that the legs do not reach or a closure error that is not
  /// positive.
  explicit ForwardKinematics(std::shared_ptr<const ParallelRobot> robot,
                             const ForwardKinematicsSettings& settings = {});

  InputPort<JointMotion> motion = input<JointMotion>("motion");
  InputPort<JointReading> joints = input<JointReading>("joints");  ///< for the passive angles
  OutputPort<PlatformMotion> platform =
      output<&ForwardKinematics::solve>("platform", motion, joints, previous_);

 private:
  void solve(const JointMotion& active, const JointReading& reading, const ForwardKinematicsMemory& previous,
             PlatformMotion& result) const;
  PlatformMotion::Status solve_pose(const JointMotion& active, const JointReading& reading,
                                    const ForwardKinematicsMemory& previous, Configuration& pose) const;
  ForwardKinematicsMemory keep(const PlatformMotion& result, const ForwardKinematicsMemory& previous,
                               Time now) const;
  std::optional<Configuration> start_pose(const JointMotion& active, const JointVector* passive,
                                          const ForwardKinematicsMemory& previous) const;

  std::shared_ptr<const ParallelRobot> robot_;
  ForwardKinematicsSettings settings_;
  WorkingMode mode_;
};

}  // namespace flinch
