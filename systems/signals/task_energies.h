#pragma once

#include <array>
#include <cstdint>

namespace flinch {

/// How far tasks are from where they shall be, counted as energy: their Lyapunov functions. [SafePR] (47)
struct TaskEnergies {
  static constexpr int most = 4;  ///< sigma_kappa, sigma_sc, then the first two tasks by priority

  bool valid = false;                 ///< tasks are served now, and the model is there
  std::uint32_t served = 0;           ///< bit i: number i is; the others mean nothing
  std::array<double, most> energy{};  ///< V_i [J]

  bool serves(int i) const { return valid && ((served >> static_cast<unsigned>(i)) & 1U) != 0; }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("valid", "", self.valid);
    visit("served", "", self.served);
    visit("sigma_kappa", "J", self.energy[0]);
    visit("sigma_sc", "J", self.energy[1]);
    visit("task_1", "J", self.energy[2]);
    visit("task_2", "J", self.energy[3]);
  }
};

}  // namespace flinch
