#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "identification/fit_uncertainty.h"
#include "identification/pull_windows.h"

namespace flinch {

/// What a fit of torque constants looks for besides them.
struct TorqueConstantModel {
  bool coulomb = true;                 ///< friction that the model of the robot does not have
  bool misalignment = true;            ///< of the instrument, anew at each mounting
  double misalignment_belief = 0.035;  ///< Standard deviation of what is believed of it, 2 degrees [rad].
  double usual_error = 1.0;            ///< of a window before anything is known [Nm or N]. [ICRA23] III-B
  bool cogging = true;                 ///< and ripple: what repeats along the way, where it explains much
  double slow = 0.02;                  ///< Below it nobody knows where friction points to [rad/s or m/s].
};

/// What repeats along the ways of the drives: of the drive i at q_i parts_0i sin(rate_i q_i) + parts_1i
/// cos(rate_i q_i); of rate 0: nothing.
struct PullWave {
  JointVector rate;                                               ///< [rad/rad or rad/m]
  Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, max_dof> parts;  ///< of sine and cosine

  double at(int drive, double position) const;
};
/// How many waves of cogging are looked for at a drive: the first harmonics.
inline constexpr int most_pull_waves = 4;

/// Torque constants of all drives, and what else explains the pulls.
struct TorqueConstantFit {
  JointVector constant;                       ///< k_t [Nm/A or N/A]
  JointVector offset;                         ///< o [Nm or N]
  JointVector coulomb;                        ///< beyond what the model of the robot has [Nm or N]
  std::vector<Eigen::Vector3d> misalignment;  ///< by mounting: rotation vector in the axes of its body [rad]
  std::array<PullWave, most_pull_waves> cogging;  ///< as they were found [Nm or N]
  PullWave ripple;                                ///< a share of the torque
  JointVector deviation;  ///< of the residuals of each drive, outliers apart [Nm or N]
  /// By how many deviations of what is believed of it each dynamic parameter is off; nothing: not looked for.
  Eigen::VectorXd surplus;

  /// Columns: k_t, o, c, parts of cogging and ripple and the rates of both of each drive, as far as they were
  /// looked for, then the misalignments, then those of the surplus that the pulls can tell.
  LinearFit linear;
  std::vector<Eigen::Index> column_of_drive;  ///< that of its k_t
  std::vector<std::size_t> window_of_row;
  std::vector<int> drive_of_row;
};

/// Minimises over windows w and drives i the squares of
/// r = ( k_i I_wi (1 + ripple_i(q_wi)) - e_wi(p) + [J^T R(delta) f_w]_i - o_i - c_i sgn(dq_wi)
/// - cogging_i(q_wi) ) / sqrt(sigma_i^2 + k_i^2 sigma_Iwi^2) after [ICRA23] (5), where e is what a robot with
/// the dynamic parameters p needs for its motion, and of (p - p_believed) / sigma_believed. The currents are
/// noisy too; the denominator takes that into account, so that no slope is flattened (Deming). Loss: Huber,
/// then Tukey, with sigma_i from the residuals. Ceres.
TorqueConstantFit fit_torque_constants(const std::vector<PullWindow>& windows, int mountings,
                                       const JointVector& believed, const TorqueConstantModel& model);

/// The residual of a window at the drive `drive`, not divided by anything [Nm or N].
double torque_residual(const PullWindow& window, int drive, const TorqueConstantFit& fit, double slow);

}  // namespace flinch
