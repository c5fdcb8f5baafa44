// Readings that contradict one another or what is believed: the likely cause is named, and right ones are not
// doubted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <numbers>

#include "identification/dynamics_calibration.h"
#include "identification/encoder_warnings.h"
#include "identification/imu_pose_calibration.h"
#include "identification/imu_warnings.h"
#include "identification/likely_scale.h"
#include "identification/motion_warnings.h"
#include "identification/pull_warnings.h"
#include "identification/torque_constant_calibration.h"
#include "systems/signals/drive_reading.h"
#include "systems/signals/force_torque_reading.h"
#include "systems/signals/imu_reading.h"
#include "systems/signals/joint_reading.h"
#include "tests/identification/recorded.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using test::edit;
using test::Simulated;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

using Doubts = std::vector<std::string>;

constexpr double degree = std::numbers::pi / 180.0;

/// A wrong log: how it differs from a right one, and what must be said.
struct Wrong {
  const char* name;
  std::function<void(Recording&)> change;
  const char* cause;
};
void PrintTo(const Wrong& wrong, std::ostream* out) { *out << wrong.name; }

std::string name_of(const testing::TestParamInfo<Wrong>& info) { return info.param.name; }

/// One recording, made once, that each test changes a copy of.
template <const char* scenario>
class Logs : public testing::TestWithParam<Wrong> {
 protected:
  static void SetUpTestSuite() { run_ = std::make_unique<Simulated>(test::simulated(scenario)); }
  static void TearDownTestSuite() { run_.reset(); }

  static Recording right() { return run_->recording; }
  static Recording wrong() {
    Recording recording = run_->recording;
    testing::TestWithParam<Wrong>::GetParam().change(recording);
    return recording;
  }
  static const SimulatedScenario& simulated() { return run_->scenario; }

 private:
  static std::unique_ptr<Simulated> run_;
};
template <const char* scenario>
std::unique_ptr<Simulated> Logs<scenario>::run_;

Wrong current(const char* name, std::function<void(JointVector&)> change, const char* cause) {
  return {name,
          [change](Recording& recording) {
            edit<DriveReading>(recording, "drives",
                               [&](std::size_t, DriveReading& reading) { change(reading.current); });
          },
          cause};
}

// ---------------------------------------------------------------- IMU

constexpr char rectangle[] = "calibration_rectangle.yaml";
using ImuLogs = Logs<rectangle>;

ImuBelief imu_belief(const SimulatedScenario& scenario) {
  ImuBelief belief;
  belief.mount = scenario.control.imu_mount;
  return belief;
}

/// Without the fit, which takes longer than all else: its values are not looked at where something is found.
Doubts imu_warnings(const Recording& recording, const SimulatedScenario& scenario) {
  Doubts ignored;
  const ImuBelief belief = imu_belief(scenario);
  return warnings_about_imu(imu_stretches(recording, *scenario.robot.robot, 0, ignored), belief,
                            ImuPoseFit());
}

Wrong imu(const char* name, std::function<void(ImuReading&)> change, const char* cause) {
  return {name,
          [change](Recording& recording) {
            edit<ImuReading>(recording, "imu", [&](std::size_t, ImuReading& reading) { change(reading); });
          },
          cause};
}

Eigen::Vector3d swapped(const Eigen::Vector3d& v) { return {v.y(), v.x(), v.z()}; }

INSTANTIATE_TEST_SUITE_P(
    Wrong, ImuLogs,
    testing::Values(
        imu(
            "accelerometer_of_other_sign", [](ImuReading& r) { r.specific_force = -r.specific_force; },
            "the accelerometer has the other sign"),
        imu(
            "accelerometer_in_g", [](ImuReading& r) { r.specific_force /= 9.81; }, "it is in g"),
        imu(
            "accelerometer_in_mg", [](ImuReading& r) { r.specific_force *= 1000.0 / 9.81; }, "it is in mg"),
        imu(
            "gravity_removed", [](ImuReading& r) { r.specific_force.z() -= 9.81; }, "has removed gravity"),
        imu(
            "gyroscope_in_degrees", [](ImuReading& r) { r.angular_velocity /= degree; }, "it is in deg/s"),
        imu(
            "gyroscope_taken_for_degrees", [](ImuReading& r) { r.angular_velocity *= degree; },
            "it is in rad/s"),
        imu(
            "gyroscope_in_rpm", [](ImuReading& r) { r.angular_velocity *= 30.0 / std::numbers::pi; },
            "it is in rpm"),
        imu(
            "gyroscope_of_other_sign", [](ImuReading& r) { r.angular_velocity = -r.angular_velocity; },
            "the gyroscope has the other sign"),
        imu(
            "axes_swapped",
            [](ImuReading& r) {
              r.specific_force = swapped(r.specific_force);
              r.angular_velocity = swapped(r.angular_velocity);
            },
            "is"),
        imu(
            "accelerometer_mirrored", [](ImuReading& r) { r.specific_force.y() = -r.specific_force.y(); },
            "not right-handed: what is read as y is -y")),
    name_of);

