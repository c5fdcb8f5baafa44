#pragma once

#include <string>
#include <vector>

#include "systems/robot/vectors.h"

namespace flinch {

/// What magnets and slots of the motors add to their torques, whatever the currents: of the drive i at q_i
///   s_i sin(2 pi q_i / lambda_i) + c_i cos(2 pi q_i / lambda_i).
/// Empty: nothing is known of it.
struct Cogging {
  JointVector wavelength{};  ///< lambda [rad or m]
  JointVector sine{};        ///< s [Nm or N]
  JointVector cosine{};      ///< c [Nm or N]

  bool is_none() const { return sine.size() == 0; }
  /// At these positions of all drives [Nm or N]. Only where something is known.
  JointVector at(const JointVector& position) const;
};

/// What forbids it for so many drives; none: nothing.
std::vector<std::string> problems(const Cogging& cogging, int drives);

}  // namespace flinch
