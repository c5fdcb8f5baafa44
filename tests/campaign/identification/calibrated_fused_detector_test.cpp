// How early contacts are detected of robots that were calibrated themselves: torque constants from pulls,
// dynamics from a motion that excites them, then error sizes and thresholds for half a false alarm an hour
// from 90 s of motion without contact, in which the robots also stand still, each robot by its own or by
// those of others. Beside them the same contacts with the same robots before, and as near to their model as
// `rig` says, with the thresholds that ship. One robot alone moves for 45 s.
// FLINCH_ROBOTS, FLINCH_CONTACTS and FLINCH_RUNS in the environment say how many robots, contacts of each
// sort, and runs without contact in which false alarms are counted; docs/observers.md cites 20 robots and 200
// contacts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diagrams/fused_detector.h"
#include "experiments/campaign/campaign_run.h"
#include "experiments/campaign/campaign_summary.h"
#include "experiments/campaign/exact_bounds.h"
#include "experiments/campaign/run_campaign.h"
#include "tests/campaign/detection/shipped_runs.h"
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
constexpr double asked = 0.5;    // false alarms an hour
constexpr double slowest = 0.3;  // speed of the platform before a contact [m/s]
const std::string own = "fused_detector", of_others = "fused_detector_of_others";

/// A momentum observer and the filter of its velocity.
struct Observer {
  const char* in_file;           ///< what a scenario says of them
  std::vector<std::string> set;  ///< what a campaign is told
};
const Observer usual{"momentum_observer: {gain_per_s: [20, 20, 20]}", {}};
const Observer fast{
    "momentum_observer: {gain_per_s: [150, 150, 150]}\n  velocity_filter: {cutoff_frequency_Hz: 60}",
    {"control.momentum_observer.gain_per_s=[150, 150, 150]",
     "control.velocity_filter.cutoff_frequency_Hz=60"}};

/// A robot in motion without contact, and what its controller knows of it.
struct Robot {
  SimulatedScenario as_rig;  ///< nearer to its model, with its torque constants known to 1.5 %
  SimulatedScenario before;  ///< as calibration_motion.yaml has it, with 6.1 Nm/A
  FreeMotion after;          ///< once it was calibrated
};

constexpr const char* constants = "  drive_torque: {torque_constant_Nm_per_A: [6.021, 6.6116, 6.7315]}\n";
constexpr const char* believed = "  drive_torque: {torque_constant_Nm_per_A: [6.1, 6.1, 6.1]}\n";
constexpr const char* rig = "plant: {realism: bench}";
constexpr const char* drawn =
    "plant: {realism: {like: bench, leg_inertia: 0.1, platform_inertia: 0.1, torque_constant: 0}}";

SimulatedScenario motion_of(const CalibratedRobot& robot, const char* realism, const char* known_constants,
                            const Observer& observer, double seconds) {
  return robot.scenario("random_motion.yaml",
                        {{rig, realism},
                         {constants, known_constants},
                         {usual.in_file, observer.in_file},
                         {"duration_s: 36", "duration_s: " + std::to_string(seconds + 1.5)},
                         {"duration_s: 34", "duration_s: " + std::to_string(seconds) + "\n  pause_ms: 300"},
                         {"momentum_kalman_filter, sliding_mode_observer, direct_extended_imu_ekf, ", ""}});
}

/// A robot drawn from a seed, which moves for so many seconds once it was calibrated.
Robot calibrated(std::uint64_t seed, const Observer& observer, double seconds) {
  CalibratedRobot robot(seed);
  SimulatedScenario as_rig = motion_of(robot, rig, constants, observer, seconds);
  SimulatedScenario before = motion_of(robot, drawn, believed, observer, seconds);
  robot.torque_constants("calibration_pulls.yaml");
  robot.dynamics("calibration_excitation.yaml");
  return {std::move(as_rig), std::move(before),
          test::free_motion(motion_of(robot, drawn, "", observer, seconds))};
}

OwnThresholds thresholds_of(const std::vector<const Robot*>& robots) {
  std::vector<const FreeMotion*> motions;
  for (const Robot* const robot : robots) motions.push_back(&robot->after);
  return test::thresholds_of(motions, {.false_alarms_per_hour = asked});
}

/// Those of the robots with odd numbers for those with even ones, and the other way round.
std::vector<OwnThresholds> thresholds_of_others(const std::vector<Robot>& robots) {
  return test::in_parallel(
      2,
      [&](std::size_t parity) {
        std::vector<const Robot*> others;
        for (std::size_t i = 0; i < robots.size(); ++i)
          if (i % 2 != parity) others.push_back(&robots[i]);
        return thresholds_of(others);
      },
      threads);
}

/// A fused detector that judges by other sizes and thresholds than those of the scenario.
DetectionStage judging_by(const std::vector<FusedResidual>& residuals) {
  return {of_others, [residuals](const StageContext& site, const EstimatePorts& given) {
            ContactControlSettings settings = site.settings;
            settings.fused_detector.residuals = residuals;
            return add_fused_detector({site.builder, site.name, site.robot, settings, site.shared}, given);
          }};
}

