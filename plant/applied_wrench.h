#pragma once

#include <vector>

#include "systems/framework/system.h"
#include "systems/robot/mechanism.h"

namespace flinch {

/// A wrench that acts on the platform from outside, besides contacts.
struct AppliedWrench {
  PlatformVector wrench_in_base;  ///< moment about the platform origin; empty: none

  /// The wrench on `robot`; zero where it has not its size.
  PlatformVector of(const Mechanism& robot) const {
    return wrench_in_base.size() == robot.dof() ? wrench_in_base : PlatformVector::Zero(robot.dof());
  }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("wrench_in_base", "<wrench>", self.wrench_in_base, "base");
  }
};

/// A push that grows linearly from zero to a peak, stays there, and falls back to zero.
struct WrenchRamp {
  PlatformVector peak_in_base{};  ///< Moment about the platform origin.
  Time start{};
  Time rise = 1s;
  Time hold = 0s;
  Time fall = 1s;

  /// The wrench at `now`. Ramps of no duration are steps.
  PlatformVector at(Time now) const;
};

/// The sum of scripted pushes.
class AppliedWrenchScript final : public System {
 public:
  /// Throws SetupError for durations that are negative and for wrenches of different sizes.
  explicit AppliedWrenchScript(std::vector<WrenchRamp> ramps);

  OutputPort<AppliedWrench> wrench = output<&AppliedWrenchScript::read>("wrench", clock);

 private:
  AppliedWrench read(Time now) const;

  std::vector<WrenchRamp> ramps_;
};

}  // namespace flinch
