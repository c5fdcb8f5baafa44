#pragma once

#include <string>

#include "systems/robot/legs/legs_parameters.h"

namespace flinch {

/// A robot as URDF, which knows trees only, and what closes its loops.
struct UrdfTexts {
  std::string model;
  /// YAML, as add_closures() reads it: which frames coincide, which joints are driven, and where all joints
  /// are at home, `zeros`, at which viewers may begin.
  std::string closures;
};

/// A model in which joints have the positions that the robot file gives them, so that at its zeros loops are
/// open. From "base" stand each leg and the platform, on joints of its own without mass, "platform_x" and so
/// on; turns are about z, y and x, one after the other. Each drive gives at most `max_torque` [Nm or N].
/// Throws SetupError with what URDF cannot say, or what is wrong with `robot`.
UrdfTexts urdf_texts(const LegsParameters& robot, double max_torque);

}  // namespace flinch
