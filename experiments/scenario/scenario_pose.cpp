#include "experiments/scenario/scenario_pose.h"

#include <array>

#include "systems/config/config_reader.h"
#include "systems/robot/mechanism.h"

namespace flinch {

Configuration read_pose(ConfigReader pose, const Mechanism& mechanism) {
  const ConfigurationSpace& space = mechanism.space();
  PlatformVector from_base = PlatformVector::Zero(space.dimension());
  from_base.head(space.translations()) = mechanism.home_pose().head(space.translations());
  constexpr std::array axes{"x", "y", "z"};
  for (int i = 0; i < space.translations(); ++i) {
    pose.number(axes[static_cast<std::size_t>(i)], unit::m, from_base[i]);
  }
  if (space.rotations() == 1) pose.number("phi", unit::rad, from_base[space.translations()]);
  if (space.rotations() == 3) {
    pose.numbers("rotation", unit::rad, {from_base.data() + space.translations(), 3});
  }
  return space.plus(space.origin(), from_base);
}

}  // namespace flinch
