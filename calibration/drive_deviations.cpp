#include "calibration/drive_deviations.h"

#include <cmath>

#include "systems/framework/recorded_values.h"
#include "systems/framework/recording.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {
namespace {

/// Root mean square of what counts; empty where nothing does.
JointVector recorded_deviations(const std::vector<ResidualRecording>& recordings) {
  JointVector squares;
  double samples = 0.0;
  for (const ResidualRecording& each : recordings) {
    if (each.recording->find(isolation_signal) == nullptr) return {};
    const auto estimates = read<WrenchEstimate>(*each.recording, isolation_signal);
    for (std::size_t k = 0; k < estimates.size(); ++k) {
      if (!each.nominal[k] || !estimates[k].valid) continue;
      const JointVector& error = estimates[k].drive_torque;
      if (squares.size() == 0) squares.setZero(error.size());
      if (squares.size() != error.size()) continue;
      squares += error.cwiseAbs2();
      samples += 1.0;
    }
  }
  return samples > 0.0 ? JointVector((squares / samples).cwiseSqrt()) : JointVector();
}

/// Of what errors of the wrench mean at the drives, at home.
JointVector deviations_at_drives(const ParallelRobot& robot, const WrenchUncertainty& of) {
  const PlatformVector none = PlatformVector::Zero(robot.dof());
  Kinematics home;
  robot.kinematics(robot.home_pose(), none, home);
  const PlatformMatrix S = of.covariance(robot.space(), none);
  return (home.J_x_qa.transpose() * S * home.J_x_qa).diagonal().cwiseSqrt();
}

}  // namespace

JointVector drive_deviations(const std::vector<ResidualRecording>& recordings, const ParallelRobot& robot,
                             const WrenchUncertainty& least) {
  const JointVector recorded = recorded_deviations(recordings), at_least = deviations_at_drives(robot, least);
  if (recorded.size() != at_least.size()) return {};
  const JointVector found = recorded * std::sqrt(static_cast<double>(recorded.size()) / robot.dof());
  if ((found.array() <= at_least.array()).all()) return {};
  return found.cwiseMax(at_least);
}

}  // namespace flinch
