#pragma once

#include <cstddef>

#include "experiments/report/page_samples.h"
#include "systems/framework/recorded_values.h"
#include "systems/signals/station_status.h"

namespace flinch {

/// Whether the drives are on and the brakes closed, as named states of a page.
class StationLanes {
 public:
  StationLanes(const Recording& recording, PageSamples& page);

  void show(std::size_t sample);

 private:
  PageSamples& page_;
  RecordedValues<StationStatus> status_;
  std::size_t drives_, brakes_;
};

}  // namespace flinch
