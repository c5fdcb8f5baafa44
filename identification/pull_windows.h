#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "systems/robot/parallel_robot.h"
#include "systems/signals/instrument_mounting.h"

namespace flinch {

struct Recording;

/// Means over a tenth of a second while a rope may pull at the robot.
struct PullWindow {
  using ForceMap = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, max_dof, 3>;

  int recording = 0;
  int mounting = 0;               ///< counted through all recordings
  int cluster = 0;                ///< those whose errors are not independent: one pull
  int body = 0;                   ///< BodyId::index()
  double time = 0.0;              ///< [s]
  JointVector current;            ///< [A]
  JointVector current_deviation;  ///< of that mean, from the scatter within the window [A]
  JointVector model_effort;       ///< what the model of the robot needs for its motion [Nm or N]
  /// How that depends on each dynamic parameter, in deviations of what is believed of them [Nm or N]; no
  /// columns: the model is taken as true.
  Eigen::MatrixXd effort_slopes;
  JointVector position;                                ///< of the drives [rad or m]
  JointVector rate;                                    ///< of the drives [rad/s or m/s]
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< of the body in the base frame, as columns
  Eigen::Vector3d force{0.0, 0.0, 0.0};   ///< in the axes of the body, without the zero of the instrument [N]
  Eigen::Vector3d moment{0.0, 0.0, 0.0};  ///< likewise, about the instrument's origin [Nm]
  ForceMap force_map;                     ///< drive torques of such a force: J_xc,qa^T R. [SafePR] (6b)
  ForceMap moment_map;                    ///< likewise of a moment
  PlatformMatrix drive_map;               ///< J_qa,x: F = J_qa,x^T tau_a

  /// What the rope does to the drives, J_xc,qa^T f. [ICRA23] III-B
  JointVector projected() const { return force_map * force + moment_map * moment; }
};

/// The windows of one recording. `mountings`: of the instrument. `first_mounting`: how many those before it
/// have; `warnings`: what is wrong with its parts. Throws SetupError where nothing can be done with it.
std::vector<PullWindow> pull_windows(const Recording& recording, const ParallelRobot& robot,
                                     const std::vector<InstrumentMounting>& mountings, int number,
                                     int first_mounting, std::vector<std::string>& warnings);

}  // namespace flinch
