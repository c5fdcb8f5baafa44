#include "plant/contact_forces.h"

#include <algorithm>

namespace flinch {

void NearPairs::add(const NearPair& pair) {
  if (!(pair.gap < near_distance)) return;
  if (count < max_touches) {
    pairs[static_cast<std::size_t>(count++)] = pair;
    return;
  }
  NearPair& farthest = *std::max_element(pairs.begin(), pairs.end(),
                                         [](const NearPair& a, const NearPair& b) { return a.gap < b.gap; });
  if (pair.gap < farthest.gap) farthest = pair;
}

const NearPair* NearPairs::find(int body, int obstacle) const {
  const auto end = pairs.begin() + count;
  const auto found = std::find_if(pairs.begin(), end, [&](const NearPair& pair) {
    return pair.body == body && pair.obstacle == obstacle;
  });
  return found == end ? nullptr : &*found;
}

const NearPair* NearPairs::nearest_of(int obstacle) const {
  const NearPair* nearest = nullptr;
  for (int i = 0; i < count; ++i) {
    const NearPair& pair = pairs[static_cast<std::size_t>(i)];
    if (pair.obstacle == obstacle && (nearest == nullptr || pair.gap < nearest->gap)) nearest = &pair;
  }
  return nearest;
}

}  // namespace flinch
