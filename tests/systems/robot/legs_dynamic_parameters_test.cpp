// Base parameters of robots of legs: that robots which differ from what is believed differ in them and in
// nothing else, that they are linear, and what a robot file says of them.
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "systems/config/robot_file.h"
#include "systems/framework/random.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/dynamic_parameters.h"
#include "systems/robot/legs/legs_robot.h"
#include "systems/robot/parameter_variants.h"
#include "systems/robot/robot_deviation.h"

namespace flinch {
namespace {

std::filesystem::path shipped_robot(const std::string& name) {
  return std::filesystem::path(FLINCH_SOURCE_DIR) / "apps/robots" / name;
}

class LegsDynamicParameters : public ::testing::TestWithParam<const char*> {
 protected:
  LegsDynamicParameters()
      : robot_(read_robot_file(shipped_robot(GetParam())).robot),
        parameters_(DynamicParameters::of(*robot_)) {}

  struct Instant {
    Kinematics at;
    PlatformVector acceleration;
  };
  /// Somewhere about home, where the robot is in reach.
  Instant random_instant(RandomGenerator& random) const {
    const int n = robot_->dof();
    const int translations = robot_->space().translations();
    for (;;) {
      Instant now;
      PlatformVector away(n), velocity(n);
      now.acceleration.resize(n);
      for (int i = 0; i < n; ++i) {
        const bool is_length = i < translations;
        away[i] = random.uniform(-1.0, 1.0) * (is_length ? 0.06 : 0.15);
        velocity[i] = random.uniform(-1.0, 1.0) * (is_length ? 0.8 : 2.0);
        now.acceleration[i] = random.uniform(-1.0, 1.0) * (is_length ? 8.0 : 20.0);
      }
      robot_->kinematics(robot_->space().plus(robot_->home_pose(), away), velocity, now.at);
      if (now.at.valid) return now;
    }
  }

  std::shared_ptr<const ParallelRobot> robot_;
  std::unique_ptr<const DynamicParameters> parameters_;
};

TEST_P(LegsDynamicParameters, AreLinear) {
  const ParameterVariants variants(*parameters_);
  RandomGenerator random(1);
  Eigen::VectorXd values = parameters_->believed();
  for (std::size_t j = 0; j < parameters_->list().size(); ++j)
    values[static_cast<Eigen::Index>(j)] += random.uniform(0.0, 0.5 * parameters_->list()[j].deviation);
  const auto other = parameters_->with(values);
  for (int trial = 0; trial < 20; ++trial) {
    const Instant now = random_instant(random);
    const JointVector base = model_effort(*robot_, now.at, now.acceleration);
    const Eigen::VectorXd predicted =
        base + variants.regressor(base, now.at, now.acceleration) * (values - parameters_->believed());
    const JointVector expected = model_effort(*other, now.at, now.acceleration);
    EXPECT_LT((predicted - expected).norm(), 1e-7 * (1.0 + expected.norm()));
  }
}

// Robots are drawn by other code, which scales links, friction and platform and adds a payload.
TEST_P(LegsDynamicParameters, ExplainHowRobotsDifferFromWhatIsBelieved) {
  const ParameterVariants variants(*parameters_);
  const auto p = static_cast<Eigen::Index>(variants.size());
  constexpr int states = 80;
  const int drives = robot_->drives();
  RandomGenerator random(2);
  for (int trial = 0; trial < 4; ++trial) {
    RobotDeviation deviation;
    const auto draw = [&](int count) {
      JointVector scales(count);
      for (double& scale : scales) scale = random.uniform(0.8, 1.2);
      return scales;
    };
    deviation.drive_friction_scale = draw(drives);
    deviation.passive_friction_scale = draw(robot_->legs());
    deviation.leg_inertia_scale = draw(robot_->legs());
    deviation.platform_inertia_scale = random.uniform(0.8, 1.2);
    deviation.payload = 0.3;
    const auto other = std::dynamic_pointer_cast<const ParallelRobot>(robot_->deviating(deviation));
    ASSERT_NE(other, nullptr);
    Eigen::MatrixXd Y(states * drives, p);
    Eigen::VectorXd difference(states * drives);
    for (int state = 0; state < states; ++state) {
      const Instant now = random_instant(random);
      const JointVector base = model_effort(*robot_, now.at, now.acceleration);
      Y.middleRows(state * drives, drives) = variants.regressor(base, now.at, now.acceleration);
      difference.segment(state * drives, drives) = model_effort(*other, now.at, now.acceleration) - base;
    }
    for (Eigen::Index j = 0; j < p; ++j)
      Y.col(j) *= parameters_->list()[static_cast<std::size_t>(j)].deviation;
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(Y);
    const Eigen::VectorXd values = solver.solve(difference);
    EXPECT_LT((Y * values - difference).norm(), 0.02 * difference.norm());
    // Each stands for something that the others do not.
    EXPECT_EQ(solver.setThreshold(1e-6).rank(), p);
  }
}

TEST_P(LegsDynamicParameters, OfTheRobotItselfAreTheRobot) {
  const auto same = parameters_->with(parameters_->believed());
  RandomGenerator random(3);
  const Instant now = random_instant(random);
  EXPECT_LT((model_effort(*robot_, now.at, now.acceleration) - model_effort(*same, now.at, now.acceleration))
                .norm(),
            1e-9);
  for (const Eigen::MatrixXd& S : parameters_->must_be_definite(parameters_->believed()))
    EXPECT_GT(S.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0.0);
}

TEST_P(LegsDynamicParameters, StandInTheFileOnceEach) {
  std::set<std::string> names;
  std::set<int> told;
  for (const FileValue& value : parameters_->in_file(parameters_->believed())) {
    EXPECT_TRUE(names.insert(value.name).second) << value.name;
    EXPECT_FALSE(value.mainly.empty()) << value.name;
    told.insert(value.mainly.begin(), value.mainly.end());
  }
  EXPECT_EQ(told.size(), parameters_->list().size());
}

INSTANTIATE_TEST_SUITE_P(OfEachFile, LegsDynamicParameters,
                         ::testing::Values("delta.yaml", "hexa_6rus.yaml", "linapod_6pus.yaml",
                                           "planar_3rpr.yaml", "planar_4rrr.yaml", "tricept.yaml"),
                         [](const auto& info) {
                           const std::string file = info.param;
                           return file.substr(0, file.find('.'));
                         });

// An arm of a Delta turns about one axis, and its platform does not turn.
TEST(TheParametersOfADelta, AreThoseThatItsMotionTells) {
  const RobotFile file = read_robot_file(shipped_robot("delta.yaml"));
  std::set<std::string> names;
  const auto parameters = DynamicParameters::of(*file.robot);
  for (const DynamicParameter& parameter : parameters->list()) names.insert(parameter.name);
  for (const char* const told :
       {"legs[0].joints[0].friction.viscous_Nms_per_rad", "legs[2].joints[0].friction.coulomb_Nm",
        "platform.mass", "legs[1].joints[0].link.first_moment_x", "legs[1].joints[0].link.first_moment_z",
        "legs[0].joints[1].link.mass"})
    EXPECT_TRUE(names.contains(told)) << told;
  for (const char* const not_told :
       {"platform.first_moment_x", "platform.I_zz", "legs[0].joints[0].link.mass",
        "legs[0].joints[0].link.I_xx", "legs[0].joints[1].link.I_xx"})
    EXPECT_FALSE(names.contains(not_told)) << not_told;
}

}  // namespace
}  // namespace flinch
