#pragma once

#include <memory>
#include <string>
#include <vector>

#include "systems/framework/system.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/contact_features.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

struct FeatureSettings {
  double least_force = 1.0;     ///< below it a force has no direction to speak of [N]
  double affected_drive = 2.5;  ///< epsilon_tau: what a drive must feel to count, [PAR] [Nm or N]
};

/// Features of a contact, [SafePR] Alg. 1. Every vector has its size, whatever the input; all is zero and
/// marked invalid without a force of at least `least_force`, so for a pure moment as well, without a valid
/// estimate, and for kinematics that are not valid.
ContactFeatures contact_features(const ParallelRobot& robot, const Kinematics& kinematics,
                                 const WrenchEstimate& estimate, const FeatureSettings& settings) noexcept;

/// Features as one vector, in the order of `feature_names`: wrench, drive torques, distances, angles.
using FeatureVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4 * max_dof, 1>;
FeatureVector feature_vector(const ContactFeatures& features) noexcept;

/// Those that tell whether and which leg is clamped: wrench, distances. [SafePR] III-E, V-F1
FeatureVector clamping_vector(const ContactFeatures& features) noexcept;

struct FeatureName {
  std::string name;  ///< "force_x", "moment_z", "drive_torque_1", "distance_1", "angle_1"
  std::string unit;  ///< SI
  friend bool operator==(const FeatureName&, const FeatureName&) = default;
};

/// What the entries of `feature_vector` are for this robot.
std::vector<FeatureName> feature_names(const ParallelRobot& robot);

/// Computes the features of the estimated wrench at every tick.
class FeatureExtraction final : public System {
 public:
  /// Throws SetupError for settings that are not positive.
  FeatureExtraction(std::shared_ptr<const ParallelRobot> robot, const FeatureSettings& settings);

  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<WrenchEstimate> wrench = input<WrenchEstimate>("wrench");
  OutputPort<ContactFeatures> features = output<&FeatureExtraction::extract>("features", kinematics, wrench);

 private:
  ContactFeatures extract(const Kinematics& now, const WrenchEstimate& estimate) const;

  std::shared_ptr<const ParallelRobot> robot_;
  FeatureSettings settings_;
};

}  // namespace flinch
