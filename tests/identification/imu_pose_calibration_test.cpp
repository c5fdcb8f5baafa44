#include "identification/imu_pose_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "identification/imu_pose_fit.h"
#include "plant/simulated_imu.h"
#include "systems/framework/random.h"
#include "systems/signals/imu_reading.h"
#include "tests/identification/recorded.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using test::edit;
using test::Simulated;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double degree = std::numbers::pi / 180.0;

CalibrationResult calibrated(const Simulated& run) {
  return calibrate_imu_pose(*run.scenario.robot.robot, run.scenario.control.imu_mount,
                            {{{"run.h5", ""}, &run.recording}});
}

double value_of(const CalibrationResult& result, const std::string& name) {
  for (const CalibratedParameter& parameter : result.parameters) {
    if (parameter.name == name) return parameter.value;
  }
  ADD_FAILURE() << "there is no " << name;
  return 0.0;
}

void expect_found(const Simulated& run) {
  const CalibrationResult got = calibrated(run);
  const ImuMount truth = run.scenario.station.imu.mount();
  for (int i = 0; i < 3; ++i) {
    const std::string entry = "[" + std::to_string(i) + "]";
    const CalibratedParameter& position = got.parameters[static_cast<std::size_t>(i)];
    EXPECT_EQ(position.name, "control.imu_mount.position_m" + entry);
    EXPECT_EQ(position.identifiable, i < 2) << "nothing depends on the height in a plane";
    if (i < 2) {
      EXPECT_NEAR(position.value, truth.position_in_platform[i], 2e-3);
    } else {
      EXPECT_EQ(position.value, run.scenario.control.imu_mount.position_in_platform[i]);
      EXPECT_FALSE(position.deviation.has_value());
    }
    EXPECT_NEAR(value_of(got, "control.imu_mount.angles_rad" + entry), truth.angles[i], 0.1 * degree);
  }
  EXPECT_NEAR(value_of(got, "delay"), 3.5e-3, 0.3e-3);
  EXPECT_NEAR(value_of(got, "stamp_error"), 0.0, 0.3e-3);
  EXPECT_EQ(value_of(got, "control.imu_stamps.spread"), 0.0);
  EXPECT_LT(got.residual_after, 0.2 * got.residual_before);
  EXPECT_THAT(got.notes, Contains(HasSubstr("NRMSE")));
  EXPECT_THAT(got.notes, Contains(HasSubstr("position_m[2] cannot be told from this motion")));
  EXPECT_TRUE(got.warnings.empty()) << got.warnings.front();
}

// [RAL25] V-B: both mountings.
TEST(ImuPose, IsFoundAtTheFirstMounting) { expect_found(test::simulated("calibration_rectangle.yaml")); }

TEST(ImuPose, IsFoundAtTheSecondMounting) {
  expect_found(test::simulated(
      "calibration_rectangle.yaml",
      {{"plant: {realism: {like: bench, leg_inertia: 0.1, platform_inertia: 0.1, torque_constant: 0}}",
        "plant: {realism: {like: bench, leg_inertia: 0.1, platform_inertia: 0.1, torque_constant: "
        "0}}\nsensors: {imu: {position_m: [0.075, 0.054, -0.097], "
        "angles_deg: [2.2, 3.1, 2.8]}}"}},
      7));
}

// Uniform by +-0.25 and +-0.5 ms.
TEST(ImuStamps, ErrAsFarAsThePlantMakesThem) {
  for (const int jitter_us : {250, 500}) {
    for (const std::uint64_t seed : {7U, 8U}) {
      const Simulated run = test::simulated(
          "calibration_rectangle.yaml",
          {{"plant: {realism: {like: bench, leg_inertia: 0.1, platform_inertia: 0.1, torque_constant: 0}}",
            "plant: {realism: {like: bench, leg_inertia: 0.1, platform_inertia: 0.1, torque_constant: "
            "0}}\nsensors: {imu: {delay_jitter_us: " +
                std::to_string(jitter_us) + "}}"}},
          seed);
      const CalibrationResult got = calibrated(run);
      const auto spread = std::find_if(got.parameters.begin(), got.parameters.end(), [](const auto& each) {
        return each.name == "control.imu_stamps.spread";
      });
      ASSERT_NE(spread, got.parameters.end());
      EXPECT_NEAR(spread->value, 2e-6 * jitter_us, 2.5 * *spread->deviation);
      EXPECT_LT(*spread->deviation, 0.1 * spread->value);
      EXPECT_EQ(spread->belongs_to, "scenario");
    }
  }
}

TEST(ImuPose, IsFoundHoweverTheSensorIsTurned) {
  Simulated run = test::simulated("calibration_rectangle.yaml");
  edit<ImuReading>(run.recording, "imu", [](std::size_t, ImuReading& reading) {
    for (Eigen::Vector3d* v : {&reading.angular_velocity, &reading.specific_force})
      *v = {-v->y(), v->x(), v->z()};
  });
  const CalibrationResult got = calibrated(run);
  EXPECT_NEAR(value_of(got, "control.imu_mount.angles_rad[2]"), (2.3 - 90.0) * degree, 0.5 * degree);
  EXPECT_NEAR(value_of(got, "control.imu_mount.position_m[0]"), -0.005, 2e-3);
}