TEST_P(ImuLogs, AreDoubtedForTheirCause) {
  EXPECT_THAT(imu_warnings(wrong(), simulated()), Contains(HasSubstr(GetParam().cause)));
}

TEST_F(ImuLogs, ThatAreRightAreNotDoubted) {
  const Recording recording = right();
  EXPECT_THAT(calibrate_imu_pose(*simulated().robot.robot, simulated().control.imu_mount,
                                 {{{"run.h5", ""}, &recording}})
                  .contradictions,
              IsEmpty());
}

TEST_F(ImuLogs, MayHaveNoBiasAndNoDelayThatNoSensorHas) {
  Doubts ignored;
  const std::vector<ImuStretch> stretches = imu_stretches(right(), *simulated().robot.robot, 0, ignored);
  ImuPoseFit fit;
  fit.pose.accelerometer_bias.z() = 2.5;
  EXPECT_THAT(warnings_about_imu(stretches, imu_belief(simulated()), fit),
              Contains(HasSubstr("the bias of the accelerometer would be 2.5 m/s^2")));
  fit.pose.accelerometer_bias.z() = 0.0;
  fit.pose.delay = 0.01;
  EXPECT_THAT(warnings_about_imu(stretches, imu_belief(simulated()), fit),
              Contains(HasSubstr("the IMU would be 10.0 ms late")));
}

// ---------------------------------------------------------------- pulls

constexpr char pulls[] = "calibration_pulls.yaml";
using PullLogs = Logs<pulls>;

Doubts pull_warnings(const Recording& recording, const SimulatedScenario& scenario) {
  Doubts ignored;
  return warnings_about_pulls(
      pull_windows(recording, *scenario.robot.robot, scenario.mountings, 0, 0, ignored),
      scenario.control.drive_torque.torque_constant);
}

/// Told in the base frame.
Wrong instrument(const char* name, std::function<void(ForceTorqueReading&)> change, const char* cause) {
  return {name,
          [change](Recording& recording) {
            edit<ForceTorqueReading>(recording, "force_torque",
                                     [&](std::size_t, ForceTorqueReading& reading) { change(reading); });
          },
          cause};
}

INSTANTIATE_TEST_SUITE_P(
    Wrong, PullLogs,
    testing::Values(current(
                        "current_of_drive_2_of_other_sign", [](JointVector& i) { i[1] = -i[1]; },
                        "the current of drive 2 has the other sign"),
                    current(
                        "currents_in_mA", [](JointVector& i) { i *= 1000.0; }, "they are in mA"),
                    current(
                        "currents_taken_for_mA", [](JointVector& i) { i *= 1e-3; },
                        "they are in A and were taken for mA"),
                    current(
                        "current_of_drive_3_in_peak_values",
                        [](JointVector& i) { i[2] *= std::numbers::sqrt2; },
                        "the torque constant of drive 3 would be 0.7"),
                    current(
                        "currents_in_peak_values", [](JointVector& i) { i *= std::numbers::sqrt2; },
                        "they are peak values"),
                    instrument(
                        "force_of_other_sign",
                        [](ForceTorqueReading& r) {
                          r.force_in_base = -r.force_in_base;
                          r.moment_in_base = -r.moment_in_base;
                        },
                        "the instrument says has the other sign"),
                    instrument(
                        "force_in_kgf",
                        [](ForceTorqueReading& r) {
                          r.force_in_base /= 9.80665;
                          r.moment_in_base /= 9.80665;
                        },
                        "they are in kgf and were taken for N"),
                    instrument(
                        "axes_swapped_in_the_base_frame",
                        [](ForceTorqueReading& r) {
                          r.force_in_base = swapped(r.force_in_base);
                          r.moment_in_base = -swapped(r.moment_in_base);
                        },
                        "axes of the base frame in which it tells its forces are swapped or mirrored")),
    name_of);

