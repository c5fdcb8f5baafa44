#include "systems/robot/quantity_units.h"

#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

/// "m, m, rad": the unit of each platform coordinate, translations first.
std::string for_each_coordinate(const ParallelRobot& robot, const std::string& translation,
                                const std::string& rotation) {
  std::string units;
  for (int i = 0; i < robot.dof(); ++i) {
    units += (i == 0 ? "" : ", ") + (i < robot.space_dimension() ? translation : rotation);
  }
  return units;
}

}  // namespace

std::map<std::string, std::string> quantity_units(const ParallelRobot& robot) {
  return {{"<pose>", for_each_coordinate(robot, "m", "rad")},
          {"<displacement>", for_each_coordinate(robot, "m", "rad")},
          {"<velocity>", for_each_coordinate(robot, "m/s", "rad/s")},
          {"<acceleration>", for_each_coordinate(robot, "m/s^2", "rad/s^2")},
          {"<wrench>", for_each_coordinate(robot, "N", "Nm")},
          {"<drive position>", "rad"},
          {"<drive velocity>", "rad/s"},
          {"<drive force>", "Nm"},
          {"<passive position>", "rad"}};
}

}  // namespace flinch
