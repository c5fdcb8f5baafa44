#include "experiments/recorded/judged_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iomanip>

#include "calibration/contact_free_motion.h"
#include "calibration/contact_free_peaks.h"
#include "experiments/recorded/completed_readings.h"
#include "import/imported_recording.h"
#include "systems/signals/drive_reading.h"
#include "systems/signals/joint_reading.h"
#include "systems/signals/wrench_estimate.h"
#include "tests/identification/recorded.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

/// A run with a contact, and the same as another program would have logged every so many milliseconds.
class JudgedLogs : public ::testing::Test {
 protected:
  JudgedLogs() : run(test::simulated("platform_collision.yaml")) {}

  std::shared_ptr<const Recording> logged(std::size_t every) const {
    std::ofstream out(place / "log.csv");
    out << "t,q1,q2,q3,p1,p2,p3,i1,i2,i3\n" << std::setprecision(17);
    const auto joints = read<JointReading>(run.recording, "joints");
    const auto drives = read<DriveReading>(run.recording, "drives");
    for (std::size_t k = 0; k < run.recording.samples(); k += every) {
      const JointReading at = joints[k];
      const DriveReading drive = drives[k];
      out << k / 1000 << '.' << std::setw(3) << std::setfill('0') << k % 1000;
      for (int i = 0; i < 3; ++i) out << ',' << at.active[i];
      for (int i = 0; i < 3; ++i) out << ',' << at.passive[i];
      for (int i = 0; i < 3; ++i) {
        out << ',';
        if (drive.valid) out << drive.current[i];
      }
      out << '\n';
    }
    out.close();
    std::string mapping =
        "log: log.csv\nscenario: scenarios/platform_collision.yaml\n"
        "time: {column: t, unit: s}\ncolumns:\n";
    for (const std::string entry : {"0", "1", "2"}) {
      const std::string n = std::to_string(std::stoi(entry) + 1);
      mapping += "  - {column: q" + n + ", signal: joints.active, entry: " + entry + ", unit: rad}\n";
      mapping += "  - {column: p" + n + ", signal: joints.passive, entry: " + entry + ", unit: rad}\n";
      mapping += "  - {column: i" + n + ", signal: drives.current, entry: " + entry + ", unit: A}\n";
    }
    place.write("mapping.yaml", mapping);
    return std::make_shared<const Recording>(import_log(place / "mapping.yaml"));
  }

  double onset() const {
    const JudgedLog judged = judge_log(run.scenario, std::make_shared<const Recording>(run.recording), {});
    return judged.detections.front().at;
  }

  test::Simulated run;
  test::Workplace place;
};

/// How many estimates of a log are not those of the run, bit for bit.
std::size_t differing(const test::Simulated& run, const std::shared_ptr<const Recording>& log) {
  const auto old = read<WrenchEstimate>(run.recording, "wrench");
  std::size_t seen = 0, valid = 0, count = 0;
  const auto wants = [](const std::string& path) { return path == "wrench"; };
  const auto see = [&](const Recording& latest) {
    const auto estimates = read<WrenchEstimate>(latest, "wrench");
    for (std::size_t k = 0; k < latest.samples(); ++k, ++seen) {
      const WrenchEstimate now = estimates[k], then = old[seen];
      valid += now.valid ? 1 : 0;
      const bool same =
          now.valid == then.valid && now.wrench_in_base.size() == then.wrench_in_base.size() &&
          std::memcmp(now.wrench_in_base.data(), then.wrench_in_base.data(),
                      static_cast<std::size_t>(now.wrench_in_base.size()) * sizeof(double)) == 0;
      count += same ? 0 : 1;
    }
  };
  judge_log(run.scenario, log, {}, {wants, see});
  EXPECT_EQ(seen, run.recording.samples());
  EXPECT_GT(valid, seen / 2);
  return count;
}

TEST_F(JudgedLogs, GiveTheEstimatesOfTheRunTheyComeFromBitForBit) {
  EXPECT_EQ(differing(run, std::make_shared<const Recording>(run.recording)), 0U);
  // The log tells joints and currents; until when the brakes were closed, only the run does.
  Recording log = *logged(1);
  log.signals.push_back(run.recording.signal("status"));
  EXPECT_EQ(differing(run, std::make_shared<const Recording>(log)), 0U);
}

TEST_F(JudgedLogs, NoticeWithinASampleOfTheRun) {
  const double at = onset();
  for (const std::size_t every : {1U, 4U, 10U}) {
    const JudgedLog judged = judge_log(run.scenario, logged(every), {});
    ASSERT_FALSE(judged.detections.empty()) << every;
    EXPECT_NEAR(judged.detections.front().at, at, 1e-3 * static_cast<double>(every) + 1e-9) << every;
    EXPECT_GT(judged.pose_known, 0.98) << every;
  }
}

TEST_F(JudgedLogs, CountFalseAlarmsAndDelays) {
  const auto log = logged(1);
  const double at = onset();
  const JudgedLog judged =
      judge_log(run.scenario, log, {{{0.0, at - 0.1}, {at - 0.05, at + 0.05}}, {at + 0.1}});
  const std::string by = judged.by.front();
  EXPECT_EQ(by, "momentum_observer");
  EXPECT_EQ(judged.false_alarms.at(by), 1U);
  EXPECT_NEAR(judged.free_seconds, at, 1e-9);
  EXPECT_FALSE(judged.delays.at(by).front().has_value());
  const JudgedLog timely = judge_log(run.scenario, log, {{}, {at - 0.02}});
  EXPECT_NEAR(*timely.delays.at(by).front(), 0.02, 1e-9);
  EXPECT_THAT(test::problems_of([&] {
                judge_log(run.scenario, log, {{{0.0, 1.0}}, {0.5}});
              }),
              Contains(HasSubstr("which --free says is free")));
  EXPECT_THAT(test::problems_of([&] {
                judge_log(run.scenario, log, {{}, {99.0}});
              }),
              Contains(HasSubstr("--contact: 99.000000 s is not within it")));
}

