#include "identification/encoder_motion.h"

#include <fmt/core.h>

#include "identification/zero_phase.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recorded_values.h"
#include "systems/robot/kinematic_causes.h"
#include "systems/robot/kinematic_check.h"
#include "systems/robot/rotation.h"
#include "systems/signals/joint_reading.h"
#include "systems/signals/reaction_state.h"

namespace flinch {
namespace {

std::vector<JointVector> active_angles(const RecordedValues<JointReading>& joints,
                                       const ValidStretch& stretch) {
  std::vector<JointVector> active;
  for (std::size_t k = 0; k < stretch.count; ++k) active.push_back(joints[stretch.first + k].active);
  return active;
}

std::string cause_of_no_pose(const RecordedValues<JointReading>& joints, const ParallelRobot& robot,
                             const ValidStretch& stretch) {
  return told_kinematic_causes(robot, active_angles(joints, stretch),
                               "the robot file is of another robot, or the encoders of its legs are swapped");
}

/// Rows are the coordinates of each pose in the chart around the first one.
Eigen::MatrixXd chart_coordinates(const Recording& recording, const ParallelRobot& robot,
                                  const ValidStretch& stretch, Configuration& origin) {
  const auto joints = read<JointReading>(recording, "joints");
  Eigen::MatrixXd xi(static_cast<Eigen::Index>(stretch.count), robot.dof());
  Configuration pose = stretch.pose.value_or(robot.home_pose());
  WorkingMode mode = robot.home_working_mode();
  for (std::size_t k = 0; k < stretch.count; ++k) {
    const JointReading reading = joints[stretch.first + k];
    if (k == 0 && reading.passive_valid) {
      pose = robot.start_pose(reading.active, reading.passive);
      mode = robot.working_mode(reading.passive);
    }
    const ForwardSolution solution = robot.forward_kinematics(reading.active, pose, mode);
    if (!solution.converged) {
      throw SetupError("the encoders fit no pose of the robot at " +
                       std::to_string(1e-9 * static_cast<double>(recording.time_ns[stretch.first + k])) +
                       " s; " + cause_of_no_pose(joints, robot, stretch));
    }
    pose = solution.pose;
    if (k == 0) origin = pose;
    xi.row(static_cast<Eigen::Index>(k)) = robot.difference(pose, origin).transpose();
  }
  return xi;
}

/// Central differences; one-sided at the ends.
Eigen::MatrixXd differences(const Eigen::MatrixXd& x, double period) {
  const Eigen::Index n = x.rows();
  Eigen::MatrixXd rate = Eigen::MatrixXd::Zero(n, x.cols());
  if (n < 3) return rate;
  rate.middleRows(1, n - 2) = (x.bottomRows(n - 2) - x.topRows(n - 2)) / (2.0 * period);
  rate.row(0) = rate.row(1);
  rate.row(n - 1) = rate.row(n - 2);
  return rate;
}

/// Adds a stretch, divided where a leg without a passive encoder changes the side of its elbow.
void add_as_assembled(const RecordedValues<JointReading>& joints, const ParallelRobot& robot,
                      const ValidStretch& stretch, std::size_t least, std::vector<ValidStretch>& stretches) {
  if (joints[stretch.first].passive_valid) return stretches.push_back(stretch);
  const KinematicCheck check = check_kinematics(robot, active_angles(joints, stretch));
  if (check.stretches.size() <= 1 && !check.folds_from_home(robot)) return stretches.push_back(stretch);
  for (std::size_t i = 0; i < check.stretches.size(); ++i) {
    const KinematicCheck::Stretch& own = check.stretches[i];
    const std::size_t end = i + 1 < check.stretches.size() ? check.stretches[i + 1].first : stretch.count;
    if (end - own.first >= least) {
      stretches.push_back(
          {stretch.first + own.first, end - own.first, robot.assembled_as(own.mode), own.pose});
    }
  }
}

}  // namespace

std::vector<ValidStretch> valid_stretches(const Recording& recording, const ParallelRobot& robot,
                                          std::size_t least) {
  const auto joints = read<JointReading>(recording, "joints");
  const bool has_mode = recording.find("reaction") != nullptr;
  const auto mode = has_mode ? std::optional(read<ReactionState>(recording, "reaction")) : std::nullopt;
  std::vector<ValidStretch> stretches;
  ValidStretch now;
  const auto end = [&] {
    if (now.count >= least) add_as_assembled(joints, robot, now, least, stretches);
    now.count = 0;
  };
  for (std::size_t k = 0; k < recording.samples(); ++k) {
    const bool moved = !mode || (*mode)[k].mode == ReactionMode::nominal;
    const bool follows =
        now.count == 0 || Time(recording.time_ns[k] - recording.time_ns[k - 1]) == recording.period;
    if (!follows) end();
    if (!joints[k].valid || !moved) {
      end();
      continue;
    }
    if (now.count == 0) now.first = k;
    ++now.count;
  }
  end();
  return stretches;
}

void require_rate(Time period, double least, const char* what) {
  const double rate = 1.0 / to_seconds(period);
  if (rate >= least) return;
  throw SetupError(fmt::format("there are {:.3g} readings a second; {} needs {:.3g} at least: record faster",
                               rate, what, least));
}

EncoderMotion encoder_motion(const Recording& recording, const ParallelRobot& at_home,
                             const ValidStretch& stretch, double cutoff_frequency) {
  const ParallelRobot& robot = stretch.robot(at_home);
  const double period = to_seconds(recording.period);
  Configuration origin;
  const Eigen::MatrixXd xi =
      zero_phase(chart_coordinates(recording, robot, stretch, origin), cutoff_frequency, period);
  EncoderMotion motion;
  motion.velocity = differences(xi, period);
  const Eigen::Index rotation = robot.space().translations();
  for (Eigen::Index k = 0; k < xi.rows(); ++k) {
    const PlatformVector step = xi.row(k).transpose();
    motion.pose.push_back(robot.space().plus(origin, step));
    if (robot.space().rotations() < 3) continue;
    const Eigen::Vector3d turned = step.segment<3>(rotation);
    const Eigen::Vector3d rate = motion.velocity.row(k).segment<3>(rotation).transpose();
    motion.velocity.row(k).segment<3>(rotation) = (left_jacobian(turned) * rate).transpose();
  }
  motion.acceleration = differences(motion.velocity, period);
  return motion;
}

}  // namespace flinch
