#pragma once

#include "systems/robot/hexapod_parameters.h"

/// A hexapod of the size of a table. Its data describe no existing machine.
namespace flinch {

enum class HexapodPayload { none, eccentric };  ///< 5 kg, 3.6 cm off the platform's axis.

enum class HexapodFriction { none, ball_screws };  ///< 200 N s/m and 15 N a drive, 0.05 Nm s/rad an axis.

HexapodParameters hexapod_robot(HexapodPayload payload = HexapodPayload::none,
                                HexapodFriction friction = HexapodFriction::none);

}  // namespace flinch
