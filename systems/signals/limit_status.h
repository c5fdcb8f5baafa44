#pragma once

#include <cstdint>

namespace flinch {

/// How a law's torques were kept within the robot's limits at a tick.
struct LimitStatus {
  // Bits of `binding` above those of BarrierKind.
  static constexpr std::uint32_t platform_speed = 1U << 16U;
  static constexpr std::uint32_t drive_speed = 1U << 17U;

  bool keeping = false;       ///< limits are kept in this mode
  bool valid = false;         ///< and could be: the model was there, and the programme was solved
  std::uint32_t binding = 0;  ///< bit i: a barrier with number i of BarrierKind; and those above
  std::int32_t steps = 0;     ///< of the quadratic programme
  double slack = 0.0;         ///< by how much the limits ask for more than the drives have; 0: they do not
  double correction = 0.0;    ///< largest change of a drive's torque [Nm or N]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("keeping", "", self.keeping);
    visit("valid", "", self.valid);
    visit("binding", "", self.binding);
    visit("steps", "", self.steps);
    visit("slack", "", self.slack);
    visit("correction", "<drive force>", self.correction);
  }
};

}  // namespace flinch
