#include "drivers/drive_group.h"

#include <algorithm>

namespace flinch {

Statusword DriveGroup::unite(const Statuswords& each) const {
  const std::size_t count = std::min<std::size_t>(each.count, each.bits.size());
  if (count == 0) return {statusword_of(DriveState::not_ready_to_switch_on)};
  DriveState state = state_in(each.bits[0]);
  for (std::size_t i = 1; i < count; ++i) state = together(state, state_in(each.bits[i]));
  return {statusword_of(state)};
}

}  // namespace flinch
