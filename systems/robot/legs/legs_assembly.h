#pragma once

#include "systems/robot/legs/legs_model.h"

namespace flinch {

/// All legs and the chart numbers that follow, where the free coordinates are those of a usable `pose`, which
/// `platform` is placed at. False where they do not reach. Legs of closed form are assembled as `mode` says:
/// 0 as at home, 1 with the arm bent to the other side. The others follow a straight path of the platform
/// from home, and do not reach where that meets a singularity.
bool assemble(const LegsModel& model, const Configuration& pose, const WorkingMode& mode,
              PlatformTwist& platform, LegsState& state) noexcept;

/// Which legs, from `first` to before `end`.
struct LegRange {
  std::size_t first = 0;
  std::size_t end = 0;
};

/// Brings legs and what follows from `state` to where the free chart numbers are those of `chart`, with short
/// steps, for set-up. False where they do not close; `state` is then as near as was found.
bool approach(const LegsModel& model, LegRange legs, const ChartNumbers& chart, LegsState& state) noexcept;

/// Whether leg `index` can be assembled as `mode` says.
bool is_working_mode(const LegsModel& model, std::size_t index, int mode) noexcept;

}  // namespace flinch
