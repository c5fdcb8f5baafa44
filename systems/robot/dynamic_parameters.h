#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "systems/robot/parallel_robot.h"

namespace flinch {

/// How a parameter takes of a drive's torque, in the drive's own unit: at any speed, or in proportion to it.
enum class DriveLoss { none, coulomb, viscous };

/// A number on which the equations of motion depend linearly, or as good as that near what is believed.
struct DynamicParameter {
  std::string name{};      ///< the path of its key in a robot file; empty: it has none
  std::string unit{};      ///< SI
  double believed = 0.0;   ///< what the robot says
  double deviation = 0.0;  ///< of that belief
  double least = 0.0;      ///< below it nothing can be: masses and friction are not negative
  DriveLoss loss = DriveLoss::none;
};

/// A number of a robot file.
struct FileValue {
  std::string name;
  std::string unit;
  double value = 0.0;
  /// the parameters on which it mainly depends, by their places in the list; none: those of the cogging
  std::vector<int> mainly{};
};

/// The inertial and friction parameters of a mechanism, and the robot that has others.
class DynamicParameters {
 public:
  virtual ~DynamicParameters() = default;

  const std::vector<DynamicParameter>& list() const { return list_; }
  /// The robot with these values, in the order of the list. It need not be physical. Throws SetupError only
  /// where no robot can be made of them.
  virtual std::shared_ptr<const ParallelRobot> with(const Eigen::VectorXd& values) const = 0;

  /// Matrices, linear in the values, that are positive definite for each robot that can be built: more than
  /// that masses and moments are positive.
  virtual std::vector<Eigen::MatrixXd> must_be_definite(const Eigen::VectorXd& values) const = 0;

  /// What a robot file says of such a robot: the values themselves, where its keys are those of the list.
  virtual std::vector<FileValue> in_file(const Eigen::VectorXd& values) const;

  Eigen::VectorXd believed() const;

  /// Those of `robot`; throws SetupError where it tells none.
  static std::unique_ptr<const DynamicParameters> of(const ParallelRobot& robot);

 protected:
  std::vector<DynamicParameter> list_;
};

}  // namespace flinch
