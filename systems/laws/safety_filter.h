#pragma once

#include <array>
#include <limits>
#include <memory>

#include "systems/framework/system.h"
#include "systems/robot/motion_barriers.h"
#include "systems/robot/parallel_robot.h"
#include "systems/robot/quadratic_programme.h"
#include "systems/signals/limit_status.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/torque_command.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

/// Shares of the largest acceleration of which all drives together are capable here, by which the robot
/// counts on braking before a limit. Rotation and coupling angles get small ones: a platform has so little
/// inertia that the drives could turn it at speeds at which nothing but braking is left. (Found by trial.)
struct BrakingShares {
  double condition_number = 0.5;
  double singularity = 0.4;
  double self_collision = 0.25;
  double distance = 0.4;
  double rotation = 0.06;
  double drive_range = 0.5;
  double hardest = 0.8;  ///< of all limits, where a contact has made the robot too fast for the others

  double of(BarrierKind kind) const;
};

struct SafetyFilterSettings {
  enum class Use : std::uint8_t {
    never,
    after_contact,  ///< in the modes react, hold and zero_g
    always,         ///< in the mode nominal too
  };
  Use use = Use::after_contact;

  PoseConstraints limits;  ///< where the robot is kept
  LimitMargins margins;
  double max_platform_speed = std::numeric_limits<double>::infinity();  ///< of its origin [m/s]
  double max_drive_speed = std::numeric_limits<double>::infinity();     ///< [rad/s or m/s]
  double max_torque = 100.0;                                            ///< of a drive [Nm or N]
  double max_torque_rate = 20e3;                                        ///< [Nm/s or N/s]

  BrakingShares braking;
  double approach = 100.0;  ///< gamma: how fast a limit may be approached, for each unit of room [1/s]
  /// a_2: how fast a speed towards a limit comes down to that [1/s]; used is at most 3/4 of max_torque_rate /
  /// max_torque, since torques that the drives cannot build up in time leave slack.
  double correction = 150.0;
  double speed_rate = 100.0;  ///< how fast a speed comes down to its limit [1/s]
};

/// Keeps torques within the robot's limits: those torques that change the motion least, by Gauss's measure of
/// constraint,
///
///   minimise (dv - dv_r)^T M_x (dv - dv_r)   of   dv = M_x^-1 (J_qa,x^T tau - b + F_ext),
///
/// where dv_r follows from the torques that a law requests, so that each barrier h of the limits (see
/// motion_barriers.h) stays positive, by
///
///   ddh + alpha'(h) dh + a_2 (dh + alpha(h)) >= 0,   alpha(h) = sqrt(c^2 + 2 a h) - c,   c = a / gamma,
///
/// with the acceleration a towards which the drives can brake: whatever h, no more than that is asked for.
/// Where that is more than the drives can do at this tick, they do what they can, and at least what braking
/// by the hardest share asks for. Speeds and torques have limits too. Where the limits ask for more than the
/// drives have, they are exceeded as little as possible. Where nothing binds, the requested torques are
/// handed on as they are. (Derived.)
///
/// Who stands outside of a limit when keeping begins is not driven back inside, but gets no further out.
/// Limits are kept while there is a motion. Without a model the request is handed on and the status is not
/// valid.
class SafetyFilter final : public System {
 public:
  /// What is kept from tick to tick.
  struct Memory {
    bool keeping = false;
    std::array<double, BarrierList::most> excess{};  ///< by how much each limit is opened
  };
  /// All that is found at a tick.
  struct Result {
    Memory memory;
    TorqueCommand torque;  ///< handed on
    LimitStatus status;
  };

 private:
  State<Memory> last_ = state<Memory>("last");
  State<TorqueCommand> told_ = state<TorqueCommand>("told");

 public:
  /// Throws SetupError for settings that are not positive, and for limits that the home pose exceeds.
  SafetyFilter(std::shared_ptr<const ParallelRobot> robot, const SafetyFilterSettings& settings);

  InputPort<TorqueCommand> request = input<TorqueCommand>("request");
  InputPort<PlatformMotion> motion = input<PlatformMotion>("motion");  ///< no data: limits are not kept
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");  ///< there; the velocity hardly lags
  InputPort<Dynamics> dynamics = input<Dynamics>("dynamics");
  InputPort<WrenchEstimate> disturbance = input<WrenchEstimate>("disturbance");  ///< that hardly lags either
  InputPort<TorqueCommand> commanded = input<TorqueCommand>("commanded");        ///< what the drives are told

 private:
  Intermediate<Result> result_ = intermediate<&SafetyFilter::keep_within>(
      "result", clock, last_, told_, request, motion, kinematics, dynamics, disturbance);

 public:
  OutputPort<TorqueCommand> torque = output<&SafetyFilter::torque_of>("torque", result_);
  OutputPort<LimitStatus> status = output<&SafetyFilter::status_of>("status", result_);

 private:
  Update remember_ = update<&SafetyFilter::memory_of>(last_, result_);
  Update tell_ = update<&SafetyFilter::as_told>(told_, commanded);

  void keep_within(Time now, const Memory& last, const TorqueCommand& told, const TorqueCommand& wanted,
                   const PlatformMotion& moving, const Kinematics& at, const Dynamics& model,
                   const WrenchEstimate& pushed, Result& result) const;
  TorqueCommand as_told(const TorqueCommand& command) const { return command; }
  Memory memory_of(const Result& result) const { return result.memory; }
  TorqueCommand torque_of(const Result& result) const { return result.torque; }
  LimitStatus status_of(const Result& result) const { return result.status; }

  std::shared_ptr<const ParallelRobot> robot_;
  SafetyFilterSettings settings_;
};

}  // namespace flinch
