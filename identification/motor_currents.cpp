#include "identification/motor_currents.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "identification/clipped.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recorded_values.h"
#include "systems/signals/drive_reading.h"

namespace flinch {
namespace {

constexpr double much_missing = 0.01;  // of the samples

/// Straight lines across what is not usable; at the ends the nearest usable value.
void bridge(const std::vector<char>& usable, Eigen::Ref<Eigen::VectorXd> x) {
  const Eigen::Index n = x.size();
  Eigen::Index last = -1;
  for (Eigen::Index k = 0; k <= n; ++k) {
    if (k < n && usable[static_cast<std::size_t>(k)] == 0) continue;
    for (Eigen::Index i = last + 1; i < k; ++i) {
      const double share = static_cast<double>(i - last) / static_cast<double>(k - last);
      if (last < 0) {
        x[i] = k < n ? x[k] : 0.0;
      } else {
        x[i] = k < n ? (1.0 - share) * x[last] + share * x[k] : x[last];
      }
    }
    last = k;
  }
}

}  // namespace

void MotorCurrents::count(const MotorCurrents& more) {
  missing.resize(more.missing.size(), 0);
  clipped.resize(more.clipped.size(), 0);
  limit.resize(more.limit.size(), 0.0);
  for (std::size_t i = 0; i < missing.size(); ++i) {
    missing[i] += more.missing[i];
    clipped[i] += more.clipped[i];
    limit[i] = std::max(limit[i], more.limit[i]);
  }
}

std::vector<std::string> MotorCurrents::warnings(std::size_t samples) const {
  std::vector<std::string> list;
  for (std::size_t i = 0; i < missing.size(); ++i) {
    const double share = static_cast<double>(missing[i]) / static_cast<double>(samples);
    if (share > much_missing) {
      list.push_back(fmt::format(
          "the current of drive {} is missing in {:.0f} % of the samples, which are left out; check its "
          "amplifier and the link to it",
          i + 1, 100.0 * share));
    }
    if (clipped[i] > 0) {
      list.push_back(
          fmt::format("the current of drive {} is saturated at {:.3g} A in {} samples, which are left out; "
                      "load it less, or "
                      "choose a wider range of its amplifier",
                      i + 1, limit[i], clipped[i]));
    }
  }
  return list;
}

MotorCurrents motor_currents(const Recording& recording, const ValidStretch& stretch, int drives) {
  if (recording.find("drives") == nullptr)
    throw SetupError(
        "there is no signal 'drives', the motor currents; record them, or map columns to it when importing");
  const auto readings = read<DriveReading>(recording, "drives");
  const auto n = static_cast<std::size_t>(drives);
  MotorCurrents out;
  out.current = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(stretch.count), drives);
  out.usable.assign(n, std::vector<char>(stretch.count, 0));
  out.missing.assign(n, 0);
  out.clipped.assign(n, 0);
  out.limit.assign(n, 0.0);
  for (std::size_t k = 0; k < stretch.count; ++k) {
    const DriveReading reading = readings[stretch.first + k];
    for (std::size_t i = 0; i < n; ++i) {
      const auto drive = static_cast<Eigen::Index>(i);
      if (!reading.valid || reading.current.size() != drives || !std::isfinite(reading.current[drive])) {
        ++out.missing[i];
        continue;
      }
      out.usable[i][k] = 1;
      out.current(static_cast<Eigen::Index>(k), drive) = reading.current[drive];
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    auto of_drive = out.current.col(static_cast<Eigen::Index>(i));
    out.limit[i] = stretch.count == 0 ? 0.0 : of_drive.cwiseAbs().maxCoeff();
    out.clipped[i] = mark_clipped(of_drive, out.usable[i]);
    bridge(out.usable[i], of_drive);
  }
  return out;
}

}  // namespace flinch
