#include "experiments/verdict/run_monitor.h"

#include <gtest/gtest.h>

#include <string>

#include "experiments/verdict/verdict.h"
#include "systems/robot/configuration_space.h"
#include "tests/experiments/verdict/synthetic_run.h"

namespace flinch {
namespace {

using test::SyntheticRun;

constexpr ConfigurationSpace planar = ConfigurationSpace::Kind::planar_pose;

Verdict judged(const SyntheticRun& run, const ForceLimits& limits = {}) {
  return judge(run.recording(), planar, {}, limits);
}

/// At these ticks, of the controller and of the truth.
SyntheticRun measured_run() {
  SyntheticRun run(300);
  for (int k = 0; k < 300; ++k) {
    run.at(k).measured = {.valid = true, .sigma_kappa = 5.0, .sigma_sc = 0.3};
    run.at(k).true_measures = {.valid = true, .sigma_kappa = 8.0, .sigma_sc = 0.18};
  }
  run.at(50).true_measures.sigma_kappa = 16.0;
  run.at(150).true_measures.sigma_sc = 0.16;
  run.at(160).true_measures = {.valid = false, .sigma_kappa = 99.0, .sigma_sc = 0.0};
  run.at(299).true_measures = {.valid = true, .sigma_kappa = 9.0, .sigma_sc = 0.17};
  return run.notice(100, 200);
}

TEST(Measures, AreThoseOfTheTruthOfTheWholeRunAndOnceSomethingIsDetected) {
  const Verdict verdict = judged(measured_run());
  EXPECT_EQ(verdict.measures.sigma_kappa->first, 8.0);
  EXPECT_EQ(verdict.measures.sigma_kappa->most, 16.0);
  EXPECT_EQ(verdict.measures.sigma_sc->least, 0.16);
  EXPECT_EQ(verdict.measures_once_detected.sigma_kappa->first, 8.0);
  EXPECT_EQ(verdict.measures_once_detected.sigma_kappa->most, 9.0);
  EXPECT_EQ(verdict.measures_once_detected.sigma_kappa->last, 9.0);
  EXPECT_EQ(verdict.measures_once_detected.sigma_sc->least, 0.16);
  EXPECT_EQ(verdict.measures_once_detected.sigma_sc->last, 0.17);
}

TEST(Measures, AreThoseOfTheControllerWhereNobodyRecordedTheTruth) {
  Recording recording = measured_run().recording();
  std::erase_if(recording.signals, [](const Signal& signal) { return signal.path == "true_measures"; });
  const Verdict verdict = judge(recording, planar, {}, {});
  EXPECT_EQ(verdict.measures.sigma_kappa->most, 5.0);
  EXPECT_EQ(verdict.measures_once_detected.sigma_sc->least, 0.3);
}

TEST(Measures, AreNoneWhereNothingIsDetectedAndWhereNobodyRecordedThem) {
  SyntheticRun quiet(50);
  EXPECT_FALSE(judged(quiet).measures.sigma_kappa) << "none of them is valid";
  quiet.at(10).true_measures = {.valid = true, .sigma_kappa = 8.0, .sigma_sc = 0.18};
  EXPECT_EQ(judged(quiet).measures.sigma_sc->first, 0.18);
  EXPECT_FALSE(judged(quiet).measures_once_detected.sigma_sc);
}

TEST(ForceLimit, ByWhichContactsAreJudgedIsToldByTheVerdict) {
  EXPECT_EQ(judged(SyntheticRun(10), {.region = "face", .transient = 65.0}).limits.region, "face");
}

TEST(LargestTorque, IsThatOfAnyDriveEitherWay) {
  SyntheticRun run(10);
  EXPECT_EQ(judged(run).largest_torque, std::nullopt);
  run.at(3).torque = {.valid = true, .torque = Eigen::Vector3d(1.0, -7.0, 2.0)};
  run.at(5).torque = {.valid = true, .torque = Eigen::Vector3d(6.0, 0.0, 0.0)};
  run.at(6).torque = {.valid = false, .torque = Eigen::Vector3d(60.0, 0.0, 0.0)};
  EXPECT_EQ(judged(run).largest_torque, 7.0);
}

}  // namespace
}  // namespace flinch
