// What every wrench estimator must do, whatever its method: one suite for all that flinch has, each followed
// by the detector in simulated experiments, and fed with broken readings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "diagrams/estimator_stages.h"
#include "experiments/recorded/replay.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/verdict.h"
#include "systems/robot/body_id.h"
#include "tests/experiments/simulated/fed_control.h"
#include "tests/support/allocations.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using test::FedControl;
using test::Readings;
using testing::Combine;
using testing::ValuesIn;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> names() {
  std::vector<std::string> names;
  for (const WrenchEstimator& stage : estimator_stages()) names.push_back(stage.name);
  return names;
}

/// A scenario of one of the shipped robots, controlled with the help of one estimator.
SimulatedScenario scenario(const std::string& robot, const std::string& estimator, const std::string& rest) {
  const test::Workplace place;
  const std::string source = estimator == "direct_method" ? "  accelerations: [extended_imu_ekf]\n" : "";
  place.write("scenarios/law.yaml", "robot: ../robots/" + robot + ".yaml\ncontrol:\n  estimators: [" +
                                        estimator + "]\n" + source + rest);
  return read_simulated_scenario(place / "scenarios/law.yaml");
}

// Nothing that is estimated here leads to a reaction.
const std::string never_reacts =
    "  contact_detector: {reaction_force_N: 500, reaction_moment_Nm: 100, hard_force_N: 600, hard_moment_Nm: "
    "200}\n";

/// Mean of estimate minus truth over the samples first ... last - 1, all of which must be valid.
PlatformVector mean_error(const Recording& recording, int dof, std::size_t first, std::size_t last) {
  const auto estimates = read<WrenchEstimate>(recording, "wrench");
  std::vector<std::vector<double>> truth;
  for (int i = 0; i < dof; ++i) truth.push_back(recording.column("truth", "wrench_in_base", i));
  PlatformVector mean = PlatformVector::Zero(dof);
  for (std::size_t k = first; k < last; ++k) {
    EXPECT_TRUE(estimates[k].valid) << k;
    for (int i = 0; i < dof; ++i)
      mean[i] += estimates[k].wrench_in_base[i] - truth[static_cast<std::size_t>(i)][k];
  }
  return mean / static_cast<double>(last - first);
}

// ---------------------------------------------------------------- on every mechanism

class EstimatorOnRobot : public testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  const std::string estimator_ = std::get<0>(GetParam());
  const std::string robot_ = std::get<1>(GetParam());
};
INSTANTIATE_TEST_SUITE_P(Of, EstimatorOnRobot,
                         Combine(ValuesIn(names()),
                                 testing::Values("planar_3rrr", "five_bar", "hexapod_6ups")),
                         [](const auto& tested) {
                           return std::get<0>(tested.param) + "_on_" + std::get<1>(tested.param);
                         });

TEST_P(EstimatorOnRobot, IsUnbiasedForAConstantForce) {
  const std::map<std::string, std::string> pushes = {
      {"planar_3rrr", "{force_x_N: 30, force_y_N: -20, moment_Nm: 2, "},
      {"five_bar", "{force_x_N: 8, force_y_N: -5, "},
      {"hexapod_6ups", "{force_x_N: 30, force_y_N: -20, force_z_N: 40, moment_x_Nm: 3, moment_z_Nm: -2, "}};
  const SimulatedScenario pushed =
      scenario(robot_, estimator_,
               never_reacts + "duration_s: 4.0\nsensors: {ideal: true}\napplied_wrench:\n  - " +
                   pushes.at(robot_) + "start_s: 0.6, rise_s: 0.3, hold_s: 5, fall_s: 1}\n");
  const int dof = pushed.robot.robot->dof();
  const PlatformVector error = mean_error(run_experiment(pushed), dof, 3500, 4000);
  const int forces = pushed.robot.robot->space().translations();
  EXPECT_LT(error.head(forces).lpNorm<Eigen::Infinity>(), 0.05);
  EXPECT_LT(error.tail(dof - forces).lpNorm<Eigen::Infinity>(), 0.01);
}

TEST_P(EstimatorOnRobot, IsReplayedBitForBit) {
  const SimulatedScenario simulated = scenario(robot_, estimator_, never_reacts + "duration_s: 0.8\n");
  const Recording recorded = run_experiment(simulated);
  EXPECT_THAT(replay(simulated, recorded).differing, testing::IsEmpty());
}

// ---------------------------------------------------------------- on the rig

class Estimator : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Of, Estimator, ValuesIn(names()), [](const auto& tested) { return tested.param; });

