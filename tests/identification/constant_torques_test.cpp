#include "identification/constant_torques.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Rows of two drives in two recordings, one after the other.
DynamicsRows two_recordings() {
  DynamicsRows rows;
  rows.drive = {0, 1, 0, 1, 0, 1, 0, 1};
  rows.recording = {0, 0, 0, 0, 1, 1, 1, 1};
  return rows;
}

TEST(ConstantTorques, AreTakenFromEachDriveInEachRecording) {
  Eigen::VectorXd error(8);
  error << 1.0, 10.0, 3.0, 10.0, -5.0, 0.5, -7.0, 1.5;
  const Eigen::VectorXd left = without_constants(two_recordings(), error);
  EXPECT_THAT(std::vector<double>(left.begin(), left.end()),
              ElementsAre(-1.0, 0.0, 1.0, 0.0, 1.0, -0.5, -1.0, 0.5));
}

TEST(ConstantTorques, AreToldWhereTheyAreMoreThanWhatIsLeft) {
  DynamicsFit fit;
  fit.deviation = Eigen::Vector2d(0.01, 0.02);
  fit.offset = Eigen::Vector4d(0.005, -0.01, 0.5, 0.001);
  EXPECT_THAT(notes_about_constants({"free.h5", "turned.h5"}, fit, "Nm"),
              ElementsAre(HasSubstr("turned.h5: a constant torque of 0.5, 0.001 Nm of the drives")));
  EXPECT_EQ(fit.offset_of(two_recordings(), 4), 0.5);
  EXPECT_EQ(fit.offset_of(two_recordings(), 1), -0.01);
}

}  // namespace
}  // namespace flinch
