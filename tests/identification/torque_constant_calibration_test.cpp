#include "identification/torque_constant_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "systems/signals/drive_reading.h"
#include "systems/signals/force_torque_reading.h"
#include "systems/signals/joint_reading.h"
#include "tests/identification/recorded.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using test::edit;
using test::Simulated;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const Eigen::Vector3d true_constant(6.021, 6.6116, 6.7315);  // of the plant, [PAR]

TorqueConstantBelief belief(const Simulated& from) {
  return {.robot = from.scenario.robot.robot.get(),
          .drives = from.scenario.robot.drives,
          .constant = from.scenario.control.drive_torque.torque_constant};
}

PullRecording pulls(const Simulated& from) {
  return {{"run.h5", ""}, &from.recording, from.scenario.mountings};
}

CalibrationResult calibrated(const Simulated& from) {
  return calibrate_torque_constants(belief(from), {pulls(from)}, {});
}

/// Pulls at three bodies only, for what does not depend on how many there are.
Simulated short_pulls() {
  const std::string rest = "force_x_N: [70, -40, -40, 0], force_y_N: [0, 60, -60, 70]}\n";
  return test::simulated("calibration_pulls.yaml",
                         {{"duration_s: 46", "duration_s: 20"},
                          {"body: leg1_link2", "body: leg2_link1"},
                          {"body: leg2_link1, position_m: [0.35, 0.03], start_s: 13.5",
                           "body: leg3_link1, position_m: [0.35, 0.03], start_s: 13.5"}});
}

TEST(TorqueConstants, OfTheSimulatedBenchAreFoundFromPullsAtAllBodies) {
  const Simulated run = test::simulated("calibration_pulls.yaml");
  const Simulated second = test::simulated("calibration_pulls_second.yaml");
  const CalibrationResult got = calibrate_torque_constants(belief(run), {pulls(run)}, {pulls(second)});
  for (int i = 0; i < 3; ++i) {
    const CalibratedParameter& constant = got.parameters[static_cast<std::size_t>(i)];
    EXPECT_EQ(constant.name, "drives.torque_constant_Nm_per_A[" + std::to_string(i) + "]");
    EXPECT_TRUE(constant.identifiable);
    EXPECT_NEAR(constant.value, true_constant[i], 0.005 * true_constant[i]);
    EXPECT_NEAR(constant.value, true_constant[i], 2.0 * *constant.deviation);
    EXPECT_EQ(constant.before, 6.1);
  }
  EXPECT_LT(got.residual_after, 0.5 * got.residual_before);
  EXPECT_LT(got.residual_after, 1.1) << "[ICRA23] III-B";
  EXPECT_TRUE(got.warnings.empty()) << got.warnings.front();
  ASSERT_EQ(got.validation.size(), 7U);
  for (const BoxNumbers& box : got.validation) {
    EXPECT_GT(box.low, -10.0) << box.name << ", [ICRA23] Fig. 4b";
    EXPECT_LT(box.high, 10.0) << box.name;
  }
}

TEST(BadPulls, ThatAreTooShortAreRefused) {
  Simulated run = short_pulls();
  edit<ForceTorqueReading>(run.recording, "force_torque",
                           [](std::size_t k, ForceTorqueReading& reading) { reading.valid = k < 2000; });
  EXPECT_THAT(test::problems_of([&] { calibrated(run); }), Contains(HasSubstr("too short")));
}

TEST(BadPulls, WithoutTheInstrumentAreRefused) {
  Simulated run = short_pulls();
  std::erase_if(run.recording.signals, [](const Signal& signal) { return signal.path == "force_torque"; });
  EXPECT_THAT(test::problems_of([&] { calibrated(run); }),
              ElementsAre(HasSubstr("run.h5: there is no signal 'force_torque'")));
}

TEST(BadPulls, OfAScenarioWithoutPullsAreRefused) {
  Simulated run = short_pulls();
  run.scenario.mountings.clear();
  EXPECT_THAT(test::problems_of([&] { calibrated(run); }), ElementsAre(HasSubstr("has no 'pulls'")));
}

TEST(BadPulls, ThatDoNotLoadADriveAreRefused) {
  Simulated run = short_pulls();
  for (InstrumentMounting& mounting : run.scenario.mountings) mounting.body = BodyId::link1(0).index();
  EXPECT_THAT(test::problems_of([&] { calibrated(run); }), Contains(HasSubstr("drive 2 is not excited")));
}

