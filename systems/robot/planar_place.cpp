#include "systems/robot/planar_place.h"

#include "systems/robot/planar_rrr.h"

namespace flinch {

bool evaluate_planar_place(const Mechanism& mechanism, const Configuration& pose,
                           PlaceKinematics& out) noexcept {
  const auto* const robot = dynamic_cast<const PlanarRrr*>(&mechanism);
  if (robot != nullptr) robot->place(pose, out);
  return robot != nullptr;
}

}  // namespace flinch