TEST_P(PullLogs, AreDoubtedForTheirCause) {
  EXPECT_THAT(pull_warnings(wrong(), simulated()), Contains(HasSubstr(GetParam().cause)));
}

TEST_F(PullLogs, ThatAreRightAreNotDoubted) { EXPECT_THAT(pull_warnings(right(), simulated()), IsEmpty()); }

TEST_F(PullLogs, MakeTheirCalibrationDoubtful) {
  Recording recording = right();
  edit<DriveReading>(recording, "drives",
                     [](std::size_t, DriveReading& reading) { reading.current[0] = -reading.current[0]; });
  const TorqueConstantBelief belief{.robot = simulated().robot.robot.get(),
                                    .drives = simulated().robot.drives,
                                    .constant = simulated().control.drive_torque.torque_constant};
  const CalibrationResult result =
      calibrate_torque_constants(belief, {{{"run.h5", ""}, &recording, simulated().mountings}}, {});
  EXPECT_THAT(result.contradictions, Contains(HasSubstr("the current of drive 1 has the other sign")));
  for (const CalibratedParameter& parameter : result.parameters) {
    if (parameter.identifiable || !parameter.before) continue;
    EXPECT_EQ(parameter.value, *parameter.before) << "what is not identifiable is as believed before";
    EXPECT_FALSE(parameter.deviation) << "and has no deviation";
  }
}

// ---------------------------------------------------------------- motion

constexpr char excitation[] = "calibration_excitation.yaml";
using MotionLogs = Logs<excitation>;

DynamicsBelief motion_belief(const SimulatedScenario& scenario) {
  return {.robot = scenario.robot.robot.get(),
          .drives = scenario.robot.drives,
          .constant = scenario.control.drive_torque.torque_constant};
}

/// Without the fit.
Doubts motion_warnings(const Recording& recording, const SimulatedScenario& scenario) {
  const ParallelRobot& robot = *scenario.robot.robot;
  Doubts contradictions = warnings_about_encoders(recording, robot), ignored;
  const DynamicsRows rows = dynamics_rows(
      recording, robot, *DynamicParameters::of(robot),
      {scenario.control.drive_torque.torque_constant, scenario.robot.drives.torque_delay}, 0, ignored);
  for (const std::string& doubt : warnings_about_motion(rows, robot.drives()))
    contradictions.push_back(doubt);
  return contradictions;
}

Wrong joints(const char* name, std::function<void(JointReading&)> change, const char* cause) {
  return {name,
          [change](Recording& recording) {
            edit<JointReading>(recording, "joints",
                               [&](std::size_t, JointReading& reading) { change(reading); });
          },
          cause};
}

INSTANTIATE_TEST_SUITE_P(
    Wrong, MotionLogs,
    testing::Values(current(
                        "current_of_drive_1_of_other_sign", [](JointVector& i) { i[0] = -i[0]; },
                        "the current of drive 1 has the other sign"),
                    current(
                        "all_currents_of_other_sign", [](JointVector& i) { i = -i; },
                        "the currents of all drives have the other sign"),
                    current(
                        "currents_in_mA", [](JointVector& i) { i *= 1000.0; }, "they are in mA"),
                    current(
                        "currents_in_peak_values", [](JointVector& i) { i *= std::numbers::sqrt2; },
                        "they are peak values"),
                    joints(
                        "zero_of_drive_2_off", [](JointReading& r) { r.active[1] += 1.1 * degree; },
                        "if the encoder of drive 2 says -1.1"),
                    joints(
                        "zero_of_passive_joint_1_off", [](JointReading& r) { r.passive[0] -= 1.0 * degree; },
                        "if the encoder of passive joint 1 says +")),
    name_of);

TEST_P(MotionLogs, AreDoubtedForTheirCause) {
  EXPECT_THAT(motion_warnings(wrong(), simulated()), Contains(HasSubstr(GetParam().cause)));
}

