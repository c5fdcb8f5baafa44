// A mechanism of your own, of which flinch knows nothing, in a whole experiment: its robot file has a kind of
// its own, with keys that this program reads; control path, simulation, verdict and report serve it as any
// other. Start it in the root of the tree.
#include <cstdio>
#include <memory>
#include <span>

#include "apps/examples/08_own_mechanism/point_on_three_legs.h"
#include "experiments/report/run_folder.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/verdict_output.h"
#include "systems/config/planar_leg_file.h"
#include "systems/config/robot_keys.h"
#include "systems/config/robot_kind.h"
#include "systems/foundation/setup_error.h"

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

int main() try {
  add_robot_kind({.name = "point_on_three_legs",
                  .read = read_three_legs,
                  .preset = std::make_shared<const PointOnThreeLegs>(point_on_three_legs())});
  const SimulatedScenario scenario = read_simulated_scenario("apps/examples/08_own_mechanism/collision.yaml");
  const RunFolder own = make_run_folder("out/example_08");
  const Verdict verdict =
      conclude_run(scenario, run_experiment(scenario), "out/example_08");  // run.h5, report.html
  std::printf("%s", verdict_table(verdict, {.wall = 0.0, .seed = scenario.seed}).c_str());
  return verdict.good() ? 0 : 1;
} catch (const SetupError& error) {  // says all that is wrong
  std::fprintf(stderr, "error: %s\n", error.what());
  return 2;
}
