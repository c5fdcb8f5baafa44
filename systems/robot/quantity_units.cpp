#include "systems/robot/quantity_units.h"

#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

/// `count` more entries of a list of units, joined by commas.
void append(std::string& units, int count, const std::string& unit) {
  for (int i = 0; i < count; ++i) units += (units.empty() ? "" : ", ") + unit;
}

/// The unit of each platform coordinate, translations first.
std::string of_coordinates(const ConfigurationSpace& space, const std::string& translation,
                           const std::string& rotation) {
  std::string units;
  append(units, space.translations(), translation);
  append(units, space.rotations(), rotation);
  return units;
}

/// The same of a stored pose, where a quaternion has no unit.
std::string of_pose(const ConfigurationSpace& space) {
  if (space.stored() == space.dimension()) return of_coordinates(space, "m", "rad");
  std::string units;
  append(units, space.translations(), "m");
  append(units, space.stored() - space.translations(), "1");
  return units;
}

/// One unit where all drives share it, else that of each.
std::string of_drives(const Mechanism& mechanism, const std::string& turning, const std::string& sliding) {
  std::string units;
  bool same = true;
  for (int i = 0; i < mechanism.drives(); ++i) {
    append(units, 1, mechanism.drive_kind(i) == DriveKind::revolute ? turning : sliding);
    same = same && mechanism.drive_kind(i) == mechanism.drive_kind(0);
  }
  return same ? units.substr(0, units.find(',')) : units;
}

}  // namespace

std::map<std::string, std::string> quantity_units(const ParallelRobot& robot) {
  const ConfigurationSpace& space = robot.space();
  return {{"<pose>", of_pose(space)},
          {"<displacement>", of_coordinates(space, "m", "rad")},
          {"<velocity>", of_coordinates(space, "m/s", "rad/s")},
          {"<acceleration>", of_coordinates(space, "m/s^2", "rad/s^2")},
          {"<wrench>", of_coordinates(space, "N", "Nm")},
          {"<drive position>", of_drives(robot, "rad", "m")},
          {"<drive velocity>", of_drives(robot, "rad/s", "m/s")},
          {"<drive force>", of_drives(robot, "Nm", "N")},
          {"<drive inertia>", of_drives(robot, "kg m^2", "kg")},
          {"<passive position>", "rad"}};
}

}  // namespace flinch
