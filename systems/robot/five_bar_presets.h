#pragma once

#include "systems/robot/five_bar_parameters.h"

/// A small five-bar. Its data describe no existing machine.
namespace flinch {

/// To which side both elbows point at home.
enum class FiveBarElbows { outward, inward };

/// The five-bar with the links below, without friction.
FiveBarParameters five_bar_robot(FiveBarElbows elbows = FiveBarElbows::outward);

/// Its first and second link, equal in both legs.
LinkBody five_bar_link1();
LinkBody five_bar_link2();

}  // namespace flinch
