#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "systems/framework/recorded_values.h"
#include "systems/framework/recording.h"
#include "systems/signals/drive_reading.h"
#include "tests/support/workplace.h"

namespace flinch::test {

/// A shipped scenario, simulated, with each `from` replaced by its `to`.
struct Simulated {
  SimulatedScenario scenario;
  Recording recording;
};

inline Simulated simulated(const std::string& name,
                           const std::vector<std::pair<std::string, std::string>>& replacements = {},
                           std::optional<std::uint64_t> seed = std::nullopt) {
  const Workplace place;
  for (const auto& [from, to] : replacements) place.replace("scenarios/" + name, from, to);
  Simulated result{read_simulated_scenario(place / ("scenarios/" + name), seed), {}};
  result.recording = run_experiment(result.scenario);
  return result;
}

/// Changes the values of a signal, sample by sample.
template <class T>
void edit(Recording& recording, const std::string& path, const std::function<void(std::size_t, T&)>& change) {
  for (Signal& signal : recording.signals) {
    if (signal.path != path) continue;
    for (std::size_t k = 0; k < recording.samples(); ++k) {
      T value = read<T>(recording, path)[k];
      change(k, value);
      write_row(value, signal.rows.data() + k * signal.layout.numbers);
    }
  }
}

/// Cuts the current of a drive at a share of its largest, as a sensor at the end of its range does.
inline void saturate_current(Recording& recording, Eigen::Index drive, double share) {
  double largest = 0.0;
  const auto drives = read<DriveReading>(recording, "drives");
  for (std::size_t k = 0; k < recording.samples(); ++k)
    largest = std::max(largest, std::abs(drives[k].current[drive]));
  const double limit = share * largest;
  edit<DriveReading>(recording, "drives", [drive, limit](std::size_t, DriveReading& reading) {
    reading.current[drive] = std::clamp(reading.current[drive], -limit, limit);
  });
}

}  // namespace flinch::test
