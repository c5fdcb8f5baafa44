#pragma once

#include <cstdint>

#include "systems/framework/time.h"

namespace flinch {

/// Which constraints a task controller keeps, by priority: modes 1 to 4 of [SafePR] Alg. 3.
enum class ConstraintMode : std::uint8_t {
  none,                                ///< both measures are inside
  condition_number,                    ///< sigma_kappa first
  self_collision,                      ///< sigma_sc first
  condition_number_and_self_collision  ///< sigma_kappa, then sigma_sc
};

/// One measure that must stay within a limit: sigma_kappa, or sigma_sc in metres.
struct ConstraintMeasure {
  bool active = false;     ///< held on its reference, before all other tasks
  double sigma = 0.0;      ///< as measured
  double rate = 0.0;       ///< of sigma per second
  double reference = 0.0;  ///< where it is held; while it is not active the activation value
  double limit = 0.0;      ///< the safety value
};

/// What the constraints of a task controller do.
struct ConstraintState {
  bool valid = false;    ///< the measures are known
  bool watched = false;  ///< they are kept, where they leave their range
  ConstraintMode mode = ConstraintMode::none;
  ConstraintMeasure sigma_kappa;
  ConstraintMeasure sigma_sc;
  Time since{};  ///< tick at which the mode began

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("valid", "", self.valid);
    visit("watched", "", self.watched);
    visit("mode", "", self.mode);
    visit("sigma_kappa.active", "", self.sigma_kappa.active);
    visit("sigma_kappa.sigma", "", self.sigma_kappa.sigma);
    visit("sigma_kappa.rate", "1/s", self.sigma_kappa.rate);
    visit("sigma_kappa.reference", "", self.sigma_kappa.reference);
    visit("sigma_kappa.limit", "", self.sigma_kappa.limit);
    visit("sigma_sc.active", "", self.sigma_sc.active);
    visit("sigma_sc.sigma", "m", self.sigma_sc.sigma);
    visit("sigma_sc.rate", "m/s", self.sigma_sc.rate);
    visit("sigma_sc.reference", "m", self.sigma_sc.reference);
    visit("sigma_sc.limit", "m", self.sigma_sc.limit);
    visit("since", "ns", self.since);
  }
};

}  // namespace flinch
