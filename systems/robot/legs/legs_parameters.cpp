#include "systems/robot/legs/legs_parameters.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "systems/foundation/findings.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/legs/leg_closure.h"
#include "systems/robot/vectors.h"

namespace flinch {
namespace {

constexpr double across = 1e-6;

// A body has a mass, and an inertia that some body has: no principal moment exceeds the sum of the others. A
// thin rod has none about its axis, and a link without inertia is a point mass.
void check_body(const std::string& field, const RigidBodyInertia& body, Findings& findings) {
  findings.positive(field + ".mass", body.mass, "kg");
  findings.finite(field + ".centre_of_mass", body.centre_of_mass, "m");
  if (!body.inertia.allFinite() || !body.inertia.isApprox(body.inertia.transpose(), 1e-9)) {
    return findings.add(field + ".inertia is not a finite symmetric matrix");
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(body.inertia, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d& moments = solver.eigenvalues();
  const double rounding = 1e-9 * moments[2];
  if (moments[0] >= -rounding && moments[2] <= moments[0] + moments[1] + rounding) return;
  std::ostringstream sentence;
  sentence << field << ".inertia has the principal moments " << moments.transpose()
           << " kg m^2; none may be negative, or greater than the sum of the others";
  findings.add(sentence.str());
}

void check_axis(const std::string& field, const Eigen::Vector3d& axis, Findings& findings) {
  findings.finite(field, axis);
  findings.require(!axis.allFinite() || axis.norm() > 1e-9, field + " has no length");
}

std::string names_of(const RobotLeg& leg, std::size_t before) {
  std::string names;
  for (std::size_t j = 0; j < before; ++j) names += (j > 0 ? ", '" : "'") + leg.joints[j].name + "'";
  return names.empty() ? "there is none before" : "those before are " + names;
}

class DescriptionCheck {
 public:
  DescriptionCheck(const LegsParameters& robot, Findings& findings) : robot_(robot), findings_(findings) {}

  void check() {
    if (robot_.name.empty()) findings_.add("name is empty; a robot needs a name");
    findings_.positive("characteristic_length", robot_.characteristic_length, "m");
    findings_.finite("gravity", robot_.gravity, "m/s^2");
    findings_.finite("home_pose", robot_.home_position, "m");
    findings_.finite("home_pose", robot_.home_rotation, "rad");
    check_body("platform", robot_.platform.inertia, findings_);
    if (robot_.payload) check_body("payload", *robot_.payload, findings_);
    if (robot_.moves.planar) check_planar_home();
    const std::size_t legs = robot_.legs.size();
    if (legs < 1 || legs > static_cast<std::size_t>(max_dof)) {
      findings_.add("legs are " + std::to_string(legs) + "; there may be 1 to " + std::to_string(max_dof));
      return;
    }
    for (std::size_t i = 0; i < legs; ++i) check_leg(i);
    check_drives();
    check_measured();
  }

 private:
  static std::string path_of(std::size_t leg) { return "legs[" + std::to_string(leg) + "]"; }

  void check_planar_home() {
    findings_.require(robot_.home_position.z() == 0.0 && robot_.home_rotation.head<2>().isZero(0.0),
                      "home_pose leaves the plane z = 0 in which such a platform moves");
  }

  void check_leg(std::size_t index) {
    const RobotLeg& leg = robot_.legs[index];
    const std::string path = path_of(index);
    findings_.finite(path + ".at", leg.at, "m");
    findings_.finite(path + ".turned", leg.turned, "rad");
    if (robot_.moves.planar) {
      findings_.require(leg.at.z() == 0.0 && leg.turned.head<2>().isZero(0.0),
                        path + " leaves the plane z = 0 in which such a robot moves");
    }
    if (leg.joints.empty()) return findings_.add(path + ".joints is empty; a leg needs joints");
    std::set<std::string> names;
    for (std::size_t j = 0; j < leg.joints.size(); ++j) {
      const std::string of_joint = path + ".joints[" + std::to_string(j) + "]";
      const std::string& name = leg.joints[j].name;
      if (name.empty()) findings_.add(of_joint + ".name is empty; a joint needs a name");
      if (leg.joints[j].on == "base" && joint_index(leg, "base"))
        findings_.add(of_joint +
                      ".on is 'base', which is the base and a joint of the leg; call the joint otherwise");
      if (!names.insert(name).second)
        findings_.add(of_joint + ".name '" + name + "' is that of another joint of the leg");
      check_joint(of_joint, leg, j);
    }
    check_size(path, leg);
    if (leg.closures.empty())
      findings_.add(path + ".closures is empty; a leg needs one that holds the platform");
    for (std::size_t c = 0; c < leg.closures.size(); ++c)
      check_closure(path + ".closures[" + std::to_string(c) + "]", leg, leg.closures[c]);
    const auto holds_platform = [](const LegClosure& closure) {
      return closure.on == LegClosure::On::platform;
    };
    const bool held = std::any_of(leg.closures.begin(), leg.closures.end(), holds_platform);
    findings_.require(leg.closures.empty() || held, path + ".closures hold nothing of the platform");
    const auto shapes = std::count_if(leg.joints.begin(), leg.joints.end(), [](const LegJoint& joint) {
      return joint.link && !joint.link->shapes.empty();
    });
    if (shapes > 2) {
      findings_.add(
          path + ".joints has " + std::to_string(shapes) +
          " links with shapes; at most two links of a leg can be touched, so leave out those of the others");
    }
  }

  void check_size(const std::string& path, const RobotLeg& leg) {
    int joints = 0;
    int coordinates = 0;
    for (const LegJoint& joint : leg.joints) {
      const int axes = axis_count(joint.kind);
      joints += joint.kind == LegJointKind::screw ? 2 : axes;
      if (!joint.follows) coordinates += axes;
    }
    int rows = 0;
    for (const LegClosure& closure : leg.closures) {
      const int directions = robot_.moves.planar ? 2 : 3;
      rows += directions + (!closure.holds_frame ? 0 : robot_.moves.planar ? 1 : 3);
    }
    if (coordinates > max_leg_coordinates) {
      findings_.add(path + " has " + std::to_string(coordinates) + " coordinates; at most " +
                    std::to_string(max_leg_coordinates) + " fit");
    }
    if (joints > static_cast<int>(max_leg_joints)) {
      findings_.add(path + " has " + std::to_string(joints) + " axes of joints; at most " +
                    std::to_string(max_leg_joints) + " fit");
    }
    if (rows > max_closure_rows) {
      findings_.add(path + ".closures have " + std::to_string(rows) + " rows; at most " +
                    std::to_string(max_closure_rows) + " fit");
    }
    if (rows < coordinates && !leg.closures.empty() && joints <= static_cast<int>(max_leg_joints)) {
      findings_.add(path + " can move while the platform stands still: it has " +
                    std::to_string(coordinates) + " coordinates, and its closures hold " +
                    std::to_string(rows));
    }
  }

  void check_joint(const std::string& path, const RobotLeg& leg, std::size_t index) {
    const LegJoint& joint = leg.joints[index];
    findings_.finite(path + ".at", joint.at, "m");
    findings_.finite(path + ".turned", joint.turned, "rad");
    if (!joint.on.empty() && joint.on != "base") require_earlier(path + ".on", leg, index, joint.on);
    if (joint.kind != LegJointKind::spherical) check_axis(path + ".axis", joint.axis, findings_);
    if (joint.kind == LegJointKind::universal) {
      check_axis(path + ".second_axis", joint.second_axis, findings_);
      const double cosine = joint.axis.normalized().dot(joint.second_axis.normalized());
      findings_.require(std::abs(cosine) <= across,
                        path +
                            ".second_axis is not across the first; the axes of a universal joint cross at "
                            "right angles");
    }
    if (joint.kind == LegJointKind::screw) {
      findings_.require(std::isfinite(joint.pitch) && joint.pitch != 0.0,
                        path + ".pitch is 0 m; a screw moves along its axis as it turns");
    }
    if (robot_.moves.planar) check_planar_joint(path, joint);
    check_following(path, leg, index);
    check_drive(path, joint);
    if (!(joint.least < joint.most))
      findings_.add(path + ".range is empty; it goes from the least to the most");
    if (slides(joint.kind)) find_sliding_friction_problems(path + ".friction", joint.friction, findings_);
    if (!slides(joint.kind)) find_friction_problems(path + ".friction", joint.friction, findings_);
    for (const double reference : joint.reference) findings_.finite(path + ".reference", reference);
    if (joint.link) check_body(path + ".link", joint.link->inertia, findings_);
  }

  void check_planar_joint(const std::string& path, const LegJoint& joint) {
    const bool turns = joint.kind == LegJointKind::revolute;
    if (!turns && joint.kind != LegJointKind::prismatic) {
      return findings_.add(path +
                           ".kind leaves the plane in which such a robot moves; there joints are revolute "
                           "or prismatic");
    }
    const Eigen::Vector3d axis = joint.axis.normalized();
    const bool fits = turns ? std::abs(std::abs(axis.z()) - 1.0) < 1e-9 : std::abs(axis.z()) < 1e-9;
    findings_.require(fits && joint.at.z() == 0.0 && joint.turned.head<2>().isZero(0.0),
                      path + " leaves the plane z = 0: there a joint turns about z, or slides across it");
  }

  void check_following(const std::string& path, const RobotLeg& leg, std::size_t index) {
    const LegJoint& joint = leg.joints[index];
    if (!joint.follows) return;
    findings_.require(!joint.drive && !joint.measured,
                      path + ".follows another joint, so it is neither driven nor measured itself");
    findings_.require(std::isfinite(joint.follows->ratio) && joint.follows->ratio != 0.0,
                      path + ".follows.ratio must be a number other than 0");
    findings_.finite(path + ".follows.offset", joint.follows->offset);
    if (!require_earlier(path + ".follows.joint", leg, index, joint.follows->joint)) return;
    const LegJoint& leader = leg.joints[*joint_index(leg, joint.follows->joint)];
    findings_.require(axis_count(leader.kind) == axis_count(joint.kind),
                      path + ".follows.joint has another number of axes than the joint that follows it");
  }

  void check_drive(const std::string& path, const LegJoint& joint) {
    if (!joint.drive) return;
    findings_.require(axis_count(joint.kind) == 1, path + ".drive needs a joint of one axis");
    findings_.require(!joint.measured,
                      path + ".measured is for joints without a drive, whose encoder is its own");
    findings_.not_negative(path + ".drive.armature", joint.drive->armature);
    findings_.require(std::isfinite(joint.drive->ratio) && joint.drive->ratio != 0.0,
                      path + ".drive.ratio must be a number other than 0");
    findings_.finite(path + ".drive.zero", joint.drive->zero);
  }

  bool require_earlier(const std::string& field, const RobotLeg& leg, std::size_t index,
                       const std::string& name) {
    const auto found = joint_index(leg, name);
    if (found && *found < index) return true;
    findings_.add(field + " is '" + name + "', " +
                  (found ? "which comes later" : "which is no joint of the leg") + "; " +
                  names_of(leg, index));
    return false;
  }

  void check_closure(const std::string& path, const RobotLeg& leg, const LegClosure& closure) {
    const auto require_joint = [&](const std::string& field, const std::string& name) {
      if (joint_index(leg, name)) return;
      findings_.add(path + field + " is '" + name + "', which is no joint of the leg; " +
                    names_of(leg, leg.joints.size()));
    };
    if (!closure.joint.empty()) require_joint(".joint", closure.joint);
    if (closure.on == LegClosure::On::joint) require_joint(".on_joint", closure.on_joint);
    findings_.finite(path + ".at", closure.at, "m");
    findings_.finite(path + ".turned", closure.turned, "rad");
    findings_.finite(path + ".on", closure.on_at, "m");
    findings_.finite(path + ".on_turned", closure.on_turned, "rad");
    if (!robot_.moves.planar) return;
    findings_.require(closure.at.z() == 0.0 && (closure.on_at.z() == 0.0),
                      path + " leaves the plane z = 0 in which such a robot moves");
  }

  void check_drives() {
    int count = static_cast<int>(robot_.drive_map.size());
    std::set<bool> sliding;
    for (const RobotLeg& leg : robot_.legs) {
      for (const LegJoint& joint : leg.joints) {
        if (!joint.drive) continue;
        if (!robot_.drive_map.empty())
          return findings_.add("drive_map takes the place of the drives of joints; '" + joint.name +
                               "' has one");
        ++count;
        sliding.insert(slides(joint.kind));
      }
    }
    for (std::size_t i = 0; i < robot_.drive_map.size(); ++i)
      check_sum("drive_map[" + std::to_string(i) + "]", robot_.drive_map[i], sliding);
    const int n = robot_.moves.space.dimension();
    if (count == 0) return findings_.add("legs has no joint with a drive");
    if (count < n)
      findings_.add("legs has " + std::to_string(count) + " drives for " + std::to_string(n) +
                    " coordinates");
    if (count > max_dof)
      findings_.add("legs has " + std::to_string(count) + " drives; at most " + std::to_string(max_dof) +
                    " fit");
    findings_.require(sliding.size() < 2,
                      "legs has drives that turn and drives that slide; all must move alike");
  }

  void check_sum(const std::string& path, const DriveSum& sum, std::set<bool>& sliding) {
    if (sum.empty()) findings_.add(path + " is empty; it names the joints that the drive moves with");
    for (const auto& [name, weight] : sum) {
      findings_.finite(path + "." + name, weight);
      const std::size_t dot = name.find('.');
      std::optional<std::size_t> joint;
      const std::string digits = dot == std::string::npos || dot < 4 ? "" : name.substr(3, dot - 3);
      const bool is_number =
          !digits.empty() && digits.size() < 3 && digits.find_first_not_of("0123456789") == std::string::npos;
      const std::size_t leg = is_number ? std::stoul(digits) : 0;
      if (name.starts_with("leg") && leg >= 1 && leg <= robot_.legs.size())
        joint = joint_index(robot_.legs[leg - 1], name.substr(dot + 1));
      if (!joint) {
        findings_.add(path + "." + name + " is no joint; it is named as in leg1." +
                      (robot_.legs[0].joints.empty() ? "joint" : robot_.legs[0].joints[0].name));
        continue;
      }
      const LegJoint& of = robot_.legs[leg - 1].joints[*joint];
      findings_.require(axis_count(of.kind) == 1,
                        path + "." + name + " has several axes; a drive moves with one");
      sliding.insert(slides(of.kind));
    }
  }

  void check_measured() {
    int count = 0;
    for (const RobotLeg& leg : robot_.legs) {
      for (const LegJoint& joint : leg.joints) {
        if (!joint.measured) continue;
        ++count;
        findings_.require(
            axis_count(joint.kind) == 1,
            "legs has the joint '" + joint.name + "' measured, which has several axes; an encoder sees one");
      }
    }
    if (count > max_dof) {
      findings_.add("legs has " + std::to_string(count) + " measured joints; at most " +
                    std::to_string(max_dof) + " fit");
    }
  }

  const LegsParameters& robot_;
  Findings& findings_;
};

}  // namespace

int axis_count(LegJointKind kind) {
  if (kind == LegJointKind::universal) return 2;
  return kind == LegJointKind::spherical ? 3 : 1;
}

bool slides(LegJointKind kind) { return kind == LegJointKind::prismatic; }

std::vector<std::string> description_problems(const LegsParameters& parameters) {
  Findings findings;
  DescriptionCheck(parameters, findings).check();
  return findings.take();
}

std::vector<std::size_t> bodies_of(const RobotLeg& leg) {
  std::vector<std::size_t> bodies;
  for (const bool with_shapes : {true, false}) {
    for (std::size_t j = 0; j < leg.joints.size() && bodies.size() < 2; ++j) {
      const auto& link = leg.joints[j].link;
      if (link && link->shapes.empty() != with_shapes) bodies.push_back(j);
    }
  }
  std::sort(bodies.begin(), bodies.end());
  return bodies;
}

std::optional<std::size_t> joint_index(const RobotLeg& leg, const std::string& name) {
  for (std::size_t j = 0; j < leg.joints.size(); ++j) {
    if (leg.joints[j].name == name) return j;
  }
  return std::nullopt;
}

}  // namespace flinch
