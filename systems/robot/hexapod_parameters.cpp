#include "systems/robot/hexapod_parameters.h"

#include <cstddef>
#include <sstream>

#include "systems/foundation/findings.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/rotation.h"

namespace flinch {
namespace {

// Inertia of a body is positive, symmetric, and each principal moment at most the sum of the others.
void check_body(const std::string& field, const RigidBodyInertia& body, Findings& findings) {
  findings.positive(field + ".mass", body.mass, "kg");
  findings.finite(field + ".centre_of_mass", body.centre_of_mass, "m");
  if (!body.inertia.allFinite() || !body.inertia.isApprox(body.inertia.transpose(), 1e-9)) {
    return findings.add(field + ".inertia is not a finite symmetric matrix");
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(body.inertia, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d& moments = solver.eigenvalues();
  if (moments[0] > 0.0 && moments[2] <= (moments[0] + moments[1]) * (1.0 + 1e-9)) return;
  std::ostringstream sentence;
  sentence << field << ".inertia has the principal moments " << moments.transpose()
           << " kg m^2; they must be positive, and none greater than the sum of the others";
  findings.add(sentence.str());
}

void check_leg(const std::string& path, const HexapodLeg& leg, Findings& findings) {
  findings.finite(path + "base_joint", leg.base_joint, "m");
  findings.finite(path + "platform_joint", leg.platform_joint, "m");
  if (!(std::abs(leg.universal_axis.norm() - 1.0) < 1e-9)) {
    findings.add(path + "universal_axis", leg.universal_axis.norm(), "long", "must be a unit vector");
  }
  findings.positive(path + "mass_scale", leg.mass_scale);
  find_sliding_friction_problems(path + "drive_friction", leg.drive_friction, findings);
  find_friction_problems(path + "universal_friction", leg.universal_friction, findings);
}

void check_home(const HexapodParameters& robot, Findings& findings) {
  const Eigen::Matrix3d R = rotation_matrix(quaternion_exp(robot.home_rotation));
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    const HexapodLeg& leg = robot.legs[i];
    const Eigen::Vector3d span = robot.home_position + R * leg.platform_joint - leg.base_joint;
    const double length = span.norm();
    const double longest = robot.rod_length + robot.cylinder_length;
    std::ostringstream sentence;
    if (!(length > robot.rod_length && length < longest)) {
      sentence << "home_pose is out of reach of legs[" << i << "]: base and platform joint are " << length
               << " m apart; the leg spans more than " << robot.rod_length << " and less than " << longest
               << " m";
    } else if (span.cross(leg.universal_axis).norm() < 1e-3 * length) {
      sentence << "home_pose turns legs[" << i << "] along its universal_axis, where it cannot be held";
    }
    if (!sentence.str().empty()) findings.add(sentence.str());
  }
}

}  // namespace

std::vector<std::string> problems(const HexapodParameters& parameters) {
  const HexapodParameters& p = parameters;
  Findings findings;
  if (p.name.empty()) findings.add("name is empty; a robot needs a name");
  for (std::size_t i = 0; i < p.legs.size(); ++i) {
    check_leg("legs[" + std::to_string(i) + "].", p.legs[i], findings);
  }
  findings.positive("cylinder_length", p.cylinder_length, "m");
  findings.positive("rod_length", p.rod_length, "m");
  findings.positive("cylinder_radius", p.cylinder_radius, "m");
  findings.positive("rod_radius", p.rod_radius, "m");
  check_body("cylinder", p.cylinder, findings);
  check_body("rod", p.rod, findings);
  findings.not_negative("drive_armature", p.drive_armature, "kg");
  findings.positive("drive_friction_velocity", p.drive_friction_velocity, "m/s");
  findings.positive("universal_friction_velocity", p.universal_friction_velocity, "rad/s");
  check_body("platform", p.platform, findings);
  if (p.payload) check_body("payload", *p.payload, findings);
  findings.positive("platform_radius", p.platform_radius, "m");
  findings.finite("platform_bottom", p.platform_bottom, "m");
  findings.positive("platform_top - platform_bottom", p.platform_top - p.platform_bottom, "m");
  findings.finite("gravity", p.gravity, "m/s^2");
  findings.finite("home_position", p.home_position, "m");
  findings.finite("home_rotation", p.home_rotation, "rad");
  findings.positive("characteristic_length", p.characteristic_length, "m");
  if (findings.none()) check_home(p, findings);
  return findings.take();
}

}  // namespace flinch
