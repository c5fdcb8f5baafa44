// What calibrating a robot is good for: rig robots drawn anew, of which the controller believes 6.1 Nm/A at
// each drive and the masses and friction of the robot file. Thresholds for 0.5 false alarms an hour before
// and after torque constants and dynamics are calibrated, and the times after which drawn contacts are
// detected by them. The table is printed; docs/theory.md cites it. FLINCH_ROBOTS in the environment says how
// many robots.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <limits>

#include "calibration/contact_free_peaks.h"
#include "calibration/threshold_calibration.h"
#include "systems/framework/random.h"
#include "tests/identification/calibrated_robot.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

using test::CalibratedRobot;

constexpr const char* constants_of_motion = "  drive_torque: {torque_constant_Nm_per_A: [6.1, 6.1, 6.1]}\n";
constexpr const char* constants_of_contacts =
    "  drive_torque: {torque_constant_Nm_per_A: [6.021, 6.6116, 6.7315]}   # as calibrated\n";
constexpr const char* believed = "  drive_torque: {torque_constant_Nm_per_A: [6.1, 6.1, 6.1]}\n";
constexpr const char* drawn_robot =
    "seed: 1\n\nplant: {realism: {like: bench, leg_inertia: 0.1, platform_inertia: 0.1, torque_constant: 0}}";

struct Collision {
  const char* scenario;
  double speed;
};
constexpr Collision collisions[] = {{"platform_collision.yaml", 0.95},
                                    {"first_link_collision.yaml", 0.56},
                                    {"second_link_collision.yaml", 0.93}};

/// A robot before or after its calibrations.
struct Stage {
  double force = 0.0, moment = 0.0;  ///< thresholds [N, Nm]
  std::vector<double> times;         ///< after which contacts were detected; infinite: never [ms]
  int detected = 0;
};

EstimatorThresholds thresholds_of(const CalibratedRobot& robot, bool calibrated) {
  const test::Simulated run = robot.recorded(
      "calibration_motion.yaml", calibrated ? CalibratedRobot::Replacements{{constants_of_motion, ""}}
                                            : CalibratedRobot::Replacements{});
  const ThresholdGoal goal;
  const auto peaks = contact_free_peaks(run.recording, run.scenario.robot.robot->space(), goal.stretch);
  const std::vector<EstimatorThresholds> all = calibrate_thresholds(peaks, goal);
  return *std::find_if(all.begin(), all.end(),
                       [](const EstimatorThresholds& of) { return of.estimator == "momentum_observer"; });
}

/// Contacts with the shipped pylons at speeds drawn from `seed`, up to those of the files.
void collide(const CalibratedRobot& robot, bool calibrated, std::uint64_t seed, Stage& stage) {
  RandomGenerator random(seed);
  for (const Collision& collision : collisions) {
    for (int trial = 0; trial < 2; ++trial) {
      const std::string detector = "{reaction_force_N: " + std::to_string(stage.force) +
                                   ", reaction_moment_Nm: " + std::to_string(stage.moment) + "}";
      const std::string speed = std::to_string(collision.speed * random.uniform(0.5, 1.0));
      const std::string shipped = std::to_string(collision.speed).substr(0, 4);
      const Verdict verdict =
          robot.judged(collision.scenario, {{"seed: 1", drawn_robot},
                                            {constants_of_contacts, calibrated ? "" : believed},
                                            {"speed_m_per_s: " + shipped, "speed_m_per_s: " + speed},
                                            {"{reaction_force_N: 10, reaction_moment_Nm: 1}", detector}});
      ASSERT_FALSE(verdict.contacts.empty()) << collision.scenario << " at " << speed << " m/s";
      const ContactVerdict& contact = verdict.contacts.front();
      const double never = std::numeric_limits<double>::infinity();
      stage.times.push_back(contact.detected ? 1e3 * (*contact.detected - contact.onset) : never);
      stage.detected += contact.detected ? 1 : 0;
      EXPECT_EQ(verdict.false_detections, 0);
    }
  }
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

TEST(CalibratedRobots, NoticeContactsSoonerByLowerThresholds) {
  const auto robots = test::wanted<std::uint64_t>("FLINCH_ROBOTS", 4);
  std::vector<double> before, after, factors;
  int detected_before = 0, detected_after = 0;
  std::printf("  robot   threshold before           after      detected after, median before, after\n");
  for (std::uint64_t seed = 1; seed <= robots; ++seed) {
    CalibratedRobot robot(seed);
    Stage nominal, calibrated;
    const auto run = [&](bool is_calibrated, Stage& stage) {
      const EstimatorThresholds thresholds = thresholds_of(robot, is_calibrated);
      stage.force = thresholds.force.value, stage.moment = thresholds.moment.value;
      collide(robot, is_calibrated, seed, stage);
    };
    run(false, nominal);
    robot.torque_constants("calibration_pulls.yaml");
    robot.dynamics("calibration_excitation.yaml");
    run(true, calibrated);
    std::printf("  %5d %8.1f N %5.2f Nm %7.1f N %5.2f Nm %14.1f ms %8.1f ms\n", static_cast<int>(seed),
                nominal.force, nominal.moment, calibrated.force, calibrated.moment, median(nominal.times),
                median(calibrated.times));
    before.insert(before.end(), nominal.times.begin(), nominal.times.end());
    after.insert(after.end(), calibrated.times.begin(), calibrated.times.end());
    detected_before += nominal.detected, detected_after += calibrated.detected;
    factors.push_back(nominal.force / calibrated.force);
  }
  std::printf(
      "  thresholds lower by %.1f (median); detected %d and %d of %zu, after %.1f and %.1f ms (median)\n",
      median(factors), detected_before, detected_after, before.size(), median(before), median(after));
  EXPECT_GT(median(factors), 2.0);
  EXPECT_LT(median(after), 0.8 * median(before));
  EXPECT_EQ(detected_after, static_cast<int>(after.size()));
}

}  // namespace
}  // namespace flinch
