#include "import/mapping_guess.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "import/column_roles.h"
#include "import/import_summary.h"
#include "import/mapped_log.h"
#include "import/mapping_text.h"
#include "systems/config/robot_file.h"
#include "systems/robot/kinematic_check.h"
#include "tests/support/problems_of.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string robot_file = FLINCH_SOURCE_DIR "/apps/robots/five_bar.yaml";

/// A five-bar on a circle, its angles in degrees; by its inverse kinematics.
class Guesses : public ::testing::Test {
 protected:
  Guesses() : robot(scenario_of_robot(robot_file).robot.robot) {}

  std::filesystem::path circle(const std::string& header, double per_angle, double per_time,
                               char separator = ',') const {
    std::string text = header + "\n";
    for (int k = 0; k < 2000; ++k) {
      const double phase = 2.0 * std::numbers::pi * k / 1000.0;
      Configuration pose = robot->home_pose();
      pose[0] += 0.01 * std::cos(phase) - 0.01;
      pose[1] += 0.01 * std::sin(phase);
      const JointAngles joints = robot->inverse_kinematics(pose, robot->home_working_mode()).joints;
      const auto cell = [&](double value) { text += separator + std::to_string(value); };
      text += std::to_string(per_time * k);
      for (int i = 0; i < 2; ++i) cell(per_angle * joints.active[i]);
      for (int i = 0; i < 2; ++i)
        cell((i == 0 ? 1.0 : -1.0) * std::copysign(2.0, joints.active[i] - last_[i]));
      last_ = joints.active;
      text += "\n";
    }
    return folder_.write("log.csv", text);
  }

  const test::TemporaryFolder& folder() const { return folder_; }

  std::shared_ptr<const ParallelRobot> robot;

 private:
  mutable JointVector last_ = JointVector::Zero(2);
  test::TemporaryFolder folder_;
};

std::vector<std::string> mapped(const MappingGuess& guess) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < guess.units.size(); ++i) {
    const MappedColumn& column = guess.mapping.columns[i];
    all.push_back((column.scale < 0.0 ? "-" : "") + column.column + " " + column.signal + " " +
                  std::to_string(column.entry) + " " + guess.units[i]);
  }
  return all;
}

TEST_F(Guesses, GoByNamesAndUnits) {
  const auto log =
      circle("Time [ms];phi [deg];psi [deg];iq_phi_A;iq_psi_A", 180.0 / std::numbers::pi, 1.0, ';');
  const MappingGuess guess = guess_mapping(log, robot_file);
  EXPECT_EQ(guess.mapping.clock, (LogClock{"Time [ms]", ClockUnit::ms}));
  EXPECT_THAT(mapped(guess), ElementsAre("phi [deg] joints.active 0 deg", "psi [deg] joints.active 1 deg",
                                         "iq_phi_A drives.current 0 A", "-iq_psi_A drives.current 1 A"));
  const ImportSummary summary = summary_of(MappedLog(guess.mapping));
  EXPECT_EQ(summary.rows, 2000U);
  EXPECT_NEAR(summary.rate, 1000.0, 1e-9);
  EXPECT_EQ(summary.signals.front().valid_fraction, 1.0);
}

TEST_F(Guesses, FindUnitsThatNobodyTellsByHowTheRobotCanStand) {
  const MappingGuess guess =
      guess_mapping(circle("t,q1,q2,i1,i2", 180.0 / std::numbers::pi, 1000.0), robot_file);
  EXPECT_EQ(guess.mapping.clock, (LogClock{"t", ClockUnit::us}));
  EXPECT_THAT(mapped(guess), Contains("q2 joints.active 1 deg"));
  EXPECT_THAT(mapping_text(guess, robot_file), HasSubstr("the robot can stand so in 100.0 % of the rows"));
}

TEST_F(Guesses, TakeThoseOfSeveralAnglesAsWhichTheRobotCanStand) {
  std::ifstream lines(circle("t,q1,q2,i1,i2", 1.0, 0.001));
  std::string text, line;
  while (std::getline(lines, line)) {
    const std::string turned_away = text.empty() ? "table_angle_1,table_angle_2" : "3.1416,0";
    text += turned_away + "," + line + "\n";
  }
  const MappingGuess guess = guess_mapping(folder().write("more.csv", text), robot_file);
  EXPECT_THAT(mapped(guess), ElementsAre("q1 joints.active 0 rad", "q2 joints.active 1 rad",
                                         "i1 drives.current 0 A", "-i2 drives.current 1 A"));
}

TEST_F(Guesses, SayThatATimeIsNotInTheUnitThatItSays) {
  const MappingGuess guess = guess_mapping(circle("Time [sec],q1,q2,i1,i2", 1.0, 1.0), robot_file);
  EXPECT_EQ(guess.mapping.clock.unit, ClockUnit::ms);
  EXPECT_THAT(guess.reasons, Contains(HasSubstr("though it says sec")));
}

TEST_F(Guesses, AskWhereTheLogDoesNotTell) {
  const MappingGuess guess = guess_mapping(circle("t,q1,q2,x,y", 1.0, 0.001), robot_file);
  EXPECT_THAT(guess.questions,
              Contains(HasSubstr("which columns are the currents or torques of the drives?")));
  EXPECT_THAT(test::problems_of([&] { guess_mapping(circle("a,b,c,d,e", 1.0, 0.001), robot_file); }),
              Contains(HasSubstr("no column is a time that grows")));
  EXPECT_THAT(test::problems_of([&] { guess_mapping(circle("t,b,c,d,e", 1.0, 0.001), robot_file); }),
              Contains(HasSubstr("the robot has 2 drives, and 0 columns look like their positions")));
}

TEST(ColumnRoles, AreToldByNames) {
  EXPECT_EQ(role_of("motorTorque_phi2 [Nm]", "Nm").role, ColumnRole::torque);
  EXPECT_EQ(role_of("joint_1_position", "").role, ColumnRole::position);
  EXPECT_EQ(role_of("iq_psi_A", "A").role, ColumnRole::current);
  EXPECT_EQ(role_of("gyro_x", "deg/s").role, ColumnRole::angular_velocity);
  EXPECT_EQ(role_of("angular_velocity.z", "").role, ColumnRole::angular_velocity);
  EXPECT_EQ(role_of("linear_acceleration.z", "").axis, 2);
  EXPECT_EQ(role_of("fx", "N").role, ColumnRole::force);
  EXPECT_EQ(role_of("tip_x_m", "m").role, ColumnRole::derived);
  EXPECT_EQ(role_of("passive_2", "rad").role, ColumnRole::passive_position);
  EXPECT_EQ(role_of("joints.active[1]", "rad").role, ColumnRole::position);
  EXPECT_EQ(role_of("joints.passive[0]", "rad").role, ColumnRole::passive_position);
  EXPECT_EQ(role_of("q_ref_1", "rad").role, ColumnRole::derived);
  EXPECT_EQ(role_of("battery", "").role, ColumnRole::unknown);
}

}  // namespace
}  // namespace flinch
