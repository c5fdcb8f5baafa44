#include "systems/robot/parameter_variants.h"

#include <algorithm>
#include <cmath>

#include "systems/robot/contact_jacobian.h"

namespace flinch {

JointVector model_effort(const ParallelRobot& robot, const Kinematics& at,
                         const PlatformVector& acceleration) {
  Dynamics dynamics;
  robot.dynamics(at, dynamics);
  return drive_torques(
      at, dynamics.M_x * acceleration + dynamics.C_x * at.velocity + dynamics.g_x + dynamics.F_fr_x);
}

ParameterVariants::ParameterVariants(const DynamicParameters& parameters) {
  const Eigen::VectorXd believed = parameters.believed();
  for (std::size_t j = 0; j < parameters.list().size(); ++j) {
    const DynamicParameter& parameter = parameters.list()[j];
    const double step = 0.01 * std::max(std::abs(parameter.believed), 0.1 * parameter.deviation);
    Eigen::VectorXd values = believed;
    values[static_cast<Eigen::Index>(j)] += step;
    robots_.push_back(parameters.with(values));
    steps_.push_back(step);
  }
}

Eigen::MatrixXd ParameterVariants::regressor(const JointVector& base, const Kinematics& at,
                                             const PlatformVector& acceleration) const {
  Eigen::MatrixXd Y(base.size(), static_cast<Eigen::Index>(robots_.size()));
  for (std::size_t j = 0; j < robots_.size(); ++j)
    Y.col(static_cast<Eigen::Index>(j)) = (model_effort(*robots_[j], at, acceleration) - base) / steps_[j];
  return Y;
}

}  // namespace flinch
