#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "systems/framework/time.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {

struct Recording;

/// A stretch of a recording in which every joint reading is valid and no leg changes the side of its elbow:
/// samples first, first + 1, ...
struct ValidStretch {
  std::size_t first = 0;
  std::size_t count = 0;
  std::shared_ptr<const ParallelRobot> assembled{};  ///< with its elbows as they are; null: as at home
  std::optional<Configuration> pose{};               ///< of its first sample; none: passive encoders tell it

  const ParallelRobot& robot(const ParallelRobot& at_home) const {
    return assembled == nullptr ? at_home : *assembled;
  }
};

/// The stretches in which the encoders are valid and the control path moves the robot, each of at least
/// `least` samples.
std::vector<ValidStretch> valid_stretches(const Recording& recording, const ParallelRobot& robot,
                                          std::size_t least);

/// Throws SetupError where readings come at less than `least` [Hz], which `what` needs.
void require_rate(Time period, double least, const char* what);

/// How the platform moved, from the encoders alone and afterwards: forward kinematics of every sample,
/// smoothed without delay, and central differences of that. One row a sample.
struct EncoderMotion {
  std::vector<Configuration> pose;
  Eigen::MatrixXd velocity;      ///< v, in the base frame
  Eigen::MatrixXd acceleration;  ///< dv/dt
};

/// Of one stretch of a recording. Throws SetupError where the encoders fit no pose.
EncoderMotion encoder_motion(const Recording& recording, const ParallelRobot& at_home,
                             const ValidStretch& stretch, double cutoff_frequency);

}  // namespace flinch
