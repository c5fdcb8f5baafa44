#pragma once

#include <string>

#include "systems/robot/five_bar_parameters.h"
#include "systems/robot/hexapod_parameters.h"
#include "systems/robot/legs/legs_robot.h"
#include "systems/robot/planar_rrr_parameters.h"

namespace flinch::test {

/// The mechanisms with closed forms of their own, written as robot files of kind `legs`; `link1` and `link2`
/// are the bodies of which the inertia of planar legs was made.
std::string legs_text(const PlanarRrrParameters& robot, const LinkBody& link1, const LinkBody& link2);
std::string legs_text(const FiveBarParameters& robot, const LinkBody& link1, const LinkBody& link2);
std::string legs_text(const HexapodParameters& robot);

/// What such a text says.
LegsParameters legs_parameters_in(const std::string& text);
LegsRobot legs_robot_in(const std::string& text);

}  // namespace flinch::test
