#include "experiments/report/station_lanes.h"

namespace flinch {

StationLanes::StationLanes(const Recording& recording, PageSamples& page)
    : page_(page),
      status_(recording, "status"),
      drives_(page.lane("drives", {"off", "on", "fault"})),
      brakes_(page.lane("brakes", {"closed", "open"})) {}

void StationLanes::show(std::size_t sample) {
  const StationStatus now = status_[sample];
  const int drives = now.fault ? 2 : now.enabled ? 1 : 0;
  page_.set_state(drives_, now.valid ? drives : -1, drives);
  page_.set_state(brakes_, now.valid ? (now.braked ? 0 : 1) : -1, now.braked ? 1.0 : 0.0);
}

}  // namespace flinch
