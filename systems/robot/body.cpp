#include "systems/robot/body.h"

#include <cstddef>

namespace flinch {

std::vector<BodyPair> pairs_of_different_legs(const std::vector<Body>& bodies) {
  std::vector<BodyPair> pairs;
  for (std::size_t a = 0; a < bodies.size(); ++a) {
    for (std::size_t b = a + 1; b < bodies.size(); ++b) {
      const bool both_are_of_legs = bodies[a].leg >= 0 && bodies[b].leg >= 0;
      if (both_are_of_legs && bodies[a].leg != bodies[b].leg) {
        pairs.push_back({static_cast<int>(a), static_cast<int>(b)});
      }
    }
  }
  return pairs;
}

}  // namespace flinch
