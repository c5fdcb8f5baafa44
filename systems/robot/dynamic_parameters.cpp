#include "systems/robot/dynamic_parameters.h"

#include "systems/foundation/setup_error.h"

namespace flinch {

Eigen::VectorXd DynamicParameters::believed() const {
  Eigen::VectorXd values(static_cast<Eigen::Index>(list_.size()));
  for (std::size_t i = 0; i < list_.size(); ++i) values[static_cast<Eigen::Index>(i)] = list_[i].believed;
  return values;
}

std::vector<FileValue> DynamicParameters::in_file(const Eigen::VectorXd& values) const {
  std::vector<FileValue> told;
  for (std::size_t i = 0; i < list_.size(); ++i) {
    const int index = static_cast<int>(i);
    told.push_back({list_[i].name, list_[i].unit, values[index], {index}});
  }
  return told;
}

std::unique_ptr<const DynamicParameters> DynamicParameters::of(const ParallelRobot& robot) {
  if (auto known = robot.dynamic_parameters()) return known;
  throw SetupError("the dynamics of a robot called '" + robot.name() +
                   "' have no parameters that are known here; a mechanism of one's own tells them by "
                   "ParallelRobot::dynamic_parameters()");
}

std::unique_ptr<const DynamicParameters> ParallelRobot::dynamic_parameters() const { return nullptr; }

}  // namespace flinch
