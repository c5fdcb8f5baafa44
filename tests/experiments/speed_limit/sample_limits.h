#pragma once

#include <vector>

#include "experiments/speed_limit/speed_limit_study.h"
#include "tests/support/workplace.h"

namespace flinch::test {

/// The map of two places, two directions and two bodies, with a limit of every sort.
struct SampleLimits {
  SampleLimits() {
    study = read_speed_limit_study({.scenario = shipped("scenarios/platform_collision.yaml"),
                                    .bodies = {"platform", "link1"},
                                    .places = {{-0.1, 0.0}, {0.1, 0.025}},
                                    .directions_deg = {0.0, 90.0}});
    using Bound = FoundSpeed::Bound;
    const std::vector<std::optional<FoundSpeed>> found = {
        FoundSpeed{0.812, Bound::force, 0, 0},         FoundSpeed{0.434, Bound::force, 0, 0},
        FoundSpeed{0.3, Bound::motion, 0, 0},          FoundSpeed{2.0, Bound::fastest, 0, 0},
        FoundSpeed{1.234, Bound::force, 0, 0},         std::nullopt,
        FoundSpeed{std::nullopt, Bound::motion, 0, 1}, FoundSpeed{0.6, Bound::force, 0, 0}};
    for (std::size_t i = 0; i < found.size(); ++i) {
      SpeedLimit limit{.cell = study.cells[i], .found = found[i]};
      if (!limit.found) limit.reason = "the legs do not reach the pose";
      if (limit.found && limit.found->speed) limit.confidence = 0.9528;
      limits.push_back(limit);
    }
  }

  SpeedLimitStudy study;
  std::vector<SpeedLimit> limits;
};

}  // namespace flinch::test
