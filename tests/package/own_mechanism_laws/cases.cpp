#include "systems/robot/five_bar.h"
#include "systems/robot/five_bar_presets.h"
#include "tests/systems/robot/mechanism_cases.h"

/// A mechanism of one's own under the laws of all mechanisms, without bodies to compare it with.
const std::vector<flinch::test::MechanismCase>& flinch::test::mechanism_cases() {
  static const std::vector<MechanismCase> cases = {
      {.name = "Own",
       .robot = std::make_shared<const FiveBar>(five_bar_robot()),
       .region = Eigen::Vector2d(0.03, 0.03),
       .velocity = Eigen::Vector2d(0.5, 0.5),
       .bodies = {},
       .least_jumps = 0,  // so near to home
       .reference = {},
       .tolerances = {}}};
  return cases;
}
