#include "experiments/verdict/recorded_sensor_faults.h"

#include <fmt/core.h>

#include <algorithm>

#include "systems/framework/recorded_values.h"

namespace flinch {

bool records(const Recording& recording, const char* signal, const char* name) {
  const Signal* const found = recording.find(signal);
  return found != nullptr && std::any_of(found->layout.fields.begin(), found->layout.fields.end(),
                                         [name](const Field& field) { return field.name == name; });
}

ImuLeftOut imu_left_out(const Recording& recording) {
  ImuLeftOut found;
  if (!records(recording, "plausibility", "imu_doubt")) return found;
  const RecordedValues<RecordedSensorFaults> doubts(recording, "plausibility");
  std::size_t samples = 0;
  for (std::size_t k = 0; k < doubts.size(); ++k) {
    const ImuFault why = doubts[k].imu;
    if (why == ImuFault::none) continue;
    if (samples++ == 0) found.why = why;
  }
  if (samples > 0) found.share = static_cast<double>(samples) / static_cast<double>(doubts.size());
  return found;
}

std::string told_left_out(const ImuLeftOut& imu) {
  if (!(imu.share > 0.0)) return "";
  return fmt::format(
      "the IMU was left out of {:.3g} % of the recording: {}. What needs it was not estimated then; 'flinch "
      "report' shows when, and docs/faults.md what looks like that",
      100.0 * imu.share, name(imu.why));
}

}  // namespace flinch
