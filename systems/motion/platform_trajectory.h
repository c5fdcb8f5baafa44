#pragma once

#include <memory>
#include <optional>

#include "systems/framework/system.h"
#include "systems/motion/platform_path.h"
#include "systems/signals/drive_check_status.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/reaction_state.h"
#include "systems/signals/start_command.h"
#include "systems/signals/target_command.h"

namespace flinch {

struct PlatformTrajectorySettings {
  std::optional<PlatformPath> path = std::nullopt;  ///< none: stay where the robot is
  /// From then on it starts by itself, once; none: on command only.
  std::optional<Time> start = Time::zero();
  /// Of the way from where the robot is to the start of the path.
  PoseLimits approach{.translation = {.velocity = 0.2, .acceleration = 2.0, .jerk = 50.0},
                      .rotation = {.velocity = 0.5, .acceleration = 5.0, .jerk = 100.0}};
  /// Of a way in the mode `recover`.
  PoseLimits recovery{.translation = {.velocity = 0.05, .acceleration = 0.5, .jerk = 10.0},
                      .rotation = {.velocity = 0.15, .acceleration = 1.5, .jerk = 30.0}};
};

/// The nominal motion. It never jumps: whenever the nominal mode begins, at first or after a reaction or a
/// fault, the platform is brought to rest where it is and held there. From rest it starts, moving slowly to
/// the start of the path and then along it,
///   by itself at the given time or as soon as the nominal mode has begun, but only before the first
///   interruption; on a start command, as often as wanted, whenever it is at rest;
///   neither before the drives have been checked, where that is wanted: then it waits for that.
/// It goes where the operator's target says from wherever it is, in the modes `nominal` and, more slowly,
/// `recover`; a target that is not finite, that the legs do not reach, or that comes while it shall be faster
/// than such a way is ignored. What began in a recovery goes on when the nominal mode follows it.
/// While another mode is active, the clock goes on; what it says then is not meant to be followed.
/// Not valid before the nominal mode has begun, or if the pose was not known then.
class PlatformTrajectory final : public System {
 public:
  /// What it is doing, and since when.
  struct Course {
    enum class Phase : std::uint8_t { none, hold, approach, path };
    Phase phase = Phase::none;
    Time begin{};
    PoseMotion to_start;       ///< while holding, to rest or a target; while approaching, to the path
    bool automatic = true;     ///< may still start by itself
    bool waits = false;        ///< shall start once the drives have been checked
    std::uint32_t target = 0;  ///< number of the last one seen
  };

 private:
  State<Course> last_ = state<Course>("last");

 public:
  /// Throws SetupError for limits that are not positive.
  PlatformTrajectory(std::shared_ptr<const ParallelRobot> robot, PlatformTrajectorySettings settings);

  InputPort<ReactionState> reaction = input<ReactionState>("reaction");
  InputPort<PlatformMotion> platform = input<PlatformMotion>("platform");
  InputPort<StartCommand> start = input<StartCommand>("start");
  InputPort<TargetCommand> target = input<TargetCommand>("target");
  InputPort<DriveCheckStatus> drive_check = input<DriveCheckStatus>("drive_check");

 private:
  Intermediate<bool> turns_ =
      intermediate<&PlatformTrajectory::turns>("turns", clock, last_, reaction, start, target, drive_check);
  Intermediate<Course> course_ = intermediate<&PlatformTrajectory::advance>(
      When(turns_), "course", clock, last_, reaction, platform, start, target, drive_check);

 public:
  OutputPort<PlatformReference> reference =
      output<&PlatformTrajectory::evaluate>("reference", clock, course_);

 private:
  Update remember_ = keep(last_, course_);

  /// Whether another course begins at this tick.
  bool turns(Time now, const Course& last, const ReactionState& state, const StartCommand& command,
             const TargetCommand& wanted, const DriveCheckStatus& checked) const;
  void advance(Time now, const Course& last, const ReactionState& state, const PlatformMotion& motion,
               const StartCommand& command, const TargetCommand& wanted, const DriveCheckStatus& checked,
               Course& course) const;
  void evaluate(Time now, const Course& course, PlatformReference& result) const;

  PoseMotion rest_at(const PlatformMotion& motion) const;
  bool has_arrived(Time now, const Course& course) const;
  bool starts(Time now, const Course& course, const StartCommand& command,
              const DriveCheckStatus& checked) const;
  PoseMotion way_to_path(Time now, const Course& course) const;
  PoseMotion way_to(const TargetCommand& wanted, const PlatformReference& present,
                    const PoseLimits& limits) const;

  std::shared_ptr<const ParallelRobot> robot_;
  PlatformTrajectorySettings settings_;
};

}  // namespace flinch