// The filter as printed takes samples of the IMU to be of now, so here they are.
TEST_P(Estimator, IsSilentWithoutContact) {
  const std::string at_once = GetParam() == "direct_imu_ekf" ? "sensors: {imu: {delay_us: 0}}\n" : "";
  const SimulatedScenario free =
      scenario("planar_3rrr", GetParam(),
               "duration_s: 2.2\nmotion:\n  kind: square\n  start_ms: 300\n"
               "  limits: {velocity_m_per_s: 1.5, acceleration_m_per_s2: 12, jerk_m_per_s3: 600}\n" +
                   at_once);
  const Verdict verdict = judge(run_experiment(free), free.robot.robot->space(), {}, {});
  EXPECT_THAT(verdict.detections, testing::IsEmpty());
  std::printf("%-28s at most %5.2f N, %6.3f Nm\n", GetParam().c_str(), verdict.max_observer_error_force,
              verdict.max_observer_error_moment);
}

/// A round post that is pushed against the middle of a link, or against the platform, from 0.6 s on.
std::string post_against(const Mechanism& robot, BodyId body) {
  Kinematics kinematics;
  robot.kinematics(robot.home_pose(), PlatformVector::Zero(robot.dof()), kinematics);
  const auto at = [&](double fraction) -> Eigen::Vector2d {
    return robot.point_on_body(kinematics, body, robot.axis_point(body, fraction));
  };
  const bool is_link = body != BodyId::platform();
  const Eigen::Vector2d along = is_link ? Eigen::Vector2d(at(1.0) - at(0.0)) : Eigen::Vector2d(0.0, 1.0);
  const Eigen::Vector2d away = Eigen::Vector2d(-along.y(), along.x()).normalized();
  const double gap = (is_link ? 0.03 : 0.137) + 0.02 + 0.005;  // radii of body and post, and 5 mm
  const Eigen::Vector2d start = at(0.5) + gap * away, way = -0.02 * away;
  const auto point = [](const Eigen::Vector2d& p) {
    return "x_m: " + std::to_string(p.x()) + ", y_m: " + std::to_string(p.y());
  };
  return "obstacles:\n  - {name: post, " + point(start) +
         ", radius_m: 0.02, kind: path, path: [{time_s: 0.6}, " + "{time_s: 1.0, " + point(way) + "}]}\n";
}

// Whichever body is touched, the wrench is what the contact does to the platform.
TEST_P(Estimator, EstimatesTheWrenchWhicheverBodyIsTouched) {
  const std::string rest = never_reacts + "duration_s: 2.0\nsensors: {ideal: true}\n";
  const SimulatedScenario untouched = scenario("planar_3rrr", GetParam(), rest);
  const Mechanism& robot = *untouched.robot.robot;
  for (const BodyId body : {BodyId::platform(), BodyId::link1(0), BodyId::link2(0), BodyId::link2(2)}) {
    const SimulatedScenario touched = scenario("planar_3rrr", GetParam(), rest + post_against(robot, body));
    const Recording recording = run_experiment(touched);
    const std::vector<double> bodies = recording.column("contact", "strongest.body");
    ASSERT_EQ(bodies.back(), body.index()) << body_name(body);
    ASSERT_GT(recording.column("contact", "strongest.depth").back(), 1e-3)
        << body_name(body);  // more than 6 N
    const PlatformVector error = mean_error(recording, robot.dof(), 1500, 2000);
    EXPECT_LT(error.head(2).lpNorm<Eigen::Infinity>(), 0.1) << body_name(body);
    EXPECT_LT(std::abs(error[2]), 0.02) << body_name(body);
  }
}

TEST_P(Estimator, IsNotValidWhereReadingsAreMissingBrokenOrLate) {
  const SimulatedScenario free = scenario("planar_3rrr", GetParam(), never_reacts + "duration_s: 1.0\n");
  const std::vector<Readings> good = test::readings_of(run_experiment(free));
  const std::vector<std::pair<std::string, std::function<void(Readings&, const Readings& old)>>> faults = {
      {"no joints", [](Readings& now, const Readings&) { now.joints.valid = false; }},
      {"joints not a number", [](Readings& now, const Readings&) { now.joints.active[1] = nan; }},
      {"no drives", [](Readings& now, const Readings&) { now.drives.valid = false; }},
      {"currents not a number", [](Readings& now, const Readings&) { now.drives.current[0] = nan; }},
      {"joints late", [](Readings& now, const Readings& old) { now.joints = old.joints; }},
  };
  constexpr std::size_t begin = 600, end = 640;
  for (const auto& [name, spoil] : faults) {
    FedControl control(free);
    for (std::size_t k = 0; k < good.size(); ++k) {
      Readings now = good[k];
      if (k >= begin && k < end) spoil(now, good[begin - 1]);
      const WrenchEstimate& estimate = control.see(now);
      ASSERT_TRUE(estimate.wrench_in_base.allFinite() && estimate.drive_torque.allFinite()) << name;
      const PlatformVector& deviation = estimate.standard_deviation;
      ASSERT_TRUE(deviation.allFinite()) << name;
      ASSERT_TRUE(!estimate.valid || k < begin - 50 || deviation.size() == 3) << name << " at " << k;
      const bool is_before = k >= begin - 50 && k < begin, has_recovered = k + 1 == good.size();
      const bool is_lost = k >= begin + 3 && k < end;
      if (is_before || is_lost || has_recovered) {
        ASSERT_EQ(estimate.valid, !is_lost) << name << " at " << k;
      }
    }
  }
}

