#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "identification/encoder_motion.h"

namespace flinch {

struct Recording;

/// What the motor currents of a stretch say, and what is wrong with them.
struct MotorCurrents {
  Eigen::MatrixXd current;                ///< one row a sample; straight lines across what is not usable [A]
  std::vector<std::vector<char>> usable;  ///< of each drive, by sample: it is there and within its range
  std::vector<std::size_t> missing;       ///< samples, of each drive
  std::vector<std::size_t> clipped;       ///< likewise, at the largest current that its sensor can say
  std::vector<double> limit;              ///< the largest current that was said [A]

  /// Adds up what is wrong over several stretches.
  void count(const MotorCurrents& more);
  /// What is wrong with these currents out of `samples` samples of each drive, and what to do about it.
  std::vector<std::string> warnings(std::size_t samples) const;
};

/// Of one stretch. Throws SetupError where the recording has no motor currents.
MotorCurrents motor_currents(const Recording& recording, const ValidStretch& stretch, int drives);

}  // namespace flinch
