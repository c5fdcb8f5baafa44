#include "identification/hexapod_dynamic_parameters.h"

#include <array>

#include "systems/robot/hexapod.h"

namespace flinch {
namespace {

constexpr double viscous_belief = 200.0;          // [N s/m]
constexpr double coulomb_belief = 20.0;           // [N]
constexpr double universal_viscous_belief = 0.1;  // [Nm s/rad]
constexpr double universal_coulomb_belief = 0.1;  // [Nm]
constexpr double mass_belief = 10.0;              // a payload [kg]
constexpr double arm_belief = 0.1;                // of its centre of mass [m]
constexpr double inertia_belief = 0.1;            // [kg m^2]
constexpr int per_leg = 4;
constexpr int of_platform = 6 * per_leg;  // mass, first moments, inertia about the origin

/// Mass, mass times centre of mass, and inertia about the frame's origin (xx, yy, zz, xy, xz, yz): motion
/// depends on these linearly.
using Moments = Eigen::Matrix<double, 10, 1>;

Moments moments_of(const RigidBodyInertia& body) {
  const Eigen::Matrix3d I = about_origin(body);
  Moments moments;
  moments << body.mass, body.mass * body.centre_of_mass, I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2);
  return moments;
}

RigidBodyInertia body_of(const Moments& m) {
  RigidBodyInertia body;
  body.mass = m[0];
  body.centre_of_mass = m.segment<3>(1) / m[0];
  const Eigen::Matrix3d S = cross_matrix(body.centre_of_mass);
  body.inertia << m[4], m[7], m[8], m[7], m[5], m[9], m[8], m[9], m[6];
  body.inertia += body.mass * S * S;
  return body;
}

class HexapodDynamicParameters final : public DynamicParameters {
 public:
  explicit HexapodDynamicParameters(const HexapodParameters& robot) : robot_(robot) {
    for (std::size_t i = 0; i < robot.legs.size(); ++i) {
      const HexapodLeg& leg = robot.legs[i];
      const std::string at = "legs[" + std::to_string(i) + "].";
      list_.push_back(
          {at + "drive_friction.viscous_Ns_per_m", "N s/m", leg.drive_friction.viscous, viscous_belief});
      list_.push_back({at + "drive_friction.coulomb_N", "N", leg.drive_friction.coulomb, coulomb_belief});
      list_.push_back({at + "universal_friction.viscous_Nms_per_rad", "Nm s/rad",
                       leg.universal_friction.viscous, universal_viscous_belief});
      list_.push_back({at + "universal_friction.coulomb_Nm", "Nm", leg.universal_friction.coulomb,
                       universal_coulomb_belief});
    }
    static constexpr std::array names = {
        "mass", "first_moment_x", "first_moment_y", "first_moment_z", "I_xx",
        "I_yy", "I_zz",           "I_xy",           "I_xz",           "I_yz"};
    const Moments moments = moments_of(robot.platform);
    const double none = -1e9;
    for (int k = 0; k < 10; ++k) {
      const double belief = k == 0 ? mass_belief : k < 4 ? mass_belief * arm_belief : inertia_belief;
      const char* const unit = k == 0 ? "kg" : k < 4 ? "kg m" : "kg m^2";
      const bool is_positive = k == 0 || (k >= 4 && k < 7);
      list_.push_back({std::string("platform.") + names[static_cast<std::size_t>(k)], unit, moments[k],
                       belief, is_positive ? 0.0 : none});
    }
  }

  std::shared_ptr<const ParallelRobot> with(const Eigen::VectorXd& values) const override {
    HexapodParameters robot = robot_;
    for (std::size_t i = 0; i < robot.legs.size(); ++i) {
      const Eigen::Index at = per_leg * static_cast<Eigen::Index>(i);
      robot.legs[i].drive_friction = {values[at], values[at + 1]};
      robot.legs[i].universal_friction = {values[at + 2], values[at + 3]};
    }
    robot.platform = body_of(values.segment<10>(of_platform));
    return std::make_shared<const Hexapod>(robot);
  }

  /// The pseudo-inertia of the platform: mass and moments are those of a body whose density is nowhere
  /// negative, so that each moment of inertia is less than the sum of the other two. [Wensing, Kim and
  /// Slotine, IEEE RA-L 3(1), 2018, (8)]
  std::vector<Eigen::MatrixXd> must_be_definite(const Eigen::VectorXd& values) const override {
    const Moments m = values.segment<10>(of_platform);
    Eigen::Matrix3d I;
    I << m[4], m[7], m[8], m[7], m[5], m[9], m[8], m[9], m[6];
    Eigen::Matrix4d pseudo;
    pseudo.topLeftCorner<3, 3>() = 0.5 * I.trace() * Eigen::Matrix3d::Identity() - I;
    pseudo.topRightCorner<3, 1>() = m.segment<3>(1);
    pseudo.bottomLeftCorner<1, 3>() = m.segment<3>(1).transpose();
    pseudo(3, 3) = m[0];
    return {pseudo};
  }

  std::vector<FileValue> in_file(const Eigen::VectorXd& values) const override {
    std::vector<FileValue> told = DynamicParameters::in_file(values);
    told.resize(static_cast<std::size_t>(of_platform));
    const RigidBodyInertia body = body_of(values.segment<10>(of_platform));
    told.push_back({"platform.mass_kg", "kg", body.mass, of_platform});
    for (int i = 0; i < 3; ++i) {
      told.push_back({"platform.centre_of_mass_m[" + std::to_string(i) + "]", "m", body.centre_of_mass[i],
                      of_platform + 1 + i});
    }
    for (int i = 0; i < 3; ++i) {
      told.push_back({"platform.inertia_kg_m2[" + std::to_string(i) + "]", "kg m^2", body.inertia(i, i),
                      of_platform + 4 + i});
    }
    const Eigen::Vector3d products(body.inertia(0, 1), body.inertia(0, 2), body.inertia(1, 2));
    for (int i = 0; i < 3; ++i) {
      told.push_back({"platform.inertia_products_kg_m2[" + std::to_string(i) + "]", "kg m^2", products[i],
                      of_platform + 7 + i});
    }
    return told;
  }

 private:
  HexapodParameters robot_;
};

}  // namespace

std::unique_ptr<const DynamicParameters> hexapod_dynamic_parameters(const HexapodParameters& robot) {
  return std::make_unique<const HexapodDynamicParameters>(robot);
}

}  // namespace flinch