TEST(BadPulls, WithSwappedDrivesAreRefused) {
  Simulated run = short_pulls();
  edit<DriveReading>(run.recording, "drives", [](std::size_t, DriveReading& reading) {
    std::swap(reading.current[0], reading.current[1]);
  });
  EXPECT_THAT(test::problems_of([&] { calibrated(run); }),
              Contains(HasSubstr("what pulls at drive 1 is answered by the current of drive 2")));
}

TEST(BadPulls, WithSwappedEncodersAreRefused) {
  Simulated run = short_pulls();
  edit<JointReading>(run.recording, "joints",
                     [](std::size_t, JointReading& reading) { reading.active[0] += 2.5; });
  EXPECT_THAT(test::problems_of([&] { calibrated(run); }), Contains(HasSubstr("the encoders fit no pose")));
}

TEST(BadPulls, OfASaturatedInstrumentAreNamedAndLeftOut) {
  Simulated run = test::simulated("calibration_pulls.yaml");
  // The instrument clips in its own axes: take those of the platform, which hardly turns.
  edit<ForceTorqueReading>(run.recording, "force_torque", [](std::size_t k, ForceTorqueReading& reading) {
    if (k > 39500) reading.force_in_base = reading.force_in_base.cwiseMin(45.0).cwiseMax(-45.0);
  });
  const CalibrationResult got = calibrated(run);
  EXPECT_THAT(got.warnings, Contains(HasSubstr("pulls[6], platform: the instrument is saturated")));
  for (int i = 0; i < 3; ++i) {
    const CalibratedParameter& constant = got.parameters[static_cast<std::size_t>(i)];
    EXPECT_NEAR(constant.value, true_constant[i], 3.0 * *constant.deviation);
  }
}

TEST(BadPulls, WithASaturatedCurrentAreNamedAndUsedWithoutIt) {
  Simulated run = test::simulated("calibration_pulls.yaml");
  test::saturate_current(run.recording, 1, 0.6);
  const CalibrationResult got = calibrated(run);
  EXPECT_THAT(got.warnings, Contains(HasSubstr("run.h5: the current of drive 2 is saturated at")));
  for (int i = 0; i < 3; ++i) {
    const CalibratedParameter& constant = got.parameters[static_cast<std::size_t>(i)];
    EXPECT_NEAR(constant.value, true_constant[i], 3.0 * *constant.deviation);
  }
}

TEST(BadPulls, WithoutCurrentsAreRefused) {
  Simulated run = short_pulls();
  edit<DriveReading>(run.recording, "drives",
                     [](std::size_t, DriveReading& reading) { reading.valid = false; });
  EXPECT_THAT(test::problems_of([&] { calibrated(run); }),
              Contains(HasSubstr("the current of drive 1 is missing in 100 % of the samples")));
}

void expect_true_constants(const CalibrationResult& got) {
  for (int i = 0; i < 3; ++i) {
    const CalibratedParameter& constant = got.parameters[static_cast<std::size_t>(i)];
    EXPECT_NEAR(constant.value, true_constant[i], 0.01 * true_constant[i]);
    EXPECT_NEAR(constant.value, true_constant[i], 3.0 * *constant.deviation);
  }
}

TEST(BadPulls, AtAnotherPlaceOfALinkThanIsSaidAreNamedAndHardlyUsed) {
  Simulated run = test::simulated("calibration_pulls.yaml");
  run.scenario.mountings[1].position_in_body.x() -= 0.05;
  const CalibrationResult got = calibrated(run);
  EXPECT_THAT(got.warnings, Contains(HasSubstr("pulls[1], leg1_link2: its residual is")));
  EXPECT_THAT(got.warnings, Contains(HasSubstr("the instrument sits elsewhere than 'pulls' says")));
  expect_true_constants(got);
}

TEST(BadPulls, AtAnotherPlaceOfThePlatformThanIsSaidAreNamedAndHardlyUsed) {
  Simulated run = test::simulated("calibration_pulls.yaml");
  run.scenario.mountings[6].position_in_body.x() -= 0.02;
  const CalibrationResult got = calibrated(run);
  EXPECT_THAT(got.warnings, Contains(HasSubstr("pulls[6], platform: its residual is")));
  expect_true_constants(got);
}

TEST(BadPulls, AtAnotherBodyThanIsSaidAreNamedAndHardlyUsed) {
  Simulated run = test::simulated("calibration_pulls.yaml");
  run.scenario.mountings[3].body = BodyId::link2(2).index();
  const CalibrationResult got = calibrated(run);
  EXPECT_THAT(got.warnings, Contains(HasSubstr("pulls[3], leg3_link2: its residual is")));
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(got.parameters[static_cast<std::size_t>(i)].value, true_constant[i], 0.02 * true_constant[i]);
  }
}

}  // namespace
}  // namespace flinch
