#pragma once

#include "systems/foundation/findings.h"
#include "systems/robot/configuration_space.h"
#include "systems/robot/kinematics.h"

namespace flinch {

/// How far an estimated wrench is from the true one: standard deviations of each of its components, or of
/// what it says of each drive, which grow with the force, and what it is behind by while the force changes.
/// docs/theory.md says how the defaults were measured.
struct WrenchUncertainty {
  double force = 2.0;             ///< [N]
  double moment = 0.2;            ///< [Nm]
  double share_of_force = 0.05;   ///< of the size of the force, on each component of it
  double share_of_lever = 0.004;  ///< of the size of the force, on each component of the moment [m]
  double share_of_change = 2.0;   ///< of what the estimate has changed by of late (`WrenchTrend`), as a whole
  /// Of what the estimate takes for torques of the drives where nothing touches the robot: where it is known,
  /// it stands for `force` and `moment`. Empty: not known [Nm or N]
  JointVector drive_torque{};

  /// The covariance of `wrench`: no correlations.
  PlatformMatrix covariance(const ConfigurationSpace& space, const PlatformVector& wrench) const {
    return diagonal(space, force * force, moment * moment, wrench);
  }

  /// The same in the pose `at`: errors of the drives' torques become a wrench by J_qa_x^T, which correlates
  /// its components.
  PlatformMatrix covariance(const ConfigurationSpace& space, const Kinematics& at,
                            const PlatformVector& wrench) const {
    if (!at.valid || at.J_qa_x.rows() != drive_torque.size() || drive_torque.size() == 0)
      return covariance(space, wrench);
    const PlatformMatrix of_drives = drive_torque.asDiagonal() * at.J_qa_x;
    return diagonal(space, 0.0, 0.0, wrench) + of_drives.transpose() * of_drives;
  }

  /// Standard deviation of each component where the wrench is zero.
  PlatformVector deviation_without_contact(const ConfigurationSpace& space) const {
    return covariance(space, PlatformVector::Zero(space.dimension())).diagonal().cwiseSqrt();
  }

  /// The covariance of all errors of an estimate that has changed by `change` of late.
  PlatformMatrix errors(const ConfigurationSpace& space, const Kinematics& at, const PlatformVector& wrench,
                        const PlatformVector& change) const {
    return covariance(space, at, wrench) + share_of_change * share_of_change * change * change.transpose();
  }

  /// The size of an estimated wrench in deviations of one that is zero: how far it stands out of what an
  /// estimate errs by without any contact.
  double size(const ConfigurationSpace& space, const PlatformVector& wrench) const {
    return wrench.cwiseQuotient(deviation_without_contact(space)).norm();
  }

  void find_problems(Findings& found) const {
    found.positive("force", force, "N");
    found.positive("moment", moment, "Nm");
    found.not_negative("share_of_force", share_of_force);
    found.not_negative("share_of_lever", share_of_lever, "m");
    found.not_negative("share_of_change", share_of_change);
    found.require((drive_torque.array() > 0.0).all(), "drive_torque must be positive");
  }

 private:
  /// `of_force`, `of_moment`: variances without a wrench.
  PlatformMatrix diagonal(const ConfigurationSpace& space, double of_force, double of_moment,
                          const PlatformVector& wrench) const {
    const double size = wrench.head(space.translations()).squaredNorm();
    PlatformVector variance =
        PlatformVector::Constant(space.dimension(), of_force + share_of_force * share_of_force * size);
    variance.tail(space.rotations()).setConstant(of_moment + share_of_lever * share_of_lever * size);
    return variance.asDiagonal();
  }
};

}  // namespace flinch
