// flinch calibrate dynamics
#include "apps/flinch/identified/calibration_files.h"
#include "identification/dynamics_calibration.h"

namespace flinch {
namespace {

std::vector<MotionRecording> motions_of(const std::vector<OpenedRecording>& files) {
  std::vector<MotionRecording> motions;
  for (const OpenedRecording& file : files) motions.push_back({file.source, &file.recording});
  return motions;
}

}  // namespace

ExitStatus calibrate_dynamics(const CalibrateOptions& options) {
  require_places(options);
  const auto [used, unseen] = open_recordings(options);
  const Scenario& scenario = used.front().scenario;
  const DynamicsBelief belief{.robot = scenario.robot.robot.get(),
                              .drives = scenario.robot.drives,
                              .constant = calibrated_constants(scenario, options.with),
                              .control_period = scenario.control_period};
  CalibrationResult result = calibrate_dynamics(belief, motions_of(used), motions_of(unseen));
  return conclude_calibration(result, scenario, options);
}

}  // namespace flinch
