#include "systems/robot/dynamic_parameters.h"
#include "systems/robot/five_bar.h"
#include "systems/robot/planar_rrr.h"

namespace flinch {
namespace {

constexpr double inertia_belief = 0.2;   // of the value: what drawings and a payload leave open
constexpr double platform_belief = 0.4;  // likewise, with what is mounted on it
constexpr double viscous_belief = 0.5;   // [Nm s/rad]
constexpr double coulomb_belief = 1.0;   // [Nm]

/// Where the numbers of a planar robot lie in its parameters.
template <class Robot, class Parameters>
class PlanarDynamicParameters final : public DynamicParameters {
 public:
  explicit PlanarDynamicParameters(const Parameters& robot) : robot_(robot) {
    Parameters copy = robot;
    for_each(copy, [this](const std::string& name, const char* unit, double& value, double deviation,
                          DriveLoss loss) {
      list_.push_back({name, unit, value, deviation < 0.0 ? -deviation * value : deviation, 0.0, loss});
    });
  }

  std::shared_ptr<const ParallelRobot> with(const Eigen::VectorXd& values) const override {
    Parameters robot = robot_;
    Eigen::Index next = 0;
    for_each(robot, [&](const std::string&, const char*, double& value, double, DriveLoss) {
      value = values[next++];
    });
    return std::make_shared<const Robot>(robot);
  }

  /// Of each leg p2 (p1 - p2) > p3^2: the mass matrix is positive definite in every position of the elbow.
  std::vector<Eigen::MatrixXd> must_be_definite(const Eigen::VectorXd& values) const override {
    std::vector<Eigen::MatrixXd> matrices;
    for (std::size_t i = 0; i < robot_.legs.size(); ++i) {
      const Eigen::Vector3d p = values.segment<3>(per_leg * static_cast<Eigen::Index>(i));
      matrices.push_back((Eigen::Matrix2d() << p[0] - p[1], p[2], p[2], p[1]).finished());
    }
    return matrices;
  }

 private:
  static constexpr Eigen::Index per_leg = 7;

  /// Calls visit(name, unit, value, deviation of the belief; negative: times the value, loss).
  template <class Visit>
  static void for_each(Parameters& robot, Visit&& visit) {
    constexpr DriveLoss none = DriveLoss::none;
    for (std::size_t i = 0; i < robot.legs.size(); ++i) {
      PlanarLegParameters& leg = robot.legs[i];
      const std::string at = "legs[" + std::to_string(i) + "].";
      visit(at + "base_parameters.p1_kg_m2", "kg m^2", leg.inertia.p1, -inertia_belief, none);
      visit(at + "base_parameters.p2_kg_m2", "kg m^2", leg.inertia.p2, -inertia_belief, none);
      visit(at + "base_parameters.p3_kg_m2", "kg m^2", leg.inertia.p3, -inertia_belief, none);
      visit(at + "active_friction.viscous_Nms_per_rad", "Nm s/rad", leg.active_friction.viscous,
            viscous_belief, DriveLoss::viscous);
      visit(at + "active_friction.coulomb_Nm", "Nm", leg.active_friction.coulomb, coulomb_belief,
            DriveLoss::coulomb);
      visit(at + "passive_friction.viscous_Nms_per_rad", "Nm s/rad", leg.passive_friction.viscous,
            viscous_belief, DriveLoss::viscous);
      visit(at + "passive_friction.coulomb_Nm", "Nm", leg.passive_friction.coulomb, coulomb_belief,
            DriveLoss::coulomb);
    }
    visit("platform.mass_kg", "kg", robot.platform_mass, -platform_belief, none);
    if constexpr (requires { robot.platform_inertia; }) {
      visit("platform.inertia_kg_m2", "kg m^2", robot.platform_inertia, -platform_belief, none);
    }
  }

  Parameters robot_;
};

}  // namespace

std::unique_ptr<const DynamicParameters> PlanarRrr::dynamic_parameters() const {
  return std::make_unique<const PlanarDynamicParameters<PlanarRrr, PlanarRrrParameters>>(parameters_);
}

std::unique_ptr<const DynamicParameters> FiveBar::dynamic_parameters() const {
  return std::make_unique<const PlanarDynamicParameters<FiveBar, FiveBarParameters>>(parameters_);
}

}  // namespace flinch