TEST(ImuResidual, HasTheDerivativesThatDifferencesShow) {
  const Simulated run = test::simulated("calibration_rectangle.yaml", {{"duration_s: 12", "duration_s: 3"}});
  std::vector<std::string> warnings;
  const auto stretches = imu_stretches(run.recording, *run.scenario.robot.robot, 0, warnings);
  const ImuPoseFit fit = fit_imu_pose(stretches, {});
  const auto rows = [&](const ImuPose& pose) {  // gyroscope, then accelerometer of each sample
    const ImuResiduals left = imu_residuals(stretches, pose);
    Eigen::VectorXd all(6 * left.gyroscope.rows());
    for (Eigen::Index i = 0; i < left.gyroscope.rows(); ++i) {
      all.segment<3>(6 * i) = left.gyroscope.row(i).transpose() / fit.gyroscope_deviation;
      all.segment<3>(6 * i + 3) = left.accelerometer.row(i).transpose() / fit.accelerometer_deviation;
    }
    return all;
  };
  const auto moved = [&](Eigen::Index column, double step) {
    ImuPose pose = fit.pose;
    const int axis = static_cast<int>(column % 3);
    if (column < 3) pose.R_ES = turned(pose.R_ES, step * Eigen::Vector3d::Unit(axis));
    if (column >= 3 && column < 6) pose.position[axis] += step;
    if (column >= 6 && column < 9) pose.gyroscope_bias[axis] += step;
    if (column >= 9 && column < 12) pose.accelerometer_bias[axis] += step;
    if (column == 12) pose.delay += step;
    return pose;
  };
  ASSERT_EQ(fit.linear.jacobian.cols(), 13);
  for (Eigen::Index column = 0; column < 13; ++column) {
    const double h = column == 12 ? 1e-7 : 1e-5;
    const Eigen::VectorXd difference = (rows(moved(column, h)) - rows(moved(column, -h))) / (2.0 * h);
    const double largest = std::max(1.0, difference.cwiseAbs().maxCoeff());
    EXPECT_LT((fit.linear.jacobian.col(column) - difference).cwiseAbs().maxCoeff(), 1e-6 * largest)
        << "column " << column;
  }
}

TEST(BadImuRecordings, WithoutAnImuAreRefused) {
  Simulated run = test::simulated("calibration_standstill.yaml");
  std::erase_if(run.recording.signals, [](const Signal& signal) { return signal.path == "imu"; });
  EXPECT_THAT(test::problems_of([&] { calibrated(run); }), ElementsAre("run.h5: there is no signal 'imu'"));
}

TEST(BadImuRecordings, OfAnImuThatIsSilentAreRefused) {
  Simulated run = test::simulated("calibration_standstill.yaml");
  edit<ImuReading>(run.recording, "imu", [](std::size_t, ImuReading& reading) { reading.valid = false; });
  EXPECT_THAT(test::problems_of([&] { calibrated(run); }), ElementsAre(HasSubstr("no valid reading")));
}

TEST(BadImuRecordings, AtStandstillAloneAreRefused) {
  EXPECT_THAT(test::problems_of([&] { calibrated(test::simulated("calibration_standstill.yaml")); }),
              ElementsAre(HasSubstr("the platform hardly moves")));
}

TEST(BadImuRecordings, ThatAreTooShortAreRefused) {
  EXPECT_THAT(
      test::problems_of([&] {
        calibrated(test::simulated("calibration_standstill.yaml", {{"duration_s: 5", "duration_s: 0.8"}}));
      }),
      ElementsAre(HasSubstr("no second of it is recorded")));
}

TEST(BadImuRecordings, WithoutRotationSayThatThePositionCannotBeTold) {
  const CalibrationResult got = calibrated(test::simulated(
      "five_bar_collision.yaml",
      {{"duration_s: 1.2", "duration_s: 3"}, {"x_mm: 0, y_mm: 385", "x_mm: 5000, y_mm: 385"}}));
  EXPECT_THAT(got.warnings, Contains(HasSubstr("the position of the IMU cannot be told")));
  EXPECT_FALSE(got.parameters[0].identifiable);
}

TEST(BadImuRecordings, OfASaturatedImuAreNamedAndLeftOut) {
  Simulated run = test::simulated("calibration_rectangle.yaml");
  edit<ImuReading>(run.recording, "imu", [](std::size_t, ImuReading& reading) {
    reading.specific_force = reading.specific_force.cwiseMin(11.0).cwiseMax(-11.0);
  });
  const CalibrationResult got = calibrated(run);
  EXPECT_THAT(got.warnings, Contains(HasSubstr("the IMU is saturated")));
  EXPECT_NEAR(value_of(got, "control.imu_mount.position_m[0]"), -0.005, 3e-3);
}

TEST(BadImuRecordings, WithSwappedAxesAreNamed) {
  Simulated run = test::simulated("calibration_rectangle.yaml");
  edit<ImuReading>(run.recording, "imu", [](std::size_t, ImuReading& reading) {
    std::swap(reading.specific_force.x(), reading.specific_force.y());  // left-handed
  });
  EXPECT_THAT(calibrated(run).warnings, Contains(HasSubstr("axes of the IMU are swapped")));
}

TEST(AFifthOfOutliers, MovesNoParameterOfTheImuByMoreThanItsDeviation) {
  Simulated run = test::simulated("calibration_rectangle.yaml");
  const CalibrationResult clean = calibrated(run);
  RandomGenerator random(3);
  edit<ImuReading>(run.recording, "imu", [&](std::size_t, ImuReading& reading) {
    if (random.uniform(0.0, 1.0) < 0.2) reading.specific_force.x() += random.uniform(-50.0, 50.0);
  });
  const CalibrationResult spoilt = calibrated(run);
  for (std::size_t i = 0; i < clean.parameters.size(); ++i) {
    if (!clean.parameters[i].identifiable) continue;
    EXPECT_LT(std::abs(spoilt.parameters[i].value - clean.parameters[i].value),
              *spoilt.parameters[i].deviation)
        << clean.parameters[i].name;
  }
}

}  // namespace
}  // namespace flinch
