// flinch calibrate torque-constant
#include <fmt/core.h>

#include "apps/flinch/identified/calibration_files.h"
#include "identification/torque_constant_calibration.h"

namespace flinch {
namespace {

std::vector<PullRecording> pulls_of(const std::vector<OpenedRecording>& files) {
  std::vector<PullRecording> pulls;
  for (const OpenedRecording& file : files) {
    pulls.push_back({file.source, &file.recording, file.scenario.mountings});
  }
  return pulls;
}

}  // namespace

ExitStatus calibrate_torque_constant(const CalibrateOptions& options) {
  require_places(options);
  const auto [used, unseen] = open_recordings(options);
  const Scenario& scenario = used.front().scenario;
  const TorqueConstantBelief belief{.robot = scenario.robot.robot.get(),
                                    .drives = scenario.robot.drives,
                                    .constant = scenario.control.drive_torque.torque_constant};
  CalibrationResult result = calibrate_torque_constants(belief, pulls_of(used), pulls_of(unseen));
  return conclude_calibration(result, scenario, options);
}

}  // namespace flinch
