#pragma once

#include <cstddef>
#include <vector>

#include "experiments/report/page_samples.h"
#include "systems/framework/recorded_values.h"
#include "systems/signals/constraint_state.h"

namespace flinch {

/// Which constraints the laws that serve tasks keep before all others, and where they lead them.
class ConstraintLane {
 public:
  ConstraintLane(const Recording& recording, PageSamples& page);

  void show(std::size_t sample);

  /// Takes lane and columns out of the page of a run in which no law kept any, or left limits to others.
  void drop_unless_kept(Report& report) const;

 private:
  PageSamples& page_;
  bool was_kept_ = false;
  std::vector<RecordedValues<ConstraintState>> laws_;
  std::size_t lane_ = 0, sigma_kappa_ = 0, sigma_sc_ = 0;
};

}  // namespace flinch
