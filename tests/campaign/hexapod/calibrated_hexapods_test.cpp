// Hexapods drawn anew, with a payload of 2 kg that nobody knows of, each calibrated by itself: force
// constants, dynamics, then thresholds, error sizes and the errors of the wrench from motion without contact.
// When are contacts detected, is it told what was touched, and how does the strict level give way? Beside it
// the same contacts with the errors of the wrench that ship. The tables are printed. FLINCH_ROBOTS and
// FLINCH_CONTACTS in the environment say how many robots, and contacts of each body; docs/theory.md cites 2
// and 30.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_run.h"
#include "experiments/campaign/campaign_summary.h"
#include "experiments/campaign/exact_bounds.h"
#include "experiments/campaign/run_campaign.h"
#include "tests/identification/calibrated_robot.h"
#include "tests/identification/own_thresholds.h"
#include "tests/support/in_parallel.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

using test::CalibratedRobot;
using test::FreeMotion;
using test::OwnThresholds;

constexpr unsigned threads = 2;
constexpr double missed_after = 0.1;  // [s]

/// One that knows itself.
struct Hexapod {
  FreeMotion motion;
  OwnThresholds thresholds;
};

Hexapod calibrated(std::uint64_t seed) {
  CalibratedRobot robot(seed);
  robot.torque_constants("hexapod_calibration_pulls.yaml");
  robot.dynamics("hexapod_calibration_excitation.yaml");
  Hexapod made{test::free_motion(robot.scenario("hexapod_calibration_motion.yaml")), {}};
  made.thresholds = test::thresholds_of({&made.motion}, {.false_alarms_per_hour = 0.5, .one_robot = true});
  return made;
}

/// Contacts with one sort of body.
struct Touched {
  std::size_t right = 0, wrong = 0, unsure = 0;
  std::vector<double> removal, peak;               ///< [s], infinite: not by the end; [N]
  std::map<std::string, CollectedGroup> detected;  ///< by detector

  std::size_t contacts() const { return right + wrong + unsure; }
};

using Results = std::map<std::string, Touched>;  // by body

/// `followed`: the detector whose word counts.
Results contacts(const std::vector<Hexapod>& robots, const std::string& followed, bool knows_errors) {
  CampaignOverrides overrides;
  overrides.draws = test::wanted<std::size_t>("FLINCH_CONTACTS", 5);
  overrides.set = {"plant.realism=none",
                   "plant.payload_kg=2",
                   "control.classifiers=[model_classifier]",
                   "control.estimators=[momentum_observer, disturbance_filter, imu_residual]",
                   "control.detectors=[" + followed + "]",
                   "control.reaction_laws=[strict_reaction]",
                   "control.isolation.window_ms=20"};
  const Campaign campaign = read_campaign(
      std::filesystem::path(FLINCH_SOURCE_DIR) / "tests/campaign/hexapod/contacts.yaml", overrides);
  const std::vector<RunResult> runs = test::in_parallel(
      campaign.runs(),
      [&](std::size_t number) {
        CampaignRun run = draw_run(campaign, number);
        const Hexapod& robot = robots[run.draw % robots.size()];
        test::put(robot.motion.scenario, run.scenario);
        ContactControlSettings& control = run.scenario.control;
        const JointVector none = control.isolation.uncertainty.drive_torque;
        robot.thresholds.give(control);
        if (!knows_errors) control.isolation.uncertainty.drive_torque = none;
        return simulate_run(run);
      },
      threads);
  Results all;
  for (const RunResult& run : runs) {
    Touched& touched = all[run.body];
    if (run.class_right) {
      ++(*run.class_right ? touched.right : touched.wrong);
    } else {
      ++touched.unsure;
    }
    for (const EstimatorResult& by : run.estimators) touched.detected[by.name].add(run, by, missed_after);
    if (run.body != "none") {
      touched.removal.push_back(run.removal_time.value_or(INFINITY));
      touched.peak.push_back(run.peak_force.value_or(0.0));
    }
    EXPECT_EQ(run.fault, "") << run.run;
    EXPECT_FALSE(run.violates_sigma_kappa || run.violates_sigma_sc || run.self_contact) << run.run;
  }
  return all;
}

/// The value that this share of them does not exceed; 0 without any.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size()))) - 1];
}

void print(const char* title, const Results& all) {
  std::printf("  %s\n  %-10s %6s %6s %6s %18s %16s   detected: median, nine tenths [ms], missed, false\n",
              title, "touched", "right", "wrong", "unsure", "removed, 95 % [ms]", "peak, most [N]");
  for (const auto& [body, touched] : all) {
    std::printf("  %-10s %6zu %6zu %6zu %8.0f %9.0f %8.0f %7.0f", body.c_str(), touched.right, touched.wrong,
                touched.unsure, 1e3 * quantile(touched.removal, 0.5), 1e3 * quantile(touched.removal, 0.95),
                quantile(touched.peak, 0.5), quantile(touched.peak, 1.0));
    for (const auto& [detector, group] : touched.detected) {
      const CampaignGroup of = group.group();
      std::printf("   %s %.1f %.1f %zu %zu", detector.c_str(), 1e3 * of.median.value_or(INFINITY),
                  1e3 * of.p90.value_or(INFINITY), of.missed, of.false_alarms);
    }
    std::printf("\n");
  }
  std::fflush(stdout);
}

TEST(HexapodsCalibratedByThemselves, TellWhatWasTouchedByTheErrorsOfTheirOwnDrives) {
  const std::vector<Hexapod> robots = test::in_parallel(
      test::wanted<std::size_t>("FLINCH_ROBOTS", 1), [](std::size_t i) { return calibrated(i + 1); },
      threads);
  std::size_t right_before = 0, right = 0, wrong = 0, all = 0;
  for (const char* const followed : {"contact_detector", "fused_detector"}) {
    const Results shipped = contacts(robots, followed, false), own = contacts(robots, followed, true);
    print((std::string(followed) + ", errors of the wrench that ship").c_str(), shipped);
    print((std::string(followed) + ", of their own drives").c_str(), own);
    for (const auto& [body, touched] : shipped) right_before += touched.right;
    for (const auto& [body, touched] : own)
      right += touched.right, wrong += touched.wrong, all += touched.contacts();
  }
  std::printf("  right %zu, with the errors that ship %zu; wrong %zu of %zu\n", right, right_before, wrong,
              all);
  EXPECT_GE(clopper_pearson_upper(right, all, 0.999), 0.7) << "docs/theory.md";
  EXPECT_LE(1.0 - clopper_pearson_upper(all - wrong, all, 0.999), 0.02);
}

}  // namespace
}  // namespace flinch