/// A campaign that ships, for robots that are put into its scenarios.
Campaign with_other_robots(const char* name, std::size_t draws, std::vector<std::string> set = {}) {
  set.insert(set.end(), {"plant.realism=none",
                         "control.estimators=[momentum_observer, disturbance_filter, imu_residual]"});
  return test::shipped(name, draws, set);
}

/// Of contacts at 0.3 to 1.5 m/s, so many of each sort.
Campaign contacts_of(std::size_t draws, const Observer& observer) {
  Campaign campaign = with_other_robots("detection_roc", draws, observer.set);
  for (CampaignDraw& draw : campaign.drawn)
    if (draw.key == "motion.speed_m_per_s") draw.from = slowest;
  return campaign;
}

/// What detectors detected in the runs of a campaign.
class Detected {
 public:
  explicit Detected(std::vector<RunResult> results) : results_(std::move(results)) {
    for (const RunResult& result : results_) {
      for (const EstimatorResult& by : result.estimators) {
        groups_[by.name][result.body].add(result, by, missed_after);
        groups_[by.name][all].add(result, by, missed_after);
      }
    }
  }

  /// Of a detector, and of contacts with a body.
  CampaignGroup of(const std::string& detector, const std::string& body = all) const {
    const auto& bodies = groups_.at(detector);
    const auto found = bodies.find(body);
    return found == bodies.end() ? CampaignGroup{} : found->second.group();
  }
  /// When a detector detected the contact of each run [s]: missed ones after `missed_after`, none that a
  /// false alarm came before.
  std::vector<std::optional<double>> times(const std::string& detector) const {
    std::vector<std::optional<double>> times;
    for (const RunResult& result : results_) {
      const auto by = std::find_if(result.estimators.begin(), result.estimators.end(),
                                   [&](const EstimatorResult& each) { return each.name == detector; });
      const bool counts = result.body != "none" && !by->false_alarm;
      times.push_back(counts
                          ? std::optional(std::min(by->detection_time.value_or(missed_after), missed_after))
                          : std::nullopt);
    }
    return times;
  }
  /// How many contacts with a body a detector detected by a time [s].
  std::size_t detected_by(double time, const std::string& detector, const std::string& body) const {
    const std::vector<std::optional<double>> when = times(detector);
    std::size_t count = 0;
    for (std::size_t i = 0; i < when.size(); ++i)
      count += results_[i].body == body && when[i] && *when[i] <= time ? 1 : 0;
    return count;
  }

  void print(const char* title) const {
    std::printf("%s; median / nine tenths [ms]\n", title);
    for (const auto& [detector, bodies] : groups_) {
      const CampaignGroup in_all = of(detector);
      std::printf("  %-24s", detector.c_str());
      for (const char* const body : {"platform", "link1", "link2", "clamping"}) {
        if (in_all.contacts == 0) break;
        const CampaignGroup group = of(detector, body);
        std::printf(" %5.1f / %5.1f |", 1e3 * group.median.value_or(never), 1e3 * group.p90.value_or(never));
      }
      std::printf(" missed %zu of %zu (at most %.1f %%), false alarms %zu in %.2f h (at most %.2f an hour)\n",
                  in_all.missed, in_all.contacts, 100.0 * in_all.missed_at_most.value_or(1.0),
                  in_all.false_alarms, in_all.contact_free / 3600.0, in_all.false_alarms_per_hour_at_most);
    }
    std::fflush(stdout);
  }
  std::vector<std::string> detectors() const {
    std::vector<std::string> names;
    for (const auto& [name, bodies] : groups_) names.push_back(name);
    return names;
  }

 private:
  static constexpr double missed_after = 0.1;  // [s]
  static constexpr double never = INFINITY;
  static constexpr const char* all = "all";

  std::vector<RunResult> results_;
  std::map<std::string, std::map<std::string, CollectedGroup>> groups_;  // by detector and body
};

/// Robots that were calibrated, and by what they tell contacts.
struct Calibrated {
  std::vector<Robot> robots;
  std::vector<OwnThresholds> own, of_others;  ///< of each; the second is empty where there is but one
};

Calibrated calibrated(std::size_t count, const Observer& observer) {
  Calibrated made;
  const double seconds = count > 1 ? 90.0 : 45.0;
  made.robots = test::in_parallel(
      count, [&](std::size_t i) { return calibrated(i + 1, observer, seconds); }, threads);
  made.own = test::in_parallel(
      count, [&](std::size_t i) { return thresholds_of({&made.robots[i]}); }, threads);
  if (count > 1) made.of_others = thresholds_of_others(made.robots);
  return made;
}

/// What the controller of a robot knows of it.
enum class Knows { as_rig, before, itself };

const SimulatedScenario& with(const Robot& robot, Knows what) {
  if (what == Knows::itself) return robot.after.scenario;
  return what == Knows::before ? robot.before : robot.as_rig;
}