TEST_F(MotionLogs, ThatAreRightAreNotDoubted) {
  const Recording recording = right();
  EXPECT_THAT(
      calibrate_dynamics(motion_belief(simulated()), {{{"run.h5", ""}, &recording}}, {}).contradictions,
      IsEmpty());
}

/// With so many amperes more in the current of each drive at a time [s].
void add_current(Recording& recording, const std::function<JointVector(double time)>& more) {
  edit<DriveReading>(recording, "drives", [&](std::size_t k, DriveReading& reading) {
    reading.current += more(to_seconds(Time(recording.time_ns[k])));
  });
}

CalibrationResult dynamics_of(const Recording& recording, const SimulatedScenario& scenario) {
  return calibrate_dynamics(motion_belief(scenario), {{{"run.h5", ""}, &recording}}, {});
}

/// A hand that pushes with some 20 N for a second and a half.
TEST_F(MotionLogs, InWhichSomethingTouchesTheRobotAreDoubtedWithTheTime) {
  Recording recording = right();
  std::erase_if(recording.signals, [](const Signal& signal) { return signal.path == "truth"; });
  add_current(recording, [](double time) {
    return JointVector(Eigen::Vector3d(0.9, -0.5, 0.2) * (time > 8.0 && time < 9.5 ? 1.0 : 0.0));
  });
  const CalibrationResult result = dynamics_of(recording, simulated());
  EXPECT_THAT(result.contradictions,
              Contains(HasSubstr("something touches the robot from about 8.0 to 9.5 s")));
}

TEST_F(MotionLogs, InWhichACurrentDriftsAreWarnedOf) {
  Recording recording = right();
  const auto drifts = HasSubstr("the torque of drive 2 changes by +");
  EXPECT_THAT(dynamics_of(recording, simulated()).warnings, Not(Contains(HasSubstr("changes by"))));
  add_current(recording, [](double time) { return JointVector(Eigen::Vector3d(0.0, 0.02 * time, 0.0)); });
  EXPECT_THAT(dynamics_of(recording, simulated()).warnings, Contains(drifts));
}

TEST_F(MotionLogs, OfTooFewReadingsASecondAreRefused) {
  const Recording all = right();
  Recording slow;
  slow.attributes = all.attributes;
  slow.period = 50 * all.period;
  for (const Signal& signal : all.signals) slow.signals.push_back({signal.path, signal.layout, {}});
  for (std::size_t k = 0; k < all.samples(); k += 50) {
    slow.time_ns.push_back(all.time_ns[k]);
    for (std::size_t i = 0; i < all.signals.size(); ++i) {
      const auto row =
          all.signals[i].rows.begin() + static_cast<std::ptrdiff_t>(k * all.signals[i].layout.numbers);
      slow.signals[i].rows.insert(slow.signals[i].rows.end(), row,
                                  row + static_cast<std::ptrdiff_t>(all.signals[i].layout.numbers));
    }
  }
  EXPECT_THAT(test::problems_of([&] { dynamics_of(slow, simulated()); }),
              Contains(HasSubstr("there are 20 readings a second; a fit of dynamics needs 55 at least")));
}

TEST_F(MotionLogs, OfADriveThatIsAFullTurnOffAreWarnedOf) {
  Recording recording = right();
  EXPECT_THAT(warnings_about_turns(recording, *simulated().robot.robot), IsEmpty());
  edit<JointReading>(recording, "joints",
                     [](std::size_t, JointReading& reading) { reading.active[0] += 2.0 * std::numbers::pi; });
  EXPECT_THAT(warnings_about_turns(recording, *simulated().robot.robot),
              Contains(HasSubstr("the encoder of drive 1 says")));
}

// ---------------------------------------------------------------- scales

TEST(LikelyCause, IsThatWhoseFactorIsWithinSixPercent) {
  EXPECT_THAT(*likely_cause(1020.0, causes_of_currents()), HasSubstr("in mA"));
  EXPECT_EQ(likely_cause(1.0, causes_of_currents()), std::nullopt);
  EXPECT_EQ(likely_cause(-1000.0, causes_of_currents()), std::nullopt);
  EXPECT_THAT(*likely_cause(57.0, causes_of_gyroscopes()), HasSubstr("deg/s"));
  EXPECT_THAT(*likely_cause(0.1, causes_of_accelerometers()), HasSubstr("in g"));
}

}  // namespace
}  // namespace flinch
