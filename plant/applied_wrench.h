#pragma once

#include <Eigen/Core>
#include <vector>

#include "systems/framework/system.h"

namespace flinch {

/// A wrench that acts on the platform from outside, besides contacts.
struct AppliedWrench {
  Eigen::Vector3d wrench_in_base{0.0, 0.0, 0.0};  ///< moment about the platform origin [N, N, Nm]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("wrench_in_base", "<wrench>", self.wrench_in_base, "base");
  }
};

/// A push that grows linearly from zero to a peak, stays there, and falls back to zero.
struct WrenchRamp {
  Eigen::Vector3d peak_in_base{0.0, 0.0, 0.0};  ///< [N, N, Nm]
  Time start{};
  Time rise = 1s;
  Time hold = 0s;
  Time fall = 1s;

  /// The wrench at `now`. Ramps of no duration are steps.
  Eigen::Vector3d at(Time now) const;
};

/// The sum of scripted pushes.
class AppliedWrenchScript final : public System {
 public:
  /// Throws SetupError for durations that are negative.
  explicit AppliedWrenchScript(std::vector<WrenchRamp> ramps);

  OutputPort<AppliedWrench> wrench = output<&AppliedWrenchScript::read>("wrench", clock);

 private:
  AppliedWrench read(Time now) const;

  std::vector<WrenchRamp> ramps_;
};

}  // namespace flinch
