// flinch calibrate imu-pose
#include "apps/flinch/identified/calibration_files.h"
#include "identification/imu_pose_calibration.h"

namespace flinch {

ExitStatus calibrate_imu_pose(const CalibrateOptions& options) {
  require_places(options);
  const std::vector<OpenedRecording> used = open_recordings(options.recordings, options.common);
  std::vector<ImuRecording> recordings;
  for (const OpenedRecording& file : used) recordings.push_back({file.source, &file.recording});
  const Scenario& scenario = used.front().scenario;
  CalibrationResult result =
      calibrate_imu_pose(*scenario.robot.robot, scenario.control.imu_mount, recordings);
  return conclude_calibration(result, scenario, options);
}

}  // namespace flinch