/// A robot file may ask for passive encoders, and a log need not have them.
TEST_F(JudgedLogs, NeedNoPassiveAngles) {
  logged(1);
  std::string text = test::bytes_of(place / "mapping.yaml"), kept;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin) + 1;
    const std::string line = text.substr(begin, end - begin);
    if (line.find("joints.passive") == std::string::npos) kept += line;
    begin = end;
  }
  place.write("mapping.yaml", kept);
  const auto log = std::make_shared<const Recording>(import_log(place / "mapping.yaml"));
  EXPECT_GT(judge_log(run.scenario, log, {}).pose_known, 0.98);
}

/// A robot without passive encoders that stands with an elbow on one side and then on the other.
TEST_F(JudgedLogs, GoOnBeyondTheFoldOfALeg) {
  const Scenario scenario = read_scenario(place / "scenarios/five_bar_collision.yaml");
  const ParallelRobot& robot = *scenario.robot.robot;
  WorkingMode mode = robot.home_working_mode();
  mode[1] = 1 - mode[1];  // where the log begins
  place.write("log.csv", "");
  std::ofstream out(place / "log.csv");
  out << "t,q1,q2\n" << std::setprecision(17);
  for (int k = 0; k < 400; ++k) {
    if (k == 250) mode[0] = 1 - mode[0];
    const JointVector active = robot.inverse_kinematics(robot.home_pose(), mode).joints.active;
    out << 1e-3 * k << ',' << active[0] << ',' << active[1] << '\n';
  }
  out.close();
  place.write("mapping.yaml",
              "log: log.csv\nscenario: scenarios/five_bar_collision.yaml\n"
              "time: {column: t, unit: s}\ncolumns:\n"
              "  - {column: q1, signal: joints.active, entry: 0, unit: rad}\n"
              "  - {column: q2, signal: joints.active, entry: 1, unit: rad}\n");
  const JudgedLog judged =
      judge_log(scenario, std::make_shared<const Recording>(import_log(place / "mapping.yaml")), {});
  EXPECT_GT(judged.pose_known, 0.98);
  EXPECT_TRUE(judged.folds_from_home);
  ASSERT_EQ(judged.folds.size(), 1U);
  EXPECT_EQ(judged.folds[0].leg, 0);
  EXPECT_NEAR(judged.folds[0].at, 0.25, 1e-9);
}

/// The estimates and loads of a log are those of the run that it came from, so its residuals are as well.
TEST_F(JudgedLogs, GiveTheResidualsOfWhichTheFusedDetectorIsMade) {
  const test::Simulated free = test::simulated(
      "random_motion.yaml", {{"duration_s: 36", "duration_s: 4"}, {"duration_s: 34", "duration_s: 3"}});
  const Recording estimates =
      estimates_of_log(free.scenario, std::make_shared<const Recording>(free.recording));
  for (const char* const path : {"load_fused_detector", "wrench_disturbance_filter", "wrench_imu_residual"}) {
    const std::vector<internal::Number>& of_log = estimates.signal(path).rows;
    const std::vector<internal::Number>& of_run = free.recording.signal(path).rows;
    ASSERT_EQ(of_log.size(), of_run.size()) << path;
    EXPECT_EQ(std::memcmp(of_log.data(), of_run.data(), of_run.size() * sizeof of_run.front()), 0) << path;
  }
  const std::vector<bool> moves = moving_samples(estimates);
  EXPECT_FALSE(moves.front());
  EXPECT_GT(std::count(moves.begin(), moves.end(), true), 2500);
}

TEST_F(JudgedLogs, GiveThePeaksFromWhichThresholdsCome) {
  const test::Simulated free = test::simulated("square.yaml");
  const ConfigurationSpace& space = free.scenario.robot.robot->space();
  const Recording estimates =
      estimates_of_log(free.scenario, std::make_shared<const Recording>(free.recording));
  ASSERT_EQ(estimates.samples(), free.recording.samples());
  const std::vector<EstimatorPeaks> peaks =
      contact_free_peaks(estimates, moving_samples(estimates), space, 500ms);
  const std::vector<EstimatorPeaks> of_run = contact_free_peaks(free.recording, space, 500ms);
  ASSERT_EQ(peaks.size(), of_run.size());
  EXPECT_EQ(peaks.front().estimator, of_run.front().estimator);
  ASSERT_GE(peaks.front().force.size(), of_run.front().force.size() - 1);
  EXPECT_NEAR(*std::max_element(peaks.front().force.begin(), peaks.front().force.end()),
              *std::max_element(of_run.front().force.begin(), of_run.front().force.end()), 0.1);
  EXPECT_TRUE(contact_free_peaks(estimates, std::vector<bool>(estimates.samples(), false), space, 500ms)
                  .front()
                  .force.empty());
}

}  // namespace
}  // namespace flinch
