#include "systems/motion/travelled_path.h"

#include <algorithm>
#include <limits>

namespace flinch {

double farthest_moved(const ConfigurationSpace& space, const PlatformVector& displacement,
                      double reach) noexcept {
  return displacement.head(space.translations()).norm() + reach * displacement.tail(space.rotations()).norm();
}

void TravelledPath::add(Time now, Time since, const Configuration& pose) noexcept {
  if (poses_.count > 0 && poses_.newest().acquired < since) poses_ = {};
  if (poses_.count == 0 || now - poses_.newest().acquired >= spacing) poses_.push({now, pose});
}

PlatformVector TravelledPath::way_back(const ConfigurationSpace& space, const Configuration& pose,
                                       double distance, double reach) const noexcept {
  const auto way_to = [&](std::size_t age) { return space.difference(poses_.back(age).pose, pose); };
  std::size_t nearest = 0;
  double off = std::numeric_limits<double>::infinity();
  for (std::size_t age = 0; age < poses_.count; ++age) {
    const double way = farthest_moved(space, way_to(age), reach);
    if (way < off) nearest = age;
    off = std::min(off, way);
  }
  if (off >= 0.5 * distance) return {};
  PlatformVector back;
  double way = 0.0;
  for (std::size_t age = nearest; age < poses_.count && way < distance; ++age) {
    back = way_to(age);
    way = farthest_moved(space, back, reach);
  }
  return way >= 0.1 * distance ? back : PlatformVector();
}

}  // namespace flinch
