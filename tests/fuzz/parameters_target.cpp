// Parameter files of calibrations, and a robot and a control path that take them over.
#include "experiments/scenario/calibration_warnings.h"
#include "experiments/scenario/scenario.h"
#include "experiments/scenario/scenario_calibrations.h"
#include "systems/config/parameter_file.h"
#include "tests/fuzz/fuzz_files.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/file_bytes.h"

namespace flinch::test {
namespace {

const std::string& robot_text() {
  static const std::string text = bytes_of(FLINCH_SOURCE_DIR "/apps/robots/planar_3rrr.yaml");
  return text;
}

const Scenario& believed() {
  static const Scenario scenario = read_scenario(FLINCH_SOURCE_DIR "/apps/scenarios/square.yaml");
  return scenario;
}

void try_parameters(std::string_view bytes) {
  const ParameterFile parameters = parse_parameter_file(bytes, "fuzzed.yaml");
  parameter_file_text(parameters);
  const Scenario& scenario = believed();
  ContactControlSettings control = scenario.control;
  control.stages = known_stages();
  calibrate_control({parameters}, *scenario.robot.robot, control);
  Scenario doubted = scenario;
  doubted.calibrations = {parameters, parameters};
  warnings_about_calibrations(doubted);
  check_thresholds(parameters);
  with_parameters(robot_text(), "planar_3rrr.yaml", parameters);
}

std::vector<std::string> parameters_seeds() {
  ParameterFile file;
  file.kind = "torque-constant";
  file.date = "2026-11-22";
  file.robot = {"planar_3rrr.yaml", std::string(64, 'a')};
  file.recordings = {{"run.h5", std::string(64, 'b')}};
  file.residual_before = 0.67;
  file.residual_after = 0.03;
  file.residual_unit = "Nm";
  for (int i = 0; i < 3; ++i) {
    file.parameters.push_back({.name = "drives.torque_constant_Nm_per_A[" + std::to_string(i) + "]",
                               .value = 6.0 + 0.01 * i,
                               .deviation = 0.002,
                               .unit = "Nm/A",
                               .belongs_to = "robot"});
  }
  file.parameters.push_back({.name = "offset[0]", .value = 0.1, .unit = "A", .identifiable = false});
  file.assumed = {{.name = "drives.torque_constant_Nm_per_A[0]", .value = 6.0, .unit = "Nm/A"}};
  return {parameter_file_text(file), bytes_of(FLINCH_SOURCE_DIR "/apps/calibrations/bench_thresholds.yaml")};
}

}  // namespace

const FuzzTarget parameters_target{"parameters", try_parameters, parameters_seeds};

}  // namespace flinch::test
