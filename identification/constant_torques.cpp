#include "identification/constant_torques.h"

#include <fmt/core.h>

#include <map>
#include <utility>

namespace flinch {

Eigen::VectorXd without_constants(const DynamicsRows& rows, Eigen::VectorXd error) {
  std::map<std::pair<int, int>, std::pair<double, double>> sums;  // of errors, and how many there are
  const auto sum_of = [&](Eigen::Index row) -> std::pair<double, double>& {
    const auto at = static_cast<std::size_t>(row);
    return sums[{rows.recording[at], rows.drive[at]}];
  };
  for (Eigen::Index row = 0; row < error.size(); ++row) {
    auto& [sum, count] = sum_of(row);
    sum += error[row];
    count += 1.0;
  }
  for (Eigen::Index row = 0; row < error.size(); ++row) {
    const auto& [sum, count] = sum_of(row);
    error[row] -= sum / count;
  }
  return error;
}

std::vector<std::string> notes_about_constants(const std::vector<std::string>& files, const DynamicsFit& fit,
                                               const std::string& unit) {
  std::vector<std::string> notes;
  const Eigen::Index drives = fit.deviation.size();
  for (std::size_t r = 0; r < files.size(); ++r) {
    const Eigen::VectorXd own = fit.offset.segment(static_cast<Eigen::Index>(r) * drives, drives);
    if ((own.cwiseAbs().array() < fit.deviation.array()).all()) continue;
    std::string list;
    for (const double torque : own) list += fmt::format("{}{:.3g}", list.empty() ? "" : ", ", torque);
    notes.push_back(
        fmt::format("{}: a constant torque of {} {} of the drives is left out: gravity that the robot file "
                    "does not have, a payload, or the zero of a current",
                    files[r], list, unit));
  }
  return notes;
}

}  // namespace flinch
