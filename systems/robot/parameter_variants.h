#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "systems/robot/dynamic_parameters.h"

namespace flinch {

/// J^T (M dv + C v + g + F_fr): what the drives of `robot` must do for a motion [Nm or N].
JointVector model_effort(const ParallelRobot& robot, const Kinematics& at,
                         const PlatformVector& acceleration);

/// The robots that differ from what is believed in one parameter each. The difference of what their drives
/// must do is the regressor, exactly, for all is linear in the parameters.
class ParameterVariants {
 public:
  explicit ParameterVariants(const DynamicParameters& parameters);

  std::size_t size() const { return robots_.size(); }
  /// Y = d tau / d p, one row for each drive, where `base` is the effort of the believed robot.
  Eigen::MatrixXd regressor(const JointVector& base, const Kinematics& at,
                            const PlatformVector& acceleration) const;

 private:
  std::vector<std::shared_ptr<const ParallelRobot>> robots_;
  std::vector<double> steps_;
};

}  // namespace flinch
