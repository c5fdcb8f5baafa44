#include "systems/robot/body_moments.h"
#include "systems/robot/dynamic_parameters.h"
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

class HexapodDynamicParameters final : public DynamicParameters {
 public:
  explicit HexapodDynamicParameters(const HexapodParameters& robot) : robot_(robot) {
    for (std::size_t i = 0; i < robot.legs.size(); ++i) {
      const HexapodLeg& leg = robot.legs[i];
      const std::string at = "legs[" + std::to_string(i) + "].";
      list_.push_back({at + "drive_friction.viscous_Ns_per_m", "N s/m", leg.drive_friction.viscous,
                       viscous_belief, 0.0, DriveLoss::viscous});
      list_.push_back({at + "drive_friction.coulomb_N", "N", leg.drive_friction.coulomb, coulomb_belief, 0.0,
                       DriveLoss::coulomb});
      list_.push_back({at + "universal_friction.viscous_Nms_per_rad", "Nm s/rad",
                       leg.universal_friction.viscous, universal_viscous_belief});
      list_.push_back({at + "universal_friction.coulomb_Nm", "Nm", leg.universal_friction.coulomb,
                       universal_coulomb_belief});
    }
    const BodyMoments moments = moments_of(robot.platform);
    const double none = -1e9;
    for (int k = 0; k < 10; ++k) {
      const double belief = k == 0 ? mass_belief : k < 4 ? mass_belief * arm_belief : inertia_belief;
      const bool is_positive = k == 0 || (k >= 4 && k < 7);
      list_.push_back({std::string("platform.") + moment_name(k), moment_unit(k), moments[k], belief,
                       is_positive ? 0.0 : none});
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

  std::vector<Eigen::MatrixXd> must_be_definite(const Eigen::VectorXd& values) const override {
    return {pseudo_inertia(values.segment<10>(of_platform))};
  }

  std::vector<FileValue> in_file(const Eigen::VectorXd& values) const override {
    std::vector<FileValue> told = DynamicParameters::in_file(values);
    told.resize(static_cast<std::size_t>(of_platform));
    int index = of_platform;
    for (FileValue& value : body_in_file("platform", body_of(values.segment<10>(of_platform)))) {
      value.mainly = {index++};
      told.push_back(std::move(value));
    }
    return told;
  }

 private:
  HexapodParameters robot_;
};

}  // namespace

std::unique_ptr<const DynamicParameters> Hexapod::dynamic_parameters() const {
  return std::make_unique<const HexapodDynamicParameters>(parameters_);
}

}  // namespace flinch
