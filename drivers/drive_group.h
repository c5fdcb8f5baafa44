#pragma once

#include <array>
#include <cstdint>

#include "drivers/drive_state_machine.h"
#include "systems/framework/system.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// What the drives of a robot say of their states. CiA 402, object 6041h of each.
struct Statuswords {
  std::uint8_t count = 0;                     ///< of the drives; 0: they do not answer
  std::array<std::uint16_t, max_dof> bits{};  ///< the first `count`

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("count", "", self.count);
    visit("bits", "", self.bits);
  }
};

/// Several drives as one: in the state that they are in together(), and not ready while none answers. What it
/// tells has no bits but those of the state.
class DriveGroup final : public System {
 public:
  InputPort<Statuswords> drives = input<Statuswords>("drives");
  OutputPort<Statusword> statusword = output<&DriveGroup::unite>("statusword", drives);

 private:
  Statusword unite(const Statuswords& each) const;
};

}  // namespace flinch
