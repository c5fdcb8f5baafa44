#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "experiments/report/page_samples.h"
#include "systems/framework/recorded_values.h"
#include "systems/signals/limit_status.h"

namespace flinch {

/// From so much slack on limits count as asking for more than the drives have: below is what the solver of
/// the programme leaves. A share of what the drives can do.
inline constexpr double least_slack = 1e-3;

/// Limits by the bits of LimitStatus::binding, as a reader says them: "self-collision and rotation".
std::string limits_in_words(std::uint32_t binding);

/// Which of the robot's limits bind, and where they ask for more than the drives have, as named states of a
/// page, whatever law requests the torques.
class LimitLane {
 public:
  static constexpr const char* name = "limits";

  LimitLane(const Recording& recording, PageSamples& page);

  void show(std::size_t sample);

  /// Takes the lane out of the page of a run in which nobody kept limits.
  void drop_unless_kept(Report& report) const;

 private:
  int state_of(const LimitStatus& status);

  PageSamples& page_;
  std::optional<RecordedValues<LimitStatus>> limits_;
  std::size_t lane_ = 0;
  std::map<std::pair<std::uint32_t, bool>, int> binding_;  ///< states by limits, and whether there is slack
  bool kept_ = false;                                      ///< at any sample
};

}  // namespace flinch
