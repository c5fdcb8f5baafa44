#include "experiments/report/page_samples.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace flinch {
namespace {

/// Without direction; empty where nobody measured it.
std::vector<double> contact_force(const Recording& recording) {
  const bool simulated = recording.find("contact") != nullptr;
  if (!simulated && recording.find("force_torque") == nullptr) return {};
  const char* const path = simulated ? "contact" : "force_torque";
  const char* const field = simulated ? "strongest.force_in_base" : "force_in_base";
  std::vector<double> x = recording.column(path, field, 0);
  const std::vector<double> y = recording.column(path, field, 1);
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = std::hypot(x[k], y[k]);
  return x;
}

/// The sample that each page sample shows.
std::vector<std::size_t> shown_samples(const Recording& recording) {
  const std::size_t together = samples_in_one(recording);
  const std::vector<double> force = contact_force(recording);
  std::vector<std::size_t> shown;
  for (std::size_t first = 0; first < recording.samples(); first += together) {
    std::size_t hardest = first;
    for (std::size_t k = first; k < std::min(first + together, force.size()); ++k) {
      if (force[k] > force[hardest]) hardest = k;
    }
    shown.push_back(hardest);
  }
  return shown;
}

Signal only(const std::vector<std::size_t>& shown, const Signal& signal, const Recording& recording) {
  Signal part{signal.path, signal.layout, {}};
  const std::size_t numbers = signal.layout.numbers;
  std::vector<internal::Number> rows;
  std::size_t first = 0, count = 0;  // of the samples in `rows`
  for (const std::size_t sample : shown) {
    if (sample >= first + count) {
      first = sample / Recording::block * Recording::block;
      count = std::min(Recording::block, recording.samples() - first);
      rows.resize(count * numbers);
      recording.read_rows(signal, first, count, rows.data());
    }
    const internal::Number* const row = rows.data() + (sample - first) * numbers;
    part.rows.insert(part.rows.end(), row, row + numbers);
  }
  return part;
}

}  // namespace

std::size_t samples_in_one(const Recording& recording) {
  return std::max<std::size_t>(1, (recording.samples() + most_page_samples - 1) / most_page_samples);
}

Recording page_samples(const Recording& recording) {
  const std::vector<std::size_t> shown = shown_samples(recording);
  Recording part{static_cast<Time::rep>(samples_in_one(recording)) * recording.period, {}, {}, {}, nullptr};
  for (const std::size_t sample : shown) part.time_ns.push_back(recording.time_ns[sample]);
  for (const Signal& signal : recording.signals) part.signals.push_back(only(shown, signal, recording));
  return part;
}

}  // namespace flinch
