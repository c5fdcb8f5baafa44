#include "systems/motion/travelled_path.h"

namespace flinch {

void TravelledPath::add(Time now, Time since, const Configuration& pose) noexcept {
  if (poses_.count > 0 && poses_.newest().acquired < since) poses_ = {};
  if (poses_.count == 0 || now - poses_.newest().acquired >= spacing) poses_.push({now, pose});
}

PlatformVector TravelledPath::way_back(const ConfigurationSpace& space, const Configuration& pose,
                                       double distance, double reach) const noexcept {
  PlatformVector back;
  double way = 0.0;
  for (std::size_t age = 0; age < poses_.count && way < distance; ++age) {
    back = space.difference(poses_.back(age).pose, pose);
    way = back.head(space.translations()).norm() + reach * back.tail(space.rotations()).norm();
  }
  return way >= 0.1 * distance ? back : PlatformVector();
}

}  // namespace flinch
