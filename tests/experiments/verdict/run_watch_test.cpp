// What becomes of the measures that laws keep within limits, by the best witness.
#include "experiments/verdict/run_watch.h"

#include <gtest/gtest.h>

#include <string>

#include "experiments/verdict/verdict.h"
#include "systems/robot/configuration_space.h"
#include "tests/experiments/verdict/synthetic_run.h"

namespace flinch {
namespace {

using test::SyntheticRun;

constexpr ConfigurationSpace planar = ConfigurationSpace::Kind::planar_pose;

Verdict judged(const SyntheticRun& run) { return judge(run.recording(), planar, {}, {}); }

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

}  // namespace
}  // namespace flinch
