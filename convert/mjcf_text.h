#pragma once

#include <string>

#include "systems/robot/legs/legs_parameters.h"

namespace flinch {

/// The robot as a model for MuJoCo, which is at home where nothing has moved: legs as trees of bodies, the
/// platform on joints along its coordinates, closures as `connect` and `weld`, drives as motors. Throws
/// SetupError with what MJCF cannot say, or what is wrong with `robot`.
std::string mjcf_text(const LegsParameters& robot);

}  // namespace flinch