/// Moves, and nothing touches it.
const std::string moves = "duration_s: 1.4\nmotion: {kind: square, start_ms: 300}\n";

TEST_P(Estimator, TellsHowUncertainEachComponentIsInFreeMotion) {
  const SimulatedScenario free = scenario("planar_3rrr", GetParam(), never_reacts + moves);
  const Recording recording = run_experiment(free);
  const auto estimates = read<WrenchEstimate>(recording, "wrench");
  for (std::size_t k = 500; k < recording.samples(); ++k) {
    const WrenchEstimate& estimate = estimates[k];
    ASSERT_TRUE(estimate.valid) << k;
    ASSERT_EQ(estimate.standard_deviation.size(), 3) << k;
    ASSERT_TRUE(estimate.standard_deviation.allFinite()) << k;
    ASSERT_GT(estimate.standard_deviation.minCoeff(), 0.0) << k;
  }
}

bool needs_imu(const std::string& estimator) {
  return estimator.starts_with("direct") || estimator.starts_with("imu");
}

// In the tick in which the IMU is gone the estimate is that of the momentum observer; it says so until it is
// back.
TEST_P(Estimator, FallsBackToTheMomentumObserverWithoutTheImu) {
  const SimulatedScenario free = scenario("planar_3rrr", GetParam(), never_reacts + moves);
  const SimulatedScenario plain = scenario("planar_3rrr", "momentum_observer", never_reacts + moves);
  const std::vector<Readings> good = test::readings_of(run_experiment(free));
  constexpr std::size_t lost = 700, back = 750;
  FedControl control(free), reference(plain);
  for (std::size_t k = 0; k < good.size(); ++k) {
    Readings now = good[k];
    if (k >= lost && k < back) now.imu = ImuReading();
    const WrenchEstimate& estimate = control.see(now);
    const WrenchEstimate& observed = reference.see(now);
    if (k + 1 == lost || k + 1 == good.size()) {
      ASSERT_FALSE(estimate.health.fallen_back) << k;
    }
    if (k < lost || k >= back) continue;
    ASSERT_TRUE(estimate.valid) << k;
    ASSERT_EQ(estimate.health.fallen_back, needs_imu(GetParam())) << k;
    if (needs_imu(GetParam())) {
      ASSERT_EQ(estimate.wrench_in_base, observed.wrench_in_base) << k;
    }
  }
}

TEST_P(Estimator, FallsBackFromAnImuThatRepeatsItselfOrIsNotANumber) {
  if (!needs_imu(GetParam())) return;
  const SimulatedScenario free = scenario("planar_3rrr", GetParam(), never_reacts + moves);
  const std::vector<Readings> good = test::readings_of(run_experiment(free));
  constexpr std::size_t begin = 700, end = 750;
  for (const bool frozen : {true, false}) {
    FedControl control(free);
    for (std::size_t k = 0; k < end; ++k) {
      Readings now = good[k];
      if (k >= begin && frozen) now.imu = good[begin - 1].imu;
      if (k >= begin && !frozen) now.imu.specific_force.y() = nan;
      const WrenchEstimate& estimate = control.see(now);
      ASSERT_TRUE(estimate.wrench_in_base.allFinite());
      if (k < begin - 50 || (frozen && k >= begin && k < begin + 3)) continue;
      ASSERT_EQ(estimate.health.fallen_back, k >= begin) << k << " frozen: " << frozen;
    }
  }
}

// A hard contact shakes IMU and encoders alike: no reason to disbelieve one of them.
TEST_P(Estimator, KeepsTheImuThroughACollision) {
  const SimulatedScenario struck = scenario(
      "planar_3rrr", GetParam(),
      never_reacts +
          "duration_s: 0.9\nmotion: {kind: passage, start_ms: 300, pose: {x_mm: -40}, direction_deg: 180, "
          "speed_m_per_s: 0.95, cruise_mm: 80}\npylon: {x_mm: -240, y_mm: -20}\n");
  const Recording recording = run_experiment(struck);
  const std::vector<double> touched = recording.column("contact", "in_contact");
  ASSERT_GT(std::count(touched.begin(), touched.end(), 1.0), 30);
  const auto estimates = read<WrenchEstimate>(recording, "wrench");
  for (std::size_t k = 400; k < recording.samples(); ++k) ASSERT_FALSE(estimates[k].health.fallen_back) << k;
}

TEST_P(Estimator, DoesNotAllocate) {
  const SimulatedScenario free = scenario("planar_3rrr", GetParam(), "duration_s: 0.6\n");
  const std::vector<Readings> readings = test::readings_of(run_experiment(free));
  FedControl control(free);
  control.see(readings.front());
  const test::AllocationCounter allocations;
  for (const Readings& now : readings) control.see(now);
  for (int k = 0; k < 10; ++k) control.see(Readings());
  EXPECT_EQ(allocations.count(), 0);
}

}  // namespace
}  // namespace flinch
