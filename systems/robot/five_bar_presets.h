#pragma once

#include "systems/robot/five_bar_parameters.h"

/// A small five-bar. Its data describe no existing machine.
namespace flinch {

/// To which side both elbows point at home.
enum class FiveBarElbows { outward, inward };

enum class FiveBarFriction {
  none,
  bearings
};  ///< 0.01 Nm s/rad and 0.05 Nm a drive, 0.002 Nm s/rad an elbow.

/// The five-bar with the links below.
FiveBarParameters five_bar_robot(FiveBarElbows elbows = FiveBarElbows::outward,
                                 FiveBarFriction friction = FiveBarFriction::none);

/// Its first and second link, equal in both legs.
LinkBody five_bar_link1();
LinkBody five_bar_link2();

}  // namespace flinch
