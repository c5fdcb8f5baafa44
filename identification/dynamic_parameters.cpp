#include "identification/dynamic_parameters.h"

#include "identification/hexapod_dynamic_parameters.h"
#include "identification/planar_dynamic_parameters.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/five_bar.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/planar_rrr.h"

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
    told.push_back({list_[i].name, list_[i].unit, values[index], index});
  }
  return told;
}

std::unique_ptr<const DynamicParameters> DynamicParameters::find(const ParallelRobot& robot) {
  if (const auto* rrr = dynamic_cast<const PlanarRrr*>(&robot))
    return planar_dynamic_parameters(rrr->parameters());
  if (const auto* bar = dynamic_cast<const FiveBar*>(&robot))
    return planar_dynamic_parameters(bar->parameters());
  if (const auto* hexapod = dynamic_cast<const Hexapod*>(&robot)) {
    return hexapod_dynamic_parameters(hexapod->parameters());
  }
  return nullptr;
}

std::unique_ptr<const DynamicParameters> DynamicParameters::of(const ParallelRobot& robot) {
  if (auto found = find(robot)) return found;
  throw SetupError("the dynamics of a robot called '" + robot.name() +
                   "' have no parameters that are known here");
}

}  // namespace flinch
