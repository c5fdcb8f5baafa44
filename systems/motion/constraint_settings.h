#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "systems/framework/time.h"
#include "systems/motion/jerk_limited_profile.h"
#include "systems/signals/task_list.h"

namespace flinch {

/// When constraints are kept. [SafePR] Tables I, II
enum class ConstraintsKept : std::uint8_t { never, after_contact, always };

/// How one measure is kept within its limit.
struct ConstraintLimit {
  double activation = 0.0;  ///< inside it nothing happens
  double safety = 0.0;      ///< where it is brought and held
  MotionLimits glide;       ///< of the motion from activation to safety [1/s, 1/s^2, 1/s^3]
  TaskGains gains;          ///< [SafePR] Table III
};

struct ConstraintSettings {
  ConstraintsKept kept = ConstraintsKept::after_contact;
  /// An upper limit. The papers' values stand in figures that are lost: these are where |det A| is 0.30,
  /// 0.25.
  ConstraintLimit sigma_kappa{.activation = 12.0,
                              .safety = 15.0,
                              .glide = {.velocity = 30.0, .acceleration = 600.0, .jerk = 6e4},
                              .gains = TaskGains::uniform(1, 20.0, 1500.0, 62.5, 1.0, 2.0)};
  /// A lower limit [m]. Safety value: links 6 cm thick, [SafePR] V-E.
  ConstraintLimit sigma_sc{.activation = 0.178,
                           .safety = 0.17,
                           .glide = {.velocity = 0.3, .acceleration = 6.0, .jerk = 600.0},
                           .gains = TaskGains::uniform(1, 30.0, 1500.0, 100.0, 16000.0, 2.0)};
  Time dwell = 50ms;  ///< a measure must have been inside for so long to be let go
};

/// All that is wrong with `settings`.
std::vector<std::string> problems(const ConstraintSettings& settings);

}  // namespace flinch
