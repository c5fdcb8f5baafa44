// A mechanism of your own, of which flinch knows nothing, in a program with all verbs of flinch: its robot
// file has a kind of its own, with keys that this program reads. In the root of the tree, try
//   example_08_own_mechanism run apps/examples/08_own_mechanism/collision.yaml --out out/example_08
#include <memory>
#include <span>

#include "apps/examples/08_own_mechanism/point_on_three_legs.h"
#include "apps/flinch/flinch_main.h"
#include "systems/config/planar_leg_file.h"
#include "systems/config/robot_keys.h"
#include "systems/config/robot_kind.h"

using namespace flinch;

static std::shared_ptr<const ParallelRobot> read_three_legs(ConfigReader& file) {
  PointOnThreeLegs::Parameters robot;
  std::vector<ConfigReader> legs = file.required().sections("legs", robot.legs.size());
  for (std::size_t i = 0; i < legs.size(); ++i) {
    legs[i].required().numbers("base_joint", unit::m, std::span(robot.legs[i].base_joint.data(), 2));
    read_planar_leg(legs[i], robot.legs[i]);
  }
  file.required().section("platform").required().number("mass", unit::kg, robot.platform_mass);
  ConfigReader home = file.required().section("home_pose").required();
  home.number("x", unit::m, robot.home_pose.x());
  home.number("y", unit::m, robot.home_pose.y());
  note_problems(file, problems(robot),
                [&](const std::string& field) { return planar_name_in_file(field, legs); });
  return file.good() ? std::make_shared<const PointOnThreeLegs>(robot) : nullptr;
}

int main(int argc, char** argv) {
  return flinch_main(argc, argv,
                     {{.name = "point_on_three_legs",
                       .read = read_three_legs,
                       .preset = std::make_shared<const PointOnThreeLegs>(point_on_three_legs())}});
}
