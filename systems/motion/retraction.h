#pragma once

#include <memory>

#include "systems/framework/system.h"
#include "systems/motion/pose_motion.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/platform_reference.h"
#include "systems/signals/reaction_state.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

struct RetractionSettings {
  double distance = 0.10;       ///< d_react, along the force [m]
  double angle = 0.15;          ///< about the moment, for a contact without a force to go by [rad]
  double force_to_go_by = 3.0;  ///< a weaker force has no reliable direction [N]
  PoseLimits limits{.translation = {.velocity = 1.0, .acceleration = 20.0, .jerk = 2000.0},
                    .rotation = {.velocity = 4.0, .acceleration = 80.0, .jerk = 8000.0}};
};

/// Pose displacement with which the platform gives way to `wrench` (on the robot, base frame): by `distance`
/// along the force, [SafePR] (23). Where the force is too weak to go by, by `angle` about the moment; where
/// there is no moment either, none.
PlatformVector retraction_displacement(const PlatformVector& wrench, int translations,
                                       const RetractionSettings& settings) noexcept;

/// Gives way to a contact: at the tick at which the reaction begins it freezes the direction of the estimated
/// force and plans a jerk-limited motion from the measured pose and velocity to x_t,d = x_t + d_react n, with
/// the orientation as measured. A platform that moves otherwise is braked and brought there. The plan stays
/// until the next reaction begins; its end is held. [SafePR] IV-A
///
/// Without a valid estimate it brakes and holds the place. Without a valid pose the reference is not valid.
/// Neither singularities nor self-collision are looked at.
class Retraction final : public System {
 public:
  /// A planned motion and when it began.
  struct Plan {
    PoseMotion motion;
    Time begin{};
  };

  /// Throws SetupError for settings that are not positive.
  Retraction(std::shared_ptr<const ParallelRobot> robot, const RetractionSettings& settings);

  InputPort<ReactionState> reaction = input<ReactionState>("reaction");
  InputPort<PlatformMotion> platform = input<PlatformMotion>("platform");
  InputPort<WrenchEstimate> estimate = input<WrenchEstimate>("estimate");

 private:
  Intermediate<bool> begins_ = intermediate<&Retraction::begins>("begins", clock, reaction);
  Intermediate<Plan> plan_ =
      intermediate<&Retraction::plan>(When(begins_), "plan", clock, begins_, platform, estimate);

 public:
  OutputPort<PlatformReference> reference = output<&Retraction::evaluate>("reference", clock, plan_);

 private:
  bool begins(Time now, const ReactionState& state) const { return state.entered(ReactionMode::react, now); }
  /// No motion before the first reaction.
  void plan(Time now, bool begins, const PlatformMotion& motion, const WrenchEstimate& contact,
            Plan& plan) const;
  PlatformReference evaluate(Time now, const Plan& active) const;
  PlatformVector displacement(const WrenchEstimate& contact) const;

  std::shared_ptr<const ParallelRobot> robot_;
  RetractionSettings settings_;
};

}  // namespace flinch
