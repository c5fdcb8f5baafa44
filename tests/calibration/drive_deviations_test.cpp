#include "calibration/drive_deviations.h"

#include <gtest/gtest.h>

#include <cmath>

#include "diagrams/contact_control_settings.h"
#include "systems/framework/recorded_values.h"
#include "systems/signals/wrench_estimate.h"
#include "tests/support/planar_rig.h"

namespace flinch {
namespace {

/// What the isolation's observer takes for torques of the drives, one sample each [Nm].
Recording recorded(const std::vector<Eigen::Vector3d>& torques) {
  Recording recording;
  Signal signal{isolation_signal, row_layout<WrenchEstimate>(), {}};
  signal.rows.resize(torques.size() * signal.layout.numbers);
  for (std::size_t k = 0; k < torques.size(); ++k) {
    WrenchEstimate estimate;
    estimate.valid = true;
    estimate.wrench_in_base = Eigen::Vector3d::Zero();
    estimate.drive_torque = torques[k];
    recording.time_ns.push_back(static_cast<std::int64_t>(k) * 1'000'000);
    write_row(estimate, signal.rows.data() + k * signal.layout.numbers);
  }
  recording.signals.push_back(signal);
  return recording;
}

const WrenchUncertainty hardly{.force = 1e-3, .moment = 1e-3};

JointVector deviations(const std::vector<ResidualRecording>& of, const WrenchUncertainty& least = hardly) {
  return drive_deviations(of, *test::planar_rig(), least);
}

TEST(DriveDeviations, AreTheRootMeanSquareOfWhatCountsInAllRecordings) {
  const Recording one = recorded({{1.0, 2.0, 3.0}, {100.0, 100.0, 100.0}, {-1.0, 2.0, 3.0}}),
                  other = recorded({{2.0, 0.0, 3.0}});
  const JointVector found = deviations(
      {{one, {true, false, true}, ContactControlSettings()}, {other, {true}, ContactControlSettings()}});
  ASSERT_EQ(found.size(), 3);
  EXPECT_NEAR(found[0], std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(found[1], std::sqrt(8.0 / 3.0), 1e-12);
  EXPECT_NEAR(found[2], 3.0, 1e-12);
}

// Against the wrench by which the errors of drives that are found would show.
TEST(DriveDeviations, AreNotLessThanWhatShipsAndNotToldWhereNoneIsMore) {
  const Recording one = recorded({{1e-6, 1e-6, 50.0}});
  const WrenchUncertainty ships{.force = 1.5, .moment = 0.12};
  const JointVector found = deviations({{one, {true}, ContactControlSettings()}}, ships);
  ASSERT_EQ(found.size(), 3);
  EXPECT_DOUBLE_EQ(found[2], 50.0);
  EXPECT_GT(found[0], 0.05);
  EXPECT_LT(found[0], 1.5) << "levers of the planar bench are below a metre";
  const Recording quiet = recorded({{1e-6, 1e-6, 1e-6}});
  EXPECT_EQ(deviations({{quiet, {true}, ContactControlSettings()}}, ships).size(), 0);
}

TEST(DriveDeviations, AreNotKnownWithoutSuchAnEstimateOrWhereNothingCounts) {
  Recording without = recorded({{1.0, 2.0, 3.0}});
  without.signals.clear();
  EXPECT_EQ(deviations({{without, {true}, ContactControlSettings()}}).size(), 0);
  const Recording one = recorded({{1.0, 2.0, 3.0}});
  EXPECT_EQ(deviations({{one, {false}, ContactControlSettings()}}).size(), 0);
}

}  // namespace
}  // namespace flinch
