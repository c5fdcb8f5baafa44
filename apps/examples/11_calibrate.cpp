// Torque constants and the pose of the IMU from recordings, with Ceres. Here both recordings are simulated;
// of a robot of yours, open_recording("pulls.h5") reads what 'flinch run' or 'flinch import' has written.
// Start it in the root of the tree.
#include <flinch/calibration.h>
#include <flinch/identification.h>
#include <flinch/simulated_experiments.h>
#include <cmath>
#include <cstdio>

using namespace flinch;

/// Whether all that can be found lies within four of its deviations of the truth.
static bool holds(const CalibrationResult& result, const Eigen::VectorXd& truth) {
  std::printf("%s\n", calibration_table(result).c_str());
  bool good = result.contradictions.empty();
  for (Eigen::Index i = 0; i < truth.size(); ++i) {
    const CalibratedParameter& found = result.parameters[static_cast<std::size_t>(i)];
    const double error = std::abs(found.value - truth[i]);
    good = good && (!found.identifiable || error < 4.0 * found.deviation.value_or(0.0));
  }
  return good;
}

int main() try {
  const auto pulls = read_simulated_scenario("apps/scenarios/calibration_pulls.yaml");
  const Recording pulled = run_experiment(pulls);
  const CalibrationResult constants =
      calibrate_torque_constants({.robot = pulls.robot.robot.get(),
                                  .drives = pulls.robot.drives,
                                  .constant = pulls.control.drive_torque.torque_constant},
                                 {{{}, &pulled, pulls.mountings}}, {});

  const auto motion = read_simulated_scenario("apps/scenarios/calibration_motion.yaml");
  const Recording moved = run_experiment(motion);
  const CalibrationResult pose =
      calibrate_imu_pose(*motion.robot.robot, motion.control.imu_mount, {{{}, &moved}});

  Eigen::VectorXd mount(6);
  mount << motion.station.imu.position_in_platform, motion.station.imu.angles;
  const bool good = holds(constants, pulls.station.drives.torque_constant) && holds(pose, mount);
  return good ? 0 : 1;
} catch (const std::exception& error) {  // a SetupError says all that is wrong
  std::fprintf(stderr, "error: %s\n", error.what());
  return 2;
}