/// The runs of a campaign, with one robot after the other.
Detected runs_of(const Campaign& campaign, const Calibrated& of, Knows what) {
  return Detected(test::in_parallel(
      campaign.runs(),
      [&](std::size_t number) {
        CampaignRun run = draw_run(campaign, number);
        const std::size_t robot = run.draw % of.robots.size();
        test::put(with(of.robots[robot], what), run.scenario);
        if (what == Knows::itself) {
          ContactControlSettings& control = run.scenario.control;
          control.reaction_thresholds = of.own[robot].plain;
          control.fused_detector.residuals = of.own[robot].residuals;
          if (!of.of_others.empty())
            control.stages.detectors.add(judging_by(of.of_others[robot % 2].residuals));
        }
        return simulate_run(run);
      },
      threads));
}

/// Contacts that were detected at least half a tick sooner, or later, than otherwise.
struct Comparison {
  std::size_t sooner = 0, later = 0;

  std::size_t differ() const { return sooner + later; }
};

Comparison compared(const Detected& before, const Detected& after, const std::string& detector) {
  constexpr double half_a_tick = 0.5e-3;  // [s]
  const auto was = before.times(detector), is = after.times(detector);
  Comparison result;
  for (std::size_t i = 0; i < was.size(); ++i) {
    if (!was[i] || !is[i]) continue;
    result.sooner += *is[i] < *was[i] - half_a_tick ? 1 : 0;
    result.later += *is[i] > *was[i] + half_a_tick ? 1 : 0;
  }
  std::printf("  %-24s %zu sooner, %zu later\n", detector.c_str(), result.sooner, result.later);
  return result;
}

using Times = std::map<std::string, double>;  // by body [s]

/// By then nine tenths of the contacts of the whole campaign were detected, docs/observers.md.
const Times of_calibrated{{"platform", 4.8e-3}, {"link1", 8.0e-3}, {"link2", 7.3e-3}, {"clamping", 10.4e-3}};

/// Half of them by then, by the momentum observer alone. It may be as slow as that.
const Times of_fast_observer{{"platform", 5e-3}, {"link1", 8e-3}, {"link2", 8e-3}, {"clamping", 9e-3}};

/// Nothing refutes that a detector has detected such a share by then.
void expect_detected(double share, const Times& by, const std::string& detector, const Detected& detected) {
  for (const auto& [body, time] : by) {
    const std::size_t soon = detected.detected_by(time, detector, body);
    EXPECT_GE(clopper_pearson_upper(soon, detected.of(detector, body).contacts, 0.999), share) << body;
  }
}

TEST(CalibratedThemselves, RobotsNoticeContactsSoonerAtTheRateOfFalseAlarmsThatIsAsked) {
  const Calibrated all = calibrated(test::wanted<std::size_t>("FLINCH_ROBOTS", 1), usual);
  const Campaign contacts = contacts_of(test::wanted<std::size_t>("FLINCH_CONTACTS", 5), usual);
  const Detected before = runs_of(contacts, all, Knows::before);
  before.print("before calibration, thresholds that ship");
  const Detected near = runs_of(contacts, all, Knows::as_rig);
  near.print("as near to their model as bench, thresholds that ship");
  const Detected after = runs_of(contacts, all, Knows::itself);
  after.print("after calibration, thresholds of their own");

  for (const char* const detector : {"momentum_observer", "disturbance_filter", "imu_residual"}) {
    const Comparison than_near = compared(near, after, detector);
    EXPECT_LT(clopper_pearson_upper(than_near.later, than_near.differ()), 0.5) << detector;
  }
  const Comparison fused = compared(near, after, own);
  EXPECT_GE(clopper_pearson_upper(fused.sooner, fused.differ()), 0.5);
  EXPECT_EQ(after.of(own, "platform").missed, 0U);
  expect_detected(0.9, of_calibrated, own, after);

  const Campaign motion =
      with_other_robots("false_alarms", test::wanted<std::size_t>("FLINCH_RUNS", 1), {"motion.pause_ms=300"});
  const Detected detected = runs_of(motion, all, Knows::itself);
  detected.print("motion without contact");
  for (const std::string& detector : detected.detectors()) {
    const CampaignGroup alarms = detected.of(detector);
    EXPECT_LE(lower_rate(alarms.false_alarms, alarms.contact_free / 3600.0), asked) << detector;
  }
}

TEST(CalibratedThemselves, RobotsNeedNoMoreThanAMomentumObserverToNoticeHalfOfAllContactsAsSoonAsAsked) {
  const Calibrated all = calibrated(test::wanted<std::size_t>("FLINCH_ROBOTS", 1), fast);
  const Detected detected =
      runs_of(contacts_of(test::wanted<std::size_t>("FLINCH_CONTACTS", 5), fast), all, Knows::itself);
  detected.print("after calibration, momentum observer at 150 1/s with velocities at 60 Hz");
  expect_detected(0.5, of_fast_observer, "momentum_observer", detected);
}

}  // namespace
}  // namespace flinch
