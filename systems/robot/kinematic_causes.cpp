#include "systems/robot/kinematic_causes.h"

#include <algorithm>
#include <functional>

#include "systems/robot/kinematic_check.h"

namespace flinch {
namespace {

constexpr std::size_t most_rows = 200;  // that are looked at
constexpr double degree = 3.14159265358979323846 / 180.0;
constexpr double good = 0.99;
constexpr double fair = 0.9;  // below it something is wrong

using Change = std::function<void(JointVector& active)>;

std::vector<JointVector> thinned(const std::vector<JointVector>& active) {
  const std::size_t step = std::max<std::size_t>(1, active.size() / most_rows);
  std::vector<JointVector> rows;
  for (std::size_t k = 0; k < active.size(); k += step) rows.push_back(active[k]);
  return rows;
}

double share_after(const ParallelRobot& robot, std::vector<JointVector> rows, const Change& change) {
  for (JointVector& row : rows) change(row);
  return check_kinematics(robot, rows).valid_fraction;
}

}  // namespace

std::vector<std::string> likely_kinematic_causes(const ParallelRobot& robot,
                                                 const std::vector<JointVector>& active) {
  const std::vector<JointVector> rows = thinned(active);
  if (rows.empty() || check_kinematics(robot, rows).valid_fraction >= fair) return {};
  std::vector<std::string> causes;
  const auto try_it = [&](const std::string& cause, const Change& change) {
    if (share_after(robot, rows, change) >= good) causes.push_back(cause);
  };
  const bool turns = robot.drive_kind(0) == DriveKind::revolute;
  if (turns) {
    try_it("the angles are in deg and were taken for rad", [](JointVector& q) { q *= degree; });
    try_it("the angles are in rad and were taken for deg", [](JointVector& q) { q /= degree; });
  } else {
    try_it("the positions are in mm and were taken for m", [](JointVector& q) { q *= 1e-3; });
    try_it("the positions are in m and were taken for mm", [](JointVector& q) { q *= 1e3; });
  }
  for (int i = 0; i < robot.drives(); ++i) {
    try_it("drive " + std::to_string(i + 1) + " counts the other way", [i](JointVector& q) { q[i] = -q[i]; });
    for (int j = i + 1; j < robot.drives(); ++j) {
      try_it("drives " + std::to_string(i + 1) + " and " + std::to_string(j + 1) + " are swapped",
             [i, j](JointVector& q) { std::swap(q[i], q[j]); });
    }
  }
  return causes;
}

std::string told_kinematic_causes(const ParallelRobot& robot, const std::vector<JointVector>& active,
                                  const std::string& otherwise) {
  std::string text;
  for (const std::string& cause : likely_kinematic_causes(robot, active))
    text += (text.empty() ? "" : ", or ") + cause;
  return text.empty() ? otherwise : text;
}

}  // namespace flinch
