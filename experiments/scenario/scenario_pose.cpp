#include "experiments/scenario/scenario_pose.h"

#include <array>

#include "systems/config/config_reader.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

/// A displacement in the base frame; `from_base` holds the defaults.
PlatformVector read_displacement(ConfigReader& reader, const ConfigurationSpace& space,
                                 PlatformVector from_base) {
  constexpr std::array axes{"x", "y", "z"};
  for (int i = 0; i < space.translations(); ++i) {
    reader.number(axes[static_cast<std::size_t>(i)], unit::m, from_base[i]);
  }
  if (space.rotations() == 1) reader.number("phi", unit::rad, from_base[space.translations()]);
  if (space.rotations() == 3) {
    reader.numbers("rotation", unit::rad, {from_base.data() + space.translations(), 3});
  }
  return from_base;
}

}  // namespace

Configuration read_pose(ConfigReader pose, const Mechanism& mechanism) {
  const ConfigurationSpace& space = mechanism.space();
  PlatformVector from_base = PlatformVector::Zero(space.dimension());
  from_base.head(space.translations()) = mechanism.home_pose().head(space.translations());
  return space.plus(space.origin(), read_displacement(pose, space, from_base));
}

Configuration read_pose_in_reach(ConfigReader& section, std::string_view name, const ParallelRobot& robot) {
  const Configuration pose = read_pose(section.section(name), robot);
  Kinematics there;
  robot.kinematics(pose, PlatformVector::Zero(robot.dof()), there);
  if (!there.reachable) section.problem(name, "is out of the reach of the legs; choose a nearer pose");
  return pose;
}

PlatformVector read_step(ConfigReader step, const ConfigurationSpace& space) {
  return read_displacement(step, space, PlatformVector::Zero(space.dimension()));
}

}  // namespace flinch
