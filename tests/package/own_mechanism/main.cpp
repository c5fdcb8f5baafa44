#include <memory>

#include "apps/flinch/flinch_main.h"
#include "systems/robot/five_bar.h"
#include "systems/robot/five_bar_presets.h"

/// All verbs of flinch, for robot files of a kind without keys of its own too.
int main(int argc, char** argv) {
  const auto robot = std::make_shared<const flinch::FiveBar>(flinch::five_bar_robot());
  const auto read = [robot](flinch::ConfigReader& /*file*/) { return robot; };
  return flinch::flinch_main(argc, argv, {{.name = "own", .read = read, .preset = robot}});
}
