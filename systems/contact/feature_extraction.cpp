#include "systems/contact/feature_extraction.h"

#include <array>
#include <utility>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/line_of_action.h"

namespace flinch {
namespace {

ContactFeatures no_contact(const ParallelRobot& robot) {
  ContactFeatures features;
  features.wrench_in_base.setZero(robot.dof());
  features.drive_torque.setZero(robot.drives());
  features.distance.setZero(robot.legs());
  features.angle.setZero(robot.legs());
  return features;
}

void append(std::vector<FeatureName>& names, const std::string& name, const std::string& unit, int count) {
  for (int i = 1; i <= count; ++i) names.push_back({name + "_" + std::to_string(i), unit});
}

}  // namespace

ContactFeatures contact_features(const ParallelRobot& robot, const Kinematics& kinematics,
                                 const WrenchEstimate& estimate, const FeatureSettings& settings) noexcept {
  ContactFeatures features = no_contact(robot);
  features.acquired = estimate.acquired;
  if (!estimate.valid || !kinematics.valid || !usable(estimate.drive_torque, robot.drives())) return features;
  const LineOfAction line = line_of_action(robot.space(), estimate.wrench_in_base, settings.least_force);
  if (!line.valid) return features;
  features.valid = true;
  features.has_lever = line.has_lever;
  features.wrench_in_base = estimate.wrench_in_base;
  features.drive_torque = estimate.drive_torque;
  features.affected_drives =
      static_cast<int>((estimate.drive_torque.array().abs() > settings.affected_drive).count());
  const CartesianVector origin = kinematics.pose.head(robot.space_dimension());
  for (int i = 0; i < robot.legs(); ++i) {
    const LegPoints& leg = kinematics.legs[static_cast<std::size_t>(i)];
    if (line.has_lever) features.distance[i] = distance_to_line(line, origin, leg.coupling_joint);
    features.angle[i] = angle_between(line.direction, leg.coupling_joint - leg.passive_joint);
  }
  return features;
}

FeatureVector feature_vector(const ContactFeatures& features) noexcept {
  const auto& [acquired, valid, has_lever, wrench, torque, distance, angle, affected] = features;
  FeatureVector vector(wrench.size() + torque.size() + distance.size() + angle.size());
  vector << wrench, torque, distance, angle;
  return vector;
}

FeatureVector clamping_vector(const ContactFeatures& features) noexcept {
  FeatureVector vector(features.wrench_in_base.size() + features.distance.size());
  vector << features.wrench_in_base, features.distance;
  return vector;
}

std::vector<FeatureName> feature_names(const ParallelRobot& robot) {
  const std::array<std::string, 3> axes = {"x", "y", "z"};
  const auto translations = static_cast<std::size_t>(robot.space().translations());
  const auto rotations = static_cast<std::size_t>(robot.space().rotations());
  std::vector<FeatureName> names;
  for (std::size_t i = 0; i < translations; ++i) names.push_back({"force_" + axes[i], "N"});
  for (std::size_t i = 3 - rotations; i < 3; ++i) names.push_back({"moment_" + axes[i], "Nm"});
  for (int i = 0; i < robot.drives(); ++i) {
    const bool turns = robot.drive_kind(i) == DriveKind::revolute;
    names.push_back({"drive_torque_" + std::to_string(i + 1), turns ? "Nm" : "N"});
  }
  append(names, "distance", "m", robot.legs());
  append(names, "angle", "rad", robot.legs());
  return names;
}

FeatureExtraction::FeatureExtraction(std::shared_ptr<const ParallelRobot> robot,
                                     const FeatureSettings& settings)
    : robot_(std::move(robot)), settings_(settings) {
  Findings found("contact features: ");
  found.require(settings.least_force > 0, "least_force must be positive [N]");
  found.require(settings.affected_drive > 0, "affected_drive must be positive [Nm or N]");
  throw_if_any(found.take());
}

ContactFeatures FeatureExtraction::extract(const Kinematics& now, const WrenchEstimate& estimate) const {
  return contact_features(*robot_, now, estimate, settings_);
}

}  // namespace flinch
