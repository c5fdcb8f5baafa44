#pragma once

#include <string>
#include <vector>

#include "systems/robot/vectors.h"

namespace flinch {

/// One wave along the way of each drive: of the drive i at q_i
///   s_i sin(2 pi q_i / lambda_i) + c_i cos(2 pi q_i / lambda_i).
struct CoggingWave {
  JointVector wavelength{};  ///< lambda [rad or m]
  JointVector sine{};        ///< s [Nm or N]
  JointVector cosine{};      ///< c [Nm or N]

  /// At these positions of all drives [Nm or N].
  JointVector at(const JointVector& position) const;
};

/// How many waves a robot file may tell of a drive.
inline constexpr int most_cogging_waves = 6;

/// What magnets and slots of the motors add to their torques, whatever the currents: the sum of waves, since
/// harmonics and the parts of a gear have wavelengths of their own.
struct Cogging {
  std::vector<CoggingWave> waves{};  ///< Empty: nothing is known of it.

  bool is_none() const { return waves.empty(); }
  /// At these positions of all drives [Nm or N]. Only where something is known.
  JointVector at(const JointVector& position) const;
};

/// How keys of a wave begin in a robot file: `cogging_`, `cogging2_` and so on.
std::string cogging_key(int wave);

/// What forbids it for so many drives; none: nothing.
std::vector<std::string> problems(const Cogging& cogging, int drives);

}  // namespace flinch
