#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "identification/dynamics_rows.h"
#include "systems/robot/drive_parameters.h"
#include "systems/robot/dynamic_parameters.h"

namespace flinch {

/// What repeats along the way of a drive, whatever its current: s sin(r q) + c cos(r q).
struct DriveWave {
  int drive = 0;
  double rate = 0.0;       ///< r [rad/rad or rad/m]
  double deviation = 0.0;  ///< of what is believed of the rate, as it was found
  double least = 0.0;      ///< rate; what is slower may be something else
  double sine = 0.0;       ///< s [Nm or N]
  double cosine = 0.0;     ///< c [Nm or N]
};

/// The waves that explain some of what is `left` of the surplus of rows [Nm or N]: of each drive one after
/// the other, each of what those before it have left, at most `most_cogging_waves`; by drive and rate.
/// Each explains at least the share `least` of the scatter that is left when it is found.
std::vector<DriveWave> find_cogging(const DynamicsRows& rows, const Eigen::VectorXd& left, int drives,
                                    double least = 0.03);

/// The surplus of rows without what drives are believed to cog by [Nm or N].
Eigen::VectorXd without_cogging(const DynamicsRows& rows, const Cogging& believed);

/// The dynamic parameters of a robot, after them by how much the torque of each drive is behind its current,
/// and s, c and r of each wave, which come by drive and rate. In the file stands the cogging of all drives; a
/// drive with fewer waves than others has some without a size.
class MotorParameters final : public DynamicParameters {
 public:
  /// `robot` outlives it.
  MotorParameters(const DynamicParameters& robot, std::vector<DriveWave> waves, DriveKind kind,
                  const DriveParameters& believed);

  /// The first of the list that is the delay of a drive, and the first that belongs to a wave.
  std::ptrdiff_t first_delay() const { return static_cast<std::ptrdiff_t>(robot_.list().size()); }
  std::ptrdiff_t first_of_waves() const { return first_delay() + believed_.torque_constant.size(); }
  /// The rows of the robot's parameters with how they depend on delays and waves.
  DynamicsRows rows(DynamicsRows of_robot) const;

  std::shared_ptr<const ParallelRobot> with(const Eigen::VectorXd& values) const override;
  std::vector<Eigen::MatrixXd> must_be_definite(const Eigen::VectorXd& values) const override;
  std::vector<FileValue> in_file(const Eigen::VectorXd& values) const override;

  /// By which the torques of the drives are behind their currents [s].
  JointVector torque_delay(const Eigen::VectorXd& values) const {
    return values.segment(first_delay(), first_of_waves() - first_delay());
  }
  /// Drives that were believed to cog by a wave that is not seen.
  std::vector<int> stilled() const;
  /// What is believed, in the order of `in_file`; it ends before the cogging where nothing is known of that.
  std::vector<FileValue> believed_in_file() const;

 private:
  Eigen::VectorXd of_robot(const Eigen::VectorXd& values) const;
  Cogging cogging(const Eigen::VectorXd& values) const;
  std::vector<FileValue> but_for_cogging(const Eigen::VectorXd& values) const;
  void add(const Cogging& cogging, std::vector<FileValue>& in_file) const;

  const DynamicParameters& robot_;
  std::vector<DriveWave> waves_;
  DriveKind kind_;
  DriveParameters believed_;
};

}  // namespace flinch
